#pragma once
// What the commands of a script have built: the box, regions, particles, what glues them, coefficients, and what is in force.
#include "core/types.hpp"
#include "lammps/script/words.hpp"
#include "laws/region.hpp"

#include <array>
#include <climits>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace elamin::script {

/// A place in the files of a script; line 0: none.
struct Where {
  int file = 0, line = 0;
  bool operator==(const Where&) const = default;
};

constexpr int always = INT_MAX;

/// A particle. Runs are counted from 0: it is there in those from `born` to before `gone`.
struct Atom {
  int id = 0, type = 1, molecule = 0;
  Vec3 x = Vec3::Zero(), start = Vec3::Zero();   // now; where the first run that it is in begins
  double diameter = 0, density = 0;              // of atom style sphere
  Vec3 v = Vec3::Zero(), start_v = Vec3::Zero(); // likewise
  Vec3 omega = Vec3::Zero();
  std::uint32_t groups = 1;                      // a bit each; the first is all
  int born = 0, gone = always;
  bool moved = false;                            // by a run: x is not known …
  bool drifts = false;                           // … nor in motion v; at rest it is 0
  bool is_body = false;
};

template <int N> struct Glue {
  int type;                                      // from 1
  std::array<int, N> atoms;                      // indices
  int born, gone = always;
};

/// A region: a shape, or several of them together.
struct ScriptRegion {
  enum class Kind { shape, unite, intersect } kind = Kind::shape;
  Region shape;
  bool inside = true, moves = false;
  std::array<std::string, 4> formulas;           // v_NAME of how far it has moved, and of its radius; "": not at all, a number
  std::vector<std::string> parts;
  std::string words;                             // as in the script
  Where where;
};

/// Coefficients of a bond or angle type; stiffness K or B, rest r₀ or θ₀ [rad].
struct Coefficient {
  double stiffness = 0, rest = 0;
  bool set = false;
  bool operator==(const Coefficient&) const = default;
};

/// What a pair_coeff line says of pairs of types i ≤ j.
struct PairCoefficient {
  enum class Law { hertz, lj, rounded, none } law = Law::none;
  std::array<int, 2> first{1, 1}, second{1, 1};  // types, from and to
  double youngs_modulus = 0, poissons_ratio = 0; // hertz of a material …
  std::optional<double> effective_modulus;       // … or E_eff itself
  double epsilon = 0, sigma = 0, cutoff = 0;     // lj
  double inner_cutoff = 0;                       // of lj/smooth
  double k_n = 0, k_na = 0;                      // rounded
  std::string damping;                           // keys of [[contact]] for dynamics, lines
  std::string style;                             // "granular"; "none"
  bool mixed = false, unlike = false;            // of types that have no line together; and whose dampings differ
  Where where;
  std::string text;                              // the command
  bool covers(int i, int j) const {
    if (i > j) std::swap(i, j);
    return first[0] <= i && i <= first[1] && second[0] <= j && j <= second[1];
  }
};

struct PairStyle {
  std::string name;                              // "granular"
  double cutoff = 0, inner_cutoff = 0;           // of lj/cut and lj/smooth: global; of granular 0: where particles touch
  bool shift = false;                            // pair_modify shift yes
  enum class Mix { geometric, arithmetic, sixthpower } mix = Mix::geometric;
  double c_n = 0, c_t = 0, mu = 0, delta_ua = 1, cut_inner = 0;   // body/rounded/polyhedron
  std::string damping;                           // of gran/hertz…, as above
  double gran_modulus = 0;                       // E_eff of gran/hertz…
};

/// What pair_style and pair_coeff have said so far.
struct Pairs {
  bool hybrid = false, overlay = false;          // one style a pair; or several
  std::vector<PairStyle> styles;
  std::vector<PairCoefficient> coefficients;
};

/// Pairs that neigh_modify leaves out: of two types, of two groups (their bits), or of one molecule within a group.
struct Exclusion {
  enum class Of { types, groups, molecules } of;
  std::array<int, 2> which;
  Where where;
  std::string text;                              // the command
};

