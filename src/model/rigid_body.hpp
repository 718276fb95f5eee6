#pragma once
// Rigid bodies with rounded corners.
#include "model/model.hpp"

#include <optional>
#include <string>
#include <vector>

namespace elamin {

struct RigidBody {
  std::string name;
  CoreMesh core;                                   // without mistakes
  double radius = 0;                               // of the ball that rounds it [length]
  Pose pose;                                       // of the frame of the core
  double density = 0, mass = 0;                    // one of these, or none: not given
  std::optional<Mat3> inertia;                     // about the centre of mass; default: of a uniform solid
  bool centered = false;                           // the centre of mass is the origin of the frame; default: that of a uniform solid
};

/// Appends the bodies, each the next id, one new type, and its Structure. In the model the frame of a body has its origin in the
/// centre of mass. Throws InputError if the numbers of ids or types end before that.
void add_bodies(Model& model, const std::vector<RigidBody>& bodies);

}  // namespace elamin
