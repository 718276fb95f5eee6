#include "energy/assembler.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

constexpr std::int64_t grain = 5000;               // elements and sites a thread
constexpr std::int64_t grain_of_entries = 50'000;  // entries of the Hessian, each a few additions

// Both dofs of an entry of an element's Hessian, the larger first.
struct Entry { int row, column; };

// The free dof of a row of an element, −1: prescribed, or no site.
int dof_of(const Kinematics& kinematics, const ElementGroup& group, int e, int row) {
  const int site = group.stencil(e)[row / 3];
  return site < 0 ? -1 : kinematics.dof(site, row % 3);
}

// Calls body(element, local row, local column ≤ row) for the packed lower triangle of every element of the group.
template <class Body>
void for_each_entry(const ElementGroup& group, const Body& body) {
  for (int e = 0; e < group.elements(); ++e)
    for (int r = 0; r < group.gradient_size(); ++r)
      for (int c = 0; c <= r; ++c) body(e, r, c);
}

}  // namespace

Assembler::Assembler(const Kinematics& kinematics, const Groups& groups) : kinematics_(kinematics), groups_(groups) {
  std::int64_t v = 0, g = 0, h = 0;
  for (const auto& group : groups_) {
    value_offset_.push_back(v), gradient_offset_.push_back(g), hessian_offset_.push_back(h);
    v += group->elements();
    g += std::int64_t(group->elements()) * group->gradient_size();
    h += std::int64_t(group->elements()) * group->hessian_size();
  }
  values_.resize(v), sums_.resize(groups_.size()), gradients_.resize(g), hessians_.resize(h);
  build_pattern();
  build_gathers();
}

// Columns of the lower triangle: every dof with itself, and the dof pairs of sites that share an element.
void Assembler::build_pattern() {
  std::vector<std::vector<int>> neighbours(kinematics_.sites());      // higher or equal sites, sorted, unique
  for (int p = 0; p < kinematics_.sites(); ++p) neighbours[p].push_back(p);
  for (const auto& group : groups_)
    for (int e = 0; e < group->elements(); ++e)
      for (const int p : group->stencil(e))
        for (const int q : group->stencil(e))
          if (p >= 0 && q > p) neighbours[p].push_back(q);
  parallel_for(kinematics_.sites(), grain, [&](std::int64_t p) {
    std::sort(neighbours[p].begin(), neighbours[p].end());
    neighbours[p].erase(std::unique(neighbours[p].begin(), neighbours[p].end()), neighbours[p].end());
  });

  hessian_.resize(kinematics_.dofs(), kinematics_.dofs());
  std::vector<int> rows;
  std::vector<int> start{0};
  for (int j = 0; j < kinematics_.dofs(); ++j) {
    for (const int q : neighbours[kinematics_.site_of(j)])
      for (int c = 0; c < 3; ++c)
        if (const int i = kinematics_.dof(q, c); i >= j) rows.push_back(i);
    start.push_back(static_cast<int>(rows.size()));
  }
  hessian_.resizeNonZeros(static_cast<Eigen::Index>(rows.size()));
  std::copy(start.begin(), start.end(), hessian_.outerIndexPtr());
  std::copy(rows.begin(), rows.end(), hessian_.innerIndexPtr());
  std::fill_n(hessian_.valuePtr(), rows.size(), 0.0);
}

