#include "path/extended_system.hpp"

#include "energy/step_limits.hpp"
#include "path/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace elamin {

using namespace limits;

// The conditions' derivatives (conditions × directions, which have unit length), and what the conditions lack.
struct ExtendedSystem::Linear {
  std::vector<CurveDirection> directions;       // (v, 0, 0) but of a contact, (p_L, δ_L, 0), (p_M, δ_M, 1)
  CurveDirection rest;                          // (p₀, δ₀, 0)
  Eigen::MatrixXd rows;
  Vector lacking;
};

namespace {

double largest(const std::vector<double>& row) {
  double most = 0;
  for (const double x : row) most = std::max(most, std::abs(x));
  return most;
}

void append(Eigen::MatrixXd& rows, Vector& lacking, const std::vector<double>& row, double value) {
  const Eigen::Map<const Eigen::RowVectorXd> r(row.data(), static_cast<Eigen::Index>(row.size()));
  const double scale = largest(row);
  if (!(scale > 0)) return;
  rows.conservativeResize(rows.rows() + 1, r.size());
  rows.bottomRows(1) = r / scale;
  lacking.conservativeResize(lacking.size() + 1);
  lacking.tail(1)[0] = -value / scale;
}

}  // namespace

std::shared_ptr<Variant> ExtendedSystem::variant(double second) {
  for (const auto& [value, there] : recent_)
    if (value == second) return there;
  std::shared_ptr<Variant> made = variants_(second);
  if (!made) return made;
  recent_.emplace_front(second, made);
  if (recent_.size() > curve::kept_variants) recent_.pop_back();
  return made;
}

