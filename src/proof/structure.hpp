#pragma once
// What a theorem is about: the elements of a model at one load factor, as a list of numbers.
#include "model/model.hpp"
#include "proof/laws.hpp"

#include <array>
#include <string>
#include <vector>

namespace elamin::proof {

template <class L, int n>
struct Element {
  L law;
  std::array<int, n> particles;
};

/// A force on a particle, of which fixed + rate λ acts.
struct DeadLoad { int particle; Vec3 force; Scaling scaling; };

/// E(q) = Σ bonds + Σ angles + Σ contacts + Σ walls − Σ F·x. Prescribed coordinates stand where the state has them.
struct Structure {
  std::vector<Element<Bond, 2>> bonds;
  std::vector<Element<Angle, 3>> angles;
  std::vector<Element<Contact, 2>> contacts;   // all whose surfaces are within `reach`
  std::vector<Element<Plane, 1>> planes;       // faces of walls, the same
  std::vector<Element<Round, 1>> rounds;
  std::vector<DeadLoad> loads;
  double load_factor = 0;
  std::vector<std::array<int, 3>> dof;         // of each particle's coordinates, −1: prescribed
  int dofs = 0;
  double reach = 0;                            // how far what may touch was looked for [length]

  /// ∂E/∂q (dofs) at the centre, which is taken to its last digit; every particle's forces are summed in 113 bits.
  std::vector<Interval<Quad>> gradient(const State& centre) const;
  /// x_j − x_i of all points within `radius` of the centre (in the space of all dofs: a point moves along a coordinate that it is free
  /// in, and the difference of two changes by √2 times the radius at most); i = −1: x_j itself.
  template <class I>
  Vector3<I> edge(const State& centre, int i, int j, double radius) const;
  /// Calls with the particles of each element, and ∂U/∂x of their places and, where it is asked for, ∂²U/∂x∂x, over the same balls.
  template <class I>
  void for_elements(const State& centre, double radius, bool with_hessian, const auto& take) const;
};

/// The structure at the state's load factor, or in `not_covered` what of the model no theorem here is about. Contacts and walls within a
/// tenth of the smallest diameter are taken in.
Structure structure_of(const Model& model, const State& state, std::string& not_covered);

/// H over balls around a centre, in intervals.
class IntervalHessian {
 public:
  IntervalHessian(const Structure& structure, const State& centre);
  /// A matrix of doubles in it, at the centre itself: lower triangle with full diagonal.
  SparseMatrix middle(const State& centre);
  /// A bound of ‖H(x) − M‖ for all x within `radius` of the centre: the largest sum of a row (of a symmetric matrix ‖·‖₂ ≤ ‖·‖_∞).
  double distance(const SparseMatrix& M, const State& centre, double radius);

 private:
  using I = Interval<double>;
  void evaluate(const State& centre, double radius);
  const Structure& structure_;
  SparseMatrix pattern_;
  std::vector<I> value_;                       // in the order of its entries
};

}  // namespace elamin::proof
