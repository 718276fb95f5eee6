#include "input/lammps_table.hpp"

#include "core/suggest.hpp"
#include "lammps/data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace elamin {

void describe(Keys& keys, LammpsTable& t) {
  keys.about("Particles, bonds, angles (with their coefficients) and bodies from LAMMPS data files, or all that a LAMMPS input script makes. "
             "Atom type 2 is the group \"type2\", and its label one too; ids are LAMMPS's own.");
  keys.may_file("data", t.data, "the data file");
  keys.may_file("bodies", t.bodies, "a data file of bodies beside it");
  keys.may_file("input", t.input, "a LAMMPS input script instead: its particles, and as tables before those of this file what is in force in it");
  keys.may("particles_only", t.particles_only, "of the script only the particles, bonds, angles and bodies");
  keys.may("atom_style", t.atom_style, "LAMMPS's, where the comment behind \"Atoms\" does not say it");
  keys.one_or_more("ignore", t.ignore, "sections that are passed over, as [\"Dihedrals\", \"Impropers\"], with their coefficients");
  keys.may("bond_coefficients", t.bond_coefficients, "[[K, r0], …] of the bond types from 1, instead of those in the file");
  keys.may("angle_coefficients", t.angle_coefficients,
           "[[B], …] of the angle types, U = B (1 + cos θ), or [B, θ₀] with U = B (1 − cos(θ − θ₀)), θ₀ in degrees");
  keys.one_at_least({"data", "bodies", "input"}, "give data = \"case.data\"");
}

bool has_particles(const LammpsTable& t) { return !t.data.empty() || (t.script && !t.script->particles.empty()); }

LammpsReading reading_of(const LammpsTable& t) {
  using Rows = std::vector<std::vector<double>>;
  LammpsReading how{t.atom_style, t.ignore.value_or(std::vector<std::string>()), t.bond_coefficients.value_or(Rows()),
                    t.angle_coefficients.value_or(Rows())};
  if (t.script) how.text = &t.script->particles;
  return how;
}

void check_lammps(LammpsTable& t, Mistakes& mistakes) {
  if (!t.input.empty() && (!t.script || t.script->files.front() != t.input) && !t.place.broken)
    mistakes.add(t.place, "input", "is read with the file, before settings and sweeps change it; they cannot change the script");
  if (t.particles_only && t.input.empty()) mistakes.add(t.place, "particles_only", "is of a script; give input = \"in.lmp\"");
  const auto row = [&](const char* key, const std::vector<double>& c, std::size_t least, const char* wanted) {
    const bool good = c.size() >= least && c.size() <= 2 && std::all_of(c.begin(), c.end(), [](double x) { return x >= 0; }) &&
                      (least == 2 || c.size() < 2 || c[1] <= 180);
    if (!good) mistakes.add(t.place, key, fmt::format("of a type must be {}, is [{}]", wanted, fmt::join(c, ", ")));
    return good;
  };
  for (const auto& c : reading_of(t).bond_coefficients)
    if (!row("bond_coefficients", c, 2, "two numbers that are not negative, [K, r0]")) break;
  for (const auto& c : reading_of(t).angle_coefficients)
    if (!row("angle_coefficients", c, 1, "[B], or [B, θ₀] with θ₀ from 0 to 180 degrees, B not negative")) break;
  for (const std::string& section : reading_of(t).ignore)
    if (section == "Atoms" || section == "Bodies")
      mistakes.add(t.place, "ignore", in_quotes(section) + " cannot be passed over; without it there is nothing");
  if (!t.place.broken) t.labels = atom_type_labels(t.data);
}

}  // namespace elamin
