#include "core/find.hpp"
#include "core/interrupt.hpp"
#include "input/check.hpp"
#include "input/staged_structure.hpp"
#include "input/stages.hpp"
#include "model/entities.hpp"
#include "path/path.hpp"
#include "study/landscape.hpp"
#include "study/trace.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <map>
#include <memory>

namespace elamin {

namespace {

// Load factors that the file names, and those that its expectations are about.
std::vector<double> stops_of(const Problem& problem) {
  std::vector<double> stops = problem.path.stops.value_or(std::vector<double>{});
  for (const double at : landscape_load_factors(problem)) stops.push_back(at);
  for (const ExpectTable& e : problem.expect)
    if (const auto lambda = load_factor_of(e.at)) stops.push_back(*lambda);
  return stops;
}

PathOptions options_of(const Problem& problem, const PathTable& t, const Model& model) {
  const auto locates = [&](const char* kind) { return contains(t.locate, kind); };
  return {.method = t.method, .from = t.from, .to = t.to, .steps = t.steps,
          .when_unstable = t.when_unstable.value_or(WhenUnstable::jump), .start = t.start_lambda,
          .stops = stops_of(problem), .limits = locates("limit"), .branch_points = locates("branch"),
          .contacts = locates("contact"), .event_errors = problem.event_errors(), .branches = t.branches, .lowest = t.lowest, .highest = t.highest,
          .most_points = t.points.value_or(0), .user_events = user_events(problem, model), .resume = {}, .deflate = t.deflate,
          .deflate_at = t.deflate_at.value_or(std::vector<double>{})};
}

// One stage at work, perhaps one that is taken up where a state was stored.
struct Run {
  Run(const Problem& problem, Stage in_force, Model in_stage, const State& start, const std::optional<StateSupplement>& stored)
      : stage(std::move(in_force)), model(std::move(in_stage)), energy(model), newton(energy, solver_options(problem)) {
    PathOptions options = options_of(problem, stage.path, model);
    options.correct = corrector_of(problem, newton);
    if (std::holds_alternative<AutoOptions>(solver_method(problem)))
      options.descend = [this](State& state) { return minimise(newton, state, AutoOptions{}); };
    if (stored && goes_on(*stored, problem)) options.resume = stored->path->resume;
    path = make_path(newton, start, options);
  }

  // Whether this is the path that the state is of: the same load factor, that scales the same and goes the same way, and the
  // same free coordinates.
  bool goes_on(const StateSupplement& stored, const Problem& problem) const {
    if (!stored.path || stage.path.start_lambda != stored.load_factor) return false;
    if (stored.path->varied != varied(problem, stage) || stored.path->rising != (stage.path.to > stage.path.from)) return false;
    const Resume& r = stored.path->resume;
    for (const Eigen::Index size : {r.modes.rows(), r.tangent.size(), r.direction.size()})
      if (size != 0 && size != energy.dofs()) return false;
    const int walls = static_cast<int>(model.walls.size());
    const auto known = [&](const auto& contact) { return contact[2] < walls && std::max(contact[0], contact[1]) < entities(model); };
    return std::all_of(r.closed.begin(), r.closed.end(), known) && std::all_of(r.closed_bodies.begin(), r.closed_bodies.end(), known);
  }

  Stage stage;
  Model model;
  Energy energy;
  Newton newton;
  std::unique_ptr<Path> path;
};

// Numbers of steps, branches and labels that go on from stage to stage.
class Numbers {
 public:
  // The point of a stage as it counts among all.
  PathPoint among_all(PathPoint point) {
    point.step += steps_;
    if (point.branch == 0 && point.parent.empty()) point.parent = parent_;
    else point.parent = renumbered(point.parent);
    point.branch += branches_;
    point.label = renumbered(point.label);
    last_ = {point.step, point.branch, point.parent};
    count(point.label);
    return point;
  }
  // The stage has ended.
  void next_stage() {
    steps_ = last_.step + 1, branches_ = last_.branch, parent_ = last_.parent;
    before_ = so_far_;
  }
  void carry(Archive& archive) { archive(steps_, branches_, parent_, before_, so_far_, last_); }

