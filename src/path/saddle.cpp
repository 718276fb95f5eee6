#include "path/saddle.hpp"

#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "path/limits.hpp"
#include "solve/ritz.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {

using namespace limits;

namespace {

/// x + p, or as much of it as nothing is in the way of.
State moved(const Energy& energy, const State& from, const Vector& p) {
  State to = from;
  energy.kinematics().retract(to, p);
  if (const double free = energy.collision_free_step(from, to); free < 1) {
    to = from;
    energy.kinematics().retract(to, p, saddle::before_collision * free);
  }
  return to;
}

/// Whether the ends of a bond come together: further up there are only cusps.
bool pressed(const Model& model, const State& state) {
  return std::any_of(model.bonds.begin(), model.bonds.end(), [&](const Bond& b) {
    return (state.at(b.particles[1]) - state.at(b.particles[0])).hi.norm() <= saddle::pressed * model.bond_types[b.type].rest_length;
  });
}

class Walker {
 public:
  Walker(Newton& newton, State state, const Heading& heading, const Eigen::MatrixXd& held)
      : newton_(newton), energy_(newton.energy()), held_(held), first_(heading.first), up_(heading.up), state_(std::move(state)) {}

  std::optional<Equilibrium> go() {
    look();
    for (int k = 0; k < saddle::most_steps && !interrupted(); ++k) {
      if (!std::isfinite(energy_here_) || pressed(energy_.model(), state_) || !choose()) return {};
      if (first_.size() == 0 && arrived_) return settle();
      if (!advance()) return {};
    }
    return {};
  }

 private:
  // Soft modes here, their slopes, and which of them is climbed along.
  void look() {
    Eigen::MatrixXd near = modes_.vectors;
    if (up_.size() > 0) near = side_by_side(up_, near);
    modes_ = soft_modes(newton_, state_, held_, saddle::modes, near);
    energy_here_ = energy_.last_terms().total(), rounding_ = equilibrium::energy_rounding * energy_.last_terms().size();
    climbs_ = -1;
    if (up_.size() > 0) {
      const Vector part = modes_.vectors.transpose() * up_;
      part.cwiseAbs().maxCoeff(&climbs_);
      if (std::abs(part[climbs_]) < saddle::same_mode) {          // it is none of the soft ones: it is held, too
        const Vector beside = (up_ - modes_.vectors * part).normalized();
        Eigen::MatrixXd all = side_by_side(modes_.vectors, beside);
        modes_.values = rotate_to_ritz(energy_, all), modes_.vectors = all;
        (all.transpose() * up_).cwiseAbs().maxCoeff(&climbs_);
      }
      if (modes_.vectors.col(climbs_).dot(up_) < 0) modes_.vectors.col(climbs_) *= -1;
    }
    slopes_ = slopes();
  }

  Vector slopes() const {
    return Vector::NullaryExpr(modes_.values.size(), [&](Eigen::Index i) { return energy_.slope(modes_.vectors.col(i)).value; });
  }

  // The step in the soft coordinates, as long as the radius allows. False: there is none.
  bool choose() {
    const Eigen::MatrixXd& v = modes_.vectors;
    step_ = -(slopes_.array() / modes_.values.array().abs().max(1e-300)).matrix();
    double along = 0;
    const bool stiff = climbs_ >= 0 && !(modes_.values[climbs_] < 0);
    if (climbs_ >= 0) along = -step_[climbs_], step_[climbs_] = 0;
    const double down = step_size(energy_, state_, v * step_), up = climbs_ < 0 ? 0 : step_size(energy_, state_, v.col(climbs_));
    arrived_ = !stiff && down <= saddle::arrived && std::abs(along) * up <= saddle::arrived;
    if (first_.size() > 0) {
      step_ = v.transpose() * first_;
      step_ *= radius_ / step_size(energy_, state_, v * step_);
      return step_.allFinite();
    }
    if (down > radius_) step_ *= radius_ / down;
    if (climbs_ >= 0) step_[climbs_] = stiff ? radius_ / up : std::clamp(along, -radius_ / up, radius_ / up);
    return step_.allFinite();
  }

  // Takes the step, or one with a smaller radius.
  bool advance() {
    const Vector p = modes_.vectors * step_;
    State next = moved(energy_, state_, p);
    Plane here{Vector::Zero(energy_.dofs()), 1};                 // Δλ = 0
    here.guided = true;
    bool good = newton_.correct(next, side_by_side(modes_.vectors, held_), &state_, equilibrium::most_in_contact, &here).converged() &&
                energy_.kinematics().difference(state_, next).norm() <= saddle::relaxed * p.norm();
    double off = 0;
    if (good) {
      energy_.evaluate(next, false);
      const Vector told = (modes_.values.array() * step_.array()).matrix();
      off = (slopes() - slopes_ - told).norm() / std::max({told.norm(), slopes_.norm(), 1e-300});
      good = off <= saddle::most_off || step_size(energy_, state_, p) <= saddle::arrived;
      if (up_.size() == 0) good = good && energy_.last_terms().total() <= energy_here_ + rounding_;
    }
    if (!good) {
      radius_ /= 2;
      return radius_ >= saddle::least_radius;
    }
    state_ = std::move(next);
    if (climbs_ >= 0) up_ = modes_.vectors.col(climbs_);
    first_.resize(0);
    if (off < saddle::little_off) radius_ = std::min(2 * radius_, saddle::largest_radius);
    look();
    return true;
  }

