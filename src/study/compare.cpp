#include "study/compare.hpp"

#include "core/error.hpp"
#include "core/heartbeat.hpp"
#include "core/interrupt.hpp"
#include "core/parallel.hpp"
#include "core/say.hpp"
#include "core/timing.hpp"
#include "energy/hard_gaps.hpp"
#include "model/entities.hpp"
#include "input/read.hpp"
#include "results/json.hpp"
#include "results/terminal.hpp"
#include "results/summary.hpp"
#include "study/imperfection.hpp"
#include "study/run.hpp"
#include "study/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

std::string refusal_of(const Problem& problem, const Model& model) {
  Energy energy(model);
  if (problem.solver.method == "fire")
    return any_hard(model) ? "damped dynamics knows no hard contacts; use \"ipopt\", or an elastic contact" : "";
  return refusal(solver_method(problem), energy);
}

// The largest coordinate of the difference, turns in units of length, relative to the extent.
double difference(const Model& model, const State& a, const State& b) {
  const Field u = Kinematics(model).displacement(a, b);
  const double size = sides_of(b).norm() + (model.particles() > 0 ? 0 : largest_size(model)), most = u.size() ? u.cwiseAbs().maxCoeff() : 0.0;
  return size > 0 ? most / size : most;
}

struct Ran {
  Compared row;
  State state;
};

Ran run(const Problem& problem, const Model& model, const std::optional<StateSupplement>& stored, double limit) {
  Ran ran;
  Compared& row = ran.row;
  row.method = problem.solver.method;
  row.refused = refusal_of(problem, model);
  if (!row.refused.empty()) return ran;
  const Sink sink{
      .stage = [](const Stage&, Energy&) {},
      .point = [&](const PathPoint& point, bool) {
        ++row.points;
        row.iterations += point.report.iterations, row.evaluations += point.report.evaluations;
        row.energy = point.energy.total(), row.residual = point.report.residual;
        ran.state = point.state;
      },
      .modes = [](const PathPoint&, const std::vector<Mode>&) {}, .note = [](const std::string&) {},
      .moment = [](const Moment&, bool) {}, .progress = [](const std::string&, double) {}};
  const Stopwatch watch;
  Progress progress(stderr, is_terminal(stderr) ? Progress::Style::terminal : Progress::Style::silent, 0, limit);
  const Heartbeat at_work(1, [&](const std::vector<std::string>& doing) {
    progress.show(fmt::format("{}: {:.0f} s  {}", row.method, watch.seconds(), fmt::join(doing, "  ")), watch.seconds());
  });
  bool passed = false;
  const std::function<bool()> time_is_up = [&] { return passed = passed || watch.seconds() > limit; };
  const StopAsked deadline(time_is_up);
  const Outcome outcome = trace(problem, model, stored, sink);
  row.out_of_time = passed && outcome.status != Status::converged;
  row.seconds = watch.seconds();
  row.status = row.out_of_time ? Status::not_converged : outcome.status;
  row.why = row.out_of_time ? fmt::format("stopped after {:g} s", limit) : outcome.why;
  return ran;
}

std::string number(const std::optional<double>& x, const char* format) { return x ? fmt::format(fmt::runtime(format), *x) : "-"; }

std::string table(const std::vector<Compared>& rows) {
  std::size_t width = 6;
  for (const Compared& r : rows) width = std::max(width, r.method.size());
  std::string text = fmt::format("{:<{}}  {:<13}  {:>22}  {:>9}  {:>9}  {:>8}  {:>6}  {:>10}  {:>11}  {:>9}\n", "method", width, "status",
                                 "energy", "Δenergy", "Δstate", "residual", "points", "iterations", "evaluations", "seconds");
  for (const Compared& r : rows) {
    if (!r.refused.empty()) continue;
    text += fmt::format("{:<{}}  {:<13}  {:>22.15g}  {:>9}  {:>9}  {:>8.1e}  {:>6}  {:>10}  {:>11}  {:>9.3f}\n", r.method, width,
                        r.out_of_time ? "out of time" : status_name(r.status), r.energy, number(r.energy_difference, "{:.1e}"),
                        number(r.state_difference, "{:.1e}"), r.residual, r.points, r.iterations, r.evaluations, r.seconds);
  }
  for (const Compared& r : rows)
    if (!r.refused.empty()) text += fmt::format("{:<{}}  cannot: {}\n", r.method, width, r.refused);
    else if (r.status != Status::converged) text += fmt::format("{:<{}}  {}\n", r.method, width, r.why);
  const auto elsewhere = [](const Compared& r) { return r.state_difference && *r.state_difference > 1e-6 && std::abs(*r.energy_difference) <= 1e-10; };
  if (std::any_of(rows.begin(), rows.end(), elsewhere))
    text += "Where the energy is the same and the state is not: a mirror image, or what may turn or slide freely has done so.\n";
  return text;
}

