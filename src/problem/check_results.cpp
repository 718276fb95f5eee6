#include "problem/check.hpp"
#include "problem/check_parts.hpp"
#include "problem/schema_words.hpp"
#include "problem/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace elamin {

const std::vector<std::string>& standing_columns() {
  static const std::vector<std::string> columns{"step",     "label",    "branch",     "lambda",   "energy", "bond",
                                                "angle",    "contact",  "wall",       "cohesion", "external",
                                                "residual", "iterations", "negative", "stable",   "multiplicity",
                                                "status"};
  return columns;
}

std::vector<std::string> eigenvalue_columns(int count) {
  std::vector<std::string> columns;
  for (int i = 1; i <= count; ++i) columns.push_back(fmt::format("eigenvalue_{}", i));
  return columns;
}

namespace {

bool is_in(const std::vector<std::string>& list, const std::string& word) {
  return std::find(list.begin(), list.end(), word) != list.end();
}

class CheckResults {
 public:
  CheckResults(const Problem& problem, Names& names, Mistakes& mistakes)
      : p_(problem), names_(names), mistakes_(mistakes), columns_(standing_columns()) {
    if (p_.study != StudyType::modes) return;
    const std::vector<std::string> eigenvalues = eigenvalue_columns(p_.modes.count);
    columns_.insert(columns_.end(), eigenvalues.begin(), eigenvalues.end());
  }

  void check(ObserveTable& o) {
    names_.refer(o.place, "group", o.group, true);
    if (names_.is_wall(o.group) && !o.place.broken) wall(o);
    if (o.name.empty()) return;
    if (is_in(columns_, o.name))
      mistakes_.add(o.place, "name",
                    quoted(o.name) + " is a column of the results already; taken are: " + listed(columns_));
    else if (is_in(observables_, o.name))
      mistakes_.add(o.place, "name", quoted(o.name) + " is the name of another [[observe]]; names are unique");
    else
      observables_.push_back(o.name);
  }

  void check(ExpectTable& e) {
    const bool event = e.at.find(':') != std::string::npos;
    std::vector<std::string> columns;
    for (const std::string& c : columns_)
      if (c != "label" && c != "status" && (event || c != "multiplicity")) columns.push_back(c);
    columns.insert(columns.end(), observables_.begin(), observables_.end());
    if (e.place.keys.count("observable") && !(e.observable.empty() && e.place.broken) && !is_in(columns, e.observable))
      mistakes_.add(e.place, "observable", quoted(e.observable) + " is no column of numbers there; there are: " +
                                               listed(columns) + did_you_mean(e.observable, columns));
    if (const std::string wrong = wrong_at(e.at); !wrong.empty()) mistakes_.add(e.place, "at", wrong);
  }

 private:
  /// A wall is one thing: it has a reaction, a smallest gap and a number of contacts.
  void wall(ObserveTable& o) {
    if (o.quantity != Quantity::reaction && o.quantity != Quantity::gap && o.quantity != Quantity::contacts)
      mistakes_.add(o.place, "quantity",
                    quoted(o.group) + " is a wall; it has reaction.x, reaction.y, reaction.z, reaction.norm, gap and "
                                      "contacts");
    else if (o.reduce != default_reduce(o.quantity))
      mistakes_.add(o.place, "reduce", quoted(o.group) + " is a wall, which has one value; leave reduce out");
  }

  /// Why there is no such row, or "".
  std::string wrong_at(const std::string& at) const {
    if (at == "final" || (at == "initial" && p_.study == StudyType::path)) return "";
    if (p_.study != StudyType::path) return "must be \"final\" in a study that is not a path, is " + quoted(at);
    const std::string allowed =
        "must be \"initial\", \"final\", an event such as \"branch:1\", \"limit:1\" or \"contact:1\", or "
        "\"lambda=0.5\", is " + quoted(at);
    if (at.compare(0, 7, "lambda=") == 0) {
      double lambda = 0;
      const auto [end, error] = std::from_chars(at.data() + 7, at.data() + at.size(), lambda);
      if (error != std::errc() || end != at.data() + at.size() || !std::isfinite(lambda)) return allowed;
      const auto [lo, hi] = std::minmax(p_.path.from, p_.path.to);
      if (lo < hi && (lambda < lo || lambda > hi))
        return fmt::format("lies outside the path, whose load factors run from {} to {}", lo, hi);
      return "";
    }
    const std::size_t colon = at.find(':');
    if (colon == std::string::npos)
      return allowed + did_you_mean(at, {"initial", "final", "branch:1", "limit:1", "contact:1"});
    const std::string kind = at.substr(0, colon), number = at.substr(colon + 1);
    if (kind != "branch" && kind != "limit" && kind != "contact") return allowed;
    if (number.empty() || number.size() > 9 || number[0] == '0' ||
        number.find_first_not_of("0123456789") != std::string::npos)
      return allowed;
    if (!p_.path.place.broken && !is_in(p_.path.locate, kind))
      return quoted(kind) + " is not among path.locate; only located events have a row";
    return "";
  }

  const Problem& p_;
  Names& names_;
  Mistakes& mistakes_;
  std::vector<std::string> columns_, observables_;
};

}  // namespace

void check_results(Problem& problem, Names& names, Mistakes& mistakes) {
  CheckResults results(problem, names, mistakes);
  for (ObserveTable& o : problem.observe) results.check(o);
  for (ExpectTable& e : problem.expect) results.check(e);
}

}  // namespace elamin
