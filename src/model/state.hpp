#pragma once
// Where everything is: the configuration that an energy is a function of.
#include "laws/rounded/pose.hpp"

#include <algorithm>
#include <vector>

namespace elamin {

/// The force with which a hard contact keeps its gap from closing further: a multiplier, positive. Between a particle and
/// another one, or a wall's face (numbered as its open faces are).
struct HardForce {
  int particle = 0, other = -1, wall = -1, face = -1;
  double force = 0;
  bool operator==(const HardForce&) const = default;
};

/// Positions of all particles as position + low (about 32 digits), poses of all rigid bodies, and the load factor λ.
/// A chain of N particles has a condition number of about 5 N⁴; the low words keep differences of neighbours exact to the
/// last bit although the positions are large beside them.
struct State {
  Field position;          // 3 × particles [length]
  Field low;              // 3 × particles, what the rounding of `position` left out
  std::vector<Pose> bodies;
  double load_factor = 0;
  std::vector<HardForce> hard;   // of the hard contacts that bear a force

  template <class A> void carry(A& archive) { archive(position, low, bodies, load_factor, hard); }
  State() = default;
  explicit State(Field positions) : position(std::move(positions)), low(Field::Zero(3, position.cols())) {}

  Eigen::Index particles() const { return position.cols(); }
  ExactVector at(Eigen::Index i) const { return {position.col(i), low.col(i)}; }
  void set(Eigen::Index i, const ExactVector& x) { position.col(i) = x.hi, low.col(i) = x.lo; }
};

/// Whether all numbers of two states of a model are the same.
inline bool identical(const State& a, const State& b) {
  const auto same_pose = [](const Pose& p, const Pose& q) {
    return p.position.hi == q.position.hi && p.position.lo == q.position.lo && p.rotation.coeffs() == q.rotation.coeffs();
  };
  return a.load_factor == b.load_factor && a.particles() == b.particles() && a.position == b.position && a.low == b.low && a.hard == b.hard &&
         std::equal(a.bodies.begin(), a.bodies.end(), b.bodies.begin(), b.bodies.end(), same_pose);
}

/// b − a of all particles, 3 × particles [length]; with bodies see Kinematics::difference.
inline Field displacement(const State& a, const State& b) { return (b.position - a.position) + (b.low - a.low); }

}  // namespace elamin
