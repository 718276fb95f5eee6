#include "core/find.hpp"
#include "input/check.hpp"

#include "core/suggest.hpp"
#include "core/text.hpp"
#include "energy/terms.hpp"
#include "input/parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

void describe(Keys& keys, ExpectTable& t) {
  keys.about("What the results are held against by `elamin verify`.");
  keys.must("observable", t.observable, "a column of path.csv");
  keys.may("at", t.at, "its row: final, initial, an event such as branch:1, a stage, lambda=0.5, in dynamics step=100, sweep, on a curve second=0.5, "
           "curve.end, curve.cusp:1, or of a landscape landscape.minimum:1@0.5");
  keys.must("value", t.value, "what it should be");
  keys.may("rtol", t.rtol, "how far off it may be, relative to the value", range::not_negative);
  keys.may("atol", t.atol, "… and besides", range::not_negative);
  keys.may("source", t.source, "where the value is from");
  keys.may("extrapolate", t.extrapolate,
           "over the runs of a sweep, each with half the spacing of the one before, errors in powers of the spacing: 1: all of them, 2: even ones",
           Range{1, 2});
  keys.may("continuum", t.continuum, "of [refine]: the value without particles, which must be as far from this one as its error bar, rtol and atol allow …");
  keys.may("bar", t.bar, "… and how wide its error bar may be, relative to the value; of 0 as it is", range::positive);
}

namespace {

/// The columns of energies between others.
std::vector<std::string> around_energies(std::vector<std::string> columns, const std::vector<std::string>& behind) {
  for (const auto& more : {energy_columns(), behind}) columns.insert(columns.end(), more.begin(), more.end());
  return columns;
}

const std::vector<std::string>& trajectory_standing_columns() {
  static const std::vector<std::string> columns =
      around_energies({"step", "label", "time"}, {"kinetic", "work", "dissipation", "balance", "status"});
  return columns;
}

}  // namespace

const std::vector<std::string>& standing_columns() {
  static const std::vector<std::string> columns = around_energies(
      {"step", "label", "branch", "lambda"}, {"residual", "iterations", "negative", "stable", "multiplicity", "status", "parent", "negative_rigid",
                                              "negative_before", "negative_after", "what", "stage"});
  return columns;
}

std::vector<std::string> eigenvalue_columns(const Problem& p) {
  const int count = p.study == StudyType::modes ? p.modes.count : p.follows_path() ? p.path.eigenvalues : 0;
  std::vector<std::string> columns;
  for (int i = 1; i <= count; ++i) columns.push_back(fmt::format("eigenvalue_{}", i));
  return columns;
}

namespace {


}  // namespace

std::vector<std::string> columns_of(const Problem& p) {
  std::vector<std::string> columns = p.in_time() ? trajectory_standing_columns() : standing_columns();
  const std::vector<std::string> eigenvalues = eigenvalue_columns(p);
  columns.insert(columns.end(), eigenvalues.begin(), eigenvalues.end());
  if (p.event_errors()) columns.push_back("lambda_error");
  return columns;
}

std::vector<std::string> taken_columns(const Problem& p) {
  std::vector<std::string> columns = columns_of(p);
  if (p.curve) columns.insert(columns.end(), {"second", "asymmetry"});
  if (p.study == StudyType::landscape) columns.insert(columns.end(), {"barrier", "barrier_back", "minima", "saddles", "euler"});
  return columns;
}

std::optional<double> number_behind(std::string_view word, const std::string& at) {
  double number = 0;
  const bool is_one = at.starts_with(word) && reads_as(std::string_view(at).substr(word.size()), number) && std::isfinite(number);
  return is_one ? std::optional(number) : std::nullopt;
}

std::optional<double> load_factor_of(const std::string& at) {
  return number_behind("lambda=", at);
}

std::optional<int> step_of(const std::string& at) {
  int step = 0;
  const bool is_one = at.starts_with("step=") && reads_as(std::string_view(at).substr(5), step) && step >= 0;
  return is_one ? std::optional(step) : std::nullopt;
}

