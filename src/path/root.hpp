#pragma once
#include "path/equilibrium.hpp"

#include <functional>
#include <limits>
#include <optional>

namespace elamin {

/// A function of an equilibrium along a branch: parameter, value, and the equilibrium itself.
struct Sample {
  double t, f;
  Equilibrium e;
};

/// The zero of f between two samples of different sign, by the Illinois variant of regula falsi, with bisection where four evaluations have not halved
/// the bracket. `evaluate(t, nearest)` computes the sample at t, from the one of the bracket that is nearest. Stops when the
/// secant through the bracket predicts a change below `resolution`, or the bracket is that small; the better end of it.
/// Nothing if an evaluation fails, or if f leaps over zero: where both ends are new ones and the bracket is narrower by the factor root_search::narrow, the difference of
/// the values there is still more than root_search::leap of what it was, and more than `next_to_none`.  Source: Dowell & Jarratt 1971, BIT 11.
[[nodiscard]] std::optional<Sample> find_zero(Sample a, Sample b, const std::function<double(double)>& resolution,
                                const std::function<std::optional<Sample>(double, const Sample&)>& evaluate,
                                double next_to_none = std::numeric_limits<double>::infinity());

}  // namespace elamin
