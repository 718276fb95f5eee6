#include "study/landscape.hpp"

#include "core/interrupt.hpp"
#include "energy/hard_gaps.hpp"
#include "path/limits.hpp"
#include "results/landscape.hpp"
#include "results/stored_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace elamin {
namespace {

/// The state, if it is at one of these load factors, as one that is exactly there.
void add_if_at(const std::vector<double>& load_factors, State state, std::vector<State>& known) {
  for (const double at : load_factors) {
    if (std::abs(state.load_factor - at) > limits::landscape::same_load * std::max(std::abs(state.load_factor), std::abs(at))) continue;
    state.load_factor = at, known.push_back(state);
  }
}

}  // namespace

void PathOfLandscape::take(const PathPoint& point) {
  add_if_at(load_factors, point.state, known);
  for (const char* kind : {"limit:", "branch:", "contact:"})
    if (point.label.starts_with(kind)) events.push_back({point.label, point.state.load_factor});
}

Outcome trace_landscape(const Problem& problem, const Model& model, const PathOfLandscape& path, RunDirectory& results,
                        const std::function<void(const std::string&)>& tell, const std::function<void(const std::string&)>& warn) {
  const LandscapeTable& t = *problem.landscape;
  if (any_hard(model)) return {Status::not_converged, "landscapes with hard contacts are not explored; give the contacts a stiffness"};
  std::vector<State> known = path.known;
  if (!t.run.empty())
    for (const StoredState& s : read_run(t.run).states) add_if_at(path.load_factors, read_state(s, model), known);
  Energy energy(model);
  Newton newton(energy, solver_options(problem));
  const Landscapes all = explore(newton, known, path.events, path.load_factors, t, tell);
  if (interrupted()) return {Status::interrupted, "interrupted before the landscape was whole; elamin resume begins it anew"};
  for (const std::string& note : all.notes) warn(note);

  const Observables observables(problem, model);
  const auto observe = [&](const PathPoint& p) {
    energy.evaluate(p.state);
    std::vector<double> values = observables.evaluate(p.state, energy.forces(p.state), observed_touches(energy, p.state, observables));
    for (const auto& own : p.energy.own) values.push_back(own.second);
    return values;
  };
  const auto called = [&](const Landscape& l, const NodeImage& i) {
    const std::string label = l.node(i).label + (i.image > 0 ? fmt::format("-image-{}", i.image + 1) : "");
    return path.load_factors.size() == 1 ? label : fmt::format("{}@{}", label, l.load_factor);
  };
  for (const Landscape& l : all.at)
    for (const NodeImage& i : l.images(-1)) {
      const PathPoint& p = l.at(i).point;
      energy.evaluate(p.state);
      const std::vector<Touch> touches = observed_touches(energy, p.state, observables);
      results.add_state(called(l, i), p, touches);
      results.add_fields(called(l, i), model, p.state, fields_at(energy, p.state, touches));
    }
  const auto file = [&](const Landscape& l, const NodeImage& i) {
    return std::filesystem::relative(results.state_file(called(l, i)), results.directory()).string();
  };
  results.set_landscape(landscape_table(all, results.record().columns(), observe), landscape_json(all, file));
  for (const Landscape& l : all.at)
    if (l.nodes.empty())
      return {Status::not_converged, fmt::format("load factor {:.10g}: no equilibrium is known that a landscape could begin with; choose one that "
                                                 "the path meets", l.load_factor)};
  const Landscape& last = all.at.back();
  return {Status::converged, fmt::format("minima {}, saddles {} at load factor {:.10g}", last.minima(), last.saddles(), last.load_factor)};
}

}  // namespace elamin
