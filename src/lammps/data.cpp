#include "lammps/data.hpp"
#include "lammps/rows.hpp"

#include "core/suggest.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <numeric>
#include <set>
#include <sstream>

namespace elamin {
namespace {

/// Index of an id in a sorted list, or -1.
int index_of(const std::vector<int>& ids, int id) {
  const auto it = std::lower_bound(ids.begin(), ids.end(), id);
  return it != ids.end() && *it == id ? static_cast<int>(it - ids.begin()) : -1;
}

/// Index of the body with that id, or −1.
int body_of(const LammpsData& data, int id) {
  const auto it = std::lower_bound(data.bodies.begin(), data.bodies.end(), id, [](const Body& b, int i) { return b.id < i; });
  return it != data.bodies.end() && it->id == id ? static_cast<int>(it - data.bodies.begin()) : -1;
}

/// Two forms have one shape if these are equal.
std::vector<double> key_of(const BodyForm& form) {
  std::vector<double> key{form.diameter, static_cast<double>(form.core.vertices.size()), static_cast<double>(form.core.edges.size())};
  for (const Vec3& x : form.core.vertices) key.insert(key.end(), x.begin(), x.end());
  for (const auto& e : form.core.edges) key.insert(key.end(), e.begin(), e.end());
  for (const auto& f : form.core.faces) key.push_back(static_cast<double>(f.size())), key.insert(key.end(), f.begin(), f.end());
  return key;
}

/// Rows by type from 0, each type once; a type's row is -1 if it is missing.
template <class Row>
std::vector<int> by_type(LammpsLines& lines, const std::vector<Row>& rows, const std::string& section) {
  int types = 0;                                    // rows are as many as the header announces, types at most as many
  for (const Row& r : rows) types = std::max(types, r.type);
  std::vector<int> row(static_cast<std::size_t>(types), -1);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    int& place = row[rows[i].type - 1];
    if (place >= 0)
      lines.mistake(rows[i].line, 1, section, fmt::format("type {} stands twice; the first is on line {}", rows[i].type, rows[place].line));
    else
      place = static_cast<int>(i);
  }
  return row;
}

/// False if an id stands twice: then nothing can be said of what refers to it.
bool take_atoms(LammpsLines& lines, LammpsRows& rows, LammpsData& data) {
  const std::size_t n = rows.atoms.size();
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return rows.atoms[a].id < rows.atoms[b].id; });
  const auto bodies = std::count_if(rows.atoms.begin(), rows.atoms.end(), [](const AtomRow& a) { return a.is_body; });
  data.position.resize(3, static_cast<Eigen::Index>(n) - bodies), data.body_position.resize(3, bodies);
  Eigen::Index particle = 0, body = 0;
  bool tilted = false, unique = true;
  for (std::size_t i = 0; i < n; ++i) {
    const AtomRow& a = rows.atoms[order[i]];
    const auto& image = rows.images[order[i]];
    if (i > 0 && rows.atoms[order[i - 1]].id == a.id) {
      unique = false;
      lines.mistake(a.line, 1, "Atoms: id", fmt::format("{} stands twice; the first is on line {}", a.id, rows.atoms[order[i - 1]].line));
    }
    if (a.is_body) {
      data.bodies.push_back({-1, a.id, a.type, a.mass, Mat3::Zero()});
    } else {
      data.id.push_back(a.id), data.type.push_back(a.type), data.molecule.push_back(a.molecule);
      data.diameter.push_back(a.diameter), data.density.push_back(a.density);
    }
    Vec3 x = a.position;
    for (int c = 0; c < 3; ++c)
      if (image[c] != 0) x[c] += image[c] * (rows.hi[c] - rows.lo[c]);
    if (!x.allFinite()) lines.mistake(a.line, 1, "Atoms: image flag", "the unwrapped position is not finite");
    if (!tilted && image != std::array<int, 3>{} && rows.tilt != Vec3::Zero()) {
      tilted = true;
      lines.mistake(a.line, 1, "Atoms: image flag", "a tilted box (xy xz yz) is not available with image flags other than 0");
    }
    if (a.is_body) data.body_position.col(body++) = x;
    else data.position.col(particle++) = x;
  }
  return unique;
}

