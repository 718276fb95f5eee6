// Commands that set up the box, regions and coefficients.
#include "core/find.hpp"
#include "lammps/script/building.hpp"

#include "core/suggest.hpp"
#include "laws/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace elamin::script::command {
namespace {

constexpr int most_types = 1000000;
constexpr double nowhere = 1e20;                // LAMMPS's INF

/// A coordinate of a region: a number, INF or EDGE.
double coordinate(const Interpreter& in, std::size_t i, int axis, bool high) {
  if (i < in.size() && in.word(i) == "INF") return high ? nowhere : -nowhere;
  if (i < in.size() && in.word(i) == "EDGE") {
    if (!in.world.has_box) throw Wrong(i, "EDGE is of the box, which there is not yet");
    return in.world.side(axis, high);
  }
  return in.value(i);
}

}  // namespace

void units(Interpreter& in) {
  in.wants(2, "units STYLE", 2);
  in.world.units = in.word(1);
  static const std::map<std::string, double> timesteps{{"lj", 0.005},      {"real", 1},  {"metal", 0.001}, {"si", 1e-8}, {"cgs", 1e-8},
                                                       {"electron", 0.001}, {"micro", 2}, {"nano", 0.00045}};
  if (const auto known = timesteps.find(in.word(1)); known != timesteps.end()) in.world.timestep = known->second;
  in.world.skin = in.word(1) == "lj" ? 0.3 : in.word(1) == "si" ? 0.001 : 0.1;
  in.ignore("numbers are taken as they are; elamin's units are any that go together");
  if (in.word(1) != "lj" && in.word(1) != "si" && in.word(1) != "cgs" && in.word(1) != "micro" && in.word(1) != "nano")
    throw Wrong(1, fmt::format("in units {} forces are not mass times acceleration in the same units; lj, si, cgs, micro and nano are taken",
                               in.word(1)), true);
}

void dimension(Interpreter& in) {
  in.wants(2, "dimension 2 or 3", 2);
  in.world.dimension = static_cast<int>(in.integer(1, 2, 3));
}

void boundary(Interpreter& in) {
  in.wants(4, "boundary X Y Z, each of f, s, m or p", 4);
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string& w = in.word(c + 1);
    if (w.empty() || w.size() > 2 || w.find_first_not_of("pfsm") != std::string::npos)
      throw Wrong(c + 1, in_quotes(w) + " is no kind of boundary; f, s, m and p are, or two of these");
    in.world.boundary[c] = w;
  }
  in.world.boundary_where = in.where;
}

void atom_style(Interpreter& in) {
  in.wants(2, "atom_style STYLE …");
  World& w = in.world;
  if (w.has_box) throw Wrong(0, "stands behind create_box or read_data");
  w.sphere = w.molecular = w.bodies = false;
  w.atom_style.clear();
  for (std::size_t i = 1; i < in.size(); ++i) {
    const std::string& s = in.word(i);
    if (s == "hybrid" && i == 1 && in.size() > 2) {
    } else if (s == "sphere") w.sphere = true;
    else if (s == "bond" || s == "angle" || s == "molecular" || s == "full") w.molecular = true;
    else if (s == "atomic") {
    } else if (s == "body") {
      w.bodies = true;
      if (i + 1 < in.size() && in.word(i + 1) != "rounded/polyhedron")
        throw Wrong(i + 1, in_quotes(in.word(i + 1)) + " are no bodies that are known here; rounded/polyhedron are", true);
      w.atom_style += (w.atom_style.empty() ? "" : " ") + s;
      break;
    } else if (s.find_first_not_of("0123456789") == std::string::npos) continue;   // as `sphere 1` has
    else
      throw Wrong(i, in_quotes(s) + " is no atom style that is known here; atomic, sphere, bond, angle, molecular, full, body and hybrids of "
                                    "them are", true);
    w.atom_style += (w.atom_style.empty() ? "" : " ") + s;
  }
}

void lattice(Interpreter& in) {
  in.wants(3, "lattice STYLE SCALE");
  if (in.word(1) != "none")
    throw Wrong(1, "atoms on a lattice are not made; write them one by one (create_atoms … single), or let LAMMPS write a data file "
                   "(write_data FILE)", true);
  in.world.lattice = in.positive(2);
}

