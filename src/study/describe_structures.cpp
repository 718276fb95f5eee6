#include "core/find.hpp"
#include "study/describe.hpp"

#include "core/dense.hpp"
#include "core/near_pairs.hpp"
#include "laws/rounded/closest.hpp"
#include "laws/section.hpp"
#include "model/entities.hpp"
#include "model/rigid_motion.hpp"
#include "model/sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace elamin {

namespace {

struct Range {
  double least = infinity, most = -least;
  void add(double v) { least = std::min(least, v), most = std::max(most, v); }
  bool empty() const { return least > most; }
  std::string text() const {
    return most - least <= 1e-12 * std::abs(most) ? fmt::format("{:.10g}", most) : fmt::format("{:.10g} to {:.10g}", least, most);
  }
};

// How an end of a row is held: no particle, one (pinned) or at least two (clamped) across its line.
struct End {
  int held = 0;
  std::string name() const { return held == 0 ? "free" : held == 1 ? "pinned" : "clamped"; }
};

End end_of(const Structure& s, const Kinematics& kinematics, bool last) {
  End end;
  for (; end.held < s.count; ++end.held) {
    const int p = last ? s.first + s.count - 1 - end.held : s.first + end.held;
    int free = 0;
    for (int c = 0; c < 3; ++c) free += kinematics.dof(p, c) >= 0;
    if (free > 1) break;
  }
  return end;
}

// Euler's factor: P = factor · π² EI/L².
double euler_factor(const End& a, const End& b) {
  const int least = std::min(std::min(a.held, b.held), 2), most = std::min(std::max(a.held, b.held), 2);
  if (least == 2) return 4;
  if (least == 1) return most == 2 ? 2.045748 : 1;
  return most == 2 ? 0.25 : 0;
}

// Rest angles of the structure's own angles.
std::string rest_of(const Model& model, const Structure& s) {
  Range rest;
  for (const Angle& a : model.angles)
    if (s.has(a.particles[0]) && s.has(a.particles[1]) && s.has(a.particles[2])) rest.add(model.angle_types[a.type].rest);
  if (rest.empty() || (rest.least == pi && rest.most == pi)) return "straight at rest";
  rest.least *= 180 / pi, rest.most *= 180 / pi;
  return "at rest " + rest.text() + " degrees";
}

// What the file of a structure's own values makes of its particles, bonds and angles.
std::string own_values(const Model& model, const Structure& s, const std::string& file) {
  Range diameter, density, K, q0, B;
  const auto own = [&](const auto& particles) { return std::all_of(particles.begin(), particles.end(), [&](int p) { return s.has(p); }); };
  for (int p = s.first; p < s.first + s.count; ++p) diameter.add(model.diameter[p]), density.add(model.density[p]);
  for (const Bond& b : model.bonds)
    if (own(b.particles)) K.add(model.bond_types[b.type].stiffness), q0.add(model.bond_types[b.type].rest_length);
  for (const Angle& a : model.angles)
    if (own(a.particles)) B.add(model.angle_types[a.type].stiffness);
  std::string text = fmt::format("  values of {}: diameter {}, density {}", file, diameter.text(), density.text());
  if (!K.empty()) text += fmt::format(", K = {}, q0 = {}", K.text(), q0.text());
  if (!B.empty()) text += fmt::format(", B = {}", B.text());
  return text + "\n";
}

// That file, "" if there is none.
std::string values_of(const Problem& problem, const Structure& s) {
  const auto in = [&](const auto& tables) {
    const auto* table = find_named(tables, s.name);
    return table ? table->values : "";
  };
  return s.kind == "beam" ? in(problem.beams) : s.kind == "loop" ? in(problem.loops) : s.kind == "sheet" ? in(problem.sheets)
                          : s.kind == "grains" ? in(problem.grains) : "";
}

std::string stiffnesses(const Problem& problem, const Model& model, const Structure& s) {
  if (!values_of(problem, s).empty()) return "";
  const BondType& bond = model.bond_types[s.bond_type];
  const double K = bond.stiffness, q0 = bond.rest_length, B = s.angle_type < 0 ? 0 : model.angle_types[s.angle_type].stiffness;
  const std::string bonds = fmt::format("  bond stiffness K = {:.10g}, rest length q0 = {:.10g}, EA = 2 K q0 = {:.10g}\n", K, q0, 2 * K * q0);
  if (s.angle_type < 0) return bonds + "  no angles: a chain that does not resist bending\n";
  return bonds + fmt::format("  angle stiffness B = {:.10g}, {}, EI = B q0 = {:.10g}\n", B, rest_of(model, s), B * q0);
}

// The line that a beam follows, "" for a straight one.
std::string line_of(const BeamTable& t) {
  if (t.through && t.through->size() > 2) return fmt::format("  through {} points, with {} corners\n", t.through->size(), t.through->size() - 2);
  if (t.points) return fmt::format("  along a curve of {} points, evenly by its length\n", t.points->size());
  if (!t.file.empty()) return "  along the curve of a file, evenly by its length\n";
  if (!t.rise && !t.angle) return "";
  const double chord = (*t.to - *t.from).norm();
  if (t.profile == Profile::sine) return fmt::format("  half a sine wave, rise {:.10g}, span {:.10g}\n", *t.rise, chord);
  const double half = t.angle ? *t.angle * pi / 360 : 2 * std::atan(2 * std::abs(*t.rise) / chord);
  return fmt::format("  arc of {:.10g} degrees, radius {:.10g}, rise {:.10g}\n", half * 360 / pi, chord / (2 * std::sin(half)),
                     chord / 2 * std::tan(half / 2));
}

std::string describe_beam(const Problem& problem, const Model& model, const Structure& s, const Kinematics& kinematics) {
  const BondType& bond = model.bond_types[s.bond_type];
  const double K = bond.stiffness, q0 = bond.rest_length, B = s.angle_type < 0 ? 0 : model.angle_types[s.angle_type].stiffness;
  std::string line;
  bool at_from = false, at_to = false;                 // clamped at the end itself
  if (const BeamTable* t = find_named(problem.beams, s.name); t && s.kind == "beam") {
    line = line_of(*t);
    at_from = t->clamped == ClampedEnds::from || t->clamped == ClampedEnds::both;
    at_to = t->clamped == ClampedEnds::to || t->clamped == ClampedEnds::both;
  }
  std::string text = line + stiffnesses(problem, model, s);
  const End a = end_of(s, kinematics, false), b = end_of(s, kinematics, true);
  if (a.held == s.count) return text + "  all of its particles are held\n";
  const int bonds = s.count - 1 - std::max(0, a.held - 1) - std::max(0, b.held - 1);
  // A clamp sits at the middle of its inner bond, unless the joint on its end is twice as stiff.
  const double length = (bonds + (a.held > 1 && !at_from ? 0.5 : 0.0) + (b.held > 1 && !at_to ? 0.5 : 0.0)) * q0;
  text += fmt::format("  ends: {}, {}; {} bonds can stretch", a.name(), b.name(), bonds);
  if (!values_of(problem, s).empty()) return text + "\n";
  text += fmt::format("; effective length {:.10g}\n", length);
  if (const double factor = line.empty() ? euler_factor(a, b) : 0; factor > 0 && B > 0)
    text += fmt::format("  Euler load {:.6g} pi^2 EI/L^2 = {:.10g}, strain {:.6g}\n", factor, factor * pi * pi * B * q0 / (length * length),
                        factor * pi * pi * B / (2 * K * length * length));
  return text;
}

std::string describe_loop(const Problem& problem, const Model& model, const Structure& s) {
  const double radius = find_named(problem.loops, s.name)->radius;
  return fmt::format("  radius {:.10g}, chord {:.10g}\n", radius, 2 * radius * std::sin(pi / s.count)) + stiffnesses(problem, model, s);
}

std::string describe_sheet(const Problem& problem, const Model& model, const Structure& s) {
  std::string text;
  for (const SheetTable& t : problem.sheets) {
    if (t.name != s.name) continue;
    switch (t.shape) {
      case SheetShape::rectangle:
        if (t.size) text += fmt::format("  rectangle, {:.10g} by {:.10g}", (*t.size)[0], (*t.size)[1]);
        break;
      case SheetShape::circle: text += fmt::format("  circle, radius {:.10g}", t.radius.value_or(0)); break;
      case SheetShape::cylinder:
        text += fmt::format("  cylinder, radius {:.10g}, height {:.10g}", t.radius.value_or(0), t.height.value_or(0));
    }
    text += fmt::format("; lattice at {:.10g} degrees, spacing {:.10g}", t.lattice_angle, t.spacing);
    if (t.shape != SheetShape::cylinder) continue;
    Sheet sheet;
    sheet.shape = Sheet::Shape::cylinder, sheet.radius = t.radius.value_or(0), sheet.height = t.height.value_or(0);
    sheet.spacing = t.spacing, sheet.lattice_angle = t.lattice_angle * (pi / 180);
    const Rolled r = rolled(sheet);
    text += fmt::format(", {:.10g} where it closes, ({}, {}) steps around", r.spacing, r.n1, r.n2);
  }
  Range lengths, rest;                                 // bonds of a cylinder are chords
  std::size_t bonds = 0;
  for (const Bond& b : model.bonds)
    if (s.has(b.particles[0]) && s.has(b.particles[1])) {
      lengths.add((model.start.at(b.particles[1]) - model.start.at(b.particles[0])).hi.norm());
      rest.add(model.bond_types[b.type].rest_length);
      ++bonds;
    }
  const double K = model.bond_types[s.bond_type].stiffness, B = s.angle_type < 0 ? 0 : model.angle_types[s.angle_type].stiffness;
  return text + fmt::format("; {} bonds of length {} as built\n", bonds, lengths.text()) +
         fmt::format("  bond stiffness K = {:.10g}, rest length q0 = {}, Y = 4 K/sqrt(3) = {:.10g}, nu = 1/3\n", K, rest.text(),
                     4 * K / std::sqrt(3.0)) +
         fmt::format("  angle stiffness B = {:.10g}, {}, D = 3 sqrt(3)/4 B = {:.10g}\n", B, rest_of(model, s), 0.75 * std::sqrt(3.0) * B);
}

std::string describe_grains(const Model& model, const Structure& s) {
  Range diameters;
  double mass = 0;
  bool known = true;
  for (int p = s.first; p < s.first + s.count; ++p) {
    diameters.add(model.diameter[p]);
    mass += model.mass(p), known = known && model.density[p] > 0;
  }
  return fmt::format("  diameters {}, {}\n", diameters.text(), known ? fmt::format("mass {:.10g}", mass) : "no density");
}

std::string stiffness_of(const std::optional<double>& bond, const std::optional<double>& axial) {
  return bond ? fmt::format("K = {:.10g}", *bond) : fmt::format("EA = {:.10g}", *axial);
}

// Bonds between two groups that are no structure's own.
std::string describe_connection(const ConnectTable& t, const Model& model) {
  std::vector<int> structure = structure_of(model);                        // that has bonds of its own
  for (int& s : structure)
    if (s >= 0 && model.structures[s].bond_type < 0) s = -1;
  std::array<std::vector<bool>, 2> member;
  for (int side = 0; side < 2; ++side) {
    member[side].resize(model.particles());
    if (const Group* group = find_named(model.groups, t.between[side]))
      for (const int p : group->particles) member[side][p] = true;
  }
  Range lengths;
  int bonds = 0;
  for (const Bond& b : model.bonds) {
    const auto [i, j] = b.particles;
    const bool joins = (member[0][i] && member[1][j]) || (member[0][j] && member[1][i]);
    const BondType& type = model.bond_types[b.type];
    const bool stiff = t.bond_stiffness ? type.stiffness == *t.bond_stiffness
                                        : std::abs(2 * type.stiffness * type.rest_length / *t.axial_stiffness - 1) < 1e-12;
    if (!joins || (structure[i] >= 0 && structure[i] == structure[j]) || !stiff) continue;
    lengths.add(model.bond_types[b.type].rest_length);
    ++bonds;
  }
  std::string text = fmt::format("connection of '{}' and '{}'", t.between[0], t.between[1]);
  if (t.within) text += fmt::format(" within {:.10g}", *t.within);
  if (t.bonds_per_particle) text += fmt::format(", each with its nearest {}", *t.bonds_per_particle);
  text += ": " + stiffness_of(t.bond_stiffness, t.axial_stiffness);
  if (bonds > 0) text += fmt::format(", {} bond{}, rest length {}", bonds, bonds == 1 ? "" : "s", lengths.text());
  if (t.angle_stiffness) text += fmt::format(", angles with B = {:.10g}", *t.angle_stiffness);
  return text + "\n";
}

}  // namespace

