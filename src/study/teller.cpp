#include "study/teller.hpp"

#include "study/trace.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {

namespace {

constexpr double glance = 1, longest_silence = 4;      // seconds between two looks at the work; without a line

// Whether the load only grows.
bool steady(const Problem& problem) {
  const PathTable& p = problem.path;
  return problem.in_time() || (p.method == PathMethod::load_steps && p.branches == 0 && p.deflate == 0);
}

std::string first_of(StudyType study) {
  return study == StudyType::path || study == StudyType::landscape ? "the first equilibrium" : study == StudyType::modes ? "the modes" : "the equilibrium";
}

}  // namespace

Teller::Teller(const Problem& problem, RunDirectory& results, Progress::Style style)
    : problem_(problem), results_(results), style_(style),
      progress_(stdout, style, problem.in_time() ? 0 : starting_load_factor(problem),
                problem.in_time() ? problem.dynamics.steps : problem.path.to, steady(problem)),
      after_(first_of(problem.study)), heartbeat_(glance, [this](const auto& doing) { at_work(doing); }) {}

void Teller::log(const std::string& line) {
  const std::lock_guard lock(mutex_);
  results_.log(line);
}

void Teller::warn(const std::string& warning) {
  log("warning: " + warning);
  warnings_.push_back(warning);
}

void Teller::enter(const Stage& stage) {
  const std::lock_guard lock(mutex_);
  if (!problem_.stages.empty()) progress_.enter(stage.number, static_cast<int>(problem_.stages.size()), stage.path.from, stage.path.to);
}

void Teller::reached(const PathPoint& point) { begin(fmt::format("what comes after step {}, load factor {:.7g},", point.step, point.state.load_factor)); }

void Teller::found(const PathPoint& point, const std::vector<Touch>& touches) {
  const auto closed = std::count_if(touches.begin(), touches.end(), [](const Touch& t) { return t.bears || t.gap < 0; });
  const std::lock_guard lock(mutex_);
  if (problem_.follows_path()) progress_.show(point, static_cast<int>(closed));
  since_line_ = Stopwatch();
}

void Teller::moved(const std::string& line, double step) {
  const std::lock_guard lock(mutex_);
  progress_.show(line, step);
}

void Teller::begin(const std::string& what) {
  const std::lock_guard lock(mutex_);
  after_ = what, since_point_ = since_line_ = Stopwatch();
}

void Teller::finish() {
  const std::lock_guard lock(mutex_);
  progress_.finish();
}

void Teller::at_work(const std::vector<std::string>& doing) {
  const std::lock_guard lock(mutex_);
  const double seconds = since_point_.seconds();
  const bool silent = since_line_.seconds() >= longest_silence;
  if (problem_.in_time() || seconds < longest_silence / 2 || !(silent || style_ == Progress::Style::terminal)) return;
  const std::string line =
      fmt::format("at work on {} for {:.0f} s{}{}", after_, seconds, doing.empty() ? "" : ": ", fmt::join(doing, ", "));
  std::vector<std::string> pieces{fmt::format("{:.0f} s at work", seconds)};
  pieces.insert(pieces.end(), doing.begin(), doing.end());
  if (silent) results_.log(line), since_line_ = Stopwatch();
  progress_.wait(line, pieces);
}

}  // namespace elamin
