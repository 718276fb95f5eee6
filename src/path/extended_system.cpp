#include "path/extended_system.hpp"

#include "energy/step_limits.hpp"
#include "path/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace elamin {

using namespace limits;

// The conditions' derivatives along directions of unit length, and what the conditions lack, both in parts of the largest derivative. The last
// row is that of one condition more.
struct ExtendedSystem::Linear {
  std::vector<CurveDirection> directions;       // (v, 0, 0) but of a contact, (p_L, δ_L, 0), (p_M, δ_M, 1)
  CurveDirection rest;                          // (p₀, δ₀, 0)
  Eigen::MatrixXd a;                            // square
  Vector b;
};

std::shared_ptr<Variant> ExtendedSystem::variant(double second) {
  for (const auto& [value, there] : recent_)
    if (value == second) return there;
  std::shared_ptr<Variant> made = variants_(second);
  recent_.emplace_front(second, made);
  if (recent_.size() > curve::kept_variants) recent_.pop_back();
  return made;
}

// The state in the structure at its new μ: what is free goes with the places at rest, and by the step besides.
State ExtendedSystem::moved(const Threshold& from, const CurveDirection& by) {
  const std::shared_ptr<Variant> here = variant(from.second), there = variant(from.second + by.second);
  State state = from.at.point.state;
  if (here != there) {
    const State &a = here->model.start, &b = there->model.start;
    for (Eigen::Index i = 0; i < state.particles(); ++i) state.set(i, state.at(i) + (b.at(i) - a.at(i)));
    for (std::size_t k = 0; k < state.bodies.size(); ++k)
      state.bodies[k].position = state.bodies[k].position + (b.bodies[k].position - a.bodies[k].position);
  }
  there->energy.kinematics().prescribe(state, from.at.point.state.load_factor + by.load);
  there->energy.kinematics().retract(state, by.x);
  return state;
}

void ExtendedSystem::move(Threshold& point, const CurveDirection& by) {
  point.at.point.state = moved(point, by), point.second += by.second;
}

CurveDirection ExtendedSystem::way(const Threshold& from, const Threshold& to) {
  const State& there = to.at.point.state;
  const Kinematics& kinematics = variant(to.second)->energy.kinematics();
  const CurveDirection rest{Vector::Zero(kinematics.dofs()), there.load_factor - from.at.point.state.load_factor, to.second - from.second};
  return {kinematics.difference(moved(from, rest), there), rest.load, rest.second};
}

// How far along a direction of unit length a central difference goes: ε^(1/3) of a turn of the bonds by a radian, of the scale of λ, of
// that of μ and of the overlap of every contact, where its rounding ε/h and what it leaves out, h²/6 of the third derivative, are alike.
double ExtendedSystem::step_of(const Threshold& at, const CurveDirection& along) {
  const double part = std::cbrt(epsilon), turn = step_size(variant(at.second)->energy, at.at.point.state, along.x, along.load);
  const double h = part / std::max({turn, std::abs(along.load) / metric.load, std::abs(along.second) / metric.second});
  const State beside = moved(at, along * h);
  Energy &here = variant(at.second)->energy, &there = variant(at.second + h * along.second)->energy;
  double within = 1;
  for (const ContactKey& key : closed_contacts(here, at.at.point.state)) {
    if (key.feature >= 0 || (at.kind == EventKind::contact && key == at.contact)) continue;
    const double overlap = gap(here, key, at.at.point.state), change = std::abs(gap(there, key, beside) - overlap);
    if (change > part * std::abs(overlap)) within = std::min(within, part * std::abs(overlap) / change);
  }
  return h * std::max(within, curve::least_within);
}

// What a function of the structure and the state has beside a point.
auto ExtendedSystem::beside(const Threshold& at, const CurveDirection& by, const auto& value) {
  const State state = moved(at, by);
  return value(variant(at.second + by.second)->energy, state);
}

// Its derivative along a direction.
auto ExtendedSystem::rate(const Threshold& at, const CurveDirection& along, const auto& value) {
  const double h = step_of(at, along);
  auto rate = beside(at, along * -h, value);
  rate = (beside(at, along * h, value) - rate) / (2 * h);
  return rate;
}

double ExtendedSystem::gap_rate(const Threshold& at, const CurveDirection& along) {
  return rate(at, along, [&](const Energy& energy, const State& state) { return gap(energy, at.contact, state); });
}

