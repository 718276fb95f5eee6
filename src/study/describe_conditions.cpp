#include "core/error.hpp"
#include "core/find.hpp"
#include "core/suggest.hpp"
#include "dynamics/timestep.hpp"
#include "energy/changes.hpp"
#include "energy/wall_group.hpp"
#include "input/conditions.hpp"
#include "laws/frustum.hpp"
#include "model/entities.hpp"
#include "study/describe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace elamin {

namespace {

const char* word(const Scaling& s) { return s.rate == 0 ? "constant" : "scaled"; }

std::string describe_radial(const Load& l, const LoadTable& t) {
  return fmt::format("load on '{}': {:.10g} away from the axis on each of {} particles, {}\n", l.group, t.radial.value_or(0),
                     l.particles.size(), word(l.scaling));
}

// Critical pressures of the inextensible ring, (m² − 1) EI/R³ with m = 2.
std::string describe_pressure(const Problem& problem, const Model& model, const Pressure& p) {
  std::string text = fmt::format("pressure on '{}': p = {:.10g}, {}", p.of, p.pressure, word(p.scaling));
  if (!p.triangles.empty()) return text + fmt::format(", on {} triangles\n", p.triangles.size());
  for (const Structure& s : model.structures)
    for (const LoopTable& t : problem.loops)
      if (s.kind == "loop" && s.name == p.of && t.name == p.of && s.angle_type >= 0) {
        const double EI = model.angle_types[s.angle_type].stiffness * model.bond_types[s.bond_type].rest_length;
        text += fmt::format("; 3 EI/R^3 = {:.10g}", 3 * EI / (t.radius * t.radius * t.radius));
      }
  return text + "\n";
}

std::string describe_change(const Model& model, int change, const Kinds& bonds, const Kinds& angles) {
  const Change& c = model.changes[change];
  const auto count = [&](const Kinds& kinds) {
    return std::count_if(kinds.of.begin(), kinds.of.end(), [&](int k) { return contains(kinds.changes[k], change); });
  };
  std::string text = fmt::format("change of '{}', {}:", c.group, word(c.scaling));
  const auto part = [&](double by, const char* what, const Kinds& kinds, const char* of) {
    if (by != 0) text += fmt::format(" {} of {} {} times 1 + {:.10g} s,", what, count(kinds), of, by);
  };
  part(c.rest_length, "rest length", bonds, "bonds");
  part(c.bond_stiffness, "stiffness", bonds, "bonds");
  part(c.angle_stiffness, "stiffness", angles, "angles");
  text.back() = '\n';
  return text;
}

}  // namespace

std::string describe_conditions(const Problem& problem, const Model& model) {
  std::string text;
  for (std::size_t k = 0; k < model.loads.size(); ++k)
    if (problem.loads[k].radial) text += describe_radial(model.loads[k], problem.loads[k]);
  for (const Pressure& p : model.pressures) text += describe_pressure(problem, model, p);
  if (!model.changes.empty()) {
    const Kinds bonds = bond_kinds(model), angles = angle_kinds(model);
    for (std::size_t k = 0; k < model.changes.size(); ++k) text += describe_change(model, static_cast<int>(k), bonds, angles);
  }
  if (problem.path.parameter.empty()) return text;
  std::vector<std::string> scaled;
  const std::vector<Condition> conditions = conditions_of(problem);
  const std::vector<Scaling> scalings = scalings_in(model);
  for (std::size_t k = 0; k < conditions.size(); ++k)
    if (scalings[k].rate != 0) scaled.push_back(conditions[k].label());
  return text + "the load factor scales " + listed(scaled) + " alone\n";
}

std::string describe_timestep(Energy& energy, const State& state, double timestep) {
  const TimestepLimit limit = timestep_limit(energy, state);
  if (!(limit.stable < infinity))
    return fmt::format("timestep {:.10g}; nothing is stiff at the start: collisions bound it\n", timestep);
  return fmt::format("timestep {:.10g}; stable up to {:.6g} at the start (largest frequency {:.6g}), advised {:.6g}\n", timestep,
                     limit.stable, limit.frequency, limit.advised());
}

