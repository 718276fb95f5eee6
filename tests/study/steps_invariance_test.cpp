// What happens on a path does not depend on how it is walked: over all files of problems/ that have one, few steps and many, and both
// methods, come to the same events and to the same end.
//
// Left out, because it cannot be so:
//   a fall        is made a part of a step behind its event: where it lands is compared by its kind, not by its load factor; and by the
//                 other method, which may go on where this one falls, only what comes before the first loss of stability;
//   load steps    pass no limit point: likewise; and `lowest`, `highest` are of arc length alone;
//   Ipopt         walks by load steps alone.
#include "catch.hpp"
#include "study/prepare.hpp"
#include "study/trace.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

using namespace elamin;

namespace {

constexpr double tolerance = 1e-9;               // of load factors, relative to the largest of the path

struct Walked {
  std::string how;
  Outcome outcome;
  std::vector<PathPoint> events;
  PathPoint last;
  double range = 0;
  int points = 0;
  std::string told() const {
    std::string all = how + ": " + outcome.why + ":";
    for (const PathPoint& p : events) all += " " + p.label + " " + std::to_string(p.state.load_factor);
    return all + "\n";
  }
};

std::string kind(const PathPoint& p) { return p.label.substr(0, p.label.find(':')); }

Walked walk(const std::string& file, const std::vector<std::string>& settings) {
  std::vector<Setting> parsed;
  Walked w;
  for (const std::string& s : settings) parsed.push_back(parse_setting(s)), w.how += s + " ";
  const PreparedRuns prepared = prepare_runs(file, parsed);
  const PreparedRun& run = prepared.runs.front();               // of a sweep the first
  const Sink sink{.stage = [](const Stage&, Energy&) {},
                  .point = [&](const PathPoint& p, bool) {
                    if (p.label.find(':') != std::string::npos) w.events.push_back(p);
                    w.last = p, ++w.points, w.range = std::max(w.range, std::abs(p.state.load_factor));
                  },
                  .modes = [](const PathPoint&, const std::vector<Mode>&) {},
                  .note = [](const std::string&) {}};
  w.outcome = trace(run.problem, run.model, {}, sink);
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
    CHECK(kind(a[k]) == kind(b[k]));
    CHECK(a[k].branch == b[k].branch);
    if (kind(a[k]) == "jump") continue;
    CHECK(std::abs(a[k].state.load_factor - b[k].state.load_factor) <= tolerance * range);
    CHECK(a[k].multiplicity == b[k].multiplicity);
  }
}

void same_end(const Walked& a, const Walked& b) {
  CHECK(a.last.state.load_factor == Approx(b.last.state.load_factor).margin(tolerance * a.range));
  CHECK(a.last.energy.total() == Approx(b.last.energy.total()).epsilon(1e-9));
  CHECK(a.last.stability.negative == b.last.stability.negative);
}

/// Numbers of steps: fewer of those files that would take most of the time.
std::vector<int> steps_of(const std::string& name) {
  static const std::set<std::string> large{"disc_clamped", "disc_hinged", "plate_clamped", "plate_hinged", "sheet_indented", "two_beams_gaps", "two_beams_winner"};
  if (name == "beam_in_tube" || name == "column_between_walls" || name == "ring_pressure" || name == "two_beams") return {5, 50};
  if (name == "confined_d_cone") return {17, 50};
  return large.count(name) ? std::vector<int>{5, 17} : std::vector<int>{5, 17, 50, 200};
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

TEST_CASE("the events and the end of a path do not depend on its steps and its method", "[steps][problems]") {
  std::vector<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(ELAMIN_ROOT) + "/problems"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  REQUIRE(files.size() > 1);
  for (const std::string& file : files)
    DYNAMIC_SECTION(std::filesystem::path(file).stem().string()) {
      const PreparedRuns prepared = prepare_runs(file);
      const Problem& problem = prepared.runs.front().problem;
      const std::string name = std::filesystem::path(file).stem().string();
      if (problem.study != StudyType::path) continue;
      std::optional<Walked> first;
      for (const int steps : steps_of(name)) {
        const Walked w = walk(file, way(problem, steps, false));
        INFO(w.told());
        CHECK(w.outcome.status == Status::converged);
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
        if (steps == 5 || steps == 200) continue;               // two numbers, or one, are enough to compare methods
        const Walked w = walk(file, way(problem, steps, true));
        INFO(w.told() << first->told());
        const std::vector<PathPoint> here_stable = stable_part(first->events), there_stable = stable_part(w.events);
        same_events(there_stable, here_stable, first->range);
        const bool all_stable = here_stable.size() == first->events.size() && there_stable.size() == w.events.size() &&
                                (here_stable.empty() || here_stable.back().negative_after <= 0);
        if (!all_stable) continue;
        CHECK(w.outcome.status == Status::converged);
        same_end(w, *first);
      }
    }
}

TEST_CASE("a path whose load factors are sums of equal steps ends at its end, however they are rounded", "[steps]") {
  const std::string file = std::string(ELAMIN_ROOT) + "/problems/cubes_jammed.toml";
  for (int steps = 2; steps <= 128; ++steps) {
    const Walked w = walk(file, {"path.method=arc_length", "path.steps=" + std::to_string(steps)});
    INFO(w.told());
    CHECK(w.outcome.status == Status::converged);
    CHECK(w.last.state.load_factor == 1);
  }
}
