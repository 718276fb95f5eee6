#include "dynamics/inverse_mass.hpp"

#include "core/dense.hpp"


namespace elamin {

InverseMass::InverseMass(const Model& model, const Kinematics& kinematics, const State& state)
    : kinematics_(kinematics), particle_(Vector::Zero(kinematics.dofs())) {
  for (int d = 0; d < kinematics.dofs(); ++d)
    if (const int s = kinematics.site_of(d); s < kinematics.particles()) particle_[d] = 1 / std::sqrt(model.mass(s));
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) {
    const BodyMass m(model, b);
    const double length = kinematics.characteristic_length(b);
    const Mat3 R = state.bodies[b].rotation.toRotationMatrix();
    Mat6 M;
    M.topLeftCorner<3, 3>() = m.mass * Mat3::Identity();
    M.topRightCorner<3, 3>() = -m.mass / length * cross_matrix(R * m.center);
    M.bottomLeftCorner<3, 3>() = M.topRightCorner<3, 3>().transpose();
    M.bottomRightCorner<3, 3>() = R * m.inertia * R.transpose() / (length * length);
    const double least = 1e-7 * M.bottomRightCorner<3, 3>().trace();
    for (int k = 0; k < 6; ++k)
      if (kinematics.dof(k < 3 ? kinematics.place_of(b) : kinematics.rotation_of(b), k % 3) < 0) M.row(k).setZero(), M.col(k).setZero();
    const EigenPairs own = symmetric_eigen(M);
    root_.push_back(Mat6::Zero());
    for (int k = 0; k < 6; ++k)
      if (const double value = own.values[k]; value > least && value > 0) root_.back() += own.vectors.col(k) * own.vectors.col(k).transpose() / std::sqrt(value);
  }
}

Vector InverseMass::root(const Vector& v) const {
  Vector out = particle_.cwiseProduct(v);
  for (int b = 0; b < static_cast<int>(root_.size()); ++b) {
    Eigen::Matrix<double, 6, 1> own = Eigen::Matrix<double, 6, 1>::Zero();
    const auto dof = [&](int k) { return kinematics_.dof(k < 3 ? kinematics_.place_of(b) : kinematics_.rotation_of(b), k % 3); };
    for (int k = 0; k < 6; ++k)
      if (dof(k) >= 0) own[k] = v[dof(k)];
    own = root_[b] * own;
    for (int k = 0; k < 6; ++k)
      if (dof(k) >= 0) out[dof(k)] = own[k];
  }
  return out;
}

double InverseMass::at(int body, const Vec3& arm) const {
  Eigen::Matrix<double, 3, 6> J;
  J << Mat3::Identity(), -cross_matrix(arm) / kinematics_.characteristic_length(body);
  const Eigen::Matrix<double, 3, 6> B = J * root_[body];
  return symmetric_eigen(B * B.transpose()).values[2];
}

double InverseMass::at(int particle) const {
  double most = 0;
  for (int c = 0; c < 3; ++c)
    if (const int d = kinematics_.dof(particle, c); d >= 0) most = std::max(most, particle_[d] * particle_[d]);
  return most;
}

}  // namespace elamin