std::vector<std::string> idle_at_rest(const Problem& problem) {
  std::vector<std::string> lines;
  if (problem.in_time()) return lines;
  const auto idle = [&](const TablePlace& table, bool acts, const char* key) {
    if (!acts) return;
    const auto at = table.keys.find(key);
    const Place place = at == table.keys.end() ? Place{table} : at->second;
    lines.push_back(Mistake{problem.file, place.line, place.column, table.key + "." + key,
                                          "acts in dynamics only; in this study, of equilibria, it does nothing"}.sentence());
  };
  const auto damping = [&](const TablePlace& table, const DampingKeys& d) {
    idle(table, d.model != ContactDamping::Model::none, "damping"), idle(table, d.friction > 0, "friction");
  };
  for (const ContactTable& t : problem.contacts) {
    damping(t.place, t.damping);
    idle(t.place, t.rounded.mu > 0, "mu"), idle(t.place, t.rounded.c_n > 0, "c_n"), idle(t.place, t.rounded.c_t > 0, "c_t");
    idle(t.place, t.rounded.slip > 0, "slip");
  }
  for (const WallTable& t : problem.walls) {
    damping(t.place, t.damping);
    idle(t.place, t.c_n > 0, "c_n"), idle(t.place, t.place.written("c_t") && t.c_t.value_or(0) > 0, "c_t");
  }
  for (const ViscosityTable& t : problem.viscosity) idle(t.place, t.coefficient > 0, "coefficient");
  return lines;
}

