#pragma once
// A structure made of glued particles: what there is, how it is held and loaded. No mathematics, no input.
#include "laws/cohesion.hpp"
#include "laws/region.hpp"
#include "laws/rounded/kernel.hpp"
#include "laws/section.hpp"
#include "model/state.hpp"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

class ElementGroup;
class Energy;

struct BondType { double stiffness, rest_length; };   // U = K (r − r₀)²: K [energy/length²], r₀ [length]
/// U = B (1 − cos(θ − θ₀)): B [energy], θ₀ [rad]; θ₀ = π, straight, is LAMMPS's cosine, others its cosine/shift.
struct AngleType { double stiffness, rest = pi; };
struct Bond { int type; std::array<int, 2> particles; };    // particles by index from 0
struct Angle { int type; std::array<int, 3> particles; };   // the middle one second

/// A rigid body: the solid of a shape, its centre of mass at the origin of the shape's frame.
struct Body {
  int shape = 0;                                // of Model::shapes
  int id = 1, type = 1;                         // LAMMPS's own, or counted on from the particles
  double mass = 0;                              // 0: not given
  Mat3 inertia = Mat3::Zero();                  // about the centre of mass, in the frame of the shape [mass·length²]
};

/// A particle that a body carries: at x + R arm.
struct Glued {
  int particle = 0, body = 0;
  Vec3 arm = Vec3::Zero();                      // in the frame of the body [length]
};

/// A named set of particles and bodies, indices from 0, ascending.
struct Group {
  std::string name;
  std::vector<int> particles;
  std::vector<int> bodies = {};
};

/// How much of a condition acts at load factor λ: fixed + rate λ. What is scaled has {0, 1}, what is constant {1, 0}.
struct Scaling {
  double fixed = 0, rate = 1;
  constexpr Scaling() = default;
  constexpr Scaling(double fixed_part, double rate_of_change) : fixed(fixed_part), rate(rate_of_change) {}
  static constexpr Scaling constant() { return {1, 0}; }
  constexpr double at(double load_factor) const { return fixed + rate * load_factor; }
  bool operator==(const Scaling&) const = default;
};

/// Particles and bodies whose chosen coordinates are prescribed: x = X + s(λ) d, X where they are in Model::start or in
/// `reference`; bodies besides turned by R = exp([s(λ) φ]×) R₀ where they may not turn freely. Of the three turns of a body
/// none, two or all are held: to hold one alone is no condition on where it is, only on how it gets there.
struct Support {
  std::string group;
  std::vector<int> particles;
  std::array<bool, 3> held{true, true, true};   // x, y, z
  Vec3 displacement = Vec3::Zero();             // [length]
  Scaling scaling;
  std::vector<ExactVector> reference = {};      // of each of the particles, unless empty
  Vec3 velocity = Vec3::Zero();                 // of what is held, in dynamics [length/time]
  std::vector<int> bodies = {};
  std::array<bool, 3> constrained_rotations{false, false, false};   // of the bodies, about x, y, z
  Vec3 rotation = Vec3::Zero();                 // φ, a rotation vector, where all turns are held [rad]
  std::vector<Pose> body_reference = {};        // of each of the bodies, unless empty
};

/// Dead load on each of these particles and bodies: energy −s(λ) Σ F·x, of bodies at x + R point. A torque τ on bodies
/// has the energy −s(λ) τ·φ, φ the rotation vector from where the body was at the start: with a fixed axis a constant torque.
struct Load {
  std::string group;
  std::vector<int> particles;
  Vec3 force = Vec3::Zero();                    // on every particle …
  Scaling scaling;
  Field own = {};                               // … and besides, unless empty, on each its own: 3 × particles
  std::vector<int> bodies = {};
  Vec3 point = Vec3::Zero();                    // of bodies, in their frame [length]
  Vec3 torque = Vec3::Zero();                   // on every body [force·length]
  Vec3 on(std::size_t k) const { return own.size() ? Vec3(force + own.col(static_cast<Eigen::Index>(k))) : force; }
};

/// Weight: energy −s(λ) m a·x.
struct Gravity {
  std::string group;
  std::vector<int> particles;
  Vec3 acceleration = Vec3::Zero();
  Scaling scaling = Scaling::constant();
  std::vector<int> bodies = {};
};

