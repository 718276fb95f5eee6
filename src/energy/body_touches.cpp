#include "energy/body_touches.hpp"

#include "core/near_pairs.hpp"
#include "energy/body_groups.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

std::vector<IndexPair> candidates(const Model& model, const BodyRules& rules, const State& state, double within) {
  const auto feel = [&](int i, int j) {
    const int t = rules.table(i, j);
    return t >= 0 && model.rounded[t].formulation != RoundedFormulation::lammps;
  };
  std::vector<IndexPair> pairs;
  if (!rules.any()) return pairs;
  if (std::isfinite(within)) {
    Field x(3, rules.entities());
    std::vector<double> radii(rules.entities(), 0.0);
    for (int e = 0; e < rules.entities(); ++e) {
      x.col(e) = rules.position(e, state);
      if (rules.cutoff_radius(e) > 0) radii[e] = (rules.cutoff_radius(e) + within / 2) * (1 + 1e-12);
    }
    return near_pairs(x, radii, feel);
  }
  for (int i = 0; i < rules.entities(); ++i)
    for (int j = std::max(i + 1, rules.particles()); j < rules.entities(); ++j)
      if (feel(i, j)) pairs.push_back({i, j});
  return pairs;
}

int feature_of(const RoundedPair& table, const RoundedContact& c, const RoundedBody& b) {
  if (table.formulation == RoundedFormulation::closest) return 0;
  if (c.first.kind == FeatureKind::vertex) return 3 * c.first.index;
  if (c.second.kind == FeatureKind::vertex) return 3 * c.second.index + 1;
  return 3 * (c.first.index * static_cast<int>(b.shape->edges.size()) + c.second.index) + 2;
}

Touch touch_of(int i, int j, int feature, const RoundedContact& c) {
  Touch t{.particle = i, .other = j, .gap = c.gap, .point = c.point, .feature = feature, .normal = c.normal};
  return t;
}

Touch touch_of(int entity, int wall, const RoundedWallTouch& w) {
  Touch t{.particle = entity, .wall = wall, .gap = w.gap, .point = w.point, .feature = 8 * w.vertex + w.face, .normal = w.normal};
  return t;
}

RoundedPair seen_from(RoundedPair table, double within) {
  table.kernel.cutoff = std::max(table.kernel.cutoff, within);
  return table;
}

// Negative zeros and contacts that only touch bear no force.
Vec3 along(double force, const Vec3& normal) { return force == 0 ? Vec3(Vec3::Zero()) : Vec3(force * normal); }

bool attracts(const RoundedKernel& kernel, double gap) { return kernel.attraction != 0 && gap >= 0 && gap < kernel.cutoff; }

}  // namespace

void add_body_touches(const Model& model, const BodyRules& rules, const State& state, double within, std::vector<Touch>& touches) {
  const auto take = [&](Touch t, const RoundedKernel& kernel, double weight = 1, const Vec3& gate = Vec3::Zero()) {
    t.attracts = attracts(kernel, t.gap);
    if (!(t.gap < 0 || t.attracts || (within > 0 && t.gap <= within))) return;
    t.force = along(-weight * kernel.slope(t.gap), t.normal) + kernel.value(t.gap) * gate;
    touches.push_back(t);
  };
  std::vector<RoundedContact> contacts;
  for (const auto& [i, j] : candidates(model, rules, state, within)) {
    const RoundedPair& table = model.rounded[rules.table(i, j)];
    const RoundedBody a = rules.body(i, state), b = rules.body(j, state);
    contacts.clear();
    rounded_contacts(seen_from(table, within), a, b, contacts);
    for (const RoundedContact& c : contacts) take(touch_of(i, j, feature_of(table, c, b), c), table.kernel, c.weight, c.gate);
  }
  std::vector<RoundedWallTouch> at_wall;
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    const Wall& wall = model.walls[w];
    if (wall.lammps) continue;
    RoundedWall law = rounded_wall_at(wall, state.load_factor);
    law.kernel.cutoff = std::max(law.kernel.cutoff, within);
    for (const int b : wall.bodies) {
      at_wall.clear();
      law.touches(model.body(b, state), at_wall);
      for (const RoundedWallTouch& t : at_wall) take(touch_of(model.particles() + b, static_cast<int>(w), t), wall.kernel);
    }
  }
}

std::optional<Touch> body_touch(const Model& model, const BodyRules& rules, const TouchKey& key, const State& state) {
  if (key.wall >= 0) {
    RoundedWall law = rounded_wall_at(model.walls[key.wall], state.load_factor);
    law.kernel.cutoff = infinity;
    std::vector<RoundedWallTouch> at_wall;
    law.touches(model.body(key.particle - model.particles(), state), at_wall);
    for (const RoundedWallTouch& t : at_wall)
      if (8 * t.vertex + t.face == key.feature) return touch_of(key.particle, key.wall, t);
    return {};
  }
  const RoundedPair table = seen_from(model.rounded[rules.table(key.particle, key.other)], infinity);
  const RoundedBody a = rules.body(key.particle, state), b = rules.body(key.other, state);
  if (table.formulation == RoundedFormulation::closest) {
    std::vector<RoundedContact> contacts;
    rounded_contacts(table, a, b, contacts);
    if (contacts.empty()) return {};
    return touch_of(key.particle, key.other, 0, contacts.front());
  }
  PairView view;
  if (!view.set(a, b, infinity)) return {};
  const int kind = key.feature % 3, index = key.feature / 3;
  if (kind < 2) {
    const bool first = kind == 0;
    return touch_of(key.particle, key.other, key.feature, view.vertex_contact(first, index, view.seen(first).distance(index), 1));
  }
  const int edges = static_cast<int>(b.shape->edges.size());
  const LinePair lines = view.lines(index / edges, index % edges);
  if (!lines.within()) return {};
  return touch_of(key.particle, key.other, key.feature, view.edge_contact(index / edges, index % edges, lines, 1));
}

double attraction_range(const Model& model, const BodyRules& rules, const TouchKey& key) {
  const RoundedKernel& kernel = key.wall >= 0 ? model.walls[key.wall].kernel : model.rounded[rules.table(key.particle, key.other)].kernel;
  return kernel.attraction != 0 ? kernel.cutoff : 0;
}

}  // namespace elamin
