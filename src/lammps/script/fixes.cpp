// Fixes, and the runs in which they are in force.
#include "lammps/script/granular.hpp"
#include "lammps/script/interpreter.hpp"

#include "core/suggest.hpp"
#include "laws/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace elamin::script::command {
namespace {

constexpr std::size_t most_runs = 1000;

/// Whether v_NAME is of style atom or atomfile.
bool of_atoms(const Interpreter& in, const std::string& formula) {
  const auto found = in.names.variables.find(formula.substr(2));
  return found != in.names.variables.end() && found->second.of_atoms();
}

/// A fix in the making.
struct Making {
  Interpreter& in;
  Fix fix;

  /// Word i as a number that does not change in time.
  double constant(std::size_t i) const {
    Dependence on;
    const double v = in.value(i, &on);
    if (on.time) throw Wrong(i, in_quotes(in.word(i)) + " changes in time, which is not followed here", true);
    return v;
  }
  /// Word i as a number, or as a formula that every run evaluates anew.
  double number_or(std::string& formula, std::size_t i, bool each) const {
    if (!in.word(i).starts_with("v_")) return in.number(i);
    formula = in.word(i);
    evaluate(formula, in.world, in.names, i, each && of_atoms(in, formula));
    return 0;
  }
  double direction(std::size_t i, std::size_t c) {
    if (i < in.size() && in.word(i) == "NULL") {
      fix.directions[c] = false;
      return 0;
    }
    return constant(i);
  }

  void move() {
    in.wants(5, "fix ID GROUP move linear VX VY VZ");
    fix.kind = Fix::Kind::move;
    if (in.word(4) != "linear") throw Wrong(4, fmt::format("move {} is not followed; linear is", in.word(4)), true);
    in.wants(8, "fix ID GROUP move linear VX VY VZ");
    for (int c = 0; c < 3; ++c) fix.vector[c] = direction(static_cast<std::size_t>(5 + c), static_cast<std::size_t>(c));
  }

  void setforce() {
    in.wants(7, "fix ID GROUP setforce FX FY FZ");
    fix.kind = Fix::Kind::hold;
    for (int c = 0; c < 3; ++c)
      if (const auto i = static_cast<std::size_t>(4 + c); direction(i, static_cast<std::size_t>(c)) != 0)
        throw Wrong(i, "a force that replaces all others is not taken; 0 holds, and addforce adds", true);
  }

  void gravity() {
    in.wants(5, "fix ID GROUP gravity MAGNITUDE vector X Y Z");
    fix.kind = Fix::Kind::gravity;
    const double g = number_or(fix.formulas[0], 4, false);
    const std::string style = in.size() > 5 ? in.word(5) : "";
    Vec3 d = Vec3::Zero();
    if (style == "vector") {
      in.wants(9, "fix ID GROUP gravity MAGNITUDE vector X Y Z");
      d = Vec3(constant(6), constant(7), constant(8));
    } else if (style == "chute") {
      const double a = constant(6) * (pi / 180);
      d = Vec3(std::sin(a), 0, -std::cos(a));
    } else if (style == "spherical") {
      const double phi = constant(6) * (pi / 180), theta = constant(7) * (pi / 180);
      d = Vec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    } else throw Wrong(std::min<std::size_t>(5, in.size() - 1), "vector, chute and spherical are taken", true);
    if (in.world.dimension == 2) {                // LAMMPS: without z, and angles within the plane
      if (style == "chute") d = Vec3(d[0], d[2], 0);
      if (style == "spherical") d = Vec3(std::sin(constant(7) * (pi / 180)), d[2], 0);
      d[2] = 0;
    }
    if (!(d.norm() > 0)) throw Wrong(6, "the direction has no length");
    fix.direction = d / d.norm();
    fix.vector = fix.end = g * fix.direction;
  }

