#include "energy/contact_rules.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace elamin {

namespace {

constexpr int far_apart = std::numeric_limits<int>::max();
constexpr int most_bonds = 100;        // along a chain; beyond it, particles that overlap at rest are told apart by hand

// Breadth-first walks along the bonds, to particles with larger and smaller index alike.
class Walk {
 public:
  explicit Walk(const Model& model) : seen_(model.particles(), -1), start_(model.particles() + 1) {
    for (const Bond& b : model.bonds)
      for (const int p : b.particles) ++start_[p + 1];
    for (std::size_t p = 1; p < start_.size(); ++p) start_[p] += start_[p - 1];
    next_.resize(start_.back());
    std::vector<std::int64_t> place(start_.begin(), start_.end() - 1);
    for (const Bond& b : model.bonds) {
      const double length = model.bond_types[b.type].rest_length;
      next_[place[b.particles[0]]++] = {b.particles[1], length};
      next_[place[b.particles[1]]++] = {b.particles[0], length};
    }
  }

  /// visit(particle, bonds, rest length of the way there) for all within `bonds` of `from`, nearest first.
  template <class Visit>
  void from(int from, int bonds, const Visit& visit) {
    front_.assign(1, {from, 0.0});
    seen_[from] = from;
    for (int k = 1; k <= bonds && !front_.empty(); ++k) {
      after_.clear();
      for (const Step& s : front_)
        for (std::int64_t e = start_[s.particle]; e < start_[s.particle + 1]; ++e)
          if (seen_[next_[e].particle] != from) {
            seen_[next_[e].particle] = from;
            after_.push_back({next_[e].particle, s.length + next_[e].length});
            visit(next_[e].particle, k, after_.back().length);
          }
      std::swap(front_, after_);
    }
  }

 private:
  struct Step { int particle; double length; };
  std::vector<int> seen_;
  std::vector<std::int64_t> start_;
  std::vector<Step> next_, front_, after_;
};

// The structure that built each particle at rest, −1: its state comes from a file.
std::vector<int> built_by(const Model& model) {
  std::vector<int> of(model.particles(), -1);
  for (std::size_t s = 0; s < model.structures.size(); ++s)
    if (model.structures[s].kind != "lammps")
      std::fill_n(of.begin() + model.structures[s].first, model.structures[s].count, static_cast<int>(s));
  return of;
}

}  // namespace

ContactRules::ContactRules(const Model& model) : any_(!model.contacts.empty()), cutoff_radius_(model.particles(), 0.0) {
  if (!any_) return;
  classify(model);
  for (const PairContact& t : model.contacts)
    for (const auto& side : t.particles)
      for (const int p : side)
        cutoff_radius_[p] = std::max(cutoff_radius_[p], t.law == PairContact::Law::hertz ? model.diameter[p] / 2 : t.cutoff / 2);
  exclude(model);
}

void ContactRules::classify(const Model& model) {
  std::vector<std::vector<int>> member(model.particles());      // 2 table + side, ascending
  for (std::size_t t = 0; t < model.contacts.size(); ++t)
    for (int side = 0; side < 2; ++side)
      for (const int p : model.contacts[t].particles[side]) member[p].push_back(2 * static_cast<int>(t) + side);
  std::map<std::vector<int>, int> number;
  class_.resize(model.particles());
  for (int p = 0; p < model.particles(); ++p)
    class_[p] = number.emplace(std::move(member[p]), static_cast<int>(number.size())).first->second;
  classes_ = number.size();
  hertz_.assign(classes_ * classes_, -1);
  lj_.assign(classes_ * classes_, -1);
  for (const auto& [a, i] : number)
    for (const auto& [b, j] : number)
      for (const int m : a)                                     // sides m of a table and its partner of the other class
        if (std::binary_search(b.begin(), b.end(), m ^ 1)) {
          std::vector<int>& tables = model.contacts[m / 2].law == PairContact::Law::hertz ? hertz_ : lj_;
          tables[i * classes_ + j] = std::max(tables[i * classes_ + j], m / 2);
        }
}

void ContactRules::exclude(const Model& model) {
  Walk walk(model);
  const std::vector<int> built = built_by(model);
  excluded_.assign(model.contacts.size(), 1);
  bool open = false;                                            // some table asks for the default
  for (std::size_t t = 0; t < model.contacts.size(); ++t) {
    excluded_[t] = model.contacts[t].exclude_bonds.value_or(1);
    open = open || (!model.contacts[t].exclude_bonds && model.contacts[t].law == PairContact::Law::hertz);
  }
  for (int depth = 2; open && depth <= most_bonds; ++depth) {    // one more bond as long as something overlaps there
    open = false;
    for (int i = 0; i < model.particles(); ++i) {
      if (cutoff_radius_[i] == 0) continue;
      walk.from(i, depth, [&](int j, int bonds, double length) {
        if (bonds < depth || j < i) return;
        const int t = hertz_[class_[i] * classes_ + class_[j]];
        if (t < 0 || model.contacts[t].exclude_bonds || excluded_[t] < depth - 1) return;
        const double rho = (model.diameter[i] + model.diameter[j]) / 2;
        const double apart = built[i] >= 0 && built[i] == built[j] ? (model.start.at(j) - model.start.at(i)).hi.norm() : length;
        if (std::min(apart, length) < (1 - 1e-9) * rho) excluded_[t] = depth, open = true;
      });
    }
  }
  const int deepest = *std::max_element(excluded_.begin(), excluded_.end());
  start_.assign(1, 0);
  for (int i = 0; i < model.particles(); ++i) {
    if (cutoff_radius_[i] > 0) walk.from(i, deepest, [&](int j, int bonds, double) { near_.push_back({j, bonds}); });
    std::sort(near_.begin() + start_.back(), near_.end(), [](const Near& a, const Near& b) { return a.particle < b.particle; });
    start_.push_back(static_cast<std::int64_t>(near_.size()));
  }
}

int ContactRules::bonds_apart(int i, int j) const {
  const auto first = near_.begin() + start_[i], last = near_.begin() + start_[i + 1];
  const auto found = std::lower_bound(first, last, j, [](const Near& n, int particle) { return n.particle < particle; });
  return found != last && found->particle == j ? found->bonds : far_apart;
}

}  // namespace elamin
