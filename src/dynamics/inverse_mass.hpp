#pragma once
// The mass of the free dofs at a state.
#include "dynamics/body_mass.hpp"
#include "energy/kinematics.hpp"

namespace elamin {

/// M of ½ q̇ᵀ M q̇: of particles diagonal; of a body, in the coordinates (x, ℓθ) of its place and turn, with a = R c the arm of its
/// centre of mass and I its inertia about x, both with what it carries,
///   M = [[m I, −m [a]×/ℓ], [·, R I Rᵀ/ℓ²]].
/// Turns about an axis with no inertia have M⁻¹ = 0, as in RigidMass.
class InverseMass {
 public:
  InverseMass(const Model& model, const Kinematics& kinematics, const State& state);

  /// M^{-1/2} v (dofs).
  Vector root(const Vector& v) const;
  /// The largest velocity that a unit impulse at `arm` from a body's position gives that point, of a particle its place [1/mass].
  double at(int body, const Vec3& arm) const;
  double at(int particle) const;

 private:
  using Mat6 = Eigen::Matrix<double, 6, 6>;
  const Kinematics& kinematics_;
  Vector particle_;                            // 1/√m of the dofs of particles
  std::vector<Mat6> root_;                     // of bodies; zero where held
};

}  // namespace elamin