  void addforce() {
    in.wants(7, "fix ID GROUP addforce FX FY FZ");
    fix.kind = Fix::Kind::force;
    for (std::size_t c = 0; c < 3; ++c) fix.vector[static_cast<int>(c)] = number_or(fix.formulas[c], 4 + c, true);
    fix.end = fix.vector;
    if (in.size() > 7) throw Wrong(7, in_quotes(in.word(7)) + " is no keyword of addforce that is taken", true);
  }

  /// The law of a wall; returns the word behind it.
  std::size_t wall_law(std::size_t i, double& modulus) {
    if (i >= in.size()) throw Wrong(in.size() - 1, "the law of the wall is missing behind this");
    if (in.word(i) == "granular") {
      GranularLaw law;
      i = law.read(in, i + 1, true);
      // LAMMPS of 2021 and later: E/(2 (1 − ν)) at walls, not E/(2 (1 − ν²)).
      modulus = law.material ? law.youngs_modulus / (2 * (1 - law.poissons_ratio)) : law.effective_modulus;
      fix.trap_modulus = law.material && law.youngs_modulus > 0 && law.poissons_ratio != 0;
      fix.damping = law.damping();
      if (law.limited) in.not_in_motion();
      if (law.history || law.rolls)
        in.note(
            "friction that remembers, rolls and twists has no energy: it is left out (with --dynamics its sliding friction stays, without "
            "history)");
      return i;
    }
    if (in.word(i) == "hertz/history") {
      modulus = 0.75 * in.number(i + 1);
      fix.damping =
          fmt::format("damping = \"viscoelastic\"\ndamping_coefficient = {}\nfriction = {}\n", in.number(i + 3), in.number(i + 5));
      if (modulus < 0) throw Wrong(i + 1, "is negative; 0 or more is taken");
      return i + 7;
    }
    throw Wrong(
        i, in_quotes(in.word(i)) + " is no law of a wall that is known here; granular hertz, granular hertz/material and hertz/history are",
        true);
  }

  void add_wall(const Region& region, bool inside, double modulus, const std::string& suffix) {
    fix.walls.push_back({region, inside, true, modulus, suffix});
  }

  void wall_region() {
    in.wants(6, "fix ID GROUP wall/gran/region LAW … region NAME");
    fix.kind = Fix::Kind::wall;
    double modulus = 0;
    std::size_t i = wall_law(4, modulus);
    if (i + 1 >= in.size() || in.word(i) != "region") throw Wrong(std::min(i, in.size() - 1), "`region NAME` is wanted here");
    const auto found = in.world.regions.find(in.word(i + 1));
    if (found == in.world.regions.end()) throw Wrong(i + 1, in_quotes(in.word(i + 1)) + " is no region");
    if (found->second.kind != ScriptRegion::Kind::shape)
      throw Wrong(i + 1, "a wall of several regions together is not taken; give each its own fix", true);
    no_more(i + 2);
    fix.region = in.word(i + 1);
    add_wall(found->second.shape, found->second.inside, modulus, "");
    fix.walls.back().formulas = found->second.formulas;
  }

  void no_more(std::size_t i) const {
    if (i < in.size() && in.word(i) != "contacts") throw Wrong(i, in_quotes(in.word(i)) + " is no keyword of this fix that is taken", true);
  }

  void plane_or_tube(std::size_t i, double modulus) {
    const std::string& style = i < in.size() ? in.word(i) : in.word(0);
    if (style == "zcylinder") {
      Region tube;
      tube.shape = Shape::cylinder, tube.axis = 2, tube.radius = in.positive(i + 1);
      no_more(i + 2);
      return add_wall(tube, true, modulus, "");
    }
    if (style != "xplane" && style != "yplane" && style != "zplane")
      throw Wrong(std::min(i, in.size() - 1), in_quotes(style) + " is no wall that is known here; xplane, yplane, zplane and zcylinder are",
                  true);
    const int c = style[0] - 'x';
    for (const std::size_t end : {i + 1, i + 2}) {
      if (end >= in.size()) throw Wrong(i, "two coordinates are wanted behind this, or NULL");
      if (in.word(end) == "NULL") continue;
      Region plane;
      plane.center[c] = in.number(end);
      plane.normal = Vec3::Unit(c) * (end == i + 1 ? 1.0 : -1.0);
      add_wall(plane, true, modulus, end == i + 1 ? "_lo" : "_hi");
    }
    if (fix.walls.empty()) throw Wrong(i + 1, "both walls are NULL");
    no_more(i + 3);
  }

