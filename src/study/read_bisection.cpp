#include "study/bisection.hpp"

#include "input/check.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>

namespace elamin {

double Bisection::middle() const {
  const double half = lo + (hi - lo) / 2;
  return integers ? std::trunc(half) : half;
}

bool Bisection::narrow() const {
  const double apart = std::abs(hi - lo);
  return apart <= tolerance || middle() == lo || middle() == hi;
}

std::vector<Setting> Bisection::settings(double value) const {
  std::vector<Setting> all;
  for (const std::string& key : keys) all.push_back({key, integers ? fmt::format("{:.0f}", value) : to_toml(value), place});
  return all;
}

bool bisects(const Sweep& s) { return s.place.keys.count("between") > 0 || s.place.keys.count("bisect") > 0; }

Bisection read_bisection(Sweep& s, const Problem& problem, Mistakes& mistakes) {
  Bisection b;
  b.keys = s.keys, b.observable = s.bisect, b.at = s.at, b.level = s.level;
  if (!s.place.keys.count("between")) {
    mistakes.add(s.place, "bisect", "needs between = [a, b], the values between which the outcome changes");
    return b;
  }
  b.place = s.place.keys.at("between");
  const auto wrong = [&](const std::string& what) { mistakes.add(s.place, "between", what); };
  double ends[2] = {0, 0};
  bool integers = true, numbers = s.between.size() == 2;
  for (std::size_t k = 0; numbers && k < 2; ++k) {
    const Node node = parse_value(s.between[k], b.place);
    const auto* integer = std::get_if<std::int64_t>(&node.value);
    const auto* real = std::get_if<double>(&node.value);
    numbers = integer || (real && std::isfinite(*real));
    integers = integers && integer && std::abs(*integer) < (std::int64_t(1) << 52);
    if (numbers) ends[k] = integer ? static_cast<double>(*integer) : *real;
  }
  if (!numbers) wrong("must be a list of two numbers, between which the outcome changes");
  else if (ends[0] == ends[1]) wrong(fmt::format("has {} twice; the outcome changes between two values", ends[0]));
  b.lo = ends[0], b.hi = ends[1], b.integers = integers;
  b.tolerance = s.tolerance.value_or(1e-3 * std::abs(b.hi - b.lo));

  if (s.bisect.empty()) mistakes.add(s.place, "bisect", "is missing; it must be an observable, whose passing of `level` is the outcome");
  else if (const std::string what = wrong_observable(problem, s.bisect, s.at); !what.empty()) mistakes.add(s.place, "bisect", what);
  if (const std::string what = s.at == at_sweep ? "must be a row of every run" : wrong_at(problem, s.at); !what.empty())
    mistakes.add(s.place, "at", what);
  return b;
}

}  // namespace elamin