/// Pressure from outside on a closed row of particles, in a plane: energy s(λ) p A with the area inside, projected along
/// the plane's normal n, A = ½ Σ n·(xᵢ × xᵢ₊₁), positive for a row that runs counterclockwise about n. It stays normal
/// to the row: hydrostatic.
/// Or on a sheet, whose rim is held: energy s(λ) p V, V = Σ (x₀ − tip)·((x₁ − tip) × (x₂ − tip))/6 of its triangles, the volume
/// between it and the tip. On the particles of the rim, where the sides of that cone end, dead forces take back what is theirs.
struct Pressure {
  std::string of;                               // the loop or the sheet
  std::vector<int> particles;                   // in the order of the row
  Vec3 normal = Vec3::UnitZ();                  // of a loop, of length 1
  double pressure = 0;                          // p [force/length], on a sheet [force/length²]
  Scaling scaling;
  std::vector<std::array<int, 3>> triangles = {};   // of a sheet, counterclockwise as seen from where the pressure comes
  Vec3 tip = Vec3::Zero();
  Field rim = {};                               // of a sheet: forces on the particles at p = 1, 3 × particles [length²]
};

/// Growth and stiffening: r₀, K and B times 1 + s(λ) c, each with its c, of the bonds and angles whose particles are all
/// among these. Where several act on one, their s c add up.
struct Change {
  std::string group;
  std::vector<int> particles;
  double rest_length = 0, bond_stiffness = 0, angle_stiffness = 0;
  Scaling scaling;
};

/// What a contact does beside its elastic force, in dynamics only; with k = F/δ, a = √(R_eff δ), m the
/// effective mass: normal damping −η vₙ with η = γ (velocity), γ m (mass_velocity), γ a m (viscoelastic), γ √(m k) (tsuji);
/// friction without history, −min(μ |Fₙ|, x η |vₜ|) vₜ/|vₜ|.  The words and factors of LAMMPS's pair_style granular.
struct ContactDamping {
  enum class Model { none, velocity, mass_velocity, viscoelastic, tsuji };
  Model model = Model::none;
  double coefficient = 0;                       // γ; of tsuji from the coefficient of restitution
  double tangential = 0;                        // x, ratio of tangential to normal damping
  double friction = 0;                          // μ
  bool operator==(const ContactDamping&) const = default;
};

/// What two particles feel of each other that are not glued: Hertz's contact or Lennard-Jones's cohesion.
/// Where two tables of one law speak of a pair, the later one holds, as with LAMMPS's pair_coeff; different laws add.
struct PairContact {
  enum class Law { hertz, lj };
  std::array<std::string, 2> between;           // names of the groups
  std::array<std::vector<int>, 2> particles;    // theirs; a pair has one of each, equal groups: any two
  Law law = Law::hertz;
  double effective_modulus = 0;                 // hertz: E_eff; 0: no contact
  double epsilon = 0, sigma = 0, cutoff = 0;    // lj
  CutoffStyle cutoff_style = CutoffStyle::cut;
  double inner_cutoff = 0;                      // lj, smooth
  std::optional<int> exclude_bonds;             // pairs this many bonds apart or nearer feel nothing; see Energy
  bool hard = false;                            // hertz: impenetrable, gap ≥ 0, instead of elastic
  ContactDamping damping = {};
};

/// How rounded bodies feel each other: by one of two true potentials, or by LAMMPS's own rules, which have none.
enum class RoundedFormulation { multi, closest, lammps };

/// What acts besides where rounded bodies touch, in dynamics only; see RoundedFriction and LammpsRules.
struct RoundedDamping {
  double normal = 0, tangential = 0;            // c_n, c_t [force·time/length]
  double friction = 0;                          // μ
  double slip = 0;                              // η of the potentials' friction [force·time/length]
  bool apart = false;                           // normal damping within the cutoff, as printed; else on overlap, as coded
};

/// What two rounded bodies feel of each other, or a body and a particle, which is a ball. Where two tables speak of a
/// pair, the later one holds.
struct RoundedPair {
  std::array<std::string, 2> between;           // names of the groups
  std::array<std::vector<int>, 2> particles, bodies;   // theirs
  RoundedFormulation formulation = RoundedFormulation::multi;
  RoundedKernel kernel;
  RoundedDamping damping = {};
  double unit_area = 1;                         // δ_ua of LAMMPS's rules
};

