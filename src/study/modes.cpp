#include "study/modes.hpp"

#include "core/interrupt.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

struct NamedMode { Vector v; std::string name; };       // over the dofs

// The zero modes, turned: first the rigid motions that lie in their span, made orthonormal in this order, then the rest,
// which has one name or none.
std::vector<NamedMode> named(Energy& energy, const Equilibrium& e) {
  constexpr double independent = 1e-3;
  const Eigen::MatrixXd& zero = e.zero_modes;
  std::vector<std::string> names = e.point.stability.zero_modes;
  std::vector<NamedMode> modes;
  Eigen::MatrixXd basis(zero.rows(), 0);
  if (zero.cols() == 0) return modes;
  for (const RigidMotion& m : e.motions) {
    const auto name = std::find(names.begin(), names.end(), m.name);
    if (name == names.end()) continue;
    names.erase(name);
    Vector v = energy.kinematics().restrict(m.velocity_field(energy.kinematics().sites())).normalized();
    v = zero * (zero.transpose() * v);
    for (int twice = 0; twice < 2; ++twice) v -= basis * (basis.transpose() * v);
    if (v.norm() < independent) continue;
    v.normalize();
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols(1) = v;
    modes.push_back({v, m.name});
  }
  const Eigen::Index left = zero.cols() - basis.cols();
  if (left > 0) {
    const Singular svd = singular_values(zero - basis * (basis.transpose() * zero));
    const Eigen::MatrixXd rest = canonical_modes(energy.kinematics(), svd.u.leftCols(left));
    const std::string name = e.point.stability.stable && !names.empty() ? names.back() : "";
    for (Eigen::Index k = 0; k < left; ++k) modes.push_back({rest.col(k), name});
  }
  return modes;
}

// Modes whose eigenvalues cannot be told apart, one cluster after the other, in their canonical choice.
std::vector<NamedMode> distinct(const Energy& energy, const Vector& values, const Eigen::MatrixXd& vectors) {
  constexpr double same = 1e-8;
  std::vector<NamedMode> modes;
  for (Eigen::Index first = 0, last; first < values.size(); first = last) {
    last = first + 1;
    while (last < values.size() && values[last] - values[first] <= same * std::abs(values[last])) ++last;
    const Eigen::MatrixXd cluster = canonical_modes(energy.kinematics(), vectors.middleCols(first, last - first));
    for (Eigen::Index k = 0; k < cluster.cols(); ++k) modes.push_back({cluster.col(k), ""});
  }
  return modes;
}

}  // namespace

std::vector<Mode> lowest_modes(Newton& newton, const Equilibrium& e, int count) {
  Energy& energy = newton.energy();
  const int negative = e.point.stability.negative, zero = static_cast<int>(e.zero_modes.cols());
  // All zero modes, or the named ones could not be picked out of their span; one mode more, so that a pair is not cut.
  constexpr double accuracy = 1e-14;                     // of the eigenvalues; of the vectors its root
  const EigenPairs pairs = newton.factors().lowest(std::max(count + 1, negative + zero), 0, accuracy);
  const Eigen::Index behind = std::min<Eigen::Index>(negative + zero, pairs.values.size());
  const auto part = [&](Eigen::Index from, Eigen::Index to) {
    return distinct(energy, pairs.values.segment(from, to - from), pairs.vectors.middleCols(from, to - from));
  };
  std::vector<NamedMode> all = part(0, std::min<Eigen::Index>(negative, pairs.values.size()));
  for (const std::vector<NamedMode>& more : {named(energy, e), part(behind, pairs.values.size())})
    all.insert(all.end(), more.begin(), more.end());
  all.resize(std::min<std::size_t>(all.size(), count));
  std::vector<Mode> modes;
  for (const NamedMode& m : all) modes.push_back({energy.quadratic_form(m.v), m.name, energy.kinematics().extend(m.v, e.point.state)});
  return modes;
}

Outcome trace_modes(const Problem& problem, Newton& newton, const Sink& sink) {
  State state = starting_state(problem, newton.energy());
  newton.energy().evaluate(state);
  const Report report = newton.correct(state, assess(newton, state, {}).zero_modes);
  Equilibrium e = assess(newton, state, report);
  if (!report.converged()) {
    sink.point(e.point, true);
    return {report.status, report.why};
  }
  const std::vector<Mode> modes = lowest_modes(newton, e, problem.modes.count);
  if (interrupted()) return tell_interrupted(newton, state, sink);
  sink.modes(e.point, modes);
  return {report.status, std::to_string(modes.size()) + " lowest modes; " + report.why};
}

std::vector<double> LowestEigenvalues::at(const State& state) {
  constexpr int more = 4;
  constexpr double accuracy = 1e-14;
  energy_.evaluate(state);
  const double guess = before_.values.size() > 0 ? std::max(0.0, -2 * before_.values[0]) : 0.0;
  before_ = factors_.lowest(count_ + more, guess, accuracy, before_.vectors);
  const Eigen::Index count = std::min<Eigen::Index>(count_, before_.values.size());
  return {before_.values.data(), before_.values.data() + count};
}

}  // namespace elamin