// ∂g/∂μ, what is free going with the places at rest.
Vector ExtendedSystem::second_derivative(const Threshold& at) {
  const CurveDirection along{Vector::Zero(variant(at.second)->energy.dofs()), 0, metric.second};
  const auto force = [](Energy& energy, const State& state) {
    energy.evaluate(state, false);
    return energy.gradient();
  };
  if (at.kind != EventKind::contact) return rate(at, along, force) / metric.second;
  // The force of a contact begins like the power 3/2 of its overlap: (−3 f(0) + 4 f(h) − f(2h))/(2h) on the side on which it is open.
  const double h = step_of(at, along) * (gap_rate(at, along) < 0 ? -1 : 1);
  const auto there = [&](double part) { return beside(at, along * part, force); };
  return (-3 * there(0) + 4 * there(h) - there(2 * h)) / (2 * h * metric.second);
}

ExtendedSystem::Linear ExtendedSystem::linearise(Threshold& point) {
  const std::shared_ptr<Variant> here = variant(point.second);
  const Vector by_second = second_derivative(point);
  Energy& energy = here->energy;
  Factors& factors = here->newton.factors();
  const State& state = point.at.point.state;
  energy.evaluate(state);
  const Vector g = energy.gradient(), load = energy.load_derivative();
  if (!factors.factorize_holding(side_by_side(point.at.zero_modes, point.modes))) throw NotFollowed(factors.why_none());

  Linear linear;
  std::vector<CurveDirection>& directions = linear.directions;
  const bool critical = point.kind != EventKind::contact;
  Vector v;
  double theta = 0;
  if (critical) {
    for (Eigen::Index j = 0; j < point.modes.cols(); ++j) {
      const Vector phi = point.modes.col(j);
      point.modes.col(j) = phi - factors.solve_holding(energy.multiply(phi));
    }
    const Vector before = point.modes.col(0);
    point.modes = orthonormal(point.modes);
    if (point.modes.col(0).dot(before) < 0) point.modes.col(0) *= -1;
    v = point.modes.col(0), theta = energy.quadratic_form(v);
    directions.push_back(metric.unit({v, 0, 0}));
  }
  // Where the load factor alone moves the equilibrium, and then across that direction.
  const CurveDirection by_load = metric.unit({-factors.solve_holding(load), 1, 0});
  const Vector row = by_load.x / (metric.length * metric.length);
  const double corner = by_load.load / (metric.load * metric.load);
  const auto solve = [&](const Vector& b, double beta, double second) {
    const Factors::Bordered s = factors.solve_bordered(load, row, corner, b, beta);
    return CurveDirection{s.p, s.delta, second};
  };
  directions.push_back(point.way = metric.unit(solve(Vector::Zero(g.size()), 1, 0)));
  directions.push_back(metric.unit(solve(-by_second, 0, 1)));
  linear.rest = solve(-g, 0, 0);

  const Eigen::Index count = static_cast<Eigen::Index>(directions.size());
  linear.a.setOnes(count, count), linear.b.setZero(count);
  if (!critical) {
    for (Eigen::Index k = 0; k < count; ++k) linear.a(0, k) = gap_rate(point, directions[k]);
    linear.b[0] = -gap(energy, point.contact, state);
  } else {
    const CurveDirection& way = directions[1];
    Eigen::RowVector3d force, work, curvature;
    double size = 0;                                          // of the terms of `work`
    for (Eigen::Index k = 0; k < count; ++k) {
      const CurveDirection& d = directions[k];
      const Eigen::MatrixX2d r = rate(point, d, [&](Energy& there, const State& place) {
        there.evaluate(place);
        return (Eigen::MatrixX2d(v.size(), 2) << there.multiply(v), there.load_derivative()).finished();
      });
      const auto by_hv = r.col(0), by_load_derivative = r.col(1);
      curvature[k] = v.dot(by_hv);
      force[k] = k == 0 ? theta * d.x.dot(v) : v.dot(load) * d.load + v.dot(by_second) * d.second;
      // δv = P(−δH v), so that vᵀ∂g/∂λ changes by vᵀδ(∂g/∂λ) + (δH v)ᵀp_λ, here times δ_L.
      work[k] = way.load * v.dot(by_load_derivative) + way.x.dot(by_hv);
      size = std::max(size, std::abs(way.load) * by_load_derivative.norm() + way.x.norm() * by_hv.norm());
      if (k == 0) point.asymmetry = curvature[0] / std::max(by_hv.norm(), std::numeric_limits<double>::min());
    }
    // Where two branch points meet the work of the load does not tell how far along the mode they are, which symmetry keeps as it was.
    const bool told = work.cwiseAbs().maxCoeff() > curve::no_row * size;
    if (point.kind == EventKind::limit) linear.a.row(0) = force, linear.b[0] = -(v.dot(g) + v.dot(load) * linear.rest.load);
    else if (told) linear.a.row(0) = work, linear.b[0] = -way.load * v.dot(load);
    else linear.a.row(0) = Eigen::RowVector3d::UnitX(), linear.b[0] = 0;
    linear.a.row(1) = curvature, linear.b[1] = -theta;
  }
  const Vector scale = linear.a.cwiseAbs().rowwise().maxCoeff();
  if (!(scale.minCoeff() > 0)) throw NotFollowed("the conditions do not depend on anything");
  linear.a.array().colwise() /= scale.array(), linear.b.array() /= scale.array();
  return linear;
}

