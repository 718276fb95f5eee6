#include "path/contact_event.hpp"

#include "energy/body_touches.hpp"
#include "model/entities.hpp"
#include "path/root.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace elamin {

namespace {

constexpr double together = 1e-10;            // of the size: gaps that vanish at one load factor
constexpr double beside = 1e-9;               // of the size: where one side of a corner is looked at

std::vector<ContactKey> difference(const ContactSet& a, const ContactSet& b) {
  std::vector<ContactKey> keys;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(keys));
  return keys;
}

void toggle(ContactSet& set, const ContactKey& key) {
  if (!set.erase(key)) set.insert(key);
}

std::string told(const Model& model, const ContactKey& key, bool made) {
  const std::string one = called(model, key.particle);
  const std::string verb = key.reach ? (made ? " comes within reach of " : " leaves the reach of ") : made ? " touches " : " leaves ";
  return one + verb + (key.wall >= 0 ? "wall " + model.walls[key.wall].name : called(model, key.other));
}

TouchKey touch_key(const ContactKey& key) { return {key.particle, key.other, key.wall, key.feature}; }

double gap(const Energy& energy, const ContactKey& key, const State& state) {
  if (key.feature < 0) return energy.gap(key.particle, key.other, key.wall, state);
  const std::optional<Touch> touch = body_touch(energy.model(), energy.body_rules(), touch_key(key), state);
  if (!touch) return std::numeric_limits<double>::infinity();
  return touch->gap - (key.reach ? attraction_range(energy.model(), energy.body_rules(), touch_key(key)) : 0.0);
}

// What is moved by a part of the way, prescribed coordinates by their part of the change of the load factor.
State moved_by(const Kinematics& kinematics, const State& from, const Vector& way, double load_change, double part) {
  State state = from;
  kinematics.prescribe(state, from.load_factor + part * load_change);
  kinematics.retract(state, way, part);
  return state;
}

// What two entities do to each other jumps there in its stiffness, so that the branch has a corner: `at` gets what is true
// just before it, `beyond` what is true behind. way, load_change: to the corner.
void look_both_ways(Newton& newton, ContactChange& change, const std::vector<ContactKey>& keys, const Vector& way, double load_change) {
  Energy& energy = newton.energy();
  const Kinematics& kinematics = energy.kinematics();
  const State& state = change.at.point.state;
  const auto rate = [&](const ContactKey& key, const Vector& x, double load, double part) {
    return (gap(energy, key, moved_by(kinematics, state, x, load, part)) - gap(energy, key, moved_by(kinematics, state, x, load, -part))) / (2 * part);
  };
  double part = 0;
  for (const ContactKey& key : keys)
    part = std::max(part, beside * size_of(energy.model(), key.particle) / std::max(std::abs(rate(key, way, load_change, 1e-4)), 1e-300));
  if (!(part > 0 && part < 0.1)) return;
  const auto side = [&](double where) {
    Equilibrium e = assess(newton, moved_by(kinematics, state, way, load_change, where), change.at.point.report);
    e.point.state = state, e.point.energy = change.at.point.energy;
    return e;
  };
  change.at = side(-part);
  change.beyond = side(part);
  const Vector& tangent = change.beyond->tangent;
  const double small = part * std::max(way.norm() / std::max(tangent.norm(), 1e-300), std::abs(load_change));
  int ahead = 0, back = 0;
  for (const ContactKey& key : keys) {
    const double r = rate(key, tangent, 1, small) * (change.after.count(key) ? -1 : 1);       // > 0: to the side beyond
    ++(r > 0 ? ahead : back);
  }
  const int came = load_change < 0 ? -1 : 1;
  change.onward = back == 0 ? came : ahead == 0 ? -came : 0;
}

