#include "path/equilibrium.hpp"

#include "core/find.hpp"
#include "model/entities.hpp"
#include "model/rigid_motion.hpp"
#include "path/arc.hpp"
#include "path/contact_event.hpp"
#include "path/family.hpp"
#include "path/limits.hpp"
#include "path/push.hpp"
#include "solve/contact_equilibrium.hpp"
#include "solve/ritz.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace elamin {

using namespace limits;

namespace {

// A basis of the zero modes that have been explained, orthonormal, and their names.
class Explained {
 public:
  Explained(const Energy& energy, Equilibrium& e)
      : energy_(energy), zero_(e.zero_modes), names_(e.point.stability.zero_modes), motions_(e.motions), rigid_(zero_.rows(), 0) {}

  bool all() const { return rigid_.cols() == zero_.cols(); }

  /// Takes the motions that lie in the span of the zero modes and are not explained yet.
  void take(const std::vector<RigidMotion>& motions) {
    for (const RigidMotion& m : motions) {
      if (all()) return;
      Vector v = energy_.kinematics().restrict(m.velocity_field(energy_.kinematics().sites()));
      if (v.norm() == 0) continue;
      v.normalize();
      if ((v - zero_ * (zero_.transpose() * v)).norm() > close) continue;
      v -= rigid_ * (rigid_.transpose() * v);
      if (v.norm() < close) continue;
      names_.push_back(m.name), motions_.push_back(m);
      rigid_.conservativeResize(Eigen::NoChange, rigid_.cols() + 1);
      rigid_.rightCols(1) = v.normalized();
    }
  }

  /// Takes what of the motions of each part with a body lies in the span: the spin of a rod, whatever way it points.
  void take_combined(const std::vector<RigidMotion>& motions, int particles) {
    for (std::size_t k = 0, end; k < motions.size() && !all(); k = end) {
      for (end = k; end < motions.size() && motions[end].particle == motions[k].particle; ++end) {}
      if (motions[k].sites.back() < particles) continue;
      const std::vector<RigidMotion> part(motions.begin() + static_cast<std::ptrdiff_t>(k), motions.begin() + static_cast<std::ptrdiff_t>(end));
      Eigen::MatrixXd v(zero_.rows(), static_cast<Eigen::Index>(part.size()));
      for (std::size_t m = 0; m < part.size(); ++m) {
        v.col(static_cast<Eigen::Index>(m)) = energy_.kinematics().restrict(part[m].velocity_field(energy_.kinematics().sites()));
        v.col(static_cast<Eigen::Index>(m)) /= std::max(v.col(static_cast<Eigen::Index>(m)).norm(), 1e-300);
      }
      const Singular svd = singular_values(v - zero_ * (zero_.transpose() * v));
      Eigen::Index inside = 0;
      while (inside < svd.values.size() && svd.values[svd.values.size() - 1 - inside] <= close) ++inside;
      if (inside == 0) continue;
      Eigen::MatrixXd c = svd.v.rightCols(inside);
      for (std::size_t m = 0; m < part.size(); ++m)
        c.row(static_cast<Eigen::Index>(m)) /= std::max(energy_.kinematics().restrict(part[m].velocity_field(energy_.kinematics().sites())).norm(), 1e-300);
      take(combined(part, c));
    }
  }

  /// Whether the rest are motions of the parts as rigid bodies against each other, which no force opposes.
  void take_relative(const std::vector<RigidMotion>& motions) {
    if (all() || motions.empty() || motions.size() > equilibrium::most_motions) return;
    Eigen::MatrixXd span(zero_.rows(), static_cast<Eigen::Index>(motions.size()));
    for (std::size_t k = 0; k < motions.size(); ++k)
      span.col(static_cast<Eigen::Index>(k)) = energy_.kinematics().restrict(motions[k].velocity_field(energy_.kinematics().sites()));
    for (Eigen::Index j = 0; j < zero_.cols(); ++j)
      if ((span * least_squares(span, zero_.col(j)) - zero_.col(j)).norm() > close) return;
    names_.push_back("sliding or rolling of what is in contact (no force opposes it)");
    rigid_ = zero_;
  }

