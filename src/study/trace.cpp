#include "study/trace.hpp"

#include <charconv>

namespace elamin {

namespace {

constexpr double largest_imposed = 0.3;        // distortion of a bond that supports may impose in one go

// Load factors that an expectation is about: at = "lambda=0.5".
std::vector<double> expected_stops(const Problem& problem) {
  std::vector<double> stops;
  const std::string_view prefix = "lambda=";
  for (const ExpectTable& e : problem.expect) {
    if (!e.at.starts_with(prefix)) continue;
    double value = 0;
    const char* last = e.at.data() + e.at.size();
    if (std::from_chars(e.at.data() + prefix.size(), last, value).ptr == last) stops.push_back(value);
  }
  return stops;
}

Outcome trace_energy(const Problem& problem, Newton& newton, const Sink& sink) {
  const State state = starting_state(problem, newton.energy());
  newton.energy().evaluate(state);
  Equilibrium e = assess(newton, state, {});
  e.point.report.residual = newton.energy().relative(newton.energy().gradient());
  e.point.report.status = Status::converged;
  sink.point(e.point, true);
  return {Status::converged, "energies and forces of the state in the file"};
}

// The last point of a path is known only when there is no next one.
Outcome trace_path(LoadSteps path, const Sink& sink) {
  std::optional<PathPoint> held;
  while (std::optional<PathPoint> point = path.next()) {
    if (held) sink.point(*held, false);
    held = std::move(point);
    for (const std::string& note : path.notes()) sink.note(note);
  }
  if (held) sink.point(*held, true);
  return {path.status(), path.why()};
}

// One state: the minimum at full load. Supports that move far are brought there in steps, so that nothing is torn or
// passes through what it is glued to.
Outcome trace_equilibrium(const Problem& problem, Newton& newton, const Sink& sink) {
  Energy& energy = newton.energy();
  State state = starting_state(problem, energy);
  const State before = energy.model().restart.value_or(energy.model().start);
  const Field moved = (state.position - before.position) + (state.tail - before.tail);
  double imposed = 0;
  for (const Bond& b : energy.model().bonds) {
    const auto [i, j] = b.particles;
    const double length = (before.at(j) - before.at(i)).hi.norm();
    if (length > 0) imposed = std::max(imposed, (moved.col(j) - moved.col(i)).norm() / length);
  }
  if (imposed > largest_imposed) {
    LoadSteps path(newton, energy.model().start, {.from = 0, .to = 1, .steps = 1 + static_cast<int>(imposed / largest_imposed), .when_unstable = WhenUnstable::jump, .start = {}, .stops = {}});
    std::optional<PathPoint> last;
    while (std::optional<PathPoint> point = path.next()) last = std::move(point);
    for (const std::string& note : path.notes()) sink.note(note);
    if (path.status() != Status::converged || !last) return {path.status(), path.why()};
    state = last->state;
  }
  const Report report = newton.minimise(state);
  Equilibrium e = assess(newton, state, report);
  sink.point(e.point, true);
  return {report.status, report.why};
}

}  // namespace

double starting_load_factor(const Problem& problem) {
  return problem.study == StudyType::path ? problem.path.start_lambda.value_or(problem.path.from) : 1.0;
}

State starting_state(const Problem& problem, const Energy& energy) {
  State state = energy.model().restart.value_or(energy.model().start);
  energy.kinematics().prescribe(state, starting_load_factor(problem));
  return state;
}

Outcome trace(const Problem& problem, Energy& energy, const Sink& sink) {
  Newton newton(energy, {.tolerance = problem.solver.tolerance, .max_iterations = problem.solver.max_iterations});
  switch (problem.study) {
    case StudyType::energy: return trace_energy(problem, newton, sink);
    case StudyType::equilibrium: return trace_equilibrium(problem, newton, sink);
    case StudyType::path: break;
  }
  const LoadStepOptions options{.from = problem.path.from, .to = problem.path.to, .steps = problem.path.steps,
                                .when_unstable = problem.path.when_unstable, .start = starting_load_factor(problem), .stops = expected_stops(problem)};
  return trace_path(LoadSteps(newton, energy.model().restart.value_or(energy.model().start), options), sink);
}

}  // namespace elamin