std::string describe_structures(const Problem& problem, const Model& model, const Kinematics& kinematics) {
  std::string text;
  for (const Structure& s : model.structures) {
    if (s.kind == "body") text += fmt::format("body '{}': id {}\n", s.name, model.bodies[s.first_body].id);
    else text += fmt::format("{} '{}': {} particles{}\n", s.kind, s.name, s.count, s.bodies > 0 ? fmt::format(", {} bodies", s.bodies) : "");
    if (s.bodies > 0) text += describe_bodies(model, s);
    if (const std::string file = values_of(problem, s); !file.empty()) text += own_values(model, s, file);
    if (s.kind == "grains") text += describe_grains(model, s);
    else if (s.bond_type < 0) continue;
    else if (s.kind == "loop") text += describe_loop(problem, model, s);
    else if (s.kind == "sheet") text += describe_sheet(problem, model, s);
    else text += describe_beam(problem, model, s, kinematics);
  }
  for (const ConnectTable& t : problem.connections) text += describe_connection(t, model);
  for (const BondsTable& t : problem.bonds)
    if (t.rule) text += describe_connection(by_rule(t), model);
    else
      text += fmt::format("bonds: {}{}\n", t.pairs ? fmt::format("{} of a list", t.pairs->size()) : "those of " + t.file,
                          t.bond_stiffness || t.axial_stiffness ? ", " + stiffness_of(t.bond_stiffness, t.axial_stiffness) : "");
  for (const AnglesTable& t : problem.angles)
    text += fmt::format("angles: {}{}\n",
                        t.triples ? fmt::format("{} of a list", t.triples->size())
                        : !t.over ? "those of " + t.file
                         : fmt::format("over the bonds that meet in '{}' at {:.10g} degrees or more", *t.over, t.least.value_or(0)),
                        t.angle_stiffness ? fmt::format(", B = {:.10g}", *t.angle_stiffness) : "");
  for (const GlueTable& t : problem.glue)
    if (const Group* g = find_named(model.groups, t.group))
      text += fmt::format("glue: '{}' carries {} particles of '{}'\n", t.body, g->particles.size(), t.group);
  return text;
}