 private:
  static constexpr double close = 1e-3;
  const Energy& energy_;
  const Eigen::MatrixXd& zero_;
  std::vector<std::string>& names_;
  std::vector<RigidMotion>& motions_;
  Eigen::MatrixXd rigid_;
};

// Names what the zero modes are: rigid motions of glued parts, of parts in contact together, of parts against each other.
// True if they explain all of them.
bool name_zero_modes(Energy& energy, Equilibrium& e) {
  const State& state = e.point.state;
  Explained explained(energy, e);
  const std::vector<RigidMotion> of_parts = free_rigid_motions(energy.model(), state);
  explained.take(of_parts);
  if (!explained.all()) explained.take_combined(of_parts, energy.model().particles());
  if (!explained.all() && !(energy.model().contacts.empty() && energy.model().rounded.empty())) {
    std::vector<std::array<int, 2>> touching;
    for (const Touch& t : energy.touches(state))
      if (t.other >= 0) touching.push_back({t.particle, t.other});
    const std::vector<RigidMotion> together = free_rigid_motions(energy.model(), state, touching);
    explained.take(together);
    if (!explained.all()) explained.take_combined(together, energy.model().particles());
  }
  explained.take_relative(of_parts);
  return explained.all();
}

// Single particles and bodies that no stiffness holds: one that flies is named as such, one that slides or spins on a plane by
// direction.
void name_null_dofs(const Energy& energy, std::vector<std::string>& names) {
  const Kinematics& kinematics = energy.kinematics();
  const Model& model = energy.model();
  const auto entity_of = [&](int dof) {
    const int site = kinematics.site_of(dof), body = kinematics.body_of(site);
    return body < 0 ? site : model.particles() + body;
  };
  std::size_t left_out = 0;
  const std::vector<int>& idle = energy.null_dofs();
  for (std::size_t k = 0; k < idle.size();) {
    const int e = entity_of(idle[k]), body = is_body(model, e) ? e - model.particles() : -1;
    std::array<std::string, 2> along;                            // places, turns
    int without_stiffness = 0, free = 0;
    for (; k < idle.size() && entity_of(idle[k]) == e; ++k, ++without_stiffness) {
      std::string& axes = along[kinematics.is_rotation(kinematics.site_of(idle[k]))];
      axes += (axes.empty() ? "" : ", ") + std::string(1, "xyz"[kinematics.coordinate_of(idle[k])]);
    }
    for (int c = 0; c < 3; ++c) {
      free += kinematics.dof(body < 0 ? e : kinematics.place_of(body), c) >= 0;
      if (body >= 0) free += kinematics.dof(kinematics.rotation_of(body), c) >= 0;
    }
    const auto tell = [&](std::string name) {
      if (names.size() >= equilibrium::most_names) ++left_out;
      else names.push_back(std::move(name));
    };
    if (without_stiffness == free) {
      tell("rattler: " + called(model, e) + " touches nothing");
      continue;
    }
    if (!along[0].empty()) tell("translation of " + called(model, e) + " along " + along[0]);
    if (!along[1].empty()) tell("rotation of " + called(model, e) + " about " + along[1]);
  }
  if (left_out > 0) names.push_back("and " + std::to_string(left_out) + " more " + (model.bodies.empty() ? "particles" : "particles and bodies"));
}

// Whether some attract each other: where what pushes and pulls cancels there is no force, and yet it is bound.
bool attracts(const Model& model) {
  return std::any_of(model.contacts.begin(), model.contacts.end(), [](const PairContact& c) { return c.law == PairContact::Law::lj; }) ||
         std::any_of(model.rounded.begin(), model.rounded.end(), [](const RoundedPair& r) { return r.kernel.attraction != 0; }) ||
         std::any_of(model.walls.begin(), model.walls.end(), [](const Wall& w) { return w.kernel.attraction != 0; });
}

// Which sites belong to parts that the supports let go somewhere.
std::vector<bool> free_sites(const Energy& energy, const State& state) {
  std::vector<bool> free(energy.kinematics().sites(), false);
  for (const RigidMotion& m : free_rigid_motions(energy.model(), state))
    if (m.translation)
      for (const int site : m.sites) free[site] = true;
  return free;
}

// Whether something that nothing holds is there and no contact bears more than a residual leaves on all of it; whether it touches something, too.
void see_floating(const Newton& newton, Energy& energy, Equilibrium& e) {
  const Model& model = energy.model();
  const double most = newton.tolerance() * std::max(energy.force_scale(), energy.force_floor()) * entities(model);
  const std::vector<Touch> touches = energy.touches(e.point.state);
  if (std::any_of(touches.begin(), touches.end(), [&](const Touch& t) { return t.force.norm() > most; })) return;
  const std::vector<bool> free = free_sites(energy, e.point.state);
  const auto is_free = [&](int entity) { return entity >= 0 && free[is_body(model, entity) ? energy.kinematics().place_of(entity - model.particles()) : entity]; };
  e.floats = contains(free, true);
  e.pushed = std::any_of(touches.begin(), touches.end(), [&](const Touch& t) { return is_free(t.particle) || is_free(t.other); });
}

// Whether contacts are made from one state to the other, and none is lost; what just touches at the first one is closed there.
bool only_touches_more(Energy& energy, const State& from, const State& to) {
  ContactSet before = closed_contacts(energy, from);
  for (const Touch& t : energy.touches(from, equilibrium::just_touching * energy.kinematics().smallest_size())) before.insert({t.particle, t.other, t.wall, t.feature});
  const ContactSet after = closed_contacts(energy, to);
  return after.size() > before.size() && std::includes(after.begin(), after.end(), before.begin(), before.end());
}


}  // namespace