  std::optional<Equilibrium> settle() {
    const State before = state_;
    const Report report = newton_.correct(state_, held_, nullptr, equilibrium::most_in_contact);
    if (!report.converged() || step_size(energy_, before, energy_.kinematics().difference(before, state_)) > saddle::settled) return {};
    return assess(newton_, state_, report);
  }

  Newton& newton_;
  Energy& energy_;
  const Eigen::MatrixXd& held_;
  Vector first_, up_;
  State state_;
  EigenPairs modes_;
  Vector slopes_, step_;               // along the modes
  Eigen::Index climbs_ = -1;           // the mode that is climbed along
  double energy_here_ = 0, rounding_ = 0, radius_ = saddle::first_radius;
  bool arrived_ = false;
};

/// States evenly along the line through others.
std::vector<State> evenly(const Kinematics& kinematics, const std::vector<State>& line) {
  const std::size_t n = line.size();
  std::vector<double> at(n, 0);
  for (std::size_t k = 1; k < n; ++k) at[k] = at[k - 1] + kinematics.difference(line[k - 1], line[k]).norm();
  std::vector<State> even = line;
  for (std::size_t k = 1, j = 0; k + 1 < n; ++k) {
    const double here = at.back() * static_cast<double>(k) / static_cast<double>(n - 1);
    while (j + 2 < n && at[j + 1] < here) ++j;
    even[k] = line[j];
    if (at[j + 1] > at[j]) kinematics.retract(even[k], kinematics.difference(line[j], line[j + 1]), (here - at[j]) / (at[j + 1] - at[j]));
  }
  return even;
}

}  // namespace

EigenPairs soft_modes(Newton& newton, const State& state, const Eigen::MatrixXd& held, int count, const Eigen::MatrixXd& near) {
  Energy& energy = newton.energy();
  energy.evaluate(state);
  const int zero = static_cast<int>(held.cols());
  EigenPairs pairs = newton.factors().lowest(std::min(energy.dofs(), count + zero), 0, saddle::accuracy, near);
  if (zero == 0) return pairs;
  const Singular free = singular_values(pairs.vectors - held * (held.transpose() * pairs.vectors));
  pairs.vectors = free.u.leftCols(std::max<Eigen::Index>(0, pairs.vectors.cols() - zero));
  pairs.values = rotate_to_ritz(energy, pairs.vectors);
  return pairs;
}

std::optional<Equilibrium> walk(Newton& newton, State state, const Heading& heading, const Eigen::MatrixXd& held) {
  return Walker(newton, std::move(state), heading, held).go();
}

std::vector<Equilibrium> passes_between(Newton& newton, const State& a, const State& b, const Eigen::MatrixXd& held) {
  Energy& energy = newton.energy();
  const Kinematics& kinematics = energy.kinematics();
  std::vector<State> line(saddle::images, a);
  for (int k = 0; k < saddle::images; ++k) kinematics.retract(line[k], kinematics.difference(a, b), k / (saddle::images - 1.0));
  line.back() = b;
  const auto tangent = [&](std::size_t k) -> Vector {
    Vector t = kinematics.difference(line[k - 1], line[k + 1]);
    if (held.cols() > 0) t -= held * (held.transpose() * t);
    return t.normalized();
  };
  for (int round = 0; round < saddle::most_rounds && !interrupted(); ++round) {
    double most = 0;
    std::vector<State> next = line;
    for (std::size_t k = 1; k + 1 < line.size(); ++k) {
      energy.evaluate(line[k]);
      if (!std::isfinite(energy.last_terms().total()) || !newton.factors().make_positive(0)) return {};
      const Eigen::MatrixXd across = side_by_side(tangent(k), held), y = newton.factors().cholesky().solve(across);
      const Vector z = newton.factors().cholesky().solve(energy.gradient());
      Vector p = y * solved(across.transpose() * y, across.transpose() * z) - z;
      const double size = step_size(energy, line[k], p);
      if (!std::isfinite(size)) return {};
      most = std::max(most, size);
      if (size > saddle::largest_radius) p *= saddle::largest_radius / size;
      next[k] = moved(energy, line[k], p);
    }
    line = evenly(kinematics, next);
    if (most <= saddle::even) break;
  }
  std::vector<double> heights;
  for (const State& s : line) heights.push_back(energy.value(s));
  std::vector<Equilibrium> found;
  for (std::size_t k = 1; k + 1 < line.size() && !interrupted(); ++k)
    if (heights[k] >= heights[k - 1] && heights[k] > heights[k + 1])
      if (const auto e = walk(newton, line[k], {{}, tangent(k)}, held)) found.push_back(*e);
  return found;
}

}  // namespace elamin