  void wall_gran() {
    in.wants(6, "fix ID GROUP wall/gran LAW … xplane LO HI");
    fix.kind = Fix::Kind::wall;
    double modulus = 0;
    const std::size_t next = wall_law(4, modulus);
    plane_or_tube(next, modulus);
  }

  void wall_body() {
    in.wants(9, "fix ID GROUP wall/body/polyhedron K_N C_N C_T xplane LO HI");
    fix.kind = Fix::Kind::wall;
    const double normal = in.number(5), tangential = in.word(6) == "NULL" ? normal / 2 : in.number(6);   // as LAMMPS has it
    fix.body = fmt::format("k_n = {}\nc_n = {}\nc_t = {}\n", in.number(4), normal, tangential);
    plane_or_tube(7, 0);
  }

  void viscous() {
    in.wants(5, "fix ID GROUP viscous GAMMA");
    fix.kind = Fix::Kind::viscous;
    fix.coefficient = constant(4);
    if (fix.coefficient < 0) throw Wrong(4, "is negative; 0 or more is taken");
    if (in.size() > 5) throw Wrong(5, "a coefficient for some types is not taken; give a group of its own", true);
  }
};

struct Style { const char* name; void (Making::*make)(); };
constexpr Style styles[]{{"move", &Making::move},
                         {"setforce", &Making::setforce},
                         {"gravity", &Making::gravity},
                         {"addforce", &Making::addforce},
                         {"wall/gran/region", &Making::wall_region},
                         {"wall/gran", &Making::wall_gran},
                         {"wall/body/polyhedron", &Making::wall_body},
                         {"viscous", &Making::viscous}};

struct Integrator { const char* name; const char* note; };
constexpr const char* cold = "there is no temperature here: what it integrates moves, and comes to rest";
constexpr Integrator integrators[]{{"nve", ""}, {"nve/sphere", ""}, {"nve/body", ""}, {"nve/limit", ""}, {"nvt", cold},
                                   {"nvt/sphere", cold}, {"nvt/body", cold}, {"nve/asphere", ""}};

struct Other { const char* name; const char* why; bool moves = false; };   // moves: matters in motion
constexpr Other others[]{{"print", "output: a run of elamin writes its own"},
                         {"ave/time", "output: a run of elamin writes its own"},
                         {"ave/atom", "output: a run of elamin writes its own"},
                         {"ave/chunk", "output: a run of elamin writes its own"},
                         {"ave/histo", "output: a run of elamin writes its own"},
                         {"ave/correlate", "output: a run of elamin writes its own"},
                         {"vector", "output: a run of elamin writes its own"},
                         {"store/state", "output: a run of elamin writes its own"},
                         {"store/force", "output: a run of elamin writes its own"},
                         {"balance", "how LAMMPS uses the machine"},
                         {"langevin", "there is no temperature here", true},
                         {"temp/rescale", "there is no temperature here", true},
                         {"temp/berendsen", "there is no temperature here", true},
                         {"dt/reset", "how LAMMPS minimises or steps: [solver] says how elamin does", true},
                         {"recenter", "rigid motions are held by supports", true},
                         {"momentum", "rigid motions are held by supports", true},
                         {"halt", "how long LAMMPS runs"}};

}  // namespace