 private:
  // "limit:1" of a stage behind one that had two of them is "limit:3".
  std::string renumbered(const std::string& label) const {
    const auto [kind, number] = parts(label);
    const auto found = before_.find(kind);
    return number == 0 || found == before_.end() ? label : fmt::format("{}:{}", kind, number + found->second);
  }
  void count(const std::string& label) {
    if (const auto [kind, number] = parts(label); number > 0) so_far_[kind] = std::max(so_far_[kind], number);
  }
  static std::pair<std::string, int> parts(const std::string& label) {
    const std::size_t colon = label.find(':');
    if (colon == std::string::npos) return {label, 0};
    return {label.substr(0, colon), std::atoi(label.c_str() + colon + 1)};
  }

  int steps_ = 0, branches_ = 0;
  std::string parent_;
  std::map<std::string, int> before_, so_far_;
  struct { int step = 0, branch = 0; std::string parent; } last_;
};

// Whether a path gets anywhere: its driver takes one point after the other, as long as there is one.
class Headway {
 public:
  explicit Headway(const PathTable& path) : span_(std::abs(path.to - path.from)) {}

  void carry(Archive& archive) { archive(before_, points_, snaps_); }

  /// A sentence once `look_back` points have moved nothing, or as many snaps have hardly changed the load factor; else "".
  std::string lost(const PathPoint& point) {
    const double here = point.state.load_factor;
    if (!before_ || ++points_ == look_back) {
      if (before_ && std::abs(here - before_->load_factor) <= nothing * span_ && farthest(*before_, point.state) <= nothing)
        return fmt::format("the path makes no more headway at load factor {:.10g}: {} points have not moved it", here, look_back);
      before_ = point.state, points_ = 0;
    }
    if (!point.label.starts_with("jump:")) return "";
    snaps_.push_back(here);
    if (snaps_.size() <= look_back) return "";
    snaps_.pop_front();
    const auto [least, most] = std::minmax_element(snaps_.begin(), snaps_.end());
    if (*most - *least > little * span_) return "";
    return fmt::format("the structure snaps again and again near load factor {:.10g}, {} times from {:.10g} on: something floats and is pushed along; "
                       "hold it with a [[support]], or give it another [[contact]]", here, look_back, *least);
  }

 private:
  static constexpr std::size_t look_back = 200;      // far more points than the finest halving of a step asks for
  static constexpr double nothing = 1e-12;           // of the way from `from` to `to`, of the largest coordinate: a point's rounding
  static constexpr double little = 1e-3;             // of the way: two hundred snaps on it would be 10⁵ in all

  static double farthest(const State& a, const State& b) {
    double moved = a.position.size() ? displacement(a, b).cwiseAbs().maxCoeff() : 0, size = a.position.size() ? a.position.cwiseAbs().maxCoeff() : 0;
    for (std::size_t k = 0; k < a.bodies.size(); ++k) {
      moved = std::max({moved, (b.bodies[k].position - a.bodies[k].position).hi.norm(), b.bodies[k].rotation.angularDistance(a.bodies[k].rotation)});
      size = std::max(size, a.bodies[k].position.hi.norm());
    }
    return size > 0 ? moved / size : moved;
  }

