#include "model/rigid_body.hpp"

#include "model/append.hpp"

namespace elamin {

void add_bodies(Model& model, const std::vector<RigidBody>& bodies) {
  int id = next_id(model, static_cast<int>(bodies.size())), type = next_type(model, static_cast<int>(bodies.size()));
  for (const RigidBody& b : bodies) {
    RoundedShape shape = rounded_shape(b.core, b.radius);
    const MassProperties uniform = mass_properties(shape);
    Pose pose = b.pose;
    if (!b.centered && uniform.center.norm() > 1e-12 * shape.bounding_radius()) {           // else rounding alone
      shape = rounded_shape(moved_origin(b.core, uniform.center), b.radius);
      pose.position = pose.position + ExactVector{pose.rotation * uniform.center, Vec3::Zero()};
    }
    Body body;
    body.shape = static_cast<int>(model.shapes.size()), body.id = id++, body.type = type++;
    const double density = b.mass > 0 ? b.mass / uniform.volume : b.density;
    body.mass = b.mass > 0 ? b.mass : density * uniform.volume;
    body.inertia = b.inertia.value_or(density * uniform.inertia);
    const int index = static_cast<int>(model.bodies.size());
    model.structures.push_back({b.name, "body", model.particles(), 0, 0, -1, -1, index, 1});
    model.shapes.push_back(std::move(shape));
    model.bodies.push_back(body);
    model.start.bodies.push_back(pose);
    for (Field* f : {&model.body_velocity, &model.angular_momentum})
      if (f->cols() > 0) {
        f->conservativeResize(3, index + 1);
        f->col(index).setZero();
      }
  }
}

}  // namespace elamin
