#include "solve/contact_equilibrium.hpp"

#include "core/dense.hpp"
#include "core/heartbeat.hpp"
#include "core/interrupt.hpp"
#include "core/timing.hpp"
#include "energy/step_limits.hpp"
#include "solve/limits.hpp"
#include "solve/ritz.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

const char* const too_far = "there is no equilibrium near enough";
const char* const singular = "nothing holds what can move here: the equations are singular, with any shift";

bool same_contacts(const std::vector<HardForce>& a, const std::vector<HardForce>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const HardForce& x, const HardForce& y) { return key(x) == key(y); });
}

}  // namespace

// Evaluates the energy at the state, and the closed gaps; the matrix takes the values, after its pattern where that is new.
void ContactEquilibrium::linearise(const State& state, const State* from, const Eigen::MatrixXd& held) {
  energy_.evaluate(state, true, {.from = from});
  gaps_.resize(state.hard.size());
  for (std::size_t k = 0; k < gaps_.size(); ++k)
    if (!hard_gap(energy_.model(), state.hard[k], state, gaps_[k])) gaps_[k].sites = 0;
  const SparseMatrix& h = energy_.hessian();
  const Kinematics& kinematics = energy_.kinematics();
  const int n = energy_.dofs(), m = static_cast<int>(gaps_.size());
  scale_ = 0;
  for (Eigen::Index k = 0; k < h.nonZeros(); ++k) scale_ = std::max(scale_, std::abs(h.valuePtr()[k]));
  scale_ = std::max(scale_, energy_.force_scale() / energy_.kinematics().smallest_size());
  if (!(scale_ > 0 && std::isfinite(scale_))) scale_ = 1;

  std::vector<Eigen::Triplet<double>> entries;
  for (int j = 0; j < n; ++j)
    for (SparseMatrix::InnerIterator it(h, j); it; ++it) entries.emplace_back(it.row(), j, it.value());
  for (int k = 0; k < m; ++k) {
    for (int i = 0; i < gaps_[k].sites; ++i)
      for (int c = 0; c < 3; ++c)
        if (const int d = kinematics.dof(gaps_[k].site[i], c); d >= 0) entries.emplace_back(n + k, d, scale_ * gaps_[k].gradient[3 * i + c]);
    entries.emplace_back(n + k, n + k, -limits::hard::give * scale_);
  }
  matrix_.resize(n + m, n + m);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  if (version_ != energy_.pattern_version() || !same_contacts(closed_, state.hard) || borders_.cols() != held.cols()) {
    pivoted_.analyze(matrix_, static_cast<int>(held.cols()));
    version_ = energy_.pattern_version();
  }
  closed_ = state.hard;
  borders_ = Eigen::MatrixXd::Zero(n + m, held.cols());
  if (held.cols() > 0) borders_.topRows(n) = held;
}

bool ContactEquilibrium::factorize(double shift) {
  if (shift != 0)
    for (int j = 0; j < energy_.dofs(); ++j) matrix_.valuePtr()[matrix_.outerIndexPtr()[j]] += shift;
  if (borders_.cols() > 0) border_unit_ = border_scale(matrix_, 0);
  const bool done = pivoted_.factorize(matrix_, 0, borders_);
  if (shift != 0)
    for (int j = 0; j < energy_.dofs(); ++j) matrix_.valuePtr()[matrix_.outerIndexPtr()[j]] -= shift;
  return done;
}

// With this shift or, where that leaves the matrix singular, with the next larger one that does not. False: none does.
bool ContactEquilibrium::factorize_near(double shift) {
  const double next = shift > 0 ? 4 * shift : 16 * std::max(factors_.zero_level(), epsilon * scale_);
  return first_shift(shift, next, 4, [&](double s) { return factorize(s); }).has_value();
}

// p, Δf of H p − Jᵀ Δf + Z μ = b, J p = c, Zᵀ p = 0, or `along` for the last of the directions Z that are held.
ContactEquilibrium::Step ContactEquilibrium::solve(const Vector& b, const Vector& c, double along) {
  const Eigen::Index held = borders_.cols();
  Vector right = Vector::Zero(b.size() + c.size() + held);
  right.head(b.size()) = b, right.segment(b.size(), c.size()) = scale_ * c;
  if (held > 0) right[right.size() - 1] = border_unit_ * along;
  const Vector x = pivoted_.solve(right);
  return {x.head(b.size()), -scale_ * x.segment(b.size(), c.size()), held > 0 ? border_unit_ * x[x.size() - 1] : 0.0};
}

