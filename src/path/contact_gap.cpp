#include "path/contact_gap.hpp"

#include "energy/body_touches.hpp"
#include "energy/wall_group.hpp"
#include "model/entities.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace elamin {

double gap(const Energy& energy, const ContactKey& key, const State& state) {
  if (key.feature < 0) return energy.gap(key.particle, key.other, key.wall, state);
  const std::optional<Touch> touch = body_touch(energy.model(), energy.body_rules(), touch_key(key), state);
  if (!touch) return std::numeric_limits<double>::infinity();
  return touch->gap - (key.within_cutoff ? attraction_range(energy.model(), energy.body_rules(), touch_key(key)) : 0.0);
}

double coordinate_rounding(const ContactKey& key, const State& state) {
  return key.wall < 0 || key.feature >= 0 ? 0.0 : 4 * epsilon * state.at(key.particle).hi.norm();
}

State moved_by(const Kinematics& kinematics, const State& from, const Vector& way, double load_change, double part) {
  State state = from;
  kinematics.prescribe(state, from.load_factor + part * load_change);
  kinematics.retract(state, way, part);
  return state;
}

namespace {

// The direction in which a gap grows: of a contact of bodies with its point, of particles at their centres.
bool normal_of(const Energy& energy, const ContactKey& key, const State& state, Vec3& normal, Vec3& point) {
  const Model& model = energy.model();
  if (key.feature >= 0) {
    const std::optional<Touch> touch = body_touch(model, energy.body_rules(), touch_key(key), state);
    if (touch) normal = touch->normal, point = touch->point;
    return touch.has_value();
  }
  if (key.wall < 0) {
    normal = (state.at(key.particle) - state.at(key.other)).hi.normalized();
    return normal.allFinite();
  }
  std::array<WallTouch, WallContact::most_faces> faces;
  constexpr double anywhere = std::numeric_limits<double>::infinity();
  const int n = wall_at(model.walls[key.wall], state.load_factor).touches(state.at(key.particle), model.diameter[key.particle] / 2, anywhere, faces);
  const auto nearest = std::min_element(faces.begin(), faces.begin() + n, [](const WallTouch& s, const WallTouch& t) { return s.gap < t.gap; });
  if (n > 0) normal = nearest->normal;
  return n > 0;
}

}  // namespace

bool slope(const Energy& energy, const ContactKey& key, const State& state, double load_change, Vector& row, double& by_load) {
  const Kinematics& kinematics = energy.kinematics();
  const Model& model = energy.model();
  Vec3 normal, point;
  if (!normal_of(energy, key, state, normal, point)) return false;
  Field g = Field::Zero(3, kinematics.sites());
  const auto push = [&](int body, const Vec3& at, double sign) {
    g.col(kinematics.place_of(body)) += sign * normal;
    g.col(kinematics.rotation_of(body)) += sign / kinematics.characteristic_length(body) * (at - state.bodies[body].position.hi).cross(normal);
  };
  const auto add = [&](int entity, double sign) {
    if (is_body(model, entity)) return push(entity - model.particles(), key.feature >= 0 ? point : Vec3(state.position.col(entity)), sign);
    const auto glued = std::find_if(model.glued.begin(), model.glued.end(), [&](const Glued& u) { return u.particle == entity; });
    if (glued != model.glued.end()) return push(glued->body, state.position.col(entity), sign);
    g.col(entity) += sign * normal;
  };
  add(key.particle, 1);
  if (key.other >= 0) add(key.other, -1);
  by_load = 0;
  for (int s = 0; s < kinematics.sites(); ++s) by_load += g.col(s).dot(kinematics.drive(s));
  if (key.wall >= 0 && load_change != 0) {                      // a gap is linear in how far a wall has moved, and none beyond a centre
    const auto rate = [&](double change) {
      State moved = state;
      moved.load_factor += change;
      return (gap(energy, key, moved) - gap(energy, key, state)) / change;
    };
    const double onward = rate(load_change);
    by_load += std::isfinite(onward) ? onward : rate(-load_change);
  }
  row = kinematics.restrict(g);
  return row.allFinite() && std::isfinite(by_load);
}

double borne(Energy& energy, const ContactKey& key, const State& state) { return borne(energy, key, energy.touches(state)); }

double borne(const Energy& energy, const ContactKey& key, const std::vector<Touch>& touches) {
  for (const Touch& t : touches)
    if (t.gap < 0 && t.key() == touch_key(key)) return t.force.norm() / std::max(energy.force_scale(), std::numeric_limits<double>::min());
  return -1;
}

}  // namespace elamin
