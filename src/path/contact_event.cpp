#include "path/contact_event.hpp"

#include "core/find.hpp"
#include "energy/body_touches.hpp"
#include "model/entities.hpp"
#include "path/arc.hpp"
#include "path/limits.hpp"
#include "path/push.hpp"
#include "path/root.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace elamin {

using namespace limits;

namespace {

void toggle(ContactSet& set, const ContactKey& key) {
  if (!set.erase(key)) set.insert(key);
}

std::string told(const Model& model, const ContactKey& key, bool made) {
  const std::string one = called(model, key.particle);
  const std::string verb = key.within_cutoff ? (made ? " comes within the cutoff of " : " leaves the cutoff of ") : made ? " touches " : " leaves ";
  return one + verb + (key.wall >= 0 ? "wall " + model.walls[key.wall].name : called(model, key.other));
}

// Completes the equilibrium at which these contacts change; from, negative: the load factor and the Morse index where the way begins; unloaded: what is
// closed before and bears nothing there.
void tell(Newton& newton, ContactChange& change, const ContactSet& before, std::vector<ContactKey> changed, const Vector& way, double load_change,
          double from, int negative, const std::vector<ContactKey>& unloaded = {}) {
  const auto apply = [&] {
    change.after = before;
    for (const ContactKey& key : changed) toggle(change.after, key);
  };
  apply();
  find_beyond(newton, change, changed, way, load_change, negative);
  const double ahead = change.at.point.state.load_factor - from;
  const auto lost = std::count_if(changed.begin(), changed.end(), [&](const ContactKey& key) { return before.count(key) > 0; });
  const bool mixed = lost > 0 && lost < static_cast<std::ptrdiff_t>(changed.size());
  const bool returns = mixed && change.beyond && change.onward * ahead < 0;      // as where a branch meets its mirror image
  if ((returns || (!change.beyond && (mixed || !unloaded.empty()))) && change.at.point.stability.negative == negative) {
    std::vector<ContactKey> here = changed;
    here.insert(here.end(), unloaded.begin(), unloaded.end());
    if (std::optional<Equilibrium> onward = onward_from(newton, change.at, here, before, ahead, negative)) {
      std::erase_if(here, [&](const ContactKey& key) { return (gap(newton.energy(), key, onward->point.state) < 0) == (before.count(key) > 0); });
      changed = std::move(here);
      apply();
      onward->point.state = change.at.point.state, onward->point.energy = change.at.point.energy;
      change.beyond = std::move(onward), change.onward = ahead < 0 ? -1 : 1;
    }
  }
  std::sort(changed.begin(), changed.end());
  std::vector<std::string> sentences;
  for (const ContactKey& key : changed) {
    const std::string sentence = told(newton.energy().model(), key, change.after.count(key) > 0);
    if (!contains(sentences, sentence)) sentences.push_back(sentence);
  }
  for (std::size_t k = 0; k < std::min(contact_event::most_told, sentences.size()); ++k) change.what += (k ? ", " : "") + sentences[k];
  if (sentences.size() > contact_event::most_told) change.what += fmt::format(" and {} more", sentences.size() - contact_event::most_told);
}

// How far anything goes on a way (dofs) over which the load factor changes.
double farthest(const Energy& energy, const Vector& way, double load_change) {
  const Kinematics& kinematics = energy.kinematics();
  double most = driven_way(energy, load_change);
  const Field moves = kinematics.extend(way);
  for (int s = 0; s < kinematics.sites(); ++s) most = std::max(most, (moves.col(s) + load_change * kinematics.drive(s)).norm());
  return most;
}

// The equilibrium at which a gap vanishes, from a state that is near:  g(x, λ) = 0, gap(x, λ) = 0. way, load_change: the scales of
// what may move. The state is moved along the way first, to where the gap vanishes to first order.
Report close_gap(Newton& newton, const ContactKey& key, const Equilibrium& from, const Vector& way, double load_change, State& state) {
  Energy& energy = newton.energy();
  Plane plane;
  plane.length = std::max(way.norm(), 1e-300), plane.load = std::max(std::abs(load_change), 1e-300);
  bool defined = true;
  double aim = 0;
  plane.condition = [&](const State& at, Plane& p) {
    defined = defined && slope(energy, key, at, load_change, p.row, p.corner);
    return defined ? gap(energy, key, at) - aim : 0.0;
  };
  Report report;
  const double off = plane.condition(state, plane), rate = defined ? plane.row.dot(way) + plane.corner * load_change : 0.0;
  if (rate == 0) return report;
  state = moved_by(energy.kinematics(), state, way, load_change, -off / rate);
  const State guess = state;
  const double size = size_of(energy.model(), key.particle);
  const double left = contact_event::faded * std::abs(gap(energy, key, from.point.state));
  const double exact = std::max(contact_event::exact_rounding * size, coordinate_rounding(key, guess));
  // Gaps of particles are exact; of a wall it is rounding where it stands; and where no other force is there, the least overlap bears too much of one.
  const auto settle = [&](State& at, double close) {
    plane.close = close * size;
    // What is closed with less of an overlap than that has not lost it there.
    if (key.feature < 0) plane.close = std::min(plane.close, std::max(exact, left));
    return correct_across(newton, at, from.zero_modes, nullptr, contact_event::most_closing, plane,
                          [&](const State& x) { return std::abs(gap(energy, key, x) - aim) <= plane.close; });
  };
  for (const auto& [close, beside] : {std::pair(contact_event::exact_rounding, 0.0), std::pair(contact_event::rounding, 0.0), std::pair(contact_event::rounding, contact_event::just_open)}) {
    aim = beside * size;
    state = aim > 0 ? moved_by(energy.kinematics(), guess, way, load_change, 2 * aim / rate) : guess;
    report = settle(state, close);
    if (report.status == Status::interrupted) break;
    if (!report.converged()) continue;
    State finer = state;                                        // from nearer by it may come out exactly
    if (const Report exactly = close > contact_event::exact_rounding && beside == 0 ? settle(finer, contact_event::exact_rounding) : Report{}; exactly.converged())
      state = std::move(finer), report = exactly;
    break;
  }
  if (!defined) report.status = Status::not_converged;
  return report;
}

bool bears_nothing(Energy& energy, const ContactKey& key, const State& state) {
  return key.feature >= 0 || borne(energy, key, state) <= contact_event::unloaded;
}

// Whether a gap vanishes at an equilibrium, to rounding; of a contact that was closed before, whose overlap may be next to nothing everywhere, little is left, and
// what particles bear there tells it of stiff ones.
bool vanishes(Energy& energy, const ContactKey& key, double before, const State& there) {
  const double size = size_of(energy.model(), key.particle), none = contact_event::together * size;
  const double left = std::max(contact_event::faded * std::abs(before), contact_event::exact_rounding * size);
  return std::abs(gap(energy, key, there)) <= (before < 0 && key.feature < 0 ? std::min(none, left) : none) && bears_nothing(energy, key, there);
}

// Whether a gap is so small at another one's change that it changes with it: of what was closed, beside its overlap before, but for rounding.
bool is_none(const Energy& energy, const ContactKey& key, double before, const State& there) {
  const double most = std::max(-contact_event::together_in_step * before, contact_event::rounding * size_of(energy.model(), key.particle));
  return before >= 0 || key.feature >= 0 || std::abs(gap(energy, key, there)) <= most;
}

// Whether a contact is closed at an equilibrium by no more of a force than is left there.
bool rounding_bears(Newton& newton, const ContactKey& key, const std::vector<Touch>& touches) {
  const double part = borne(newton.energy(), key, touches);
  return part >= 0 && part <= newton.tolerance();
}

// d gap/dt along a branch; not a number where the gap has no slope. load_change: over which walls move.
double gap_rate(Energy& energy, const Segment& segment, const ContactKey& key, const Equilibrium& e, double load_change) {
  Vector row;
  double by_load = 0;
  if (!slope(energy, key, e.point.state, load_change, row, by_load)) return std::numeric_limits<double>::quiet_NaN();
  return segment.load_rate(e) * (row.dot(e.tangent) + by_load);
}

// Where on the way from one equilibrium towards another its tangent closes a gap; nothing if it does not.
std::optional<State> where_tangent_closes(const Energy& energy, const ContactKey& key, const Equilibrium& from, const Equilibrium& towards) {
  const double load_change = towards.point.state.load_factor - from.point.state.load_factor;
  const Vector way = load_change * from.tangent;
  const auto at = [&](double part) { return moved_by(energy.kinematics(), from.point.state, way, load_change, part); };
  const double here = gap(energy, key, from.point.state), rate = (gap(energy, key, at(contact_event::little)) - here) / contact_event::little;
  const double part = -here / rate;
  if (!(part > 0 && part <= 1)) return {};
  return at(part);
}

// Whether a contact that changes where a segment begins is closed, or open, a little farther on: where it is as it was at the end it has changed back between.
bool is_onward(Energy& energy, const Segment& segment, const ContactKey& key, const Equilibrium& a, bool closed) {
  return std::any_of(contact_event::onward.begin(), contact_event::onward.end(), [&](double part) {
    const Equilibrium e = segment.at(segment.a + part * (segment.b - segment.a), a);
    return e.point.report.converged() && (closed ? -1 : 1) * gap(energy, key, e.point.state) > contact_event::rounding * size_of(energy.model(), key.particle);
  });
}

// Where what floats is pushed until a gap is next to nothing, by the secant from the side where it is open: beyond, the gap stays none, and no Newton's
// method finds where that begins. beyond: a load factor at which it has closed; guess: where it may close.
std::optional<Equilibrium> pushed_until(Newton& newton, const ContactKey& key, const Equilibrium& from, double beyond, double guess) {
  const Energy& energy = newton.energy();
  const double wanted = std::max(contact_event::next_to_none * size_of(energy.model(), key.particle), coordinate_rounding(key, from.point.state));
  double open = from.point.state.load_factor, left = gap(energy, key, from.point.state), rate = left / (guess - open);
  for (int k = 0; k < contact_event::most_closing; ++k) {
    double load = open + (left - wanted) / rate;
    if (!((beyond - load) * (beyond - open) > 0)) load = (open + beyond) / 2;
    const Equilibrium e = continue_to(newton, from, load);
    const double here = e.point.report.converged() && e.slack ? gap(energy, key, e.point.state) : 0.0;
    if (here > 0 && here <= 4 * wanted) return e;
    if (here <= wanted) beyond = load;
    else rate = (left - here) / (load - open), open = load, left = here;
  }
  return {};
}

// The first of these contacts that are made on the way from a slack equilibrium, and those made together with it. What has been told before, and has come
// apart since, is told again only where it is the last one, which catches what floats.
ContactChange first_pushed(Newton& newton, const Segment& segment, ContactSet now, const ContactSet& before, const std::vector<ContactKey>& made,
                           const Equilibrium& a, const Equilibrium& b) {
  const double from = a.point.state.load_factor, to = b.point.state.load_factor;
  std::vector<Equilibrium> at;
  double last = 0;
  for (const ContactKey& key : made) {
    const std::optional<State> ahead = where_tangent_closes(newton.energy(), key, a, b);
    std::optional<Equilibrium> e = pushed_until(newton, key, a, to, ahead ? ahead->load_factor : to);
    if (!e) return {};
    at.push_back(std::move(*e));
    last = std::max(last, std::abs(at.back().point.state.load_factor - from));
  }
  std::size_t first = made.size();
  for (std::size_t k = 0; k < made.size(); ++k) {
    const double way = std::abs(at[k].point.state.load_factor - from);
    if (before.count(made[k]) && way < (1 - contact_event::together_in_step) * last) now.insert(made[k]);
    else if (first == made.size() || way < std::abs(at[first].point.state.load_factor - from)) first = k;
  }
  ContactChange change{true, segment.parameter(at[first].point.state), at[first], {}, {}};
  std::vector<ContactKey> together;
  for (const ContactKey& key : closed_contacts(newton.energy(), change.at))
    if (!now.count(key)) together.push_back(key);
  tell(newton, change, now, together, Vector::Zero(a.tangent.size()), 0, from, a.point.stability.negative);
  return change;
}

}  // namespace

