#include "dynamics/verlet.hpp"

#include "core/exact.hpp"
#include "core/interrupt.hpp"
#include "dynamics/moving_bodies.hpp"
#include "dynamics/motion.hpp"
#include "dynamics/forces.hpp"
#include "energy/kinematics.hpp"

#include <algorithm>

namespace elamin {

namespace {

constexpr int work_of_body = 20;                // in particles
constexpr std::int64_t work_between_looks = 200000;   // particle-steps until the next look at interrupts and lost positions

}  // namespace

class Verlet::Engine {
 public:
  Engine(const Model& model, Motion start, double timestep)
      : model_(model), n_(model.particles()), dt_(timestep), motion_(std::move(start)),
        forces_(model, motion_.state.load_factor), x_(motion_.state.position), v_(n_), f_(n_), kick_(n_), drag_(padded(n_)),
        turn_(padded(n_)), first_step_(motion_.step), first_time_(motion_.time) {
    const Kinematics kinematics(model);
    refuse_what_cannot_move(model, kinematics);
    if (!model.bodies.empty()) bodies_.emplace(model, kinematics, motion_, dt_, forces_, MovingParticles{x_, v_, f_, drag_});
    motion_.state.low.setZero();
    if (motion_.velocity.cols() == n_) v_ = Columns(motion_.velocity);
    if (motion_.angular_velocity.cols() != n_) motion_.angular_velocity = Field::Zero(3, n_);
    motion_.velocity.resize(3, n_), motion_.force.resize(3, n_);
    for (int p = 0; p < n_; ++p) {
      const double m = model.mass(p), r = model.diameter[p] / 2;
      bool free = false;
      for (int c = 0; c < 3; ++c) {
        const bool moves = kinematics.dof(p, c) >= 0;
        free = free || moves;
        kick_.at(c, p) = moves ? dt_ / 2 / m : 0;
        if (!moves) v_.at(c, p) = 0;
      }
      if (free && r > 0) turn_[p] = dt_ / 2 / (0.4 * m * r * r);
    }
    drive();
    for (const Viscosity& w : model.viscosity)
      for (const int p : w.particles) drag_[p] += w.coefficient;
    resists_ = forces_.damped() || (bodies_ && forces_.bodies()->damps()) || std::any_of(drag_.begin(), drag_.end(), [](double g) { return g != 0; });
    for (int p = 0; p < n_ && forces_.rubs(); ++p)
      forces_.movement().angular_velocity.add(p, {motion_.angular_velocity(0, p), motion_.angular_velocity(1, p), motion_.angular_velocity(2, p)});
    if (!forces_.rubs()) motion_.angular_velocity.resize(3, 0);
    for (int p = 0; p < n_ && forces_.by_row(); p += 4) show(p, x_.load(p), v_.load(p));
    if (bodies_) bodies_->carry();
    forces_.prepare(x_);
    look();
    write_motion();
  }

  std::int64_t advance(std::int64_t steps) {
    const int work = n_ + work_of_body * static_cast<int>(model_.bodies.size());
    const std::int64_t between_looks = std::max<std::int64_t>(1, work_between_looks / std::max(work, 1));
    std::int64_t done = 0;
    while (done < steps && finite_ && !interrupted()) {
      const std::int64_t some = std::min(between_looks, steps - done);
      resists_ ? take<true>(some) : take<false>(some);
      done += some;
      finite_ = all_finite();
    }
    if (done > 0) write_motion();
    return done;
  }

  void carry(Archive& archive) {
    archive(motion_, x_, v_, f_, steps_, finite_, fastest_, working_, dissipating_, forces_);
    if (bodies_) archive(*bodies_);
  }

  bool finite() const { return finite_; }
  const Motion& motion() const { return motion_; }
  double timestep() const { return dt_; }
  double kinetic() const {
    ExactSum sum;
    if (bodies_) sum.add(bodies_->kinetic());
    for (int p = 0; p < n_; ++p) {
      const double m = model_.mass(p), r = model_.diameter[p] / 2;
      if (!(m > 0)) continue;
      sum.add(m / 2 * motion_.velocity.col(p).squaredNorm());
      if (motion_.angular_velocity.cols() == n_ && turn_[p] > 0) sum.add(0.2 * m * r * r * motion_.angular_velocity.col(p).squaredNorm());
    }
    return sum.value();
  }

