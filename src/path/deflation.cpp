#include "path/deflation.hpp"

#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "path/arc.hpp"
#include "path/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

using namespace limits;

namespace {

class Deflation {
 public:
  Deflation(Newton& newton, std::vector<State> known) : newton_(newton), energy_(newton.energy()), known_(std::move(known)) {
    radius_ = 0;
    for (const State& s : known_) radius_ = std::max(radius_, apart(known_.front(), s).norm());
    const double least = 0.1 * span(energy_.model()) * std::sqrt(std::max(1.0, static_cast<double>(energy_.model().particles())));
    radius_ = std::max(radius_, least);
  }

  const std::vector<State>& known() const { return known_; }
  double radius() const { return radius_; }

  /// A further equilibrium from a guess, or nothing; the list grows by it.
  std::optional<Equilibrium> find(State state) {
    double size = 0;
    for (int k = 0; k < deflation::most_iterations && !interrupted(); ++k) {
      energy_.evaluate(state);
      if (!std::isfinite(energy_.last_terms().total())) return {};
      newton_.factors().factorize_holding({});
      Vector p = -newton_.factors().solve_holding(energy_.gradient());
      if (!p.allFinite()) return {};
      size = p.norm();
      // (M H + g ∇Mᵀ) d = −M g:  d = τ p,  τ = 1 / (1 − ∇(log M)·p)   (Sherman & Morrison).
      const double tau = 1 / (1 - slope(state).dot(p));
      p *= std::isfinite(tau) ? tau : 1.0;
      const double rotation = distortion(energy_, state, p);
      const double part = std::min(1.0, deflation::largest_rotation / std::max(rotation, 1e-300));
      State next = state;
      energy_.kinematics().retract(next, p, part);
      if (const double free = energy_.collision_free_step(state, next); free < 1) {
        next = state;
        energy_.kinematics().retract(next, p, part * free);
      }
      state = next;
      if (size < 1e-3 * radius_ && std::abs(tau - 1) < 0.1) break;          // near a root that is not deflated
    }
    const State near = state;
    const Report report = newton_.correct(state, {}, nullptr, 20);
    if (!report.converged() || apart(near, state).norm() > 0.1 * radius_) return {};
    for (const State& s : known_)
      if (apart(s, state).norm() <= deflation::same * radius_) return {};
    known_.push_back(state);
    return assess(newton_, state, report);
  }

 private:
  Vector apart(const State& a, const State& b) const { return energy_.kinematics().difference(a, b); }

  // ∇ log M = Σ −2 ρ² (x − xᵢ) / (|x − xᵢ|² (|x − xᵢ|² + ρ²))
  Vector slope(const State& state) const {
    Vector sum = Vector::Zero(energy_.dofs());
    for (const State& s : known_) {
      const Vector d = apart(s, state);
      const double square = std::max(d.squaredNorm(), 1e-24 * radius_ * radius_), r = radius_ * radius_;
      sum -= 2 * r / (square * (square + r)) * d;
    }
    return sum;
  }

  Newton& newton_;
  Energy& energy_;
  std::vector<State> known_;
  double radius_;
};

// The known states at one load factor: each brought there, those that are equilibria there kept, twins dropped.
std::vector<State> brought_to(Newton& newton, const std::vector<State>& states, double load_factor) {
  std::vector<State> there;
  for (State s : states) {
    newton.energy().kinematics().prescribe(s, load_factor);
    if (!newton.correct(s, {}, nullptr, 20).converged()) continue;
    const auto twin = [&](const State& t) {
      const Vector apart = newton.energy().kinematics().difference(t, s);
      return apart.norm() <= 1e-9 * span(newton.energy().model());
    };
    if (std::none_of(there.begin(), there.end(), twin)) there.push_back(std::move(s));
  }
  return there;
}

}  // namespace

std::vector<PathPoint> deflate(Newton& newton, const std::vector<State>& states, const PathOptions& options,
                               std::vector<std::string>& notes) {
  Energy& energy = newton.energy();
  std::vector<PathPoint> found;
  std::vector<double> at = options.deflate_at;
  if (at.empty()) at.push_back(options.to);
  int number = 0;
  for (const double load_factor : at) {
    // The states next to the load factor on the branches stand for all of them.
    std::vector<State> near = states;
    std::stable_sort(near.begin(), near.end(), [&](const State& a, const State& b) {
      return std::abs(a.load_factor - load_factor) < std::abs(b.load_factor - load_factor);
    });
    if (near.size() > deflation::most_near) near.resize(deflation::most_near);
    Deflation deflation(newton, brought_to(newton, near, load_factor));
    if (deflation.known().empty()) {
      notes.push_back(fmt::format("deflation: no equilibrium is known at load factor {:.10g}", load_factor));
      continue;
    }
    int count = 0;
    for (std::size_t k = 0; k < deflation.known().size() && count < options.deflate; ++k) {
      const State base = deflation.known()[k];
      energy.evaluate(base);
      const EigenPairs pairs = newton.factors().lowest(std::min(deflation::most_modes, energy.dofs()));
      for (Eigen::Index m = 0; m < pairs.vectors.cols(); ++m)
        for (const double way : {0.02, -0.02, 0.3, -0.3}) {
          if (count == options.deflate || interrupted()) break;
          const Vector& v = pairs.vectors.col(m);
          const double rotation = distortion(energy, base, v);
          State guess = base;
          energy.kinematics().retract(guess, v, way / std::max(rotation, 1e-300));
          if (energy.collision_free_step(base, guess) < 1) continue;
          std::optional<Equilibrium> e = deflation.find(guess);
          if (!e) continue;
          ++count;
          e->point.label = fmt::format("deflated:{}", ++number);
          e->point.what = "found by deflation";
          found.push_back(std::move(e->point));
        }
    }
    notes.push_back(fmt::format("deflation: {} further equilibria at load factor {:.10g}", count, load_factor));
  }
  return found;
}

}  // namespace elamin
