#pragma once
// A piece of a branch between two equilibria as a function of one parameter: load factor, or arc length.
#include "path/equilibrium.hpp"
#include "path/limits.hpp"

#include <algorithm>
#include <functional>

namespace elamin {

struct Segment {
  double a = 0, b = 0;                 // parameters of its ends
  /// The equilibrium at a parameter between, computed from one that is near; not converged if there is none to be had.
  std::function<Equilibrium(double parameter, const Equilibrium& nearest)> at;
  /// The equilibrium at the parameter of a state that is near to it, some directions (dofs × m) held.
  std::function<Report(State& state, const Eigen::MatrixXd& held)> settle;
  std::function<double(const State&)> parameter;         // of a state
  std::function<double(const Equilibrium&)> load_rate;   // dλ/dt
  /// Whether the branch through one equilibrium leads to another one: a step and its parts meet.
  std::function<bool(const Equilibrium& from, const Equilibrium& to)> leads;
  /// How well a parameter tells a state, where coordinates are rounded; none: to its own last digits.
  std::function<double(double parameter)> rounding = {};
  double resolution(double t, double part = limits::segment::rounding) const { return std::max(part * std::abs(b - a), rounding ? rounding(t) : 0.0); }
};

/// A point between two equilibria of a segment, and dx/dt (dofs), dλ/dt there: Hermite's cubic, with dx/dt = dλ/dt dx/dλ at the ends.
struct Interpolated {
  State state;
  Vector rate;
  double load_rate;
};
Interpolated interpolate(const Kinematics& kinematics, const Segment& segment, const Equilibrium& a, const Equilibrium& b, double ta, double tb,
                         double t);

/// The load factor that this cubic gives between the equilibria at both ends of a segment, as a function of the parameter.
std::function<double(double parameter)> load_along(const Segment& segment, const Equilibrium& a, const Equilibrium& b);

/// Whether an equilibrium computed between two of a branch lies beside their chord: on another branch it would not.
[[nodiscard]] inline bool beside_chord(const Kinematics& kinematics, const State& a, const State& b, const State& between) {
  const Vector chord = kinematics.difference(a, b), way = kinematics.difference(a, between);
  const double length = chord.norm(), along = length > 0 ? way.dot(chord) / (length * length) : 0.0;
  return along >= -limits::segment::widest && along <= 1 + limits::segment::widest && (way - along * chord).norm() <= limits::segment::widest * length;
}

/// Whether the way between two equilibria is by more than `most` of it another one than the mean of their tangents, as it is of a parabola, or either tangent
/// tells less of it than none would: a step over a bend, where what the corrector finds may belong to another branch, as over a pitchfork, one branch of
/// which is as stable as what is before.
[[nodiscard]] inline bool bends(const Kinematics& kinematics, const Equilibrium& a, const Equilibrium& b, double most) {
  const Vector moved = kinematics.difference(a.point.state, b.point.state);
  const double change = b.point.state.load_factor - a.point.state.load_factor, rounding = limits::segment::least_movement * kinematics.norm(b.point.state), way = moved.norm();
  const auto off = [&](const Vector& tangent) { return (moved - change * tangent).norm(); };
  return !(off((a.tangent + b.tangent) / 2) <= most * way + rounding && std::min(off(a.tangent), off(b.tangent)) <= way + rounding);
}

}  // namespace elamin
