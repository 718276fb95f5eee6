#include "solve/ipopt_problem.hpp"

#include "core/dense.hpp"
#include "core/heartbeat.hpp"
#include "core/interrupt.hpp"
#include "energy/step_limits.hpp"
#include "solve/limits.hpp"
#include "solve/steady_bodies.hpp"

#include <IpDenseVector.hpp>
#include <IpIpoptData.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace elamin {

namespace {

const Ipopt::Number* values(const Ipopt::Vector& v) { return dynamic_cast<const Ipopt::DenseVector&>(v).ExpandedValues(); }

}  // namespace

IpoptProblem::IpoptProblem(Energy& energy, ContactEquilibrium& equilibrium, const State& start, const IpoptOptions& options,
                           IpoptMemory& memory, Report& report)
    : energy_(energy), equilibrium_(equilibrium), options_(options), memory_(memory), report_(report), origin_(start), at_(start), state_(start),
      before_(start), trail_{start}, length_(energy.kinematics().mean_size()), extent_(extent(energy.model())) {
  const bool hard = any_hard(energy.model());
  freedom_ = hard ? std::min(energy_.freedom(), limits::ipopt::wide * length_) : infinity;
  energy_.look_around(start);
  if (hard) contacts_ = energy_.hard_contacts(start, freedom_);
  gaps_.resize(contacts_.size());
  origin_.hard.clear(), at_.hard.clear();
  energy_.evaluate(at_);
  version_ = energy_.pattern_version();
  const SparseMatrix& h = energy_.hessian();
  double stiffest = 0, force = energy_.gradient().size() ? infinity_norm(energy_.gradient()) : 0.0;
  for (Eigen::Index k = 0; k < h.nonZeros(); ++k) stiffest = std::max(stiffest, std::abs(h.valuePtr()[k]));
  unit_ = stiffest > 0 ? stiffest * length_ * length_ : 1;
  offset_ = energy_.last_terms().total() - energy_.last_terms().size();
  for (const HardForce& c : contacts_) force = std::max(force, c.force);
  if (!(memory_.barrier > 0)) memory_.barrier = std::max(options_.barrier * force * length_ / unit_, 1e-12);
  if (!(memory_.close > 0)) memory_.close = hard ? 1e-3 : std::max(1e-6, options_.tolerance);
  step_.resize(energy_.dofs());
}

bool IpoptProblem::get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) {
  n = energy_.dofs(), m = static_cast<Index>(contacts_.size()), jacobian = 0;
  for (const HardForce& h : contacts_)
    for (const int p : {h.particle, h.other})
      for (int c = 0; c < 3; ++c) jacobian += p >= 0 && energy_.kinematics().dof(p, c) >= 0;
  hessian = static_cast<Index>(energy_.hessian().nonZeros());
  style = C_STYLE;
  return true;
}

bool IpoptProblem::get_bounds_info(Index n, Number* lo, Number* hi, Index m, Number* gap_lo, Number* gap_hi) {
  std::fill_n(lo, n, -limits::ipopt::unbounded), std::fill_n(hi, n, limits::ipopt::unbounded);
  std::fill_n(gap_lo, m, 0.0), std::fill_n(gap_hi, m, limits::ipopt::unbounded);
  return true;
}

bool IpoptProblem::get_starting_point(Index n, bool, Number* y, bool, Number*, Number*, Index m, bool with_forces, Number* force) {
  std::fill_n(y, n, 0.0);
  if (with_forces)
    for (Index k = 0; k < m; ++k) force[k] = -contacts_[k].force * length_ / unit_;
  return true;
}

bool IpoptProblem::eval_f(Index, const Number* y, bool renewed, Number& f) {
  if (!move(y, renewed)) return false;
  if (!differentiated_) ++report_.evaluations;
  const double e = differentiated_ ? energy_.last_terms().total() : energy_.value(at_);
  f = (e - offset_) / unit_;
  return std::isfinite(e);
}

bool IpoptProblem::eval_grad_f(Index n, const Number* y, bool renewed, Number* g) {
  if (!differentiate(y, renewed)) return false;
  Eigen::Map<Vector>(g, n) = length_ / unit_ * gradient_;
  return true;
}