void fix(Interpreter& in) {
  in.wants(4, "fix ID GROUP STYLE …");
  World& w = in.world;
  Making m{in, {}};
  Fix& f = m.fix;
  f.id = in.word(1), f.group = in.word(2), f.style = in.word(3), f.where = in.where;
  if (!std::all_of(f.id.begin(), f.id.end(), [](unsigned char c) { return std::isalnum(c) || c == '_'; }))
    throw Wrong(1, in_quotes(f.id) + " is no name of a fix; letters, digits and _ are");
  w.group(f.group, 2);
  f.text = in.text();
  std::vector<std::string> known;
  bool found = false;
  for (const Style& s : styles) {
    known.push_back(s.name);
    if (f.style != s.name) continue;
    found = true;
    (m.*s.make)();
  }
  for (const Integrator& s : integrators) {
    known.push_back(s.name);
    if (f.style != s.name) continue;
    found = true;
    f.kind = Fix::Kind::integrate;
    for (std::size_t i = 4; i < in.size() && f.style == "nve/sphere"; ++i)
      if (in.word(i) == "update" && i + 1 < in.size()) ++i;
      else if (in.word(i) != "disc") throw Wrong(i, in_quotes(in.word(i)) + " is no keyword of nve/sphere; update and disc are");
    if (*s.note) in.note(s.note);
    if (*s.note || f.style == "nve/limit") in.not_in_motion();
  }
  if (f.style == "nve/noforce") f.kind = Fix::Kind::hold, f.unforced = found = true;
  if (f.style == "freeze") f.kind = Fix::Kind::hold, found = true;
  if (f.style == "enforce2d") f.kind = Fix::Kind::plane, found = true;
  for (const Other& o : others)
    if (f.style == o.name) {
      found = true;
      in.ignore(o.why);
      if (o.moves) in.not_in_motion();
    }
  if (!found)
    throw Wrong(
        3,
        in_quotes(f.style) + " is no fix that is known here; there are: freeze, enforce2d, nve/noforce, " + listed(known) +
            did_you_mean(f.style, known),
        true);
  if (f.kind == Fix::Kind::viscous) in.ignore("drag: matters in motion only (--dynamics)");
  f.serial = ++w.fix_serial;
  const auto same = std::find_if(w.fixes.begin(), w.fixes.end(), [&](const Fix& o) { return o.id == f.id; });
  if (same == w.fixes.end()) w.fixes.push_back(std::move(f));
  else {
    if (same->style != f.style) throw Wrong(1, fmt::format("the fix {} is there already, of style {}", f.id, same->style));
    *same = std::move(f);                        // as LAMMPS does
  }
}

void unfix(Interpreter& in) {
  in.wants(2, "unfix ID", 2);
  auto& fixes = in.world.fixes;
  const auto found = std::find_if(fixes.begin(), fixes.end(), [&](const Fix& f) { return f.id == in.word(1); });
  if (found == fixes.end()) throw Wrong(1, in_quotes(in.word(1)) + " is no fix");
  fixes.erase(found);
}

namespace {

std::string kind_of(const World& w, std::size_t c) { return w.boundary[c]; }

/// Where the steps of a run and those of its ramps begin and end.
struct Span { bool minimize = false; long long steps = 0, before = 0, total = 0; };

/// What v_NAME is (of style atom: of each atom) as a run begins and as it ends; in between it must be linear in the step.
std::array<std::vector<double>, 2> over_run(Interpreter& in, const std::string& formula, bool each, const Span& span, const std::string& what) {
  World& w = in.world;
  struct Leave { World& w; ~Leave() { w.moment = {}; } } leave{w};
  const auto wrong = [&](const std::string& why) { throw Wrong(0, fmt::format("{}: {} {}", what, in_quotes(formula), why)); };
  Dependence on;
  const auto at = [&](long long step) {
    w.moment = {step, span.before, span.total};
    const Value v = evaluate(formula, w, in.names, 0, each, &on);
    const std::vector<double> values = v.each.empty() ? std::vector(each ? w.atoms.size() : 1, v.number) : v.each;
    if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) wrong("is not finite");
    return values;
  };
  const std::vector<double> begin = at(0);
  if (on.places) wrong("depends on where particles are, which is not followed");
  if (on.time && span.minimize) wrong("changes in time, which a minimisation does not have");
  if (!on.time || span.steps == 0) return {begin, begin};
  const std::vector<double> end = at(span.steps);
  constexpr int samples = 32;                      // at multiples of the golden ratio: in step with no period of a formula
  for (int k = 0; k < samples + 2; ++k) {
    const double golden = 0.6180339887498949 * k;
    const long long step = k == samples       ? 1
                           : k == samples + 1 ? span.steps - 1
                                              : static_cast<long long>((golden - std::floor(golden)) * static_cast<double>(span.steps));
    const std::vector<double> now = at(step);
    const double part = static_cast<double>(step) / static_cast<double>(span.steps);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double line = begin[i] + part * (end[i] - begin[i]), size = std::max({std::abs(begin[i]), std::abs(end[i]), std::abs(now[i])});
      // Nothing but rounding may be off the line: formulas of a few operations round to some 1e-15 of what goes into them.
      if (!(std::abs(now[i] - line) <= 1e-10 * size))
        wrong(fmt::format("is not linear in the step of this run: {} as it begins, {} as it ends, {} at step {} of {}; a load factor takes what "
                          "is; write several runs, with ramp(A, B) in each",
                          begin[i], end[i], now[i], step, span.steps));
    }
  }
  return {begin, end};
}

