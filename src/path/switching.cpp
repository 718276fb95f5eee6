#include "path/switching.hpp"

#include "energy/step_limits.hpp"
#include "path/family.hpp"
#include "path/limits.hpp"
#include "path/root.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {

using namespace limits;

namespace {

// An equilibrium beside a branch point.
struct Beside {
  Equilibrium e;
  Direction direction;
  Vector leaving;
  double step;
};

class Switch {
 public:
  Switch(Newton& newton, const Event& event, const Metric& metric, double load_step, double rotation)
      : newton_(newton), event_(event), metric_(metric), load_step_(load_step), rotation_(rotation) {}

  /// The equilibrium at amplitude a along a unit vector of the critical modes, others held or not.
  Report at(State& state, const Vector& along, double amplitude, const Eigen::MatrixXd& others) const {
    state = event_.at.point.state;
    kinematics().retract(state, along, amplitude);
    Plane plane{along / (metric_.length * metric_.length), 0, metric_.length, metric_.load};
    plane.guided = others.cols() > 0;
    Equilibrium from = event_.at;
    from.zero_modes = side_by_side(zero(), family_);
    return correct_in_phase(newton_.energy(), from, state, [&](State& x, const Eigen::MatrixXd& held) {
      return newton_.correct(x, side_by_side(held, others), nullptr, 30, &plane);
    });
  }

  /// From here on these directions keep still: along them lie the equilibria of one family.
  void hold(const Eigen::MatrixXd& family) { family_ = family; }

  /// A bond turned by one radian, or a particle moved by its diameter, is amplitude one over this.
  double rotation(const Vector& along) const { return step_size(newton_.energy(), event_.at.point.state, along); }

  /// The longest amplitude along a mode, other modes held, at which the load factor has changed by no more than a step: λ(a) is taken
  /// as a parabola.
  double amplitude(const Vector& along, const Eigen::MatrixXd& others) const {
    double a = rotation_ / rotation(along);
    for (int k = 0; k < 12; ++k) {
      State state;
      const Report report = at(state, along, a, others);
      const double change = std::abs(state.load_factor - event_.at.point.state.load_factor);
      if (report.converged() && near(state, a) && change <= load_step_) return a;
      a *= report.converged() && change > 0 ? std::clamp(0.9 * std::sqrt(load_step_ / change), 1e-3, 0.5) : 0.3;
    }
    return a;
  }

  std::optional<Beside> leave(const Vector& along, double longest) const {
    for (double a = longest; a >= switching::least_part * longest; a /= 3) {
      State state;
      const Report report = at(state, along, a, {});
      if (!report.converged() || !near(state, a)) continue;
      const Vector moved = kinematics().difference(event_.at.point.state, state);
      const double load = state.load_factor - event_.at.point.state.load_factor;
      const double size = std::sqrt(metric_.dot(moved, load, moved, load));
      const Direction chord{moved / size, load / size};
      Equilibrium e = with_tangent(newton_, assess(newton_, state, report), event_.at, Arc(newton_, event_.at, chord, metric_).plane());
      if (event_.modes.cols() > 1 || straight(e, moved, load, chord)) return Beside{std::move(e), chord, along, size};
    }
    return {};
  }

  /// Force along the circle of the plane of two modes, at an angle.
  double around(double angle, const Vector& u, const Vector& v, double amplitude) const {
    const Vector along = std::cos(angle) * u + std::sin(angle) * v, across = std::cos(angle) * v - std::sin(angle) * u;
    State state;
    if (!at(state, along, amplitude, across).converged()) return 0;
    return across.dot(newton_.energy().gradient()) / newton_.energy().force_scale();
  }

 private:
  // Whether the branch leaves along the chord to the equilibrium, as a step along it asks (ArcSteps), in a metric that may be another one: nearer to the
  // branch point it does. Not asked of a multiple one, where nearer by the modes are not told from what is neutral.
  bool straight(const Equilibrium& e, const Vector& moved, double load, const Direction& chord) const {
    const Direction end = direction_of(e, metric_, chord);
    return cosine(chord, end, metric_) >= std::cos(arc_steps::largest_angle / 2) &&
           elamin::chord(moved, load, chord, end, metric_).defect <= arc_steps::largest_defect / 2;
  }

