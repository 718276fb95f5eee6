#include "study/curve.hpp"

#include "energy/hard_gaps.hpp"
#include "results/columns.hpp"
#include "study/solving.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {
namespace {

/// Whether two models have the same unknowns and the same elements between them.
bool same_topology(const Energy& a, const Energy& b) {
  const Model &m = a.model(), &n = b.model();
  const auto alike = [](const auto& x, const auto& y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const auto& p, const auto& q) { return p.particles == q.particles; });
  };
  if (m.particles() != n.particles() || m.bodies.size() != n.bodies.size() || a.dofs() != b.dofs()) return false;
  for (int d = 0; d < a.dofs(); ++d)
    if (a.kinematics().site_of(d) != b.kinematics().site_of(d) || a.kinematics().coordinate_of(d) != b.kinematics().coordinate_of(d))
      return false;
  return alike(m.bonds, n.bonds) && alike(m.angles, n.angles);
}

/// The contact whose gap is nearest to zero.
ContactKey nearest_contact(Energy& energy, const State& state) {
  const std::vector<Touch> touches = energy.touches(state, 1e-6 * energy.kinematics().smallest_size());
  const auto nearest = std::ranges::min_element(touches, {}, [](const Touch& t) { return std::abs(t.gap); });
  return nearest == touches.end() ? ContactKey{-1, -1, -1} : ContactKey{nearest->particle, nearest->other, nearest->wall, nearest->feature};
}

}  // namespace

void StartOfCurve::take(const PathPoint& point) {
  if (of_.starts_with("jump:") && !point.label.empty()) seen_[point.label] = point;
  if (!is_end(point)) return;
  if (!of_.starts_with("jump:")) event_ = point;
  else if (const auto begins = seen_.find(point.parent); begins != seen_.end()) event_ = begins->second;
}

Outcome trace_curve(const Problem& problem, const ModelAt& models, const PathPoint& event,
                    const std::function<void(const Row&, const Threshold&)>& found) {
  const CurveTable& t = *problem.curve;
  const auto here = std::make_shared<Variant>(models(t.from), solver_options(problem));
  const VariantAt variants = [&](double second) {
    try {
      const auto made = std::make_shared<Variant>(models(second), solver_options(problem));
      if (same_topology(made->energy, here->energy)) return made;
    } catch (const InputError& e) {
      throw NotFollowed(fmt::format("at {} = {:.10g} there is no such structure: {}", t.second, second,
                                    e.mistakes().empty() ? e.what() : e.mistakes().front().what));
    }
    throw NotFollowed(fmt::format("at {} = {:.10g} there are other particles, bonds or free coordinates than at {:.10g}, where the curve begins",
                                  t.second, second, t.from));
  };
  if (any_hard(here->model))
    return {Status::not_converged, "thresholds with hard contacts cannot be followed; give the contacts a stiffness"};

  Threshold start;
  start.second = t.from;
  start.at.point = event;
  start.kind = event.label.starts_with("limit:") ? EventKind::limit : event.label.starts_with("branch:") ? EventKind::branch : EventKind::contact;
  here->energy.evaluate(event.state);
  start.at.zero_modes = assess(here->newton, event.state, event.report).zero_modes;
  if (start.kind == EventKind::contact) {
    start.contact = nearest_contact(here->energy, event.state);
    if (start.contact.particle < 0 || start.contact.feature >= 0)
      return {Status::not_converged, "only contacts of particles, among them or at walls, can be followed"};
  } else {
    start.modes = event.modes;
    start.at.zero_modes = without_modes(start.at.zero_modes, start.modes);
    if (start.modes.cols() == 0)
      return {Status::not_converged, "the event has no mode along which the structure gives way: bodies that touch, whose stiffness jumps"};
  }
  CurveOptions options{t.from, t.to, t.steps, t.stops.value_or(std::vector<double>{}), t.until, std::abs(problem.path.to - problem.path.from)};
  for (const ExpectTable& e : problem.expect)
    if (const auto second = second_of(e.at)) options.stops.push_back(*second);
  const auto [status, why] = trace_curve(variants, std::move(start), options, [&](const Threshold& point) {
    const std::shared_ptr<Variant> there = variants(point.second);
    const PathPoint& p = point.at.point;
    const Observables observables(problem, there->model);
    const std::vector<Touch> touches = observed_touches(there->energy, p.state, observables);
    std::vector<double> values = observables.evaluate(p.state, there->energy.forces(p.state), touches);
    for (const auto& own : p.energy.own) values.push_back(own.second);
    found(curve_row(point.second, point.asymmetry, p, values), point);
  });
  return {status, why};
}

}  // namespace elamin
