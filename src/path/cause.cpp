#include "path/cause.hpp"

#include "model/entities.hpp"
#include "path/limits.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elamin {

using namespace limits;

namespace {

std::string flat_angle(const Model& model, const State& state) {
  if (model.plane_normal) return "";
  for (const Angle& a : model.angles) {
    if (std::abs(model.angle_types[a.type].rest - pi) <= cause::bent) continue;
    const auto [i, j, k] = a.particles;
    const Vec3 u = (state.at(i) - state.at(j)).hi.normalized(), v = (state.at(k) - state.at(j)).hi.normalized();
    if (u.cross(v).norm() > cause::flat || u.dot(v) > 0) continue;
    return fmt::format("the angle at {} is flat here, and rest angles have no sign in space; in a plane they have: give the file "
                       "plane = \"xy\", \"xz\" or \"yz\"", called(model, j));
  }
  return "";
}

std::string changing_contact(Energy& energy, const State& state) {
  const Model& model = energy.model();
  double smallest = 0;
  for (int e = 0; e < entities(model); ++e) smallest = smallest == 0 ? size_of(model, e) : std::min(smallest, size_of(model, e));
  for (const Touch& t : energy.touches(state, cause::touching * smallest))
    if (std::abs(t.gap) <= cause::touching * size_of(model, t.particle))
      return fmt::format("{} just touches {} here; where contacts are much stiffer than what they press on, more path.steps or a softer contact may do",
                         called(model, t.particle), t.wall >= 0 ? "wall " + model.walls[t.wall].name : called(model, t.other));
  return "";
}

// What the load drives along a motion that costs nothing: then no other load factor has an equilibrium near.
std::string driven_freely(Energy& energy, const Equilibrium& last) {
  const Vector load = energy.load_derivative();
  Vector freely = Vector::Zero(load.size());
  if (last.zero_modes.cols() > 0) freely = last.zero_modes * (last.zero_modes.transpose() * load);
  for (const int d : energy.null_dofs()) freely[d] = load[d];
  if (!(freely.norm() > cause::soft * load.norm())) return "";
  Eigen::Index most = 0;
  freely.cwiseAbs().maxCoeff(&most);
  const Kinematics& kinematics = energy.kinematics();
  const int site = kinematics.site_of(static_cast<int>(most)), body = kinematics.body_of(site);
  return fmt::format("the load moves {}, which nothing holds; hold it with a [[support]], or with a wall",
                     called(energy.model(), body >= 0 ? energy.model().particles() + body : site));
}

}  // namespace

std::string cause_at(Newton& newton, const Equilibrium& last) {
  Energy& energy = newton.energy();
  const State& state = last.point.state;
  if (std::string why = flat_angle(energy.model(), state); !why.empty()) return why;
  if (std::string why = changing_contact(energy, state); !why.empty()) return why;
  if (energy.dofs() == 0) return "";
  energy.evaluate(state);
  if (std::string why = driven_freely(energy, last); !why.empty()) return why;
  const double stiffest = newton.factors().zero_level() / (16 * epsilon);
  const EigenPairs lowest = newton.factors().lowest(std::min(energy.dofs(), last.point.stability.negative + 1));
  if (lowest.values.size() > 0 && lowest.values.cwiseAbs().minCoeff() <= cause::soft * stiffest)
    return "a limit point or branch point is near, and branches run close to each other; more path.steps may do, or a larger imperfection, or none";
  return "";
}

}  // namespace elamin