 private:
  struct Driven { int particle, coordinate; double start, velocity; };

  // Where several supports hold a coordinate, the last one does.
  void drive() {
    Columns velocity(n_);
    for (const Support& s : model_.supports)
      for (const int p : s.particles)
        for (int c = 0; c < 3; ++c)
          if (s.held[c]) velocity.at(c, p) = s.velocity[c];
    for (int p = 0; p < n_; ++p)
      for (int c = 0; c < 3; ++c)
        if (const double V = velocity.at(c, p); V != 0) {
          driven_.push_back({p, c, x_.at(c, p), V});
          v_.at(c, p) = V;
        }
  }

  template <bool resists>
  void take(std::int64_t steps) {
    start();
    for (std::int64_t k = 1; k <= steps; ++k) {
      ++steps_;
      place_driven();
      forces_.moved(dt_ * std::sqrt(fastest_));
      forces_.prepare(x_);
      double power = finish<resists>(k == steps);
      if (bodies_) power += bodies_->finish(k == steps);
      motion_.dissipation += dt_ / 2 * (dissipating_ + power);
      dissipating_ = power;
      if (driven_.empty() && !(bodies_ && bodies_->driven())) continue;
      const double rate = work_rate();
      motion_.work += dt_ / 2 * (working_ + rate);
      working_ = rate;
    }
  }

  // Every force at a whole step with the velocity v, and of it what resists the motion.
  template <bool resists>
  [[gnu::always_inline]] Triple<Lanes> force(int p, const Triple<Lanes>& v, Triple<Lanes>& resistance) {
    const Triple<Lanes> f = forces_.on(p / 4, x_);
    if constexpr (!resists) return f;
    resistance = -Lanes::load(&drag_[p]) * v;
    if (forces_.damped()) resistance = resistance + forces_.damping_on(p / 4);
    return f + resistance;
  }

  // Forces and powers at the start.
  void look() {
    Lanes power(0.0);
    for (int p = 0; p < n_; p += 4) {
      const Triple<Lanes> v = v_.load(p);
      Triple<Lanes> resistance{0.0, 0.0, 0.0};
      f_.store(p, resists_ ? force<true>(p, v, resistance) : force<false>(p, v, resistance));
      power -= dot(resistance, v);
    }
    for (int p = 0; p < n_ && forces_.rubs(); ++p) power -= forces_.torque_on(p) * forces_.movement().angular_velocity.row[p];
    dissipating_ = power.sum();
    if (bodies_) dissipating_ += bodies_->look();
    working_ = work_rate();
  }

  // From a whole step: the first kick and the drift.
  void start() {
    Lanes fastest(0.0);
    for (int p = 0; p < n_; p += 4) {
      Triple<Lanes> v = v_.load(p);
      kick(p, f_.load(p), v);
      drift(p, v, fastest);
    }
    fastest_ = fastest.largest();
    for (int p = 0; p < n_ && forces_.rubs(); ++p) forces_.movement().angular_velocity.row[p] += Lanes(turn_[p]) * forces_.torque_on(p);
    if (bodies_) bodies_->start();
  }

  // The second kick of a step; unless it is the last one, the first kick and the drift of the next besides. Returns the power
  // of what resists at the whole step.
  template <bool resists>
  double finish(bool last) {
    Lanes fastest(0.0), power(0.0);
    const bool keep = last || !driven_.empty() || !model_.glued.empty();
    for (int p = 0; p < n_; p += 4) {
      Triple<Lanes> v = v_.load(p), resistance;
      const Triple<Lanes> f = force<resists>(p, v, resistance);
      kick(p, f, v);
      if constexpr (resists) power -= dot(resistance, v);
      if (keep) f_.store(p, f);
      if (last) {
        v_.store(p, v);
        continue;
      }
      kick(p, f, v);
      drift(p, v, fastest);
    }
    fastest_ = fastest.largest();
    for (int p = 0; p < n_ && forces_.rubs(); ++p) {
      Lanes& omega = forces_.movement().angular_velocity.row[p];
      const Lanes torque = forces_.torque_on(p), change = Lanes(turn_[p]) * torque;
      omega += change;
      power -= torque * omega;
      if (!last) omega += change;
    }
    return power.sum();
  }

