#include "study/describe.hpp"

#include "core/error.hpp"
#include "dynamics/timestep.hpp"
#include "energy/changes.hpp"
#include "input/conditions.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

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
    return std::count_if(kinds.of.begin(), kinds.of.end(), [&](int k) {
      const std::vector<int>& on = kinds.changes[k];
      return std::find(on.begin(), on.end(), change) != on.end();
    });
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
  if (!(limit.stable < std::numeric_limits<double>::infinity()))
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

}  // namespace elamin
