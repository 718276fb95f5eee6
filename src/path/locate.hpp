#pragma once
// Where between two equilibria an eigenvalue crosses zero, or touches it: branch points and limit points.
#include "path/event.hpp"
#include "path/options.hpp"
#include "path/segment.hpp"

#include <optional>

namespace elamin {

/// The first change of the Morse index on a segment from `a`, beyond which it is `before`, to `b`: root finding (Illinois,
/// bracketed) on the sorted eigenvalue that changes sign, at equilibria that the corrector itself computes. A limit point if
/// the load factor turns on the segment, else a branch point; where that is not known, or may be both, because the index changes by more
/// than one, a limit point if the load does work along the critical mode. Nothing if the eigenvalue jumps over zero: the ends are on different branches.
[[nodiscard]] std::optional<Event> locate_crossing(Newton& newton, const Segment& segment, const Equilibrium& a, int before, const Equilibrium& b,
                                     std::optional<bool> turns);

/// An eigenvalue or a curvature of the size `scale` at the ends of a segment has vanished where it is no larger than this: next to nothing of it, or, where slender
/// structures have all that decides below the zero level, as far as rounding tells it.
inline double vanished_below(double scale, double zero_level) {
  return std::max(limits::locate::next_to_nothing * scale, std::min(4 * zero_level, limits::locate::vanished * scale));
}

/// Equilibria between two load factors.
Segment segment_of_loads(Newton& newton, double from, double to);

/// An event of an equilibrium that lies at its place already.
inline Event event_at(const Equilibrium& e, double parameter) {
  Event event;
  event.at_parameter = parameter, event.at = e;
  return event;
}

/// The root of a function of the equilibria of a segment that has different signs at its ends, or nothing.
[[nodiscard]] std::optional<Event> locate_root(const Segment& segment, const Equilibrium& a, const Equilibrium& b,
                                 const std::function<double(const Equilibrium&)>& f);

/// The user_events whose observables pass their values first on the segment: several where they coincide. sides: of each the sign of
/// observable − value from `a` on, 0: not known. negative: the Morse index from `a` on. `missed`: a user event changes its side, but
/// where could not be found.
std::vector<Event> locate_user_events(const std::vector<UserEvent>& user_events, const std::vector<double>& sides, const Segment& segment,
                                  const Equilibrium& a, const Equilibrium& b, int negative, bool& missed);

/// The sides from a point on where `passed` have been met.
void pass_user_events(const std::vector<UserEvent>& user_events, const std::vector<Event>& passed, const State& state, std::vector<double>& sides);

/// The branch point that a side branch arrives at between `a` and `b`, where the load factor turns although no eigenvalue
/// changes sign. `slope`: dλ/ds, which changes sign. On the side branch the equations are singular there; so the place is
/// told from equilibria beside it (cubic Hermite interpolation), the branch that is met is stepped on by holding the
/// critical mode, and the zero of the eigenvalue located along that one.
[[nodiscard]] std::optional<Event> locate_arrival(Newton& newton, const Segment& segment, const Equilibrium& a, const Equilibrium& b,
                                    const std::function<double(const Equilibrium&)>& slope);

}  // namespace elamin
