#include "model/connect.hpp"

#include "model/append.hpp"
#include "model/distinct.hpp"
#include "model/geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace elamin {
namespace {

constexpr double even = 1e-9;                      // relative: distances this close are the same
constexpr std::size_t most_bonds = 20'000'000;
constexpr std::int64_t most_tries = 500'000'000;   // some seconds

using Pair = std::array<int, 2>;

/// Points sorted by the cell they are in, so that the three cells of a row of neighbours follow one another.
class Cells {
 public:
  Cells(const Field& position, const std::vector<int>& of, double cutoff) {
    low_ = high_ = position.col(of.front());
    for (const int p : of) low_ = low_.cwiseMin(position.col(p)), high_ = high_.cwiseMax(position.col(p));
    size_ = 1.001 * std::max(cutoff, (high_ - low_).maxCoeff() / most);
    for (const int p : of) entries_.push_back({cell(position.col(p)), p});
    std::sort(entries_.begin(), entries_.end());
  }

  /// body(particle) for all within `cutoff` of x, and for some beyond, until it returns false.
  template <class Body>
  bool for_each_near(const Vec3& x, const Body& body) const {
    if (((x - low_).array() < -2 * size_).any() || ((x - high_).array() > 2 * size_).any()) return true;
    const Cell c = cell(x);
    for (std::int64_t i = c[0] - 1; i <= c[0] + 1; ++i)
      for (std::int64_t j = c[1] - 1; j <= c[1] + 1; ++j) {
        const Cell last{i, j, c[2] + 1};
        auto e = std::lower_bound(entries_.begin(), entries_.end(), Entry{{i, j, c[2] - 1}, -1});
        for (; e != entries_.end() && e->first <= last; ++e)
          if (!body(e->second)) return false;
      }
    return true;
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  using Entry = std::pair<Cell, int>;
  static constexpr double most = 1e12;             // cells along an axis: their bounds keep some digits

  Cell cell(const Vec3& x) const {
    Cell c;
    for (int d = 0; d < 3; ++d) c[d] = static_cast<std::int64_t>(std::floor((x[d] - low_[d]) / size_));
    return c;
  }

  Vec3 low_, high_;
  double size_ = 0;
  std::vector<Entry> entries_;
};

struct Near {
  double distance;
  int particle;
};

/// The nearest n; among those equally far the first ones.
void keep_nearest(std::vector<Near>& near, int n) {
  if (static_cast<int>(near.size()) <= n) return;
  std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) { return a.distance < b.distance; });
  for (auto from = near.begin(); from != near.end();) {
    auto to = from + 1;
    while (to != near.end() && to->distance <= (to - 1)->distance * (1 + even)) ++to;
    std::sort(from, to, [](const Near& a, const Near& b) { return a.particle < b.particle; });
    from = to;
  }
  near.resize(n);
}

std::vector<std::vector<int>> bonded(const Model& model) {
  std::vector<std::vector<int>> to(model.particles());
  for (const Bond& b : model.bonds)
    for (int s = 0; s < 2; ++s) to[b.particles[s]].push_back(b.particles[1 - s]);
  for (std::vector<int>& t : to) {
    std::sort(t.begin(), t.end());
    t.erase(std::unique(t.begin(), t.end()), t.end());
  }
  return to;
}

}  // namespace

int connect(Model& model, const Connection& connection) {
  if (connection.first.empty() || connection.second.empty() || !(connection.within > 0)) return 0;
  const double cutoff = connection.within * (1 + even);
  const std::vector<std::vector<int>> before = bonded(model);
  const Cells cells(model.start.position, connection.second, cutoff);
  std::vector<Pair> pairs;
  std::int64_t tries = 0;
  std::vector<Near> near;
  for (const int i : connection.first) {
    near.clear();
    const Vec3 x = model.start.position.col(i);
    const bool few = cells.for_each_near(x, [&](int j) {
      if (j == i || (model.start.position.col(j) - x).norm() > 2 * cutoff) return ++tries < most_tries;
      const double distance = norm(model.start.at(j) - model.start.at(i)).value();
      const bool apart = !std::binary_search(before[i].begin(), before[i].end(), j);
      if (apart && distance <= cutoff) near.push_back({distance, j});
      return ++tries < most_tries;
    });
    if (connection.bonds_per_particle > 0) keep_nearest(near, connection.bonds_per_particle);
    if (!few || pairs.size() + near.size() > most_bonds) return -1;
    for (const Near& n : near) pairs.push_back({std::min(i, n.particle), std::max(i, n.particle)});
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  if (pairs.empty()) return 0;

  std::vector<double> lengths(pairs.size(), connection.rest_length);
  if (connection.rest_length == 0)
    for (std::size_t b = 0; b < pairs.size(); ++b)
      lengths[b] = norm(model.start.at(pairs[b][1]) - model.start.at(pairs[b][0])).value();
  const Distinct bond_types = distinct(lengths, static_cast<int>(model.bond_types.size()), 0, 16 * epsilon);
  for (const double length : bond_types.value) add_type(model, BondType{connection.bond_stiffness, length});
  for (std::size_t b = 0; b < pairs.size(); ++b) model.bonds.push_back({bond_types.type[b], pairs[b]});
  if (connection.angle_stiffness == 0) return static_cast<int>(pairs.size());

  std::vector<std::array<int, 3>> triples;
  for (const auto& [i, j] : pairs) {
    for (const int k : before[j]) triples.push_back({i, j, k});
    for (const int m : before[i]) triples.push_back({j, i, m});
  }
  std::vector<double> rests(triples.size(), connection.rest);
  if (connection.as_built)
    for (std::size_t a = 0; a < triples.size(); ++a)
      rests[a] = angle_at(model.start.at(triples[a][1]), model.start.at(triples[a][0]), model.start.at(triples[a][2]));
  const Distinct angle_types = distinct(rests, static_cast<int>(model.angle_types.size()), 1e-12, 0);
  for (const double rest : angle_types.value) add_type(model, AngleType{connection.angle_stiffness, rest});
  for (std::size_t a = 0; a < triples.size(); ++a) model.angles.push_back({angle_types.type[a], triples[a]});
  return static_cast<int>(pairs.size());
}

}  // namespace elamin