Equilibrium assess(Newton& newton, const State& state, const Report& report) {
  Energy& energy = newton.energy();
  Equilibrium e;
  e.point.state = state;
  e.point.report = report;
  energy.be_at(state);
  e.point.energy = energy.last_terms();
  e.tangent = Vector::Zero(energy.dofs());
  if (energy.dofs() == 0) {
    e.point.stability.stable = true;
    return e;
  }
  if (report.status == Status::interrupted) return e;           // a run that is stopped ends without another factorisation
  Stability& s = e.point.stability;
  if (!state.hard.empty()) {                                    // what moves keeps the hard contacts closed
    ContactEquilibrium held(energy);
    const Inertia inertia = held.inertia(state);
    s.negative = s.negative_rigid = inertia.negative, s.zero = inertia.zero + static_cast<int>(energy.null_dofs().size());
    name_null_dofs(energy, s.zero_modes);
    if (inertia.zero > 0) e.zero_modes = held.lowest(state, inertia.negative + inertia.zero).vectors.rightCols(inertia.zero);
    const bool named = inertia.zero == 0 || name_zero_modes(energy, e);
    s.critical = named ? 0 : inertia.zero;
    s.stable = s.negative == 0 && named;
    e.tangent = held.tangent(state, e.zero_modes).q;
    return e;
  }
  Inertia inertia = newton.factors().inertia();
  e.soft = newton.factors().soft();
  const bool slack = energy.slack() && may_touch(energy.model()) && !attracts(energy.model());
  if (slack) inertia.zero += inertia.negative, inertia.negative = 0;            // what forces that are none make of it
  s.negative = inertia.negative, s.zero = inertia.zero + static_cast<int>(energy.null_dofs().size());
  name_null_dofs(energy, s.zero_modes);
  bool named = inertia.zero == 0;
  if (!named && inertia.negative <= equilibrium::most_unstable && inertia.zero <= static_cast<int>(equilibrium::most_motions)) {
    const EigenPairs lowest = newton.factors().lowest(inertia.negative + inertia.zero);
    e.zero_modes = lowest.vectors.rightCols(inertia.zero);
    named = name_zero_modes(energy, e);
  }
  s.critical = named ? 0 : inertia.zero;
  s.stable = s.negative == 0 && named;
  e.slack = slack;
  if (!slack && may_touch(energy.model()) && !attracts(energy.model())) see_floating(newton, energy, e);
  if (inertia.zero > 0) newton.factors().factorize_holding(e.zero_modes);   // else there is a factor that has just told so
  e.tangent = newton.factors().solve_holding(-energy.load_derivative());
  // Where f·H⁻¹f < 0, f = −∂g/∂λ of the loads, one of the negative directions is one on which they do work.
  s.negative_rigid = s.negative;
  if (s.negative > 0 && energy.loads_scaled()) {
    const Vector f = energy.load_force();
    if (f.dot(newton.factors().solve_holding(f)) < 0) --s.negative_rigid;
  }
  return e;
}

