#include "path/event_error.hpp"

#include "path/limits.hpp"
#include "solve/limits.hpp"

#include <array>
#include <cmath>
#include <limits>

namespace elamin {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double over(double missed, double rate) { return rate != 0 && std::isfinite(missed / rate) ? std::abs(missed / rate) : unknown; }

/// Calls with every bond, the unit vector from its first particle to the second one, its length, and 2 K r₀ ε/2.
void for_rounded(const Energy& energy, const State& state, const auto& call) {
  const Model& model = energy.model();
  for (const Bond& b : model.bonds) {
    const BondType& type = model.bond_types[static_cast<std::size_t>(b.type)];
    const Vec3 d = (state.at(b.particles[1]) - state.at(b.particles[0])).hi;
    if (const double r = d.norm(); r > 0) call(b.particles[0], b.particles[1], Vec3(d / r), r, epsilon * type.stiffness * type.rest_length);
  }
}

Vector rounded_lengths(const Energy& energy, const State& state) {
  Field g = Field::Zero(3, energy.kinematics().sites());
  for_rounded(energy, state, [&](int i, int j, const Vec3& n, double, double force) { g.col(i) += force * n, g.col(j) -= force * n; });
  return energy.kinematics().restrict(g);
}

// vᵀ∂H/∂r₀ v for the same: of 2K (nnᵀ + (1 − r₀/r)(1 − nnᵀ)).
double softened(const Energy& energy, const State& state, const Vector& v) {
  const Field u = energy.kinematics().extend(v);
  double sum = 0;
  for_rounded(energy, state, [&](int i, int j, const Vec3& n, double r, double force) {
    const Vec3 d = u.col(j) - u.col(i);
    sum -= force / r * (d - n.dot(d) * n).squaredNorm();
  });
  return sum;
}

// H⁻¹g and H⁻¹g_r with what is held kept; zero where there is no such factor.
std::array<Vector, 2> moved(Newton& newton, const Equilibrium& at, const Eigen::MatrixXd& held) {
  Energy& energy = newton.energy();
  energy.evaluate(at.point.state);
  const Vector g = energy.gradient(), zero = Vector::Zero(g.size());
  if (!newton.factors().factorize_holding(held)) return {zero, zero};
  return {newton.factors().solve_holding(g), newton.factors().solve_holding(rounded_lengths(energy, at.point.state))};
}

}  // namespace

double limit_error(Newton& newton, const Equilibrium& at, const Eigen::MatrixXd& modes) {
  Energy& energy = newton.energy();
  energy.evaluate(at.point.state);
  const Vector v = modes.col(0);
  const BilinearForm force = energy.slope(v);
  return over(std::abs(force.value) + limits::slope_rounding * epsilon * force.size + std::abs(v.dot(rounded_lengths(energy, at.point.state))),
              v.dot(energy.load_derivative()));
}

double branch_error(Newton& newton, const Equilibrium& at, const Eigen::MatrixXd& modes, double width) {
  Energy& energy = newton.energy();
  const std::array<Vector, 2> aside = moved(newton, at, side_by_side(at.zero_modes, modes));
  const double step = limits::event_error::step * std::abs(width), way = step * at.tangent.norm();
  const auto rate = [&](const Vector& x, double load, double by, const Vector& v) {
    double value[2];
    for (const int side : {0, 1}) {
      energy.evaluate(moved_by(energy.kinematics(), at.point.state, x, load, side ? by : -by));
      value[side] = energy.form(v, v).value;
    }
    return (value[1] - value[0]) / (2 * by);
  };
  double worst = 0;
  for (Eigen::Index k = 0; k < modes.cols(); ++k) {
    const Vector v = modes.col(k);
    double change[2] = {0, softened(energy, at.point.state, v)};     // by p = −H⁻¹g, −H⁻¹g_r
    for (const int i : {0, 1})
      if (const Vector& p = aside[i]; p.norm() > 0 && way > 0) change[i] -= rate(p, 0, way / p.norm(), v);
    const double missed = std::abs(change[0]) + std::abs(change[1]);
    const double along = rate(at.tangent, 1, step, v);
    energy.evaluate(at.point.state);
    const BilinearForm stiffness = energy.form(v, v);
    const double error = over(missed + std::abs(stiffness.value) + limits::form_rounding * epsilon * stiffness.size, along);
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

bool sharpen(Newton& newton, Equilibrium& at) {
  State state = at.point.state;
  if (!state.hard.empty()) return false;
  const Report report = newton.correct(state, at.zero_modes);
  if (!report.converged()) return false;
  newton.energy().evaluate(state);
  at.point.state = std::move(state), at.point.energy = newton.energy().last_terms(), at.point.report.residual = report.residual;
  return true;
}

double contact_error(Newton& newton, const Equilibrium& at, const ContactSet& changed, double width) {
  const Energy& energy = newton.energy();
  const std::array<Vector, 2> aside = moved(newton, at, at.zero_modes);
  double worst = changed.empty() ? unknown : 0;
  for (const ContactKey& key : changed) {
    Vector row;
    double by_load = 0;
    if (key.feature >= 0 || !slope(energy, key, at.point.state, limits::event_error::step * width, row, by_load)) return unknown;
    const double missed = std::abs(gap(energy, key, at.point.state)) + epsilon * at.point.state.at(key.particle).hi.norm() + std::abs(row.dot(aside[0])) +
                          std::abs(row.dot(aside[1]));
    const double error = over(missed, row.dot(at.tangent) + by_load);
    if (!(error <= worst)) worst = error;
  }
  return worst;
}

}  // namespace elamin
