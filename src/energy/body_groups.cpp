#include "energy/body_groups.hpp"

#include "laws/rounded/closest.hpp"
#include "laws/rounded/multi.hpp"
#include "laws/rounded/rotation.hpp"

namespace elamin {

namespace {

constexpr std::int64_t bodies_per_thread = 20;

// Turn rows and columns of a Local of n sites, per unit of length: those of site k divided by length[k], 1 for places.
template <int n>
void to_lengths(Local<n>& u, const std::array<double, n>& length) {
  Eigen::Matrix<double, 3 * n, 1> scale;
  for (int k = 0; k < n; ++k) scale.template segment<3>(3 * k).setConstant(1 / length[k]);
  u.gradient.array() *= scale.array();
  u.hessian = (scale.asDiagonal() * u.hessian * scale.asDiagonal()).eval();
}

double rounded_value(const RoundedPair& table, const RoundedBody& a, const RoundedBody& b) {
  return table.formulation == RoundedFormulation::closest ? RoundedClosest{table.kernel}.value(a, b)
                                                          : RoundedMulti{table.kernel}.value(a, b);
}

// Elements with n sites that stand in space.
template <int n>
class BodyGroup : public ElementGroup {
 public:
  int elements() const override { return static_cast<int>(stencils_.size()); }
  int sites() const override { return n; }
  std::span<const int> stencils() const override { return in_a_row(stencils_); }
  bool anchored() const override { return true; }
  bool residual_energy(const State&, const State&, double*) const override { return false; }

 protected:
  std::vector<std::array<int, n>> stencils_;
};

// n = 4: two bodies; 3: a body and a particle, second.
template <int n>
class RoundedGroup final : public BodyGroup<n> {
  using BodyGroup<n>::stencils_;

 public:
  RoundedGroup(const Model& model, const Kinematics& kinematics, const BodyNeighbours& neighbours, std::vector<IndexPair> pairs)
      : model_(model), rules_(neighbours.rules()), pairs_(std::move(pairs)) {
    for (const auto& [i, j] : pairs_) {                           // entities; the body of a mixed pair is the larger one
      const int a = (n == 4 ? i : j) - rules_.particles(), b = j - rules_.particles();
      table_.push_back(rules_.table(i, j));
      if constexpr (n == 4) {
        stencils_.push_back({kinematics.place_of(a), kinematics.rotation_of(a), kinematics.place_of(b), kinematics.rotation_of(b)});
        lengths_.push_back({1, kinematics.characteristic_length(a), 1, kinematics.characteristic_length(b)});
      } else {
        stencils_.push_back({kinematics.place_of(a), kinematics.rotation_of(a), i});
        lengths_.push_back({1, kinematics.characteristic_length(a), 1});
      }
    }
  }

  void values(const State& state, double* value) const override {
    parallel_for(this->elements(), bodies_per_thread, [&](std::int64_t e) {
      value[e] = rounded_value(model_.rounded[table_[e]], first(e, state), second(e, state));
    });
  }

  void derivatives(const State& state, const Tangent&, double* value, double* gradient, double* hessian) const override {
    parallel_for(this->elements(), bodies_per_thread, [&](std::int64_t e) {
      const PairLocal whole = rounded_derivatives(model_.rounded[table_[e]], first(e, state), second(e, state));
      Local<n> u;
      u.value = whole.value;
      u.gradient = whole.gradient.template head<3 * n>();
      u.hessian = whole.hessian.template topLeftCorner<3 * n, 3 * n>();
      to_lengths<n>(u, lengths_[e]);
      store(u, e, value, gradient, hessian);
    });
  }

 private:
  RoundedBody first(std::int64_t e, const State& state) const {
    return rules_.body(n == 4 ? pairs_[e].first : pairs_[e].second, state);
  }
  RoundedBody second(std::int64_t e, const State& state) const {
    return rules_.body(n == 4 ? pairs_[e].second : pairs_[e].first, state);
  }

