#include "solve/shifts.hpp"

#include "core/interrupt.hpp"

#include <cmath>

namespace elamin {

std::optional<double> first_shift(double first, double next, double growth, const std::function<bool(double)>& attempt) {
  constexpr int most_attempts = 100;             // 1.5¹⁰⁰ = 4·10¹⁷: from the rounding of any matrix to beyond its norm
  double shift = first;
  for (int k = 0; k < most_attempts && std::isfinite(shift) && !interrupted(); ++k, next *= growth) {
    if (attempt(shift)) return shift;
    if (next == 0) return {};
    shift = next;
  }
  return {};
}

}  // namespace elamin
