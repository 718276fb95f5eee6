#pragma once
// All forces of a model on plain doubles, as fast as they come: without energies, exact tails, or anything allocated.
#include "dynamics/body_forces.hpp"
#include "dynamics/columns.hpp"
#include "dynamics/edge_forces.hpp"
#include "dynamics/wall_forces.hpp"
#include "energy/element_group.hpp"

#include <memory>
#include <optional>

namespace elamin {

// What has no fast way of its own: rest angles, pressures, angles that share an edge's end with another one.

/// Forces of the bonds and angles that an EdgeOrder left out and of the pressures, by way of the groups of the energy.
class OtherForces {
 public:
  OtherForces(const Model& model, const EdgeOrder& order, double load_factor);
  static bool needed(const Model& model, const EdgeOrder& order) {
    return !order.bonds.empty() || !order.angles.empty() || !model.pressures.empty();
  }
  void add(const Columns& x, Rows& force);

 private:
  Model part_;                                  // the model with nothing but these bonds, angles and pressures
  std::vector<std::unique_ptr<ElementGroup>> groups_;
  State state_;
  std::vector<double> value_, gradient_;
};

/// The forces at a load factor that stays. prepare() finds what particles push on each other; what is left is done for four
/// particles at a time by whoever moves them, so that everything is still near when it is wanted again: see on().
class Forces {
 public:
  Forces(const Model& model, double load_factor);
  Forces(const Forces&) = delete;
  Forces& operator=(const Forces&) = delete;

  bool damped() const { return pushes_.damped(); }
  bool rubs() const { return pushes_.rubs(); }
  /// Whether positions are wanted by row, in movement().
  bool by_row() const { return by_row_; }
  Movement& movement() { return movement_; }
  /// Where bodies are, as prepare() wants it; with bodies only.
  BodyPlaces& places() { return places_; }
  /// What acts on the bodies, after prepare(); none: there are no bodies.
  const BodyForces* bodies() const { return bodies_ ? &*bodies_ : nullptr; }

  /// Says that no particle has moved farther than this since the last call of prepare() [length].
  void moved(double distance) { travelled_ += distance; }
  /// Elastic forces and loads at x; damping and friction with the velocities and angular velocities of movement(), whose positions are x.
  void prepare(const Columns& x);
  /// Elastic force and loads on particles 4·block …, after prepare(), block after block; x as there, but for particles of
  /// blocks before this one, which may have moved on.
  [[gnu::always_inline]] Triple<Lanes> on(int block, const Columns& x) {
    Triple<Lanes> f = edges_.on(block, x);
    if (loaded_) f = f + loads_.load(4 * block);
    if (pushes()) f = f + pushes_.force.load(4 * block);
    return f;
  }
  /// Damping and friction on them; only if damped().
  Triple<Lanes> damping_on(int block) const { return pushes_.damping.load(4 * block); }
  Triple<double> damping_at(int particle) const { return pushes_.damping.at(particle); }
  /// All that goes on from step to step.
  void carry(Archive& archive);
  /// The torque on a particle; only if rubs().
  Lanes torque_on(int particle) const { return pushes_.torque.row[particle]; }

 private:
  Forces(const Model& model, double load_factor, const EdgeOrder& order);
  bool pushes() const { return by_row_ || others_.has_value(); }
  void push(const Columns& x);
  void find_near(const Columns& x);
  double farthest(const Columns& x) const;

  int particles_ = 0;
  EdgeForces edges_;
  Columns loads_;
  std::optional<ContactRules> rules_;
  std::optional<PairForces> pairs_;
  std::optional<WallForces> walls_;
  std::optional<OtherForces> others_;
  std::optional<BodyForces> bodies_;
  BodyPlaces places_;
  bool by_row_ = false, loaded_ = false;
  double skin_ = 0, travelled_ = 0;
  Columns listed_;                              // where everything was when the lists were made
  Movement movement_;
  Pushes pushes_;
};

}  // namespace elamin
