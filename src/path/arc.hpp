#pragma once
// A branch as a curve in the space of positions and load factor: its direction, and steps of arc length along it.
#include "path/equilibrium.hpp"

namespace elamin {

/// |(x, λ)|² = |x|²/L² + λ²/Λ², |x| the Euclidean norm over the free dofs; L [length].
struct Metric {
  double length = 1, load = 1;
  double dot(const Vector& x, double l, const Vector& y, double m) const {
    return x.dot(y) / (length * length) + l * m / (load * load);
  }
};

/// A unit vector of the metric.
struct Direction {
  Vector x;                            // dofs [length]
  double load = 0;
};

/// A length of the size of the structure: the longest side of the box around all centres at the start, but not less than
/// the largest diameter.
double span(const Model& model);

/// The branch's direction at an equilibrium, of the two senses the one that makes an acute angle with `along`. At a limit
/// point, where dx/dλ is without bound, it is the critical mode.
Direction direction_of(const Equilibrium& e, const Metric& metric, const Direction& along);
double cosine(const Direction& a, const Direction& b, const Metric& metric);

/// A chord (x, λ) of a branch, split along the sum d of the directions at its ends:  (x, λ) = part d + off,  defect = |off| / |(x, λ)|  in the metric.
struct Chord {
  double part = 0;
  Direction off;
  double defect = 0;
};
Chord chord(const Vector& x, double load, const Direction& begin, const Direction& end, const Metric& metric);

/// Newton's corrector on a surface across a branch. Where a wall that is moved presses so stiffly that forces change by more than they may
/// within the spacing of the load factors, no pair (x, λ) fulfils both conditions: there a few iterations lead to the surface, and the
/// equilibrium at the load factor that has been reached is as near to it as rounding lets it be, if it still `lies_on` it. Not converged:
/// as Newton::correct.
[[nodiscard]] Report correct_across(Newton& newton, State& state, const Eigen::MatrixXd& held, const State* from, int most, Plane& across,
                                    const std::function<bool(const State&)>& lies_on);

/// Equilibria on hyperplanes across a branch (Keller 1977):
///   g(x, λ) = 0,   t_x·(x − x₀)/L² + t_λ (λ − λ₀)/Λ² = s.
class Arc {
 public:
  Arc(Newton& newton, const Equilibrium& from, Direction direction, Metric metric)
      : newton_(newton), from_(from), direction_(std::move(direction)), metric_(metric) {}

  /// The equilibrium at arc length s, predicted along the branch's direction at one that is near. Not converged if Newton
  /// does not contract there, or if anything would pass through something else on the way. Its tangent is that of the bordered
  /// system  H p + c δ = 0,  t_x·p/L² + t_λ δ/Λ² = 1,  which is regular where H is not: at limit points, beside branch points.
  Equilibrium at(double s, const Equilibrium& nearest) const;
  /// The state of it alone, without what is known of the equilibrium there.
  [[nodiscard]] Report correct(State& state, double s, const Equilibrium& nearest) const;
  /// The equilibrium at the arc length of a state that is near to it, some directions (dofs × m) held.
  [[nodiscard]] Report settle(State& state, const Eigen::MatrixXd& held) const;
  /// dλ/ds of the branch at an equilibrium.
  double load_rate(const Equilibrium& e) const;
  /// s of an equilibrium, and how far the state lies from the branch's tangent at `from`, in the metric.
  double position(const State& state) const;
  double distance(const State& state) const;
  const Direction& direction() const { return direction_; }
  const Metric& metric() const { return metric_; }
  /// The hyperplane.
  Plane plane() const;

 private:
  [[nodiscard]] Report on_plane(State& state, const Eigen::MatrixXd& held, const State* from) const;
  Direction along(const Equilibrium& nearest) const;
  Newton& newton_;
  Equilibrium from_;
  Direction direction_;
  Metric metric_;
};

/// The equilibrium with its tangent told across a plane, or a surface: dx/dλ is without bound at a limit point, not its direction. nearest: the one it was found from.
[[nodiscard]] Equilibrium with_tangent(Newton& newton, Equilibrium e, const Equilibrium& nearest, const Plane& across);

}  // namespace elamin
