// One table: the name of a command, and who takes it, or why it is ignored or refused.
#include "core/find.hpp"
#include "lammps/script/interpreter.hpp"

#include <algorithm>

namespace elamin::script {
namespace {

const std::map<std::string, Handler> taken{
    {"angle_coeff", command::angle_coeff}, {"angle_style", command::angle_style}, {"atom_style", command::atom_style},
    {"bond_coeff", command::bond_coeff}, {"bond_style", command::bond_style}, {"boundary", command::boundary},
    {"change_box", command::change_box}, {"clear", command::clear}, {"compute", command::compute}, {"create_atoms", command::create_atoms},
    {"create_bonds", command::create_bonds}, {"create_box", command::create_box}, {"delete_atoms", command::delete_atoms},
    {"delete_bonds", command::delete_bonds}, {"dimension", command::dimension}, {"displace_atoms", command::displace_atoms},
    {"fix", command::fix}, {"group", command::group}, {"if", command::condition_of_if}, {"include", command::include}, {"jump", command::jump},
    {"label", command::label}, {"lattice", command::lattice}, {"mass", command::mass}, {"minimize", command::minimize},
    {"neigh_modify", command::neigh_modify}, {"neighbor", command::neighbor}, {"next", command::next}, {"pair_coeff", command::pair_coeff},
    {"pair_modify", command::pair_modify}, {"pair_style", command::pair_style}, {"print", command::print}, {"quit", command::quit},
    {"read_data", command::read_data}, {"region", command::region}, {"reset_atom_ids", command::reset_atom_ids},
    {"reset_ids", command::reset_atom_ids}, {"reset_timestep", command::reset_timestep}, {"run", command::run}, {"set", command::set},
    {"special_bonds", command::special_bonds}, {"timestep", command::timestep}, {"uncompute", command::uncompute}, {"unfix", command::unfix},
    {"units", command::units}, {"variable", command::variable}, {"velocity", command::velocity}};

/// A reason, and the commands that have it.
using Reasons = std::vector<std::pair<const char*, std::vector<std::string>>>;

const Reasons ignored{
    {because::output, {"dump", "dump_modify", "undump", "thermo", "thermo_style", "thermo_modify", "restart", "write_data", "write_restart",
                       "write_dump", "write_coeff", "log", "echo", "info", "compute_modify", "fix_modify", "timers", "timer"}},
    {because::neighbours, {"atom_modify"}},
    {because::machine, {"processors", "comm_modify", "comm_style", "newton", "package", "suffix", "balance", "partition"}},
    {because::output, {"pair_write", "bond_write"}},
    {because::stepping, {"min_style", "min_modify", "run_style"}},
    {"elamin runs no other programs", {"shell"}}};

const Reasons refused{
    {"a restart file can be read by LAMMPS alone; let LAMMPS write it as a data file (write_data FILE) and read that", {"read_restart"}},
    {"positions from a dump are not taken; let LAMMPS write a data file (write_data FILE) and read that", {"read_dump", "rerun"}},
    {"there are no charges here", {"kspace_style"}},
    {"there are no dihedrals here", {"dihedral_style", "dihedral_coeff"}},
    {"there are no impropers here", {"improper_style", "improper_coeff"}},
    {"copies of a box are not made; let LAMMPS write them as a data file (write_data FILE) and read that", {"replicate"}},
    {"molecule templates are not taken here; let LAMMPS write what it makes of them as a data file (write_data FILE) and read that", {"molecule"}},
    {"elamin runs no other programs", {"python", "plugin"}},
    {"paths between states are found by [path] of elamin", {"neb"}},
    {because::cold, {"prd", "tad", "temper"}}};

std::string reason(const Reasons& reasons, const std::string& name) {
  for (const auto& [why, names] : reasons)
    if (contains(names, name)) return why;
  return "";
}

}  // namespace

Handler handler_of(const std::string& name) {
  const auto found = taken.find(name);
  return found == taken.end() ? nullptr : found->second;
}

std::string ignored_command(const std::string& name) { return reason(ignored, name); }
std::string refused_command(const std::string& name) { return reason(refused, name); }

std::vector<std::string> known_commands() {
  std::vector<std::string> all;
  for (const auto& [name, handler] : taken) all.push_back(name);
  for (const auto& [why, names] : ignored) all.insert(all.end(), names.begin(), names.end());
  return all;
}

}  // namespace elamin::script
