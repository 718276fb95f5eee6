#pragma once
// What touches what, for tables and pictures.
#include "core/types.hpp"

#include <compare>

namespace elamin {

/// Which contact it is. Two entities (see model/entities.hpp), or one and a face of a wall; indices from 0.
struct TouchKey {
  int particle = 0;          // or body: entity
  int other = -1;            // the other entity, −1: it is a wall
  int wall = -1;             // of Model::walls, −1: it is an entity
  int feature = -1;          // of bodies, where they may touch at several places: see body_touches.hpp
  auto operator<=>(const TouchKey&) const = default;
};

/// One contact.
struct Touch {
  int particle = 0, other = -1, wall = -1;   // see TouchKey
  double gap = 0;            // distance of the surfaces; negative: overlap [length]
  Vec3 force = Vec3::Zero(); // on `particle`
  Vec3 point = Vec3::Zero(); // of contact: on the line of centres in the middle of the overlap, or on the wall
  bool bears = false;        // a hard contact that bears a force: its gap is zero to rounding
  bool attracts = false;     // bodies apart within the cutoff of an attraction
  int feature = -1;
  Vec3 normal = Vec3::Zero();   // of bodies: unit, the direction of a repulsive force on `particle`; gap grows with n·(x − x_other)
  TouchKey key() const { return {particle, other, wall, feature}; }
};

}  // namespace elamin
