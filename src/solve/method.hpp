#pragma once
// One question, how a minimum is found by many methods.
#include "solve/ipopt.hpp"
#include "solve/newton.hpp"
#include "solve/nlopt.hpp"

#include <functional>
#include <string>
#include <variant>

namespace elamin {

/// Newton's method, as the Newton that is given has it, again and again while loose bodies fall farther; settle() for packings of loose grains, and where
/// Newton's method stalls beside fewer of them.
struct AutoOptions {};

/// How a minimum is looked for.
using Method = std::variant<NewtonOptions, IpoptOptions, NloptOptions, AutoOptions>;

/// "newton", "ipopt", "nlopt:LD_LBFGS", …
std::string name_of(const Method& method);

/// Why a method cannot minimise an energy, one sentence that names others that can; "" if it can.
std::string refusal(const Method& method, const Energy& energy);

/// Finds a minimum near the state by the method: converged means the same of all of them, a residual (Energy::relative) below the
/// tolerance and a Hessian without a negative eigenvalue. A method that ends at a saddle is sent down its negative
/// curvature and asked again. `newton`: of the energy that is minimised; it factorises, and polishes where that is asked for.
[[nodiscard]] Report minimise(Newton& newton, State& state, const Method& method);

/// The same with any search for an equilibrium, whose reports are added up. At its end, as Newton's method does it too, simplified
/// Newton steps with the factor that has told the inertia bring the residual down to rounding; `why` counts them.
/// Where hard contacts bear a force the Hessian is that of a Lagrangian: neither is asked of it.
[[nodiscard]] Report stable_end(Newton& newton, State& state, const std::function<Report(State&)>& search);

}  // namespace elamin