namespace {

struct Overlaps {
  int count = 0;
  double deepest = 0;
  void add(const Touch& t) {
    if (t.gap < 0) ++count, deepest = std::max(deepest, -t.gap);
  }
  std::string text(const char* what) const {
    return count == 0 ? fmt::format("no {} at the start", what)
                      : fmt::format("{} {}{} at the start, the deepest {:.6g}", count, what, count == 1 ? "" : "s", deepest);
  }
};

// Smallest and largest radius of the particles of a group.
std::array<double, 2> radii(const Model& model, const std::vector<int>& particles) {
  std::array<double, 2> r{};
  for (std::size_t k = 0; k < particles.size(); ++k) {
    const double radius = model.diameter[particles[k]] / 2;
    r = k == 0 ? std::array{radius, radius} : std::array{std::min(r[0], radius), std::max(r[1], radius)};
  }
  return r;
}

// What is in force in dynamics only.
std::string describe_damping(const ContactDamping& d) {
  using Model = ContactDamping::Model;
  if (d.model == Model::none) return "";
  const std::pair<Model, const char*> names[]{{Model::velocity, "velocity"}, {Model::mass_velocity, "mass_velocity"},
                                              {Model::viscoelastic, "viscoelastic"}, {Model::tsuji, "tsuji"}};
  std::string text = "\n  in dynamics ";
  for (const auto& [model, name] : names)
    if (d.model == model) text += fmt::format("{} damping, coefficient {:.10g}", name, d.coefficient);
  if (d.friction > 0) text += fmt::format(", friction {:.10g}, tangential damping {:.10g} of the normal one", d.friction, d.tangential);
  return text;
}

// How a cohesion ends at its cutoff.
std::string end_of(const PairContact& c) {
  if (c.cutoff_style == CutoffStyle::smooth) return fmt::format(", smooth from {:.10g} on", c.inner_cutoff);
  return c.cutoff_style == CutoffStyle::shifted ? ", shifted" : "";
}

std::string describe_pair(const Model& model, const PairContact& c, int excluded, const Overlaps& overlaps) {
  std::string text = fmt::format("contact of '{}' and '{}': ", c.between[0], c.between[1]);
  const std::string left_out = excluded > 0 ? fmt::format("pairs up to {} bond{} apart are left out", excluded, excluded == 1 ? "" : "s")
                                            : std::string("bonded pairs too");
  if (c.law == PairContact::Law::lj)
    return text + fmt::format("lj, epsilon = {:.10g}, sigma = {:.10g}, cutoff {:.10g}{}; {}\n", c.epsilon, c.sigma, c.cutoff, end_of(c), left_out);
  const auto a = radii(model, c.particles[0]), b = radii(model, c.particles[1]);
  const auto effective = [](double r, double s) { return r + s > 0 ? r * s / (r + s) : 0.0; };
  const double least = effective(a[0], b[0]), most = effective(a[1], b[1]);
  if (c.hard) return text + fmt::format("hard, gap >= 0; {}\n  {}\n", left_out, overlaps.text("overlap"));
  text += fmt::format("hertz, E_eff = {:.10g}, r_eff = {:.10g}", c.effective_modulus, least);
  if (most > least) text += fmt::format(" to {:.10g}", most);
  return text + fmt::format("; {}{}\n  {}\n", left_out, describe_damping(c.damping), overlaps.text("overlap"));
}

std::string coordinates(const Vec3& v) { return fmt::format("[{:.10g}, {:.10g}, {:.10g}]", v[0], v[1], v[2]); }

std::string shape_of(const Region& r) {
  const auto along = [&](const std::string& name) {
    const std::string ends = std::isfinite(r.axial_lo) || std::isfinite(r.axial_hi)
                                 ? fmt::format(" from {:.10g} to {:.10g}", r.axial_lo, r.axial_hi) : std::string(" without ends");
    return fmt::format("a {} along {}{}", name, "xyz"[r.axis], ends);
  };
  switch (r.shape) {
    case Shape::plane: return fmt::format("a plane through {}, normal {}", coordinates(r.center), coordinates(r.normal));
    case Shape::block: return fmt::format("a block from {} to {}", coordinates(r.lo), coordinates(r.hi));
    case Shape::sphere: return fmt::format("a sphere of radius {:.10g}", r.radius);
    case Shape::cylinder: return along("cylinder") + fmt::format(", radius {:.10g}", r.radius);
    case Shape::cone: return along("cone") + fmt::format(", radii {:.10g} and {:.10g}", r.radius_lo, r.radius_hi);
  }
  return "";
}

// k_n, k_na and the rest of a rounded contact or of a wall of bodies.
std::string describe_kernel(const RoundedKernel& k) {
  std::string text = fmt::format("k_n = {:.10g}", k.normal);
  if (k.attraction > 0) text += fmt::format(", k_na = {:.10g}, cutoff {:.10g}", k.attraction, k.cutoff);
  return text + (k.form == RoundedKernel::Form::printed ? ", as printed" : "");
}

std::string describe_damping(const RoundedDamping& d) {
  std::string text;
  if (d.normal > 0 || d.tangential > 0)
    text += fmt::format("\n  in dynamics damping c_n = {:.10g}{}, c_t = {:.10g}", d.normal, d.apart ? " within the cutoff" : "", d.tangential);
  if (d.friction > 0) text += fmt::format("\n  in dynamics mu = {:.10g}{}", d.friction, d.slip > 0 ? fmt::format(", slip {:.10g}", d.slip) : "");
  return text;
}

std::string describe_body_wall(const Wall& wall) {
  return fmt::format("bodies {} {}{}", wall.lammps ? "by LAMMPS's rules," : "by a potential,", describe_kernel(wall.kernel),
                     describe_damping(wall.body_damping));
}

std::string describe_rounded(const RoundedPair& r, const Overlaps& overlaps) {
  const bool lammps = r.formulation == RoundedFormulation::lammps;
  std::string text = fmt::format("contact of '{}' and '{}': rounded, formulation {}, {}", r.between[0], r.between[1],
                                 lammps ? "lammps" : r.formulation == RoundedFormulation::multi ? "multi" : "closest", describe_kernel(r.kernel));
  if (lammps) return text + fmt::format(", delta_ua = {:.10g}{}\n", r.unit_area, describe_damping(r.damping));
  return text + fmt::format("{}\n  {}\n", describe_damping(r.damping), overlaps.text("overlap"));
}

std::string describe_wall(const Wall& wall, const State& state, const Overlaps& overlaps) {
  const Region region = wall_at(wall, state.load_factor).region.rounded();
  int wrong = 0;
  for (const int p : wall.particles) wrong += !on_side(region, wall.inside, state.at(p));
  const int open = static_cast<int>(std::count(region.open.begin(), region.open.end(), true));
  std::string text = fmt::format("wall '{}' of '{}': {} of {}, ", wall.name, wall.group,
                                 wall.inside ? "inside" : "outside", shape_of(region));
  if (wall.hard) text += "hard, gap >= 0";
  else if (!wall.particles.empty() || wall.bodies.empty())
    text += fmt::format("E_eff = {:.10g}, effective radius {}", wall.effective_modulus, wall.curved ? "with the wall's curvature" : "the particle's");
  if (!wall.bodies.empty()) text += (wall.particles.empty() ? "" : "; ") + describe_body_wall(wall);
  if (open > 0) text += fmt::format(", {} open face{}: both sides act", open, open == 1 ? "" : "s");
  text += describe_damping(wall.damping) + fmt::format("\n  {}", overlaps.text("overlap"));
  if (wrong > 0 && open == 0)
    text += fmt::format("; {} on the wrong side, feeling nothing", wrong == 1 ? "1 particle is" : std::to_string(wrong) + " particles are");
  return text + "\n";
}

}  // namespace

std::string describe_contacts(const Model& model, Energy& energy, const State& state) {
  std::vector<Overlaps> pairs(model.contacts.size()), rounded(model.rounded.size()), walls(model.walls.size());
  for (const Touch& t : energy.touches(state)) {
    if (t.wall >= 0) walls[t.wall].add(t);
    else if (is_body(model, std::max(t.particle, t.other))) rounded[energy.body_rules().table(t.particle, t.other)].add(t);
    else pairs[energy.contact_rules().hertz(t.particle, t.other)].add(t);
  }
  std::string text;
  for (std::size_t k = 0; k < pairs.size(); ++k)
    text += describe_pair(model, model.contacts[k], energy.contact_rules().excluded_bonds(static_cast<int>(k)), pairs[k]);
  for (std::size_t k = 0; k < rounded.size(); ++k) text += describe_rounded(model.rounded[k], rounded[k]);
  for (std::size_t k = 0; k < walls.size(); ++k) text += describe_wall(model.walls[k], state, walls[k]);
  return text;
}

}  // namespace elamin