/// The faces of a prism as planes, with the block around it: a prism is inside of all of them.
std::vector<Region> prism(const Vec3& lo, const Vec3& hi, double xy, double xz, double yz) {
  const Vec3 size = hi - lo, a(size[0], 0, 0), b(xy, size[1], 0), c(xz, yz, size[2]);
  std::vector<Region> all(7);
  all[0].shape = Shape::block;
  all[0].lo = lo + Vec3(std::min({0., xy, xz, xy + xz}), std::min(0., yz), 0), all[0].hi = hi + Vec3(std::max({0., xy, xz, xy + xz}), std::max(0., yz), 0);
  const std::array<Vec3, 3> edges{a, b, c}, inward{b.cross(c).normalized(), c.cross(a).normalized(), a.cross(b).normalized()};
  for (std::size_t k = 0; k < 3; ++k) {
    all[1 + k].center = lo, all[1 + k].normal = inward[k];
    all[4 + k].center = lo + edges[k], all[4 + k].normal = -inward[k];
  }
  return all;
}

void region(Interpreter& in) {
  in.wants(3, "region ID STYLE …");
  World& w = in.world;
  const std::string id = in.word(1), style = in.word(2);
  if (style == "delete") {
    if (!w.regions.erase(id)) throw Wrong(1, in_quotes(id) + " is no region");
    return;
  }
  if (w.regions.count(id)) throw Wrong(1, in_quotes(id) + " is a region already");
  ScriptRegion r;
  r.where = in.where, r.words = in.text();
  Region& s = r.shape;
  std::size_t next = 0;
  const auto numbers = [&](std::size_t n) {
    if (in.size() < 3 + n) throw Wrong(in.size() - 1, fmt::format("a region of style {} has {} numbers", style, n));
    next = 3 + n;
  };
  const auto fixed = [&](std::size_t i) {
    Dependence on;
    const double v = in.value(i, &on);
    if (on.time) throw Wrong(i, in_quotes(in.word(i)) + " changes in time, which is followed of radii and of `move` alone", true);
    return v;
  };
  const auto radius_at = [&](std::size_t i) {     // a variable of style equal is evaluated by every run
    if (in.word(i).starts_with("v_")) r.formulas[3] = in.word(i);
    Dependence on;
    const double radius = in.value(i, &on);
    r.moves = on.time || on.places;
    return radius;
  };
  const auto along = [&](std::size_t lo_at) {    // ends along the axis
    s.axial_lo = coordinate(in, lo_at, s.axis, false), s.axial_hi = coordinate(in, lo_at + 1, s.axis, true);
    if (s.axial_lo > s.axial_hi) throw Wrong(lo_at, "the region ends before it begins");
  };
  const auto on_axis = [&] {
    s.axis = in.axis(3);
    const int a = s.axis == 0 ? 1 : 0, b = s.axis == 2 ? 1 : 2;
    s.center[a] = fixed(4), s.center[b] = fixed(5);
  };
  if (style == "block") {
    numbers(6);
    s.shape = Shape::block;
    for (int c = 0; c < 3; ++c) {
      const std::size_t i = 3 + 2 * c;
      s.lo[c] = coordinate(in, i, c, false), s.hi[c] = coordinate(in, i + 1, c, true);
      if (s.lo[c] > s.hi[c]) throw Wrong(i, "the region ends before it begins");
    }
  } else if (style == "cylinder") {
    numbers(6);
    s.shape = Shape::cylinder;
    on_axis();
    s.radius = radius_at(6);
    along(7);
  } else if (style == "cone") {
    numbers(7);
    s.shape = Shape::cone;
    on_axis();
    s.radius_lo = in.value(6), s.radius_hi = in.value(7);
    if (s.radius_lo < 0 || s.radius_hi < 0) throw Wrong(6, "a radius is negative");
    along(8);
  } else if (style == "sphere") {
    numbers(4);
    s.shape = Shape::sphere;
    s.center = Vec3(fixed(3), fixed(4), fixed(5)), s.radius = radius_at(6);
  } else if (style == "plane") {
    numbers(6);
    s.shape = Shape::plane;
    s.center = Vec3(in.value(3), in.value(4), in.value(5)), s.normal = Vec3(in.value(6), in.value(7), in.value(8));
    if (!(s.normal.norm() > 0)) throw Wrong(6, "the normal has no length");
    s.normal /= s.normal.norm();
  } else if (style == "prism") {
    numbers(9);
    r.kind = ScriptRegion::Kind::intersect;
    const double unit = in.unit_of_length(12);
    Vec3 lo, hi;
    for (int c = 0; c < 3; ++c) {
      const std::size_t i = 3 + 2 * c;
      lo[c] = unit * in.number(i), hi[c] = unit * in.number(i + 1);
      if (!(lo[c] < hi[c])) throw Wrong(i, "the region ends before it begins");
    }
    const std::vector<Region> faces = prism(lo, hi, unit * in.number(9), unit * in.number(10), unit * in.number(11));
    for (std::size_t k = 0; k < faces.size(); ++k) {
      ScriptRegion part = r;
      part.kind = ScriptRegion::Kind::shape, part.shape = faces[k];
      r.parts.push_back(fmt::format("{} ({})", id, k));
      w.regions[r.parts.back()] = part;
    }
  } else if (style == "union" || style == "intersect") {
    r.kind = style == "union" ? ScriptRegion::Kind::unite : ScriptRegion::Kind::intersect;
    const auto n = static_cast<std::size_t>(in.integer(3, 2, 1000));
    numbers(1 + n);
    for (std::size_t i = 4; i < 4 + n; ++i) {
      if (!w.regions.count(in.word(i))) throw Wrong(i, in_quotes(in.word(i)) + " is no region");
      r.parts.push_back(in.word(i));
    }
  } else
    throw Wrong(2, in_quotes(style) + " is no style of a region that is known here; block, prism, cylinder, cone, sphere, plane, union and "
                                      "intersect are", true);
  if ((style == "cylinder" || style == "sphere") && !(s.radius > 0)) throw Wrong(6, "the radius is not above 0");
  bool box_units = false;
  for (std::size_t i = next; i < in.size();) {
    const std::string& k = in.word(i);
    if (i + 1 >= in.size()) throw Wrong(i, in_quotes(k) + " is followed by nothing");
    const std::string& v = in.word(i + 1);
    if (k == "side" && (v == "in" || v == "out")) r.inside = v == "in", i += 2;
    else if (k == "units" && (v == "box" || v == "lattice")) box_units = v == "box", i += 2;
    else if (k == "open") {
      const bool block = s.shape == Shape::block;
      if (r.kind != ScriptRegion::Kind::shape || s.shape == Shape::sphere || s.shape == Shape::plane)
        throw Wrong(i, "is of blocks, cylinders and cones");
      s.open[in.integer(i + 1, 1, block ? 6 : 3) - 1] = true, i += 2;
    } else if (k == "move" && i + 3 < in.size()) {
      r.moves = true;
      for (std::size_t c = 0; c < 3; ++c)
        if (const std::string& by = in.word(i + 1 + c); by.starts_with("v_")) r.formulas[c] = by;
        else if (by != "NULL") throw Wrong(i + 1 + c, in_quotes(by) + " is neither v_NAME of a variable nor NULL");
      i += 4;
    } else if (k == "rotate" || k == "move") throw Wrong(i, "turning regions are not followed", true);
    else throw Wrong(i, in_quotes(k) + " is no keyword of a region; side, units, open and move are", true);
  }
  if (!box_units && w.lattice != 1 && r.kind == ScriptRegion::Kind::shape) {
    if (r.formulas != std::array<std::string, 4>{}) throw Wrong(0, "moves or grows in units of a lattice; units box are taken", true);
    for (Vec3* v : {&s.center, &s.lo, &s.hi}) *v *= w.lattice;
    for (double* d : {&s.axial_lo, &s.axial_hi, &s.radius, &s.radius_lo, &s.radius_hi}) *d *= w.lattice;
  }
  w.regions[id] = std::move(r);
}