void see_softest(Newton& newton, Equilibrium& e, const EigenPairs& neighbour, double change) {
  Energy& energy = newton.energy();
  const int block = std::min(equilibrium::softest + 1, energy.dofs()), count = std::min(equilibrium::softest, block);
  if (count == 0 || e.slack || !e.point.state.hard.empty() || change == 0) return;
  const Eigen::Index known = neighbour.vectors.cols();
  const EigenPairs pairs = newton.factors().soft_pairs(side_by_side(neighbour.vectors, starting_block(energy.dofs(), block - static_cast<int>(known))),
                                                       known > 0 ? 1 : equilibrium::softest_rounds);
  std::vector<int> order(block);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int i, int j) { return std::abs(pairs.values[i]) < std::abs(pairs.values[j]); });
  order.resize(count);
  e.softest = {pairs.values(order), pairs.vectors(Eigen::all, order)};
  State beside = e.point.state;
  energy.kinematics().prescribe(beside, beside.load_factor + change);
  energy.kinematics().retract(beside, e.tangent, change);
  energy.evaluate(beside);
  e.softening.resize(count);
  for (int j = 0; j < count; ++j) e.softening[j] = (energy.quadratic_form(e.softest.vectors.col(j)) - e.softest.values[j]) / change;
}

bool same_branch(Energy& energy, const Equilibrium& a, const Equilibrium& b) {
  if (a.slack && b.slack) return true;
  Vector moved = energy.kinematics().difference(a.point.state, b.point.state), tangent_a = a.tangent, tangent_b = b.tangent;
  if (a.pushed || b.pushed) {                                   // of what is pushed no tangent tells the way
    const std::vector<bool> free = free_sites(energy, a.point.state);
    for (int d = 0; d < energy.dofs(); ++d)
      if (free[energy.kinematics().site_of(d)]) moved[d] = tangent_a[d] = tangent_b[d] = 0;
  }
  const double change = b.point.state.load_factor - a.point.state.load_factor;
  const double by_a = (moved - change * tangent_a).norm(), by_b = (moved - change * tangent_b).norm(),
               by_both = (moved - change / 2 * (tangent_a + tangent_b)).norm();
  const double rounding = segment::least_movement * energy.kinematics().norm(b.point.state);
  if (std::min({by_a, by_b, by_both}) > equilibrium::largest_part * moved.norm() + rounding) return false;
  const bool comes_to_rest = change * tangent_b.dot(moved) < equilibrium::least_rest * moved.squaredNorm() && by_both > equilibrium::parabola * moved.norm();
  const bool alike = tangent_a.dot(tangent_b) >= equilibrium::least_cosine * tangent_a.norm() * tangent_b.norm();
  if (moved.norm() <= rounding || (alike && !comes_to_rest)) return true;
  return !energy.touches(a.point.state).empty() || !energy.touches(b.point.state).empty();
}

