#include "solve/nlopt_search.hpp"

#include "core/dense.hpp"
#include "core/heartbeat.hpp"
#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "solve/limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

namespace elamin {

namespace {

struct Destroy {
  void operator()(nlopt_opt o) const { nlopt_destroy(o); }
};
using Optimiser = std::unique_ptr<nlopt_opt_s, Destroy>;

}  // namespace

NloptSearch::NloptSearch(Newton& newton, const State& start, const NloptOptions& options, Report& report)
    : newton_(newton), energy_(newton.energy()), options_(options), report_(report), base_(start), best_(start),
      extent_(extent(newton.energy().model())), most_evaluations_(options.max_evaluations) {}

void NloptSearch::end(Status status, std::string why) { report_.status = status, report_.why = std::move(why); }

Vector NloptSearch::step(const Vector& z) {
  if (space_ == Space::preconditioned) return std::sqrt(unit_) * newton_.factors().cholesky().root(z);
  return length_ * z;
}

Vector NloptSearch::slope(const Vector& g) {
  if (space_ == Space::preconditioned) return newton_.factors().cholesky().root_transposed(g) / std::sqrt(unit_);
  return length_ / unit_ * g;
}

// A factor of H + τI, positive definite; τ of the size of the lowest eigenvalue where that is negative, and so large that the
// Newton step is not longer than everything there is. None: there is no factor.
std::optional<double> NloptSearch::factorise(const Vector& g) {
  Factors& factors = newton_.factors();
  std::optional<double> shift = factors.make_positive(shift_ / 4);
  const double sigma = factors.zero_level();
  if (shift && *shift > sigma) {
    const double lowest = factors.lowest(1, *shift, 0.1).values[0];
    shift = factors.make_positive_from(lowest < 0 ? std::min(-2 * lowest, *shift) : *shift);
  } else if (shift && *shift > 0) {
    shift = factors.make_positive_from(100 * sigma);
  }
  while (shift && infinity_norm(factors.cholesky().solve(g)) > 2 * extent_)
    shift = factors.make_positive_from(std::max(4 * *shift, infinity_norm(g) / (4 * extent_)));
  return shift;
}

// The variables about the best state, where the energy has just been evaluated with its Hessian. False: there is no factor.
bool NloptSearch::begin_round(bool from_forces) {
  base_ = best_;
  const Vector g = energy_.gradient();
  base_energy_ = energy_.last_terms().total();
  base_residual_ = best_residual_ = energy_.relative(g);
  best_value_ = worst_ = 0;
  unit_ = 1;
  double predicted = 0;
  if (space_ == Space::preconditioned) {
    const std::optional<double> shift = factorise(g);
    if (!shift) return false;
    shift_ = *shift;
    unit_ = predicted = slope(g).squaredNorm();
  } else {
    const SparseMatrix& h = energy_.hessian();
    double stiffest = 0;
    for (int j = 0; j < h.outerSize(); ++j) stiffest = std::max(stiffest, std::abs(h.coeff(j, j)));
    if (space_ == Space::scaled) length_ = stiffest > 0 ? g.norm() / stiffest : energy_.kinematics().mean_size();
    unit_ = stiffest > 0 ? stiffest * length_ * length_ : infinity_norm(g) * length_;
    predicted = stiffest > 0 ? g.squaredNorm() / stiffest : unit_;
  }
  if (!(unit_ > 0)) unit_ = 1;
  base_slope_ = slope(g);
  from_forces_ = from_forces || predicted <= limits::nlopt::seen * 16 * epsilon * energy_.last_terms().size();
  return true;
}

void NloptSearch::keep(const State& state, double f, double residual) {
  best_ = state, best_value_ = f, best_residual_ = residual;
  last_gain_ = looks_;
  at_iteration(++report_.iterations, residual);
  report_.energy = energy_.last_terms().total(), report_.residual = residual;
  if (report_.history.size() < limits::nlopt::most_entries)
    report_.history.push_back({report_.energy, residual, infinity_norm(energy_.kinematics().difference(base_, state)), shift_});
}

bool NloptSearch::must_stop() {
  return interrupted() || report_.evaluations >= most_evaluations_ || looks_ > most_looks_ || looks_ - last_gain_ > patience_ || thrown_;
}

// Above everything seen, and rising away from the base.
double NloptSearch::barred(const Vector& z, double* gradient) {
  if (!z.allFinite()) {
    if (gradient) std::fill_n(gradient, z.size(), 0.0);
    return infinity;
  }
  const double steep = 1 + worst_ - best_value_;
  if (gradient) Eigen::Map<Vector>(gradient, z.size()) = 2 * steep * z;
  return worst_ + steep * (1 + z.squaredNorm());
}

double NloptSearch::value(const Vector& z, double* gradient) {
  ++looks_;
  if (must_stop()) nlopt_force_stop(running_);
  const Vector move = z.allFinite() ? step(z) : z;
  if (!move.allFinite() || infinity_norm(move) > 4 * extent_) return barred(z, gradient);   // farther than everything there is
  State next = base_;
  energy_.kinematics().retract(next, move);
  if (energy_.collision_free_step(whole_space_ ? base_ : best_, next) < 1) return barred(z, gradient);
  energy_.evaluate(next, false);
  ++report_.evaluations;
  const double total = energy_.last_terms().total();
  if (!std::isfinite(total)) return barred(z, gradient);
  const double residual = energy_.relative(energy_.gradient());
  Vector g = energy_.gradient();
  energy_.kinematics().pull_back(g, move);
  const Vector gamma = slope(g);
  if (gradient) Eigen::Map<Vector>(gradient, z.size()) = gamma;
  const double f = from_forces_ ? (base_slope_ + gamma).dot(z) / 2 : (total - base_energy_) / unit_;
  worst_ = std::max(worst_, f);
  const bool reached = residual <= options_.tolerance && !whole_space_;
  if (reached || (from_forces_ ? residual < best_residual_ : f < best_value_)) keep(next, f, residual);
  if (reached) nlopt_force_stop(running_);
  return f;
}

double NloptSearch::call(unsigned n, const double* z, double* gradient, void* self) {
  NloptSearch& search = *static_cast<NloptSearch*>(self);
  try {
    return search.value(Eigen::Map<const Vector>(z, n), gradient);
  } catch (...) {                                                 // not through NLopt
    search.thrown_ = std::current_exception();
    nlopt_force_stop(search.running_);
    return infinity;
  }
}

void NloptSearch::optimise(nlopt_opt optimiser) {
  running_ = optimiser;
  looks_ = last_gain_ = 0;
  Vector z = Vector::Zero(energy_.dofs());
  double f = 0;
  nlopt_srand(options_.seed);
  nlopt_set_min_objective(optimiser, &call, this);
  // NLopt sets 40 MB to zero in each run, room for far more differences of gradients than a small problem has.
  if (energy_.dofs() <= limits::nlopt::small) nlopt_set_vector_storage(optimiser, std::max(energy_.dofs(), limits::nlopt::fewest_pairs));
  const nlopt_result result = nlopt_optimize(optimiser, z.data(), &f);
  running_ = nullptr;
  if (thrown_) std::rethrow_exception(thrown_);
  if (result == NLOPT_OUT_OF_MEMORY) throw std::bad_alloc();
  if (result == NLOPT_INVALID_ARGS) throw std::runtime_error("NLopt refuses the arguments of " + options_.algorithm);
}

void NloptSearch::local(const NloptAlgorithm& algorithm) {
  const int n = energy_.dofs();
  const bool derivatives = algorithm.kind == NloptAlgorithm::Kind::gradient;
  space_ = options_.precondition && newton_.factors().cholesky().has_root() ? Space::preconditioned : Space::scaled;
  whole_space_ = false, most_evaluations_ = options_.max_evaluations;
  const bool preconditioned = space_ == Space::preconditioned;
  most_looks_ = derivatives ? (preconditioned ? 100 : 2000) : 200 + 100 * n;
  patience_ = !derivatives ? 20 + 20 * n : preconditioned ? 30 : 500;
  const double far = limits::lost * extent_;
  for (int idle = 0, rounds = 0, saddles = 0;; ++rounds) {
    energy_.evaluate(best_);
    ++report_.evaluations;
    report_.energy = energy_.last_terms().total(), report_.residual = energy_.relative(energy_.gradient());
    if (rounds == 0) report_.history.push_back({report_.energy, report_.residual, 0, 0});
    if (!std::isfinite(report_.energy))
      return end(Status::not_converged, "the energy is not finite here: particles coincide, or do not fit into a curved wall");
    if (report_.residual <= options_.tolerance)
      return end(Status::converged, fmt::format("the residual is below {:g} after {} rounds of {}", options_.tolerance, rounds, algorithm.name));
    if (interrupted()) return end(Status::interrupted, "interrupted");
    if (const std::string gone = escaped(energy_.model(), best_, far); !gone.empty()) return end(Status::not_converged, gone);
    if (report_.evaluations >= options_.max_evaluations)
      return end(Status::not_converged, fmt::format("{} evaluations were not enough for {}; the residual is {:.2g}", options_.max_evaluations,
                                                    algorithm.name, report_.residual));
    // Beside a saddle what goes down has larger forces, and what has smaller ones does not go down.
    if (idle >= limits::nlopt::most_rounds_without_gain && derivatives && saddles++ < limits::most_saddles && newton_.factors().inertia().negative > 0 &&
        newton_.leave_saddle(best_, newton_.factors().lowest(1).vectors.col(0))) {
      idle = 0;
      continue;
    }
    if (idle >= limits::nlopt::most_rounds_without_gain)
      return end(Status::not_converged, fmt::format("{} gains nothing more; the residual stays at {:.2g}", algorithm.name, report_.residual));
    if (!begin_round(idle > 0)) {
      const std::string why = newton_.factors().why_none();
      return end(interrupted() ? Status::interrupted : Status::not_converged, why.empty() ? "no shift makes the Hessian positive definite" : why);
    }
    const Optimiser optimiser(nlopt_create(algorithm.code, n));
    if (!optimiser) throw std::bad_alloc();
    if (!derivatives) nlopt_set_initial_step1(optimiser.get(), 0.5), nlopt_set_xtol_abs1(optimiser.get(), 1e-3);
    optimise(optimiser.get());
    const bool gained = from_forces_ ? best_residual_ <= base_residual_ / 2 : best_value_ < 0;
    idle = gained ? 0 : idle + 1;
  }
}

void NloptSearch::global(const NloptAlgorithm& algorithm, double half, int evaluations) {
  const int n = energy_.dofs();
  space_ = Space::box, length_ = half;
  energy_.evaluate(best_);
  ++report_.evaluations;
  begin_round(false);
  from_forces_ = false, whole_space_ = true;
  most_evaluations_ = evaluations, most_looks_ = patience_ = 4 * evaluations;
  const Optimiser optimiser(nlopt_create(algorithm.code, n)), inner(nlopt_create(NLOPT_LD_LBFGS, n));
  if (!optimiser || !inner) throw std::bad_alloc();
  nlopt_set_lower_bounds1(optimiser.get(), -1), nlopt_set_upper_bounds1(optimiser.get(), 1);
  if (algorithm.code == NLOPT_GN_CRS2_LM) nlopt_set_population(optimiser.get(), 100 * (n + 1));   // the usual 10 (n + 1) lose a valley easily
  if (algorithm.random_starts()) {
    nlopt_set_ftol_rel(inner.get(), 1e-10), nlopt_set_xtol_rel(inner.get(), 1e-8), nlopt_set_maxeval(inner.get(), 500);
    nlopt_set_local_optimizer(optimiser.get(), inner.get());
  }
  optimise(optimiser.get());
  whole_space_ = false;
}

}  // namespace elamin