// Those of the changed contacts that change at the equilibrium found; completes it.
void tell(Newton& newton, ContactChange& change, ContactSet now, const std::vector<ContactKey>& changed, const Vector& way, double load_change) {
  Energy& energy = newton.energy();
  constexpr std::size_t most_told = 4;
  std::vector<std::string> sentences;
  std::vector<ContactKey> here;
  for (const ContactKey& key : changed) {
    if (std::abs(gap(energy, key, change.at.point.state)) > together * size_of(energy.model(), key.particle)) continue;
    toggle(now, key);
    here.push_back(key);
    const std::string sentence = told(energy.model(), key, now.count(key) > 0);
    if (std::find(sentences.begin(), sentences.end(), sentence) == sentences.end()) sentences.push_back(sentence);
  }
  for (std::size_t k = 0; k < std::min(most_told, sentences.size()); ++k) change.what += (k ? ", " : "") + sentences[k];
  if (sentences.size() > most_told) change.what += fmt::format(" and {} more", sentences.size() - most_told);
  change.after = std::move(now);
  std::erase_if(here, [](const ContactKey& key) { return key.feature < 0; });
  if (!here.empty()) look_both_ways(newton, change, here, way, load_change);
}

// ∇gap (dofs) and ∂gap/∂λ of prescribed coordinates and moving walls.
Vector slope(const Energy& energy, const ContactKey& key, const State& state, const Touch& touch, double& by_load) {
  const Kinematics& kinematics = energy.kinematics();
  const Model& model = energy.model();
  Field g = Field::Zero(3, kinematics.sites());
  const auto add = [&](int entity, double sign) {
    if (!is_body(model, entity)) {
      g.col(entity) += sign * touch.normal;
      return;
    }
    const int b = entity - model.particles();
    g.col(kinematics.place_of(b)) += sign * touch.normal;
    g.col(kinematics.turn_of(b)) += sign / kinematics.lever(b) * (touch.point - state.bodies[b].position.hi).cross(touch.normal);
  };
  add(key.particle, 1);
  if (key.other >= 0) add(key.other, -1);
  by_load = 0;
  for (int s = 0; s < kinematics.sites(); ++s) by_load += g.col(s).dot(kinematics.drive(s));
  if (key.wall >= 0) by_load -= model.walls[key.wall].scaling.rate * touch.normal.dot(model.walls[key.wall].displacement);
  return kinematics.restrict(g);
}

}  // namespace

ContactSet closed_contacts(Energy& energy, const State& state) {
  ContactSet set;
  for (const Touch& t : energy.touches(state)) {
    if (t.gap < 0 || t.bears || t.feature < 0) set.insert({t.particle, t.other, t.wall, t.feature});
    if (t.feature < 0) continue;
    const double range = attraction_range(energy.model(), energy.body_rules(), t.key());
    if (range > 0 && t.gap < range) set.insert({t.particle, t.other, t.wall, t.feature, true});
  }
  return set;
}

std::optional<ContactChange> locate_contact(Newton& newton, const Segment& segment, const ContactSet& before, const Equilibrium& a,
                                            const Equilibrium& b) {
  Energy& energy = newton.energy();
  ContactSet now = before;
  std::vector<ContactKey> changed;
  const auto gap = [&](const ContactKey& key, const Equilibrium& e) { return elamin::gap(energy, key, e.point.state); };
  for (const ContactKey& key : difference(before, closed_contacts(energy, b.point.state))) {
    const double ga = gap(key, a), gb = gap(key, b);
    if ((ga < 0) != (gb < 0) && std::isfinite(ga) && std::isfinite(gb)) changed.push_back(key);
    else toggle(now, key);                    // it changes at `a`, which is an event already, or fades out at the end of an edge
  }
  if (changed.empty()) return {};
  const auto sample = [&](const ContactKey& key, double t, const Equilibrium& e) { return Sample{t, gap(key, e), e}; };
  ContactChange change{true, segment.b, b, {}, {}};
  for (std::size_t round = 0; round <= changed.size(); ++round) {
    // The one that changes first, as far as straight lines tell, of those that change before.
    const ContactKey* first = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const ContactKey& key : changed) {
      const double ga = gap(key, a), gu = gap(key, change.at), size = size_of(energy.model(), key.particle);
      if ((ga < 0) == (gu < 0) || (round > 0 && std::abs(gu) <= together * size)) continue;
      if (const double part = ga / (ga - gu); part < least) least = part, first = &key;
    }
    if (!first) break;
    const double resolution = 1e-13 * std::abs(segment.b - segment.a);
    const auto zero = find_zero(sample(*first, segment.a, a), sample(*first, change.at_parameter, change.at), resolution,
                                [&](double t, const Sample& from) -> std::optional<Sample> {
      const Equilibrium e = segment.at(t, from.e);
      if (!e.point.report.converged()) return {};
      return sample(*first, t, e);
    });
    if (!zero) return ContactChange{};
    change.at = zero->e, change.at_parameter = zero->t;
  }
  const State &from = a.point.state, &to = change.at.point.state;
  const Vector way = energy.kinematics().difference(from, to);
  tell(newton, change, std::move(now), changed, way, to.load_factor - from.load_factor);
  return change;
}

