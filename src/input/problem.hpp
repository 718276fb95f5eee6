#pragma once
// A problem file as plain numbers: every table a struct, every default in it. What the file says, not what it means.
#include "core/types.hpp"
#include "laws/region.hpp"
#include "model/model.hpp"
#include "path/options.hpp"
#include "input/structure_tables.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// What a contact does in dynamics beside its elastic force; see ContactDamping.
struct DampingKeys {
  ContactDamping::Model model = ContactDamping::Model::none;
  std::optional<double> coefficient;            // γ …
  std::optional<double> restitution;            // … or of tsuji this
  double friction = 0, friction_damping = 1;    // μ; ratio of tangential to normal damping
  bool operator==(const DampingKeys&) const = default;
};

/// Of the law "rounded", between bodies, and between bodies and particles; its cutoff is that of the table.
struct RoundedKeys {
  double k_n = 0, k_na = 0;                     // [force/length]
  RoundedFormulation formulation = RoundedFormulation::multi;
  RoundedKernel::Form kernel = RoundedKernel::Form::coded;
  std::optional<double> delta_ua;               // of LAMMPS's rules; default 1
  double mu = 0, c_n = 0, c_t = 0;              // friction; damping [force·time/length]
  double slip = 0;                              // η of the friction of the potentials [force·time/length]
  bool apart = false;                           // damping = "printed": within the cutoff; else on overlap
  bool operator==(const RoundedKeys&) const = default;
};

struct ContactTable {
  TablePlace place;
  std::array<std::string, 2> between;
  std::string law = "hertz";                    // or "lj", "rounded"
  std::vector<double> youngs_modulus, poissons_ratio;   // one number, or of unlike materials two
  std::optional<double> effective_modulus;
  std::optional<int> exclude_bonds;
  std::optional<double> epsilon, sigma, cutoff, inner_cutoff;
  CutoffStyle cutoff_style = CutoffStyle::cut;
  bool hard = false;                            // hertz: impenetrable instead of elastic
  DampingKeys damping;
  RoundedKeys rounded;
  std::string from_stage;                       // in force from that stage on; "": from the start
  bool operator==(const ContactTable&) const = default;
};

struct WallTable {
  TablePlace place;
  std::string name, group = "all";
  Region region;
  bool inside = true;
  std::optional<double> youngs_modulus, poissons_ratio, effective_modulus;
  std::optional<double> k_n, c_t;               // of bodies: [force/length]; default of c_t: c_n/2
  double k_na = 0, cutoff = 0, c_n = 0;
  bool lammps = false;                          // formulation = "lammps"
  bool curved = false;                          // effective_radius = "curved"
  Vec3 displacement = Vec3::Zero();
  double radius_change = 0;
  bool hard = false;                            // impenetrable instead of elastic
  DampingKeys damping;
  std::string from_stage;                       // in force from that stage on; "": from the start
  bool operator==(const WallTable&) const = default;
};

struct LammpsTable {
  TablePlace place;
  std::string data;                             // made absolute from the folder of the problem file
  std::string bodies;                           // a data file of bodies beside it, likewise; "": none
  std::string atom_style;                       // "": what the file's "Atoms # …" says
  bool operator==(const LammpsTable&) const = default;
};

struct GroupTable {
  TablePlace place;
  std::string name;
  std::vector<std::string> of{"all"};           // what is in any of these groups …
  std::optional<std::vector<std::string>> except;   // … and in none of these
  std::optional<int> first, last, middle;       // of that
  std::optional<std::vector<int>> ids;
  struct Inside {                               // a region, as of a wall
    TablePlace place;
    Region region;
    bool operator==(const Inside&) const = default;
  };
  std::optional<Inside> inside, outside;        // what the region holds, or all but that
  bool operator==(const GroupTable&) const = default;
};

struct SupportTable {
  TablePlace place;
  std::string name;                             // "" here and below: it has none but its number
  std::string group;
  std::optional<std::string> directions, turns; // default: all; where one of them is given, none of the other
  Vec3 displacement = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();                 // in dynamics: x = x(0) + V t
  bool constant = false;
  std::string from_stage;                       // in force from that stage on; "": from the start
  std::optional<TurnTable> rotation;            // of bodies
  bool operator==(const SupportTable&) const = default;
};

