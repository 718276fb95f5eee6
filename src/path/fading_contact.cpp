#include "path/fading_contact.hpp"

#include "model/entities.hpp"
#include "path/arc.hpp"

#include <cmath>

namespace elamin {

using namespace limits;

namespace {

class Fading {
 public:
  Fading(Newton& newton, const ContactKey& key, const Equilibrium& from, double load_change)
      : newton_(&newton), key_(key), from_(from), load_change_(load_change), overlap_(-gap(newton.energy(), key, from.point.state)),
        rounding_(std::max(contact_event::exact_rounding * size_of(newton.energy().model(), key.particle), coordinate_rounding(key, from.point.state))) {}

  double parameter(const State& state) const {
    const double gap = elamin::gap(newton_->energy(), key_, state);
    return -std::copysign(std::sqrt(std::abs(gap) / overlap_), -gap);
  }

  /// dλ/dt = (dδ/dt) / (dδ/dλ); where it begins to open the sign tells whether the load factor goes on or back.
  double load_rate(const Equilibrium& e) const {
    Vector row;
    double by_load = 0;
    if (!slope(newton_->energy(), key_, e.point.state, load_change_, row, by_load)) return 0;
    const double t = std::max(std::abs(parameter(e.point.state)), epsilon);
    return 2 * overlap_ * t / (row.dot(e.tangent) + by_load);
  }

  /// Of t, which the overlap tells: dt = dδ/(2 δ₀ |t|).
  double rounding(double t) const { return rounding_ / (2 * overlap_ * std::max(std::abs(t), epsilon)); }

  Report settle(State& state, double t, const Eigen::MatrixXd& held, const State* from, Plane& plane) const {
    const double aim = -overlap_ * t * t;
    bool defined = true;
    plane.length = span(newton_->energy().model()), plane.load = load_change_;
    plane.condition = [this, aim, &defined](const State& at, Plane& p) {
      defined = defined && slope(newton_->energy(), key_, at, load_change_, p.row, p.corner);
      return defined ? gap(newton_->energy(), key_, at) - aim : 0.0;
    };
    plane.close = std::max(contact_event::rounding * overlap_ * t * t, rounding_);
    Report report = newton_->correct(state, held, from, arc::most_iterations, &plane);
    if (!defined) report.status = Status::not_converged;
    return report;
  }

  Equilibrium at(double t, const Equilibrium& nearest) const {
    Plane plane;
    Equilibrium e;
    e.point.state = nearest.point.state;
    e.point.report = settle(e.point.state, t, nearest.zero_modes, &nearest.point.state, plane);
    if (!e.point.report.converged() || newton_->energy().collision_free_step(nearest.point.state, e.point.state) < 1)
      return e.point.report.status = Status::not_converged, e;
    return with_tangent(*newton_, assess(*newton_, e.point.state, e.point.report), nearest, plane);
  }

  bool leads(const Equilibrium& a, const Equilibrium& b) const {
    const Kinematics& kinematics = newton_->energy().kinematics();
    const Equilibrium there = at(parameter(b.point.state), a);
    return there.point.report.converged() && kinematics.difference(there.point.state, b.point.state).norm() <=
           equilibrium::same_end * kinematics.difference(a.point.state, b.point.state).norm() + left_by_rounding(*newton_, there.point.state, a.zero_modes);
  }

 private:
  Newton* newton_;
  ContactKey key_;
  Equilibrium from_;
  double load_change_, overlap_, rounding_;
};

}  // namespace

Segment segment_of_fading(Newton& newton, const ContactKey& key, const Equilibrium& from, double load_change) {
  const Fading fading(newton, key, from, load_change);
  return {-1, 0, [fading](double t, const Equilibrium& nearest) { return fading.at(t, nearest); },
          [fading](State& state, const Eigen::MatrixXd& held) {
            Plane plane;
            return fading.settle(state, fading.parameter(state), held, nullptr, plane);
          },
          [fading](const State& state) { return fading.parameter(state); }, [fading](const Equilibrium& e) { return fading.load_rate(e); },
          [fading](const Equilibrium& a, const Equilibrium& b) { return fading.leads(a, b); }, [fading](double t) { return fading.rounding(t); }};
}

}  // namespace elamin