std::optional<ContactChange> corner_ahead(Newton& newton, const ContactSet& before, const Equilibrium& a, const Vector& way, double load_change) {
  Energy& energy = newton.energy();
  const Kinematics& kinematics = energy.kinematics();
  const Model& model = energy.model();
  if (model.bodies.empty()) return {};
  const State& from = a.point.state;
  double reach = 0, walls = 0;
  const Field moves = kinematics.extend(way);
  for (int s = 0; s < kinematics.sites(); ++s) reach = std::max(reach, 4 * (moves.col(s) + load_change * kinematics.drive(s)).norm());
  for (const Wall& w : model.walls) walls = std::max(walls, std::abs(load_change * w.scaling.rate) * w.displacement.norm());
  reach += 2 * walls;
  // The one that the tangent meets first.
  ContactKey first{};
  double least = std::numeric_limits<double>::infinity();
  for (const Touch& t : energy.touches(from, reach))
    for (const bool within : {false, true}) {
      const ContactKey key{t.particle, t.other, t.wall, t.feature, within};
      if (t.feature < 0 || (within && attraction_range(model, energy.body_rules(), t.key()) == 0)) continue;
      const double here = gap(energy, key, from), there = gap(energy, key, moved_by(kinematics, from, way, load_change, 1e-3));
      const bool closed = before.count(key) > 0;
      const bool at = std::abs(here) <= together * size_of(model, key.particle);
      if (at ? (there < 0) == closed : (here < 0) != closed) continue;
      const double part = at ? 0 : 1e-3 * here / (here - there);
      if (part >= 0 && part <= 1.5 && part < least) least = part, first = key;
    }
  if (!std::isfinite(least)) return {};
  ContactChange change;
  State state = moved_by(kinematics, from, way, load_change, least);
  Report report;
  for (int k = 0; k < 8; ++k) {
    const std::optional<Touch> touch = body_touch(model, energy.body_rules(), touch_key(first), state);
    if (!touch) return {};
    Plane plane;
    plane.row = slope(energy, first, state, *touch, plane.corner);
    const double off = gap(energy, first, state);
    if (k > 0 && std::abs(off) <= 1e-14 * size_of(model, first.particle)) break;
    const double rate = plane.row.dot(way) + plane.corner * load_change;
    if (rate == 0) return {};
    state = moved_by(kinematics, state, way, load_change, -off / rate);
    plane.length = std::max(way.norm(), 1e-300), plane.load = std::max(std::abs(load_change), 1e-300);
    report = newton.correct(state, a.zero_modes, nullptr, 16, &plane);
    if (!report.converged()) return {};
  }
  if (std::abs(gap(energy, first, state)) > together * size_of(model, first.particle)) return {};
  if (energy.passage(from, state) < 1) return {};
  change.found = true;
  change.at.point.state = state, change.at.point.report = report;
  change.at = assess(newton, state, report);
  // Nothing else may have changed before.
  std::vector<ContactKey> changed;
  for (const auto& set : {before, closed_contacts(energy, state)})
    for (const ContactKey& key : set) {
      const bool here = std::abs(gap(energy, key, state)) <= together * size_of(model, key.particle);
      if (here && std::find(changed.begin(), changed.end(), key) == changed.end()) changed.push_back(key);
    }
  for (const ContactKey& key : difference(before, closed_contacts(energy, state)))
    if (std::find(changed.begin(), changed.end(), key) == changed.end() && std::isfinite(gap(energy, key, state))) return {};
  if (std::find(changed.begin(), changed.end(), first) == changed.end()) changed.push_back(first);
  tell(newton, change, before, changed, way, load_change);
  return change;
}

}  // namespace elamin
