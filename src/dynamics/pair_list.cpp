#include "dynamics/pair_list.hpp"

#include "core/near_pairs.hpp"

#include <algorithm>

namespace elamin {

namespace {
constexpr double alike = 2;                      // ratio of reaches up to which one grid is good
constexpr std::int64_t most_cells = 8;           // for every particle; more: they are far apart, see core/near_pairs
}

PairList::PairList(const Model& model, const ContactRules& rules, double skin) : model_(model), rules_(rules), skin_(skin) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  for (int i = 0; i < model.particles(); ++i) {
    if (!(rules.cutoff_radius(i) > 0)) continue;
    members_.push_back(i);
    smallest = std::min(smallest, rules.cutoff_radius(i)), largest = std::max(largest, rules.cutoff_radius(i));
  }
  cell_ = 2 * largest + skin;
  alike_ = largest <= alike * smallest;
  cell_of_.resize(model.particles()), sorted_.resize(model.particles());
  at_ = Columns(model.particles()), far_.resize(padded(model.particles()));
}

void PairList::find(const Columns& x) {
  for (auto& list : pairs_) list.clear();
  if (members_.empty()) return;
  alike_ ? find_on_grid(x) : find_at_all_sizes(x);
}

void PairList::offer(int i, int j, double squared) {
  const auto within = [&](double distance) { return squared <= (distance + skin_) * (distance + skin_); };
  if (const int t = rules_.hertz(i, j); t >= 0 && model_.contacts[t].effective_modulus > 0 &&
                                        within((model_.diameter[i] + model_.diameter[j]) / 2))
    pairs_[0].push_back({i, j, t});
  if (const int t = rules_.lj(i, j); t >= 0 && model_.contacts[t].epsilon != 0 && within(model_.contacts[t].cutoff))
    pairs_[1].push_back({i, j, t});
}

void PairList::find_on_grid(const Columns& x) {
  Vec3 lo = Vec3::Constant(std::numeric_limits<double>::infinity()), hi = -lo;
  for (const int i : members_) lo = lo.cwiseMin(x.at(i)), hi = hi.cwiseMax(x.at(i));
  const Vec3 cells = ((hi - lo) / cell_).array().floor() + 1;
  if (!(cells.prod() <= static_cast<double>(most_cells * static_cast<std::int64_t>(members_.size()) + 1000)))
    return find_at_all_sizes(x);
  const int nx = static_cast<int>(cells[0]), ny = static_cast<int>(cells[1]), nz = static_cast<int>(cells[2]);
  const double per_length = 1 / cell_;
  const auto along = [&](double a, double from, int n) { return std::min(static_cast<int>((a - from) * per_length), n - 1); };
  start_.assign(static_cast<std::size_t>(nx) * ny * nz + 1, 0);
  for (const int i : members_) {
    cell_of_[i] = (along(x.z[i], lo[2], nz) * ny + along(x.y[i], lo[1], ny)) * nx + along(x.x[i], lo[0], nx);
    ++start_[cell_of_[i] + 1];
  }
  for (std::size_t c = 1; c < start_.size(); ++c) start_[c] += start_[c - 1];
  for (const int i : members_) {
    const int at = start_[cell_of_[i]]++;
    sorted_[at] = i, at_.x[at] = x.x[i], at_.y[at] = x.y[i], at_.z[at] = x.z[i], far_[at] = rules_.cutoff_radius(i);
  }
  for (std::size_t c = start_.size() - 1; c > 0; --c) start_[c] = start_[c - 1];
  start_[0] = 0;
  // Of two particles the one that is sorted first looks for the other: in the cells behind its own. Cells side by side are
  // one stretch of particles.
  int at = 0;
  for (int cz = 0; cz < nz; ++cz)
    for (int cy = 0; cy < ny; ++cy)
      for (int cx = 0; cx < nx; ++cx) {
        const int row = (cz * ny + cy) * nx, left = std::max(cx - 1, 0), right = std::min(cx + 1, nx - 1) + 1;
        std::array<std::pair<int, int>, 5> stretches;
        int count = 1;                                            // the first one: what follows here and in the next cell
        stretches[0].second = start_[row + right];
        const auto add = [&](int y, int z) {
          if (y >= 0 && y < ny && z < nz) stretches[count++] = {start_[(z * ny + y) * nx + left], start_[(z * ny + y) * nx + right]};
        };
        add(cy + 1, cz), add(cy - 1, cz + 1), add(cy, cz + 1), add(cy + 1, cz + 1);
        for (const int end = start_[row + cx + 1]; at < end; ++at) {
          stretches[0].first = at + 1;
          for (int k = 0; k < count; ++k) search(at, stretches[k].first, stretches[k].second);
        }
      }
}

// The particles from `begin` to `end`, as sorted, that are near the one at `at`.
void PairList::search(int at, int begin, int end) {
  const Triple<Lanes> own{at_.x[at], at_.y[at], at_.z[at]};
  const Lanes cutoff = far_[at] + skin_;
  for (int j = begin; j < end; j += Lanes::count) {
    const Triple<Lanes> d = at_.load(j) - own;
    const Lanes far = Lanes::load(&far_[j]) + cutoff, squared = dot(d, d);
    unsigned near = below(squared, far * far);
    if (end - j < Lanes::count) near &= (1u << (end - j)) - 1;
    for (int k = 0; near != 0; ++k, near >>= 1)
      if (near & 1) offer(std::min(sorted_[at], sorted_[j + k]), std::max(sorted_[at], sorted_[j + k]), squared[k]);
  }
}

void PairList::find_at_all_sizes(const Columns& x) {
  Field centers(3, model_.particles());
  x.copy_to(centers);
  std::vector<double> radii(model_.particles(), 0.0);
  for (const int i : members_) radii[i] = rules_.cutoff_radius(i) + skin_ / 2;
  for (const auto& [i, j] : near_pairs(centers, radii, [](int, int) { return true; })) offer(i, j, (x.at(j) - x.at(i)).squaredNorm());
}

}  // namespace elamin
