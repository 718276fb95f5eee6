#pragma once
// Limit points, branch points and contacts as curves in the load factor λ and a second parameter μ.
#include "path/extended_system.hpp"

namespace elamin {

struct CurveOptions {
  double from = 0, to = 1;             // values of μ
  int steps = 40;                      // no step changes μ by more than (to − from)/steps
  std::vector<double> stops = {};      // values of μ that are met besides
  std::vector<std::string> until = {}; // labels at the first of which it ends
  double load = 1;                     // the scale of the load factor, where it is zero at the start
};

/// What a curve came to.
struct CurveEnd {
  Status status = Status::converged;
  std::string why;
};

/// Follows a threshold from an event of the structure at μ = from in arc length (Keller 1977) over (x, λ, μ), in which a curve is smooth
/// where λ and μ both turn, and tells its points in order, with a label ("start", "end", "cusp:1", …; "" of others) and a phrase, and between them
///   cusp:      of limit points, ∇³E v v v = 0: two of them meet, and both λ and μ turn (Thom's cusp)
///   turn:      λ or μ turns; where μ does so on a curve of limit points, the load does no work along v: a branch point of the path
///   symmetric: ∇³E v v v changes its sign on a curve of branch points
///   hilltop:   another eigenvalue vanishes: a limit point and a branch point meet; double: of the same kind; meeting: with a contact
///   contact:   another contact is made or lost
/// It ends where μ leaves [from, to], at `to` or back at `from`, or where it cannot be followed, with a sentence. Derivatives by the
/// structure are differences of residuals; see ExtendedSystem.
CurveEnd trace_curve(const VariantAt& variants, Threshold start, const CurveOptions& options,
                     const std::function<void(const Threshold&)>& found);

}  // namespace elamin
