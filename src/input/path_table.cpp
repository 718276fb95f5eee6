#include "core/find.hpp"
#include "core/suggest.hpp"
#include "input/names.hpp"
#include "input/parts.hpp"
#include "input/stages.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {

namespace {

constexpr Word<StudyType> study_words[]{{"energy", StudyType::energy},
                                        {"equilibrium", StudyType::equilibrium},
                                        {"path", StudyType::path},
                                        {"landscape", StudyType::landscape},
                                        {"modes", StudyType::modes},
                                        {"dynamics", StudyType::dynamics}};
constexpr Word<PathMethod> path_method_words[]{{"load_steps", PathMethod::load_steps}, {"arc_length", PathMethod::arc_length}};
constexpr Word<WhenUnstable> when_unstable_words[]{
    {"jump", WhenUnstable::jump}, {"follow", WhenUnstable::follow}, {"stop", WhenUnstable::stop}};
constexpr std::array event_words{"limit", "branch", "contact"};

const char* const when_unstable_means =
    "snap to the next minimum, as an experiment does, stay on the branch, or stop; by default jump, of arc_length follow";

}  // namespace

void describe(Keys& keys, StudyTable& t) {
  keys.about("What is asked for.");
  keys.word("type", t.type, study_words, "by default what the tables are for: dynamics, landscape, path (or stages), modes; else an equilibrium");
}

void describe(Keys& keys, ModesTable& t) {
  keys.about("A study of modes: the lowest eigenpairs of the Hessian.");
  keys.may("count", t.count, "how many", Range{1, most_modes});
}

void describe(Keys& keys, PathTable& t) {
  keys.about("A path of equilibria as the load factor changes.");
  keys.one_or_more("parameter", t.parameter, "tables that the load factor scales, such as \"load.top\"; by default all but the constant ones");
  keys.word("method", t.method, path_method_words, "steps of the load factor, or of the length of the branch");
  keys.may("steps", t.steps, "of equal length, halved where Newton's method fails; in arc length none changes the load factor by more",
           Range{1, most_steps});
  keys.may("from", t.from, "load factor where it begins");
  keys.may("to", t.to, "load factor where it ends");
  keys.word("when_unstable", t.when_unstable, when_unstable_words, when_unstable_means);
  keys.may("branches", t.branches, "how many branch points to switch at, both ways", Range{0, most_branches});
  keys.words("locate", t.locate, event_words, "events that are located (none: load steps that may snap search for nothing within a step) and have a row in events.csv …");
  keys.may("event_errors", t.event_errors, "… and there lambda_error, how far rounding may move the load factor; with [refine] always");
  keys.may("eigenvalues", t.eigenvalues, "columns eigenvalue_1 … of every point", Range{0, most_modes});
  keys.may("stops", t.stops, "load factors that are met besides");
  keys.may("lowest", t.lowest, "load factor below which a branch in arc length ends");
  keys.may("highest", t.highest, "load factor above which it ends");
  keys.may("points", t.points, "most points of such a branch; by default 20 · steps, of a stage its own", Range{1, 20.0 * most_steps});
  keys.may("deflate", t.deflate, "further equilibria to look for …", Range{0, most_branches});
  keys.may("deflate_at", t.deflate_at, "… at these load factors; by default at `to`");
  keys.may("frames", t.frames, "states that are kept, evenly along the path, beside those that have a label", Range{2, most_steps});
  keys.may("every", t.every, "… or each so many points", range::id);
  keys.at_most_one({"frames", "every"});
  keys.words("film", t.film, film_words, "files that show them all: for LAMMPS and OVITO, for ParaView, extended XYZ; by default the first two");
  keys.with({"film"}, {"frames", "every"}, "the states that it shows");
  keys.may_file("start", t.start, "a states/LABEL.data to go on from");
  keys.may("start_lambda", t.start_lambda, "its load factor; by default the stored one, or `from`");
}

void describe(Keys& keys, StageTable& t) {
  keys.about("A part of a path with conditions of its own; what is left out is as in [path].");
  keys.name("name", t.name, "its name");
  keys.one_or_more("vary", t.vary, "tables that the load factor scales; by default all that are scaled");
  keys.one_or_more("off", t.off, "tables that are not in force");
  keys.may("from", t.from, "load factor where it begins; by default the one that what it varies has by then");
  keys.may("to", t.to, "load factor where it ends");
  keys.may("steps", t.steps, "as in [path]", Range{1, most_steps});
  keys.word("method", t.method, path_method_words, "as in [path]");
  keys.word("when_unstable", t.when_unstable, when_unstable_words, when_unstable_means);
}