// ∂c/∂λ with what is prescribed, and J p of one gap.
double ContactEquilibrium::rate(const HardGap& gap) const {
  double rate = gap.rate;
  for (int i = 0; i < gap.sites; ++i) rate += gap.gradient.segment<3>(3 * i).dot(energy_.kinematics().drive(gap.site[i]));
  return rate;
}

double ContactEquilibrium::along(const HardGap& gap, const Vector& p) const {
  double sum = 0;
  for (int i = 0; i < gap.sites; ++i)
    for (int c = 0; c < 3; ++c)
      if (const int d = energy_.kinematics().dof(gap.site[i], c); d >= 0) sum += gap.gradient[3 * i + c] * p[d];
  return sum;
}

// The closed gap that is farthest from closed, in diameters.
double ContactEquilibrium::worst_gap(const State& state) const {
  double worst = 0;
  for (std::size_t k = 0; k < gaps_.size(); ++k)
    worst = std::max(worst, gaps_[k].sites ? std::abs(gaps_[k].value) / energy_.model().diameter[state.hard[k].particle] : 1.0);
  return worst;
}

// With `changing` the load factor moves by δ so that its gap or force vanishes:  p = p₀ + δ p₁, Δf = f₀ + δ f₁, where p₀, f₀ leave the
// load factor as it is and p₁, f₁ are the tangent.
Report ContactEquilibrium::newton(State& state, double tolerance, const State* from, double step_bound, const Eigen::MatrixXd& held,
                                  const HardForce* changing) {
  const Stopwatch watch;
  std::size_t place = 0;                                        // of `changing` among the closed ones
  while (changing && place < state.hard.size() && key(state.hard[place]) != key(*changing)) ++place;
  const bool by_gap = changing && place == state.hard.size();
  HardGap open;
  Report report;
  const State start = state;
  State previous, best;
  double least = infinity, moved = 0;
  int polishing = 0, worse = 0;
  const auto end = [&](Status status, std::string why) {
    report.status = status, report.why = std::move(why), report.seconds = watch.seconds();
    return report;
  };
  for (;; ++report.iterations) {
    linearise(state, from, held);
    ++report.evaluations;
    const double residual = energy_.relative(energy_.gradient());
    double error = std::max(residual, worst_gap(state)), left = 0;
    if (by_gap && !hard_gap(energy_.model(), *changing, state, open)) return end(Status::not_converged, "a gap is lost from sight");
    if (by_gap) left = open.value, error = std::max(error, std::abs(left) / energy_.model().diameter[changing->particle]);
    else if (changing) left = state.hard[place].force, error = std::max(error, energy_.relative(Vector::Constant(1, left)));
    if (!std::isfinite(error) || !std::isfinite(energy_.last_terms().total())) return end(Status::not_converged, "the energy is not finite");
    report.history.push_back({energy_.last_terms().total(), residual, moved, 0});
    const bool better = error <= least / 2;
    if (error < least) best = state, least = error, report.energy = energy_.last_terms().total(), report.residual = residual;
    worse = better ? 0 : worse + 1;
    if (least <= tolerance) {
      const bool rounding = least <= 4 * epsilon || (!better && polishing > 0);
      if (rounding || polishing++ == limits::hard::most_polishing) {
        state = best;
        return end(Status::converged, fmt::format("the residual is below {:g}", tolerance));
      }
    } else if (interrupted()) {
      return end(Status::interrupted, "interrupted");
    } else if (report.iterations == limits::hard::most_steps || worse > 6) {
      return end(Status::not_converged, fmt::format("Newton's method does not contract; the residual is {:.2g}", residual));
    }
    Vector gaps(static_cast<Eigen::Index>(gaps_.size())), rates(gaps.size());
    for (std::size_t k = 0; k < gaps_.size(); ++k) {
      gaps[static_cast<Eigen::Index>(k)] = gaps_[k].value, rates[static_cast<Eigen::Index>(k)] = rate(gaps_[k]);
    }
    if (!factorize_near(0)) return interrupted() ? end(Status::interrupted, "interrupted") : end(Status::not_converged, singular);
    ++report.factorizations;
    Step step = solve(-energy_.gradient(), -gaps);
    double change = 0;                                          // of the load factor
    if (changing) {
      const Step by_load = solve(-energy_.load_derivative(), -rates);
      const Eigen::Index k = static_cast<Eigen::Index>(place);
      change = by_gap ? -(left + along(open, step.p)) / (rate(open) + along(open, by_load.p)) : -(left + step.force[k]) / by_load.force[k];
      step.p += change * by_load.p, step.force += change * by_load.force;
    }
    if (!step.p.allFinite() || !std::isfinite(change)) return end(Status::not_converged, "the equations have no solution");
    const double rotation = distortion(energy_, state, step.p);
    const double part = std::min({1.0, 0.3 / std::max(rotation, 1e-300), 0.5 / std::max(movement(energy_, step.p), 1e-300)});
    previous = state, from = &previous;
    if (changing) energy_.kinematics().prescribe(state, state.load_factor + part * change);
    energy_.kinematics().retract(state, step.p, part);
    moved = part * infinity_norm(step.p);
    if (energy_.kinematics().displacement(start, state).cwiseAbs().maxCoeff() > step_bound) return end(Status::not_converged, too_far);
    for (std::size_t k = 0; k < gaps_.size(); ++k) state.hard[k].force += part * step.force[static_cast<Eigen::Index>(k)];
  }
}