ContactSet difference(const ContactSet& a, const ContactSet& b) {
  ContactSet keys;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::inserter(keys, keys.end()));
  return keys;
}

ContactSet closed_contacts(Energy& energy, const Equilibrium& e) {
  return closed_contacts(energy, e.point.state, e.slack ? contact_event::together * energy.kinematics().smallest_size() : 0.0);
}

ContactSet closed_contacts(Energy& energy, const State& state, double within) {
  ContactSet set;
  for (const Touch& t : energy.touches(state, within)) {
    if (t.gap < within || t.bears || t.feature < 0) set.insert({t.particle, t.other, t.wall, t.feature});
    if (t.feature < 0) continue;
    const double range = attraction_range(energy.model(), energy.body_rules(), t.key());
    if (range > 0 && t.gap < range) set.insert({t.particle, t.other, t.wall, t.feature, true});
  }
  return set;
}

std::optional<ContactChange> locate_contact(Newton& newton, const Segment& segment, const ContactSet& before, const Equilibrium& a,
                                            const Equilibrium& b) {
  Energy& energy = newton.energy();
  const Kinematics& kinematics = energy.kinematics();
  ContactSet now = before;
  std::vector<ContactKey> changed;
  const auto gap = [&](const ContactKey& key, const State& state) { return elamin::gap(energy, key, state); };
  // From a slack equilibrium what has been apart is made; what just touches is pushed, and leaves and touches by rounding: it is told once, and again
  // where something is caught.
  const double touching = contact_event::together * kinematics.smallest_size();
  const auto other_side = [&](double here, double there) { return a.slack ? here >= touching && there < touching : (here < 0) != (there < 0); };
  if (a.slack && !b.slack) std::erase_if(now, [&](const ContactKey& key) { return gap(key, a.point.state) >= touching; });
  for (const ContactKey& key : difference(ContactSet(now), closed_contacts(energy, b))) {
    if (a.slack && b.slack && now.count(key)) continue;
    const double ga = gap(key, a.point.state), gb = gap(key, b.point.state);
    const bool made = now.count(key) > 0;
    const bool back = made ? ga >= 0 && gb > (a.slack ? touching : 0) : ga <= 0 && gb < 0 && !a.slack;
    if (key.feature < 0 && back && is_onward(energy, segment, key, a, made)) return ContactChange{};         // a shorter step
    if (other_side(ga, gb) && std::isfinite(ga) && std::isfinite(gb)) changed.push_back(key);
    else toggle(now, key);                    // it changes at `a`, which is an event already, or fades out at the end of an edge
  }
  if (changed.empty()) return {};
  if (a.slack) return first_pushed(newton, segment, std::move(now), before, changed, a, b);
  ContactChange change{true, segment.b, {}, {}, {}};
  std::optional<Equilibrium> at = b;          // what is known of it
  State found = b.point.state;
  Report report;
  std::optional<ContactKey> met;              // the one whose gap vanishes at `found`
  const auto near = [&](const ContactKey& key, const State& state) {
    const double ga = gap(key, a.point.state);                  // an overlap may be next to nothing beside what opens behind it
    const double moves = ga < 0 && key.feature < 0 ? 0.0 : std::abs(gap(key, b.point.state) - ga);
    return vanishes(energy, key, ga, state) || (std::abs(gap(key, state)) <= contact_event::together_in_step * moves && bears_nothing(energy, key, state));
  };
  const auto with_it = [&](const ContactKey& key, const State& state) { return near(key, state) && is_none(energy, key, gap(key, a.point.state), state); };
  for (std::size_t round = 0; round <= changed.size(); ++round) {
    // The one that changes first, as far as straight lines tell, of those that change before.
    const ContactKey* first = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const ContactKey& key : changed) {
      const double ga = gap(key, a.point.state), gu = gap(key, found);
      if ((ga < 0) == (gu < 0) || (round > 0 && with_it(key, found))) continue;
      if (const double part = ga / (ga - gu); part < least) least = part, first = &key;
    }
    if (!first) break;
    const Vector way = kinematics.difference(a.point.state, found);
    const double load_change = found.load_factor - a.point.state.load_factor;
    // From `a` the branch goes where its tangent points: what lies behind is where a stiff contact was made, not where it is lost, unless it bears rounding.
    const double ga = gap(*first, a.point.state);
    const bool just_made = ga < 0 && first->feature < 0 && -ga <= contact_event::exact_rounding * size_of(energy.model(), first->particle);
    const bool makes = ga > 0;
    const double after = !just_made && rounding_bears(newton, *first, energy.touches(a.point.state)) ? -contact_event::along_chord
                       : (just_made ? 1 : -1) * contact_event::together_in_step;
    double t = segment.a;
    const auto closed_from = [&](State state) {
      report = close_gap(newton, *first, a, way, load_change, state);
      if (!report.converged()) return false;
      t = segment.parameter(state);
      const double part = (t - segment.a) / (change.at_parameter - segment.a);
      if (!(part > after && part < 1 + contact_event::along_chord && beside_chord(kinematics, a.point.state, found, state) &&
            energy.collision_free_step(a.point.state, state) == 1)) return false;
      // Beyond the end, where it is closed already, may be the place where it is lost again.
      if (makes && first->feature < 0 && part > 1 + contact_event::together_in_step &&
          !((segment.b - segment.a) * gap_rate(energy, segment, *first, assess(newton, state, report), load_change) < 0)) return false;
      found = std::move(state), t = segment.b > segment.a ? std::max(t, segment.a) : std::min(t, segment.a);
      return true;
    };
    // From the side where the contact is open its tangent tells the place, however stiff it is; else the chord.
    const std::optional<State> ahead = where_tangent_closes(energy, *first, makes ? a : b, makes ? b : a);
    if ((ahead && closed_from(*ahead)) || closed_from(moved_by(kinematics, a.point.state, way, load_change, least))) {
      change.at_parameter = t, at.reset();
    } else {                                                    // slowly, along the branch
      if (!at) at = segment.at(change.at_parameter, a);
      if (just_made || !at->point.report.converged()) return ContactChange{};        // its gap vanishes at `a`, too: a shorter step
      const auto sample = [&](double u, const Equilibrium& e) { return Sample{u, gap(*first, e.point.state), e}; };
      const auto zero = find_zero(sample(segment.a, a), sample(change.at_parameter, *at), [&](double u) { return segment.resolution(u); },
                                  [&](double u, const Sample& from) -> std::optional<Sample> {
        const Equilibrium e = segment.at(u, from.e);
        if (!e.point.report.converged()) return {};
        return sample(u, e);
      }, contact_event::together * size_of(energy.model(), first->particle));
      if (!zero || !near(*first, zero->e.point.state)) return ContactChange{};      // a gap that jumps: two branches
      at = zero->e, change.at_parameter = zero->t, found = zero->e.point.state;
      if (closed_from(found)) change.at_parameter = t, at.reset();                  // to the last digit
    }
    met = *first;
  }
  change.at = at ? std::move(*at) : assess(newton, found, report);
  const Vector chord = kinematics.difference(a.point.state, b.point.state);    // it may be where the segment begins
  const double load_change = b.point.state.load_factor - a.point.state.load_factor;
  std::erase_if(changed, [&](const ContactKey& key) { return key != met && !with_it(key, found); });
  std::vector<ContactKey> unloaded;
  for (const ContactKey& key : just_touching(energy, found, now))
    if (key.feature < 0 && !contains(changed, key) && with_it(key, found)) unloaded.push_back(key);
  tell(newton, change, now, changed, chord, load_change, a.point.state.load_factor, a.point.stability.negative, unloaded);
  return change;
}

