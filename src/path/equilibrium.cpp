#include "path/equilibrium.hpp"

#include "model/rigid_motion.hpp"

#include <cmath>

namespace elamin {

namespace {

// Solves H t = b in the complement of the zero modes, with whichever factorisation exists.
Vector solve_projected(Factors& factors, const Eigen::MatrixXd& zero, Vector b) {
  const auto project = [&](Vector v) {
    if (zero.cols() > 0) v -= zero * (zero.transpose() * v);
    return v;
  };
  b = project(b);
  if (zero.cols() == 0 && factors.try_cholesky(0)) return factors.cholesky().solve(b);
  const double shift = zero.cols() > 0 ? 100 * factors.zero_level() : 0.0;
  if (!factors.try_pivoted(shift)) factors.try_pivoted(shift + factors.zero_level());
  return project(factors.pivoted().solve(b));
}

// Names of the free rigid motions that lie in the span of the zero modes; true if they explain all of it.
bool name_zero_modes(const Energy& energy, const State& state, const Eigen::MatrixXd& zero, std::vector<std::string>& names) {
  constexpr double close = 1e-3;
  Eigen::MatrixXd rigid(zero.rows(), 0);
  for (const RigidMotion& m : free_rigid_motions(energy.model(), state)) {
    Vector v = energy.kinematics().restrict(m.velocity);
    if (v.norm() == 0) continue;
    v.normalize();
    if ((v - zero * (zero.transpose() * v)).norm() > close) continue;
    names.push_back(m.name);
    v -= rigid * (rigid.transpose() * v);
    rigid.conservativeResize(Eigen::NoChange, rigid.cols() + 1);
    rigid.rightCols(1) = v.normalized();
  }
  return rigid.cols() == zero.cols();
}

}  // namespace

Equilibrium assess(Newton& newton, const State& state, const Report& report) {
  Energy& energy = newton.energy();
  Equilibrium e;
  e.point.state = state;
  e.point.report = report;
  energy.evaluate(state);
  e.point.energy = energy.last_terms();
  const Inertia inertia = newton.factors().inertia();
  Stability& s = e.point.stability;
  s.negative = inertia.negative, s.zero = inertia.zero;
  bool named = true;
  if (inertia.zero > 0) {
    const EigenPairs lowest = newton.factors().lowest(inertia.negative + inertia.zero);
    e.zero_modes = lowest.vectors.rightCols(inertia.zero);
    named = name_zero_modes(energy, state, e.zero_modes, s.zero_modes);
  }
  s.stable = s.negative == 0 && named;
  e.tangent = solve_projected(newton.factors(), e.zero_modes, -energy.load_derivative());
  return e;
}

Equilibrium continue_to(Newton& newton, const Equilibrium& from, double load_factor) {
  const Kinematics& kinematics = newton.energy().kinematics();
  State predicted = from.point.state;
  const Vector step = (load_factor - from.point.state.load_factor) * from.tangent;
  kinematics.prescribe(predicted, load_factor);
  kinematics.retract(predicted, step);
  State state = predicted;
  Report report = newton.correct(state, from.zero_modes, &from.point.state);
  if (report.converged()) {
    const Field corrected = (state.position - predicted.position) + (state.tail - predicted.tail);
    if (kinematics.restrict(corrected).norm() > step.norm()) {
      report.status = Status::not_converged;
      report.why = "the corrector went further than the predictor";
    }
  }
  if (!report.converged()) {
    Equilibrium failed;
    failed.point.state = state, failed.point.report = report;
    return failed;
  }
  return assess(newton, state, report);
}

Eigen::MatrixXd canonical_modes(const Kinematics& kinematics, const Eigen::MatrixXd& modes) {
  Eigen::MatrixXd left = modes, chosen(modes.rows(), 0);
  while (left.cols() > 0) {
    Vector best = left.col(0);
    for (int c = 0; c < 3 && left.cols() > 1; ++c) {        // the part of the span that moves along this axis most
      Eigen::MatrixXd along = left;
      for (int d = 0; d < kinematics.dofs(); ++d)
        if (kinematics.coordinate_of(d) != c) along.row(d).setZero();
      const Eigen::JacobiSVD<Eigen::MatrixXd> svd(along, Eigen::ComputeThinV);
      if (svd.singularValues()[0] < 0.5) continue;
      best = left * svd.matrixV().col(0);
      break;
    }
    best.normalize();
    const double sum = best.sum();
    Eigen::Index lead = 0;
    const double largest = best.cwiseAbs().maxCoeff();
    while (std::abs(best[lead]) < 0.5 * largest) ++lead;
    if (std::abs(sum) > 1e-6 * best.lpNorm<1>() ? sum < 0 : best[lead] < 0) best = -best;
    chosen.conservativeResize(Eigen::NoChange, chosen.cols() + 1);
    chosen.rightCols(1) = best;
    // What is left of the span, orthonormal again.
    const Eigen::MatrixXd rest = left - best * (best.transpose() * left);
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rest, Eigen::ComputeThinU);
    left = svd.matrixU().leftCols(left.cols() - 1).eval();
  }
  return chosen;
}

}  // namespace elamin