// p = p₀ + δ p₁, δ the change of the load factor: so that no force is needed along the mode, μ₀ + δ μ₁ = 0.
Report ContactEquilibrium::slide(State& state, const State& origin, const Vector& mode, double amount, double tolerance,
                                 const Eigen::MatrixXd& held, double& slope) {
  const Stopwatch watch;
  Report report;
  Eigen::MatrixXd borders(mode.size(), held.cols() + 1);
  if (held.cols() > 0) borders.leftCols(held.cols()) = held;
  borders.rightCols(1) = mode;
  State previous = state, best;
  const State* from = nullptr;
  double least = infinity;
  const double size = energy_.kinematics().smallest_size();
  report.why = "Newton's method does not contract";
  for (; report.iterations <= limits::hard::most_steps && !interrupted(); ++report.iterations) {
    linearise(state, from, borders);
    const double residual = energy_.relative(energy_.gradient());
    const double left = amount - mode.dot(energy_.kinematics().difference(origin, state));
    const double error = std::max({residual, worst_gap(state), std::abs(left) / size});
    at_iteration(report.iterations, residual);
    if (!std::isfinite(error) || !factorize_near(0)) break;
    ++report.factorizations;
    Vector gaps(static_cast<Eigen::Index>(gaps_.size())), rates(gaps.size());
    for (std::size_t k = 0; k < gaps_.size(); ++k) gaps[static_cast<Eigen::Index>(k)] = gaps_[k].value, rates[static_cast<Eigen::Index>(k)] = rate(gaps_[k]);
    const Step by_load = solve(-energy_.load_derivative(), -rates);
    const bool better = error <= least / 2;
    if (error < least) {
      const Step by_mode = solve(Vector::Zero(mode.size()), Vector::Zero(gaps.size()), 1);
      best = state, least = error, slope = -by_mode.border / by_load.border;
      report.residual = residual, report.energy = energy_.last_terms().total();
    }
    if (least <= tolerance && (!better || least <= 4 * epsilon)) {
      state = best;
      report.status = Status::converged, report.why = fmt::format("the residual is below {:g}", tolerance);
      break;
    }
    Step step = solve(-energy_.gradient(), -gaps, left);
    const double change = -step.border / by_load.border;
    step.p += change * by_load.p, step.force += change * by_load.force;
    if (!step.p.allFinite() || !std::isfinite(change)) break;
    const double rotation = distortion(energy_, state, step.p, change);
    const double part = std::min({1.0, 0.3 / std::max(rotation, 1e-300), 0.5 / std::max(movement(energy_, step.p), 1e-300)});
    previous = state, from = &previous;
    energy_.kinematics().prescribe(state, state.load_factor + part * change);
    energy_.kinematics().retract(state, step.p, part);
    for (std::size_t k = 0; k < gaps_.size(); ++k) state.hard[k].force += part * step.force[static_cast<Eigen::Index>(k)];
  }
  report.seconds = watch.seconds();
  return report;
}