std::string describe_motions(const Model& model) {
  constexpr std::size_t most = 10;
  const std::vector<RigidMotion> motions = free_rigid_motions(model, model.start);
  std::string text = motions.empty() ? "no rigid motion is free\n" : "";
  for (std::size_t k = 0; k < std::min(most, motions.size()); ++k) text += fmt::format("free rigid motion: {}\n", motions[k].name);
  if (motions.size() > most) text += fmt::format("and {} more\n", motions.size() - most);
  return text;
}

namespace {

std::string counted(std::size_t n, const char* one, const char* many) { return fmt::format("{} {}", n, n == 1 ? one : many); }

std::string corners_of(const RoundedShape& s) {
  const std::string rounding = fmt::format(", rounding radius {:.10g}", s.radius);
  if (s.vertices.size() == 1) return "a sphere" + rounding;
  if (s.vertices.size() == 2) return fmt::format("a rod of length {:.10g}", s.shortest_edge) + rounding;
  return fmt::format("{}, {}, {}", counted(s.vertices.size(), "vertex", "vertices"), counted(s.edges.size(), "edge", "edges"),
                     counted(s.faces.size(), "face", "faces")) + rounding;
}

// The body's shape and size; extents are along the axes of its frame, the rounding included.
std::string shape_lines(const RoundedShape& s) {
  Vec3 lo = s.vertices.front(), hi = lo;
  for (const Vec3& v : s.vertices) lo = lo.cwiseMin(v), hi = hi.cwiseMax(v);
  const Vec3 size = hi - lo + Vec3::Constant(2 * s.radius);
  return fmt::format("  {}; extents [{:.10g}, {:.10g}, {:.10g}], reach {:.10g} from the centre of mass, volume {:.10g}\n", corners_of(s), size[0],
                     size[1], size[2], s.bounding_radius(), mass_properties(s).volume);
}

std::string mass_line(const Body& b) {
  if (!(b.mass > 0)) return "  no mass\n";
  const Vec3 moments = symmetric_eigen(b.inertia).values;
  return fmt::format("  mass {:.10g}, principal moments of inertia {:.10g}, {:.10g}, {:.10g}\n", b.mass, moments[0], moments[1], moments[2]);
}

std::string place_line(const Pose& pose) {
  const Vec3 x = pose.position.hi;
  return fmt::format("  centre of mass at [{:.10g}, {:.10g}, {:.10g}]\n", x[0], x[1], x[2]);
}

}  // namespace