void describe(Keys& keys, EventTable& t) {
  keys.about("An observable whose reaching of a value is located on a path, as NAME:1, NAME:2, …");
  keys.name("name", t.name, "its name");
  keys.must("observable", t.observable, "the name of an [[observe]]");
  keys.must("value", t.value, "the value");
  keys.may("stop", t.stop, "the path ends there");
}

namespace {

/// Keys that only branches in arc length have a use for.
void check_method(PathTable& t, Mistakes& mistakes) {
  if (t.method == PathMethod::arc_length || t.branches > 0) return;
  const auto refuse = [&](const char* key) {
    mistakes.add(t.place, key, "is for branches in arc length: method = \"arc_length\", or branches; load steps go from `from` to `to`");
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

/// Load factors that the path is to meet, from lo to hi.
void check_within(PathTable& t, const char* key, const std::vector<double>& list, double lo, double hi, Mistakes& mistakes) {
  for (const double at : list)
    if (at < lo || at > hi)
      mistakes.add(t.place, key, fmt::format("{} lies outside the path, whose load factors run from {} to {}", at, lo, hi));
}

void check_deflation(PathTable& t, Mistakes& mistakes) {
  if (!t.deflate_at) return;
  if (t.deflate == 0)
    return mistakes.add(t.place, "deflate_at", "is of no use without deflate, the number of further equilibria to look for");
  check_within(t, "deflate_at", *t.deflate_at, t.lowest.value_or(std::min(t.from, t.to)), t.highest.value_or(std::max(t.from, t.to)), mistakes);
}

/// Load steps meet what lies on their way; a branch in arc length may go anywhere.
void check_stops(PathTable& t, bool staged, Mistakes& mistakes) {
  if (!t.stops || staged || t.method == PathMethod::arc_length || t.branches > 0) return;
  check_within(t, "stops", *t.stops, std::min(t.from, t.to), std::max(t.from, t.to), mistakes);
}

void check_table(PathTable& t, bool is_path, bool staged, Mistakes& mistakes) {
  if (t.place.broken) return;
  if (t.from == t.to && !staged)
    mistakes.add(t.place, "to", fmt::format("is the same load factor as from, {}; a path leads from one to another", t.to));
  if (t.start_lambda && t.start.empty())
    mistakes.add(t.place, "start_lambda", "is of no use without start, the state to start from");
  if (is_path && !staged && t.start_lambda && *t.start_lambda == t.to && t.from != t.to) {
    const bool given = t.place.written("start_lambda");
    mistakes.add(t.place, given ? "start_lambda" : "start",
                 fmt::format("is at the load factor where the path ends, {}; {}", t.to,
                             given ? "a path leads from one to another"
                                   : fmt::format("start_lambda = {} begins a new path from this state, another `to` goes on with "
                                                 "the old one", t.from)));
  }
  check_method(t, mistakes);
  check_range(t, mistakes);
  check_stops(t, staged, mistakes);
  check_deflation(t, mistakes);
}

}  // namespace

void check_path(Problem& problem, Mistakes& mistakes) {
  const bool is_path = problem.follows_path();
  check_table(problem.path, is_path, !problem.stages.empty(), mistakes);
  if (!is_path && !problem.stages.empty())
    mistakes.add(problem.stages.front().place, "stages are parts of a path; give study.type = \"path\" or leave them out");
  check_stages(problem, mistakes);

  std::vector<std::string> names;
  for (EventTable& e : problem.events) {
    if (e.name.empty()) continue;
    const std::vector<std::string> taken{"branch", "limit", "contact", "jump", "deflated", "initial", "final"};
    if (contains(taken, e.name))
      mistakes.add(e.place, "name", in_quotes(e.name) + " is reserved; taken are: " + listed(taken));
    else if (contains(names, e.name))
      mistakes.add(e.place, "name", in_quotes(e.name) + " is the name of another [[event]]; names are unique");
    names.push_back(e.name);
    if (!e.observable.empty()) must_be_one(problem.observe, "observe", e.place, "observable", e.observable, mistakes);
  }
}

}  // namespace elamin
