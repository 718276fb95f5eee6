#include "path/contact_event.hpp"

#include "path/root.hpp"

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

}  // namespace

ContactSet closed_contacts(Energy& energy, const State& state) {
  ContactSet set;
  for (const Touch& t : energy.touches(state)) set.insert({t.particle, t.other, t.wall});
  return set;
}

std::optional<ContactEvent> locate_contact(Newton& newton, const ContactSet& before, const Equilibrium& a, const Equilibrium& b) {
  Energy& energy = newton.energy();
  ContactSet now = before;
  std::vector<ContactKey> changed;
  for (const ContactKey& key : difference(before, closed_contacts(energy, b.point.state))) {
    const double here = energy.gap(key.particle, key.other, key.wall, a.point.state);
    const double there = energy.gap(key.particle, key.other, key.wall, b.point.state);
    if ((here < 0) != (there < 0)) changed.push_back(key);
    else toggle(now, key);                    // it changes at `a`, which is an event already
  }
  if (changed.empty()) return {};
  const auto gap = [&](const ContactKey& key, const Equilibrium& e) { return energy.gap(key.particle, key.other, key.wall, e.point.state); };
  const auto sample = [&](const ContactKey& key, const Equilibrium& e) { return Sample{e.point.state.load_factor, gap(key, e), e}; };
  Equilibrium upper = b;
  for (std::size_t round = 0; round <= changed.size(); ++round) {
    // The one that changes first, as far as straight lines tell, of those that change before `upper`.
    const ContactKey* first = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const ContactKey& key : changed) {
      const double ga = gap(key, a), gu = gap(key, upper), diameter = energy.model().diameter[key.particle];
      if ((ga < 0) == (gu < 0) || (round > 0 && std::abs(gu) <= together * diameter)) continue;
      if (const double part = ga / (ga - gu); part < least) least = part, first = &key;
    }
    if (!first) break;
    const double resolution = 1e-13 * std::max(std::abs(a.point.state.load_factor), std::abs(b.point.state.load_factor));
    const auto zero = find_zero(sample(*first, a), sample(*first, upper), resolution, [&](double t, const Sample& from) -> std::optional<Sample> {
      const Equilibrium e = continue_to(newton, from.e, t);
      if (!e.point.report.converged()) return {};
      return sample(*first, e);
    });
    if (!zero) return ContactEvent{};
    upper = zero->e;
  }
  for (const ContactKey& key : changed)
    if (std::abs(gap(key, upper)) <= together * energy.model().diameter[key.particle]) toggle(now, key);
  return ContactEvent{true, std::move(upper), std::move(now)};
}

}  // namespace elamin