  const Model& model_;
  const BodyRules& rules_;
  std::vector<IndexPair> pairs_;
  std::vector<int> table_;
  std::vector<std::array<double, n>> lengths_;
};

class BodyWallGroup final : public BodyGroup<2> {
 public:
  BodyWallGroup(const Model& model, const Kinematics& kinematics) : model_(model), kinematics_(kinematics) {
    for (std::size_t w = 0; w < model.walls.size(); ++w) {
      const Wall& wall = model.walls[w];
      if (wall.lammps) continue;
      for (const int b : wall.bodies)
        stencils_.push_back({kinematics.place_of(b), kinematics.rotation_of(b)}), wall_.push_back(static_cast<int>(w));
      load_dependent_ = load_dependent_ || (!wall.bodies.empty() && wall.scaling.rate != 0 && !wall.displacement.isZero(0));
    }
  }

  bool load_dependent() const override { return load_dependent_; }

  void values(const State& state, double* value) const override {
    parallel_for(elements(), bodies_per_thread, [&](std::int64_t e) { value[e] = law(e, state).value(body(e, state)); });
  }
  void derivatives(const State& state, const Tangent&, double* value, double* gradient, double* hessian) const override {
    parallel_for(elements(), bodies_per_thread, [&](std::int64_t e) { store(local(e, state), e, value, gradient, hessian); });
  }
  // ∂(∇U)/∂λ = −s′ ∂(∇U)/∂x d.
  void explicit_load_derivative(const State& state, double* rate) const override {
    parallel_for(elements(), bodies_per_thread, [&](std::int64_t e) {
      const Wall& wall = model_.walls[wall_[e]];
      Eigen::Map<Eigen::Matrix<double, 6, 1>>(rate + 6 * e) =
          -wall.scaling.rate * (local(e, state).hessian.leftCols<3>() * wall.displacement);
    });
  }

 private:
  RoundedWall law(std::int64_t e, const State& state) const { return rounded_wall_at(model_.walls[wall_[e]], state.load_factor); }
  RoundedBody body(std::int64_t e, const State& state) const { return model_.body(kinematics_.body_of(stencils_[e][0]), state); }
  Local<2> local(std::int64_t e, const State& state) const {
    Local<2> u = law(e, state).derivatives(body(e, state));
    to_lengths<2>(u, {1, kinematics_.characteristic_length(kinematics_.body_of(stencils_[e][0]))});
    return u;
  }

  const Model& model_;
  const Kinematics& kinematics_;
  std::vector<int> wall_;
  bool load_dependent_ = false;
};

// U = −s(λ) F·(x + R arm), or −s(λ) τ·φ.
class BodyLoadGroup final : public BodyGroup<2> {
 public:
  BodyLoadGroup(const Model& model, const Kinematics& kinematics) : kinematics_(kinematics) {
    std::vector<int> glue(model.particles(), -1);
    for (std::size_t k = 0; k < model.glued.size(); ++k) glue[model.glued[k].particle] = static_cast<int>(k);
    const auto at_particle = [&](int p, const Vec3& force, const Scaling& scaling) {
      if (glue[p] >= 0 && !force.isZero(0)) add(model.glued[glue[p]].body, {force, model.glued[glue[p]].arm, {}, scaling});
    };
    for (const Load& l : model.loads) {
      for (std::size_t k = 0; k < l.particles.size(); ++k) at_particle(l.particles[k], l.on(k), l.scaling);
      for (const int b : l.bodies) {
        if (!l.point.isZero(0)) add(b, {l.force, l.point, {}, l.scaling});
        if (!l.torque.isZero(0)) add(b, {Vec3::Zero(), Vec3::Zero(), {l.torque, model.start.bodies[b].rotation}, l.scaling});
      }
    }
    for (const Gravity& g : model.gravity)
      for (const int p : g.particles) at_particle(p, model.mass(p) * g.acceleration, g.scaling);
  }

  bool load_dependent() const override { return load_dependent_; }

  void values(const State& state, double* value) const override {
    for (int e = 0; e < elements(); ++e) value[e] = loads_[e].scaling.at(state.load_factor) * unit(e, state).value;
  }
  void derivatives(const State& state, const Tangent&, double* value, double* gradient, double* hessian) const override {
    for (int e = 0; e < elements(); ++e) {
      const double s = loads_[e].scaling.at(state.load_factor);
      Local<2> u = unit(e, state);
      u.value *= s, u.gradient *= s, u.hessian *= s;
      store(u, e, value, gradient, hessian);
    }
  }
  void explicit_load_derivative(const State& state, double* rate) const override {
    for (int e = 0; e < elements(); ++e)
      Eigen::Map<Eigen::Matrix<double, 6, 1>>(rate + 6 * e) = loads_[e].scaling.rate * unit(e, state).gradient;
  }

