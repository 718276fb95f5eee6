#include "energy/energy.hpp"

#include "laws/cosine_angle.hpp"
#include "laws/harmonic_bond.hpp"

#include <algorithm>

namespace elamin {

namespace {

std::unique_ptr<ElementGroup> bond_group(const Model& model) {
  std::vector<HarmonicBond> laws;
  for (const BondType& t : model.bond_types) laws.push_back({t.stiffness, t.rest_length});
  std::vector<int> kind;
  std::vector<std::array<int, 2>> stencils;
  for (const Bond& b : model.bonds) kind.push_back(b.type), stencils.push_back(b.particles);
  return std::make_unique<LawGroup<HarmonicBond>>(std::move(laws), std::move(kind), std::move(stencils));
}

std::unique_ptr<ElementGroup> angle_group(const Model& model) {
  std::vector<CosineAngle> laws;
  for (const AngleType& t : model.angle_types) laws.push_back({t.stiffness});
  std::vector<int> kind;
  std::vector<std::array<int, 3>> stencils;
  for (const Angle& a : model.angles) kind.push_back(a.type), stencils.push_back(a.particles);
  return std::make_unique<LawGroup<CosineAngle>>(std::move(laws), std::move(kind), std::move(stencils));
}

}  // namespace

Energy::Energy(const Model& model)
    : model_(model), kinematics_(model), constant_load_(Field::Zero(3, model.particles())),
      scaled_load_(Field::Zero(3, model.particles())) {
  groups_.push_back(bond_group(model));
  groups_.push_back(angle_group(model));
  assembler_ = std::make_unique<Assembler>(kinematics_, groups_);
  for (const Load& l : model.loads)
    for (const int p : l.particles) (l.constant ? constant_load_ : scaled_load_).col(p) += l.force;
  for (const Gravity& g : model.gravity)
    for (const int p : g.particles) (g.constant ? constant_load_ : scaled_load_).col(p) += model.mass(p) * g.acceleration;
  double stiffest = 0;                                        // of 2K r₀
  for (const Bond& b : model.bonds) {
    const double length = (model.start.at(b.particles[1]) - model.start.at(b.particles[0])).hi.norm();
    stiffest = std::max(stiffest, 2 * model.bond_types[b.type].stiffness * length);
  }
  for (const Angle& a : model.angles) {
    const double length = (model.start.at(a.particles[1]) - model.start.at(a.particles[0])).hi.norm();
    if (length > 0) stiffest = std::max(stiffest, model.angle_types[a.type].stiffness / length);
  }
  force_floor_ = epsilon * stiffest;
}

double Energy::external(const State& state) const {
  ExactSum sum;
  for (Eigen::Index p = 0; p < state.particles(); ++p)
    for (int c = 0; c < 3; ++c)
      sum.add(-(constant_load_(c, p) + state.load_factor * scaled_load_(c, p)) * (state.position(c, p) + state.tail(c, p)));
  return sum.value();
}

EnergyTerms Energy::terms(const State& state) {
  const std::vector<double> sums = assembler_->values(state);
  return {sums[0], sums[1], external(state)};
}

void Energy::evaluate(const State& state, bool with_hessian, const State* from) {
  const std::vector<double> sums = assembler_->evaluate(state, with_hessian, from);
  terms_ = {sums[0], sums[1], external(state)};
  finish_gradient(state);
  if (with_hessian) hessian_ = &assembler_->hessian();
}

void Energy::finish_gradient(const State& state) {
  assembler_->gradient(site_gradient_);
  force_scale_ = assembler_->largest_element_force();
  for (Eigen::Index p = 0; p < state.particles(); ++p) {
    const Vec3 load = constant_load_.col(p) + state.load_factor * scaled_load_.col(p);
    site_gradient_.col(p) -= load;
    force_scale_ = std::max(force_scale_, load.norm());
  }
  gradient_ = kinematics_.restrict(site_gradient_);
}

Vector Energy::load_derivative() const {
  Vector d = -kinematics_.restrict(scaled_load_);
  assembler_->add_drive(d);
  return d;
}

Vector Energy::multiply(const Vector& v) const {
  Field product;
  assembler_->multiply(kinematics_.extend(v), product);
  return kinematics_.restrict(product);
}

double Energy::distortion(const State& state, const Vector& step) const {
  const Field s = kinematics_.extend(step);
  double largest = 0;
  for (const Bond& b : model_.bonds) {
    const auto [i, j] = b.particles;
    const double length = (state.at(j) - state.at(i)).hi.norm();
    if (length > 0) largest = std::max(largest, (s.col(j) - s.col(i)).norm() / length);
  }
  return largest;
}

double Energy::relative(const Vector& force) const {
  const double largest = force.size() ? force.cwiseAbs().maxCoeff() : 0.0;
  return largest == 0 ? 0.0 : largest / std::max(force_scale_, force_floor_);
}

Field Energy::forces(const State& state) {
  evaluate(state, false);
  return -site_gradient_;
}

}  // namespace elamin