std::optional<double> where_contact_may_pass(Energy& energy, const Segment& segment, const Equilibrium& a, const Equilibrium& b, const ContactSet& but) {
  const double width = segment.b - segment.a, load_change = b.point.state.load_factor - a.point.state.load_factor;
  const double reach = farthest(energy, energy.kinematics().difference(a.point.state, b.point.state), load_change);
  std::optional<double> where;
  double most = 0;
  for (const Touch& t : energy.touches(a.point.state, reach)) {
    const ContactKey key{t.particle, t.other, t.wall, t.feature};
    const double ga = gap(energy, key, a.point.state), gb = gap(energy, key, b.point.state);
    if (but.count(key) || !std::isfinite(gb) || (ga < 0) != (gb < 0)) continue;
    // g' = ra + 2u (3(gb − ga) − 2ra − rb) + 3u² (ra + rb − 2(gb − ga)); on the way to the other side at one end, on the way back at the other.
    const double sign = ga < 0 ? -1 : 1, ra = width * gap_rate(energy, segment, key, a, load_change);
    if (!(sign * ra < 0)) continue;
    const double rb = width * gap_rate(energy, segment, key, b, load_change);
    if (!(sign * rb > 0)) continue;
    const double c = ra + rb - 2 * (gb - ga), h = 3 * (gb - ga) - 2 * ra - rb;
    const double root = std::sqrt(std::max(0.0, h * h - 3 * c * ra)), u = ra / (-h - std::copysign(root, h)), v = (-h - std::copysign(root, h)) / (3 * c);
    for (const double x : {u, v}) {
      if (!(x > 0 && x < 1)) continue;
      const double g = ga + x * (ra + x * (h + x * c)), past = -sign * g / std::max(std::abs(ga), std::abs(gb));
      if (past > most) most = past, where = segment.a + x * width;
    }
  }
  return where;
}

