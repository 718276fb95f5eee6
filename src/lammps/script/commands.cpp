// One table: the name of a command, and who takes it, or why it is ignored or refused.
#include "lammps/script/interpreter.hpp"

#include <algorithm>
#include <iterator>

namespace elamin::script {
namespace {

struct Taken { const char* name; Handler handler; };
constexpr Taken taken[]{{"angle_coeff", command::angle_coeff},
                        {"angle_style", command::angle_style},
                        {"atom_style", command::atom_style},
                        {"bond_coeff", command::bond_coeff},
                        {"bond_style", command::bond_style},
                        {"boundary", command::boundary},
                        {"change_box", command::change_box},
                        {"clear", command::clear},
                        {"compute", command::compute},
                        {"create_atoms", command::create_atoms},
                        {"create_bonds", command::create_bonds},
                        {"create_box", command::create_box},
                        {"delete_atoms", command::delete_atoms},
                        {"delete_bonds", command::delete_bonds},
                        {"dimension", command::dimension},
                        {"displace_atoms", command::displace_atoms},
                        {"fix", command::fix},
                        {"group", command::group},
                        {"if", command::condition_of_if},
                        {"include", command::include},
                        {"jump", command::jump},
                        {"label", command::label},
                        {"lattice", command::lattice},
                        {"mass", command::mass},
                        {"minimize", command::minimize},
                        {"neigh_modify", command::neigh_modify},
                        {"neighbor", command::neighbor},
                        {"next", command::next},
                        {"pair_coeff", command::pair_coeff},
                        {"pair_modify", command::pair_modify},
                        {"pair_style", command::pair_style},
                        {"print", command::print},
                        {"quit", command::quit},
                        {"read_data", command::read_data},
                        {"region", command::region},
                        {"reset_atom_ids", command::reset_atom_ids},
                        {"reset_ids", command::reset_atom_ids},
                        {"reset_timestep", command::reset_timestep},
                        {"run", command::run},
                        {"set", command::set},
                        {"special_bonds", command::special_bonds},
                        {"timestep", command::timestep},
                        {"uncompute", command::uncompute},
                        {"unfix", command::unfix},
                        {"units", command::units},
                        {"variable", command::variable},
                        {"velocity", command::velocity}};

constexpr const char* output = "output: a run of elamin writes its own";
constexpr const char* neighbours = "neighbour lists: elamin finds all pairs that touch";
constexpr const char* machine = "how LAMMPS uses the machine";
constexpr const char* stepping = "how LAMMPS minimises or steps: [solver] says how elamin does";

struct Ignored { const char* name; const char* why; };
constexpr Ignored ignored[]{{"dump", output},
                            {"dump_modify", output},
                            {"undump", output},
                            {"thermo", output},
                            {"thermo_style", output},
                            {"thermo_modify", output},
                            {"restart", output},
                            {"write_data", output},
                            {"write_restart", output},
                            {"write_dump", output},
                            {"write_coeff", output},
                            {"log", output},
                            {"echo", output},
                            {"info", output},
                            {"compute_modify", output},
                            {"fix_modify", output},
                            {"timers", output},
                            {"timer", output},
                            {"atom_modify", neighbours},
                            {"processors", machine},
                            {"comm_modify", machine},
                            {"comm_style", machine},
                            {"newton", machine},
                            {"package", machine},
                            {"suffix", machine},
                            {"balance", machine},
                            {"partition", machine},
                            {"pair_write", output},
                            {"bond_write", output},
                            {"min_style", stepping},
                            {"min_modify", stepping},
                            {"run_style", stepping},
                            {"shell", "elamin runs no other programs"}};

struct Refused { const char* name; const char* why; };
constexpr Refused refused[]{
    {"read_restart", "a restart file can be read by LAMMPS alone; let LAMMPS write it as a data file (write_data FILE) and read that"},
    {"read_dump", "positions from a dump are not taken; let LAMMPS write a data file (write_data FILE) and read that"},
    {"rerun", "positions from a dump are not taken; let LAMMPS write a data file (write_data FILE) and read that"},
    {"kspace_style", "there are no charges here"},
    {"dihedral_style", "there are no dihedrals here"},
    {"dihedral_coeff", "there are no dihedrals here"},
    {"improper_style", "there are no impropers here"},
    {"improper_coeff", "there are no impropers here"},
    {"replicate", "copies of a box are not made; let LAMMPS write them as a data file (write_data FILE) and read that"},
    {"molecule",
     "molecule templates are not taken here; let LAMMPS write what it makes of them as a data file (write_data FILE) and read that"},
    {"python", "elamin runs no other programs"},
    {"plugin", "elamin runs no other programs"},
    {"neb", "paths between states are found by [path] of elamin"},
    {"prd", "there is no temperature here"},
    {"tad", "there is no temperature here"},
    {"temper", "there is no temperature here"}};

}  // namespace

Handler handler_of(const std::string& name) {
  const auto* found =
      std::lower_bound(std::begin(taken), std::end(taken), name, [](const Taken& t, const std::string& n) { return t.name < n; });
  return found != std::end(taken) && name == found->name ? found->handler : nullptr;
}

std::string ignored_command(const std::string& name) {
  for (const Ignored& i : ignored)
    if (name == i.name) return i.why;
  return "";
}

std::string refused_command(const std::string& name) {
  for (const Refused& r : refused)
    if (name == r.name) return r.why;
  return "";
}

std::vector<std::string> known_commands() {
  std::vector<std::string> all;
  for (const Taken& t : taken) all.push_back(t.name);
  for (const Ignored& i : ignored) all.push_back(i.name);
  return all;
}

}  // namespace elamin::script
