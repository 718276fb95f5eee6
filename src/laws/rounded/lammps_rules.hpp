#pragma once
// The contact rules that LAMMPS follows in pair_style body/rounded/polyhedron and fix wall/body/polyhedron: forces for
// comparison and for dynamics, not a potential.
#include "laws/rounded/core_distance.hpp"
#include "laws/rounded/kernel.hpp"
#include "laws/rounded/pose.hpp"


namespace elamin {

enum class LammpsHow {
  direct,                                      // the kernel's force once
  scaled,                                      // touching: the kernel's force times the area factor
  dropped,                                     // touching, too near to another contact: energy, no elastic force
  through                                      // an edge through a face: if touching, energy and no elastic force
};

/// One hit, in the words of the rules: the point of `first_of` the pair's bodies (0 or 1) on its feature, the foot on
/// the other's.
struct LammpsContact {
  int first_of = 0;
  Feature first, second;
  double gap = 0;
  LammpsHow how = LammpsHow::direct;
  Vec3 point = Vec3::Zero(), foot = Vec3::Zero(), normal = Vec3::Zero();   // world; normal from foot to point
};

struct LammpsPair {
  double energy = 0;                           // as LAMMPS reports it: RoundedKernel::reported
  std::array<Wrench, 2> on;                    // bodies i and j
  std::array<Wrench, 2> damping;               // of that, what c_n and c_t do
  double area_factor = 1;                      // j_a ≥ 1
  bool through = false;                        // an edge passes through a face: the cores overlap
  bool overflow = false;                       // more than 32 touching contacts: LAMMPS writes beyond its list
  bool parallel = false;                       // parallel edges met at mid points: force and torque are no gradient
  bool dropped = false;
  /// Whether, at rest and without friction, the forces are minus the gradient of the energy while the set of contacts
  /// stays.
  bool conservative() const { return area_factor == 1 && !through && !parallel && !dropped; }
};

/// The rules of a pair. Source: LAMMPS 29 Sep 2021, its manual and its answers (data/polyhedra/README.md, section 3).
///   f = −U′(δ) of the coded kernel along n, from foot to point; hits at δ > 0: f n. At δ ≤ 0:
///   (j_a + μ) f n − c_n v_n − c_t v_t, v the relative velocity of the two points, v_n = (v·n) n, v_t = v − v_n;
///   with a sphere: f n − c_n v_n − c_t v_t.
///   j_a = max(1, area/(kept · unit_area)) for three and more touching contacts, else 1;
///   area = π · mean squared distance of their points from their mean.
/// One constant 1e-3 serves for lengths, angles and parameters: the rules are not free of scale, and the order of the
/// two bodies matters where edges are parallel or j_a > 1.
struct LammpsRules {
  RoundedKernel kernel;                        // Form::coded
  double normal_damping = 0;                   // c_n
  double tangential_damping = 0;               // c_t
  double friction = 0;                         // μ
  double unit_area = 1;                        // δ_ua; LAMMPS takes a negative one for 1; not 0

  /// Body i before j, as in the file. Contacts, if wanted, are appended.
  LammpsPair pair(const RoundedBody& i, const RoundedBody& j, const BodyMotion& vi = {}, const BodyMotion& vj = {},
                  std::vector<LammpsContact>* contacts = nullptr) const;
};

/// fix wall/body/polyhedron between two planes across an axis. Of the side nearer to the centre every vertex with
/// unsigned distance s ≤ ρ has the force k_n (ρ − s) away from the plane on its own side, −c_n v_n − c_t v_t; no
/// energy; nothing if the centre is farther than the core's extent + ρ (sphere: ρ). LAMMPS's default c_t is c_n/2.
struct LammpsWall {
  double stiffness = 0, normal_damping = 0, tangential_damping = 0;
  int axis = 2;
  double lo = -infinity;                // infinite: no wall
  double hi = infinity;

  /// All of it; what c_n and c_t do of that is added to `damping`, if wanted.
  Wrench on(const RoundedBody& body, const BodyMotion& motion = {}, Wrench* damping = nullptr) const;
};

}  // namespace elamin