double ContactEquilibrium::curvature(const State& state, const Vector& mode, const Eigen::MatrixXd& held) {
  Eigen::MatrixXd borders(mode.size(), held.cols() + 1);
  if (held.cols() > 0) borders.leftCols(held.cols()) = held;
  borders.rightCols(1) = mode;
  linearise(state, nullptr, borders);
  if (!factorize_near(0)) return std::numeric_limits<double>::quiet_NaN();
  return -solve(Vector::Zero(mode.size()), Vector::Zero(static_cast<Eigen::Index>(gaps_.size())), 1).border;
}

Report ContactEquilibrium::correct(State& state, double tolerance, const State* from, double step_bound, const Eigen::MatrixXd& held) {
  const State start = state;
  Report total;
  const Stopwatch watch;
  for (int change = 0;; ++change) {
    Report report = settle(state, tolerance, change == 0 ? from : nullptr, step_bound, held);
    total.iterations += report.iterations, total.evaluations += report.evaluations, total.factorizations += report.factorizations;
    total.history.insert(total.history.end(), report.history.begin(), report.history.end());
    total.status = report.status, total.why = report.why, total.energy = report.energy, total.residual = report.residual;
    total.seconds = watch.seconds();
    if (report.converged() && energy_.kinematics().displacement(start, state).cwiseAbs().maxCoeff() > step_bound)
      total.status = Status::not_converged, total.why = too_far;
    if (!total.converged()) return total;
    const double slightest = std::max(tolerance, 64 * epsilon) * energy_.force_scale();
    const std::vector<HardForce> before = state.hard;
    std::vector<HardForce> now;
    for (const HardForce& h : before)
      if (h.force >= -slightest) now.push_back(h);
    for (const HardForce& h : energy_.hard_contacts(state, 0)) {
      HardGap gap;
      const bool closed = std::any_of(before.begin(), before.end(), [&](const HardForce& b) { return key(b) == key(h); });
      if (!closed && hard_gap(energy_.model(), h, state, gap) && gap.value < -limits::hard::gap_rounding * energy_.model().diameter[h.particle])
        now.push_back(h);
    }
    std::sort(now.begin(), now.end(), [](const HardForce& a, const HardForce& b) { return key(a) < key(b); });
    if (same_contacts(now, before)) {
      std::erase_if(state.hard, [&](const HardForce& h) { return !(h.force > 0); });
      return total;
    }
    state.hard = std::move(now);
    if (change == limits::hard::most_changes || interrupted()) {
      total.status = interrupted() ? Status::interrupted : Status::not_converged;
      total.why = "which hard contacts are closed could not be told: they change without end";
      return total;
    }
  }
}

Inertia ContactEquilibrium::inertia(const State& state) {
  linearise(state, nullptr);
  const double sigma = factors_.zero_level();
  const int contacts = static_cast<int>(gaps_.size());
  const auto factor_at = [&](double shift) { return first_shift(shift, 1.5 * shift, 1.5, [&](double s) { return factorize(s); }).has_value(); };
  const Inertia inertia{0, std::max(1, energy_.dofs() - contacts)};       // without a factor
  if (!factor_at(sigma)) return inertia;
  const int below = pivoted_.negative() - contacts;
  if (!factor_at(-sigma)) return inertia;
  return {below, std::max(0, pivoted_.negative() - contacts - below)};
}

ContactEquilibrium::Tangent ContactEquilibrium::tangent(const State& state, const Eigen::MatrixXd& held) {
  linearise(state, nullptr, held);
  Vector rates(static_cast<Eigen::Index>(gaps_.size()));
  for (std::size_t k = 0; k < gaps_.size(); ++k) rates[static_cast<Eigen::Index>(k)] = rate(gaps_[k]);
  if (!factorize_near(0)) return {Vector::Zero(energy_.dofs()), Vector::Zero(rates.size())};
  const Step step = solve(-energy_.load_derivative(), -rates);
  return {step.p, step.force};
}