  // Beside the branch point, and not on the branch that is known.
  bool near(const State& state, double a) const {
    const Vector moved = kinematics().difference(event_.at.point.state, state);
    const double change = state.load_factor - event_.at.point.state.load_factor;
    if ((moved - change * event_.at.tangent).norm() < 0.1 * moved.norm()) return false;
    return kinematics().difference(event_.at.point.state, state).norm() <= 2 * a && newton_.energy().collision_free_step(event_.at.point.state, state) == 1;
  }
  const Kinematics& kinematics() const { return newton_.energy().kinematics(); }
  const Eigen::MatrixXd& zero() const { return event_.at.zero_modes; }
  Newton& newton_;
  const Event& event_;
  Metric metric_;
  double load_step_, rotation_;
  Eigen::MatrixXd family_;
};

// Angles in [0, π) at which the force along the circle vanishes; only 0 where it vanishes everywhere.
std::vector<double> angles_between(const Switch& s, const Vector& u, const Vector& v) {
  const double amplitude = std::min(s.amplitude(u, v), s.amplitude(v, u));
  std::vector<double> force(switching::rays + 1);
  const double step = pi / switching::rays, shift = step / 3;             // rays beside the axes of symmetry
  for (int k = 0; k <= switching::rays; ++k) force[k] = s.around(shift + k * step, u, v, amplitude);
  double largest = 0;
  for (const double f : force) largest = std::max(largest, std::abs(f));
  if (largest <= switching::no_force) return {0.0};
  std::vector<double> angles;
  for (int k = 0; k < switching::rays; ++k) {
    if ((force[k] < 0) == (force[k + 1] < 0)) continue;
    const auto zero = find_zero({shift + k * step, force[k], {}}, {shift + (k + 1) * step, force[k + 1], {}}, [](double) { return 1e-9; },
                                [&](double t, const Sample&) -> std::optional<Sample> {
      return Sample{t, s.around(t, u, v, amplitude), {}};
    });
    if (zero) angles.push_back(zero->t);
  }
  return angles;
}

// Whether one is an image of the other: at the same distance the same load factor and energy, beside their changes.
bool images(const Kinematics& kinematics, const Equilibrium& at, const Beside& a, const Beside& b) {
  const auto shape = [&](const Beside& side) { return kinematics.extend(side.leaving).colwise().norm().eval().lpNorm<4>(); };
  const auto close = [](double x, double y, double from) { return std::abs(x - y) <= switching::same * std::max(std::abs(x - from), std::abs(y - from)) + 64 * epsilon * std::abs(from); };
  return close(a.e.point.state.load_factor, b.e.point.state.load_factor, at.point.state.load_factor) &&
         close(a.e.point.energy.total(), b.e.point.energy.total(), at.point.energy.total()) &&
         std::abs(shape(a) - shape(b)) <= 1e3 * switching::same * shape(a);
}

// What costs next to nothing on a side branch within the span of the critical modes, orthonormal: the directions of a family.
Eigen::MatrixXd neutral(Newton& newton, const Beside& side, const Eigen::MatrixXd& modes, const Eigen::MatrixXd& zero) {
  Eigen::MatrixXd found(modes.rows(), 0);
  const Eigen::MatrixXd free = side_by_side(side.e.zero_modes, nearly_neutral(newton, side.e, static_cast<int>(modes.cols())).vectors);
  for (Eigen::Index j = 0; j < free.cols(); ++j) {
    Vector v = modes * (modes.transpose() * free.col(j));
    if (zero.cols() > 0) v -= zero * (zero.transpose() * v);
    v -= found * (found.transpose() * v);
    if ((v - side.leaving * side.leaving.dot(v)).norm() > 0.3) found = side_by_side(found, v.normalized());
  }
  return found;
}

}  // namespace

std::vector<SideBranch> side_branches(Newton& newton, const Event& branch_point, const Metric& metric, double load_step, double rotation) {
  Switch s(newton, branch_point, metric, load_step, rotation);
  const Eigen::MatrixXd& modes = branch_point.modes;
  std::vector<Vector> rays_found;
  Eigen::MatrixXd family(modes.rows(), 0);
  const auto others = [&](Eigen::Index i) -> Eigen::MatrixXd {
    Eigen::MatrixXd rest(modes.rows(), modes.cols() - 1);
    rest << modes.leftCols(i), modes.rightCols(modes.cols() - 1 - i);
    return rest;
  };
  const Vector symmetric = symmetric_direction(newton.energy(), branch_point.at.point.state, modes);
  if (modes.cols() > 1)
    if (const auto first = s.leave(symmetric, s.amplitude(symmetric, others(0)))) {
      family = neutral(newton, *first, modes, branch_point.at.zero_modes);
      if (modes.cols() == 2 && family.cols() == 1) family = modes.col(1);          // by symmetry, where `first` has drifted along the family
    }
  if (modes.cols() == 1 + family.cols()) {
    rays_found.push_back(symmetric);
    s.hold(family);
  } else {
    family.resize(Eigen::NoChange, 0);
    for (Eigen::Index i = 0; i < modes.cols(); ++i)
      for (Eigen::Index j = i + 1; j < modes.cols(); ++j)
        for (const double angle : angles_between(s, modes.col(i), modes.col(j)))
          rays_found.push_back(std::cos(angle) * modes.col(i) + std::sin(angle) * modes.col(j));
  }
  std::vector<Beside> found;
  for (const Vector& ray : rays_found) {
    const double longest = s.amplitude(ray, {});
    const std::optional<Beside> one = s.leave(ray, longest), other = s.leave(-ray, longest);
    const auto known = [&](const Beside& side) {
      return std::any_of(found.begin(), found.end(), [&](const Beside& f) { return images(newton.energy().kinematics(), branch_point.at, side, f); });
    };
    const bool new_one = one && (modes.cols() == 1 || !known(*one)), new_other = other && (modes.cols() == 1 || !known(*other));
    if (new_one) found.push_back(*one);
    if (new_other) found.push_back(*other);
  }
  std::vector<SideBranch> sides;
  for (Beside& side : found) {
    Equilibrium at = branch_point.at;
    at.zero_modes = side_by_side(at.zero_modes, family);
    sides.push_back({std::move(at), std::move(side.direction), std::move(side.leaving), side.step});
  }
  return sides;
}

}  // namespace elamin