void take_velocities(LammpsLines& lines, const LammpsRows& rows, LammpsData& data) {
  std::map<int, int> from;                          // line that gave it
  data.velocity = data.angular_velocity = Field::Zero(3, data.position.cols());
  data.body_velocity = data.angular_momentum = Field::Zero(3, data.body_position.cols());
  for (const VelocityRow& v : rows.velocities) {
    const int i = index_of(data.id, v.id), b = body_of(data, v.id);
    const auto tell = [&](const std::string& what) { lines.mistake(v.line, 1, "Velocities: id", what); };
    if (i < 0 && b < 0) {
      tell(fmt::format("there is no atom {}", v.id));
    } else if (const auto [first, fresh] = from.emplace(v.id, v.line); !fresh) {
      tell(fmt::format("{} stands twice; the first is on line {}", v.id, first->second));
    } else if (i >= 0) {
      data.velocity.col(i) = v.velocity, data.angular_velocity.col(i) = v.angular_velocity;
    } else {
      if (!v.long_row) tell(fmt::format("{} is a body; expected are 7 columns: id, velocity and angular momentum", v.id));
      data.body_velocity.col(b) = v.velocity, data.angular_momentum.col(b) = v.angular_velocity;
    }
  }
}

/// Gives every body its form; equal ones share a shape.
void take_forms(LammpsLines& lines, LammpsRows& rows, LammpsData& data) {
  std::map<std::vector<double>, int> known;
  std::vector<int> from(data.bodies.size(), 0);     // line that gave it
  for (BodyRow& row : rows.bodies) {
    const int b = body_of(data, row.id);
    const auto tell = [&](const std::string& what) { lines.mistake(row.line, 1, "Bodies: id", what); };
    if (b < 0) {
      tell(index_of(data.id, row.id) < 0 ? fmt::format("there is no atom {}", row.id) : fmt::format("atom {} is a particle", row.id));
    } else if (from[b] > 0) {
      tell(fmt::format("{} stands twice; the first is on line {}", row.id, from[b]));
    } else {
      from[b] = row.line;
      data.bodies[b].inertia = row.form.inertia;
      const auto [place, fresh] = known.emplace(key_of(row.form), static_cast<int>(data.shapes.size()));
      if (fresh) data.shapes.push_back(rounded_shape(row.form.core, row.form.diameter / 2));
      data.bodies[b].shape = place->second;
    }
  }
  for (const AtomRow& a : rows.atoms)
    if (a.is_body && from[body_of(data, a.id)] == 0)
      lines.mistake(a.line, 1, "Atoms: id", fmt::format("body {} is missing in the section Bodies", a.id));
}

/// Bonds (2 sites) or angles (3): ids to indices, types from 0, every one with coefficients.
template <int sites, class Element>
void take_topology(LammpsLines& lines, const LammpsRows& rows, const LammpsReading& how, const std::vector<TopologyRow>& from,
                   const std::string& kind, std::size_t types, const LammpsData& data, std::vector<Element>& to) {
  const std::string section = kind + "s", coefficients = kind + " Coeffs";
  const bool coefficients_known = !how.coefficients_may_lack && (rows.sound(coefficients) || !rows.sections.count(coefficients));
  std::set<int> missing;                            // types
  int first = 0;                                    // line that has one
  for (const TopologyRow& r : from) {
    Element e;
    e.type = r.type - 1;
    for (int k = 0; k < sites; ++k) {
      e.particles[k] = index_of(data.id, r.id[k]);
      if (e.particles[k] < 0)
        lines.mistake(r.line, r.column[k], section + ": id",
                      body_of(data, r.id[k]) < 0 ? fmt::format("there is no atom {}", r.id[k])
                                                 : fmt::format("atom {} is a body, which has no bonds and angles", r.id[k]));
      for (int l = 0; l < k; ++l)
        if (r.id[l] == r.id[k])
          lines.mistake(r.line, r.column[k], section + ": id", fmt::format("atom {} stands twice in it", r.id[k]));
    }
    const bool lacks = coefficients_known && static_cast<std::size_t>(r.type) > types;
    if (lacks && missing.insert(r.type).second && missing.size() == 1) first = r.line;
    to.push_back(e);
  }
  if (missing.empty()) return;
  constexpr std::size_t most = 10;
  const std::vector<int> some(missing.begin(), std::next(missing.begin(), static_cast<std::ptrdiff_t>(std::min(most, missing.size()))));
  const std::string more = missing.size() > most ? fmt::format(" and {} more", missing.size() - most) : "";
  const bool one = missing.size() == 1;
  lines.mistake(first, 1, section + ": type",
                fmt::format("{} {}{} {} no coefficients; the section {} gives them, or {}_coefficients in [lammps]", one ? "type" : "types",
                            fmt::join(some, ", "), more, one ? "has" : "have", coefficients, kind == "Bond" ? "bond" : "angle"));
}

