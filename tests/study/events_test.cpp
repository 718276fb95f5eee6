// What happens on the paths of problems/: every event satisfies its own equations, and the same events come however the path is walked.
//
// Every walk by a file's own method is held against the equations. By few steps and many, and by both methods, the events and the end are the same.
// Left out, because it cannot be so:
//   a snap        by the other method, which may go on where this one snaps: only what comes before the first loss of stability;
//   load steps    pass no limit point: likewise; and `lowest`, `highest` are of arc length alone;
//   Ipopt         walks by load steps alone.
#include "catch.hpp"
#include "core/dense.hpp"
#include "energy/hard_gaps.hpp"
#include "model/entities.hpp"
#include "path/arc.hpp"
#include "study/prepare.hpp"
#include "study/trace.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <limits>
#include <set>

using namespace elamin;

namespace {

// A path as it was found; of a path in stages one of them, with the model that was in force there.
struct StagePoints {
  Model model;
  std::vector<PathPoint> points;
};

struct Found {
  std::deque<StagePoints> stages;
  Outcome outcome;
};

Found found_by(const PreparedRun& run) {
  Found found;
  const Sink sink{.stage = [&](const Stage&, Energy& energy) { found.stages.push_back({energy.model(), {}}); },
                  .point = [&](const PathPoint& point, bool) { found.stages.back().points.push_back(point); },
                  .modes = [&](const PathPoint& point, const std::vector<Mode>&) { found.stages.back().points.push_back(point); },
                  .note = [](const std::string&) {}};
  found.outcome = trace(run.problem, run.model, {}, sink);
  return found;
}

std::string kind_of(const PathPoint& p) { return p.label.substr(0, p.label.find(':')); }
bool located(const PathPoint& p) { return p.label.find(':') != std::string::npos && kind_of(p) != "jump"; }

// What is left of a force when hard contacts that bear one take what they can: less its part in the span of the gaps' gradients.
Vector beside_contacts(const Energy& energy, const State& state, Vector force) {
  Eigen::MatrixXd gradients(force.size(), 0);
  for (const HardForce& h : state.hard) {
    HardGap gap;
    if (!hard_gap(energy.model(), h, state, gap)) continue;
    Field g = Field::Zero(3, energy.kinematics().sites());
    for (int i = 0; i < gap.sites; ++i) g.col(gap.site[i]) += gap.gradient.segment<3>(3 * i);
    gradients.conservativeResize(Eigen::NoChange, gradients.cols() + 1);
    gradients.rightCols(1) = energy.kinematics().restrict(g);
  }
  if (gradients.cols() > 0) force -= gradients * least_squares(gradients, force);
  return force;
}

// Null vectors: orthonormal, H φ = 0, and the load does work along that of a limit point, along none of a branch point.
// Slender structures bend so much more easily than they stretch that H φ is small beside H for any bending φ: so φ·Hφ is
// held against what it is one point before or after too.
void check_modes(const std::vector<PathPoint>& points, std::size_t at, Energy& energy, Factors& factors) {
  const PathPoint& p = points[at];
  REQUIRE(p.multiplicity >= 1);
  REQUIRE(p.modes.cols() == p.multiplicity);
  CHECK((p.modes.transpose() * p.modes - Eigen::MatrixXd::Identity(p.multiplicity, p.multiplicity)).cwiseAbs().maxCoeff() <= 1e-12);
  const double stiffness = factors.zero_level() / (16 * epsilon);
  const Vector rate = energy.load_derivative();
  std::vector<double> left;
  for (int k = 0; k < p.multiplicity; ++k) {
    const Vector mode = p.modes.col(k);
    const Vector product = beside_contacts(energy, p.state, energy.multiply(mode));
    CAPTURE(k, product.norm() / stiffness, mode.dot(rate) / rate.norm());
    CHECK(product.norm() <= 1e-8 * stiffness);
    if (kind_of(p) == "limit") CHECK(std::abs(mode.dot(rate)) > 1e-5 * rate.norm());
    else CHECK(std::abs(mode.dot(rate)) <= 1e-5 * rate.norm());
    left.push_back(std::abs(energy.quadratic_form(mode)));
  }
  for (int k = 0; k < p.multiplicity; ++k) {
    double beside = 0;
    for (const std::size_t other : {at - 1, at + 1}) {
      if (other >= points.size() || points[other].branch != p.branch) continue;
      energy.evaluate(points[other].state);
      beside = std::max(beside, std::abs(energy.quadratic_form(p.modes.col(k))));
    }
    CAPTURE(k, left[k] / beside);
    CHECK(left[k] <= 1e-6 * beside);
  }
}

// A gap that is zero, or, between bodies that attract each other, as wide as they reach.
void check_contact(const PathPoint& p, Energy& energy) {
  const Model& model = energy.model();
  double reach = 1e-9 * largest_size(model), least = std::numeric_limits<double>::infinity();
  std::vector<double> ends{0};
  for (const RoundedPair& r : model.rounded) ends.push_back(r.kernel.cutoff), reach = std::max(reach, r.kernel.cutoff * (1 + 1e-9));
  for (const Touch& t : energy.touches(p.state, reach))
    for (const double end : ends) least = std::min(least, std::abs(t.gap - end) / size_of(model, t.particle));
  CHECK(least <= 1e-9);
}

// A corner of the path, where a contact of bodies that opens or closes changes the stiffness at once: nothing is singular there.
bool at_corner(const PathPoint& p, const Model& model) { return kind_of(p) == "limit" && p.modes.cols() == 0 && !model.bodies.empty(); }

void check_watch(const PathPoint& p, const std::vector<PathPoint>& points, const std::vector<UserEvent>& watched) {
  const auto watch = std::find_if(watched.begin(), watched.end(), [&](const UserEvent& w) { return w.name == kind_of(p); });
  REQUIRE(watch != watched.end());
  double most = 0;
  for (const PathPoint& q : points) most = std::max(most, std::abs(watch->observable(q.state)));
  CHECK(std::abs(watch->observable(p.state) - watch->value) <= 1e-9 * most);
}

// Right beside an event, where nothing else happens in between, the Morse index is what the event says of its two sides.
void check_index(const std::vector<PathPoint>& points, std::size_t k) {
  const PathPoint& p = points[k];
  const auto ordinary = [&](const PathPoint& q) {
    return q.branch == p.branch && (q.label.empty() || q.label == "initial" || q.label == "final") && q.stability.critical == 0;
  };
  if (k > 0 && ordinary(points[k - 1])) CHECK(p.negative_before == points[k - 1].stability.negative);
  if (k + 1 < points.size() && ordinary(points[k + 1])) CHECK(p.negative_after == points[k + 1].stability.negative);
}

void check_events(const StagePoints& stage, const Problem& problem) {
  Energy energy(stage.model);
  Factors factors(energy);
  const std::vector<UserEvent> watched = user_events(problem, stage.model);
  for (std::size_t k = 0; k < stage.points.size(); ++k) {
    const PathPoint& p = stage.points[k];
    if (p.label.empty()) continue;
    CAPTURE(p.label, p.step, p.branch, p.state.load_factor);
    energy.evaluate(p.state);
    CHECK(energy.relative(energy.gradient()) <= problem.solver.tolerance);
    if (!located(p)) continue;
    check_index(stage.points, k);
    if (kind_of(p) == "contact" || at_corner(p, stage.model)) check_contact(p, energy);
    else if (kind_of(p) == "limit" || kind_of(p) == "branch") check_modes(stage.points, k, energy, factors);
    else check_watch(p, stage.points, watched);
  }
}

void check_twins(const StagePoints& stage) {
  std::vector<const PathPoint*> events;
  double loads = 0;
  for (const PathPoint& p : stage.points) {
    loads = std::max(loads, std::abs(p.state.load_factor));
    if (located(p)) events.push_back(&p);
  }
  const double size = span(stage.model);
  const Kinematics kinematics(stage.model);
  for (std::size_t a = 0; a < events.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) {
      if (kind_of(*events[a]) != kind_of(*events[b])) continue;
      const double moved = kinematics.displacement(events[a]->state, events[b]->state).cwiseAbs().maxCoeff();
      const bool twins = moved <= 1e-9 * size && std::abs(events[a]->state.load_factor - events[b]->state.load_factor) <= 1e-9 * loads;
      CAPTURE(events[a]->label, events[b]->label, events[a]->state.load_factor);
      CHECK_FALSE(twins);
    }
}

// Events of a run and their equations; each stands there once, and those of which something is expected do.
void check_found(const Found& found, const Problem& problem) {
  CAPTURE(found.outcome.why);
  CHECK(found.outcome.status == Status::converged);
  REQUIRE_FALSE(found.stages.empty());
  std::set<std::string> labels;
  for (const StagePoints& stage : found.stages) {
    check_events(stage, problem);
    check_twins(stage);
    for (const PathPoint& p : stage.points) labels.insert(p.label);
  }
  for (const ExpectTable& e : problem.expect)
    if (e.at.find(':') != std::string::npos && !is_of_curve(e.at) && !is_of_landscape(e.at)) CHECK(labels.count(e.at) == 1);
}

std::vector<std::string> problem_files() {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(ELAMIN_ROOT) + "/problems"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  REQUIRE(files.size() > 1);
  return files;
}

constexpr double same_load = 1e-9;               // of load factors, relative to the largest of the path

struct Walked {
  std::string how;
  Found found;
  std::vector<PathPoint> events;
  PathPoint last;
  double range = 0;
  std::string told() const {
    std::string all = how + ": " + found.outcome.why + ":";
    for (const PathPoint& p : events) all += " " + p.label + " " + std::to_string(p.state.load_factor);
    return all + "\n";
  }
};

Walked walk(const std::string& file, const std::vector<std::string>& settings) {
  std::vector<Setting> parsed;
  Walked w;
  for (const std::string& s : settings) parsed.push_back(parse_setting(s)), w.how += s + " ";
  const PreparedRuns prepared = prepare_runs(file, parsed);
  w.found = found_by(prepared.runs.front());                     // of a sweep the first
  for (const StagePoints& stage : w.found.stages)
    for (const PathPoint& p : stage.points) {
      if (p.label.find(':') != std::string::npos) w.events.push_back(p);
      w.last = p, w.range = std::max(w.range, std::abs(p.state.load_factor));
    }
  return w;
}

/// Events up to the first loss of stability, with it.
std::vector<PathPoint> stable_part(const std::vector<PathPoint>& events) {
  std::vector<PathPoint> part;
  for (const PathPoint& p : events) {
    part.push_back(p);
    if (p.negative_before == 0 && p.negative_after > 0) break;
  }
  return part;
}

void same_events(const std::vector<PathPoint>& a, const std::vector<PathPoint>& b, double range) {
  REQUIRE(a.size() == b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    CAPTURE(a[k].label, b[k].label, a[k].state.load_factor, b[k].state.load_factor);
    CHECK(kind_of(a[k]) == kind_of(b[k]));
    CHECK(a[k].branch == b[k].branch);
    CHECK(std::abs(a[k].state.load_factor - b[k].state.load_factor) <= same_load * range);
    if (kind_of(a[k]) != "jump") CHECK(a[k].multiplicity == b[k].multiplicity);
  }
}

void same_end(const Walked& a, const Walked& b) {
  CHECK(a.last.state.load_factor == Approx(b.last.state.load_factor).margin(same_load * a.range));
  CHECK(a.last.energy.total() == Approx(b.last.energy.total()).epsilon(1e-9));
  CHECK(a.last.stability.negative == b.last.stability.negative);
}

/// Numbers of steps: fewer of those files that would take most of the time.
std::vector<int> steps_of(const std::string& name) {
  static const std::set<std::string> large{"disc_clamped", "disc_hinged", "plate_clamped", "plate_hinged", "sheet_indented", "two_beams_gaps", "two_beams_winner"};
  if (name == "beam_in_tube" || name == "column_between_walls" || name == "ring_pressure" || name == "two_beams") return {5, 50};
  if (name == "confined_d_cone") return {11};                     // its own, which its expectations hold against twice as many
  return large.count(name) ? std::vector<int>{5, 17} : std::vector<int>{5, 17, 50, 101};
}

std::string other_than(PathMethod method) { return method == PathMethod::arc_length ? "load_steps" : "arc_length"; }

/// Settings for so many steps in all stages, by the file's own methods or by the other ones.
std::vector<std::string> way(const Problem& problem, int steps, bool other) {
  const PathTable& path = problem.path;
  std::vector<std::string> settings{"path.steps=" + std::to_string(steps)};
  if (other) settings.push_back("path.method=" + other_than(path.method));
  for (const StageTable& s : problem.stages) {
    if (s.steps) settings.push_back("stage." + s.name + ".steps=" + std::to_string(steps));
    if (other && s.method) settings.push_back("stage." + s.name + ".method=" + other_than(*s.method));
  }
  if ((path.method == PathMethod::arc_length) != other) settings.push_back("path.points=20000");            // their number is not what ends it
  return settings;
}

}  // namespace

