#pragma once
// Elements of one law: which law acts on which sites, and one loop over them.
#include "core/parallel.hpp"
#include "energy/element_group.hpp"

#include <array>
#include <functional>
#include <vector>

namespace elamin {

/// The positions and their low words at n sites.
template <int n>
Points<n> points(const State& state, const std::array<int, n>& sites) {
  Points<n> x;
  for (int i = 0; i < n; ++i) x.position.col(i) = state.position.col(sites[i]), x.low.col(i) = state.low.col(sites[i]);
  return x;
}

/// Writes what a law gave for element e into the buffers of its group, whose Hessian is that of all sites or without the first; hessian may be null.
template <bool anchored = true, int n>
void store(const Local<n>& u, std::int64_t e, double* value, double* gradient, double* hessian) {
  value[e] = u.value;
  Eigen::Map<Eigen::Matrix<double, 3 * n, 1>>(gradient + e * 3 * n) = u.gradient;
  if (!hessian) return;
  constexpr int first = anchored ? 0 : 3;
  double* h = hessian + e * ElementGroup::packed(3 * n - first, 0);
  for (int r = first; r < 3 * n; ++r)
    for (int c = first; c <= r; ++c) *h++ = u.hessian(r, c);
}

/// A law whose stiffness across depends on a force that a straight step of finite length falsifies (see HarmonicBond).
template <class L>
concept PredictingLaw = Law<L> && requires(const L& law, const Points<L::sites>& x) {
  { law.derivatives(x, x) } -> std::same_as<Local<L::sites>>;
  { law.residual_energy(x, x) } -> std::same_as<double>;
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
struct Schedule {
  std::vector<L> laws, rates;
};

template <Law L>
class LawGroup final : public ElementGroup {
 public:
  static constexpr int n = L::sites;
  /// laws: one a kind; kind: which law each element has; stencils: its sites.
  LawGroup(std::vector<L> laws, std::vector<int> kind, std::vector<std::array<int, n>> stencils)
      : laws_(std::move(laws)), kind_(std::move(kind)), stencils_(std::move(stencils)) {}
  /// The same with laws that change: `schedule` is asked once an evaluation.
  using ScheduleAt = std::function<Schedule<L>(const State&)>;
  LawGroup(ScheduleAt schedule, std::vector<int> kind, std::vector<std::array<int, n>> stencils) requires ChangingLaw<L>
      : schedule_(std::move(schedule)), kind_(std::move(kind)), stencils_(std::move(stencils)) {}

  int elements() const override { return static_cast<int>(stencils_.size()); }
  int sites() const override { return n; }
  std::span<const int> stencils() const override { return in_a_row(stencils_); }

  void values(const State& state, double* value) const override {
    at(state);
    parallel_for(elements(), grain, [&](std::int64_t e) { value[e] = laws_[kind_[e]].value(gather(state, e)); });
  }

  void derivatives(const State& state, const Tangent& tangent, double* value, double* gradient, double* hessian) const override {
    at(state);
    parallel_for(elements(), grain, [&](std::int64_t e) {
      store<AnchoredLaw<L>>(local(state, tangent, e), e, value, gradient, hessian);
    });
  }

  bool residual_energy(const State& state, const State& from, double* value) const override {
    if constexpr (PredictingLaw<L>) {
      at(state);
      parallel_for(elements(), grain, [&](std::int64_t e) { value[e] = laws_[kind_[e]].residual_energy(gather(state, e), gather(from, e)); });
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
  bool load_dependent() const override { return bool(schedule_); }
  void explicit_load_derivative(const State& state, double* rate) const override {
    if constexpr (ChangingLaw<L>) {
      const Schedule<L> schedule = schedule_(state);
      parallel_for(elements(), grain, [&](std::int64_t e) {
        Eigen::Map<Eigen::Matrix<double, 3 * n, 1>>(rate + e * 3 * n) =
            schedule.laws[kind_[e]].gradient_rate(gather(state, e), schedule.rates[kind_[e]]);
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
    if (schedule_) laws_ = schedule_(state).laws;
  }

  ScheduleAt schedule_;                              // none: the laws stay
  mutable std::vector<L> laws_;                  // as they are at the state asked for last
  std::vector<int> kind_;
  std::vector<std::array<int, n>> stencils_;
};

}  // namespace elamin