void create_box(Interpreter& in) {
  in.wants(3, "create_box TYPES REGION [KEYWORD N …]");
  World& w = in.world;
  if (w.has_box) throw Wrong(0, "there is a box already");
  const int types = static_cast<int>(in.integer(1, 1, most_types));
  const auto found = w.regions.find(in.word(2));
  if (found == w.regions.end()) throw Wrong(2, in_quotes(in.word(2)) + " is no region");
  const Region& r = found->second.shape;
  if (found->second.kind != ScriptRegion::Kind::shape || r.shape != Shape::block || !found->second.inside)
    throw Wrong(2, "the region of a box must be a block, side in");
  for (int c = 0; c < 3; ++c)
    if (std::abs(r.lo[c]) >= nowhere || std::abs(r.hi[c]) >= nowhere) throw Wrong(2, "the region of a box must be finite");
  int bonds = 0, angles = 0;
  for (std::size_t i = 3; i < in.size(); i += 2) {
    const std::string& k = in.word(i);
    const int n = static_cast<int>(in.integer(i + 1, 0, most_types));
    if (k == "bond/types") bonds = n;
    else if (k == "angle/types") angles = n;
    else if (!k.starts_with("extra/") && k != "dihedral/types" && k != "improper/types")
      throw Wrong(i, in_quotes(k) + " is no keyword of create_box");
  }
  w.atom_types = types, w.bond_types = bonds, w.angle_types = angles;
  w.set_box({r.lo, r.hi});
  w.mass.resize(types);
  w.bond_coefficients.resize(bonds), w.angle_coefficients.resize(angles);
}