struct LoadTable {
  TablePlace place;
  std::string name, group;
  std::optional<Vec3> force, total_force;       // one of these …
  std::optional<double> radial;                 // … or this: on every particle away from an axis
  std::optional<Vec3> center, axis;             // of radial; default: the mean of the group, the normal of the plane
  std::optional<Vec3> point, torque;            // of bodies: where the force acts, in their frame; besides it
  bool constant = false;
  std::string from_stage;                       // in force from that stage on; "": from the start
  bool operator==(const LoadTable&) const = default;
};

struct GravityTable {
  TablePlace place;
  std::string name, group = "all";
  Vec3 acceleration = Vec3::Zero();
  bool constant = true;
  std::string from_stage;                       // in force from that stage on; "": from the start
  bool operator==(const GravityTable&) const = default;
};

/// A pressure from outside on a [[loop]], in its plane.
struct PressureTable {
  TablePlace place;
  std::string name, loop;
  double pressure = 0;                          // [force/length]
  bool constant = false;
  std::string from_stage;                       // in force from that stage on; "": from the start
  bool operator==(const PressureTable&) const = default;
};

/// Growth and stiffening of what is between the particles of a group: relative changes.
struct ChangeTable {
  TablePlace place;
  std::string name, group;
  std::optional<double> rest_length, bond_stiffness, angle_stiffness;
  bool constant = false;
  std::string from_stage;                       // in force from that stage on; "": from the start
  bool operator==(const ChangeTable&) const = default;
};

struct ViscosityTable {
  TablePlace place;
  std::string group = "all";
  double coefficient = 0;
  bool operator==(const ViscosityTable&) const = default;
};

/// Velocity at the start of a motion, of every particle and body of a group; what is held moves as its support says.
struct VelocityTable {
  TablePlace place;
  std::string group = "all";
  std::optional<Vec3> velocity, spin;           // spin: angular velocity, of bodies
  bool operator==(const VelocityTable&) const = default;
};

enum class StudyType { energy, equilibrium, path, modes, dynamics };

struct ModesTable {
  TablePlace place;
  int count = 6;                                // lowest eigenpairs
  bool operator==(const ModesTable&) const = default;
};

struct PathTable {
  TablePlace place;
  std::vector<std::string> parameter;           // tables that the load factor scales; none: all but the constant ones
  PathMethod method = PathMethod::load_steps;
  int steps = 100;
  double from = 0, to = 1;
  std::optional<WhenUnstable> when_unstable;    // default: jump; of arc_length: follow
  int branches = 0;                             // branch points to switch at
  int eigenvalues = 0;                          // columns eigenvalue_1 … of every point
  std::vector<std::string> locate{"limit", "branch", "contact"};
  std::optional<std::vector<double>> stops;     // load factors that are met besides
  std::optional<double> lowest, highest;        // load factors that end a branch in arc length
  std::optional<int> points;                    // most points of such a branch; default 20 · steps
  int deflate = 0;                              // further equilibria to look for …
  std::optional<std::vector<double>> deflate_at;   // … at these load factors; default: at `to`
  std::string start;                            // a states/LABEL.data to restart from, made absolute
  std::optional<double> start_lambda;           // with start; default: `from`
  bool operator==(const PathTable&) const = default;
};

struct SolverTable {
  TablePlace place;
  std::string method = "auto";                  // or "newton", "ipopt", "fire", "nlopt:NAME"
  bool by_newton() const { return method == "auto" || method == "newton"; }
  double tolerance = 1e-10;                     // residual, relative to the largest internal force
  std::optional<int> max_iterations;            // default: by method
  int max_evaluations = 100'000;                // of NLopt
  bool polish = false;                          // of NLopt: ends with Newton's method
  bool precondition = true;                     // of NLopt: in variables in which the Hessian at the start is the identity
  std::optional<double> bounds;                 // of NLopt's global methods: half the width of the box about the start [length]
  int seed = 1;                                 // of NLopt's random numbers
  bool operator==(const SolverTable&) const = default;
};

