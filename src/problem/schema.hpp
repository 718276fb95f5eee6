#pragma once
// What a problem file may hold, said once: for every table its keys, with what they may be. `describe(io, table)` is
// read by the Reader (TOML → structs), the Writer (structs → resolved.toml) and the Keys (which key there is, for
// --set).
//
// io.must(key, value, range)       the key has to be there        io.name(key, value)        a name of something new
// io.may(key, value, range)        left as it is if absent        io.file(key, value)        a file; also may_file
// io.word(key, value, words)       one of some words; also must_word and (any of them, each once) words
// io.table(key, value)             [key], may be absent           io.tables(key, list)       [[key]], any number
#include "problem/problem.hpp"

#include <limits>

namespace elamin {

/// What a number may be: lo ≤ x ≤ hi, or lo < x ≤ hi.
struct Range {
  double lo = -std::numeric_limits<double>::max(), hi = std::numeric_limits<double>::max();
  bool above = false;
};
inline constexpr int most_particles = 100'000'000, most_steps = 1'000'000;
namespace range {
inline constexpr Range any{}, positive{0, any.hi, true}, not_negative{0}, count{1, most_particles};
inline constexpr Range id{1, std::numeric_limits<int>::max()};
}  // namespace range

/// A word of the file and what it stands for.
template <class T> struct Word {
  const char* text;
  T value;
};
inline constexpr Word<Section> section_words[]{{"cylinder", Section::cylinder}, {"square", Section::square}};
inline constexpr Word<const char*> plane_words[]{{"xy", "xy"}, {"xz", "xz"}, {"yz", "yz"}};
inline constexpr Word<const char*> inside_words[]{{"block", "block"}};
inline constexpr Word<StudyType> study_words[]{
    {"energy", StudyType::energy}, {"equilibrium", StudyType::equilibrium}, {"path", StudyType::path}};
inline constexpr Word<const char*> path_method_words[]{{"load_steps", "load_steps"}};
inline constexpr Word<WhenUnstable> when_unstable_words[]{{"jump", WhenUnstable::jump}, {"stop", WhenUnstable::stop}};
inline constexpr Word<const char*> event_words[]{{"limit", "limit"}, {"branch", "branch"}, {"contact", "contact"}};
inline constexpr Word<const char*> solver_words[]{{"newton", "newton"}};
inline constexpr Word<Reduce> reduce_words[]{
    {"mean", Reduce::mean}, {"sum", Reduce::sum}, {"min", Reduce::min}, {"max", Reduce::max}};

/// What is observed: quantity and component in one word.
struct Observed {
  Quantity quantity;
  Component component;
  bool operator==(const Observed&) const = default;
};
inline constexpr Word<Observed> observed_words[]{
    {"position.x", {Quantity::position, Component::x}},
    {"position.y", {Quantity::position, Component::y}},
    {"position.z", {Quantity::position, Component::z}},
    {"position.norm", {Quantity::position, Component::norm}},
    {"displacement.x", {Quantity::displacement, Component::x}},
    {"displacement.y", {Quantity::displacement, Component::y}},
    {"displacement.z", {Quantity::displacement, Component::z}},
    {"displacement.norm", {Quantity::displacement, Component::norm}},
    {"reaction.x", {Quantity::reaction, Component::x}},
    {"reaction.y", {Quantity::reaction, Component::y}},
    {"reaction.z", {Quantity::reaction, Component::z}},
    {"reaction.norm", {Quantity::reaction, Component::norm}},
    {"velocity.x", {Quantity::velocity, Component::x}},
    {"velocity.y", {Quantity::velocity, Component::y}},
    {"velocity.z", {Quantity::velocity, Component::z}},
    {"velocity.norm", {Quantity::velocity, Component::norm}}};

/// One [[sweep]]: the key and either the values or a range.
struct Sweep {
  TablePlace place;
  std::string key, zip;
  std::vector<std::string> values;       // as TOML
  std::vector<double> range;             // first, last, step
};

/// What a file holds: the problem, and the sweeps over its keys.
struct ProblemFile {
  Problem problem;
  std::vector<Sweep> sweeps;
};

template <class IO> void describe(IO& io, LammpsTable& t) {
  io.file("data", t.data);
  io.may("atom_style", t.atom_style);
}

template <class IO> void describe(IO& io, BeamTable& t) {
  io.name("name", t.name);
  io.word("section", t.section, section_words);
  io.must("particles", t.particles, Range{2, most_particles});
  io.may("from", t.from);
  io.may("to", t.to);
  io.may("center", t.center);
  io.may("axis", t.axis);
  io.may("spacing", t.spacing, range::positive);
  io.must("diameter", t.diameter, range::positive);
  io.may("thickness", t.thickness, range::positive);
  io.may("youngs_modulus", t.youngs_modulus, range::positive);
  io.may("density", t.density, range::positive);
  io.may("bond_stiffness", t.bond_stiffness, range::positive);
  io.may("angle_stiffness", t.angle_stiffness, range::positive);
  io.may("rest_length", t.rest_length, range::positive);
}

template <class IO> void describe(IO& io, GroupTable::Inside& t) {
  std::string shape = "block";
  if (!io.must_word("shape", shape, inside_words)) return io.skip_the_rest();   // other keys belong to other shapes
  io.must("lo", t.lo);
  io.must("hi", t.hi);
}

template <class IO> void describe(IO& io, GroupTable& t) {
  io.name("name", t.name);
  io.may("of", t.of);
  io.may("first", t.first, range::count);
  io.may("last", t.last, range::count);
  io.may("middle", t.middle, range::count);
  io.may("ids", t.ids, range::id);
  io.table("inside", t.inside);
}

template <class IO> void describe(IO& io, SupportTable& t) {
  io.must("group", t.group);
  io.may("directions", t.directions);
  io.may("displacement", t.displacement);
  io.may("constant", t.constant);
}

template <class IO> void describe(IO& io, LoadTable& t) {
  io.must("group", t.group);
  io.may("force", t.force);
  io.may("total_force", t.total_force);
  io.may("constant", t.constant);
}

template <class IO> void describe(IO& io, GravityTable& t) {
  io.may("group", t.group);
  io.must("acceleration", t.acceleration);
  io.may("constant", t.constant);
}

template <class IO> void describe(IO& io, ViscosityTable& t) {
  io.may("group", t.group);
  io.must("coefficient", t.coefficient, range::not_negative);
}

/// [study] is one word; the problem keeps the word alone.
struct StudyTable {
  TablePlace place;
  StudyType type;
};
template <class IO> void describe(IO& io, StudyTable& t) { io.word("type", t.type, study_words); }

template <class IO> void describe(IO& io, PathTable& t) {
  io.word("method", t.method, path_method_words);
  io.may("steps", t.steps, Range{1, most_steps});
  io.may("from", t.from);
  io.may("to", t.to);
  io.word("when_unstable", t.when_unstable, when_unstable_words);
  io.may("branches", t.branches, Range{0, 0});
  io.words("locate", t.locate, event_words);
  io.may_file("start", t.start);
  io.may("start_lambda", t.start_lambda);
}

template <class IO> void describe(IO& io, SolverTable& t) {
  io.word("method", t.method, solver_words);
  io.may("tolerance", t.tolerance, Range{0, 1e-2, true});
  io.may("max_iterations", t.max_iterations, Range{1, most_steps});
}

template <class IO> void describe(IO& io, ObserveTable& t) {
  io.name("name", t.name);
  io.must("group", t.group);
  Observed observed{t.quantity, t.component};
  io.must_word("quantity", observed, observed_words);
  t.quantity = observed.quantity, t.component = observed.component;
  if constexpr (IO::reading) t.reduce = t.quantity == Quantity::reaction ? Reduce::sum : Reduce::mean;
  io.word("reduce", t.reduce, reduce_words);
}

template <class IO> void describe(IO& io, ExpectTable& t) {
  io.must("observable", t.observable);
  io.may("at", t.at);
  io.must("value", t.value);
  io.may("rtol", t.rtol, range::not_negative);
  io.may("atol", t.atol, range::not_negative);
  io.may("source", t.source);
}

template <class IO> void describe(IO& io, Sweep& t) {
  io.must("key", t.key);
  io.may("zip", t.zip);
  io.raw("values", t.values);
  io.may("range", t.range);
}

template <class IO> void describe(IO& io, ProblemFile& f) {
  Problem& p = f.problem;
  io.may("title", p.title);
  io.word("plane", p.plane, plane_words);
  io.table("lammps", p.lammps);
  io.tables("beam", p.beams);
  io.tables("group", p.groups);
  io.tables("support", p.supports);
  io.tables("load", p.loads);
  io.tables("gravity", p.gravity);
  io.tables("viscosity", p.viscosity);
  if constexpr (IO::reading) p.study = io.has("path") ? StudyType::path : StudyType::equilibrium;
  StudyTable study{{}, p.study};
  io.table("study", study);
  p.study = study.type;
  io.table("path", p.path);
  io.table("solver", p.solver);
  io.tables("observe", p.observe);
  io.tables("expect", p.expect);
  io.tables("sweep", f.sweeps);
}

}  // namespace elamin