  void kick(int p, const Triple<Lanes>& f, Triple<Lanes>& v) const {
    const Triple<Lanes> k = kick_.load(p);
    v = {multiply_add(k.x, f.x, v.x), multiply_add(k.y, f.y, v.y), multiply_add(k.z, f.z, v.z)};
  }

  void drift(int p, const Triple<Lanes>& v, Lanes& fastest) {
    const Triple<Lanes> x = multiply_add(Lanes(dt_), v, x_.load(p));
    x_.store(p, x), v_.store(p, v);
    if (!forces_.by_row()) return;              // nobody looks for neighbours
    show(p, x, v);
    fastest = max(dot(v, v), fastest);
  }

  void show(int p, const Triple<Lanes>& x, const Triple<Lanes>& v) {
    forces_.movement().position.store(p, x);
    if (forces_.damped()) forces_.movement().velocity.store(p, v);
  }

  void place_driven() {
    for (const Driven& d : driven_) {
      const double x = d.start + d.velocity * (static_cast<double>(steps_) * dt_);
      x_.at(d.coordinate, d.particle) = x;
      if (forces_.by_row()) forces_.movement().position.row[d.particle].v[d.coordinate] = x;
    }
    if (bodies_) fastest_ = std::max(fastest_, bodies_->place(static_cast<double>(steps_) * dt_));
  }

  // What the supports put in: they bear what the forces leave, −F, at the velocity V.
  double work_rate() {
    double rate = 0;
    for (const Driven& d : driven_) rate -= f_.at(d.coordinate, d.particle) * d.velocity;
    return bodies_ ? rate + bodies_->work_rate() : rate;
  }

  bool all_finite() const {
    Lanes zero(0.0);
    for (int p = 0; p < n_; p += 4) {
      const Triple<Lanes> x = x_.load(p);
      zero += (x.x - x.x) + (x.y - x.y) + (x.z - x.z);
    }
    return zero.sum() == 0 && !(bodies_ && !bodies_->finite());
  }

  void write_motion() {
    x_.copy_to(motion_.state.position), v_.copy_to(motion_.velocity), f_.copy_to(motion_.force);
    for (int p = 0; p < n_ && forces_.rubs(); ++p) {
      const Triple<double> w = forces_.movement().angular_velocity.at(p);
      motion_.angular_velocity.col(p) << w.x, w.y, w.z;
    }
    if (bodies_) bodies_->write(motion_);
    motion_.step = first_step_ + steps_;
    motion_.time = first_time_ + static_cast<double>(steps_) * dt_;
  }

  const Model& model_;
  int n_;
  double dt_;
  Motion motion_;
  Forces forces_;
  Columns x_, v_, f_;
  Columns kick_;                                // dt/2m of every coordinate, 0 where it is held
  std::vector<double> drag_;                    // γ
  std::vector<double> turn_;                    // dt/2I, 0 where the particle is held whole
  std::optional<BodySteps> bodies_;
  std::vector<Driven> driven_;
  bool resists_ = false, finite_ = true;
  std::int64_t steps_ = 0, first_step_;         // taken by this one; before
  double first_time_;
  double fastest_ = 0;                          // |v|² of the last drift
  double working_ = 0, dissipating_ = 0;        // the powers at the last whole step
};

Verlet::Verlet(const Model& model, Motion start, double timestep)
    : engine_(std::make_unique<Engine>(model, std::move(start), timestep)) {}
Verlet::~Verlet() = default;
Verlet::Verlet(Verlet&&) noexcept = default;
std::int64_t Verlet::advance(std::int64_t steps) { return engine_->advance(steps); }
void Verlet::carry(Archive& archive) { engine_->carry(archive); }
bool Verlet::finite() const { return engine_->finite(); }
const Motion& Verlet::motion() const { return engine_->motion(); }
double Verlet::timestep() const { return engine_->timestep(); }
double Verlet::kinetic() const { return engine_->kinetic(); }

}  // namespace elamin
