#pragma once
// Elements of one law: which law acts on which sites, and one loop over them. One virtual call a group, none an element.
#include "core/parallel.hpp"
#include "laws/law.hpp"
#include "model/state.hpp"

#include <array>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace elamin {

/// The positions and their low words at n sites.
template <int n>
Points<n> points(const State& state, const std::array<int, n>& sites) {
  Points<n> x;
  for (int i = 0; i < n; ++i) x.position.col(i) = state.position.col(sites[i]), x.tail.col(i) = state.tail.col(sites[i]);
  return x;
}

/// Which Hessian is asked for. With `from`, the state that a step came from: the one whose forces are predicted there, where the law does that
/// (PredictingLaw). `convex`, in [0, 1]: the part of what compression, or a cohesion that gives way, takes away that is left out, where the law knows that (ConvexLaw); with
/// all of it left out an element's Hessian is positive semidefinite.
struct Tangent {
  const State* from = nullptr;
  double convex = 0;
};

/// What the assembler sees of a group: stencils, and buffers that each element fills at its own place.
class ElementGroup {
 public:
  virtual ~ElementGroup() = default;
  virtual int elements() const = 0;
  virtual int sites() const = 0;
  /// The element's sites; −1: none, whose derivatives are left out.
  virtual std::span<const int> stencil(int element) const = 0;
  /// The sites between which the element's energy is, where they are not those of its derivatives.
  virtual std::span<const int> between(int element) const { return stencil(element); }
  /// Energy of every element.
  virtual void values(const State& state, double* value) const = 0;
  /// Energy, gradient (3·sites) and, unless null, Hessian (lower triangle by rows, see packed) of every element.
  virtual void derivatives(const State& state, const Tangent& tangent, double* value, double* gradient, double* hessian) const = 0;
  /// Energy of every element that its linearisation at `from` did not predict; false if the law has no such thing.
  virtual bool unpredicted(const State& state, const State& from, double* value) const = 0;

  /// Adds uᵀHv at the state, and its size, for fields of all sites (see BilinearForm); false if the entries of the Hessian are as good.
  virtual bool forms(const State&, const Field&, const Field&, ExactSum&, double&) const { return false; }

  /// Whether the energy of an element is another one where the element is moved as a whole.
  virtual bool anchored() const { return sites() == 1; }
  /// Whether the energy depends on the load factor by itself, not through the sites: a moving wall, growth. Then
  /// load_rates gives ∂(∇U)/∂λ of every element (3·sites each).
  virtual bool moves() const { return false; }
  virtual void load_rates(const State&, double*) const {}

  int gradient_size() const { return 3 * sites(); }
  int hessian_size() const { return 3 * sites() * (3 * sites() + 1) / 2; }
  /// Place of the entry (row ≥ column) in an element's packed Hessian.
  static int packed(int row, int column) { return row * (row + 1) / 2 + column; }
};

/// Writes what a law gave for element e into the buffers of its group; hessian may be null.
template <int n>
void store(const Local<n>& u, std::int64_t e, double* value, double* gradient, double* hessian) {
  value[e] = u.value;
  Eigen::Map<Eigen::Matrix<double, 3 * n, 1>>(gradient + e * 3 * n) = u.gradient;
  if (!hessian) return;
  double* h = hessian + e * (3 * n * (3 * n + 1) / 2);
  for (int r = 0; r < 3 * n; ++r)
    for (int c = 0; c <= r; ++c) *h++ = u.hessian(r, c);
}

/// A law whose stiffness across depends on a force that a straight step of finite length falsifies (see HarmonicBond).
template <class L>
concept PredictingLaw = Law<L> && requires(const L& law, const Points<L::sites>& x) {
  { law.derivatives(x, x) } -> std::same_as<Local<L::sites>>;
  { law.unpredicted(x, x) } -> std::same_as<double>;
};

/// A law that can leave out a part in [0, 1] of what compression takes from its Hessian: all of it, and that is positive semidefinite.
template <class L>
concept ConvexLaw = Law<L> && (requires(const L& law, const Points<L::sites>& x) {
  { law.convex(x, 1.0) } -> std::same_as<Local<L::sites>>;
} || requires(const L& law, const Points<L::sites>& x) {
  { law.convex(x, x, 1.0) } -> std::same_as<Local<L::sites>>;
});

