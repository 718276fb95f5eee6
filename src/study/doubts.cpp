// What a problem is told to be doubtful in.
#include "study/describe.hpp"

#include "input/lammps.hpp"
#include "model/entities.hpp"
#include "study/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace elamin {

namespace {

/// Numbers that look like pascals beside lengths that look like millimetres, and gravity in m/s² beside lengths in millimetres: in metres
/// hardly anything soft (below 1e9 Pa) is half a metre thick, and nothing at all 20; in N/mm² the soft has moduli below 1e3.
void mixed_units(const Problem& problem, std::vector<std::string>& lines) {
  const auto by_default = [](const auto& t) {
    if constexpr (requires { t.particles; }) return t.diameter;
    else return t.spacing;
  };
  const auto look = [&](const auto& tables, const char* kind) {
    for (const auto& t : tables) {
      const double modulus = t.youngs_modulus.value_or(0);
      const double thick = t.thickness.value_or(by_default(t));
      if ((modulus >= 1e5 && thick >= 0.5 && modulus < 1e9) || (modulus >= 1e9 && thick >= 20))
        lines.push_back(fmt::format("{} '{}' has a modulus of {:.4g} and a thickness of {:.4g}: as pascals and millimetres these do not "
                                    "go together. Units have to be of one system: with lengths in mm and forces in N, 1e6 Pa are 1",
                                    kind, t.name, modulus, thick));
      else if (modulus > 0 && modulus < 1e3 && thick >= 0.5)
        for (const GravityTable& g : problem.gravity)
          if (const double size = g.acceleration.norm(); size >= 9.75 && size <= 9.85)
            lines.push_back(fmt::format("{} '{}' has a modulus of {:.4g} and a thickness of {:.4g}, and gravity is {:.4g}: with lengths in "
                                        "mm that is 9810 mm/s²", kind, t.name, modulus, thick, size));
    }
  };
  look(problem.beams, "beam"), look(problem.loops, "loop"), look(problem.sheets, "sheet");
}

/// Residuals are told from rounding to 1e-10 of the largest force: what is softer by more than that is at rest anywhere.
void stiffness_ratio(const Model& model, std::vector<std::string>& lines) {
  constexpr double most = 1e10;
  double soft = infinity, stiff = 0;
  for (const Bond& b : model.bonds)
    if (const double k = model.bond_types[b.type].stiffness; k > 0) soft = std::min(soft, k), stiff = std::max(stiff, k);
  if (stiff > most * soft)
    lines.push_back(fmt::format("the stiffest bond, K = {:.4g}, is {:.1g} times as stiff as the softest, K = {:.4g}: of the 16 digits of a "
                                "force {:.0f} are left to the soft one",
                                stiff, stiff / soft, soft, std::max(0.0, 16 - std::log10(stiff / soft))));
}

}  // namespace