/// What the formulas of a fix are in this run.
void evaluate_formulas(Interpreter& in, Run::Active& a, const Span& span) {
  Fix& f = a.fix;
  const std::string what = fmt::format("fix {} of line {}", f.id, f.where.line);
  if (f.kind == Fix::Kind::gravity && !f.formulas[0].empty()) {
    const auto g = over_run(in, f.formulas[0], false, span, what);
    f.vector = g[0][0] * f.direction, f.end = g[1][0] * f.direction;
  }
  for (std::size_t c = 0; c < 3 && f.kind == Fix::Kind::force; ++c) {
    if (f.formulas[c].empty()) continue;
    const auto component = static_cast<Eigen::Index>(c);
    const bool each = of_atoms(in, f.formulas[c]);
    const auto values = over_run(in, f.formulas[c], each, span, what);
    if (!each) {
      f.vector[component] = values[0][0], f.end[component] = values[1][0];
      continue;
    }
    a.own.resize(a.members.size(), {Vec3::Zero(), Vec3::Zero()});
    for (std::size_t k = 0; k < a.members.size(); ++k)
      for (std::size_t end = 0; end < 2; ++end) a.own[k][end][component] = values[end][static_cast<std::size_t>(a.members[k])];
  }
  for (Fix::Wall& wall : f.walls)
    for (std::size_t c = 0; c < 4; ++c) {
      if (wall.formulas[c].empty()) continue;
      const auto values = over_run(in, wall.formulas[c], false, span, what + ", its region");
      for (std::size_t end = 0; end < 2; ++end) {
        if (c < 3) wall.moved[end][static_cast<Eigen::Index>(c)] = values[end][0];
        else wall.grown[end] = values[end][0] - wall.region.radius;
        if (c == 3 && !(values[end][0] > 0))
          throw Wrong(0, fmt::format("{}: the radius of its region is {}; it must be above 0", what, values[end][0]));
      }
    }
}

/// Pairs that are left out in a run.
std::vector<Run::Excluded> excluded(const World& w, const std::vector<int>& atoms) {
  using Of = Exclusion::Of;
  constexpr std::size_t most_molecules = 1000;
  std::vector<Run::Excluded> all;
  const auto add = [&](const Exclusion& e, const std::vector<int>& I, const std::vector<int>& J) {
    if (!I.empty() && !J.empty() && (I != J || I.size() > 1)) all.push_back({{I, J}, e.where, e.text});
  };
  for (const Exclusion& e : w.exclusions) {
    std::array<std::vector<int>, 2> sides;
    std::map<int, std::vector<int>> molecules;
    for (const int k : atoms) {
      const Atom& a = w.atoms[static_cast<std::size_t>(k)];
      for (std::size_t s = 0; s < 2; ++s)
        if (e.of == Of::types ? a.type == e.which[s] : w.in(a, e.which[s])) sides[s].push_back(k);
      if (e.of == Of::molecules && w.in(a, e.which[0])) molecules[a.molecule].push_back(k);
    }
    if (e.of != Of::molecules) add(e, sides[0], sides[1]);
    if (molecules.size() > most_molecules)
      throw Wrong(0, fmt::format("`{}` is of {} molecules; at most {} are taken", e.text, molecules.size(), most_molecules));
    for (const auto& [number, members] : molecules) add(e, members, members);
  }
  return all;
}

