#include "path/curve.hpp"

#include "core/find.hpp"
#include "core/interrupt.hpp"
#include "path/arc.hpp"
#include "path/limits.hpp"
#include "path/root.hpp"
#include "path/saddle.hpp"
#include "solve/ritz.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace elamin {

using namespace limits;

namespace {

bool turns(double a, double b) { return (a < 0) != (b < 0); }
bool turns_asymmetry(const Threshold& a, const Threshold& b) {
  return std::min(std::abs(a.asymmetry), std::abs(b.asymmetry)) > curve::asymmetric && turns(a.asymmetry, b.asymmetry);
}

/// Something that changes its sign on the way; and whether it is a difference quotient.
struct Sign {
  std::string kind, what;
  std::function<double(Threshold&)> of;
  bool differenced = true;
};

const Sign turn_of_second{"turn", "the second parameter turns", [](Threshold& t) { return t.direction.second; }};

class CurveTracer {
 public:
  CurveTracer(const VariantAt& variants, const CurveOptions& options, const std::function<void(const Threshold&)>& found)
      : options_(options), found_(found), system_(variants) {}

  CurveEnd trace(Threshold here) {
    try {
      return follow(here);
    } catch (const NotFollowed& end) {
      return {Status::not_converged, fmt::format("the curve cannot be followed beyond {:.10g}: {}", here.second, end.what())};
    }
  }

 private:
  // From the threshold that the path has located to the end; `here` is the last point that there is.
  CurveEnd follow(Threshold& here) {
    begin(here);
    const double nominal = 1.0 / options_.steps;
    double step = nominal;
    for (int points = 0; points < curve::most_points * options_.steps; ++points) {
      const double rate = std::abs(here.direction.second) / system_.metric.second;
      step = std::min({step, curve::longest_step * nominal, rate > 0 ? nominal / rate : step});
      Threshold next;
      for (std::string why; !interrupted() && !advance(here, step, next, why); step /= 2)
        if (step / 2 < curve::least_step * nominal) throw NotFollowed(why);
      if (interrupted()) return {Status::interrupted, "interrupted"};
      const double angle = angle_between(here, next);
      // A step over a turn of μ ends there, so that values of it are met on both sides.
      bool told = false;
      if (turns(here.direction.second, next.direction.second) && !turns_asymmetry(here, next))
        if (const auto turn = locate(here, next, turn_of_second)) {
          const double sense = next.direction.second;
          next = *turn, next.direction.second = std::copysign(next.direction.second, sense), told = true;
        }
      const std::optional<double> target = target_between(here, next);
      if (target) land(here, *target, next);
      system_.assess_at(next);
      const std::string missed = tell_between(here, next);
      if (!until_.empty()) return {Status::converged, "the curve has been followed to " + until_};
      const bool ends = target && (*target == options_.to || *target == options_.from);
      if (!told || target) tell(next, ends ? "end" : "", missed);
      if (ends && *target == options_.to) return {Status::converged, "the curve has been followed to its end"};
      if (ends) return {Status::converged, "the curve turns, and leads back to where the second parameter began"};
      here = std::move(next);
      if (angle < curve::wanted_angle) step *= 2;
    }
    return {Status::not_converged, fmt::format("the curve has {} points and does not get to its end", curve::most_points * options_.steps)};
  }

  // The threshold as the extended system has it, and scales that make all parts of the curve alike there.
  void begin(Threshold& start) {
    const double load = std::abs(start.at.point.state.load_factor), extent = span(system_.variant(start.second)->model);
    system_.metric = {extent, load > 0 ? load : options_.load, std::abs(options_.to - options_.from)};
    system_.solve(start, nullptr);
    const CurveDirection& d = start.direction;
    const double rest = std::hypot(d.load / system_.metric.load, d.second / system_.metric.second), way = d.x.norm();
    system_.metric.length = std::max(curve::least_length * extent, rest > 0 ? way / rest : 0.0);
    if ((start.direction.second < 0) != (options_.to < options_.from)) start.direction = start.direction * -1;
    start.direction = system_.metric.unit(start.direction);
    system_.assess_at(start);
    tell(start, "start", "");
  }

