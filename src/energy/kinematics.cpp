#include "energy/kinematics.hpp"

namespace elamin {

Kinematics::Kinematics(const Model& model)
    : dof_(Eigen::Matrix3Xi::Zero(3, model.particles())), reference_(model.start), drive_(Field::Zero(3, model.particles())) {
  if (model.plane_normal) dof_.row(*model.plane_normal).setConstant(-1);
  for (const Support& s : model.supports)
    for (std::size_t k = 0; k < s.particles.size(); ++k)
      for (int c = 0; c < 3; ++c) {
        const int p = s.particles[k];
        if (!s.held[c]) continue;
        dof_(c, p) = -1;
        const ExactVector at = s.reference.empty() ? model.start.at(p) : s.reference[k];
        const Exact x = Exact{at.hi[c], at.lo[c]} + two_product(s.scaling.fixed, s.displacement[c]);
        reference_.position(c, p) = x.hi, reference_.tail(c, p) = x.lo;
        drive_(c, p) = s.scaling.rate * s.displacement[c];
      }
  for (int p = 0; p < model.particles(); ++p)
    for (int c = 0; c < 3; ++c) {
      driven_ = driven_ || drive_(c, p) != 0;
      if (dof_(c, p) >= 0) {
        dof_(c, p) = static_cast<int>(site_of_.size());
        site_of_.push_back(p);
      }
    }
}

void Kinematics::prescribe(State& state, double load_factor) const {
  state.load_factor = load_factor;
  for (int p = 0; p < sites(); ++p)
    for (int c = 0; c < 3; ++c) {
      if (dof_(c, p) >= 0) continue;
      const Exact x = Exact{reference_.position(c, p), reference_.tail(c, p)} + two_product(load_factor, drive_(c, p));
      state.position(c, p) = x.hi, state.tail(c, p) = x.lo;
    }
}

void Kinematics::retract(State& state, const Vector& step, double scale) const {
  for (int p = 0; p < sites(); ++p)
    for (int c = 0; c < 3; ++c) {
      if (dof_(c, p) < 0) continue;
      const Exact x = Exact{state.position(c, p), state.tail(c, p)} + scale * step[dof_(c, p)];
      state.position(c, p) = x.hi, state.tail(c, p) = x.lo;
    }
}

void Kinematics::restrict(const Field& field, Vector& out) const {
  out.resize(dofs());
  for (int p = 0; p < sites(); ++p)
    for (int c = 0; c < 3; ++c)
      if (dof_(c, p) >= 0) out[dof_(c, p)] = field(c, p);
}

Vector Kinematics::restrict(const Field& field) const {
  Vector v;
  restrict(field, v);
  return v;
}

Field Kinematics::extend(const Vector& v) const {
  Field field = Field::Zero(3, sites());
  for (int p = 0; p < sites(); ++p)
    for (int c = 0; c < 3; ++c)
      if (dof_(c, p) >= 0) field(c, p) = v[dof_(c, p)];
  return field;
}

}  // namespace elamin
