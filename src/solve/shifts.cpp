#include "solve/shifts.hpp"

#include "core/interrupt.hpp"
#include "solve/limits.hpp"

#include <cmath>

namespace elamin {

std::optional<double> first_shift(double first, double next, double growth, const std::function<bool(double)>& attempt) {
  double shift = first;
  for (int k = 0; k < limits::most_attempts && std::isfinite(shift) && !interrupted(); ++k, next *= growth) {
    if (attempt(shift)) return shift;
    if (next == 0) return {};
    shift = next;
  }
  return {};
}

}  // namespace elamin