/// Velocity Verlet in time, or damped to an equilibrium.
struct DynamicsTable {
  TablePlace place;
  std::optional<double> timestep;               // only `relax` chooses its own
  int steps = 1000;
  int every = 100;                              // steps between rows of trajectory.csv
  std::optional<std::vector<int>> record;       // steps whose frames are written, rows too; default: every `every`
  bool relax = false;                           // damped dynamics (FIRE) to equilibrium, in at most `steps` steps
  bool allow_unstable = false;                  // of a timestep beyond the stable limit
  bool operator==(const DynamicsTable&) const = default;
};

enum class Quantity { position, displacement, rotation, reaction, torque, velocity, spin, gap, contacts };
enum class Component { x, y, z, norm };
enum class Reduce { mean, sum, min, max };

struct ObserveTable {
  TablePlace place;
  std::string name, group;                      // the group may be a wall: its reaction, gap, contacts
  Quantity quantity = Quantity::position;
  Component component = Component::x;           // not of a gap and of contacts
  Reduce reduce = Reduce::mean;                 // sum for a reaction and contacts, min for a gap
  bool operator==(const ObserveTable&) const = default;
};

/// An observable whose reaching of a value is located on a path.
struct EventTable {
  TablePlace place;
  std::string name, observable;                 // the name of an [[observe]]
  double value = 0;
  bool stop = false;                            // the path ends there
  bool operator==(const EventTable&) const = default;
};

/// A part of a path with conditions of its own; what is left out is as in [path].
struct StageTable {
  TablePlace place;
  std::string name;
  std::optional<std::vector<std::string>> vary; // tables that the load factor scales; default: all that are scaled
  std::vector<std::string> off;                 // tables that are not in force
  std::optional<double> from, to;               // default of `from`: the factor that the varied tables have by then
  std::optional<int> steps;
  std::optional<PathMethod> method;
  std::optional<WhenUnstable> when_unstable;
  bool operator==(const StageTable&) const = default;
};

struct ExpectTable {
  TablePlace place;
  std::string observable, at = "final";         // a column of path.csv; "final", an event's label, or "lambda=VALUE"
  double value = 0;
  double rtol = 1e-8, atol = 0;
  std::string source;
  std::optional<int> extrapolate;               // over the runs of a sweep, each with half the spacing of the one before,
                                                // errors in powers of the spacing: 1: all of them, 2: even ones
  bool operator==(const ExpectTable&) const = default;
};

/// Everything one run needs. Sweeps are expanded before this is read (see sweep.hpp).
struct Problem {
  std::string file;                             // path of the problem file, as given
  std::string sha256;                           // of its bytes, 64 hexadecimal digits
  std::string title;
  std::string plane;                            // "", "xy", "xz", "yz"
  std::optional<LammpsTable> lammps;
  std::vector<BeamTable> beams;
  std::vector<LoopTable> loops;
  std::vector<SheetTable> sheets;
  std::vector<GrainsTable> grains;
  std::vector<BodyTable> bodies;
  std::vector<GlueTable> glue;
  std::vector<ConnectTable> connections;
  std::vector<RemoveTable> removals;
  std::vector<GroupTable> groups;
  std::vector<SupportTable> supports;
  std::vector<LoadTable> loads;
  std::vector<GravityTable> gravity;
  std::vector<PressureTable> pressures;
  std::vector<ChangeTable> changes;
  std::vector<ContactTable> contacts;
  std::vector<WallTable> walls;
  std::vector<ViscosityTable> viscosity;
  std::vector<VelocityTable> velocities;
  StudyType study = StudyType::path;
  TablePlace study_place;                       // of [study], where it is written
  PathTable path;
  ModesTable modes;
  SolverTable solver;
  DynamicsTable dynamics;
  std::vector<ObserveTable> observe;
  std::vector<EventTable> events;
  std::vector<StageTable> stages;
  std::vector<ExpectTable> expect;
  /// A motion in time is asked for; damped dynamics ends in an equilibrium.
  bool in_time() const { return study == StudyType::dynamics && !dynamics.relax; }
  bool operator==(const Problem&) const = default;
};

}  // namespace elamin