std::vector<std::string> doubts(const Problem& problem, const Model& model) {
  std::vector<std::string> lines = idle_at_rest(problem);
  mixed_units(problem, lines);
  stiffness_ratio(model, lines);
  for (const std::string& warning : lammps_remarks(problem).warnings) lines.push_back(warning);
  for (const ExpectTable& e : problem.expect)
    if (e.value != 0 && e.rtol * std::abs(e.value) + e.atol >= std::abs(e.value))
      lines.push_back(Mistake{problem.file, e.place.line, e.place.column, e.place.key,
                              fmt::format("the tolerance on {} is as large as the value: nothing at all would meet it, too", e.observable)}
                          .sentence());
  const auto remedy = [&](const Structure& s) {
    const auto x = model.start.position.middleCols(s.first, s.count);
    const Vec3 sides = x.rowwise().maxCoeff() - x.rowwise().minCoeff();
    for (const int c : {1, 2, 0})
      if (sides[c] == 0)
        return fmt::format("; if it stays in its plane, write plane = \"{}\", which gives angles a sign", std::array{"yz", "xz", "xy"}[c]);
    return std::string();
  };
  for (const Structure& s : model.structures) {
    const auto bent = [&](const Angle& a) {
      return s.has(a.particles[1]) && model.angle_types[a.type].rest != pi && model.angle_types[a.type].stiffness != 0;
    };
    const auto slack = [&](const Bond& b) { return s.has(b.particles[0]) && model.bond_types[b.type].stiffness == 0; };
    if (!model.plane_normal && std::any_of(model.angles.begin(), model.angles.end(), bent))
      lines.push_back(fmt::format("{} '{}' has rest angles that are not straight; in space an angle has no sign and is at rest on either "
                                  "side: a path may end where the structure becomes flat{}", s.kind, s.name, remedy(s)));
    if (const auto first = std::find_if(model.bonds.begin(), model.bonds.end(), slack); first != model.bonds.end())
      lines.push_back(fmt::format("{} of the bonds of {} '{}' have stiffness 0 and hold nothing; the first joins {} and {}",
                                  std::count_if(model.bonds.begin(), model.bonds.end(), slack), s.kind, s.name,
                                  called(model, first->particles[0]), called(model, first->particles[1])));
  }
  return lines;
}

std::vector<std::string> driven_together(const Problem& problem, const Model& model) {
  const bool path = problem.follows_path();
  if (model.contacts.empty() || !problem.stages.empty() || !(path || problem.study == StudyType::equilibrium)) return {};
  const Kinematics kinematics(model);
  const auto fixed = [&](int p) { return kinematics.dof(p, 0) < 0 && kinematics.dof(p, 1) < 0 && kinematics.dof(p, 2) < 0; };
  double fastest = 0, smallest = infinity;
  for (int p = 0; p < model.particles(); ++p)
    if (const double v = kinematics.drive(p).norm(); v > 0 && fixed(p))
      fastest = std::max(fastest, v), smallest = std::min(smallest, model.diameter[p]);
  if (fastest == 0) return {};
  constexpr double deep = 0.25;                              // of the smaller diameter
  const double from = path ? starting_load_factor(problem) : 0, to = path ? problem.path.to : 1;
  const double most = std::max(1.0, std::min(200.0, 2e6 / model.particles()));
  const double wanted = std::abs(to - from) * 2 * fastest / (deep * smallest);
  const int count = static_cast<int>(std::clamp(std::ceil(wanted), 1.0, most));
  std::vector<std::string> lines;
  std::set<IndexPair> told;
  Energy energy(model);                                      // of its own: the run's begins where the run does
  State state = model.restart.value_or(model.start);
  for (int k = 1; k <= count; ++k) {
    const double load_factor = from + (to - from) * k / count;
    kinematics.prescribe(state, load_factor);
    for (const Touch& t : energy.touches(state)) {
      if (t.other < 0 || std::max(t.particle, t.other) >= model.particles() || !fixed(t.particle) || !fixed(t.other)) continue;
      if (kinematics.drive(t.particle) == kinematics.drive(t.other)) continue;
      const double overlap = -t.gap / std::min(model.diameter[t.particle], model.diameter[t.other]);
      if (overlap <= deep || !told.insert({t.particle, t.other}).second || told.size() > 1) continue;
      lines.push_back(fmt::format("supports drive {} and {} into each other: at load factor {:.3g} they overlap by {:.2g} of a diameter, and "
                                  "neither can give way", called(model, t.particle), called(model, t.other), load_factor, overlap));
    }
  }
  if (told.size() > 1) lines.push_back(fmt::format("and {} more pairs of driven particles", told.size() - 1));
  return lines;
}

std::vector<std::string> warnings(const Problem& problem, const Model& model, Energy& energy, const State& state) {
  std::vector<std::string> lines = doubts(problem, model);
  for (const auto& more : {deep_overlaps(model, energy, state), driven_together(problem, model)})
    lines.insert(lines.end(), more.begin(), more.end());
  return lines;
}

}  // namespace elamin