/// What the file holds and a model has no use for, and coefficients that were rounded.
void take_notes(const LammpsLines& lines, const LammpsRows& rows, const std::string& file, LammpsData& data) {
  for (const std::string& section : rows.passed_over)
    data.notes.push_back(fmt::format("{}: the section {} is passed over{}", file, in_quotes(section),
                                     section.starts_with("Pair") ? "; contacts are given by [[contact]]" : ""));
  if (rows.charged) data.notes.push_back(file + ": charges are dropped; nothing here depends on them");
  if (rows.most_digits == 0 || rows.most_digits > 6 || !lines.title().starts_with("LAMMPS data file via write_data")) return;
  data.doubt = file + ": its coefficients have six digits, as LAMMPS's write_data rounds them; a rest length that is off by 1e-6 of "
                      "itself is a strain that matters beside a buckling strain; give those of the script as bond_coefficients and "
                      "angle_coefficients in [lammps]";
}

}  // namespace

LammpsData read_lammps_data(const std::string& file, const LammpsReading& how) {
  if (const std::string what = how.text ? "" : other_format(file); !what.empty()) throw InputError({Mistake{file, 0, 0, {}, what}});
  LammpsLines lines = how.text ? LammpsLines(file, *how.text) : LammpsLines(file, "LAMMPS data file", " (write_data, not write_restart)");
  LammpsRows rows = read_lammps_rows(lines, how);
  LammpsData data;
  for (const auto& c : how.bond_coefficients) data.bond_types.push_back({c[0], c[1]});
  for (const auto& c : how.angle_coefficients)
    data.angle_types.push_back({c[0], c.size() == 1 || c[1] == 180 ? pi : c[1] * pi / 180});
  if (rows.sound("Bond Coeffs"))
    for (const int i : by_type(lines, rows.bond_coefficients, "Bond Coeffs")) {
      const CoefficientRow r = i < 0 ? CoefficientRow{} : rows.bond_coefficients[i];
      data.bond_types.push_back({r.stiffness, r.rest});
    }
  if (rows.sound("Angle Coeffs"))
    for (const int i : by_type(lines, rows.angle_coefficients, "Angle Coeffs")) {
      data.angle_types.push_back(i < 0 ? AngleType{0} : AngleType{rows.angle_coefficients[i].stiffness, rows.angle_coefficients[i].rest});
    }
  if (rows.sound("Atoms")) {
    if (rows.atoms.empty())
      lines.mistake(rows.sections["Atoms"].line, 1, "Atoms", "there are none; at least one is needed");
    if (take_atoms(lines, rows, data)) {
      take_topology<2>(lines, rows, how, rows.bonds, "Bond", data.bond_types.size(), data, data.bonds);
      take_topology<3>(lines, rows, how, rows.angles, "Angle", data.angle_types.size(), data, data.angles);
      if (rows.sound("Velocities")) take_velocities(lines, rows, data);
      if (rows.sound("Bodies") || (rows.count("bodies") == 0 && !data.bodies.empty())) take_forms(lines, rows, data);
    }
  }
  data.mass.assign(data.id.size(), 0.0);
  if (rows.sound("Masses")) {
    const std::vector<int> mass = by_type(lines, rows.masses, "Masses");
    for (std::size_t i = 0; i < data.id.size(); ++i)
      if (static_cast<std::size_t>(data.type[i]) <= mass.size() && mass[data.type[i] - 1] >= 0)
        data.mass[i] = rows.masses[mass[data.type[i] - 1]].mass;
  }
  const auto types = [&](const char* of) { return std::clamp(rows.count(of), 0, 1000000); };
  data.header = {rows.lo, rows.hi, types("atom types"), types("bond types"), types("angle types")};
  take_notes(lines, rows, file, data);
  lines.finish();
  return data;
}

std::vector<std::pair<std::string, int>> atom_type_labels(const std::string& file) {
  std::vector<std::pair<std::string, int>> labels;
  std::ifstream in(file, std::ios::binary);
  std::string line, word;
  const auto is = [&](std::string_view name) {
    return line.starts_with(name) && line.find_first_not_of(" \t\r", name.size()) == std::string::npos;
  };
  while (std::getline(in, line) && !line.starts_with("Atoms"))
    if (is("Atom Type Labels")) {
      int type = 0;
      while (std::getline(in, line)) {
        std::istringstream row(line);
        if (row >> type >> word && type > 0) labels.emplace_back(word, type);
        else if (line.find_first_not_of(" \t\r") != std::string::npos) break;
      }
      return labels;
    }
  return labels;
}

}  // namespace elamin
