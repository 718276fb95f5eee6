#include "energy/step_limits.hpp"

#include "core/near_pairs.hpp"
#include "energy/body_touches.hpp"
#include "energy/wall_group.hpp"
#include "laws/frustum.hpp"
#include "model/entities.hpp"

#include <Eigen/Geometry>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

bool is_free(const Kinematics& kinematics, int particle) {
  return kinematics.dof(particle, 0) >= 0 || kinematics.dof(particle, 1) >= 0 || kinematics.dof(particle, 2) >= 0;
}

std::string pressed_at_wall(const Model& model, int particle, const char* how, const Wall& wall) {
  return fmt::format("the centre of {} is pressed {} the wall '{}'; a contact that bears the force needs a larger modulus",
                     called(model, particle), how, wall.name);
}

}  // namespace

double distortion(const Energy& energy, const State& state, const Vector& step, double load_change) {
  Field s = energy.kinematics().extend(step, state);
  if (load_change != 0 && energy.kinematics().driven())
    for (Eigen::Index p = 0; p < s.cols(); ++p) s.col(p) += load_change * energy.kinematics().drive(static_cast<int>(p));
  double largest = 0;
  for (const Bond& b : energy.model().bonds) {
    const auto [i, j] = b.particles;
    const double length = (state.at(j) - state.at(i)).hi.norm();
    if (length > 0) largest = std::max(largest, (s.col(j) - s.col(i)).norm() / length);
  }
  const Kinematics& kinematics = energy.kinematics();
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    largest = std::max(largest, s.col(kinematics.rotation_of(static_cast<int>(b))).norm() / kinematics.characteristic_length(static_cast<int>(b)));
  return largest;
}

double movement(const Energy& energy, const Vector& step) {
  const Field s = energy.kinematics().extend(step);
  double largest = 0;
  for (int p = 0; p < s.cols(); ++p)
    if (const double size = energy.kinematics().size(p); size > 0) largest = std::max(largest, s.col(p).norm() / size);
  return largest;
}

double step_size(const Energy& energy, const State& state, const Vector& step, double load_change) {
  const double turn = distortion(energy, state, step, load_change);
  return turn > 0 ? turn : movement(energy, step);
}

double extent(const Model& model) {
  if (model.contacts.empty() && model.walls.empty() && model.rounded.empty()) return infinity;
  Eigen::AlignedBox3d box = box_of(model, model.start);
  if (box.isEmpty()) return 0;
  for (const Wall& w : model.walls) {
    const Region& r = w.region;
    const Vec3 x0 = model.particles() > 0 ? Vec3(model.start.position.col(0)) : model.start.bodies[0].position.hi;
    if (r.shape == Shape::block) box.extend(r.lo), box.extend(r.hi);
    else if (r.shape == Shape::plane) box.extend(Vec3(x0 - r.normal * r.normal.dot(x0 - r.center)));
    else box.extend(Vec3(r.center - Vec3::Constant(r.radius))), box.extend(Vec3(r.center + Vec3::Constant(r.radius)));
  }
  return box.isEmpty() ? 0.0 : box.diagonal().norm();
}

std::string escaped(const Model& model, const State& state, double far) {
  const auto told = [&](int entity) { return called(model, entity) + " moves away without end; hold it with a [[support]], or with a wall"; };
  for (int p = 0; p < model.particles(); ++p)
    if ((state.position.col(p) - model.start.position.col(p)).cwiseAbs().maxCoeff() > far) return told(p);
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    if ((state.bodies[b].position.hi - model.start.bodies[b].position.hi).cwiseAbs().maxCoeff() > far)
      return told(model.particles() + static_cast<int>(b));
  return "";
}

std::string gone_through(const Energy& energy, const State& state) {
  for (const Wall& wall : energy.model().walls) {
    if (!(wall.effective_modulus > 0) || wall.region.any_open()) continue;
    const Region now = wall_at(wall, state.load_factor).region;
    for (const int p : wall.particles)
      if (is_free(energy.kinematics(), p) && !on_side(now, wall.inside, state.at(p))) return pressed_at_wall(energy.model(), p, "through", wall);
  }
  return "";
}

