#include "dynamics/edge_order.hpp"

#include "energy/changes.hpp"

#include <algorithm>

namespace elamin {

namespace {

using Pair = std::array<int, 2>;

constexpr int shortest_row = 4;                // shorter ones are not worth their fillers

Pair sorted(int i, int j) { return i < j ? Pair{i, j} : Pair{j, i}; }

int place(const std::vector<Pair>& pairs, const Pair& p) {
  const auto at = std::lower_bound(pairs.begin(), pairs.end(), p);
  return at != pairs.end() && *at == p ? static_cast<int>(at - pairs.begin()) : -1;
}

class Ordering {
 public:
  Ordering(const Model& model, double load_factor, EdgeOrder& out) : model_(model), load_factor_(load_factor), out_(out) {}

  void run() {
    find_pairs();
    put_bonds();
    join();
    direct();
    lay_out();
  }

 private:
  bool straight(const Angle& a) const {
    const auto [i, j, k] = a.particles;
    return model_.angle_types[a.type].rest == pi && i != j && j != k && i != k;
  }

  void find_pairs() {
    for (const Bond& b : model_.bonds) pairs_.push_back(sorted(b.particles[0], b.particles[1]));
    for (const Angle& a : model_.angles)
      if (straight(a))
        pairs_.push_back(sorted(a.particles[0], a.particles[1])), pairs_.push_back(sorted(a.particles[1], a.particles[2]));
    std::sort(pairs_.begin(), pairs_.end());
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
    joints_.resize(pairs_.size());
    edges_.resize(pairs_.size());
    for (std::size_t e = 0; e < pairs_.size(); ++e) edges_[e].from = pairs_[e][0], edges_[e].to = pairs_[e][1];
  }

  void put_bonds() {
    const Kinds kinds = bond_kinds(model_);
    std::vector<bool> taken(edges_.size());
    for (std::size_t b = 0; b < model_.bonds.size(); ++b) {
      const auto [i, j] = model_.bonds[b].particles;
      const int e = place(pairs_, sorted(i, j));
      if (taken[e] || i == j) {
        out_.bonds.push_back(static_cast<int>(b));
        continue;
      }
      taken[e] = true;
      const BondType& type = model_.bond_types[model_.bonds[b].type];
      const std::vector<int>* changes = kinds.changed() ? &kinds.changes[kinds.of[b]] : nullptr;
      const auto factor = [&](double Change::*part) {
        return changes ? change_factor(model_, *changes, part, load_factor_).value() : 1.0;
      };
      edges_[e].stiffness = type.stiffness * factor(&Change::bond_stiffness);
      edges_[e].rest_length = type.rest_length * factor(&Change::rest_length);
    }
  }

  // At each end of an edge, 0 or 1 as in pairs_: the edge that an angle joins it to, by which of its ends.
  struct Joint { int edge = -1, end = 0; double stiffness = 0; };
  Joint& joint(int edge, int particle) { return joints_[edge][pairs_[edge][1] == particle]; }

  void join() {
    const Kinds kinds = angle_kinds(model_);
    for (std::size_t a = 0; a < model_.angles.size(); ++a) {
      const auto [i, j, k] = model_.angles[a].particles;
      const int e = straight(model_.angles[a]) ? place(pairs_, sorted(i, j)) : -1;
      const int f = e >= 0 ? place(pairs_, sorted(j, k)) : -1;
      if (e < 0 || joint(e, j).edge >= 0 || joint(f, j).edge >= 0) {
        out_.angles.push_back(static_cast<int>(a));
        continue;
      }
      double B = model_.angle_types[model_.angles[a].type].stiffness;
      if (kinds.changed()) B *= change_factor(model_, kinds.changes[kinds.of[a]], &Change::angle_stiffness, load_factor_).value();
      joint(e, j) = {f, pairs_[f][1] == j, B};
      joint(f, j) = {e, pairs_[e][1] == j, B};
    }
  }

  // One direction along each strand of joined edges: that of its first edge, from the smaller particle to the larger.
  void direct() {
    std::vector<bool> seen(edges_.size());
    for (std::size_t first = 0; first < edges_.size(); ++first) {
      if (seen[first]) continue;
      seen[first] = true;
      for (const int way : {1, 0}) {                              // onwards from its end, then backwards from its beginning
        int e = static_cast<int>(first), end = way;
        for (Joint go = joints_[e][end]; go.edge >= 0 && !seen[go.edge]; go = joints_[e][end]) {
          e = go.edge, end = 1 - go.end;
          seen[e] = true;
          if ((end == 1) != (way == 1)) std::swap(edges_[e].from, edges_[e].to);
        }
      }
    }
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const Joint &at_end = joint(static_cast<int>(e), edges_[e].to), &at_start = joint(static_cast<int>(e), edges_[e].from);
      edges_[e].next = at_end.edge, edges_[e].turn_next = at_end.stiffness;
      edges_[e].before = at_start.edge, edges_[e].turn_before = at_start.stiffness;
    }
  }

  void fill(int count) {
    for (int k = 0; k < count; ++k) {
      Edge e;
      e.filler = true;
      if (!out_.edges.empty() && row_) e.from = out_.edges.back().from + 1, e.to = out_.edges.back().to + 1;
      out_.edges.push_back(e);
    }
  }

  void put(int e) {
    where_[e] = static_cast<int>(out_.edges.size());
    out_.edges.push_back(edges_[e]);
  }

  void lay_out() {
    std::vector<std::pair<Pair, int>> order;
    for (std::size_t e = 0; e < edges_.size(); ++e) order.push_back({{edges_[e].from, edges_[e].to}, static_cast<int>(e)});
    std::sort(order.begin(), order.end());
    const auto following = [&](int e) {
      const Pair wanted{edges_[e].from + 1, edges_[e].to + 1};
      const auto at = std::lower_bound(order.begin(), order.end(), std::pair(wanted, -1));
      return at != order.end() && at->first == wanted ? at->second : -1;
    };
    std::vector<bool> seen(edges_.size());
    std::vector<int> row, single;
    where_.assign(edges_.size(), -1);
    fill(4);
    for (const auto& [pair, first] : order) {
      if (seen[first]) continue;
      row.clear();
      for (int e = first; e >= 0 && !seen[e]; e = following(e)) row.push_back(e), seen[e] = true;
      if (row.size() < shortest_row) {
        single.insert(single.end(), row.begin(), row.end());
        continue;
      }
      row_ = true;
      for (const int e : row) put(e);
      fill(4 - static_cast<int>(row.size()) % 4);
    }
    row_ = false;
    for (const int e : single) put(e);
    fill(4 + (4 - static_cast<int>(out_.edges.size()) % 4) % 4);
    for (Edge& e : out_.edges)
      if (!e.filler)
        for (int* other : {&e.next, &e.before})
          if (*other >= 0) *other = where_[*other];
  }

  const Model& model_;
  double load_factor_;
  EdgeOrder& out_;
  std::vector<Pair> pairs_;                     // ascending, each with the smaller particle first
  std::vector<Edge> edges_;                     // one a pair; `next` and `before` count these until they are laid out
  std::vector<std::array<Joint, 2>> joints_;
  std::vector<int> where_;
  bool row_ = false;                            // fillers go on a row
};

}  // namespace

EdgeOrder order_edges(const Model& model, double load_factor) {
  EdgeOrder order;
  Ordering(model, load_factor, order).run();
  return order;
}

}  // namespace elamin
