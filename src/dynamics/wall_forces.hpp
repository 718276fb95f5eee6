#pragma once
// Particles at walls on plain doubles; only those that are near are asked.
#include "dynamics/pair_forces.hpp"
#include "laws/wall_contact.hpp"

namespace elamin {

/// Walls as they stand at a load factor; they do not move.
class WallForces {
 public:
  WallForces(const Model& model, double load_factor, double skin);

  bool any() const { return !walls_.empty(); }
  bool damped() const { return damped_; }
  bool rubs() const { return rubs_; }
  /// Looks for the particles that are near a wall.
  void find(const Columns& x);
  void add(const Movement& movement, Pushes& pushes);

 private:
  struct Near { int wall, particle; };
  void damp(const Near& near, const WallPress& press, double stiffness, const Movement& movement, Pushes& pushes) const;

  const Model& model_;
  double skin_;
  std::vector<WallContact> walls_;              // as many as Model::walls
  bool damped_ = false, rubs_ = false;
  std::vector<Near> near_;                      // wall after wall, particles ascending
};

}  // namespace elamin