void Assembler::build_gathers() {
  // Counting sort of the contributions: by site for the gradient, by non-zero for the Hessian.
  std::vector<std::int64_t>& site_start = site_gather_.start;
  site_start.assign(kinematics_.sites() + 1, 0);
  for (const auto& group : groups_)
    for (int e = 0; e < group->elements(); ++e)
      for (const int p : group->stencil(e))
        if (p >= 0) ++site_start[p + 1];
  for (std::size_t p = 1; p < site_start.size(); ++p) site_start[p] += site_start[p - 1];
  site_gather_.index.resize(site_start.back());
  std::vector<std::int64_t> next(site_start.begin(), site_start.end() - 1);
  for (std::size_t k = 0; k < groups_.size(); ++k)
    for (int e = 0; e < groups_[k]->elements(); ++e)
      for (int i = 0; i < groups_[k]->sites(); ++i)
        if (const int p = groups_[k]->stencil(e)[i]; p >= 0)
          site_gather_.index[next[p]++] = gradient_offset_[k] + std::int64_t(e) * groups_[k]->gradient_size() + 3 * i;

  const auto entry = [&](const ElementGroup& group, int e, int r, int c) {
    const int i = dof_of(kinematics_, group, e, r), j = dof_of(kinematics_, group, e, c);
    return Entry{std::max(i, j), std::min(i, j)};
  };
  const auto nonzero = [&](const Entry& at) {
    const int* first = hessian_.innerIndexPtr() + hessian_.outerIndexPtr()[at.column];
    const int* last = hessian_.innerIndexPtr() + hessian_.outerIndexPtr()[at.column + 1];
    return std::lower_bound(first, last, at.row) - hessian_.innerIndexPtr();
  };
  // The place in hessian_ of every entry of the buffer, found once; −1: a prescribed dof is in it.
  std::vector<std::int64_t> target(hessians_.size(), -1);
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const ElementGroup& group = *groups_[k];
    parallel_for(group.elements(), grain, [&](std::int64_t e) {
      std::int64_t place = hessian_offset_[k] + e * group.hessian_size();
      for (int r = 0; r < group.gradient_size(); ++r)
        for (int c = 0; c <= r; ++c, ++place)
          if (const Entry at = entry(group, static_cast<int>(e), r, c); at.column >= 0) target[place] = nonzero(at);
    });
  }
  std::vector<std::int64_t>& start = nonzero_gather_.start;
  start.assign(hessian_.nonZeros() + 1, 0);
  for (const std::int64_t t : target)
    if (t >= 0) ++start[t + 1];
  for (std::size_t i = 1; i < start.size(); ++i) start[i] += start[i - 1];
  nonzero_gather_.index.resize(start.back());
  next.assign(start.begin(), start.end() - 1);
  for (std::size_t place = 0; place < target.size(); ++place)
    if (target[place] >= 0) nonzero_gather_.index[next[target[place]]++] = static_cast<std::int64_t>(place);

  if (!kinematics_.driven()) return;
  for (std::size_t k = 0; k < groups_.size(); ++k)              // one dof free, the other driven: it feeds ∂g/∂λ
    for_each_entry(*groups_[k], [&](int e, int r, int c) {
      const Entry at = entry(*groups_[k], e, r, c);
      if (at.column >= 0 || at.row < 0) return;
      const int held = dof_of(kinematics_, *groups_[k], e, r) < 0 ? r : c, site = groups_[k]->stencil(e)[held / 3];
      const double rate = site < 0 ? 0.0 : kinematics_.drive(site)[held % 3];
      if (rate != 0)
        drives_.push_back({at.row, hessian_offset_[k] + std::int64_t(e) * groups_[k]->hessian_size() + ElementGroup::packed(r, c), rate});
    });
}

namespace {

// Sum with compensation; +inf if a value is not finite.
double sum_of(const double* value, int count) {
  ExactSum sum;
  bool finite = true;
  for (int e = 0; e < count; ++e) {
    finite = finite && std::isfinite(value[e]);
    sum.add(value[e]);
  }
  return finite ? sum.value() : std::numeric_limits<double>::infinity();
}

}  // namespace

void Assembler::sum_values() {
  for (std::size_t k = 0; k < groups_.size(); ++k)
    sums_[k] = sum_of(values_.data() + value_offset_[k], groups_[k]->elements());
}

const std::vector<double>& Assembler::values(const State& state) {
  for (std::size_t k = 0; k < groups_.size(); ++k) groups_[k]->values(state, values_.data() + value_offset_[k]);
  sum_values();
  return sums_;
}

const std::vector<double>& Assembler::evaluate(const State& state, bool with_hessian, const Tangent& tangent) {
  for (std::size_t k = 0; k < groups_.size(); ++k)
    groups_[k]->derivatives(state, tangent, values_.data() + value_offset_[k], gradients_.data() + gradient_offset_[k],
                            with_hessian ? hessians_.data() + hessian_offset_[k] : nullptr);
  sum_values();
  return sums_;
}

double Assembler::residual_energy(const State& state, const State& from) {
  double sum = 0;
  for (std::size_t k = 0; k < groups_.size(); ++k)
    if (groups_[k]->residual_energy(state, from, values_.data() + value_offset_[k]))
      sum += sum_of(values_.data() + value_offset_[k], groups_[k]->elements());
  return sum;
}

void Assembler::gather(const std::vector<double>& buffer, Field& g) const {
  g.resize(3, kinematics_.sites());
  parallel_for(kinematics_.sites(), grain, [&](std::int64_t p) {
    Vec3 sum = Vec3::Zero();
    for (std::int64_t k = site_gather_.start[p]; k < site_gather_.start[p + 1]; ++k)
      sum += Eigen::Map<const Vec3>(buffer.data() + site_gather_.index[k]);
    g.col(p) = sum;
  });
}

