#pragma once
// Of each site: its position, how it moves with the free dofs and with the load factor. Nothing else knows of dofs.
#include "model/model.hpp"

namespace elamin {

/// Splits the coordinates of everything into free dofs q and prescribed ones. Sites: particle after particle, then of each body
/// its place and its rotation. A particle's or body's place is x = X + s(λ) d where it is prescribed; a rotation is ℓ θ, R → exp([θ]×) R from
/// wherever the body is, ℓ the body's bounding radius, so that all dofs are lengths and all gradients forces; where it is prescribed
/// R = exp([s(λ) φ]×) R₀. A glued particle has no dofs and follows its body: x = x_b + R arm.
/// A coordinate of a site is one or the other; its derivative is a unit vector.
class Kinematics {
 public:
  explicit Kinematics(const Model& model);

  int dofs() const { return static_cast<int>(site_of_.size()); }
  int sites() const { return static_cast<int>(dof_.cols()); }
  int particles() const { return static_cast<int>(reference_.particles()); }
  /// The sites of a body.
  int place_of(int body) const { return particles() + 2 * body; }
  int rotation_of(int body) const { return particles() + 2 * body + 1; }
  /// The body of a site, −1: a particle; whether the site is its rotation.
  int body_of(int site) const { return site < particles() ? -1 : (site - particles()) / 2; }
  bool is_rotation(int site) const { return site >= particles() && (site - particles()) % 2 == 1; }
  /// ℓ of a body: its bounding radius [length].
  double characteristic_length(int body) const { return characteristic_length_[body]; }
  /// A particle's diameter, twice a body's bounding radius [length].
  double size(int site) const { return size_[site]; }
  double mean_size() const;
  double smallest_size() const;

  /// Index of the free dof of a site's coordinate, or −1 where it is prescribed.
  int dof(int site, int coordinate) const { return dof_(coordinate, site); }
  int site_of(int dof) const { return site_of_[dof]; }
  int coordinate_of(int dof) const { return dof_(0, site_of_[dof]) == dof ? 0 : dof_(1, site_of_[dof]) == dof ? 1 : 2; }
  /// ∂x/∂λ of the prescribed coordinates; zero for free ones.  [length]
  Vec3 drive(int site) const { return drive_.col(site); }
  const Field& drive() const { return drive_; }
  bool driven() const { return driven_; }

  /// The same configuration with the prescribed coordinates where λ puts them.
  void prescribe(State& state, double load_factor) const;
  /// x ← x + scale · step on the free dofs (dofs), kept exactly; rotations by θ = scale · step/ℓ.
  void retract(State& state, const Vector& step, double scale = 1) const;
  /// b − a, of rotations ℓ times the rotation vector from a to b: 3 × sites, and on the free dofs: retract's inverse.  [length]
  Field displacement(const State& a, const State& b) const;
  Vector difference(const State& a, const State& b) const { return restrict(displacement(a, b)); }
  /// √(Σ |x|² + Σ ℓ²) over the places of particles and bodies, and bodies' characteristic lengths: the scale of a displacement's rounding.  [length]
  double norm(const State& state) const;
  /// From derivatives by a further step at retract(origin, y) to those by y itself: of bodies that have rotated they differ.
  void pull_back(Vector& gradient, const Vector& y) const;
  /// The same of a Hessian in its lower triangle, given the gradient there before it was pulled back.
  void pull_back(SparseMatrix& hessian, const Vector& gradient, const Vector& y) const;
  /// The free dofs of a field (3 × sites) as a vector, and back with zeros at prescribed coordinates.
  Vector restrict(const Field& field) const;
  void restrict(const Field& field, Vector& out) const;
  Field extend(const Vector& v) const;
  /// The same, and what glued particles move with their bodies at the state.
  Field extend(const Vector& v, const State& state) const;

 private:
  struct DrivenRotation { int body; double fixed, rate; Vec3 rotation; };   // R = exp([(fixed + λ rate) φ]×) R₀
  void hold(const Model& model);
  void carry(State& state) const;
  Vec3 rotation_by(const Vector& y, int body) const;

  Eigen::Matrix3Xi dof_;
  std::vector<int> site_of_;
  State reference_;                     // X, what does not vary with λ included
  std::vector<Glued> glued_;
  std::vector<DrivenRotation> driven_rotations_;
  std::vector<double> characteristic_length_, size_;
  Field drive_;
  bool driven_ = false;
};

}  // namespace elamin
