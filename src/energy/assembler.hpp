#pragma once
// From element buffers to a gradient on all sites, a sparse Hessian on the free dofs, and ∂g/∂λ.
#include "energy/element_group.hpp"
#include "energy/kinematics.hpp"

#include <memory>

namespace elamin {

/// Which places of the element buffers add up to one number, for many numbers: sources of item i are
/// index[start[i]] … index[start[i+1]−1], summed in this order by whichever thread holds i.
struct GatherList {
  std::vector<std::int64_t> start{0};
  std::vector<std::int64_t> index;
};

/// Which 3 × 3 blocks of the element Hessians add up to those of the lower triangle. Of the columns of site p there are blocks first[p] … first[p+1] − 1,
/// that of p itself, then those of higher sites it shares an element with; block k has the rows of site[k], and is the sum of
/// part[start[k]] … part[start[k+1] − 1] in this order: the place of an element's Hessian, and which two of its sites, see BlockPart.
struct BlockGather {
  std::vector<std::int64_t> first, start;
  std::vector<int> site;
  std::vector<std::int64_t> part;
};

/// Everything that depends on the topology alone is made once, here; evaluations overwrite values only.
class Assembler {
 public:
  using Groups = std::vector<std::unique_ptr<ElementGroup>>;
  static constexpr int most_sites = 12;              // of an element: four sites, each with a body's place and rotation
  Assembler(const Kinematics& kinematics, const Groups& groups);

  /// Energy of each group, summed in stored order with compensation; +inf where a law is outside its domain.
  const std::vector<double>& values(const State& state);
  /// The same; fills the element buffers, which the calls below read.
  const std::vector<double>& evaluate(const State& state, bool with_hessian, const Tangent& tangent);
  /// Sum over the laws that predict their force from `from` of the energy they did not predict.
  double residual_energy(const State& state, const State& from);
  /// ∂U/∂x of all sites, 3 × sites, from the last evaluation.
  void gradient(Field& g) const { gather(gradients_, g); }
  /// ∂²U/∂q∂q, lower triangle, pattern fixed; from the last evaluation with Hessian.
  void sum_hessian();
  const SparseMatrix& hessian() const { return hessian_; }
  /// The same, for whoever puts something on its diagonal until the next evaluation.
  SparseMatrix& hessian() { return hessian_; }
  /// ∂²U/∂q∂λ through the driven sites and the groups that move by themselves, added to `out` (dofs); from the last
  /// evaluation with Hessian, which was at `state`.
  void add_drive(const State& state, Vector& out) const;
  /// ∂²U/∂q∂λ of one group that moves by itself, added to `out` (dofs); nothing if it does not.
  void add_load_derivative(const ElementGroup& group, const State& state, Vector& out) const;
  /// H v for a field v that is zero at prescribed coordinates (3 × sites), element by element on differences of v, so
  /// that soft modes of slender structures keep their digits; from the last evaluation with Hessian.
  void multiply(const Field& v, Field& out);
  /// gᵀv in the same way, g without loads; from the last evaluation. The size is the root of the sum of its terms' squares.
  BilinearForm slope(const Field& v) const;
  /// uᵀHv in the same way, summed with compensation. `state`: of the last evaluation, where laws that form it better than their Hessian's
  /// entries do so anew; null: all of it from the entries.
  BilinearForm form(const Field& u, const Field& v, const State* state) const;
  /// Largest force of one element on one site, of the groups from the number `first` to before `last`, from the last evaluation.
  double largest_element_force(std::size_t first, std::size_t last) const;

 private:
  void sum_values();
  void gather(const std::vector<double>& buffer, Field& out) const;
  void build_site_gather();
  void build_blocks();
  void build_pattern();
  void find_driven();

  const Kinematics& kinematics_;
  const Groups& groups_;
  std::vector<std::int64_t> value_offset_, gradient_offset_, hessian_offset_;   // of each group in the buffers
  std::vector<double> values_, sums_, gradients_, hessians_, products_;
  GatherList site_gather_;              // per site: places of its 3 components in gradients_
  BlockGather blocks_;
  std::vector<std::vector<int>> driven_;        // of each group: elements between what is free and what is driven
  SparseMatrix hessian_;
};

}  // namespace elamin
