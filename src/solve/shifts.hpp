#pragma once
// The one way to a factor of H + τI with a τ that is sought.
#include <functional>
#include <optional>

namespace elamin {

/// The first of  first, next, g·next, g²·next, …  (g = growth > 1) with which `attempt` makes a factor, [force/length]; none after
/// most_attempts, where the shifts overflow or stay at zero, or when a user interrupts. With a `next` of the size of rounding and a finite
/// matrix of entries up to 10¹⁷ times that there is one: by Gershgorin's theorem H + τI is positive definite from τ = ‖H‖₁ on.
[[nodiscard]] std::optional<double> first_shift(double first, double next, double growth, const std::function<bool(double)>& attempt);

}  // namespace elamin
