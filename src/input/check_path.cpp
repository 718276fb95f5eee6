#include "input/check_parts.hpp"
#include "input/stages.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {
namespace {

/// Keys that only branches in arc length have a use for.
void check_method(PathTable& t, Mistakes& mistakes) {
  if (t.method == PathMethod::arc_length || t.branches > 0) return;
  const auto refuse = [&](const char* key) {
    mistakes.add(t.place, key, "is for branches in arc length: method = \"arc_length\", or branches; load steps go from "
                               "`from` to `to`");
  };
  if (t.lowest) refuse("lowest");
  if (t.highest) refuse("highest");
  if (t.place.keys.count("points")) refuse("points");
}

/// The load factors that end an arc-length path lie around its start.
void check_range(PathTable& t, Mistakes& mistakes) {
  const double start = t.start_lambda.value_or(t.from);
  if (t.lowest && t.highest && *t.lowest >= *t.highest)
    return mistakes.add(t.place, "highest", fmt::format("must be above lowest, {}, is {}", *t.lowest, *t.highest));
  if (t.lowest && start < *t.lowest)
    mistakes.add(t.place, "lowest", fmt::format("is above {}, where the path starts; it must not be", start));
  if (t.highest && start > *t.highest)
    mistakes.add(t.place, "highest", fmt::format("is below {}, where the path starts; it must not be", start));
}

void check_deflation(PathTable& t, Mistakes& mistakes) {
  if (!t.deflate_at) return;
  if (t.deflate == 0)
    return mistakes.add(t.place, "deflate_at", "is of no use without deflate, the number of further equilibria to look for");
  const double lo = t.lowest.value_or(std::min(t.from, t.to)), hi = t.highest.value_or(std::max(t.from, t.to));
  for (const double at : *t.deflate_at)
    if (at < lo || at > hi)
      return mistakes.add(t.place, "deflate_at",
                          fmt::format("{} lies outside the path, whose load factors run from {} to {}", at, lo, hi));
}

/// Load steps meet what lies on their way; a branch in arc length may go anywhere.
void check_stops(PathTable& t, bool staged, Mistakes& mistakes) {
  if (!t.stops || staged || t.method == PathMethod::arc_length || t.branches > 0) return;
  const auto [lo, hi] = std::minmax(t.from, t.to);
  for (const double at : *t.stops)
    if (at < lo || at > hi)
      return mistakes.add(t.place, "stops",
                          fmt::format("{} lies outside the path, whose load factors run from {} to {}", at, lo, hi));
}

void check_table(PathTable& t, bool is_path, bool staged, Mistakes& mistakes) {
  if (t.place.broken) return;
  if (t.from == t.to && !staged)
    mistakes.add(t.place, "to",
                 fmt::format("is the same load factor as from, {}; a path leads from one to another", t.to));
  if (t.start_lambda && t.start.empty())
    mistakes.add(t.place, "start_lambda", "is of no use without start, the state to start from");
  if (is_path && !staged && t.start_lambda && *t.start_lambda == t.to && t.from != t.to)
    mistakes.add(t.place, t.place.keys.count("start_lambda") ? "start_lambda" : "start",
                 fmt::format("is at the load factor where the path ends, {}; a path leads from one to another", t.to));
  check_method(t, mistakes);
  check_range(t, mistakes);
  check_stops(t, staged, mistakes);
  check_deflation(t, mistakes);
}

}  // namespace

void check_path(Problem& problem, Mistakes& mistakes) {
  const bool is_path = problem.study == StudyType::path;
  check_table(problem.path, is_path, !problem.stages.empty(), mistakes);
  if (!is_path && !problem.stages.empty())
    mistakes.add(problem.stages.front().place, "stages are parts of a path; give study.type = \"path\" or leave them out");
  check_stages(problem, mistakes);

  std::vector<std::string> observables, names;
  for (const ObserveTable& o : problem.observe) observables.push_back(o.name);
  for (EventTable& e : problem.events) {
    if (e.name.empty()) continue;
    const std::vector<std::string> taken{"branch", "limit", "contact", "jump", "deflated", "initial", "final"};
    if (std::find(taken.begin(), taken.end(), e.name) != taken.end())
      mistakes.add(e.place, "name", in_quotes(e.name) + " is reserved; taken are: " + listed(taken));
    else if (std::find(names.begin(), names.end(), e.name) != names.end())
      mistakes.add(e.place, "name", in_quotes(e.name) + " is the name of another [[event]]; names are unique");
    names.push_back(e.name);
    if (e.observable.empty() || std::find(observables.begin(), observables.end(), e.observable) != observables.end()) continue;
    mistakes.add(e.place, "observable",
                 in_quotes(e.observable) + " is no [[observe]]; " +
                     (observables.empty() ? "there is none" : "there are: " + listed(observables)) +
                     did_you_mean(e.observable, observables));
  }
}

}  // namespace elamin
