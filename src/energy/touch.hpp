#pragma once
// What touches what, for tables and pictures.
#include "core/types.hpp"

namespace elamin {

/// One contact: two particles, or a particle and a face of a wall. Indices from 0.
struct Touch {
  int particle = 0;
  int other = -1;            // the other particle, −1: it is a wall
  int wall = -1;             // of Model::walls, −1: it is a particle
  double gap = 0;            // distance of the surfaces; negative: overlap [length]
  Vec3 force = Vec3::Zero(); // on `particle`
  Vec3 point = Vec3::Zero(); // of contact: on the line of centres in the middle of the overlap, or on the wall
  bool bears = false;        // a hard contact that bears a force: its gap is zero to rounding
};

}  // namespace elamin
