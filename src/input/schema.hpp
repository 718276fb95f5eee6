#pragma once
// What a problem file may hold, said once: for every table its keys, with what they may be. `describe(io, table)` is
// read by the Reader (TOML → structs), the Writer (structs → resolved.toml) and the Keys (which key there is, for
// --set).
//
// io.must(key, value, range)       the key has to be there        io.name(key, value)        a name of something new; also may_name
// io.may(key, value, range)        left as it is if absent        io.file(key, value)        a file; also may_file
// io.word(key, value, words)       one of some words; also must_word and (any of them, each once) words
// io.one_or_more(key, list)        a string or a list of them; also must_one_or_more
// io.one_or_two(key, list, range)  a number or a list of two      io.center(key, x, axis)    with or without x[axis]
// io.foreign(key, what)            must not be here: it does not belong to `what`
// io.table(key, value)             [key], may be absent           io.tables(key, list)       [[key]], any number
#include "input/schema_conditions.hpp"
#include "input/schema_structures.hpp"

namespace elamin {

/// One [[sweep]]: the key and the values, a range, or two values between which an outcome changes.
struct Sweep {
  TablePlace place;
  std::vector<std::string> keys;         // all get the same value
  std::string zip;
  std::vector<std::string> values;       // as TOML
  std::vector<double> range;             // first, last, step
  std::vector<std::string> between;      // two values as TOML, to halve …
  std::string bisect, at = "final";      // … where this observable there passes
  double level = 0;
  std::optional<double> tolerance;       // of the key; default: a thousandth of what is between
};

/// What a file holds: the problem, and the sweeps over its keys.
struct ProblemFile {
  Problem problem;
  std::vector<Sweep> sweeps;
};

/// [study] is one word; the problem keeps the word alone.
struct StudyTable {
  TablePlace place;
  StudyType type;
};
template <class IO> void describe(IO& io, StudyTable& t) { io.word("type", t.type, study_words); }

template <class IO> void describe(IO& io, PathTable& t) {
  io.one_or_more("parameter", t.parameter);
  io.word("method", t.method, path_method_words);
  io.may("steps", t.steps, Range{1, most_steps});
  io.may("from", t.from);
  io.may("to", t.to);
  io.word("when_unstable", t.when_unstable, when_unstable_words);
  io.may("branches", t.branches, Range{0, most_branches});
  io.words("locate", t.locate, event_words);
  io.may("eigenvalues", t.eigenvalues, Range{0, most_modes});
  io.may("stops", t.stops);
  io.may("lowest", t.lowest);
  io.may("highest", t.highest);
  io.may("points", t.points, Range{1, 20.0 * most_steps});
  io.may("deflate", t.deflate, Range{0, most_branches});
  io.may("deflate_at", t.deflate_at);
  io.may_file("start", t.start);
  io.may("start_lambda", t.start_lambda);
}

template <class IO> void describe(IO& io, ModesTable& t) { io.may("count", t.count, Range{1, most_modes}); }

template <class IO> void describe(IO& io, SolverTable& t) {
  io.word("method", t.method, solver_words);
  io.may("tolerance", t.tolerance, Range{0, 1e-2, true});
  io.may("max_iterations", t.max_iterations, Range{1, most_steps});
  if (t.method.rfind("nlopt:", 0) != 0) {
    for (const char* key : {"max_evaluations", "polish", "precondition", "bounds", "seed"})
      io.foreign(key, "the method " + t.method + "; it is for NLopt's");
    return;
  }
  io.may("max_evaluations", t.max_evaluations, range::count);
  io.may("polish", t.polish);
  io.may("precondition", t.precondition);
  io.may("bounds", t.bounds, range::positive);
  io.may("seed", t.seed, range::id);
}

template <class IO> void describe(IO& io, DynamicsTable& t) {
  io.may("relax", t.relax);
  io.may("timestep", t.timestep, range::positive);
  if constexpr (IO::reading)
    if (t.relax) t.steps = 200'000;
  io.may("steps", t.steps, Range{0, 2e9});
  io.may("every", t.every, range::id);
  io.may("record", t.record, Range{0, 2e9});
  io.may("allow_unstable", t.allow_unstable);
}

template <class IO> void describe(IO& io, ObserveTable& t) {
  io.name("name", t.name);
  io.must("group", t.group);
  Observed observed{t.quantity, t.component};
  io.must_word("quantity", observed, observed_words);
  t.quantity = observed.quantity, t.component = observed.component;
  if constexpr (IO::reading) t.reduce = default_reduce(t.quantity);
  io.word("reduce", t.reduce, reduce_words);
}

template <class IO> void describe(IO& io, EventTable& t) {
  io.name("name", t.name);
  io.must("observable", t.observable);
  io.must("value", t.value);
  io.may("stop", t.stop);
}

template <class IO> void describe(IO& io, StageTable& t) {
  io.name("name", t.name);
  io.one_or_more("vary", t.vary);
  io.one_or_more("off", t.off);
  io.may("from", t.from);
  io.may("to", t.to);
  io.may("steps", t.steps, Range{1, most_steps});
  io.word("method", t.method, path_method_words);
  io.word("when_unstable", t.when_unstable, when_unstable_words);
}

template <class IO> void describe(IO& io, ExpectTable& t) {
  io.must("observable", t.observable);
  io.may("at", t.at);
  io.must("value", t.value);
  io.may("rtol", t.rtol, range::not_negative);
  io.may("atol", t.atol, range::not_negative);
  io.may("source", t.source);
  io.may("extrapolate", t.extrapolate, Range{1, 2});
}

template <class IO> void describe(IO& io, Sweep& t) {
  io.must_one_or_more("key", t.keys);
  io.may("zip", t.zip);
  io.raw("values", t.values);
  io.may("range", t.range);
  io.raw("between", t.between);
  io.may("bisect", t.bisect);
  io.may("at", t.at);
  io.may("level", t.level);
  io.may("tolerance", t.tolerance, range::positive);
}

template <class IO> void describe(IO& io, ProblemFile& f) {
  Problem& p = f.problem;
  io.may("title", p.title);
  io.word("plane", p.plane, plane_words);
  io.table("lammps", p.lammps);
  io.tables("beam", p.beams);
  io.tables("loop", p.loops);
  io.tables("sheet", p.sheets);
  io.tables("grains", p.grains);
  io.tables("body", p.bodies);
  io.tables("group", p.groups);
  io.tables("connect", p.connections);
  io.tables("remove", p.removals);
  io.tables("glue", p.glue);
  io.tables("support", p.supports);
  io.tables("load", p.loads);
  io.tables("gravity", p.gravity);
  io.tables("pressure", p.pressures);
  io.tables("change", p.changes);
  io.tables("contact", p.contacts);
  io.tables("wall", p.walls);
  io.tables("viscosity", p.viscosity);
  io.tables("velocity", p.velocities);
  if constexpr (IO::reading)
    p.study = io.has("dynamics") ? StudyType::dynamics : io.has("path") || io.has("stage") ? StudyType::path : io.has("modes") ? StudyType::modes : StudyType::equilibrium;
  StudyTable study{{}, p.study};
  io.table("study", study);
  p.study = study.type, p.study_place = study.place;
  io.table("path", p.path);
  io.table("modes", p.modes);
  io.table("solver", p.solver);
  io.table("dynamics", p.dynamics);
  io.tables("stage", p.stages);
  io.tables("observe", p.observe);
  io.tables("event", p.events);
  io.tables("expect", p.expect);
  io.tables("sweep", f.sweeps);
}

}  // namespace elamin