/// A rigid surface that the particles and bodies of a group touch: moved by s(λ) d, its radius larger by s(λ) ΔR.
struct Wall {
  std::string name, group;
  std::vector<int> particles;
  Region region;                                // where s(λ) = 0
  bool inside = true;                           // the particles are inside of the region; else outside
  double effective_modulus = 0;                 // E_eff
  bool curved = false;                          // effective radius with the wall's curvature; else the particle's radius
  Vec3 displacement = Vec3::Zero();             // d of the wall [length]
  double radius_change = 0;                     // ΔR of its radius (of a cone: of both) [length]
  Scaling scaling;
  bool hard = false;                            // impenetrable, gap ≥ 0, instead of elastic
  ContactDamping damping = {};
  std::vector<int> bodies = {};
  RoundedKernel kernel = {};                    // of the bodies' vertices
  RoundedDamping body_damping = {};
  bool lammps = false;                          // bodies: as fix wall/body/polyhedron, a force without energy
};

/// Drag −γ v: no energy; matters in dynamics and in the forces of a moving state.
struct Viscosity {
  std::vector<int> particles;
  double coefficient = 0;
  std::vector<int> bodies = {};
};

/// A set of particles and bodies that was built as one thing, for messages and `check`.
struct Structure {
  std::string name, kind;                       // kind: "beam", "loop", "sheet", "grains", "body", "lammps"
  int first = 0, count = 0;                     // its particles
  double youngs_modulus = 0;                    // 0: not known
  int bond_type = -1, angle_type = -1;          // its first ones, or none
  int first_body = 0, bodies = 0;
  Vec3 up = Vec3::Zero();                       // of a sheet the second of its axes, of length 1: see Sheet
  bool has(int particle) const { return particle >= first && particle < first + count; }
};

/// A law that a program brings along: every Energy of the model adds its elements, as Energy::add does.
struct OwnLaw {
  std::string term;                             // name of its energy
  std::vector<std::vector<int>> elements;       // of each element the particles, which it holds together as a bond does
  bool anchored = false;                        // it holds them in space, too: its energy changes where an element is moved as a whole
  std::function<std::unique_ptr<ElementGroup>(const Energy&)> group;   // its sites are particles, and what carries them
};

struct Model {
  State start;                                  // the reference configuration X
  std::optional<State> restart;                 // where to start from instead, with its load factor
  std::vector<int> id;                          // LAMMPS's own, or counted from 1
  std::vector<int> type, molecule;              // from 1
  std::vector<double> diameter, density;        // density 0: not given
  Field velocity;                               // 3 × particles, or empty: at rest
  Field angular_velocity;              // 3 × particles, or empty: none
  std::vector<RoundedShape> shapes;
  std::vector<Body> bodies;                     // at start.bodies
  Field body_velocity, angular_momentum;        // of bodies, axes of space, 3 × bodies, or empty: at rest
  std::vector<Glued> glued;                     // ascending by particle, none twice
  std::vector<BondType> bond_types;
  std::vector<AngleType> angle_types;
  std::vector<Bond> bonds;
  std::vector<Angle> angles;
  std::vector<Structure> structures;
  std::vector<Group> groups;                    // structures' own, "all", then the named ones
  std::vector<Support> supports;
  std::vector<PairContact> contacts;
  std::vector<RoundedPair> rounded;
  std::vector<Wall> walls;
  std::vector<Load> loads;
  std::vector<Gravity> gravity;
  std::vector<Pressure> pressures;
  std::vector<Change> changes;
  std::vector<Viscosity> viscosity;
  double imperfection = 0;                      // how far a particle was moved at most from the perfect shape [length]
  std::optional<int> plane_normal;              // 0, 1, 2: the coordinate that every particle keeps
  std::vector<OwnLaw> own;

  int particles() const { return static_cast<int>(start.particles()); }
  RoundedBody body(int b, const State& state) const { return {&shapes[bodies[b].shape], state.bodies[b]}; }
  /// Mass of particle i: density · π d³/6; of a point, without diameter, what stands for its density, as in LAMMPS.
  double mass(int i) const { return diameter[i] > 0 ? density[i] * pi / 6 * diameter[i] * diameter[i] * diameter[i] : density[i]; }
};

}  // namespace elamin