/// Laws that change with the load factor, or with the state as a whole: of every kind the law, and as another law the
/// rates ∂/∂λ of its parameters.
template <class L>
struct Course {
  std::vector<L> laws, rates;
};

template <Law L>
class LawGroup final : public ElementGroup {
 public:
  static constexpr int n = L::sites;
  /// laws: one a kind; kind: which law each element has; stencils: its sites.
  LawGroup(std::vector<L> laws, std::vector<int> kind, std::vector<std::array<int, n>> stencils)
      : laws_(std::move(laws)), kind_(std::move(kind)), stencils_(std::move(stencils)) {}
  /// The same with laws that change: `course` is asked once an evaluation.
  using CourseAt = std::function<Course<L>(const State&)>;
  LawGroup(CourseAt course, std::vector<int> kind, std::vector<std::array<int, n>> stencils) requires ChangingLaw<L>
      : course_(std::move(course)), kind_(std::move(kind)), stencils_(std::move(stencils)) {}

  int elements() const override { return static_cast<int>(stencils_.size()); }
  int sites() const override { return n; }
  std::span<const int> stencil(int element) const override { return stencils_[element]; }

  void values(const State& state, double* value) const override {
    at(state);
    parallel_for(elements(), grain, [&](std::int64_t e) { value[e] = laws_[kind_[e]].value(gather(state, e)); });
  }

  void derivatives(const State& state, const Tangent& tangent, double* value, double* gradient, double* hessian) const override {
    at(state);
    parallel_for(elements(), grain, [&](std::int64_t e) {
      store(local(state, tangent, e), e, value, gradient, hessian);
    });
  }

  bool unpredicted(const State& state, const State& from, double* value) const override {
    if constexpr (PredictingLaw<L>) {
      at(state);
      parallel_for(elements(), grain, [&](std::int64_t e) { value[e] = laws_[kind_[e]].unpredicted(gather(state, e), gather(from, e)); });
    } else
      (void)state, (void)from, (void)value;
    return PredictingLaw<L>;
  }

  bool forms(const State& state, const Field& u, const Field& v, ExactSum& sum, double& size) const override {
    if constexpr (FormLaw<L>) {
      at(state);
      for (int e = 0; e < elements(); ++e) {
        Eigen::Matrix<double, 3, n> left, right;
        for (int i = 0; i < n; ++i) left.col(i) = u.col(stencils_[e][i]), right.col(i) = v.col(stencils_[e][i]);
        const BilinearForm form = laws_[kind_[e]].form(gather(state, e), left, right);
        sum.add(form.value), size += form.size;
      }
    } else
      (void)state, (void)u, (void)v, (void)sum, (void)size;
    return FormLaw<L>;
  }

  bool anchored() const override { return AnchoredLaw<L>; }
  bool moves() const override { return bool(course_); }
  void load_rates(const State& state, double* rate) const override {
    if constexpr (ChangingLaw<L>) {
      const Course<L> course = course_(state);
      parallel_for(elements(), grain, [&](std::int64_t e) {
        Eigen::Map<Eigen::Matrix<double, 3 * n, 1>>(rate + e * 3 * n) =
            course.laws[kind_[e]].gradient_rate(gather(state, e), course.rates[kind_[e]]);
      });
    } else
      (void)state, (void)rate;
  }

 private:
  static constexpr std::int64_t grain = 2000;
  Local<n> local(const State& state, const Tangent& tangent, std::int64_t e) const {
    if constexpr (ConvexLaw<L>)
      if (tangent.convex > 0) {
        if constexpr (PredictingLaw<L>)
          return laws_[kind_[e]].convex(gather(state, e), gather(tangent.from ? *tangent.from : state, e), tangent.convex);
        else
          return laws_[kind_[e]].convex(gather(state, e), tangent.convex);
      }
    if constexpr (PredictingLaw<L>)
      if (tangent.from) return laws_[kind_[e]].derivatives(gather(state, e), gather(*tangent.from, e));
    return laws_[kind_[e]].derivatives(gather(state, e));
  }
  Points<n> gather(const State& state, std::int64_t e) const {
    return points<n>(state, stencils_[e]);
  }

  void at(const State& state) const {
    if (course_) laws_ = course_(state).laws;
  }

  CourseAt course_;                              // none: the laws stay
  mutable std::vector<L> laws_;                  // as they are at the state asked for last
  std::vector<int> kind_;
  std::vector<std::array<int, n>> stencils_;
};

}  // namespace elamin
