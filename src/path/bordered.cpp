#include "path/bordered.hpp"

#include "energy/step_limits.hpp"

#include <cmath>
#include <limits>

namespace elamin {

ArcStep::ArcStep(Energy& energy, const Equilibrium& from, int direction) : energy_(energy), from_(from) {
  const double length = from.tangent.norm();
  weight_ = length > 0 ? 1 / (length * length) : 1.0;
  t_lambda_ = direction / std::sqrt(1 + weight_ * length * length);
  t_x_ = t_lambda_ * from.tangent;
}

Equilibrium ArcStep::equilibrium(Newton& newton, double s) const {
  Factors& factors = newton.factors();
  const Kinematics& kinematics = energy_.kinematics();
  const Eigen::MatrixXd& zero = from_.zero_modes;
  const auto project = [&](Vector v) {
    if (zero.cols() > 0) v -= zero * (zero.transpose() * v);
    return v;
  };
  State state = from_.point.state;
  double lambda = state.load_factor + s * t_lambda_;
  kinematics.prescribe(state, lambda);
  kinematics.retract(state, t_x_, s);
  Equilibrium result;
  Report& report = result.point.report;
  constexpr int most = 20;
  double last = std::numeric_limits<double>::infinity();
  for (; report.iterations < most; ++report.iterations) {
    energy_.evaluate(state);
    report.residual = energy_.relative(project(energy_.gradient()));
    // Block elimination: Δx = a + Δλ b,  H a = −g,  H b = −∂g/∂λ. What it loses close to a singular H, the next
    // iteration mends, as residuals are exact.
    if (!factors.try_pivoted(0)) factors.try_pivoted(factors.zero_level());
    const Vector a = project(factors.pivoted().solve(project(-energy_.gradient())));
    const Vector b = project(factors.pivoted().solve(project(-energy_.load_derivative())));
    const double change = -weight_ * t_x_.dot(a) / (weight_ * t_x_.dot(b) + t_lambda_);
    const Vector step = a + change * b;
    const double size = std::sqrt(weight_ * step.squaredNorm() + change * change);
    if (!std::isfinite(size) || size > 2 * last || distortion(energy_, state, step) > 0.5) break;
    lambda += change;
    kinematics.prescribe(state, lambda);
    kinematics.retract(state, step);
    if (size <= 1e-13 * std::abs(s) || (report.residual <= 1e-13 && size <= 1e-9 * std::abs(s)) || (size > 0.3 * last && report.residual < 1e-12)) {
      report.status = Status::converged, report.why = "the arc-length corrector converged";
      break;
    }
    last = size;
  }
  if (!report.converged()) {
    report.why = "the arc-length corrector does not contract";
    result.point.state = state;
    return result;
  }
  energy_.evaluate(state);
  Report done = report;
  done.energy = energy_.last_terms().total();
  done.residual = energy_.relative(project(energy_.gradient()));
  return assess(newton, state, done);
}

}  // namespace elamin
