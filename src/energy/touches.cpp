#include "energy/touches.hpp"

#include "energy/body_touches.hpp"
#include "energy/groups.hpp"
#include "energy/hard_gaps.hpp"
#include "energy/wall_group.hpp"
#include "laws/hertz_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace elamin {

namespace {

std::vector<IndexPair> candidates(const Model& model, const Neighbours& neighbours, const State& state, double within) {
  std::vector<IndexPair> pairs;
  if (neighbours.covers(state, within)) {
    pairs = neighbours.hertz();
    pairs.insert(pairs.end(), neighbours.hard().begin(), neighbours.hard().end());
    return pairs;
  }
  const ContactRules& rules = neighbours.rules();
  const auto feel = [&](int i, int j) { return rules.hertz(i, j) >= 0; };
  if (std::isfinite(within)) {
    std::vector<double> radii(model.particles(), 0.0);
    for (int i = 0; i < model.particles(); ++i)
      if (rules.cutoff_radius(i) > 0) radii[i] = (model.diameter[i] + within) / 2 * (1 + 1e-12);
    return near_pairs(state.position, radii, feel);
  }
  for (int i = 0; i < model.particles(); ++i)
    for (int j = i + 1; j < model.particles(); ++j)
      if (feel(i, j)) pairs.push_back({i, j});
  return pairs;
}

// Hard contacts: closed where they bear a force, or overlap by more than rounding.
class HardTouches {
 public:
  HardTouches(const Model& model, const State& state) : model_(model), state_(state), forces_(state.hard) {
    std::sort(forces_.begin(), forces_.end(), before);
  }

  double slack(int particle) const { return 1e-12 * model_.diameter[particle]; }

  /// Those that bear a force …
  void add_bearing(std::vector<Touch>& touches) const {
    HardGap gap;
    for (const HardForce& h : forces_)
      if (h.force > 0 && hard_gap(model_, h, state_, gap))
        touches.push_back({h.particle, h.other, h.wall, gap.value, h.force * gap.gradient.head<3>(), gap.point, true});
  }

  /// … and another one, if it is near enough.
  void add(const HardForce& at, double within, std::vector<Touch>& touches) const {
    const auto found = std::lower_bound(forces_.begin(), forces_.end(), at, before);
    if (found != forces_.end() && key(*found) == key(at) && found->force > 0) return;
    HardGap gap;
    if (hard_gap(model_, at, state_, gap) && (gap.value < -slack(at.particle) || (within > 0 && gap.value <= within)))
      touches.push_back({at.particle, at.other, at.wall, gap.value, Vec3::Zero(), gap.point});
  }

 private:
  static bool before(const HardForce& a, const HardForce& b) { return key(a) < key(b); }
  const Model& model_;
  const State& state_;
  std::vector<HardForce> forces_;
};

Touch between(const Model& model, const HertzContact& law, int i, int j, const State& state) {
  const Points<2> x = points<2>(state, {i, j});
  Touch t{i, j, -1, law.gap(x), Vec3::Zero(), Vec3::Zero()};
  const Vec3 d = x.edge(0, 1).hi;
  const double r = d.norm();
  const Vec3 n = r > 0 ? Vec3(d / r) : Vec3(Vec3::Zero());
  if (t.gap < 0) t.force = -law.force(t.gap) * n;
  t.point = state.position.col(i) + (model.diameter[i] / 2 + t.gap / 2) * n;
  return t;
}

}  // namespace

double pair_gap(const Model& model, int i, int j, const State& state) {
  return HertzContact{0, (model.diameter[i] + model.diameter[j]) / 2}.gap(points<2>(state, {i, j}));
}

double wall_gap(const Model& model, int particle, int wall, const State& state) {
  std::array<WallTouch, WallContact::most_faces> faces;
  constexpr double anywhere = infinity;
  const int n = wall_at(model.walls[wall], state.load_factor).touches(state.at(particle), model.diameter[particle] / 2, anywhere, faces);
  double least = anywhere;
  for (int k = 0; k < n; ++k) least = std::min(least, faces[k].gap);
  return least;
}

std::vector<Touch> find_touches(const Model& model, const Neighbours& neighbours, const BodyRules& body_rules, const State& state, double within) {
  const ContactRules& rules = neighbours.rules();
  std::vector<Touch> touches;
  within = std::max(within, 0.0);
  const auto near = [&](double gap) { return gap < 0 || (gap <= within && within > 0); };
  const HardTouches hard(model, state);
  hard.add_bearing(touches);
  if (rules.any())
    for (const auto& [i, j] : candidates(model, neighbours, state, within)) {
      const int table = rules.hertz(i, j);
      if (model.contacts[table].hard) {
        hard.add({i, j, -1, -1, 0}, within, touches);
        continue;
      }
      if (model.contacts[table].effective_modulus == 0) continue;
      const Touch t = between(model, hertz_contact(model, table, i, j), i, j, state);
      if (near(t.gap)) touches.push_back(t);
    }
  for (std::size_t w = 0; w < model.walls.size(); ++w) {
    const WallContact wall = wall_at(model.walls[w], state.load_factor);
    std::array<WallTouch, WallContact::most_faces> faces;
    for (const int p : model.walls[w].particles) {
      const int n = wall.touches(state.at(p), model.diameter[p] / 2, model.walls[w].hard ? std::max(within, hard.slack(p)) : within, faces);
      if (model.walls[w].hard) {
        for (int k = 0; k < n; ++k) hard.add({p, -1, static_cast<int>(w), faces[k].face, 0}, within, touches);
        continue;
      }
      for (int k = 0; k < n; ++k)
        if (near(faces[k].gap))
          touches.push_back({p, -1, static_cast<int>(w), faces[k].gap, faces[k].force * faces[k].normal, faces[k].point});
    }
  }
  add_body_touches(model, body_rules, state, within, touches);
  std::stable_sort(touches.begin(), touches.end(), [](const Touch& a, const Touch& b) {
    return std::array{a.wall, a.particle, a.other} < std::array{b.wall, b.particle, b.other};
  });
  return touches;
}

}  // namespace elamin