Json json(const std::vector<Compared>& rows) {
  Json all = Json::array();
  for (const Compared& r : rows)
    if (!r.refused.empty()) all.push_back({{"method", r.method}, {"status", "refused"}, {"message", r.refused}});
    else
      all.push_back({{"method", r.method}, {"status", r.out_of_time ? "out_of_time" : status_name(r.status)}, {"message", r.why}, {"energy", r.energy},
                     {"energy_difference", json_of(r.energy_difference)}, {"state_difference", json_of(r.state_difference)},
                     {"residual", r.residual}, {"points", r.points}, {"iterations", r.iterations}, {"evaluations", r.evaluations}, {"seconds", r.seconds}});
  return all;
}

}  // namespace

std::vector<std::string> compared_methods() {
  return {"newton", "ipopt", "nlopt:LD_LBFGS", "nlopt:LD_TNEWTON_PRECOND_RESTART", "nlopt:LD_VAR2", "nlopt:LD_MMA", "nlopt:LD_CCSAQ",
          "nlopt:LD_SLSQP", "fire"};
}

std::vector<Compared> compare(const Problem& problem, const std::vector<std::string>& methods, double limit) {
  const Model model = model_of(problem);
  std::optional<StateSupplement> stored;
  if (!problem.path.start.empty()) stored = read_supplement(problem.path.start);
  std::vector<Compared> rows;
  std::optional<Ran> first;                                        // that converged
  for (const std::string& method : methods) {
    Problem with = problem;
    if (method != problem.solver.method) with.solver.method = method, with.solver.max_iterations.reset();
    Ran ran = run(with, model, stored, limit);
    Compared& row = ran.row;
    if (first && row.points > 0 && row.status == Status::converged) {
      const double scale = std::abs(first->row.energy);
      row.energy_difference = (row.energy - first->row.energy) / (scale > 0 ? scale : 1);
      row.state_difference = difference(model, ran.state, first->state);
    }
    rows.push_back(row);
    if (!first && row.refused.empty() && row.status == Status::converged) first = std::move(ran);
    if (row.status == Status::interrupted) break;
  }
  return rows;
}

int compare_command(const CompareOptions& options) {
  const Problem problem = read_problem(options.file, options.settings);
  if (problem.study != StudyType::equilibrium && problem.study != StudyType::path)
    throw InputError(fmt::format("{}: study.type: methods are compared on the equilibria of a study of type \"equilibrium\" or \"path\"", problem.file));
  const std::vector<std::string> methods = options.methods.empty() ? compared_methods() : options.methods;
  for (const std::string& m : methods)                             // before anything runs
    if (m != "auto" && m != "newton" && m != "ipopt" && m != "fire" && m.rfind("nlopt:", 0) != 0)
      throw InputError(fmt::format("--methods: {}: there is no such method; there are auto, newton, ipopt, fire, and nlopt:LD_LBFGS and NLopt's other names", m));
  set_threads(options.threads > 0 ? options.threads : usual_threads());
  const std::vector<Compared> rows = compare(problem, methods, options.limit);
  if (options.json) say("{}\n", json(rows).dump(2));
  else say("{}", table(rows));
  int status = exit_done;
  for (const Compared& r : rows) {
    if (r.status == Status::interrupted) return exit_interrupted;
    if (r.refused.empty() && r.status != Status::converged) status = exit_not_converged;
  }
  return status;
}

}  // namespace elamin