/// The checks of a run, and what is in force in it.
Run in_force(Interpreter& in, const Span& span) {
  World& w = in.world;
  if (!w.has_box) throw Wrong(0, "stands before create_box or read_data");
  const auto periodic = [&](int c) { return kind_of(w, static_cast<std::size_t>(c)).find('p') != std::string::npos; };
  for (int c = 0; c < 3; ++c)
    if (periodic(c) && !(c == 2 && w.dimension == 2))
      throw Wrong(
          0, fmt::format(
                 "the box is periodic along {}: elamin has no periodic boxes. Write `boundary f f f` (or s) before the box is made, or "
                 "`change_box all boundary f f f` behind it, with walls or room around what there is",
                 "xyz"[c]));
  Run r;
  r.where = in.where, r.minimize = span.minimize, r.steps = span.steps, r.timestep = w.timestep;
  r.text = in.text();
  for (std::size_t k = 0; k < w.atoms.size(); ++k)
    if (World::there(w.atoms[k])) r.atoms.push_back(static_cast<int>(k));
  if (r.atoms.empty() && !r.still()) throw Wrong(0, "there is no atom");
  if (w.runs.size() >= most_runs) throw Wrong(0, fmt::format("is one more than {} runs", most_runs));
  for (const Fix& f : w.fixes) {
    if (f.kind == Fix::Kind::ignored) continue;
    Run::Active a{f, {}, {}};
    const int g = w.group(f.group, 0);
    for (const int k : r.atoms)
      if (w.in(w.atoms[static_cast<std::size_t>(k)], g)) a.members.push_back(k);
    if (a.members.empty()) continue;
    if (!f.region.empty()) {                      // it may have been made anew
      const auto region = w.regions.find(f.region);
      if (region == w.regions.end() || region->second.kind != ScriptRegion::Kind::shape)
        throw Wrong(0, fmt::format("the region {} of the fix {} is there no more", in_quotes(f.region), f.id));
      Fix::Wall& wall = a.fix.walls[0];
      wall.region = region->second.shape, wall.inside = region->second.inside, wall.formulas = region->second.formulas;
    }
    evaluate_formulas(in, a, span);
    r.fixes.push_back(std::move(a));
  }
  r.excluded = excluded(w, r.atoms);
  r.pairs = w.pairs, r.special_lj = w.special_lj, r.special_coul = w.special_coul;
  const auto coefficients = [&](const auto& list, const std::vector<Coefficient>& all, std::map<int, Coefficient>& to, const char* what) {
    for (const auto& glue : list)
      if (glue.gone == always && !to.count(glue.type)) {
        const Coefficient& c = all[static_cast<std::size_t>(glue.type - 1)];
        if (!c.set) throw Wrong(0, fmt::format("{}s of type {} have no coefficients; {}_coeff gives them", what, glue.type, what));
        to[glue.type] = c;
      }
  };
  coefficients(w.bonds, w.bond_coefficients, r.bonds, "bond");
  coefficients(w.angles, w.angle_coefficients, r.angles, "angle");
  if (!w.runs.empty())                            // glue that was there keeps its stiffness within a problem
    for (const auto& [now, before] : {std::pair(&r.bonds, &w.runs.back().bonds), {&r.angles, &w.runs.back().angles}})
      for (const auto& [type, c] : *now)
        if (const auto old = before->find(type); old != before->end() && !(old->second == c)) throw NeedsPositions{w.last_run};
  if (w.unspecial)
    in.note(
        "bonds made with `special no` are not known to LAMMPS's contacts: it lets bonded pairs touch, here they do as special_bonds says");
  return r;
}

