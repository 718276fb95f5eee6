#include "energy/assembler.hpp"

#include "core/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace elamin {

namespace {

constexpr std::int64_t grain = 5000;               // elements and sites a thread
constexpr std::int64_t grain_of_blocks = 1000;     // sites, each with a few hundred additions

// One part of a block: the place of an element's Hessian, of `sites` sites, and which of them are that of the rows and that of the columns; `others`: the
// first site of an element that may be moved as a whole, minus all others, see ElementGroup::derivatives.
struct BlockPart {
  static constexpr int others = 15;
  std::int64_t place;
  int sites, rows, columns;

  std::int64_t code() const { return place << 12 | sites << 8 | rows << 4 | columns; }
  static BlockPart of(std::int64_t code) {
    return {code >> 12, static_cast<int>(code >> 8 & 15), static_cast<int>(code >> 4 & 15), static_cast<int>(code & 15)};
  }
};
static_assert(Assembler::most_sites < BlockPart::others);

// Adds the entries of two sites to a block, given by columns.
void add_entries(const double* h, int r, int c, double sign, double (&block)[3][3]) {
  for (int k = 0; k < 3; ++k) {
    const double* const row = h + (r < c ? ElementGroup::packed(3 * c + k, 3 * r) : ElementGroup::packed(3 * r + k, 3 * c));
    for (int b = 0; b < (r == c ? k + 1 : 3); ++b) {
      if (r >= c) block[b][k] += sign * row[b];
      if (r < c || (r == c && b < k)) block[k][b] += sign * row[b];
    }
  }
}

void add_part(const std::vector<double>& hessians, std::int64_t code, double (&block)[3][3]) {
  const BlockPart p = BlockPart::of(code);
  const double* const h = hessians.data() + p.place;
  if (p.rows != BlockPart::others && p.columns != BlockPart::others) return add_entries(h, p.rows, p.columns, 1, block);
  const auto from = [](int site) { return site == BlockPart::others ? 0 : site; };
  const auto to = [&](int site) { return site == BlockPart::others ? p.sites : site + 1; };
  const double sign = p.rows == p.columns ? 1 : -1;
  for (int r = from(p.rows); r < to(p.rows); ++r)
    for (int c = from(p.columns); c < to(p.columns); ++c) add_entries(h, r, c, sign, block);
}

// The free dof of a row of an element, −1: prescribed, or no site.
int dof_of(const Kinematics& kinematics, const ElementGroup& group, int e, int row) {
  const int site = group.stencil(e)[row / 3];
  return site < 0 ? -1 : kinematics.dof(site, row % 3);
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
  build_site_gather();
  build_blocks();
  build_pattern();
  if (kinematics_.driven()) find_driven();
  values_.resize(v), sums_.resize(groups_.size()), gradients_.resize(g), hessians_.resize(h);       // the largest last, when what has made the lists is gone
}

// A counting sort, by site.
void Assembler::build_site_gather() {
  std::vector<std::int64_t>& start = site_gather_.start;
  start.assign(kinematics_.sites() + 1, 0);
  for (const auto& group : groups_)
    for (int e = 0; e < group->elements(); ++e)
      for (const int p : group->stencil(e))
        if (p >= 0) ++start[p + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  site_gather_.index.resize(start.back());
  std::vector<std::int64_t> next(start.begin(), start.end() - 1);
  for (std::size_t k = 0; k < groups_.size(); ++k)
    for (int e = 0; e < groups_[k]->elements(); ++e)
      for (int i = 0; i < groups_[k]->sites(); ++i)
        if (const int p = groups_[k]->stencil(e)[i]; p >= 0)
          site_gather_.index[next[p]++] = gradient_offset_[k] + std::int64_t(e) * groups_[k]->gradient_size() + 3 * i;
}

// A counting sort of the parts by the site of their columns, then by that of their rows, which keeps the order of the elements.
void Assembler::build_blocks() {
  struct Placed { int rows; std::int64_t code; };
  const auto for_each_part = [&](const auto& body) {           // body(columns' site, rows' site, code)
    for (std::size_t k = 0; k < groups_.size(); ++k) {
      const int first = groups_[k]->hessian_first() / 3, count = groups_[k]->sites() - first, size = groups_[k]->hessian_size();
      const auto part = [&](int e, int rows, int columns) {
        const auto among = [&](int i) { return i < first ? BlockPart::others : i - first; };
        return BlockPart{hessian_offset_[k] + std::int64_t(e) * size, count, among(rows), among(columns)}.code();
      };
      for (int e = 0; e < groups_[k]->elements(); ++e) {
        const std::span<const int> site = groups_[k]->stencil(e);
        for (int i = 0; i < static_cast<int>(site.size()); ++i)
          for (int j = 0; j <= i && site[i] >= 0; ++j) {
            if (site[j] < 0) continue;
            if (i > j && site[i] <= site[j]) body(site[i], site[j], part(e, j, i));
            if (site[i] >= site[j]) body(site[j], site[i], part(e, i, j));
          }
      }
    }
  };
  const std::size_t sites = kinematics_.sites();
  std::vector<std::int64_t> begin(sites + 1, 0);
  for_each_part([&](int columns, int, std::int64_t) { ++begin[columns + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<Placed> parts(begin.back());
  std::vector<std::int64_t> next(begin.begin(), begin.end() - 1);
  for_each_part([&](int columns, int rows, std::int64_t code) { parts[next[columns]++] = {rows, code}; });
  blocks_.first.assign(sites + 1, 0);
  parallel_for(static_cast<std::int64_t>(sites), grain, [&](std::int64_t p) {
    const auto from = parts.begin() + begin[p], to = parts.begin() + begin[p + 1];
    std::stable_sort(from, to, [](const Placed& a, const Placed& b) { return a.rows < b.rows; });
    std::int64_t count = from == to || from->rows != p;         // its own, though nothing be in it
    for (auto it = from; it != to; ++it) count += it == from || it->rows != (it - 1)->rows;
    blocks_.first[p + 1] = count;
  });
  std::partial_sum(blocks_.first.begin(), blocks_.first.end(), blocks_.first.begin());
  blocks_.site.reserve(blocks_.first.back()), blocks_.start.reserve(blocks_.first.back() + 1);
  blocks_.part.reserve(parts.size());
  for (std::size_t p = 0; p < sites; ++p) {
    blocks_.site.push_back(static_cast<int>(p)), blocks_.start.push_back(static_cast<std::int64_t>(blocks_.part.size()));
    for (std::int64_t k = begin[p]; k < begin[p + 1]; ++k) {
      if (parts[k].rows != blocks_.site.back())
        blocks_.site.push_back(parts[k].rows), blocks_.start.push_back(static_cast<std::int64_t>(blocks_.part.size()));
      blocks_.part.push_back(parts[k].code);
    }
  }
  blocks_.start.push_back(static_cast<std::int64_t>(blocks_.part.size()));
}

// Columns of the lower triangle: every dof with itself, and the dof pairs of sites that share an element.
void Assembler::build_pattern() {
  const auto for_each_row = [&](int j, const auto& body) {
    const int p = kinematics_.site_of(j);
    for (std::int64_t k = blocks_.first[p]; k < blocks_.first[p + 1]; ++k)
      for (int c = 0; c < 3; ++c)
        if (const int i = kinematics_.dof(blocks_.site[k], c); i >= j) body(i);
  };
  hessian_.resize(kinematics_.dofs(), kinematics_.dofs());
  int* const start = hessian_.outerIndexPtr();
  for (int j = 0; j < kinematics_.dofs(); ++j) {
    start[j + 1] = start[j];
    for_each_row(j, [&](int) { ++start[j + 1]; });
  }
  hessian_.resizeNonZeros(start[kinematics_.dofs()]);
  parallel_for(kinematics_.dofs(), grain, [&](std::int64_t j) {
    int* row = hessian_.innerIndexPtr() + start[j];
    for_each_row(static_cast<int>(j), [&](int i) { *row++ = i; });
  });
  std::fill_n(hessian_.valuePtr(), hessian_.nonZeros(), 0.0);
}

// They feed ∂g/∂λ.
void Assembler::find_driven() {
  driven_.resize(groups_.size());
  for (std::size_t k = 0; k < groups_.size(); ++k)
    for (int e = 0; e < groups_[k]->elements(); ++e) {
      bool free = false, driven = false;
      for (const int site : groups_[k]->stencil(e))
        for (int c = 0; c < 3 && site >= 0; ++c)
          free = free || kinematics_.dof(site, c) >= 0, driven = driven || kinematics_.drive(site)[c] != 0;
      if (free && driven) driven_[k].push_back(e);
    }
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
  return finite ? sum.value() : infinity;
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
  parallel_for(kinematics_.sites(), grain_of_blocks, [&](std::int64_t p) {
    double* column[3] = {};                                   // where it goes on
    int dof[3];
    for (int b = 0; b < 3; ++b)
      if ((dof[b] = kinematics_.dof(static_cast<int>(p), b)) >= 0) column[b] = hessian_.valuePtr() + hessian_.outerIndexPtr()[dof[b]];
    for (std::int64_t k = blocks_.first[p]; k < blocks_.first[p + 1]; ++k) {
      double block[3][3] = {};
      for (std::int64_t i = blocks_.start[k]; i < blocks_.start[k + 1]; ++i) add_part(hessians_, blocks_.part[i], block);
      for (int a = 0; a < 3; ++a) {
        const int row = kinematics_.dof(blocks_.site[k], a);
        for (int b = 0; b < 3; ++b)
          if (column[b] && row >= dof[b]) *column[b]++ = block[b][a];
      }
    }
  });
}

namespace {

// The part of v that an element sees: differences to its first site, as its energy does not change under translation, or
// v itself where it does.
void relative_motion(const Field& v, std::span<const int> stencil, bool anchored, double* out) {
  for (std::size_t i = 0; i < stencil.size(); ++i)
    for (int c = 0; c < 3; ++c) out[3 * i + c] = stencil[i] < 0 ? 0.0 : v(c, stencil[i]) - (anchored ? 0.0 : v(c, stencil[0]));
}

constexpr int most_local = 3 * Assembler::most_sites;

// y = H_e v from the packed lower triangle. `size` is n, or 0 where it is not one of the usual ones: then nothing is unrolled.
template <int size>
void packed_product(const double* __restrict h, const double* __restrict v, [[maybe_unused]] int n, double* __restrict y) {
  const int all = size > 0 ? size : n;
  for (int r = 0; r < all; ++r) y[r] = 0;
  for (int r = 0; r < all; ++r) {
    for (int c = 0; c < r; ++c, ++h) y[r] += *h * v[c], y[c] += *h * v[r];
    y[r] += *h++ * v[r];
  }
}

// Bonds and contacts, angles, hinges of four sites, relative to their first.
auto packed_product_of(int n) { return n == 3 ? packed_product<3> : n == 6 ? packed_product<6> : n == 9 ? packed_product<9> : packed_product<0>; }

// What one group's elements have in common, asked for once.
struct Elements {
  std::span<const int> stencils;
  const double* hessians;
  int sites, first, size;                            // first: of the coordinates that the Hessians have

  Elements(const ElementGroup& group, const double* at)
      : stencils(group.stencils()), hessians(at), sites(group.sites()), first(group.hessian_first()), size(group.hessian_size()) {}

  // H_e v of one element, 3·sites.
  void multiply(std::int64_t e, const Field& v, double* out) const {
    const int n = 3 * sites;
    double local[most_local];
    relative_motion(v, stencils.subspan(e * sites, sites), first == 0, local);
    packed_product_of(n - first)(hessians + e * size, local + first, n - first, out + first);
    if (first == 0) return;
    out[0] = out[1] = out[2] = 0;
    for (int i = 3; i < n; ++i) out[i % 3] -= out[i];
  }
};

}  // namespace

void Assembler::add_drive(const State& state, Vector& out) const {
  for (std::size_t k = 0; k < driven_.size(); ++k) {
    const Elements elements(*groups_[k], hessians_.data() + hessian_offset_[k]);
    for (const int e : driven_[k]) {
      double rate[most_local];
      elements.multiply(e, kinematics_.drive(), rate);
      for (int i = 0; i < 3 * elements.sites; ++i) {
        const int site = elements.stencils[std::size_t(e) * elements.sites + i / 3], dof = site < 0 ? -1 : kinematics_.dof(site, i % 3);
        if (dof >= 0) out[dof] += rate[i];
      }
    }
  }
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

void Assembler::multiply(const Field& v, Field& out) {
  products_.resize(gradients_.size());
  for (std::size_t k = 0; k < groups_.size(); ++k) {
    const Elements elements(*groups_[k], hessians_.data() + hessian_offset_[k]);
    double* const products = products_.data() + gradient_offset_[k];
    parallel_for(groups_[k]->elements(), grain, [&](std::int64_t e) { elements.multiply(e, v, products + e * 3 * elements.sites); });
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
    const double* entry = hessians_.data() + hessian_offset_[k];
    const int first = group.hessian_first(), n = group.gradient_size();
    for (int e = 0; e < group.elements(); ++e) {
      double left[most_local], right[most_local];
      relative_motion(u, group.stencil(e), first == 0, left);
      relative_motion(v, group.stencil(e), first == 0, right);
      double q = 0;
      for (int r = first; r < n; ++r) {
        for (int c = first; c < r; ++c, ++entry) {
          q += *entry * (left[r] * right[c] + left[c] * right[r]);
          size += std::abs(*entry) * (std::abs(left[r] * right[c]) + std::abs(left[c] * right[r]));
        }
        q += *entry * left[r] * right[r];
        size += std::abs(*entry * left[r] * right[r]), ++entry;
      }
      sum.add(q);
    }
  }
  return {sum.value(), size};
}

double Assembler::largest_element_force(std::size_t first, std::size_t last) const {
  const auto begins = [&](std::size_t k) { return k < gradient_offset_.size() ? static_cast<std::size_t>(gradient_offset_[k]) : gradients_.size(); };
  double largest = 0;
  for (std::size_t i = begins(first); i < begins(last); i += 3)
    largest = std::max(largest, Eigen::Map<const Vec3>(gradients_.data() + i).norm());
  return largest;
}

}  // namespace elamin