bool lower_already(Energy& energy, const Equilibrium& a, const Equilibrium& b) {
  const auto pushed = [](const Equilibrium& e) { return e.slack || e.pushed; };
  if (pushed(a) || pushed(b)) return false;
  State back = b.point.state;
  energy.kinematics().prescribe(back, a.point.state.load_factor);
  const EnergyTerms &here = a.point.energy, there = energy.terms(back);
  return there.total() < here.total() - equilibrium::energy_rounding * std::max(here.size(), there.size());
}

Equilibrium continue_to(Newton& newton, const Equilibrium& from, double load_factor, const Corrector& correct) {
  const Kinematics& kinematics = newton.energy().kinematics();
  Energy& energy = newton.energy();
  const State& start = from.point.state;
  State driven = start;                                         // what is prescribed moves; then what is free, as predicted
  kinematics.prescribe(driven, load_factor);
  State predicted = driven;
  kinematics.retract(predicted, from.tangent, load_factor - start.load_factor);
  const auto fail = [&](const State& at, Report report, const std::string& why = {}) {
    if (!why.empty()) report.status = Status::not_converged, report.why = why;
    Equilibrium failed;
    failed.point.state = at, failed.point.report = std::move(report);
    return failed;
  };
  // A contact that hardly touches yields without end to the tangent: then the prediction is cut short of what is in its way.
  if (const double part = energy.collision_free_step(start, predicted); part < 1) {
    if (energy.collision_free_step(start, driven) < 1) return fail(driven, {}, "the step would carry something through something else");
    predicted = driven;
    kinematics.retract(predicted, from.tangent, part * (load_factor - start.load_factor));
    if (energy.collision_free_step(start, predicted) < 1) predicted = driven;
  }
  State state = predicted;
  const bool meets = may_touch(energy.model());
  State aside;
  const auto push = [&](const State& begin) -> std::optional<Equilibrium> {
    aside = begin;
    energy.evaluate(start, false);
    Report pushed = push_aside(newton, driven, driven_way(energy, load_factor - start.load_factor), from.slack ? 0.0 : energy.force_scale(), aside);
    if (!pushed.converged() || energy.collision_free_step(start, aside) < 1) return {};
    return assess(newton, aside, pushed);
  };
  // What is predicted of what has been pushed may be beyond, where nothing touches it.
  if (from.slack && !correct)
    if (std::optional<Equilibrium> e = push(predicted)) return std::move(*e);
  if ((from.slack || from.pushed) && !correct)
    if (std::optional<Equilibrium> e = push(driven)) return std::move(*e);
  Report report = correct ? correct(state) : newton.correct(state, from.zero_modes, &start, equilibrium::most_iterations);
  if (!correct && !report.converged() && from.floats && !from.pushed && from.point.stability.negative == 0)
    if (std::optional<Equilibrium> e = push(predicted)) return std::move(*e);
  if (!correct && report.status == Status::not_converged && meets && from.point.stability.negative == 0) {
    // Contacts that open, close or slide bend a stable path more than Newton's method without safeguards can follow.
    state = aside.particles() > 0 ? aside : predicted;          // what is pushed has been caught there
    report = newton.minimise(state, Pace::stationary, equilibrium::most_in_contact);
    if (report.converged() && report.negative > 0) report = newton.correct(state, from.zero_modes, &start, equilibrium::most_iterations);
  }
  if (!report.converged()) return fail(state, report);
  if (energy.collision_free_step(start, state) < 1)
    return fail(state, report, "the step would carry something through something else");
  Equilibrium e = assess(newton, state, report);
  if (!std::isfinite(e.point.energy.total())) return fail(state, report, "the energy is not finite where the step ends");
  if (from.family > 0) hold_family(newton, e, from.family, from.zero_modes);
  // What is beyond a contact that is made need not lie on the tangent of what is before: then the contact comes first. And what is all but free may have moved by
  // rounding alone.
  if (!(meets && only_touches_more(energy, start, state)) && !same_branch(energy, from, e) &&
      kinematics.difference(start, state).norm() > left_by_rounding(newton, state, from.zero_modes))
    return fail(state, report, "the corrector went to another branch");
  return e;
}

