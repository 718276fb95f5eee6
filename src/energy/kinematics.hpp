#pragma once
// Of each site: its position, how it moves with the free dofs and with the load factor. Nothing else knows of dofs.
#include "model/model.hpp"

namespace elamin {

/// Splits the coordinates of all particles into free dofs q and prescribed ones, x = X + s(λ) d.
/// A coordinate of a particle is one or the other; ∂x/∂q is a unit vector and ∂²x/∂q² zero.
class Kinematics {
 public:
  explicit Kinematics(const Model& model);

  int dofs() const { return static_cast<int>(site_of_.size()); }
  int sites() const { return static_cast<int>(dof_.cols()); }
  /// Index of the free dof of a site's coordinate, or −1 where it is prescribed.
  int dof(int site, int coordinate) const { return dof_(coordinate, site); }
  int site_of(int dof) const { return site_of_[dof]; }
  int coordinate_of(int dof) const { return dof_(0, site_of_[dof]) == dof ? 0 : dof_(1, site_of_[dof]) == dof ? 1 : 2; }
  /// ∂x/∂λ of the prescribed coordinates; zero for free ones.  [length]
  Vec3 drive(int site) const { return drive_.col(site); }
  bool driven() const { return driven_; }

  /// The same configuration with the prescribed coordinates where λ puts them.
  void prescribe(State& state, double load_factor) const;
  /// x ← x + scale · step on the free dofs (dofs), kept exactly.
  void retract(State& state, const Vector& step, double scale = 1) const;
  /// The free dofs of a field (3 × sites) as a vector, and back with zeros at prescribed coordinates.
  Vector restrict(const Field& field) const;
  void restrict(const Field& field, Vector& out) const;
  Field extend(const Vector& v) const;

 private:
  Eigen::Matrix3Xi dof_;
  std::vector<int> site_of_;
  State reference_;                     // X, what does not vary with λ included
  Field drive_;
  bool driven_ = false;
};

}  // namespace elamin