TEST_CASE("every event of the problems satisfies its own equations, and stands there once", "[events][problems]") {
  for (const std::string& file : problem_files())
    DYNAMIC_SECTION(std::filesystem::path(file).stem().string()) {
      const PreparedRuns prepared = prepare_runs(file);
      if (prepared.runs.front().problem.in_time()) continue;          // a motion has no equilibria
      const std::size_t last = prepared.runs.front().problem.refine ? 1 : prepared.runs.size() - 1;      // refined: the second level; the finest takes ten times as long
      for (const std::size_t number : last == 0 ? std::vector<std::size_t>{0} : std::vector<std::size_t>{0, last}) {
        const PreparedRun& run = prepared.runs[number];
        if (number == 0 && run.problem.study == StudyType::path) continue;       // the test below has it
        CAPTURE(number);
        check_found(found_by(run), run.problem);
      }
    }
}

TEST_CASE("the events and the end of a path do not depend on its steps and its method, and satisfy their own equations", "[steps][problems]") {
  for (const std::string& file : problem_files())
    DYNAMIC_SECTION(std::filesystem::path(file).stem().string()) {
      const PreparedRuns prepared = prepare_runs(file);
      const Problem& problem = prepared.runs.front().problem;
      const std::string name = std::filesystem::path(file).stem().string();
      if (problem.study != StudyType::path) continue;
      std::optional<Walked> first;
      for (const int steps : steps_of(name)) {
        const Walked w = walk(file, way(problem, steps, false));
        INFO(w.told());
        check_found(w.found, problem);
        if (!first) {
          first = w;
          continue;
        }
        INFO(first->told());
        same_events(w.events, first->events, first->range);
        same_end(w, *first);
      }
      if (!problem.solver.by_newton() || problem.path.lowest || problem.path.highest) continue;
      for (const int steps : steps_of(name)) {
        if (steps == 5 || steps == 101) continue;               // two numbers, or one, are enough to compare methods
        const Walked w = walk(file, way(problem, steps, true));
        INFO(w.told() << first->told());
        const std::vector<PathPoint> here_stable = stable_part(first->events), there_stable = stable_part(w.events);
        same_events(there_stable, here_stable, first->range);
        const bool all_stable = here_stable.size() == first->events.size() && there_stable.size() == w.events.size() &&
                                (here_stable.empty() || here_stable.back().negative_after <= 0);
        if (!all_stable) continue;
        CHECK(w.found.outcome.status == Status::converged);
        same_end(w, *first);
      }
    }
}

TEST_CASE("a path whose load factors are sums of equal steps ends at its end, however they are rounded", "[steps]") {
  const std::string file = std::string(ELAMIN_ROOT) + "/problems/cubes_jammed.toml";
  for (int steps = 2; steps <= 128; ++steps) {
    const Walked w = walk(file, {"path.method=arc_length", "path.steps=" + std::to_string(steps)});
    INFO(w.told());
    CHECK(w.found.outcome.status == Status::converged);
    CHECK(w.last.state.load_factor == 1);
  }
}
