#include "path/contact_event.hpp"

#include "path/root.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace elamin {

namespace {

constexpr double together = 1e-10;            // of the particle's diameter: gaps that vanish at one load factor

std::vector<ContactKey> difference(const ContactSet& a, const ContactSet& b) {
  std::vector<ContactKey> keys;
  std::set_symmetric_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(keys));
  return keys;
}

void toggle(ContactSet& set, const ContactKey& key) {
  if (!set.erase(key)) set.insert(key);
}

std::string told(const Model& model, const ContactKey& key, bool made) {
  const std::string one = fmt::format("particle {}", model.id[key.particle]);
  if (key.wall >= 0) return one + (made ? " touches wall " : " leaves wall ") + model.walls[key.wall].name;
  return one + (made ? " touches particle " : " leaves particle ") + std::to_string(model.id[key.other]);
}

}  // namespace

ContactSet closed_contacts(Energy& energy, const State& state) {
  ContactSet set;
  for (const Touch& t : energy.touches(state)) set.insert({t.particle, t.other, t.wall});
  return set;
}

std::optional<ContactChange> locate_contact(Newton& newton, const Segment& segment, const ContactSet& before, const Equilibrium& a,
                                            const Equilibrium& b) {
  Energy& energy = newton.energy();
  ContactSet now = before;
  std::vector<ContactKey> changed;
  const auto gap = [&](const ContactKey& key, const Equilibrium& e) { return energy.gap(key.particle, key.other, key.wall, e.point.state); };
  for (const ContactKey& key : difference(before, closed_contacts(energy, b.point.state))) {
    if ((gap(key, a) < 0) != (gap(key, b) < 0)) changed.push_back(key);
    else toggle(now, key);                    // it changes at `a`, which is an event already
  }
  if (changed.empty()) return {};
  const auto sample = [&](const ContactKey& key, double t, const Equilibrium& e) { return Sample{t, gap(key, e), e}; };
  ContactChange change{true, segment.b, b, {}, {}};
  for (std::size_t round = 0; round <= changed.size(); ++round) {
    // The one that changes first, as far as straight lines tell, of those that change before.
    const ContactKey* first = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const ContactKey& key : changed) {
      const double ga = gap(key, a), gu = gap(key, change.at), diameter = energy.model().diameter[key.particle];
      if ((ga < 0) == (gu < 0) || (round > 0 && std::abs(gu) <= together * diameter)) continue;
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
  constexpr std::size_t most_told = 4;
  std::size_t count = 0;
  for (const ContactKey& key : changed) {
    if (std::abs(gap(key, change.at)) > together * energy.model().diameter[key.particle]) continue;
    toggle(now, key);
    if (++count <= most_told) change.what += (change.what.empty() ? "" : ", ") + told(energy.model(), key, now.count(key) > 0);
  }
  if (count > most_told) change.what += fmt::format(" and {} more", count - most_told);
  change.after = std::move(now);
  return change;
}

}  // namespace elamin