std::string describe_bodies(const Model& model, const Structure& s) {
  if (s.bodies == 1) {
    const Body& b = model.bodies[s.first_body];
    return shape_lines(model.shapes[b.shape]) + mass_line(b) + place_line(model.start.bodies[s.first_body]);
  }
  std::string text;
  for (std::size_t shape = 0; shape < model.shapes.size(); ++shape) {
    int count = 0;
    double least = infinity, most = 0;
    for (int b = s.first_body; b < s.first_body + s.bodies; ++b)
      if (model.bodies[b].shape == static_cast<int>(shape))
        ++count, least = std::min(least, model.bodies[b].mass), most = std::max(most, model.bodies[b].mass);
    if (count == 0) continue;
    const std::string mass = most == 0       ? "no mass"
                             : least == most ? fmt::format("mass {:.10g}", most)
                                             : fmt::format("masses {:.10g} to {:.10g}", least, most);
    text += fmt::format("  {} of one shape, {}:\n  {}", counted(count, "body", "bodies"), mass, shape_lines(model.shapes[shape]));
  }
  return text;
}

std::vector<std::string> deep_overlaps(const Model& model, Energy& energy, const State& state) {
  constexpr std::size_t most = 10;
  constexpr double deep = 0.25;                               // of the smaller diameter: far beyond what a law of contact means
  std::set<IndexPair> particles;
  const auto overlap = [&](int i, int j) { return (model.diameter[i] + model.diameter[j]) / 2 - (state.at(j) - state.at(i)).hi.norm(); };
  const auto take = [&](int i, int j) {
    if (overlap(i, j) > deep * std::min(model.diameter[i], model.diameter[j])) particles.insert({std::min(i, j), std::max(i, j)});
  };
  for (const Touch& t : energy.touches(state))
    if (t.other >= 0 && std::max(t.particle, t.other) < model.particles()) take(t.particle, t.other);
  std::vector<double> radii(model.diameter.begin(), model.diameter.end());
  for (double& r : radii) r /= 2;
  for (const Bond& b : model.bonds) radii[b.particles[0]] = radii[b.particles[1]] = 0;
  for (const Glued& g : model.glued) radii[g.particle] = 0;
  for (const auto& [i, j] : near_pairs(state.position, radii, [](int, int) { return true; })) take(i, j);
  std::vector<std::string> lines;
  for (const auto& [i, j] : particles)
    if (lines.size() < most)
      lines.push_back(fmt::format("{} and {} overlap by {:.3g} of a diameter at the start; no law of contact means much there", called(model, i), called(model, j),
                                  overlap(i, j) / std::min(model.diameter[i], model.diameter[j])));
  std::size_t count = particles.size();
  const BodyRules& rules = energy.body_rules();
  for (const auto& [i, j] : energy.body_neighbours().pairs())
    if (cores_overlap(rules.body(i, state), rules.body(j, state)) && ++count <= most)
      lines.push_back(fmt::format("the cores of {} and {} overlap, deeper than their rounding; no law of rounded bodies means much there",
                                  called(model, i), called(model, j)));
  if (count > most) lines.push_back(fmt::format("and {} more pairs overlap", count - most));
  return lines;
}

}  // namespace elamin
