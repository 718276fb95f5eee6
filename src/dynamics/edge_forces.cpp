#include "dynamics/edge_forces.hpp"

#include "core/find.hpp"
#include "energy/changes.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/harmonic_bond.hpp"

#include <algorithm>
#include <map>

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

namespace {
constexpr int stretch = 64;                    // blocks of edges
}

EdgeForces::EdgeForces(const EdgeOrder& order, int particles) : edges_(static_cast<int>(order.edges.size())) {
  build_blocks(order);
  build_pulls(order, particles);
  a_ = Columns(edges_), e_ = Columns(edges_);
  inverse_.resize(padded(edges_)), pull_.resize(padded(edges_));
}

void EdgeForces::build_blocks(const EdgeOrder& order) {
  std::map<std::array<double, 16>, int> known;
  for (const Edge& e : order.edges) {
    from_.push_back(e.from), to_.push_back(e.to);
    next_.push_back(std::max(e.next, 0)), before_.push_back(std::max(e.before, 0));
  }
  for (int o = 0; o < edges_; o += 4) {
    const Edge* e = &order.edges[o];
    // The first of four that follow each other, where those that `counts` leaves out may be anything.
    const auto base = [&](const std::vector<int>& list, const auto& counts) {
      int first = -1;
      for (int k = 0; k < 4; ++k) {
        if (!counts(e[k])) continue;
        if (first < 0) first = list[o + k] - k;
        if (first < 0 || list[o + k] != first + k) return -1;
      }
      return std::max(first, 0);
    };
    Block b;
    b.from = base(from_, [](const Edge&) { return true; }), b.to = base(to_, [](const Edge&) { return true; });
    if (b.from < 0 || b.to < 0) b.from = b.to = -1;
    b.next = base(next_, [](const Edge& s) { return s.next >= 0; });
    b.before = base(before_, [](const Edge& s) { return s.before >= 0; });
    b.turns_next = std::any_of(e, e + 4, [](const Edge& s) { return s.turn_next != 0; });
    b.turns_before = std::any_of(e, e + 4, [](const Edge& s) { return s.turn_before != 0; });
    std::array<double, 16> all;
    for (int k = 0; k < 4; ++k)
      all[k] = e[k].stiffness, all[4 + k] = e[k].rest_length, all[8 + k] = e[k].turn_next, all[12 + k] = e[k].turn_before;
    const auto [at, fresh] = known.try_emplace(all, static_cast<int>(numbers_.size()));
    if (fresh) numbers_.push_back({Lanes::load(&all[0]), Lanes::load(&all[4]), Lanes::load(&all[8]), Lanes::load(&all[12])});
    b.numbers = at->second;
    b.found = o / 4 + 1;
    for (int k = 0; k < 4; ++k) b.found = std::max({b.found, next_[o + k] / 4 + 1, before_[o + k] / 4 + 1});
    if (!blocks_.empty()) b.found = std::max(b.found, blocks_.back().found);
    blocks_.push_back(b);
  }
}