void Assembler::sum_hessian() {
  double* value = hessian_.valuePtr();
  parallel_for(hessian_.nonZeros(), grain_of_entries, [&](std::int64_t i) {
    double sum = 0;
    for (std::int64_t k = nonzero_gather_.start[i]; k < nonzero_gather_.start[i + 1]; ++k)
      sum += hessians_[nonzero_gather_.index[k]];
    value[i] = sum;
  });
}

void Assembler::add_drive(const State& state, Vector& out) const {
  for (const Drive& d : drives_) out[d.dof] += hessians_[d.place] * d.rate;
  for (const auto& group : groups_) add_load_derivative(*group, state, out);
}

void Assembler::add_load_derivative(const ElementGroup& group, const State& state, Vector& out) const {
  if (!group.load_dependent()) return;
  std::vector<double> rate(std::size_t(group.elements()) * group.gradient_size());
  group.explicit_load_derivative(state, rate.data());
  for (int e = 0; e < group.elements(); ++e)
    for (int i = 0; i < group.gradient_size(); ++i)
      if (const int dof = dof_of(kinematics_, group, e, i); dof >= 0)
        out[dof] += rate[std::size_t(e) * group.gradient_size() + i];
}

namespace {

// The part of v that an element sees: differences to its first site, as its energy does not change under translation, or
// v itself where it does.
void relative_motion(const Field& v, std::span<const int> stencil, bool anchored, double* out) {
  for (std::size_t i = 0; i < stencil.size(); ++i)
    for (int c = 0; c < 3; ++c) out[3 * i + c] = stencil[i] < 0 ? 0.0 : v(c, stencil[i]) - (anchored ? 0.0 : v(c, stencil[0]));
}

constexpr int most_local = 3 * Assembler::most_sites;

// y = H_e v from the packed lower triangle.
void packed_product(const double* h, const double* v, int n, double* y) {
  for (int r = 0; r < n; ++r) y[r] = 0;
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < r; ++c, ++h) y[r] += *h * v[c], y[c] += *h * v[r];
    y[r] += *h++ * v[r];
  }
}

}  // namespace

void Assembler::multiply(const Field& v, Field& out) {
  products_.resize(gradients_.size());
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const ElementGroup& group = *groups_[k];
    parallel_for(group.elements(), grain, [&](std::int64_t e) {
      double local[most_local];
      relative_motion(v, group.stencil(e), group.anchored(), local);
      packed_product(hessians_.data() + hessian_offset_[k] + e * group.hessian_size(), local, group.gradient_size(),
                     products_.data() + gradient_offset_[k] + e * group.gradient_size());
    });
  }
  gather(products_, out);
}

BilinearForm Assembler::slope(const Field& v) const {
  ExactSum sum;
  double squares = 0;
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const ElementGroup& group = *groups_[k];
    const double* g = gradients_.data() + gradient_offset_[k];
    for (int e = 0; e < group.elements(); ++e, g += group.gradient_size()) {
      double local[most_local], part = 0;
      relative_motion(v, group.stencil(e), group.anchored(), local);
      for (int r = 0; r < group.gradient_size(); ++r) part += g[r] * local[r], squares += g[r] * local[r] * g[r] * local[r];
      sum.add(part);
    }
  }
  return {sum.value(), std::sqrt(squares)};
}

BilinearForm Assembler::form(const Field& u, const Field& v, const State* state) const {
  ExactSum sum;
  double size = 0;
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const ElementGroup& group = *groups_[k];
    if (state && group.forms(*state, u, v, sum, size)) continue;
    for (int e = 0; e < group.elements(); ++e) {
      double left[most_local], right[most_local];
      relative_motion(u, group.stencil(e), group.anchored(), left);
      relative_motion(v, group.stencil(e), group.anchored(), right);
      const int first = group.anchored() ? 0 : 3;
      double q = 0;
      for (int r = first; r < group.gradient_size(); ++r) {
        const double* row = hessians_.data() + hessian_offset_[k] + std::int64_t(e) * group.hessian_size() + ElementGroup::packed(r, 0);
        for (int c = first; c < r; ++c) {
          q += row[c] * (left[r] * right[c] + left[c] * right[r]);
          size += std::abs(row[c]) * (std::abs(left[r] * right[c]) + std::abs(left[c] * right[r]));
        }
        q += row[r] * left[r] * right[r];
        size += std::abs(row[r] * left[r] * right[r]);
      }
      sum.add(q);
    }
  }
  return {sum.value(), size};
}

double Assembler::largest_element_force() const {
  double largest = 0;
  for (std::size_t i = 0; i < gradients_.size(); i += 3)
    largest = std::max(largest, Eigen::Map<const Vec3>(gradients_.data() + i).norm());
  return largest;
}

}  // namespace elamin