  void tell(Threshold& point, const std::string& label, const std::string& what) {
    point.at.point.label = label, point.at.point.what = what;
    found_(point);
  }

  double angle_between(const Threshold& a, const Threshold& b) const {
    return std::acos(std::clamp(system_.metric.dot(a.direction, b.direction), -1.0, 1.0));
  }

  // The point a step further; false, with a phrase, where it is none.
  bool advance(const Threshold& from, double step, Threshold& next, std::string& why) {
    try {
      next = from;
      system_.move(next, from.direction * step);
      system_.solve(next, &from.direction);
      if (angle_between(from, next) <= curve::largest_angle) return true;
      why = "it bends too sharply";
    } catch (const NotFollowed& none) {
      why = none.what();
    }
    return false;
  }

  // The first value of μ on the way that is to be met.
  std::optional<double> target_between(const Threshold& a, const Threshold& b) const {
    std::vector<double> targets = options_.stops;
    targets.insert(targets.end(), {options_.from, options_.to});
    std::optional<double> first;
    for (const double t : targets)
      if ((t - a.second) * (t - b.second) <= 0 && t != a.second && (!first || std::abs(t - a.second) < std::abs(*first - a.second)))
        first = t;
    return first;
  }

  // The point between at that value of μ, instead of `at` behind it.
  void land(const Threshold& from, double target, Threshold& at) {
    if (at.second != target) {
      const auto found = locate(from, at, {"", "", [target](Threshold& t) { return t.second - target; }});
      if (!found) throw NotFollowed(fmt::format("it does not lead to {:.10g}", target));
      at = *found;
    }
    system_.move(at, {Vector::Zero(from.direction.x.size()), 0, target - at.second});
    at.second = target;
    system_.solve(at, nullptr);
    if (system_.metric.dot(from.direction, at.direction) < 0) at.direction = at.direction * -1;
  }

  /// Tells what happens between two points in its order; returns what of it could not be located.
  std::string tell_between(const Threshold& a, const Threshold& b) {
    std::vector<Threshold> special;
    std::string missed;
    const auto look = [&](const Threshold& from, const Threshold& to, const Sign& sign) {
      if (auto located = locate(from, to, sign)) special.push_back(std::move(*located));
      else missed += (missed.empty() ? "not located before: " : "; ") + sign.what;
    };
    const bool cubic = turns_asymmetry(a, b);
    const auto asymmetry = [](Threshold& t) { return t.asymmetry; };
    if (cubic && a.kind == EventKind::limit) {
      look(a, b, {"cusp", "two limit points meet", asymmetry});
    } else {
      if (cubic) look(a, b, {"symmetric", "an asymmetric branch point becomes a symmetric one", asymmetry});
      if (turns(a.direction.load, b.direction.load))
        look(a, b, {"turn", "the load factor turns", [](Threshold& t) { return t.direction.load; }});
      if (turns(a.direction.second, b.direction.second)) look(a, b, turn_of_second);
    }
    meet_between(a, b, look);
    for (const ContactKey& key : difference(closed(a), closed(b)))
      if (key.feature < 0 && (a.kind != EventKind::contact || key != a.contact))
        look(a, b, {"contact", "another contact is made or lost",
                    [&](Threshold& t) { return gap(system_.variant(t.second)->energy, key, t.at.point.state); }, false});
    std::ranges::stable_sort(special, {}, [&](const Threshold& point) { return along(a, point); });
    for (Threshold& point : special) {
      const std::string kind = point.at.point.label, label = fmt::format("{}:{}", kind, ++numbers_[kind]);
      tell(point, label, point.at.point.what);
      if (!contains(options_.until, label)) continue;
      until_ = label;
      break;
    }
    return missed;
  }

