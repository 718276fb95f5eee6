#pragma once
// Which pairs of rigid bodies, or of a body and a particle, feel each other at all, and by which table.
#include "model/model.hpp"

namespace elamin {

/// Entities: particle after particle, then body after body. For every pair with a body in it the last table that speaks of it;
/// not between a body and what is glued to it, or bonded to what is glued to it. Entities that belong to the same
/// sides of the same tables are of one class; tables are looked up by pairs of classes.
class BodyRules {
 public:
  explicit BodyRules(const Model& model);

  /// Whether any body is in a table.
  bool any() const { return any_; }
  int entities() const { return static_cast<int>(class_.size()); }
  int particles() const { return particles_; }
  bool is_body(int entity) const { return entity >= particles_; }
  /// Index into Model::rounded of the table in force, −1: none.
  int table(int i, int j) const;
  /// Of the sphere around an entity that meets that of everything it feels: its own and half the largest cutoff; 0: it is in
  /// no table. [length]
  double cutoff_radius(int entity) const { return cutoff_radius_[entity]; }
  /// The place of an entity; as a body: a particle is a ball. [length]
  Vec3 position(int entity, const State& state) const;
  RoundedBody body(int entity, const State& state) const;

 private:
  const Model& model_;
  bool any_ = false;
  int particles_ = 0;
  std::vector<int> class_, tables_;            // tables_: classes × classes
  std::size_t classes_ = 0;
  std::vector<double> cutoff_radius_;
  std::vector<std::pair<int, int>> glued_;     // particle, body: ascending
  std::vector<RoundedShape> balls_;            // a radius each
  std::vector<int> ball_;                      // of each particle
};

}  // namespace elamin
