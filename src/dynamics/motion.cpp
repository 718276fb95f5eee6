#include "dynamics/motion.hpp"

#include "core/error.hpp"
#include "dynamics/moving_bodies.hpp"
#include "dynamics/verlet.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>

namespace elamin {

Motion begin_motion(const Model& model) {
  Motion m;
  const int n = model.particles();
  m.state = model.restart.value_or(model.start);
  m.velocity = model.velocity.cols() == n ? model.velocity : Field(Field::Zero(3, n));
  m.angular_velocity = model.angular_velocity.cols() == n ? model.angular_velocity : Field(Field::Zero(3, n));
  m.force = Field::Zero(3, n);
  const auto bodies = static_cast<Eigen::Index>(model.bodies.size());
  m.body_velocity = model.body_velocity.cols() == bodies ? model.body_velocity : Field(Field::Zero(3, bodies));
  m.angular_momentum = model.angular_momentum.cols() == bodies ? model.angular_momentum : Field(Field::Zero(3, bodies));
  m.body_force = m.torque = Field::Zero(3, bodies);
  return m;
}

void refuse_what_cannot_move(const Model& model, const Kinematics& kinematics) {
  std::vector<Mistake> mistakes;
  const auto add = [&](const std::string& key, const std::string& what) { mistakes.push_back({"", 0, 0, key, what}); };
  int massless = 0, first = -1;
  for (int d = 0; d < kinematics.dofs(); ++d)
    if (const int p = kinematics.site_of(d); p < model.particles() && !(model.mass(p) > 0) && p != first) ++massless, first = p;
  if (massless > 0)
    add("density", fmt::format("{} particle{} can move but {} no mass (the last is {}); dynamics needs a density and a diameter",
                               massless, massless > 1 ? "s" : "", massless > 1 ? "have" : "has", called(model, first)));
  for (const PairContact& c : model.contacts)
    if (c.hard) add("contact.hard", fmt::format("the contact between '{}' and '{}' is hard; dynamics needs elastic ones", c.between[0], c.between[1]));
  for (const Wall& w : model.walls)
    if (w.hard) add("wall.hard", fmt::format("the wall '{}' is hard; dynamics needs elastic ones", w.name));
  for (const Mistake& m : MovingBodies::mistakes(model, kinematics)) mistakes.push_back(m);
  if (!mistakes.empty()) throw InputError(mistakes);
}

}  // namespace elamin