// The equilibrium with its critical modes held, across its way, where a step has left forces: axial ones grow with its square.
void ExtendedSystem::settle(Threshold& point) {
  const std::shared_ptr<Variant> here = variant(point.second);
  const Eigen::MatrixXd held = side_by_side(point.at.zero_modes, point.modes);
  Plane across{Vector::Zero(here->energy.dofs()), 1};
  if (point.way.x.size() > 0)
    across = {point.way.x / (metric.length * metric.length), point.way.load / (metric.load * metric.load), metric.length, metric.load};
  across.guided = held.cols() > 0;
  const Report report = here->newton.correct(point.at.point.state, held, nullptr, curve::most_settling, &across);
  if (!report.converged()) throw NotFollowed(report.why);
}

void ExtendedSystem::solve(Threshold& point, const CurveDirection* across) {
  const Threshold predicted = point;
  double last = std::numeric_limits<double>::infinity();
  int stalled = 0;
  for (int k = 0; k <= curve::most_iterations; ++k) {
    settle(point);
    auto [directions, rest, a, b] = linearise(point);
    const Eigen::Index n = b.size();
    for (Eigen::Index j = 0; j < n; ++j) a(n - 1, j) = across ? metric.dot(*across, directions[j]) : directions[j].second / metric.second;
    if (across) b[n - 1] = -metric.dot(*across, way(predicted, point)) - metric.dot(*across, rest);
    const Vector u = solved(a, b);
    CurveDirection step = rest;
    for (Eigen::Index j = 0; j < n; ++j) step = step + directions[j] * u[j];
    if (!across) step.second = 0;
    const double size = std::sqrt(metric.dot(step, step) + metric.dot(rest, rest));
    if (!std::isfinite(size) || size > curve::longest_correction) throw NotFollowed("Newton's method leads far away");
    const bool shrinks = size <= last / 2;
    if (!shrinks && k >= 2 && last > curve::at_rest) throw NotFollowed("Newton's method does not contract");
    stalled += !shrinks;
    if (stalled < 2) move(point, step);
    last = size;
    if (size > curve::rounding && stalled < 2) continue;
    // Of a branch point only the part of the forces that its mode does not feel was asked to vanish.
    const std::shared_ptr<Variant> here = variant(point.second);
    here->energy.evaluate(point.at.point.state, false);
    const double residual = here->energy.relative(here->energy.gradient());
    if (!(residual <= here->newton.tolerance()))
      throw NotFollowed(fmt::format("a force of {:.2g} is left along the critical mode: the branches do not meet any more", residual));
    // The tangent fulfils the conditions' derivatives: a row of cofactors.
    CurveDirection tangent{Vector::Zero(step.x.size())};
    for (Eigen::Index j = 0; j < n; ++j) {
      a.row(n - 1) = Eigen::RowVectorXd::Unit(n, j);
      tangent = tangent + directions[j] * a.determinant();
    }
    if (!(metric.dot(tangent, tangent) > 0)) throw NotFollowed("two curves meet");
    point.direction = metric.unit(tangent);
    const double sense = across ? metric.dot(*across, point.direction) : point.direction.second;
    if (sense < 0) point.direction = point.direction * -1;
    return;
  }
  throw NotFollowed("too many iterations");
}

void ExtendedSystem::assess_at(Threshold& point) {
  const std::shared_ptr<Variant> here = variant(point.second);
  Energy& energy = here->energy;
  energy.evaluate(point.at.point.state);
  Report report;
  report.status = Status::converged, report.residual = energy.relative(energy.gradient());
  const Eigen::MatrixXd known = point.at.zero_modes;
  point.at = assess(here->newton, point.at.point.state, report);
  // The critical ones do not count as negative, on whichever side of zero rounding has put them.
  const Eigen::Index unseen = point.modes.cols() - std::max<Eigen::Index>(0, point.at.zero_modes.cols() - known.cols());
  for (Eigen::Index j = 0; j < unseen; ++j) point.at.point.stability.negative -= energy.quadratic_form(point.modes.col(j)) < 0;
  const Eigen::MatrixXd others = without_modes(point.at.zero_modes, point.modes);
  point.at.zero_modes = others.cols() == known.cols() ? others : known;
  point.at.point.multiplicity = static_cast<int>(point.modes.cols());
  point.at.point.modes = point.modes;
  if (point.modes.cols() > 0) point.at.point.stability.stable = false;
}

}  // namespace elamin