std::optional<ContactChange> kink_ahead(Newton& newton, const ContactSet& before, const Equilibrium& a, const Vector& way, double load_change, bool made) {
  Energy& energy = newton.energy();
  const Kinematics& kinematics = energy.kinematics();
  const Model& model = energy.model();
  const State& from = a.point.state;
  const double step_bound = made ? 4 * farthest(energy, way, load_change) : 0.0;
  // The one that the tangent meets first.
  ContactKey first{};
  ContactSet candidates = before;
  double least = std::numeric_limits<double>::infinity();
  const std::vector<Touch> touches = energy.touches(from, step_bound);
  const State onward = moved_by(kinematics, from, way, load_change, 1e-3);
  for (const Touch& t : touches)
    for (const bool within : {false, true}) {
      const ContactKey key{t.particle, t.other, t.wall, t.feature, within};
      if (within && (t.feature < 0 || attraction_range(model, energy.body_rules(), t.key()) == 0)) continue;
      candidates.insert(key);
      const double here = gap(energy, key, from), there = gap(energy, key, onward);
      const bool closed = before.count(key) > 0;
      // What is closed may overlap by no more than that everywhere: it changes here if it bears nothing.
      const bool bears = closed && here < 0 && key.feature < 0 && !rounding_bears(newton, key, touches);
      const bool opens = closed && here < 0 && key.feature >= 0 && there - here > contact_event::rounding * size_of(model, key.particle);
      const bool at = !bears && !opens && std::abs(here) <= contact_event::together * size_of(model, key.particle);
      const bool stays = (there < 0) == closed ||
                         std::abs(there) <= std::max(contact_event::rounding * size_of(model, key.particle), coordinate_rounding(key, from));
      if (at ? stays : (here < 0) != closed) continue;
      const double part = at ? 0 : 1e-3 * here / (here - there);
      if (part >= 0 && part <= 1.5 && part < least) least = part, first = key;
    }
  if (!std::isfinite(least)) return {};
  ContactChange change;
  State state = moved_by(kinematics, from, way, load_change, least);
  const Report report = close_gap(newton, first, a, way, load_change, state);
  if (!report.converged()) return {};
  if (!just_touches(energy, first, state)) return {};
  if (energy.collision_free_step(from, state) < 1) return {};
  change.found = true;
  change.at.point.state = state, change.at.point.report = report;
  change.at = assess(newton, state, report);
  // What changes here, too; nothing else may have changed before.
  const State ahead = moved_by(kinematics, state, way, load_change, 1e-3);
  std::vector<ContactKey> changed{first};
  for (const ContactKey& key : candidates) {
    const double here = gap(energy, key, state);
    const bool closed = before.count(key) > 0;
    if (key == first || !std::isfinite(here)) continue;
    const double before_it = closed ? gap(energy, key, from) : 0.0;
    if (!vanishes(energy, key, before_it, state) || (here > 0 && !is_none(energy, key, before_it, state))) {
      if ((here < 0) != closed) return {};
    } else if ((gap(energy, key, ahead) < 0) != closed) {
      changed.push_back(key);
    }
  }
  tell(newton, change, before, changed, way, load_change, from.load_factor, a.point.stability.negative);
  return change;
}

bool just_touches(const Energy& energy, const ContactKey& key, const State& state) {
  return std::abs(gap(energy, key, state)) <= contact_event::together * size_of(energy.model(), key.particle);
}

std::vector<ContactKey> just_touching(const Energy& energy, const State& state, const ContactSet& closed) {
  std::vector<ContactKey> keys;
  for (const ContactKey& key : closed)
    if (just_touches(energy, key, state)) keys.push_back(key);
  return keys;
}

}  // namespace elamin
