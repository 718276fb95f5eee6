#include "lammps/export.hpp"

#include "energy/contact_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace elamin {
namespace {

using Pair = std::array<int, 2>;

/// Neighbours along bonds.
std::vector<std::vector<int>> neighbours(const Model& model) {
  std::vector<std::vector<int>> next(static_cast<std::size_t>(model.particles()));
  for (const Bond& b : model.bonds) next[b.particles[0]].push_back(b.particles[1]), next[b.particles[1]].push_back(b.particles[0]);
  return next;
}

/// visit(j, bonds) for all within `most` bonds of i.
template <class Visit> void around(const std::vector<std::vector<int>>& next, int i, int most, std::vector<int>& seen, const Visit& visit) {
  std::vector<int> front{i}, after;
  seen[i] = i;
  for (int bonds = 1; bonds <= most && !front.empty(); ++bonds) {
    after.clear();
    for (const int p : front)
      for (const int j : next[p])
        if (seen[j] != i) seen[j] = i, after.push_back(j), visit(j, bonds);
    std::swap(front, after);
  }
}

/// Numbers from 0 of equal keys, in the order in which they first occur.
template <class Key> std::vector<int> numbered(const std::vector<Key>& keys) {
  std::map<Key, int> number;
  std::vector<int> of;
  for (const Key& k : keys) of.push_back(number.emplace(k, static_cast<int>(number.size())).first->second);
  return of;
}

/// The glued part of each particle.
std::vector<int> parts(const std::vector<std::vector<int>>& next) {
  std::vector<int> part(next.size(), -1), seen(next.size(), -1);
  for (int i = 0; i < static_cast<int>(next.size()); ++i) {
    if (part[i] >= 0) continue;
    part[i] = i;
    around(next, i, static_cast<int>(next.size()), seen, [&](int j, int) { part[j] = i; });
  }
  return part;
}

class TypeMaker {
 public:
  TypeMaker(const std::vector<const Model*>& stages, int most)
      : stages_(stages), model_(*stages.front()), most_(most), next_(neighbours(model_)) {}

  ExportTypes make() {
    std::vector<std::vector<int>> key(static_cast<std::size_t>(model_.particles()));
    for (std::size_t p = 0; p < key.size(); ++p) key[p] = {model_.type[p]};
    int number = 0;
    for (const Model* m : stages_)
      for (const PairContact& t : m->contacts)
        for (int side = 0; side < 2; ++side, ++number)
          for (const int p : t.particles[side]) key[p].push_back(number);
    class_ = numbered(key);
    for (std::size_t s = 0; s < stages_.size(); ++s) find_left_out(s);
    if (std::any_of(left_out_.begin(), left_out_.end(), [](const auto& pairs) { return !pairs.empty(); })) refine();
    order();
    for (std::size_t s = 0; s < stages_.size(); ++s) rule(s);
    return std::move(types_);
  }

 private:
  using Rule = ExportTypes::Rule;

  /// Which tables speak of two particles, bonds apart.
  Rule tables(std::size_t s, int i, int j) const {
    Rule rule;
    const auto has = [](const std::vector<int>& list, int p) { return std::binary_search(list.begin(), list.end(), p); };
    const std::vector<PairContact>& contacts = stages_[s]->contacts;
    for (int t = 0; t < static_cast<int>(contacts.size()); ++t) {
      const auto& side = contacts[t].particles;
      if ((has(side[0], i) && has(side[1], j)) || (has(side[0], j) && has(side[1], i)))
        (contacts[t].law == PairContact::Law::hertz ? rule.hertz : rule.lj) = t;
    }
    return rule;
  }

  /// Pairs that a table of contact leaves out, and how many bonds those of cohesion do.
  void find_left_out(std::size_t s) {
    const Model& m = *stages_[s];
    types_.stages.emplace_back(), left_out_.emplace_back();
    if (m.contacts.empty()) return;
    const ContactRules rules(m);
    int most = 0;
    for (std::size_t t = 0; t < m.contacts.size(); ++t) most = std::max(most, rules.excluded_bonds(static_cast<int>(t)));
    std::map<Pair, Rule> known;                            // by class
    std::vector<int> seen(next_.size(), -1);
    int least_felt = 1 << 30, most_left_out = 0;           // bonds, of pairs with cohesion
    for (int i = 0; i < m.particles(); ++i)
      around(next_, i, std::max(most, 4), seen, [&](int j, int bonds) {
        if (j < i) return;
        const auto [place, fresh] = known.try_emplace(Pair{class_[i], class_[j]});
        if (fresh) place->second = tables(s, i, j);
        const Rule rule = place->second;
        if (rule.hertz >= 0 && bonds <= rules.excluded_bonds(rule.hertz)) left_out_[s].insert({i, j});
        if (rule.lj < 0) return;
        if (bonds <= rules.excluded_bonds(rule.lj)) most_left_out = std::max(most_left_out, bonds);
        else least_felt = std::min(least_felt, bonds);
      });
    types_.stages[s].special = most_left_out;
    if (most_left_out > 3 || least_felt <= most_left_out)
      types_.refused.push_back(fmt::format("cohesion that leaves out pairs {} bonds apart{}: special_bonds knows 1 to 3, the same of all "
                                           "pairs", most_left_out,
                                           least_felt <= most_left_out ? " of some groups and not of others" : ""));
  }