void change_box(Interpreter& in) {
  in.wants(3, "change_box GROUP KEYWORD …");
  needs_box(in);
  World& w = in.world;
  const int g = w.group(in.word(1), 1);
  const double unit = in.unit_of_length(2);
  w.shrink_box();
  std::array<Vec3, 2> before = w.box;            // that `remap` goes out from
  for (std::size_t i = 2; i < in.size();) {
    const std::string& k = in.word(i);
    const auto takes = [&](std::size_t words) {
      if (i + words >= in.size()) throw Wrong(i, fmt::format("is followed by {} words", words));
    };
    if (k == "boundary") {
      takes(3);
      for (std::size_t c = 0; c < 3; ++c) {
        const std::string& b = in.word(i + 1 + c);
        if (b.empty() || b.size() > 2 || b.find_first_not_of("pfsm") != std::string::npos)
          throw Wrong(i + 1 + c, in_quotes(b) + " is no kind of boundary; f, s, m and p are");
        w.boundary[c] = b;
      }
      w.boundary_where = in.where;
      w.set_box(w.box);
      i += 4;
    } else if (k == "x" || k == "y" || k == "z") {
      takes(2);
      const int c = k[0] - 'x';
      const std::string& how = in.word(i + 1);
      std::array<Vec3, 2> now = w.box;
      if (how == "final" || how == "delta") {
        takes(3);
        for (std::size_t end = 0; end < 2; ++end) {
          now[end][c] = unit * in.number(i + 2 + end) + (how == "delta" ? w.side(c, static_cast<int>(end)) : 0);
          w.lost[end][c] = false;
        }
        i += 4;
      } else if (how == "scale") {
        const double lo = w.side(c, 0), hi = w.side(c, 1), middle = 0.5 * (lo + hi), factor = in.positive(i + 2);
        now[0][c] = middle + factor * (lo - middle), now[1][c] = middle + factor * (hi - middle), i += 3;
      } else throw Wrong(i + 1, in_quotes(how) + " is no change of a side that is taken; final, delta and scale are", true);
      if (!(now[0][c] < now[1][c])) throw Wrong(i - 1, "the box ends before it begins");
      w.set_box(now);
    } else if (k == "remap" || k == "set") {
      const std::array<Vec3, 2> now = w.box;
      for (int c = 0; c < 6; ++c) w.side(c / 2, c % 2);          // has to be known
      for (Atom& a : w.atoms) {
        if (k == "set" || now == before || !World::there(a) || !w.in(a, g)) continue;
        newborn(w, a);
        a.x = now[0].array() + (a.x - before[0]).array() / (before[1] - before[0]).array() * (now[1] - now[0]).array();
      }
      before = now;
      ++i;
    } else if (k == "units") i += 2;
    else throw Wrong(i, in_quotes(k) + " is no keyword of change_box that is taken; boundary, x, y, z, remap, set and units are", true);
  }
  w.shrink_box();
}

void timestep(Interpreter& in) {
  in.wants(2, "timestep DT", 2);
  in.world.timestep = in.positive(1);
}

void reset_timestep(Interpreter& in) {
  in.wants(2, "reset_timestep N");
  in.world.step = in.integer(1, 0, 9000000000000000000);
}

void special_bonds(Interpreter& in) {
  in.wants(2, "special_bonds KEYWORD …");
  World& w = in.world;
  std::array<double, 3> lj{}, coul{};
  for (std::size_t i = 1; i < in.size();) {
    const std::string& k = in.word(i);
    if (k == "fene") lj = coul = {0, 1, 1}, ++i;
    else if (k == "charmm") lj = coul = {0, 0, 0}, ++i;
    else if (k == "dreiding") lj = coul = {0, 0, 1}, ++i;
    else if (k == "lj" || k == "coul" || k == "lj/coul") {
      for (std::size_t c = 0; c < 3; ++c) {
        const double f = in.number(i + 1 + c);
        if (f < 0 || f > 1) throw Wrong(i + 1 + c, "must be from 0 to 1");
        if (k != "coul") lj[c] = f;
        if (k != "lj") coul[c] = f;
      }
      i += 4;
    } else if (k == "angle" || k == "dihedral") {
      if (in.yes(i + 1)) throw Wrong(i, "that only atoms of an angle count as second neighbours is not followed", true);
      i += 2;
    } else if (k == "extra") i += 2;
    else throw Wrong(i, in_quotes(k) + " is no keyword of special_bonds that is taken; lj, coul, lj/coul, fene, charmm, dreiding, angle no and extra are", true);
  }
  w.special_lj = lj, w.special_coul = coul;
}

