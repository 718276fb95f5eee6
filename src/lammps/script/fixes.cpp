// Fixes.
#include "core/find.hpp"
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
    evaluate(formula, in.world, in.names, i, each && in.names.of_atoms(formula));
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
    for (int c = 0; c < 3; ++c) fix.vector[c] = in.unit_of_length(8) * direction(5 + c, c);
  }

  void setforce() {
    in.wants(7, "fix ID GROUP setforce FX FY FZ");
    fix.kind = Fix::Kind::hold;
    for (int c = 0; c < 3; ++c)
      if (direction(4 + c, c) != 0) throw Wrong(4 + c, "a force that replaces all others is not taken; 0 holds, and addforce adds", true);
  }

  /// lineforce leaves the force along an axis, planeforce that across it.
  void along_axis() {
    in.wants(7, "fix ID GROUP " + fix.style + " X Y Z");
    fix.kind = Fix::Kind::hold;
    int zeros = 0;
    for (int c = 0; c < 3; ++c) {
      const bool zero = constant(4 + c) == 0;
      zeros += zero;
      fix.directions[c] = zero == (fix.style == "lineforce");
    }
    if (zeros != 2) throw Wrong(4, fix.style + " along x, y or z is taken", true);
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
    for (std::size_t c = 0; c < 3; ++c) fix.vector[c] = number_or(fix.formulas[c], 4 + c, true);
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
      law.tell(in);
      return i;
    }
    if (in.word(i) == "hertz/history") {
      GranularLaw law;
      i = law.read_older(in, i + 1);
      law.tell(in);
      modulus = law.effective_modulus, fix.damping = law.damping();
      return i;
    }
    throw Wrong(i, in_quotes(in.word(i)) + " is no law of a wall that is known here; granular hertz, granular hertz/material and "
                                           "hertz/history are", true);
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
      throw Wrong(i + 1, "a wall of several regions together, or of a prism, is not taken; give each its own fix, or each face", true);
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
      throw Wrong(std::min(i, in.size() - 1), in_quotes(style) + " is no wall that is known here; xplane, yplane, zplane and zcylinder are", true);
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
constexpr Style styles[]{{"move", &Making::move}, {"setforce", &Making::setforce}, {"lineforce", &Making::along_axis},
                         {"planeforce", &Making::along_axis}, {"gravity", &Making::gravity}, {"addforce", &Making::addforce},
                         {"wall/gran/region", &Making::wall_region}, {"wall/gran", &Making::wall_gran},
                         {"wall/body/polyhedron", &Making::wall_body}, {"viscous", &Making::viscous}};

struct Integrator { const char* name; const char* note; };
constexpr const char* comes_to_rest = "there is no temperature here: what it integrates moves, and comes to rest";
constexpr Integrator integrators[]{{"nve", ""}, {"nve/sphere", ""}, {"nve/body", ""}, {"nve/limit", ""}, {"nvt", comes_to_rest},
                                   {"nvt/sphere", comes_to_rest}, {"nvt/body", comes_to_rest}, {"nve/asphere", ""}};

/// Fixes without effect here; `moves`: they matter in motion.
struct Other { const char* why; std::vector<std::string> names; bool moves = false; };
const std::vector<Other> others{
    {because::output, {"print", "ave/time", "ave/atom", "ave/chunk", "ave/histo", "ave/correlate", "vector", "store/state", "store/force"}},
    {because::machine, {"balance"}},
    {because::cold, {"langevin", "temp/rescale", "temp/berendsen"}, true},
    {because::stepping, {"dt/reset"}, true},
    {"rigid motions are held by supports", {"recenter", "momentum"}, true},
    {"how long LAMMPS runs", {"halt"}}};

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
    if (contains(o.names, f.style)) {
      found = true;
      in.ignore(o.why);
      if (o.moves) in.not_in_motion();
    }
  if (!found)
    throw Wrong(3, in_quotes(f.style) + " is no fix that is known here; there are: freeze, enforce2d, nve/noforce, " + listed(known) +
                       did_you_mean(f.style, known), true);
  if (f.kind == Fix::Kind::viscous) in.ignore("drag: matters in motion only (--dynamics)");
  f.serial = ++w.fix_serial;
  const auto same = std::find_if(w.fixes.begin(), w.fixes.end(), [&](const Fix& o) { return o.id == f.id; });
  if (same == w.fixes.end()) return w.fixes.push_back(std::move(f));
  if (same->style != f.style) throw Wrong(1, fmt::format("the fix {} is there already, of style {}", f.id, same->style));
  *same = std::move(f);                          // as LAMMPS does
}

void unfix(Interpreter& in) {
  in.wants(2, "unfix ID", 2);
  auto& fixes = in.world.fixes;
  const auto found = std::find_if(fixes.begin(), fixes.end(), [&](const Fix& f) { return f.id == in.word(1); });
  if (found == fixes.end()) throw Wrong(1, in_quotes(in.word(1)) + " is no fix");
  fixes.erase(found);
}

}  // namespace elamin::script::command
