#include "model/connect.hpp"

#include "model/append.hpp"
#include "model/distinct.hpp"
#include "model/geometry.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace elamin {
namespace {

constexpr double even = 1e-9;                      // relative: distances this close are the same
constexpr std::size_t most_pairs = 20'000'000;
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

/// Values of any kind, numbered as they come; one number for each distinct pair.
std::vector<int> numbered(const std::vector<int>& a, const std::vector<double>& b, std::vector<std::size_t>& first) {
  std::map<std::pair<int, double>, int> numbers;
  std::vector<int> of;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const auto [found, is_new] = numbers.try_emplace({a[k], b[k]}, static_cast<int>(first.size()));
    if (is_new) first.push_back(k);
    of.push_back(found->second);
  }
  return of;
}

/// Pairs of a particle of `first` and one of `second`, ascending, each once; none if they are too many.
class NearPairs {
 public:
  NearPairs(const Model& model, const std::vector<std::vector<int>>& before, const Connection& connection)
      : start_(model.start), before_(before), c_(connection) {}

  std::optional<std::vector<Pair>> find() {
    if (c_.within > 0) return within(c_.within * (1 + even), true);
    // The nearest, however far: a cutoff that grows until everyone has enough.
    Vec3 low = start_.position.col(c_.second.front()), high = low;
    for (const auto* side : {&c_.first, &c_.second})
      for (const int p : *side) low = low.cwiseMin(start_.position.col(p)), high = high.cwiseMax(start_.position.col(p));
    const double extent = (high - low).norm() * (1 + even);
    for (double cutoff = extent / std::max<double>(1, static_cast<double>(c_.second.size())); extent > 0; cutoff *= 2) {
      const bool all = cutoff >= extent;
      std::optional<std::vector<Pair>> pairs = within(std::min(cutoff, extent), all);
      if (!pairs || enough_) return pairs;
    }
    return std::vector<Pair>{};
  }

 private:
  std::optional<std::vector<Pair>> within(double cutoff, bool farthest) {
    const Cells cells(start_.position, c_.second, cutoff);
    std::vector<Pair> pairs;
    std::vector<Near> near;
    enough_ = true;
    for (const int i : c_.first) {
      near.clear();
      const Vec3 x = start_.position.col(i);
      const bool few = cells.for_each_near(x, [&](int j) {
        if (j == i || (start_.position.col(j) - x).norm() > 2 * cutoff) return ++tries_ < most_tries;
        const double distance = norm(start_.at(j) - start_.at(i)).value();
        const bool apart = !std::binary_search(before_[i].begin(), before_[i].end(), j);
        if (apart && distance <= cutoff) near.push_back({distance, j});
        return ++tries_ < most_tries;
      });
      if (static_cast<int>(near.size()) < c_.bonds_per_particle && !farthest) return enough_ = false, std::vector<Pair>{};
      if (c_.bonds_per_particle > 0) keep_nearest(near, c_.bonds_per_particle);
      if (!few || pairs.size() + near.size() > most_pairs) return std::nullopt;
      for (const Near& n : near) pairs.push_back({std::min(i, n.particle), std::max(i, n.particle)});
    }
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  }

  const State& start_;
  const std::vector<std::vector<int>>& before_;
  const Connection& c_;
  bool enough_ = true;
  std::int64_t tries_ = 0;
};

}  // namespace

void add_bonds(Model& model, const std::vector<NewBond>& bonds) {
  std::vector<double> lengths, stiffness;
  for (const NewBond& b : bonds)
    lengths.push_back(b.rest_length > 0 ? b.rest_length : norm(model.start.at(b.particles[1]) - model.start.at(b.particles[0])).value());
  const Distinct alike = distinct(lengths, 0, 0, 16 * epsilon);
  for (std::size_t b = 0; b < bonds.size(); ++b)
    stiffness.push_back(bonds[b].axial_stiffness > 0 ? bonds[b].axial_stiffness / (2 * alike.value[alike.type[b]]) : bonds[b].stiffness);
  std::vector<std::size_t> first;
  const std::vector<int> type = numbered(alike.type, stiffness, first);
  const int types = static_cast<int>(model.bond_types.size());
  for (const std::size_t b : first) add_type(model, BondType{stiffness[b], alike.value[alike.type[b]]});
  for (std::size_t b = 0; b < bonds.size(); ++b) model.bonds.push_back({types + type[b], bonds[b].particles});
}

void add_angles(Model& model, const std::vector<NewAngle>& angles) {
  std::vector<double> rests, stiffness;
  for (const NewAngle& a : angles) {
    const auto at = [&](int k) { return model.start.at(a.particles[k]); };
    rests.push_back(a.rest >= 0 ? a.rest : angle_at(at(1), at(0), at(2)));
    stiffness.push_back(a.stiffness);
  }
  const Distinct alike = distinct(rests, 0, 1e-12, 0);
  std::vector<std::size_t> first;
  const std::vector<int> type = numbered(alike.type, stiffness, first);
  const int types = static_cast<int>(model.angle_types.size());
  for (const std::size_t a : first) add_type(model, AngleType{stiffness[a], alike.value[alike.type[a]]});
  for (std::size_t a = 0; a < angles.size(); ++a) model.angles.push_back({types + type[a], angles[a].particles});
}

std::vector<std::array<int, 3>> meeting_bonds(const Model& model, const std::vector<int>& particles, double least) {
  std::vector<bool> in(model.particles());
  for (const int p : particles) in[p] = true;
  const std::vector<std::vector<int>> to = bonded(model);
  std::vector<std::array<int, 3>> triples;
  for (const int p : particles)
    for (std::size_t a = 0; a < to[p].size(); ++a)
      for (std::size_t b = a + 1; b < to[p].size(); ++b) {
        const int i = to[p][a], k = to[p][b];
        if (!in[i] || !in[k]) continue;
        if (least <= 0 || angle_at(model.start.at(p), model.start.at(i), model.start.at(k)) >= least - 1e-9) triples.push_back({i, p, k});
      }
  return triples;
}

int connect(Model& model, const Connection& connection) {
  if (connection.first.empty() || connection.second.empty() || !(connection.within > 0 || connection.bonds_per_particle > 0)) return 0;
  const std::vector<std::vector<int>> before = bonded(model);
  const std::optional<std::vector<Pair>> pairs = NearPairs(model, before, connection).find();
  if (!pairs) return -1;
  std::vector<NewBond> bonds;
  for (const Pair& pair : *pairs) bonds.push_back({pair, connection.bond_stiffness, connection.axial_stiffness, connection.rest_length});
  add_bonds(model, bonds);
  std::vector<NewAngle> angles;
  const auto over = [&](int i, int j, int k) {
    angles.push_back({{i, j, k}, connection.angle_stiffness, connection.as_built ? -1 : connection.rest});
  };
  for (const auto& [i, j] : *pairs) {
    if (connection.angle_stiffness == 0) break;
    for (const int k : before[j]) over(i, j, k);
    for (const int m : before[i]) over(j, i, m);
  }
  add_angles(model, angles);
  return static_cast<int>(pairs->size());
}

}  // namespace elamin
