#include "dynamics/relax.hpp"

#include "core/heartbeat.hpp"
#include "core/interrupt.hpp"
#include "core/sparse.hpp"
#include "core/timing.hpp"
#include "dynamics/forces.hpp"
#include "energy/step_limits.hpp"
#include "solve/limits.hpp"

#include <fmt/format.h>


namespace elamin {

namespace {

constexpr double longest_time = 1.1, first_time = 0.2;        // where no frequency is above 1
constexpr double step_of_diameter = 0.05;
constexpr int between_masses = 200, between_rows = 1000;

// FIRE's decisions, from the sums of one evaluation: power F·v, |F|² = Σ F²/m and |v|² = Σ m v².
struct Fire {
  double time = first_time, mixing = 0.25;
  int downhill = 0;
  bool stopped = true;                           // the velocity starts from zero

  void judge(double power) {
    if (power > 0) {
      stopped = false;
      if (++downhill > 20) time = std::min(time * 1.1, longest_time), mixing *= 0.99;
    } else {
      stopped = true;
      if (downhill > 0) time = std::max(time / 2, first_time / 10);
      downhill = 0, mixing = 0.25;
    }
  }
  /// v ← keep v + pull F/m:  v += t F/m, then (1 − α) v + α F/m |v|/|F|.
  struct Change { double keep, pull; };
  Change change(double power, double ff, double vv) const {
    if (stopped) return {0, time};
    const double size = std::sqrt(std::max(0.0, vv + 2 * time * power + time * time * ff));
    return {1 - mixing, (1 - mixing) * time + (ff > 0 ? mixing * size / std::sqrt(ff) : 0)};
  }
};

// Σ |Kᵢⱼ| of the rows of free dofs, and where a contact may come the stiffness of a light one.
Vector masses(Energy& energy) {
  const SparseMatrix& K = energy.hessian();
  Vector m = Vector::Zero(energy.dofs());
  for (const int d : energy.null_dofs()) m[d] = -std::abs(K.valuePtr()[K.outerIndexPtr()[d]]);     // not theirs
  add_absolute_row_sums(K, m);
  const Kinematics& kinematics = energy.kinematics();
  std::vector<double> light(kinematics.sites(), 0.0);
  const auto contact = [&](double modulus, const std::vector<int>& particles) {
    for (const int p : particles) light[p] = std::max(light[p], modulus * energy.model().diameter[p] / 2);
  };
  for (const PairContact& c : energy.model().contacts)
    for (const auto& side : c.particles) contact(c.effective_modulus, side);
  for (const Wall& w : energy.model().walls) contact(w.effective_modulus, w.particles);
  const auto rounded = [&](const RoundedKernel& kernel, const std::vector<int>& particles, const std::vector<int>& bodies) {
    const auto at = [&](int site) { light[site] = std::max(light[site], std::max(kernel.normal, kernel.attraction)); };
    for (const int p : particles) at(p);
    for (const int b : bodies) at(kinematics.place_of(b)), at(kinematics.rotation_of(b));
  };
  for (const RoundedPair& t : energy.model().rounded)
    for (int side = 0; side < 2; ++side) rounded(t.kernel, t.particles[side], t.bodies[side]);
  for (const Wall& w : energy.model().walls) rounded(w.kernel, {}, w.bodies);
  for (int d = 0; d < energy.dofs(); ++d) m[d] = std::max(m[d], light[energy.kinematics().site_of(d)]);
  const double most = m.maxCoeff();
  for (int d = 0; d < energy.dofs(); ++d)
    if (!(m[d] > 1e-12 * most)) m[d] = most > 0 ? most : 1;
  return m;
}

class Relaxation {
 public:
  Relaxation(Energy& energy, State& state, const RelaxOptions& options)
      : energy_(energy), state_(state), options_(options), v_(Vector::Zero(energy.dofs())) {
    const Model& model = energy.model();
    double smallest = infinity;
    for (int p = 0; p < model.particles(); ++p)
      if (!model.walls.empty() || energy.contact_rules().cutoff_radius(p) > 0) smallest = std::min(smallest, model.diameter[p]);
    for (const Bond& b : model.bonds)
      smallest = std::min(smallest, model.bond_types[b.type].rest_length);
    for (const Body& b : model.bodies) smallest = std::min(smallest, 2 * model.shapes[b.shape].radius);
    longest_ = step_of_diameter * smallest;
  }

  Report run() {
    const Stopwatch watch;
    if (energy_.dofs() > 0) look();
    if (converging() && energy_.model().bodies.empty()) fast();
    if (converging()) exact();
    finish();
    report_.seconds = watch.seconds();
    return report_;
  }

 private:
  bool converging() const {
    at_iteration(report_.iterations, residual_);
    return std::isfinite(residual_) && residual_ > options_.tolerance && report_.iterations < options_.max_steps && gone_.empty() && !interrupted();
  }

  // The exact forces and the stiffness at the state.
  void look() {
    energy_.evaluate(state_, true);
    ++report_.evaluations;
    residual_ = energy_.relative(energy_.gradient());
    mass_ = masses(energy_);
    gone_ = escaped(energy_.model(), state_, limits::lost * extent_);
  }

  void record(double step) {
    if (report_.iterations % between_rows == 0)
      report_.history.push_back({energy_.last_terms().total(), residual_, step, 0});
  }

  // What rounding of the positions does to a force, relative to the largest internal one.
  double plain_accuracy() const {
    return 16 * epsilon * mass_.maxCoeff() * state_.position.cwiseAbs().maxCoeff() / std::max(energy_.force_scale(), 1e-300);
  }