/// A fix that matters to equilibria.
struct Fix {
  enum class Kind { integrate, move, hold, gravity, force, wall, viscous, plane, ignored } kind = Kind::ignored;
  std::string id, style, group;
  int serial = 0;
  Where where;
  std::string text;                              // the command
  std::array<bool, 3> directions{true, true, true};   // move, hold: which coordinates
  Vec3 vector = Vec3::Zero();                    // velocity of move; acceleration, force as a run begins
  Vec3 end = Vec3::Zero();                       // acceleration, force as it ends
  std::array<std::string, 3> formulas;           // v_NAME of the force's components, of gravity of its size in [0]; "": numbers
  Vec3 direction = Vec3::Zero();                 // of gravity
  double timestep = 0;                           // of move, since it moves
  double coefficient = 0;                        // viscous
  struct Wall {
    Region region;                               // as it is defined
    bool inside = true, curved = true;
    double effective_modulus = 0;
    std::string suffix;
    std::array<std::string, 4> formulas = {};    // of its displacement and its radius, as of a region
    std::array<Vec3, 2> moved = {Vec3::Zero(), Vec3::Zero()};   // as a run begins, and ends
    std::array<double, 2> grown{};               // ΔR of its radius
  };
  std::vector<Wall> walls;
  std::string region;                            // whose surface the wall is, as it is when a run begins
  std::string damping;                           // keys of [[wall]] for dynamics
  std::string body;                              // keys of [[wall]] of bodies
  bool trap_modulus = false;                     // E/(2(1 − ν)) of hertz/material
  bool unforced = false;                         // integrates, and lets its atoms feel no force: nve/noforce, a hold
  /// Whether it moves its atoms.
  bool integrates() const { return kind == Kind::integrate || kind == Kind::move || unforced; }
};

/// What holds a particle along its coordinates, and how fast.
struct Held {
  std::array<bool, 3> directions{};
  Vec3 velocity = Vec3::Zero();
  int fix = -1;                                  // of Run::fixes; −1: nothing integrates it
  auto key() const { return std::tuple(fix, directions, velocity[0], velocity[1], velocity[2]); }
  bool operator<(const Held& o) const { return key() < o.key(); }
};

/// A run or minimisation, and what was in force then.
struct Run {
  Where where;
  std::string text;
  bool minimize = false;
  long long steps = 0;
  double timestep = 0;
  struct Active {
    Fix fix;
    std::vector<int> members;                    // indices of atoms, ascending
    std::vector<std::array<Vec3, 2>> own;        // force on each of them as the run begins and ends, unless empty
  };
  std::vector<Active> fixes;
  std::vector<int> atoms;                        // that are there
  std::map<Held, std::vector<int>> held;         // of them
  std::array<bool, 3> thrown{};                  // whether some of them have a velocity along x, y, z
  Pairs pairs;
  struct Excluded { std::array<std::vector<int>, 2> members; Where where; std::string text; };
  std::vector<Excluded> excluded;                // pairs of one of the first and one of the second that do not touch
  std::map<int, Coefficient> bonds, angles;      // of the types in use
  std::array<double, 3> special_lj{}, special_coul{};
  double time() const { return static_cast<double>(steps) * timestep; }
  bool still() const { return steps == 0 && !minimize; }         // forces and energies alone
};

/// Glue that delete_bonds has taken away behind a run.
struct Removal {
  int run = 0;                                   // from which it is gone
  bool angles = false;                           // only these; else bonds with the angles over them
  std::vector<int> members;
  std::string group, text;
  Where where;
};