bool leads_to(Newton& newton, const Equilibrium& from, const Equilibrium& to) {
  const Kinematics& kinematics = newton.energy().kinematics();
  State state = from.point.state;
  const double change = to.point.state.load_factor - state.load_factor;
  kinematics.prescribe(state, to.point.state.load_factor);
  kinematics.retract(state, from.tangent, change);
  if (!newton.correct(state, from.zero_modes, &from.point.state, equilibrium::most_iterations).converged()) return false;
  const double apart = kinematics.difference(state, to.point.state).norm();
  return apart <= equilibrium::same_end * kinematics.difference(from.point.state, to.point.state).norm() || apart <= left_by_rounding(newton, state, from.zero_modes);
}

double left_by_rounding(Newton& newton, const State& state, const Eigen::MatrixXd& held) {
  Energy& energy = newton.energy();
  energy.evaluate(state);
  if (!newton.factors().factorize_holding(held)) return 0;
  const Vector g = energy.gradient(), once = newton.factors().solve_holding(g), twice = newton.factors().solve_holding(once);
  const double far = g.norm() * (twice.norm() / once.norm());
  return std::isfinite(far) ? far : 0;
}

Eigen::MatrixXd free_motions(const Energy& energy, const State& state) {
  const Kinematics& kinematics = energy.kinematics();
  const std::vector<RigidMotion> motions = free_rigid_motions(energy.model(), state);
  if (motions.empty() || motions.size() > equilibrium::most_held) return Eigen::MatrixXd(energy.dofs(), 0);
  Eigen::MatrixXd all(energy.dofs(), static_cast<Eigen::Index>(motions.size()));
  for (std::size_t k = 0; k < motions.size(); ++k) all.col(static_cast<Eigen::Index>(k)) = kinematics.restrict(motions[k].velocity_field(kinematics.sites()));
  return orthonormal(all);
}

Eigen::MatrixXd side_by_side(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd both(std::max(a.rows(), b.rows()), a.cols() + b.cols());
  if (a.cols() > 0) both.leftCols(a.cols()) = a;
  if (b.cols() > 0) both.rightCols(b.cols()) = b;
  return both;
}

Eigen::MatrixXd canonical_modes(const Kinematics& kinematics, const Eigen::MatrixXd& modes) {
  Eigen::MatrixXd left = modes, chosen(modes.rows(), 0);
  while (left.cols() > 0) {
    Vector best = left.col(0);
    bool told = left.cols() == 1;
    for (int c = 0; c < 3 && !told; ++c) {                  // the part of the span that moves along this axis most
      Eigen::MatrixXd along = left;
      for (int d = 0; d < kinematics.dofs(); ++d)
        if (kinematics.coordinate_of(d) != c) along.row(d).setZero();
      const Singular svd = singular_values(along);
      if (svd.values[0] < 0.5) continue;
      best = left * svd.v.col(0);
      told = svd.values[1] < (1 - equilibrium::close_values) * svd.values[0];
      break;
    }
    if (!told) {                                            // all alike: the one that moves a single coordinate most, the first such
      const Vector largest = left.rowwise().norm();
      const double most = largest.maxCoeff();
      Eigen::Index d = 0;
      while (largest[d] < (1 - equilibrium::close_values) * most) ++d;
      best = left * left.row(d).transpose();
    }
    best.normalize();
    const double sum = best.sum();
    Eigen::Index lead = 0;
    const double largest = best.cwiseAbs().maxCoeff();
    while (std::abs(best[lead]) < 0.5 * largest) ++lead;
    if (std::abs(sum) > 1e-6 * best.lpNorm<1>() ? sum < 0 : best[lead] < 0) best = -best;
    chosen.conservativeResize(Eigen::NoChange, chosen.cols() + 1);
    chosen.rightCols(1) = best;
    // What is left of the span, orthonormal again.
    const Eigen::MatrixXd rest = left - best * (best.transpose() * left);
    left = singular_values(rest).u.leftCols(left.cols() - 1).eval();
  }
  return chosen;
}

}  // namespace elamin