bool IpoptProblem::eval_g(Index, const Number* y, bool renewed, Index m, Number* gap) {
  if (!measure(y, renewed)) return false;
  for (Index k = 0; k < m; ++k) gap[k] = gaps_[k].value / length_;
  return true;
}

bool IpoptProblem::eval_jac_g(Index, const Number* y, bool renewed, Index, Index, Index* row, Index* column, Number* value) {
  if (value && !measure(y, renewed)) return false;
  Index e = 0;
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    for (int i = 0; i < 2; ++i)
      for (int c = 0; c < 3; ++c) {
        const int p = i == 0 ? contacts_[k].particle : contacts_[k].other;
        const int d = p >= 0 ? energy_.kinematics().dof(p, c) : -1;
        if (d < 0) continue;
        if (value) value[e] = gaps_[k].gradient[3 * i + c];
        else row[e] = static_cast<Index>(k), column[e] = d;
        ++e;
      }
  return true;
}

bool IpoptProblem::eval_h(Index, const Number* y, bool renewed, Number factor, Index m, const Number* multiplier, bool,
                          Index entries, Index* row, Index* column, Number* value) {
  const SparseMatrix& h = energy_.hessian();
  if (!value) {
    Index e = 0;
    for (int j = 0; j < h.outerSize(); ++j)
      for (SparseMatrix::InnerIterator it(h, j); it; ++it, ++e) row[e] = static_cast<Index>(it.row()), column[e] = j;
    return true;
  }
  if (!differentiate(y, renewed) || stale_) return false;
  Eigen::Map<Vector> out(value, entries);
  const auto add = [&](double part) { out += part * length_ * length_ / unit_ * Eigen::Map<const Vector>(h.valuePtr(), entries); };
  out.setZero();
  if (m == 0) {
    add(factor);
    return true;
  }
  const double part = factor == 0 ? 1 : factor;                // 0: of the gaps alone, to restore feasibility
  if (factor == 0) energy_.evaluate(at_), add(-1);
  at_.hard = contacts_;
  for (Index k = 0; k < m; ++k) at_.hard[k].force = -multiplier[k] / part * unit_ / length_;
  energy_.evaluate(at_, true, {.from = factor == 0 ? nullptr : &before_});
  add(part);
  at_.hard.clear();
  differentiated_ = false;
  return out.allFinite();
}

bool IpoptProblem::intermediate_callback(Ipopt::AlgorithmMode mode, Index iteration, Number, Number, Number, Number mu, Number,
                                         Number shift, Number, Number, Index, const Ipopt::IpoptData* data,
                                         Ipopt::IpoptCalculatedQuantities*) {
  if (iteration > 0) ++report_.iterations;
  at_iteration(report_.iterations, report_.residual);
  if (interrupted()) return false;
  if (mode == Ipopt::RestorationPhaseMode) {
    if (arrived_ && free_) remember(at_);
    return true;
  }
  if (!differentiate(values(*data->curr()->x()), true)) return true;
  memory_.barrier = mu;
  const double moved = infinity_norm(energy_.kinematics().difference(state_, at_));
  before_ = state_, state_ = at_;
  remember(at_);
  state_.hard = contacts_;
  if (!contacts_.empty()) {
    const Number* multiplier = values(*data->curr()->y_d());
    for (std::size_t k = 0; k < contacts_.size(); ++k) state_.hard[k].force = std::max(0.0, -multiplier[k] * unit_ / length_);
  }
  look(moved);
  report_.history.back().shift = shift * unit_ / (length_ * length_);
  if (!escaped_.empty() || reached_) return false;
  stale_ = stale_ || energy_.kinematics().displacement(origin_, state_).colwise().norm().maxCoeff() > freedom_ / 2;
  return !stale_;
}

void IpoptProblem::remember(const State& accepted) {
  if (trail_.size() < limits::ipopt::most_watched) trail_.push_back(accepted);
  else trail_[next_++ % limits::ipopt::most_watched] = accepted;
}

// The forces of hard contacts are large or small beside this.
double IpoptProblem::force_scale() const {
  double largest = 1e-10 * unit_ / length_;                      // of the stiffness: less is none
  for (const HardForce& h : state_.hard) largest = std::max(largest, h.force);
  return largest;
}

