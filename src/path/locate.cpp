#include "path/locate.hpp"

#include "path/bordered.hpp"
#include "path/root.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

// The lowest eigenpairs at the equilibrium without the known zero modes Z: of the span V of so many eigenvectors more as
// there are known ones, what is orthogonal to VᵀZ. So it does not matter how a critical mode and a zero mode mix where
// their eigenvalues meet, and the stiff directions, in which Z is not exact beside its own state, stay out.
// `e.lowest` is where the search begins and what it leaves for a neighbour.
EigenPairs lowest_but(Newton& newton, Equilibrium& e, const Eigen::MatrixXd& known, int count) {
  newton.energy().evaluate(e.point.state);
  const double guess = e.lowest.values.size() > 0 ? 2 * e.lowest.values.cwiseAbs().maxCoeff() : 0.0;
  const EigenPairs pairs = e.lowest = newton.factors().lowest(count + static_cast<int>(known.cols()), guess, 1e-11, e.lowest.vectors);
  if (known.cols() == 0 || pairs.values.size() <= known.cols()) return pairs;
  const Eigen::MatrixXd Q = Eigen::HouseholderQR<Eigen::MatrixXd>(pairs.vectors.transpose() * known).householderQ();
  const Eigen::MatrixXd others = Q.rightCols(pairs.values.size() - known.cols());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> small(others.transpose() * pairs.values.asDiagonal() * others);
  return {small.eigenvalues(), pairs.vectors * (others * small.eigenvectors())};
}

// The eigenvalue number `index` (from 0, ascending) that belongs to neither a rigid motion nor a symmetry.
double eigenvalue(Newton& newton, Equilibrium& e, int index) {
  const Vector values = lowest_but(newton, e, e.zero_modes, index + 1).values;
  return values.size() == 0 ? 0.0 : values[std::min<Eigen::Index>(index, values.size() - 1)];
}

// Eigenvectors whose eigenvalues are zero beside `scale`, without the zero modes that were there before.
Eigen::MatrixXd critical_modes(Newton& newton, Equilibrium& e, int index, double scale, const Eigen::MatrixXd& known) {
  constexpr int most_multiple = 6;
  const EigenPairs pairs = lowest_but(newton, e, known, index + most_multiple);
  Eigen::MatrixXd modes(pairs.vectors.rows(), 0);
  for (Eigen::Index j = 0; j < pairs.values.size(); ++j)
    if (std::abs(pairs.values[j]) <= scale) {
      modes.conservativeResize(Eigen::NoChange, modes.cols() + 1);
      modes.rightCols(1) = pairs.vectors.col(j);
    }
  return canonical_modes(newton.energy().kinematics(), modes);
}

// Zero modes of the branch: those that both ends have.
Eigen::MatrixXd persistent(const Equilibrium& a, const Equilibrium& b) {
  return a.zero_modes.cols() <= b.zero_modes.cols() ? a.zero_modes : b.zero_modes;
}

Event finish(Newton& newton, Equilibrium at, EventKind kind, int index, double scale, const Eigen::MatrixXd& known) {
  Event event;
  event.kind = kind;
  event.modes = critical_modes(newton, at, index, scale, known);
  at.point.multiplicity = static_cast<int>(event.modes.cols());
  at.point.stability.stable = false;
  event.at = std::move(at);
  return event;
}

}  // namespace

std::optional<Event> locate_crossing(Newton& newton, const Equilibrium& a, const Equilibrium& b) {
  const int before = a.point.stability.negative, after = b.point.stability.negative;
  const int index = after > before ? before : before - 1;      // the sorted eigenvalue that changes sign first
  const Eigen::MatrixXd known = persistent(a, b);
  Equilibrium first = a, second = b;
  first.zero_modes = second.zero_modes = known;
  Sample lower{a.point.state.load_factor, eigenvalue(newton, first, index), first};
  if (std::abs(lower.f) <= newton.factors().zero_level() && a.zero_modes.cols() > known.cols())   // a is the event itself
    return finish(newton, first, EventKind::branch, index, newton.factors().zero_level(), known);
  Sample upper{b.point.state.load_factor, eigenvalue(newton, second, index), second};
  if ((lower.f < 0) == (upper.f < 0)) return {};
  const double scale = std::max(std::abs(lower.f), std::abs(upper.f));
  const double resolution = 1e-14 * std::max(std::abs(lower.t), std::abs(upper.t));
  const std::optional<Sample> zero = find_zero(lower, upper, resolution, [&](double t, const Sample& from) -> std::optional<Sample> {
    Equilibrium start = from.e;
    if (std::abs(from.f) < 1e-6 * scale) {                     // close by, the critical modes stay as they are
      const Eigen::MatrixXd modes = critical_modes(newton, start, index, 1e-5 * scale, known);
      start.zero_modes.resize(modes.rows(), known.cols() + modes.cols());
      if (known.cols() > 0) start.zero_modes.leftCols(known.cols()) = known;
      start.zero_modes.rightCols(modes.cols()) = modes;
      start.tangent -= modes * (modes.transpose() * start.tangent);
    }
    Equilibrium e = continue_to(newton, start, t);
    if (!e.point.report.converged()) return {};
    e.zero_modes = known, e.lowest = from.e.lowest;
    return Sample{t, eigenvalue(newton, e, index), std::move(e)};
  });
  if (!zero || std::abs(zero->f) > 1e-6 * scale) return {};
  return finish(newton, zero->e, EventKind::branch, index, std::max(1e-7 * scale, 4 * std::abs(zero->f)), known);
}

std::optional<Event> locate_limit(Newton& newton, const Equilibrium& a, double reach) {
  const int index = a.point.stability.negative;
  const Eigen::MatrixXd known = a.zero_modes;
  const ArcStep arc(newton.energy(), a, reach > a.point.state.load_factor ? 1 : -1);
  Equilibrium first = a;
  Sample lower{0, eigenvalue(newton, first, index), first};
  const auto evaluate = [&](double s, const Sample& from) -> std::optional<Sample> {
    Equilibrium e = arc.equilibrium(newton, s);
    if (!e.point.report.converged()) return {};
    e.zero_modes = known, e.lowest = from.e.lowest;
    return Sample{s, eigenvalue(newton, e, index), std::move(e)};
  };
  constexpr int most = 60;
  double s = 1e-3 * std::abs(reach - a.point.state.load_factor);
  std::optional<Sample> upper;
  for (int k = 0; k < most; ++k) {
    std::optional<Sample> next = evaluate(s, lower);
    if (next && (next->f < 0) != (lower.f < 0)) {
      upper = next;
      break;
    }
    if (next && k < 40) s *= 2;
    else if (!next) s /= 3;
    if (s < 1e-14 * std::abs(reach - a.point.state.load_factor)) return {};
  }
  if (!upper) return {};
  const double scale = std::abs(lower.f);
  const std::optional<Sample> zero = find_zero(lower, *upper, 1e-9 * upper->t, evaluate);
  if (!zero) return {};
  return finish(newton, zero->e, EventKind::limit, index, std::max(1e-4 * scale, 4 * std::abs(zero->f)), known);
}

}  // namespace elamin
