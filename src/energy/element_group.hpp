#pragma once
// What the assembler sees of the elements of one law: stencils, and buffers that each element fills at its own place.
#include "laws/law.hpp"
#include "model/state.hpp"

#include <array>
#include <span>
#include <vector>

namespace elamin {

/// Which Hessian is asked for. With `from`, the state that a step came from: the one whose forces are predicted there, where the law does that
/// (PredictingLaw). `convex`, in [0, 1]: the part of what compression, or a cohesion that gives way, takes away that is left out, where the law knows that (ConvexLaw); with
/// all of it left out an element's Hessian is positive semidefinite.
struct Tangent {
  const State* from = nullptr;
  double convex = 0;
};

/// All numbers of rows of n, row after row.
template <std::size_t n>
std::span<const int> in_a_row(const std::vector<std::array<int, n>>& rows) {
  return {rows.empty() ? nullptr : rows.front().data(), n * rows.size()};
}

/// One virtual call a group, none an element.
class ElementGroup {
 public:
  virtual ~ElementGroup() = default;
  virtual int elements() const = 0;
  virtual int sites() const = 0;
  /// The sites of all elements, one element after another; −1: none, whose derivatives are left out.
  virtual std::span<const int> stencils() const = 0;
  /// Those of one element.
  std::span<const int> stencil(int element) const { return stencils().subspan(std::size_t(element) * sites(), sites()); }
  /// The sites between which the element's energy is, where they are not those of its derivatives.
  virtual std::span<const int> between(int element) const { return stencil(element); }
  /// Energy of every element.
  virtual void values(const State& state, double* value) const = 0;
  /// Energy, gradient (3·sites) and, unless null, Hessian (lower triangle by rows, see packed) of every element. Where an element may be moved as a whole
  /// (not `anchored`) that of the motion relative to its first site, which has all of it: ∂²U/∂x₀∂x_j = −Σᵢ ∂²U/∂xᵢ∂x_j, i > 0.
  virtual void derivatives(const State& state, const Tangent& tangent, double* value, double* gradient, double* hessian) const = 0;
  /// Energy of every element that its linearisation at `from` did not predict; false if the law has no such thing.
  virtual bool residual_energy(const State& state, const State& from, double* value) const = 0;

  /// Adds uᵀHv at the state, and its size, for fields of all sites (see BilinearForm); false if the entries of the Hessian are as good.
  virtual bool forms(const State&, const Field&, const Field&, ExactSum&, double&) const { return false; }

  /// Whether the energy of an element is another one where the element is moved as a whole.
  virtual bool anchored() const { return sites() == 1; }
  /// Whether the energy depends on the load factor by itself, not through the sites: a moving wall, growth. Then
  /// explicit_load_derivative gives ∂(∇U)/∂λ of every element (3·sites each).
  virtual bool load_dependent() const { return false; }
  virtual void explicit_load_derivative(const State&, double*) const {}

  int gradient_size() const { return 3 * sites(); }
  /// The first of an element's coordinates that its Hessian has.
  int hessian_first() const { return anchored() ? 0 : 3; }
  int hessian_size() const { return packed(gradient_size() - hessian_first(), 0); }
  /// Place of the entry (row ≥ column) in an element's packed Hessian.
  static int packed(int row, int column) { return row * (row + 1) / 2 + column; }
};

}  // namespace elamin