// The state that was accepted: its residual; where that is small, whether there is an equilibrium.
void IpoptProblem::look(double moved) {
  if (!contacts_.empty()) {
    energy_.evaluate(state_, false);
    differentiated_ = false;
  }
  report_.energy = energy_.last_terms().total();
  double error = report_.residual = energy_.relative(energy_.gradient());
  report_.history.push_back({report_.energy, report_.residual, moved, 0});
  if (!(report_.residual <= memory_.close)) {
    escaped_ = elamin::escaped(energy_.model(), state_, limits::lost * extent_);
    lost_ = moved <= std::numeric_limits<double>::epsilon() * extent_ ? lost_ + 1 : 0;
    if (escaped_.empty() && lost_ == limits::ipopt::most_lost) escaped_ = "Ipopt's steps have become smaller than rounding";
    return;
  }
  const double largest = force_scale();
  if (!contacts_.empty() && !measure(step_.data(), false)) return;
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    error = std::max(error, std::min(state_.hard[k].force / largest, std::abs(gaps_[k].value) / length_));
  // A contact that hardly bears a force is open and closed alike for long: then Newton's method decides.
  const bool undecided = report_.residual <= options_.tolerance && ++waited_ >= limits::ipopt::patience;
  if (error > memory_.close && !undecided) return;
  waited_ = 0;
  reached_ = settle();
  memory_.close = std::max(memory_.close / 10, 1e-9);
}

// From the state by Newton's method to the equilibrium next to it, with the contacts whose forces are larger than their gaps.
bool IpoptProblem::settle() {
  State near = state_;
  const double largest = force_scale();
  near.hard.clear();
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    if (state_.hard[k].force * length_ > gaps_[k].value * largest) near.hard.push_back(state_.hard[k]);
  const Report found = equilibrium_.correct(near, options_.tolerance, nullptr, limits::ipopt::near_by * length_);
  report_.evaluations += found.evaluations, report_.factorizations += found.factorizations;
  differentiated_ = false;
  const bool saddle = found.converged() && !near.hard.empty() && memory_.close > 1e-8 && equilibrium_.inertia(near).negative > 0;
  const bool good = found.converged() && !saddle && (near.hard.empty() || energy_.collision_free_step(state_, near) == 1);
  if (good) {
    state_ = near;
    report_.energy = found.energy, report_.residual = found.residual;
    return true;
  }
  if (!contacts_.empty() || report_.residual > options_.tolerance) return false;
  return true;                                                   // as good as asked for, if not as can be
}

// Goes to y; false where the way there is barred.
bool IpoptProblem::move(const Number* y, bool renewed) {
  if (!renewed && arrived_) return free_;
  const Eigen::Map<const Vector> to(y, step_.size());
  if (arrived_ && step_ == to) return free_;
  differentiated_ = measured_ = false;
  arrived_ = to.allFinite();
  if (!arrived_) return free_ = false;
  step_ = to;
  at_.position = origin_.position, at_.low = origin_.low, at_.bodies = origin_.bodies;
  energy_.kinematics().retract(at_, step_, length_);
  return free_ = energy_.kinematics().displacement(origin_, at_).colwise().norm().maxCoeff() <= freedom_ && passes();
}

// Whether nothing is in the way from a state that was accepted: the last one, or one that Ipopt has gone back to.
bool IpoptProblem::passes() const {
  if (energy_.collision_free_step(state_, at_) == 1) return true;
  return std::any_of(trail_.begin(), trail_.end(), [&](const State& s) { return energy_.collision_free_step(s, at_) == 1; });
}

bool IpoptProblem::differentiate(const Number* y, bool renewed) {
  if (!move(y, renewed)) return false;
  if (!differentiated_) {
    ++report_.evaluations;
    energy_.evaluate(at_, true, {.from = &state_});
    stale_ = stale_ || energy_.pattern_version() != version_;
    gradient_ = energy_.gradient();
    const Vector way = length_ * step_;
    energy_.kinematics().pull_back(energy_.changeable_hessian(), gradient_, way), energy_.kinematics().pull_back(gradient_, way);
    steady_bodies(energy_, gradient_);
    differentiated_ = true;
  }
  return std::isfinite(energy_.last_terms().total());
}

bool IpoptProblem::measure(const Number* y, bool renewed) {
  if (!move(y, renewed)) return false;
  if (measured_) return true;
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    if (!hard_gap(energy_.model(), contacts_[k], at_, gaps_[k])) return false;
  return measured_ = true;
}

}  // namespace elamin