  void fast();
  void exact();
  void finish();

  Energy& energy_;
  State& state_;
  RelaxOptions options_;
  Report report_;
  Fire fire_;
  Vector v_, mass_;
  double longest_, residual_ = 0;
  const double extent_ = extent(energy_.model());
  std::string gone_;                             // what moves away without end
};

void Relaxation::fast() {
  const Kinematics& kinematics = energy_.kinematics();
  Forces forces(energy_.model(), state_.load_factor);
  const int n = energy_.model().particles();
  Columns x(state_.position), v(n), f(n), light(n);            // light: 1/m, 0 where held
  while (converging() && residual_ > plain_accuracy()) {
    const Field lightness = kinematics.extend(mass_.cwiseInverse());
    light = Columns(lightness);
    x = Columns(state_.position);
    const double scale = energy_.force_scale();
    const double enough = std::max(options_.tolerance, plain_accuracy()) * scale;
    for (int p = 0; p < n && forces.by_row(); p += 4) forces.movement().position.store(p, x.load(p));
    bool settled = false;
    for (int k = 0; k < between_masses && !settled && report_.iterations < options_.max_steps && !interrupted(); ++k) {
      forces.prepare(x);
      Lanes power(0.0), ff(0.0), vv(0.0), largest(0.0);
      for (int p = 0; p < n; p += 4) {
        const Triple<Lanes> F = forces.on(p / 4, x), u = v.load(p), w = light.load(p);
        f.store(p, F);
        power += dot(F, u);
        ff += F.x * F.x * w.x + F.y * F.y * w.y + F.z * F.z * w.z;
        vv += u.x * u.x * inverse(w.x) + u.y * u.y * inverse(w.y) + u.z * u.z * inverse(w.z);
        largest = max(largest, max(max(where(w.x, abs(F.x)), where(w.y, abs(F.y))), where(w.z, abs(F.z))));
      }
      settled = !(largest.largest() > enough);
      residual_ = largest.largest() / scale;
      fire_.judge(power.sum());
      const auto [keep, pull] = fire_.change(power.sum(), ff.sum(), vv.sum());
      Lanes fastest(0.0);
      for (int p = 0; p < n; p += 4) {
        const Triple<Lanes> F = f.load(p), w = light.load(p), u = v.load(p);
        const Triple<Lanes> now{Lanes(keep) * u.x + Lanes(pull) * w.x * F.x, Lanes(keep) * u.y + Lanes(pull) * w.y * F.y,
                                Lanes(keep) * u.z + Lanes(pull) * w.z * F.z};
        v.store(p, now);
        fastest = max(dot(now, now), fastest);
      }
      const double step = fire_.time * std::sqrt(fastest.largest()), part = step > longest_ ? longest_ / step : 1;
      for (int p = 0; p < n; p += 4) {
        const Triple<Lanes> u = Lanes(part) * v.load(p), at = x.load(p) + Lanes(fire_.time) * u;
        v.store(p, u), x.store(p, at);
        if (forces.by_row()) forces.movement().position.store(p, at);
      }
      forces.moved(part * step);
      ++report_.iterations;
      record(part * step);
    }
    for (int p = 0; p < n; ++p)
      for (int c = 0; c < 3; ++c)
        if (kinematics.dof(p, c) >= 0) state_.position(c, p) = x.at(c, p), state_.low(c, p) = 0, v_[kinematics.dof(p, c)] = v.at(c, p);
    look();
  }
}

void Relaxation::exact() {
  int since = 0;
  while (converging()) {
    if (++since % between_masses == 0) look();
    else energy_.evaluate(state_, false), ++report_.evaluations;
    const Vector F = -energy_.gradient();
    residual_ = energy_.relative(F);
    if (!converging()) break;
    const double power = F.dot(v_), ff = F.cwiseAbs2().dot(mass_.cwiseInverse()), vv = v_.cwiseAbs2().dot(mass_);
    fire_.judge(power);
    const auto [keep, pull] = fire_.change(power, ff, vv);
    v_ = keep * v_ + pull * F.cwiseQuotient(mass_);
    const double step = fire_.time * energy_.kinematics().extend(v_).colwise().norm().maxCoeff();
    if (step > longest_) v_ *= longest_ / step;
    energy_.kinematics().retract(state_, v_, fire_.time);
    ++report_.iterations;
    record(std::min(step, longest_));
  }
}

void Relaxation::finish() {
  energy_.evaluate(state_, true);
  ++report_.evaluations;
  report_.energy = energy_.last_terms().total();
  report_.residual = energy_.relative(energy_.gradient());
  if (report_.residual <= options_.tolerance) {
    report_.status = Status::converged;
    report_.why = fmt::format("residual {:.1e} after {} steps", report_.residual, report_.iterations);
  } else if (interrupted()) {
    report_.status = Status::interrupted;
    report_.why = fmt::format("interrupted after {} steps at a residual of {:.1e}", report_.iterations, report_.residual);
  } else {
    report_.status = Status::not_converged;
    report_.why = !gone_.empty() ? gone_ : std::isfinite(report_.residual)
                      ? fmt::format("residual {:.1e} is above {:.1e} after {} steps", report_.residual, options_.tolerance, report_.iterations)
                      : fmt::format("the energy is not finite after {} steps", report_.iterations);
  }
}

}  // namespace

Report relax(Energy& energy, State& state, const RelaxOptions& options) { return Relaxation(energy, state, options).run(); }

}  // namespace elamin