 private:
  struct One { Vec3 force, arm; RotationTorque torque; Scaling scaling; };

  void add(int body, One load) {
    stencils_.push_back({kinematics_.place_of(body), kinematics_.rotation_of(body)});
    load_dependent_ = load_dependent_ || load.scaling.rate != 0;
    loads_.push_back(std::move(load));
  }
  Local<2> unit(int e, const State& state) const {                // for s = 1
    const One& load = loads_[e];
    const int b = kinematics_.body_of(stencils_[e][0]);
    const Pose& pose = state.bodies[b];
    Local<2> u;
    if (!load.force.isZero(0)) {
      const Vec3 arm = pose.rotation * load.arm;
      u.value = -load.force.dot(pose.position.hi + pose.position.lo + arm);
      add_point(u, arm, -load.force, Mat3::Zero());
    } else {
      const Local<1> t = load.torque.derivatives(pose.rotation);
      u.value = t.value, u.force_part(1) = t.gradient, u.block(1, 1) = t.hessian;
    }
    to_lengths<2>(u, {1, kinematics_.characteristic_length(b)});
    return u;
  }

  const Kinematics& kinematics_;
  std::vector<One> loads_;
  bool load_dependent_ = false;
};

template <class Keep>
std::vector<IndexPair> kept(const Model& model, const BodyNeighbours& neighbours, const Keep& keep) {
  std::vector<IndexPair> pairs;
  for (const IndexPair& p : neighbours.pairs())
    if (model.rounded[neighbours.rules().table(p.first, p.second)].formulation != RoundedFormulation::lammps && keep(p)) pairs.push_back(p);
  return pairs;
}

}  // namespace

RoundedWall rounded_wall_at(const Wall& wall, double load_factor) {
  return {wall.region.moved_exactly(two_product(wall.scaling.at(load_factor), wall.displacement), 0), wall.inside, wall.kernel};
}

PairLocal rounded_derivatives(const RoundedPair& table, const RoundedBody& a, const RoundedBody& b) {
  return table.formulation == RoundedFormulation::closest ? RoundedClosest{table.kernel}.derivatives(a, b)
                                                          : RoundedMulti{table.kernel}.derivatives(a, b);
}

void rounded_contacts(const RoundedPair& table, const RoundedBody& a, const RoundedBody& b, std::vector<RoundedContact>& out) {
  if (table.formulation == RoundedFormulation::closest) RoundedClosest{table.kernel}.contacts(a, b, out);
  else RoundedMulti{table.kernel}.contacts(a, b, out);
}

std::unique_ptr<ElementGroup> body_pair_group(const Model& model, const Kinematics& kinematics, const BodyNeighbours& neighbours) {
  const BodyRules& rules = neighbours.rules();
  return std::make_unique<RoundedGroup<4>>(model, kinematics, neighbours,
                                           kept(model, neighbours, [&](const IndexPair& p) { return rules.is_body(p.first); }));
}

std::unique_ptr<ElementGroup> body_particle_group(const Model& model, const Kinematics& kinematics, const BodyNeighbours& neighbours,
                                                  bool carried) {
  std::vector<bool> glued(model.particles(), false);
  for (const Glued& g : model.glued) glued[g.particle] = true;
  const auto wanted = [&](const IndexPair& p) { return !neighbours.rules().is_body(p.first) && glued[p.first] == carried; };
  return std::make_unique<RoundedGroup<3>>(model, kinematics, neighbours, kept(model, neighbours, wanted));
}

std::unique_ptr<ElementGroup> body_wall_group(const Model& model, const Kinematics& kinematics) {
  return std::make_unique<BodyWallGroup>(model, kinematics);
}

std::unique_ptr<ElementGroup> body_load_group(const Model& model, const Kinematics& kinematics) {
  return std::make_unique<BodyLoadGroup>(model, kinematics);
}

}  // namespace elamin
