#include "energy/changes.hpp"

#include <algorithm>
#include <map>

namespace elamin {

namespace {

// `acts`: whether a change is of any use to elements of this sort.
template <class Element, class Acts>
Kinds kinds(const Model& model, const std::vector<Element>& elements, std::size_t types, const Acts& acts) {
  Kinds all;
  for (std::size_t t = 0; t < types; ++t) all.type.push_back(static_cast<int>(t));
  all.changes.resize(types), all.of.reserve(elements.size());
  std::vector<std::pair<int, std::vector<bool>>> members;       // of the changes that act
  for (std::size_t c = 0; c < model.changes.size(); ++c) {
    if (!acts(model.changes[c])) continue;
    auto& member = members.emplace_back(static_cast<int>(c), std::vector<bool>(model.particles())).second;
    for (const int p : model.changes[c].particles) member[p] = true;
  }
  std::map<std::pair<int, std::vector<int>>, int> known;
  for (const Element& e : elements) {
    std::vector<int> on;
    for (const auto& [change, member] : members)
      if (std::all_of(e.particles.begin(), e.particles.end(), [&in = member](int p) { return in[p]; })) on.push_back(change);
    if (on.empty()) {
      all.of.push_back(e.type);
      continue;
    }
    const auto [at, is_new] = known.try_emplace({e.type, on}, static_cast<int>(all.type.size()));
    if (is_new) all.type.push_back(e.type), all.changes.push_back(std::move(on));
    all.of.push_back(at->second);
  }
  return all;
}

}  // namespace

Kinds bond_kinds(const Model& model) {
  return kinds(model, model.bonds, model.bond_types.size(), [](const Change& c) { return c.rest_length != 0 || c.bond_stiffness != 0; });
}

Kinds angle_kinds(const Model& model) {
  return kinds(model, model.angles, model.angle_types.size(), [](const Change& c) { return c.angle_stiffness != 0; });
}

Exact change_factor(const Model& model, const std::vector<int>& changes, double Change::*part, double load_factor) {
  Exact factor{1};
  for (const int c : changes) {
    const Scaling& s = model.changes[c].scaling;
    factor = factor + (two_product(s.rate, load_factor) + s.fixed) * Exact{model.changes[c].*part};
  }
  return factor;
}

double change_rate(const Model& model, const std::vector<int>& changes, double Change::*part) {
  double rate = 0;
  for (const int c : changes) rate += model.changes[c].scaling.rate * (model.changes[c].*part);
  return rate;
}

}  // namespace elamin