namespace {

/// The style of a coefficient line, and where its numbers begin.
std::string style_of(const Interpreter& in, const std::string& style, std::size_t& first) {
  if (!style.starts_with("hybrid")) return style;
  if (in.size() <= first) throw Wrong(in.size() - 1, "the name of a style is missing behind this");
  return in.word(first++);
}

void glue_style(Interpreter& in, std::string& style, std::vector<Coefficient>& coefficients, const std::vector<std::string>& known) {
  in.wants(2, in.word(0) + " STYLE");
  for (Coefficient& c : coefficients) c.set = false;             // as LAMMPS does, of the same style, too
  style = in.word(1);
  std::size_t i = 1;
  if (style == "hybrid") ++i;
  for (; i < in.size(); ++i)
    if (i > 1 && style != "hybrid" && in.word(i) != "nocoeff") throw Wrong(i, in_quotes(in.word(i)) + " is no word of this style");
    else if (!contains(known, in.word(i)) && in.word(i) != "nocoeff")
      throw Wrong(i, in_quotes(in.word(i)) + " is no style that is known here; there are: " + listed(known), true);
}

}  // namespace

void bond_style(Interpreter& in) { glue_style(in, in.world.bond_style, in.world.bond_coefficients, {"harmonic", "zero", "none"}); }
void angle_style(Interpreter& in) { glue_style(in, in.world.angle_style, in.world.angle_coefficients, {"cosine", "cosine/shift", "zero", "none"}); }

void bond_coeff(Interpreter& in) {
  in.wants(2, "bond_coeff TYPE K R0");
  const auto types = in.range(1, in.world.bond_types);
  std::size_t i = 2;
  const std::string style = style_of(in, in.world.bond_style, i);
  Coefficient c{0, 0, true};
  if (style == "harmonic") {
    if (in.size() != i + 2) throw Wrong(0, "a harmonic bond has two numbers: K and r0");
    c.stiffness = in.number(i), c.rest = in.number(i + 1);
    if (c.stiffness < 0 || c.rest < 0) throw Wrong(c.stiffness < 0 ? i : i + 1, "is negative; 0 or more is taken");
  } else if (style != "zero" && style != "none")
    throw Wrong(0, style.empty() ? "stands before bond_style" : in_quotes(style) + " is no bond style that is known here", true);
  for (int t = types[0]; t <= types[1]; ++t) in.world.bond_coefficients[t - 1] = c;
}

void angle_coeff(Interpreter& in) {
  in.wants(2, "angle_coeff TYPE K [THETA0]");
  const auto types = in.range(1, in.world.angle_types);
  std::size_t i = 2;
  const std::string style = style_of(in, in.world.angle_style, i);
  Coefficient c{0, pi, true};
  if (style == "cosine") {
    if (in.size() != i + 1) throw Wrong(0, "a cosine angle has one number: K");
    c.stiffness = in.number(i);
  } else if (style == "cosine/shift") {
    if (in.size() != i + 2) throw Wrong(0, "a cosine/shift angle has two numbers: Umin and theta0");
    c.stiffness = in.number(i) / 2;
    const double degrees = in.number(i + 1);
    if (degrees < 0 || degrees > 180) throw Wrong(i + 1, "must be from 0 to 180 degrees");
    c.rest = degrees == 180 ? pi : degrees * (pi / 180);
  } else if (style != "zero" && style != "none")
    throw Wrong(0, style.empty() ? "stands before angle_style" : in_quotes(style) + " is no angle style that is known here", true);
  if (c.stiffness < 0) throw Wrong(i, "is negative; 0 or more is taken");
  for (int t = types[0]; t <= types[1]; ++t) in.world.angle_coefficients[t - 1] = c;
}

void mass(Interpreter& in) {
  in.wants(3, "mass TYPE MASS", 3);
  const auto types = in.range(1, in.world.atom_types);
  const double m = in.positive(2);
  for (const Atom& a : in.world.atoms)
    in.world.change(a, !in.world.sphere && types[0] <= a.type && a.type <= types[1] && in.world.mass[a.type - 1] != m);
  for (int t = types[0]; t <= types[1]; ++t) in.world.mass[t - 1] = m;
  if (in.world.sphere) in.ignore("a sphere's mass follows from its diameter and density");
}

}  // namespace elamin::script::command