std::optional<std::vector<HardForce>> ContactEquilibrium::onward(State state, const std::vector<HardForce>& slack, double direction) {
  const auto place = [](const std::vector<HardForce>& among, const HardForce& h) {
    return std::find_if(among.begin(), among.end(), [&](const HardForce& x) { return key(x) == key(h); });
  };
  const auto close = [&](const HardForce& h, bool closed) {
    if (const auto at = place(state.hard, h); at != state.hard.end()) state.hard.erase(at);
    if (closed) state.hard.push_back({h.particle, h.other, h.wall, h.face, 0});
    std::sort(state.hard.begin(), state.hard.end(), [](const HardForce& x, const HardForce& y) { return key(x) < key(y); });
  };
  // Those of `slack` whose force or gap falls below zero; nothing where the equations have no solution.
  const auto wrong = [&]() -> std::optional<std::vector<const HardForce*>> {
    linearise(state, nullptr);
    // Motions that cost nothing are as soft as can be told from that: whether contacts hold them is what is asked here.
    if (!factorize_near(16 * std::max(factors_.zero_level(), epsilon * scale_))) return {};
    Vector rates(static_cast<Eigen::Index>(gaps_.size()));
    for (std::size_t k = 0; k < gaps_.size(); ++k) rates[static_cast<Eigen::Index>(k)] = rate(gaps_[k]);
    const Vector load = energy_.load_derivative();
    const Step step = solve(-direction * load, -direction * rates);
    if (!step.p.allFinite() || !step.force.allFinite()) return {};
    const double motion = infinity_norm(step.p);
    double speed = motion;
    std::vector<HardGap> open(slack.size());
    for (std::size_t k = 0; k < slack.size(); ++k)
      if (hard_gap(energy_.model(), slack[k], state, open[k])) speed = std::max(speed, std::abs(rate(open[k])));
    const double no_gap = limits::hard::rounding_of_rates * speed;
    const double no_force = limits::hard::rounding_of_rates * std::max(infinity_norm(step.force), infinity_norm(load)) + 64 * epsilon * scale_ * motion;
    std::vector<const HardForce*> found;
    for (std::size_t k = 0; k < slack.size(); ++k) {
      const auto at = place(state.hard, slack[k]);
      const bool bad = at != state.hard.end() ? step.force[at - state.hard.begin()] < -no_force
                                              : open[k].sites > 0 && along(open[k], step.p) + direction * rate(open[k]) < -no_gap;
      if (bad) found.push_back(&slack[k]);
    }
    return found;
  };
  const int most_pivots = limits::hard::pivots_at_least + limits::hard::pivots_each * static_cast<int>(slack.size());
  std::size_t least = slack.size() + 1;                         // that were wrong so far
  int chances = limits::hard::block_chances;
  for (int pivot = 0; pivot < most_pivots && !interrupted(); ++pivot) {
    auto change = wrong();
    if (!change) break;
    if (change->empty()) return state.hard;
    if (change->size() < least) least = change->size(), chances = limits::hard::block_chances;
    else --chances;
    if (chances <= 0) change->erase(change->begin() + 1, change->end());                  // in the order of `slack`
    for (const HardForce* h : *change) close(*h, place(state.hard, *h) == state.hard.end());
  }
  // Where one of the choices is unstable, as at the end of two branches that are mirror images, pivots may go round in a circle past the right one.
  if (slack.size() > limits::hard::most_tried) return {};
  for (std::size_t choice = std::size_t{1} << slack.size(); choice-- > 0 && !interrupted();) {
    for (std::size_t k = 0; k < slack.size(); ++k) close(slack[k], choice >> k & 1);
    if (const auto change = wrong(); change && change->empty()) return state.hard;
  }
  return {};
}

EigenPairs ContactEquilibrium::lowest(const State& state, int count) {
  linearise(state, nullptr);
  const int n = energy_.dofs(), contacts = static_cast<int>(gaps_.size());
  const Eigen::Index block = std::min(std::max(1, n - contacts), count + 3);
  count = std::min(count, static_cast<int>(block));
  const double sigma = std::max(factors_.zero_level(), epsilon * scale_);       // a shift that leaves nothing negative
  const auto positive = first_shift(sigma, 8 * sigma, 8, [&](double s) { return factorize(s) && pivoted_.negative() <= contacts; });
  Eigen::MatrixXd x(n, block);
  for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] = std::sin(1 + 12.9898 * static_cast<double>(i));
  const Vector none = Vector::Zero(contacts);
  Vector values = Vector::Zero(block), before;
  for (int k = 0; positive && k < 100 && !interrupted(); ++k) {
    for (Eigen::Index j = 0; j < block; ++j) x.col(j) = solve(x.col(j).normalized(), none).p;
    x = orthonormal(x);
    before = values, values = rotate_to_ritz(energy_, x);
    const double change = (values - before).head(count).cwiseAbs().maxCoeff(), size = values.head(count).cwiseAbs().maxCoeff();
    if (k > 3 && change <= 1e-6 * size + factors_.zero_level() / 64) break;
  }
  return {values.head(count), x.leftCols(count)};
}

}  // namespace elamin