struct World {
  // Settings.
  std::string units = "lj", atom_style = "atomic", bond_style, angle_style, body_style;
  bool sphere = false, molecular = false, bodies = false;
  int dimension = 3;
  std::array<std::string, 3> boundary{"p", "p", "p"};
  Where boundary_where;
  double timestep = 0.005, skin = 0.3;           // skin: how much farther than a pair's cutoff neighbour lists reach
  std::array<double, 3> special_lj{}, special_coul{};
  double lattice = 1;
  long long step = 0;
  double time = 0;
  /// How far a run has come, for formulas: its steps, and the share of the way of ramp().
  struct Moment { long long steps = 0, before = 0, total = 0; } moment;
  // The box.
  bool has_box = false;
  std::array<Vec3, 2> box{Vec3::Zero(), Vec3::Zero()};              // its low and high sides
  std::array<Vec3, 2> least_box = box;           // that sides of kind m keep
  Vec3 room = Vec3::Zero();                      // of shrunk sides from what is there
  std::array<std::array<bool, 3>, 2> lost{};     // shrunk sides around what a run has moved
  int atom_types = 0, bond_types = 0, angle_types = 0;
  // What there is.
  std::map<std::string, ScriptRegion> regions;
  std::vector<Atom> atoms;                       // in the order of their making; those gone stay
  std::vector<int> of_id;                        // index of the one with an id that is there, −1: none
  std::vector<Glue<2>> bonds;
  std::vector<Glue<3>> angles;
  std::vector<std::string> groups{"all"};        // by bit; "": free
  std::vector<double> mass;                      // by type
  std::vector<Coefficient> bond_coefficients, angle_coefficients;   // by type from 0
  Pairs pairs;
  std::vector<Exclusion> exclusions;
  std::vector<Fix> fixes;
  int fix_serial = 0;
  std::string body_file;                         // the data file that bodies are from
  std::vector<Run> runs;                         // that move something
  std::optional<Run> still;                      // the last `run 0` before them …
  std::vector<Atom> atoms_of_still;              // … and what was there
  std::vector<Removal> removals;
  struct Unfollowed { Where where; std::string command, what; };
  std::vector<Unfollowed> not_in_motion;         // commands that matter in motion, and are not followed there
  Where last_run;                                // that has moved particles
  bool unspecial = false;                        // some bonds were made with `special no`
  std::map<std::string, std::vector<int>> sheets;   // by files of atoms that are called sheet_N: their indices

  int run_number() const { return static_cast<int>(runs.size()); }
  /// Of a side of the box f (fixed), s (shrunk around what there is), m (shrunk, but no smaller than it was) or p.
  char kind_of_side(int c, int end) const;
  /// Makes the box, or changes it: sides of kind s move outward by 10⁻⁴ of it.
  void set_box(const std::array<Vec3, 2>& sides);
  /// Shrinks sides around what there is, where LAMMPS does so.
  void shrink_box();
  /// A low (end 0) or high side. Throws NeedsPositions if it is around what a run has moved.
  double side(int c, int end) const;
  /// Whether x is in the box; what shrinks around what a run has moved does not count.
  bool in_box(const Vec3& x) const;
  static bool there(const Atom& a) { return a.gone == always; }
  /// The bit of a group; throws Wrong at `word` if there is none.
  int group(const std::string& name, std::size_t word) const;
  std::optional<int> find_group(const std::string& name) const;
  bool in(const Atom& a, int group_bit) const { return (a.groups >> group_bit & 1u) != 0; }
  /// Mass of a particle; 0: not known.
  double mass_of(const Atom& a) const;
  /// Of a bond type, of an angle type: without force where there is no style. Throws Wrong if it has none.
  Coefficient of_bonds(int type) const, of_angles(int type) const;
  /// Where it is. Throws NeedsPositions if a run has moved it.
  const Vec3& at(const Atom& a) const;
  /// Whether something of it changes. Throws NeedsPositions if it was in a run already: a problem has particles of one kind in all of its stages.
  void change(const Atom& a, bool changes) const;
  /// Whether x is in a region; throws Wrong if there is none of that name.
  bool matches(const std::string& region, const Vec3& x, std::size_t word, int depth = 0) const;
  /// Whether what there is has not changed since the run was recorded.
  bool is_of_now(const Run& run) const;
  /// Index of the particle with that id; throws Wrong if there is none.
  int with_id(long long id, std::size_t word) const;
  /// A new particle with the next id.
  Atom& create(int type, const Vec3& x);
  /// Throws NeedsPositions if all of these were there in an earlier run already: glue between them comes with a problem of its own.
  void new_glue(std::initializer_list<int> indices) const;
  void remove(const std::vector<bool>& gone);
  void remove(Atom& a);
};

/// A command needs to know where particles are that a run has moved, or changes what they were in it.
struct NeedsPositions {
  Where run;                                     // which has moved them
  const char* why = "needs to know where particles are behind";
};

}  // namespace elamin::script