  double span_;
  std::optional<State> before_;
  std::size_t points_ = 0;
  std::deque<double> snaps_;
};

}  // namespace

Outcome trace_path(const Problem& problem, const Model& model, const std::optional<StateSupplement>& stored, const Sink& sink, Archive* stopped) {
  Stages stages(problem);
  int k = 0;
  if (stored && stored->stage && stages.resume(*stored->stage)) k = stages.next();
  const int first = k;
  Numbers numbers;
  std::optional<Model> all = model;                    // with everything in force, as long as a stage is to come
  std::unique_ptr<Run> run, before;
  std::optional<PathPoint> held;                       // the last point is known only when there is no next one
  std::vector<State> starts;                           // of the stages so far
  if (stopped) (*stopped)(starts);
  Outcome outcome;
  for (; k < stages.count(); ++k) {
    const std::size_t so_far = static_cast<std::size_t>(k - first);
    const bool again = stopped && so_far < starts.size(), here = again && so_far + 1 == starts.size();      // it was begun before; it goes on
    if (!again) starts.push_back(held ? held->state : model.restart.value_or(model.start));
    const State& start = starts[so_far];
    std::string unclear;
    Stage stage = stages.enter(unclear);
    std::string broken = connect_in(problem, stage.number, *all, start);       // why the path is not gone on with
    if (stored && k == first && connects_before(problem, stage.number))
      broken = "a path is not taken up behind a [[connect]] with from_stage, whose bonds are not those of the file; begin with a stage before it";
    if (!broken.empty()) {
      outcome = {Status::not_converged, stage.name + ": " + broken};
      break;
    }
    Model in_stage = model_in(problem, stage, *all, start);
    if (k + 1 == stages.count()) all.reset();
    if (again && !here) {
      stages.leave(starts[so_far + 1].load_factor);
      continue;
    }
    if (problem.stages.size() > 0 && !here && (k > first || model.restart))        // the first one is checked as the problem is read
      broken = on_wrong_side(in_stage, start, stage.path.start_lambda.value_or(stage.path.from));
    if (!broken.empty()) {
      outcome = {Status::not_converged, stage.name + ": " + broken};
      break;
    }
    before = std::move(run);
    run = std::make_unique<Run>(problem, std::move(stage), std::move(in_stage), start, k == first ? stored : std::nullopt);
    const bool by_newton = problem.solver.by_newton() || any_hard(run->model);
    if (k == first && !here && !by_newton)
      sink.note(fmt::format("the path's start, its events and the stability of its points are a matter of Newton's method; solver.method = "
                            "\"{}\" finds the equilibria between them", problem.solver.method));
    bool begun = here;
    Headway headway(run->stage.path);
    const auto carry = [&](Archive& archive) { archive(numbers, held, headway, *run->path, run->energy, run->newton.factors()); };
    if (here) sink.stage(run->stage, run->energy), carry(*stopped);
    const auto enough = [&] { return held && sink.enough && sink.enough(*held); };
    const auto tell_notes = [&] {
      for (const std::string& note : run->path->notes()) sink.note(note);
    };
    while (std::optional<PathPoint> point = broken.empty() && !enough() ? run->path->next() : std::nullopt) {
      if (gave_up || interrupted()) break;              // what is found while it is to stop need not be what would be found otherwise
      if (!std::isfinite(point->energy.total())) {
        broken = fmt::format("load factor {:.10g}: {}", point->state.load_factor, not_finite(run->energy, point->state));
        break;
      }
      broken = headway.lost(*point);
      if (held) {
        if (!begun && held->label.empty()) held->label = before->stage.name;
        sink.point(*held, false);
      }
      if (!begun) sink.stage(run->stage, run->energy);
      if (!begun && k > first) point->label.clear();       // "initial" is the first of all
      begun = true;
      held = numbers.among_all(std::move(*point));
      if (sink.reached) sink.reached(*held);
      tell_notes();
      if (sink.checkpoint && broken.empty() && !interrupted()) sink.checkpoint([&](Archive& archive) { archive(starts), carry(archive); });
    }
    tell_notes();
    outcome = {run->path->status(), run->path->why()};
    if ((gave_up || interrupted()) && outcome.status != Status::interrupted)
      outcome = {Status::interrupted, held ? fmt::format("interrupted at load factor {:.10g}", held->state.load_factor) : "interrupted"};
    if (enough()) outcome = {Status::converged, "the path ends at " + held->label};
    if (!broken.empty()) outcome = {Status::not_converged, broken};
    if (!run->stage.name.empty()) outcome.why = run->stage.name + ": " + outcome.why;
    if (!begun) run = std::move(before);               // the last point belongs to the stage before
    if (outcome.status != Status::converged || !begun) break;
    stages.leave(held->state.load_factor), numbers.next_stage();
  }
  if (held) sink.point(*held, true);
  return outcome;
}

std::vector<UserEvent> user_events(const Problem& problem, const Model& model) {
  std::vector<UserEvent> all;
  for (const EventTable& e : problem.events)
    for (std::size_t k = 0; k < problem.observe.size(); ++k) {
      if (problem.observe[k].name != e.observable) continue;
      const auto probe = std::make_shared<Probe>(problem, model, made_of(problem.observe, k));
      all.push_back({e.name, [probe](const State& state) { return (*probe)(state).back(); }, e.value, e.stop});
    }
  return all;
}

}  // namespace elamin
