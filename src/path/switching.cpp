#include "path/switching.hpp"

#include "energy/step_limits.hpp"
#include "path/root.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

constexpr double first_turn = 0.02;           // of a bond at the first equilibrium [rad]
constexpr double least_turn = 1e-4;
constexpr double same = 1e-6;                 // images by symmetry: load factors and energies, beside their changes
constexpr int rays = 32;                      // on half a circle
constexpr double no_force = 1e-12;            // of the scale of internal forces

class Switch {
 public:
  Switch(Newton& newton, const Event& event, const Metric& metric) : newton_(newton), event_(event), metric_(metric) {}

  /// The equilibrium at amplitude a along a unit vector of the critical modes, others held or not.
  Report at(State& state, const Vector& along, double amplitude, const Eigen::MatrixXd& others) const {
    state = event_.at.point.state;
    kinematics().retract(state, along, amplitude);
    Plane plane{along / (metric_.length * metric_.length), 0, metric_.length, metric_.load, others.cols() > 0};
    return newton_.correct(state, side_by_side(zero(), others), nullptr, 30, &plane);
  }

  /// A bond turned by one radian, or a particle moved by its diameter, is amplitude one over this.
  double turn(const Vector& along) const {
    const double t = distortion(newton_.energy(), event_.at.point.state, along);
    return t > 0 ? t : movement(newton_.energy(), along);
  }

  std::optional<SideBranch> leave(const Vector& along) const {
    for (double t = first_turn; t >= least_turn; t /= 3) {
      const double amplitude = t / turn(along);
      State state;
      const Report report = at(state, along, amplitude, {});
      if (!report.converged()) continue;
      const Vector moved = kinematics().difference(event_.at.point.state, state);
      if (moved.norm() > 2 * amplitude || newton_.energy().passage(event_.at.point.state, state) < 1) continue;
      SideBranch side{assess(newton_, state, report), {}, along};
      const double load = state.load_factor - event_.at.point.state.load_factor;
      const double size = std::sqrt(metric_.dot(moved, load, moved, load));
      side.direction = direction_of(side.first, metric_, {moved / size, load / size});
      return side;
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
  const Kinematics& kinematics() const { return newton_.energy().kinematics(); }
  const Eigen::MatrixXd& zero() const { return event_.at.zero_modes; }
  Newton& newton_;
  const Event& event_;
  Metric metric_;
};

// Angles in [0, π) at which the force along the circle vanishes; only 0 where it vanishes everywhere.
std::vector<double> angles_between(const Switch& s, const Vector& u, const Vector& v) {
  const double amplitude = 2 * first_turn / std::max(s.turn(u), s.turn(v));
  std::vector<double> force(rays + 1);
  const double step = pi / rays, shift = step / 3;             // rays beside the axes of symmetry
  for (int k = 0; k <= rays; ++k) force[k] = s.around(shift + k * step, u, v, amplitude);
  double largest = 0;
  for (const double f : force) largest = std::max(largest, std::abs(f));
  if (largest <= no_force) return {0.0};
  std::vector<double> angles;
  for (int k = 0; k < rays; ++k) {
    if ((force[k] < 0) == (force[k + 1] < 0)) continue;
    const auto zero = find_zero({shift + k * step, force[k], {}}, {shift + (k + 1) * step, force[k + 1], {}}, 1e-9,
                                [&](double t, const Sample&) -> std::optional<Sample> {
      return Sample{t, s.around(t, u, v, amplitude), {}};
    });
    if (zero) angles.push_back(zero->t);
  }
  return angles;
}

// Whether one is an image of the other: at the same distance the same load factor and energy, beside their changes.
bool images(const Kinematics& kinematics, const Equilibrium& at, const SideBranch& a, const SideBranch& b) {
  const auto shape = [&](const SideBranch& side) { return kinematics.extend(side.leaving).colwise().norm().eval().lpNorm<4>(); };
  const auto close = [](double x, double y, double from) { return std::abs(x - y) <= same * std::max(std::abs(x - from), std::abs(y - from)) + 64 * epsilon * std::abs(from); };
  return close(a.first.point.state.load_factor, b.first.point.state.load_factor, at.point.state.load_factor) &&
         close(a.first.point.energy.total(), b.first.point.energy.total(), at.point.energy.total()) &&
         std::abs(shape(a) - shape(b)) <= 1e3 * same * shape(a);
}

}  // namespace

std::vector<SideBranch> side_branches(Newton& newton, const Event& branch_point, const Metric& metric) {
  const Switch s(newton, branch_point, metric);
  const Eigen::MatrixXd& modes = branch_point.modes;
  std::vector<Vector> rays_found;
  if (modes.cols() == 1) rays_found.push_back(modes.col(0));
  for (Eigen::Index i = 0; i < modes.cols(); ++i)
    for (Eigen::Index j = i + 1; j < modes.cols(); ++j)
      for (const double angle : angles_between(s, modes.col(i), modes.col(j)))
        rays_found.push_back(std::cos(angle) * modes.col(i) + std::sin(angle) * modes.col(j));
  std::vector<SideBranch> found;
  for (const Vector& ray : rays_found) {
    const std::optional<SideBranch> one = s.leave(ray), other = s.leave(-ray);
    const auto known = [&](const SideBranch& side) {
      return std::any_of(found.begin(), found.end(), [&](const SideBranch& f) { return images(newton.energy().kinematics(), branch_point.at, side, f); });
    };
    const bool new_one = one && (modes.cols() == 1 || !known(*one)), new_other = other && (modes.cols() == 1 || !known(*other));
    if (new_one) found.push_back(*one);
    if (new_other) found.push_back(*other);
  }
  return found;
}

}  // namespace elamin