std::string obstacle(const Energy& energy, const State& state) {
  constexpr double pressed = 1e-3;                               // of the distance of touch: far beyond what Hertz's law is for
  constexpr double at_cutoff = 1e-6;                             // of it: where a search for a minimum ends that runs into a jump
  const Model& model = energy.model();
  const Kinematics& kinematics = energy.kinematics();
  const auto apart = [&](int i, int j) { return (state.at(j) - state.at(i)).hi.norm(); };
  const auto both = [&](int i, int j) { return fmt::format("{} and {}", called(model, i), called(model, j)); };
  for (const Bond& b : model.bonds)
    if (apart(b.particles[0], b.particles[1]) == 0)
      return both(b.particles[0], b.particles[1]) + ", which are glued, are in one place, where bonds and angles have no direction";
  for (const Angle& a : model.angles)
    for (const int end : {a.particles[0], a.particles[2]})
      if (apart(a.particles[1], end) == 0) return both(a.particles[1], end) + " are in one place, where their angle has no direction";
  if (const std::string what = gone_through(energy, state); !what.empty()) return what;
  for (int w = 0; w < static_cast<int>(model.walls.size()); ++w)
    for (const int p : model.walls[w].particles) {
      const double r = model.diameter[p] / 2;
      if (model.walls[w].effective_modulus > 0 && is_free(kinematics, p) && energy.gap(p, -1, w, state) + r <= pressed * r)
        return pressed_at_wall(model, p, "onto", model.walls[w]);
    }
  std::vector<Touch> touches;
  add_body_touches(model, energy.body_rules(), state, 0, touches);
  for (const Touch& t : touches)
    if (t.other >= 0 && t.gap < 0 &&
        model.rounded[energy.body_rules().table(t.particle, t.other)].formulation == RoundedFormulation::closest)
      return both(t.particle, t.other) + " touch by formulation \"closest\", whose force leaps where edges or faces lie along each other: a minimum there is a kink, "
                                         "where forces do not vanish; formulation = \"multi\" has none";
  const ContactRules& rules = energy.contact_rules();
  if (!rules.any()) return "";
  std::vector<double> radii(model.particles());
  for (int p = 0; p < model.particles(); ++p) radii[p] = rules.cutoff_radius(p) * (1 + 2 * at_cutoff);
  std::string found;
  for (const auto& [i, j] : near_pairs(state.position, radii, [&](int a, int b) { return is_free(kinematics, a) || is_free(kinematics, b); })) {
    const double d = apart(i, j);
    if (const int t = rules.hertz(i, j); t >= 0 && model.contacts[t].effective_modulus > 0 && d <= pressed * (model.diameter[i] + model.diameter[j]) / 2)
      return fmt::format("the centres of {} are pressed onto each other; a contact that bears the force needs a larger modulus", both(i, j));
    const int t = rules.lj(i, j);
    if (t < 0 || !found.empty()) continue;
    const PairContact& lj = model.contacts[t];
    if (!(std::abs(d - lj.cutoff) <= at_cutoff * lj.cutoff)) continue;
    const bool shifted = lj.cutoff_style == CutoffStyle::shifted;
    const double s = std::pow(lj.sigma / lj.cutoff, 6);
    const double jump = shifted ? Cohesion::push(lj.cutoff * lj.cutoff, lj.epsilon, lj.sigma) * lj.cutoff : 4 * lj.epsilon * s * (1 - s);
    if (jump != 0 && lj.cutoff_style != CutoffStyle::smooth)
      found = fmt::format("{} are at the cutoff of law \"lj\", {:.6g}, where its {} jumps by {:.3g} and there is no equilibrium; with a larger "
                          "cutoff the jump is smaller, with cutoff_style = \"smooth\" there is none", both(i, j), lj.cutoff, shifted ? "force" : "energy", std::abs(jump));
  }
  return found;
}

std::string falling(const Energy& energy) {
  for (const int d : energy.null_dofs())
    if (energy.gradient()[d] != 0) {
      const int site = energy.kinematics().site_of(d), body = energy.kinematics().body_of(site);
      return called(energy.model(), body < 0 ? site : energy.model().particles() + body);
    }
  return "";
}

}  // namespace elamin
