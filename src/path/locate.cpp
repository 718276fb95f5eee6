#include "path/locate.hpp"

#include "path/bordered.hpp"
#include "path/root.hpp"

#include <cmath>

namespace elamin {

namespace {

// The eigenvalue number `index` (from 0, ascending) that belongs to neither a rigid motion nor a symmetry.
double eigenvalue(Newton& newton, const Equilibrium& e, int index) {
  newton.energy().evaluate(e.point.state);
  const int zeros = static_cast<int>(e.zero_modes.cols());
  const EigenPairs pairs = newton.factors().lowest(index + zeros + 1);
  std::vector<double> values;
  for (Eigen::Index j = 0; j < pairs.values.size(); ++j)
    if (zeros == 0 || (e.zero_modes.transpose() * pairs.vectors.col(j)).norm() < 0.5) values.push_back(pairs.values[j]);
  return index < static_cast<int>(values.size()) ? values[index] : values.empty() ? 0.0 : values.back();
}

// Eigenvectors whose eigenvalues are zero beside `scale`, without the zero modes that were there before.
Eigen::MatrixXd critical_modes(Newton& newton, const Equilibrium& e, int index, double scale, const Eigen::MatrixXd& known) {
  newton.energy().evaluate(e.point.state);
  constexpr int most_multiple = 6;
  const EigenPairs pairs = newton.factors().lowest(index + static_cast<int>(known.cols()) + most_multiple);
  Eigen::MatrixXd modes(pairs.vectors.rows(), 0);
  for (Eigen::Index j = 0; j < pairs.values.size(); ++j) {
    if (std::abs(pairs.values[j]) > scale) continue;
    if (known.cols() > 0 && (known.transpose() * pairs.vectors.col(j)).norm() > 0.5) continue;
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
      const Eigen::MatrixXd modes = critical_modes(newton, from.e, index, 1e-5 * scale, known);
      start.zero_modes.resize(modes.rows(), known.cols() + modes.cols());
      if (known.cols() > 0) start.zero_modes.leftCols(known.cols()) = known;
      start.zero_modes.rightCols(modes.cols()) = modes;
      start.tangent -= modes * (modes.transpose() * start.tangent);
    }
    Equilibrium e = continue_to(newton, start, t);
    if (!e.point.report.converged()) return {};
    e.zero_modes = known;
    return Sample{t, eigenvalue(newton, e, index), std::move(e)};
  });
  if (!zero || std::abs(zero->f) > 1e-6 * scale) return {};
  return finish(newton, zero->e, EventKind::branch, index, std::max(1e-7 * scale, 0.0), known);
}

std::optional<Event> locate_limit(Newton& newton, const Equilibrium& a, double reach) {
  const int index = a.point.stability.negative;
  const Eigen::MatrixXd known = a.zero_modes;
  const ArcStep arc(newton.energy(), a, reach > a.point.state.load_factor ? 1 : -1);
  Sample lower{0, eigenvalue(newton, a, index), a};
  const auto evaluate = [&](double s, const Sample&) -> std::optional<Sample> {
    Equilibrium e = arc.equilibrium(newton, s);
    if (!e.point.report.converged()) return {};
    e.zero_modes = known;
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