/// The record of a run; then what is known of where things are.
void record(Interpreter& in, const Span& span) {
  World& w = in.world;
  if (span.steps == 0 && !span.minimize && !w.runs.empty()) return in.ignore("a run of no steps moves nothing");
  Run r = in_force(in, span);
  for (const int k : r.atoms)
    if (Atom& a = w.atoms[static_cast<std::size_t>(k)]; a.born == w.run_number()) a.start = a.x;
  if (r.still()) {                                 // a study only if nothing else is run
    w.still = std::move(r);
    return;
  }
  // Integrated; all coordinates given by fix move, by a hold.
  std::vector<char> moving(w.atoms.size(), r.minimize), driven(w.atoms.size()), held(w.atoms.size());
  std::vector<Vec3> velocity(w.atoms.size(), Vec3::Zero());
  for (const Run::Active& a : r.fixes)
    for (const int k : a.members) {
      const auto i = static_cast<std::size_t>(k);
      if (a.fix.integrates()) moving[i] = 1;
      if (a.fix.kind == Fix::Kind::move && a.fix.directions == std::array{true, true, true}) driven[i] = 1, velocity[i] = a.fix.vector;
      if (a.fix.kind == Fix::Kind::hold && !a.fix.unforced && a.fix.directions == std::array{true, true, true}) held[i] = 1;
    }
  for (const int k : r.atoms) {
    const auto i = static_cast<std::size_t>(k);
    Atom& a = w.atoms[i];
    if (driven[i] && !r.minimize) a.x += velocity[i] * r.time();
    else if (moving[i] && !(held[i] && r.minimize)) a.moved = true;      // in a run what is held goes on at the velocity that it had
  }
  w.last_run = in.where;
  w.step += r.steps, w.time += r.minimize ? 0 : r.time();
  w.runs.push_back(std::move(r));
  if (in.after >= in.options.after.size()) return;
  take_positions(in, in.options.after[in.after++]);
  // From here on it is a problem by itself: what was run is behind it.
  for (Atom& a : w.atoms) a.moved = false, a.born = 0, a.v.setZero(), a.gone = a.gone == always ? always : -1;
  std::erase_if(w.bonds, [](const auto& b) { return b.gone != always; });
  std::erase_if(w.angles, [](const auto& b) { return b.gone != always; });
  for (auto& b : w.bonds) b.born = 0;
  for (auto& b : w.angles) b.born = 0;
  w.runs.clear(), w.still.reset(), w.removals.clear();
}

}  // namespace

void run(Interpreter& in) {
  in.wants(2, "run STEPS");
  constexpr long long most = 1000000000000000000;
  long long steps = in.integer(1, 0, most), start = in.world.step, stop = -1;
  for (std::size_t i = 2; i < in.size();) {
    const std::string& k = in.word(i);
    if (k == "upto") steps = std::max(0LL, steps - in.world.step), ++i;
    else if (k == "start") start = in.integer(i + 1, 0, in.world.step), i += 2;
    else if (k == "stop") stop = in.integer(i + 1, 0, most), i += 2;
    else if (k == "pre" || k == "post") i += 2;
    else if (k == "every") throw Wrong(i, "commands within a run are not followed; write several runs", true);
    else throw Wrong(i, in_quotes(k) + " is no keyword of run");
  }
  if (in.world.step > most - steps) throw Wrong(1, "is more steps than can be counted");
  if (stop < 0) stop = in.world.step + steps;
  if (stop < in.world.step + steps) throw Wrong(0, "stops its ramps before it ends; stop is a step that it ends at or before");
  record(in, {false, steps, in.world.step - start, stop - start});
}

void minimize(Interpreter& in) {
  in.wants(5, "minimize ETOL FTOL ITERATIONS EVALUATIONS", 5);
  record(in, {true, 0, 0, 0});
}

}  // namespace elamin::script::command
