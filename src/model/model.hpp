#pragma once
// A structure made of glued particles: what there is, how it is held and loaded. No mathematics, no input.
#include "laws/region.hpp"
#include "laws/section.hpp"
#include "model/state.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

struct BondType { double stiffness, rest_length; };   // U = K (r − r₀)²: K [energy/length²], r₀ [length]
/// U = B (1 − cos(θ − θ₀)): B [energy], θ₀ [rad]; θ₀ = π, straight, is LAMMPS's cosine, others its cosine/shift.
struct AngleType { double stiffness, rest = pi; };
struct Bond { int type; std::array<int, 2> particles; };    // particles by index from 0
struct Angle { int type; std::array<int, 3> particles; };   // the middle one second

/// A named set of particles, indices from 0, ascending.
struct Group {
  std::string name;
  std::vector<int> particles;
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

/// Particles whose chosen coordinates are prescribed: x = X + s(λ) d, X where they are in Model::start or in `reference`.
struct Support {
  std::string group;
  std::vector<int> particles;
  std::array<bool, 3> held{true, true, true};   // x, y, z
  Vec3 displacement = Vec3::Zero();             // [length]
  Scaling scaling;
  std::vector<ExactVector> reference = {};      // of each of the particles, unless empty
  Vec3 velocity = Vec3::Zero();                 // of what is held, in dynamics [length/time]
};

/// Dead load on each of these particles: energy −s(λ) Σ F·x.
struct Load {
  std::string group;
  std::vector<int> particles;
  Vec3 force = Vec3::Zero();                    // on every particle …
  Scaling scaling;
  Field own = {};                               // … and besides, unless empty, on each its own: 3 × particles
  Vec3 on(std::size_t k) const { return own.size() ? Vec3(force + own.col(static_cast<Eigen::Index>(k))) : force; }
};

/// Weight: energy −s(λ) m a·x.
struct Gravity {
  std::string group;
  std::vector<int> particles;
  Vec3 acceleration = Vec3::Zero();
  Scaling scaling = Scaling::constant();
};

/// Pressure from outside on a closed row of particles, in a plane: energy s(λ) p A with the area inside, projected along
/// the plane's normal n, A = ½ Σ n·(xᵢ × xᵢ₊₁), positive for a row that runs counterclockwise about n. It stays normal
/// to the row: hydrostatic.
struct Pressure {
  std::string loop;
  std::vector<int> particles;                   // in the order of the row
  Vec3 normal = Vec3::UnitZ();                  // of length 1
  double pressure = 0;                          // p [force/length]
  Scaling scaling;
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
  std::optional<int> exclude_bonds;             // pairs this many bonds apart or nearer feel nothing; see Energy
  bool hard = false;                            // hertz: impenetrable, gap ≥ 0, instead of elastic
  ContactDamping damping = {};
};

/// A rigid surface that the particles of a group touch: moved by s(λ) d, its radius larger by s(λ) ΔR.
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
};

/// Drag −γ v: no energy; matters in dynamics and in the forces of a moving state.
struct Viscosity {
  std::vector<int> particles;
  double coefficient = 0;
};

/// A set of particles that was built as one thing, for messages and `check`.
struct Structure {
  std::string name, kind;                       // kind: "beam", "loop", "sheet", "grains", "lammps"
  int first = 0, count = 0;                     // its particles
  double youngs_modulus = 0;                    // 0: not known
  int bond_type = -1, angle_type = -1;          // its first ones, or none
};

struct Model {
  State start;                                  // the reference configuration X
  std::optional<State> restart;                 // where to start from instead, with its load factor
  std::vector<int> id;                          // LAMMPS's own, or counted from 1
  std::vector<int> type, molecule;              // from 1
  std::vector<double> diameter, density;        // density 0: not given
  Field velocity;                               // 3 × particles, or empty: at rest
  Field spin;                                   // angular velocities, 3 × particles, or empty: none
  std::vector<BondType> bond_types;
  std::vector<AngleType> angle_types;
  std::vector<Bond> bonds;
  std::vector<Angle> angles;
  std::vector<Structure> structures;
  std::vector<Group> groups;                    // structures' own, "all", then the named ones
  std::vector<Support> supports;
  std::vector<PairContact> contacts;
  std::vector<Wall> walls;
  std::vector<Load> loads;
  std::vector<Gravity> gravity;
  std::vector<Pressure> pressures;
  std::vector<Change> changes;
  std::vector<Viscosity> viscosity;
  std::optional<int> plane_normal;              // 0, 1, 2: the coordinate that every particle keeps

  int particles() const { return static_cast<int>(start.particles()); }
  /// Mass of particle i: density · π d³/6.
  double mass(int i) const { return density[i] * pi / 6 * diameter[i] * diameter[i] * diameter[i]; }
};

}  // namespace elamin