  /// Classes in which all pairs are left out, or none.
  void refine() {
    const std::vector<int> part = parts(next_);
    std::set<int> concerned;
    for (const auto& pairs : left_out_)
      for (const Pair& p : pairs) concerned.insert(class_[p[0]]), concerned.insert(class_[p[1]]);
    std::vector<Pair> key;
    for (std::size_t p = 0; p < class_.size(); ++p) key.push_back({class_[p], concerned.count(class_[p]) ? part[p] : 0});
    class_ = numbered(key);
    std::map<int, long> members;
    for (const int c : class_) ++members[c];
    std::set<int> mixed;
    for (const auto& pairs : left_out_) {
      std::map<Pair, long> count;                          // of pairs of two classes
      for (const Pair& p : pairs) {
        Pair c{class_[p[0]], class_[p[1]]};
        std::sort(c.begin(), c.end());
        ++count[c];
      }
      for (const auto& [c, n] : count)
        if (n != (c[0] == c[1] ? members[c[0]] * (members[c[0]] - 1) / 2 : members[c[0]] * members[c[1]]))
          mixed.insert(c[0]), mixed.insert(c[1]);
    }
    long alone = 0;
    for (const int c : mixed) alone += members[c];
    if (alone + static_cast<long>(members.size() - mixed.size()) > most_) {
      types_.refused.push_back(fmt::format("contact of {} particles that leaves out pairs that are glued closely: LAMMPS's granular style "
                                           "does not know bonds, and a type for each of so many is too much (at most {})", alone, most_));
      for (auto& pairs : left_out_) pairs.clear();
      return;
    }
    for (std::size_t p = 0; p < class_.size(); ++p) key[p] = {class_[p], mixed.count(class_[p]) ? static_cast<int>(p) + 1 : 0};
    class_ = numbered(key);
  }

  /// Types from classes: in the order of the model's types, so that these stay where each is one class.
  void order() {
    const int classes = class_.empty() ? 0 : *std::max_element(class_.begin(), class_.end()) + 1;
    std::vector<int> first(classes, -1), by(classes), rank(classes);
    for (int p = static_cast<int>(class_.size()) - 1; p >= 0; --p) first[class_[p]] = p;
    std::iota(by.begin(), by.end(), 0);
    const auto place = [&](int c) { return std::pair(model_.type[first[c]], first[c]); };
    std::stable_sort(by.begin(), by.end(), [&](int a, int b) { return place(a) < place(b); });
    for (int k = 0; k < classes; ++k) rank[by[k]] = k, first_.push_back(first[by[k]]);
    for (const int c : class_) types_.type.push_back(rank[c] + 1);
    types_.count = classes;
  }

  void rule(std::size_t s) {
    std::vector<Rule>& rules = types_.stages[s].rules;
    const int n = types_.count;
    rules.assign(static_cast<std::size_t>(n) * static_cast<std::size_t>(n), {});
    if (stages_[s]->contacts.empty()) return;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b) {
        Rule rule = tables(s, first_[a], first_[b]);
        if (rule.hertz >= 0 && stages_[s]->contacts[rule.hertz].effective_modulus == 0) rule.hertz = -1;
        rules[a * n + b] = rule;
      }
    for (const Pair& p : left_out_[s])
      for (const Pair q : {p, Pair{p[1], p[0]}}) rules[(types_.type[q[0]] - 1) * n + types_.type[q[1]] - 1].hertz = -1;
  }

  const std::vector<const Model*>& stages_;
  const Model& model_;
  int most_;
  std::vector<std::vector<int>> next_;
  std::vector<int> class_, first_;
  std::vector<std::set<Pair>> left_out_;   // of each stage
  ExportTypes types_;
};

}  // namespace

ExportTypes export_types(const std::vector<const Model*>& stages, int most) { return TypeMaker(stages, most).make(); }

}  // namespace elamin