std::string wrong_observable(const Problem& p, const std::string& observable, const std::string& at) {
  const std::vector<std::string> no_numbers{"label", "status", "parent", "what", "stage"},
      of_events{"multiplicity", "negative_before", "negative_after", "lambda_error"};
  if (at == at_sweep) return observable == "threshold" ? "" : "must be \"threshold\" at = \"sweep\", is " + in_quotes(observable);
  const bool event = at.find(':') != std::string::npos;
  std::vector<std::string> columns;
  if (is_of_curve(at)) columns = {"second", "multiplicity", "asymmetry"};
  if (is_of_landscape(at)) columns = {"multiplicity", "barrier", "barrier_back", "minima", "saddles", "euler"};
  for (const std::string& c : columns_of(p))
    if (!contains(no_numbers, c) && (event || !contains(of_events, c))) columns.push_back(c);
  for (const ObserveTable& o : p.observe)
    if (!o.name.empty() && !contains(columns, o.name)) columns.push_back(o.name);
  if (contains(columns, observable)) return "";
  return in_quotes(observable) + " is no column of numbers there; there are: " + listed(columns) + did_you_mean(observable, columns);
}

std::string wrong_at(const Problem& p, const std::string& at) {
  if (is_of_curve(at)) return wrong_at_curve(p, at);
  if (is_of_landscape(at)) return wrong_at_landscape(p, at);
  if (at == at_sweep || at == "final" || (at == "initial" && p.follows_path())) return "";
  if (p.in_time()) {
    if (const auto step = step_of(at); step && *step > p.dynamics.steps)
      return fmt::format("lies behind the last step, {}", p.dynamics.steps);
    else if (at == "initial" || step)
      return "";
    return "must be \"initial\", \"final\" or a step such as \"step=100\" in dynamics, is " + in_quotes(at);
  }
  if (!p.follows_path()) return "must be \"final\" in a study that is not a path, is " + in_quotes(at);
  const std::string allowed =
      "must be \"initial\", \"final\", an event such as \"branch:1\", \"limit:1\" or \"contact:1\", " +
      std::string(p.stages.empty() ? "" : "a stage's name, ") + "or \"lambda=0.5\", is " + in_quotes(at);
  if (at.compare(0, 7, "lambda=") == 0) {
    const auto lambda = load_factor_of(at);
    if (!lambda) return allowed;
    if (p.path.method == PathMethod::arc_length || !p.stages.empty()) return "";
    const auto [lo, hi] = std::minmax(p.path.from, p.path.to);
    if (lo < hi && (*lambda < lo || *lambda > hi))
      return fmt::format("lies outside the path, whose load factors run from {} to {}", lo, hi);
    return "";
  }
  for (const StageTable& s : p.stages)
    if (at == s.name) return "";
  const std::size_t colon = at.find(':');
  std::vector<std::string> labels{"initial", "final", "branch:1", "limit:1", "contact:1"};
  for (const EventTable& e : p.events) labels.push_back(e.name + ":1");
  for (const StageTable& s : p.stages) labels.push_back(s.name);
  if (colon == std::string::npos) return allowed + did_you_mean(at, labels);
  const std::string kind = at.substr(0, colon), number = at.substr(colon + 1);
  const bool watched = std::any_of(p.events.begin(), p.events.end(), [&](const EventTable& e) { return e.name == kind; });
  if (!watched && kind != "branch" && kind != "limit" && kind != "contact" && kind != "jump" && kind != "deflated")
    return allowed + did_you_mean(at, labels);
  if (number.empty() || number.size() > 9 || number[0] == '0' || number.find_first_not_of("0123456789") != std::string::npos)
    return allowed;
  if (!watched && kind != "jump" && kind != "deflated" && !p.path.place.broken && !contains(p.path.locate, kind))
    return in_quotes(kind) + " is not among path.locate; only located events have a row";
  return "";
}

void check_expectations(Problem& problem, Mistakes& mistakes) {
  for (ExpectTable& e : problem.expect) {
    if (e.place.keys.count("observable") && !(e.observable.empty() && e.place.broken))
      if (const std::string wrong = wrong_observable(problem, e.observable, e.at); !wrong.empty())
        mistakes.add(e.place, "observable", wrong);
    if (const std::string wrong = wrong_at(problem, e.at); !wrong.empty()) mistakes.add(e.place, "at", wrong);
    if (e.continuum && !problem.refine) mistakes.add(e.place, "continuum", "is of the value without particles, which [refine] finds; there is none");
    if (e.continuum && e.extrapolate) mistakes.add(e.place, "extrapolate", "is of a [[sweep]], continuum of [refine]; leave one of them out");
    if (e.continuum && !e.bar) mistakes.add(e.place, "bar", "is missing; how wide the error bar may be, relative to the value");
    if (e.bar && !e.continuum) mistakes.add(e.place, "bar", "is of the value without particles; write continuum = true, too");
  }
}

}  // namespace elamin