// The state in the structure at its new μ: what is free goes with the places at rest, and by the step besides.
std::optional<State> ExtendedSystem::moved(const Threshold& from, const CurveDirection& by) {
  const std::shared_ptr<Variant> here = variant(from.second), there = by.second == 0 ? here : variant(from.second + by.second);
  if (!here || !there) return {};
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

bool ExtendedSystem::move(Threshold& point, const CurveDirection& by) {
  std::optional<State> state = moved(point, by);
  if (!state) return false;
  point.at.point.state = std::move(*state), point.second += by.second;
  return true;
}

// How far along a direction of unit length a central difference goes: ε^(1/3) of a turn of the bonds by a radian, of the scale of λ, of
// that of μ and of the overlap of every contact, where its rounding ε/h and what it leaves out, h²/6 of the third derivative, are alike.
double ExtendedSystem::step_of(const Threshold& at, const CurveDirection& along) {
  const Energy& energy = variant(at.second)->energy;
  const double turn = distortion(energy, at.at.point.state, along.x, along.load), by_turn = turn > 0 ? turn : movement(energy, along.x);
  const double part = std::cbrt(epsilon), h = part / std::max({by_turn, std::abs(along.load) / metric.load, std::abs(along.second) / metric.second});
  const std::optional<State> beside = moved(at, along * h);
  if (!beside) return h;
  Energy &here = variant(at.second)->energy, &there = variant(at.second + h * along.second)->energy;
  double within = 1;
  for (const ContactKey& key : closed_contacts(here, at.at.point.state)) {
    if (key.feature >= 0 || (at.kind == EventKind::contact && key == at.contact)) continue;
    const double overlap = gap(here, key, at.at.point.state), change = std::abs(gap(there, key, *beside) - overlap);
    if (change > part * std::abs(overlap)) within = std::min(within, part * std::abs(overlap) / change);
  }
  return h * std::max(within, curve::least_within);
}

std::optional<ExtendedSystem::Rates> ExtendedSystem::rates(const Threshold& at, const CurveDirection& along, const Vector& v) {
  const double h = step_of(at, along);
  Rates sides[2];
  for (const int k : {0, 1}) {
    const CurveDirection by = along * (k == 0 ? -h : h);
    const std::optional<State> state = moved(at, by);
    if (!state) return {};
    Energy& energy = variant(at.second + by.second)->energy;
    const bool all = v.size() > 0;                            // or the force alone
    energy.evaluate(*state, all);
    sides[k] = {energy.gradient(), all ? energy.multiply(v) : Vector(), all ? energy.load_derivative() : Vector()};
  }
  const auto rate = [&](const Vector& a, const Vector& b) { return Vector((b - a) / (2 * h)); };
  return Rates{rate(sides[0].force, sides[1].force), rate(sides[0].hv, sides[1].hv), rate(sides[0].load, sides[1].load)};
}

std::optional<double> ExtendedSystem::gap_rate(const Threshold& at, const CurveDirection& along) {
  const double h = step_of(at, along);
  double gaps[2];
  for (const int k : {0, 1}) {
    const CurveDirection by = along * (k == 0 ? -h : h);
    const std::optional<State> state = moved(at, by);
    if (!state) return {};
    gaps[k] = variant(at.second + by.second)->energy.gap(at.contact.particle, at.contact.other, at.contact.wall, *state);
  }
  return (gaps[1] - gaps[0]) / (2 * h);
}

// ∂g/∂μ, what is free going with the places at rest.
std::optional<Vector> ExtendedSystem::second_derivative(const Threshold& at) {
  const CurveDirection along{Vector::Zero(variant(at.second)->energy.dofs()), 0, metric.second};
  if (at.kind != EventKind::contact) {
    const auto rate = rates(at, along, {});
    return rate ? std::optional<Vector>(rate->force / metric.second) : std::nullopt;
  }
  // The force of a contact begins like the power 3/2 of its overlap: (−3 f(0) + 4 f(h) − f(2h))/(2h) on the side on which it is open.
  const std::optional<double> opens = gap_rate(at, along);
  if (!opens) return {};
  const double h = step_of(at, along) * (*opens < 0 ? -1 : 1);
  Vector sum = Vector::Zero(along.x.size());
  for (const auto& [weight, part] : {std::pair(-3.0, 0.0), {4.0, h}, {-1.0, 2 * h}}) {
    const std::optional<State> state = moved(at, along * part);
    if (!state) return {};
    Energy& energy = variant(at.second + part * metric.second)->energy;
    energy.evaluate(*state, false);
    sum += weight * energy.gradient();
  }
  return Vector(sum / (2 * h * metric.second));
}

std::optional<ExtendedSystem::Linear> ExtendedSystem::linearise(Threshold& point, std::string& why) {
  const std::shared_ptr<Variant> here = variant(point.second);
  const std::optional<Vector> by_second = second_derivative(point);
  if (!here || !by_second) return why = "there is no structure there", std::nullopt;
  Energy& energy = here->energy;
  Factors& factors = here->newton.factors();
  const State& state = point.at.point.state;
  energy.evaluate(state);
  const Vector g = energy.gradient(), load = energy.load_derivative();
  if (!factors.factorize_holding(side_by_side(point.at.zero_modes, point.modes))) return why = factors.why_none(), std::nullopt;

  Linear linear;
  const bool critical = point.kind != EventKind::contact;
  Vector v;
  double theta = 0;
  if (point.modes.cols() > 0) {
    for (Eigen::Index j = 0; j < point.modes.cols(); ++j) {
      const Vector phi = point.modes.col(j);
      point.modes.col(j) = phi - factors.solve_holding(energy.multiply(phi));
    }
    const Vector before = point.modes.col(0);
    point.modes = orthonormal(point.modes);
    if (point.modes.col(0).dot(before) < 0) point.modes.col(0) *= -1;
  }
  if (critical) {
    v = point.modes.col(0), theta = energy.quadratic_form(v);
    linear.directions.push_back(metric.unit({v, 0, 0}));
  }
  // Where the load factor alone moves the equilibrium, and then across that direction.
  const CurveDirection by_load = metric.unit({-factors.solve_holding(load), 1, 0});
  const Vector row = by_load.x / (metric.length * metric.length);
  const double corner = by_load.load / (metric.load * metric.load);
  const auto solve = [&](const Vector& b, double beta, double second) {
    const Factors::Bordered s = factors.solve_bordered(load, row, corner, b, beta);
    return CurveDirection{s.p, s.delta, second};
  };
  const CurveDirection along = solve(Vector::Zero(g.size()), 1, 0);
  linear.directions.push_back(point.way = metric.unit(along));
  linear.directions.push_back(metric.unit(solve(-*by_second, 0, 1)));
  linear.rest = solve(-g, 0, 0);

  const std::size_t count = linear.directions.size();
  if (!critical) {
    std::vector<double> gaps;
    for (const CurveDirection& d : linear.directions) gaps.push_back(gap_rate(point, d).value_or(0));
    append(linear.rows, linear.lacking, gaps, energy.gap(point.contact.particle, point.contact.other, point.contact.wall, state));
  } else {
    std::vector<double> force, work, curvature;
    double size = 0;                                          // of the terms of `work`
    const CurveDirection& way = linear.directions[1];
    for (std::size_t k = 0; k < count; ++k) {
      const CurveDirection& d = linear.directions[k];
      const auto r = rates(point, d, v);
      if (!r) return why = "there is no structure beside", std::nullopt;
      curvature.push_back(v.dot(r->hv));
      force.push_back(k == 0 ? theta * d.x.dot(v) : v.dot(load) * d.load + v.dot(*by_second) * d.second);
      // δv = P(−δH v), so that vᵀ∂g/∂λ changes by vᵀδ(∂g/∂λ) + (δH v)ᵀp_λ, here times δ_L.
      work.push_back(way.load * v.dot(r->load) + way.x.dot(r->hv));
      size = std::max(size, std::abs(way.load) * r->load.norm() + way.x.norm() * r->hv.norm());
      if (k == 0) point.asymmetry = curvature[0] / std::max(r->hv.norm(), std::numeric_limits<double>::min());
    }
    // Where two branch points meet the work of the load does not tell how far along the mode they are, which symmetry keeps as it was.
    if (point.kind == EventKind::branch && largest(work) <= curve::no_row * size) append(linear.rows, linear.lacking, {1, 0, 0}, 0);
    else if (point.kind == EventKind::branch) append(linear.rows, linear.lacking, work, way.load * v.dot(load));
    else append(linear.rows, linear.lacking, force, v.dot(g) + v.dot(load) * linear.rest.load);
    append(linear.rows, linear.lacking, curvature, theta);
  }
  if (linear.rows.rows() + 1 < static_cast<Eigen::Index>(count)) return why = "the conditions do not depend on anything", std::nullopt;
  return linear;
}

// The equilibrium with its critical modes held, across its way, where a step has left forces: axial ones grow with its square.
Report ExtendedSystem::settle(Threshold& point, Variant& here) {
  const Eigen::MatrixXd held = side_by_side(point.at.zero_modes, point.modes);
  Plane across{Vector::Zero(here.energy.dofs()), 1};
  if (point.way.x.size() > 0)
    across = {point.way.x / (metric.length * metric.length), point.way.load / (metric.load * metric.load), metric.length, metric.load};
  across.guided = held.cols() > 0;
  return here.newton.correct(point.at.point.state, held, nullptr, curve::most_settling, &across);
}

Report ExtendedSystem::solve(Threshold& point, const CurveDirection* across) {
  Report report;
  const Threshold predicted = point;
  double last = std::numeric_limits<double>::infinity();
  int stalled = 0;
  const auto fail = [&](std::string why) {
    report.status = Status::not_converged, report.why = std::move(why);
    return report;
  };
  for (int k = 0; k <= curve::most_iterations; ++k, ++report.iterations) {
    const std::shared_ptr<Variant> here = variant(point.second);
    if (!here) return fail("there is no such structure");
    const Report settled = settle(point, *here);
    if (!settled.converged()) return fail(settled.why);
    std::string why;
    const std::optional<Linear> linear = linearise(point, why);
    if (!linear) return fail(why);
    const Eigen::Index n = static_cast<Eigen::Index>(linear->directions.size());
    Eigen::MatrixXd a(n, n);
    Vector b(n);
    a.topRows(n - 1) = linear->rows, b.head(n - 1) = linear->lacking;
    for (Eigen::Index j = 0; j < n; ++j)
      a(n - 1, j) = across ? metric.dot(*across, linear->directions[j]) : linear->directions[j].second / metric.second;
    b[n - 1] = 0;
    if (across) {
      const std::optional<State> from = moved(predicted, {Vector::Zero(linear->rest.x.size()), 0, point.second - predicted.second});
      if (!from) return fail("there is no such structure");
      const CurveDirection way{here->energy.kinematics().difference(*from, point.at.point.state),
                               point.at.point.state.load_factor - predicted.at.point.state.load_factor, point.second - predicted.second};
      b[n - 1] = -metric.dot(*across, way) - metric.dot(*across, linear->rest);
    }
    const Vector u = solved(a, b);
    CurveDirection step = linear->rest;
    for (Eigen::Index j = 0; j < n; ++j) step = step + linear->directions[j] * u[j];
    if (!across) step.second = 0;
    const double size = std::sqrt(metric.dot(step, step) + metric.dot(linear->rest, linear->rest));
    if (!std::isfinite(size) || size > curve::longest_correction) return fail("Newton's method leads far away");
    const bool shrinks = size <= last / 2;
    if (!shrinks && k >= 2 && last > curve::at_rest) return fail("Newton's method does not contract");
    stalled += !shrinks;
    const bool at_rest = size <= curve::rounding || stalled == 2;
    if (stalled < 2 && !move(point, step)) return fail("there is no such structure");
    last = size;
    if (!at_rest) continue;
    // Of a branch point only the part of the forces that its mode does not feel was asked to vanish.
    Energy& there = variant(point.second)->energy;
    there.evaluate(point.at.point.state, false);
    report.residual = there.relative(there.gradient());
    if (!(report.residual <= here->newton.tolerance()))
      return fail(fmt::format("a force of {:.2g} is left along the critical mode: the branches do not meet any more", report.residual));
    // The tangent fulfils the conditions' derivatives: a row of cofactors.
    Eigen::MatrixXd border = a;
    CurveDirection tangent{Vector::Zero(step.x.size())};
    for (Eigen::Index j = 0; j < n; ++j) {
      border.bottomRows(1).setZero(), border(n - 1, j) = 1;
      tangent = tangent + linear->directions[j] * border.determinant();
    }
    if (!(metric.dot(tangent, tangent) > 0)) return fail("two curves meet");
    point.direction = metric.unit(tangent);
    const double sense = across ? metric.dot(*across, point.direction) : point.direction.second;
    if (sense < 0) point.direction = point.direction * -1;
    report.status = Status::converged, report.why = "the corrections are rounding";
    return report;
  }
  return fail("too many iterations");
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
