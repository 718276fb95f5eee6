#pragma once
// Where between two equilibria an eigenvalue crosses zero, or touches it: branch points and limit points.
#include "path/event.hpp"
#include "path/options.hpp"
#include "path/segment.hpp"

#include <optional>

namespace elamin {

/// The first change of the Morse index on a segment from `a`, beyond which it is `before`, to `b`: root finding (Illinois,
/// bracketed) on the sorted eigenvalue that changes sign, at equilibria that the corrector itself computes. A limit point if
/// the load does work along the critical mode, else a branch point. Nothing if that eigenvalue does not go through zero:
/// then `b` is on another branch than `a`, or `a` itself is the event.
std::optional<Event> locate_crossing(Newton& newton, const Segment& segment, const Equilibrium& a, int before, const Equilibrium& b);

/// An event of an equilibrium that lies at its place already.
inline Event event_at(const Equilibrium& e, double parameter) {
  Event event;
  event.at_parameter = parameter, event.at = e;
  return event;
}

/// The root of a function of the equilibria of a segment that has different signs at its ends, or nothing.
std::optional<Event> locate_root(const Segment& segment, const Equilibrium& a, const Equilibrium& b,
                                 const std::function<double(const Equilibrium&)>& f);

/// The first of the watches whose observable passes its value on the segment. side: of each, observable − value from `a` on,
/// 0: not known. negative: the Morse index from `a` on.
std::optional<Event> locate_watch(const std::vector<Watch>& watches, const std::vector<double>& side, Segment segment,
                                  const Equilibrium& a, const Equilibrium& b, int negative);

/// The branch point that a side branch arrives at between `a` and `b`, where the load factor turns although no eigenvalue
/// changes sign. `slope`: dλ/ds, which changes sign. On the side branch the equations are singular there; so the place is
/// told from equilibria beside it (cubic Hermite interpolation), the branch that is met is stepped on by holding the
/// critical mode, and the zero of the eigenvalue located along that one. `position`: the parameter of a state.
std::optional<Event> locate_arrival(Newton& newton, const Segment& segment, const Equilibrium& a, const Equilibrium& b,
                                    const std::function<double(const Equilibrium&)>& slope,
                                    const std::function<double(const State&)>& position);

}  // namespace elamin