void EdgeForces::build_pulls(const EdgeOrder& order, int particles) {
  struct Term { int edge, in; auto operator<=>(const Term&) const = default; };
  std::vector<std::vector<Term>> of(padded(particles));
  for (int e = 0; e < edges_; ++e) {
    if (order.edges[e].filler) continue;
    of[order.edges[e].from].push_back({e, 0}), of[order.edges[e].to].push_back({e, 1});
  }
  const auto holds = [](const std::vector<Term>& list, const Term& t) { return contains(list, t); };
  int pulled = 0;
  for (int p = 0; p < particles; p += 4) {
    std::array<std::vector<int>, 3> terms;
    for (int lane = 0; lane < 4; ++lane)
      for (const Term& t : of[p + lane]) pulled = std::max(pulled, t.edge / 4 + 1);
    for (int lane = 0; lane < 4; ++lane)
      while (!of[p + lane].empty()) {
        const Term t = of[p + lane].front();
        const int first = t.edge - lane;
        int members = 0;
        bool whole = first >= 0 && first + 4 <= edges_;
        for (int k = 0; k < 4 && whole; ++k) {
          const bool member = holds(of[p + k], {first + k, t.in});
          members += member;
          whole = member || order.edges[first + k].filler;
        }
        if (whole && members > 1) {
          terms[t.in].push_back(first);
          for (int k = 0; k < 4; ++k) std::erase(of[p + k], Term{first + k, t.in});
        } else {
          terms[2].push_back(8 * t.edge + 2 * lane + t.in);
          std::erase(of[p + lane], t);
        }
      }
    pulls_.push_back({static_cast<int>(terms_.size()), pulled, static_cast<short>(terms[0].size()), static_cast<short>(terms[1].size()),
                      static_cast<short>(terms[2].size())});
    for (const auto& kind : terms) terms_.insert(terms_.end(), kind.begin(), kind.end());
  }
  terms_.push_back(0);
}

Triple<Lanes> EdgeForces::direction(int base, const std::vector<int>& list, int edge) const {
  if (base >= 0) return a_.load(base);
  const int* i = &list[edge];
  return {Lanes::gather(a_.x.data(), i), Lanes::gather(a_.y.data(), i), Lanes::gather(a_.z.data(), i)};
}

// In stretches: what is written must have left the processor's store buffer before it is read with a shift.
[[gnu::flatten]] void EdgeForces::go_on(const Columns& x, int pulled) {
  const int blocks = static_cast<int>(blocks_.size()), to = std::min(blocks, std::max(pulled, pulled_ + stretch));
  if (const int found = blocks_[to - 1].found; found_ < found)
    for (const int end = std::min(blocks, found + stretch); found_ < end; ++found_) find(x, found_);
  for (; pulled_ < to; ++pulled_) pull(pulled_);
}

// Directions, lengths and tensions of four edges.
void EdgeForces::find(const Columns& x, int block) {
  const Block& b = blocks_[block];
  const int o = 4 * block;
  Triple<Lanes> u;
  if (b.from >= 0) {
    u = x.load(b.to) - x.load(b.from);
  } else {
    const int *i = &from_[o], *j = &to_[o];
    u = {Lanes::gather(x.x.data(), j) - Lanes::gather(x.x.data(), i), Lanes::gather(x.y.data(), j) - Lanes::gather(x.y.data(), i),
         Lanes::gather(x.z.data(), j) - Lanes::gather(x.z.data(), i)};
  }
  const Lanes r = sqrt(dot(u, u)), inv = inverse(r);
  a_.store(o, inv * u);
  inv.store(&inverse_[o]);
  HarmonicBond::pull(r, numbers_[b.numbers].K, numbers_[b.numbers].r0).store(&pull_[o]);
}

// Their e.
void EdgeForces::pull(int block) {
  const Block& b = blocks_[block];
  const int o = 4 * block;
  const Triple<Lanes> a = a_.load(o);
  const Lanes inv = Lanes::load(&inverse_[o]);
  Triple<Lanes> e = Lanes::load(&pull_[o]) * a;
  if (b.turns_next) e = multiply_add(-(numbers_[b.numbers].next * inv), CosineAngle::across(a, direction(b.next, next_, o)), e);
  if (b.turns_before) e = multiply_add(-(numbers_[b.numbers].before * inv), CosineAngle::across(a, direction(b.before, before_, o)), e);
  e_.store(o, e);
}

Triple<Lanes> EdgeForces::single(int term) const {
  const int edge = term / 8, lane = term / 2 % 4;
  const double sign = term % 2 ? -1 : 1;
  Triple<Lanes> f{0.0, 0.0, 0.0};
  f.x.v[lane] = sign * e_.x[edge], f.y.v[lane] = sign * e_.y[edge], f.z.v[lane] = sign * e_.z[edge];
  return f;
}

}  // namespace elamin