  // Another eigenvalue that changes its sign. Where the load does no work along its mode, that is held, which symmetry keeps as it is:
  // the equilibrium is regular then. Along one on which the load does work the path itself goes.
  void meet_between(const Threshold& a, const Threshold& b,
                    const std::function<void(const Threshold&, const Threshold&, const Sign&)>& look) {
    const int before = a.at.point.stability.negative, after = b.at.point.stability.negative, index = std::min(before, after);
    if (before == after) return;
    Threshold first = a, last = b;
    const Vector mode = next_eigenvalue(first, index).vectors.col(0);
    Energy& energy = system_.variant(a.second)->energy;
    energy.evaluate(a.at.point.state);
    const Vector load = energy.load_derivative();
    const bool limit = std::abs(mode.dot(load)) > curve::orthogonal * load.norm();
    const char* const names[]{"a limit point", "a branch point", "a contact"};
    const bool alike = a.kind == (limit ? EventKind::limit : EventKind::branch);
    Sign sign{a.kind == EventKind::contact ? "meeting" : alike ? "double" : "hilltop",
              fmt::format("{} meets {}", names[static_cast<int>(a.kind)], limit ? names[0] : names[1]), {}, false};
    if (limit) {
      sign.of = [&, index](Threshold& t) { return next_eigenvalue(t, index).values[0]; };
    } else {
      first.modes = side_by_side(a.modes, mode), last.modes = side_by_side(b.modes, next_eigenvalue(last, index).vectors);
      sign.of = [&](Threshold& t) {
        Energy& there = system_.variant(t.second)->energy;
        there.evaluate(t.at.point.state);
        return there.quadratic_form(t.modes.rightCols(1));
      };
    }
    look(first, last, sign);
  }

  ContactSet closed(const Threshold& t) { return closed_contacts(system_.variant(t.second)->energy, t.at.point.state); }

  double along(const Threshold& a, const Threshold& b) { return system_.metric.dot(a.direction, system_.way(a, b)); }

  std::optional<Threshold> locate(const Threshold& a, const Threshold& b, const Sign& sign) {
    const double length = along(a, b);
    std::map<double, Threshold> seen{{0, a}, {length, b}};
    Threshold first = a, last = b;
    const Sample lower{0, sign.of(first), a.at}, upper{length, sign.of(last), b.at};
    if ((lower.f < 0) == (upper.f < 0)) return {};
    const double resolution = (sign.differenced ? curve::about : curve::located) * length;
    const auto zero = find_zero(lower, upper, [&](double) { return resolution; }, [&](double s, const Sample& nearest) -> std::optional<Sample> {
      Threshold t;
      if (std::string why; advance(a, s, t, why)) {
        const double f = sign.of(t);
        seen[s] = t;
        return Sample{s, f, t.at};
      }
      if (std::abs(s - nearest.t) > curve::as_near * length) return {};
      return Sample{nearest.t, 0, nearest.e};                  // where two eigenvectors mix by rounding: as near as it can be told
    });
    if (!zero) return {};
    Threshold point = seen.at(zero->t);
    system_.assess_at(point);
    point.at.point.label = sign.kind, point.at.point.what = sign.what;
    return point;
  }

  // Of the eigenpairs beside the critical and the zero modes the one of this number from below, from 0.
  EigenPairs next_eigenvalue(Threshold& t, int index) {
    Newton& newton = system_.variant(t.second)->newton;
    const Eigen::MatrixXd held = side_by_side(t.at.zero_modes, t.modes);
    const Eigen::MatrixXd others = soft_modes(newton, t.at.point.state, held, index + curve::more_modes).vectors;
    if (others.cols() == 0) return {Vector::Zero(1), Eigen::MatrixXd::Zero(held.rows(), 1)};
    EigenPairs near = newton.factors().nearest_zero(others, held);
    near.values = rotate_to_ritz(newton.energy(), near.vectors);
    const Eigen::Index k = std::min<Eigen::Index>(index, others.cols() - 1);
    return {near.values.segment(k, 1), near.vectors.col(k)};
  }

  const CurveOptions& options_;
  const std::function<void(const Threshold&)>& found_;
  ExtendedSystem system_;
  std::map<std::string, int> numbers_;
  std::string until_;                                          // of options_.until, where it has come
};

}  // namespace

CurveEnd trace_curve(const VariantAt& variants, Threshold start, const CurveOptions& options,
                     const std::function<void(const Threshold&)>& found) {
  return CurveTracer(variants, options, found).trace(std::move(start));
}

}  // namespace elamin
