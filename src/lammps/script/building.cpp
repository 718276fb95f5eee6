// Commands that make and change particles and what glues them.
#include "lammps/script/building.hpp"

#include "core/find.hpp"
#include "core/near_pairs.hpp"
#include "core/suggest.hpp"
#include "lammps/script/random.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace elamin::script::command {
namespace {

/// The box around a region that LAMMPS has: of a union if all of its parts have one, of an intersection if one of them has.
std::optional<std::array<Vec3, 2>> box_of(const World& w, const ScriptRegion& r) {
  if (!r.inside || (r.kind == ScriptRegion::Kind::shape && r.shape.shape == Shape::plane)) return std::nullopt;
  if (r.kind != ScriptRegion::Kind::shape) {
    const bool unite = r.kind == ScriptRegion::Kind::unite;
    std::optional<std::array<Vec3, 2>> whole;
    for (const std::string& name : r.parts) {
      const auto part = box_of(w, w.regions.at(name));
      if (!part && unite) return std::nullopt;
      if (!part) continue;
      if (!whole) whole = part;
      const auto& [lo, hi] = *part;
      if (unite) whole = {whole->at(0).cwiseMin(lo), whole->at(1).cwiseMax(hi)};
      else whole = {whole->at(0).cwiseMax(lo), whole->at(1).cwiseMin(hi)};
    }
    return whole;
  }
  const Region& s = r.shape;
  Vec3 a = s.lo, b = s.hi;
  if (s.shape == Shape::sphere) a = s.center.array() - s.radius, b = s.center.array() + s.radius;
  if (s.shape == Shape::cylinder || s.shape == Shape::cone) {
    const double radius = s.shape == Shape::cone ? std::max(s.radius_lo, s.radius_hi) : s.radius;
    a = s.center.array() - radius, b = s.center.array() + radius;
    a[s.axis] = s.axial_lo, b[s.axis] = s.axial_hi;
  }
  return std::array{a, b};
}

void create_random(Interpreter& in, int type) {
  in.wants(6, "create_atoms TYPE random N SEED REGION");
  World& w = in.world;
  const long long n = in.integer(3, 0, static_cast<long long>(most_atoms)), seed = in.integer(4, 1, 2147483646);
  const bool region = in.word(5) != "NULL";
  Vec3 lo, hi;
  for (int c = 0; c < 3; ++c) lo[c] = w.side(c, 0), hi[c] = w.side(c, 1);
  if (region) {
    w.matches(in.word(5), lo, 5);
    if (const auto box = box_of(w, w.regions.at(in.word(5)))) lo = lo.cwiseMax(box->at(0)), hi = hi.cwiseMin(box->at(1));
  }
  if (in.size() > 6) throw Wrong(6, in_quotes(in.word(6)) + " is no keyword of create_atoms that is taken", true);
  ParkMiller random(seed);
  random.throw_away(30);
  long long tries = 100 * n + 100000;
  for (long long k = 0; k < n; ++k) {
    Vec3 x;
    do {
      if (--tries < 0) throw Wrong(5, "the region has next to no room in the box");
      for (int c = 0; c < 3; ++c) x[c] = lo[c] + random.next() * (hi[c] - lo[c]);
      if (w.dimension == 2) x[2] = lo[2] + 0.5 * (hi[2] - lo[2]);
    } while (region && !w.matches(in.word(5), x, 5));
    if (w.atoms.size() >= most_atoms) throw Wrong(3, fmt::format("makes more than {} atoms", most_atoms));
    if (w.in_box(x)) w.create(type, x);
  }
}

/// Velocities that are given behind a run: a motion goes on with those that it has.
void moving(Interpreter& in) {
  if (in.world.run_number() > 0) in.not_in_motion();
}

/// The number of one atom: a number, or v_name of style equal or atom.
Value each_value(const Interpreter& in, std::size_t i) {
  if (i < in.size() && in.word(i).starts_with("v_")) {
    const auto found = in.names.variables.find(in.word(i).substr(2));
    const bool each = found != in.names.variables.end() && found->second.style == Variable::Style::atom;
    return evaluate(in.word(i), in.world, in.names, i, each);
  }
  return {in.number(i), {}};
}

}  // namespace

}  // namespace elamin::script::command

namespace elamin::script {

void needs_box(const Interpreter& in) {
  if (!in.world.has_box) throw Wrong(0, "stands before create_box or read_data");
}

void newborn(const World& w, const Atom& a) {
  w.at(a);
  if (a.born < w.run_number()) throw Wrong(0, "displaces atoms that were there in an earlier run; they go on from where they are", true);
}

std::vector<int> chosen(Interpreter& in, const std::string& style, std::size_t i) {
  World& w = in.world;
  std::vector<int> list;
  const auto take = [&](const auto& wanted) {
    for (std::size_t k = 0; k < w.atoms.size(); ++k)
      if (World::there(w.atoms[k]) && wanted(w.atoms[k])) list.push_back(static_cast<int>(k));
  };
  if (style == "atom") {
    if (i < in.size() && in.word(i).find('*') == std::string::npos) return {w.with_id(in.integer(i, 1, largest_id), i)};
    const auto r = in.range(i, largest_id);
    for (int id = r[0]; id <= r[1] && id < static_cast<int>(w.of_id.size()); ++id)
      if (const int k = w.of_id[id]; k >= 0) list.push_back(k);
  } else if (style == "type") {
    const auto r = in.range(i, w.atom_types);
    take([&](const Atom& a) { return r[0] <= a.type && a.type <= r[1]; });
  } else if (style == "mol") {
    const auto r = in.range(i, largest_id);
    take([&](const Atom& a) { return r[0] <= a.molecule && a.molecule <= r[1]; });
  } else if (style == "group") {
    const int g = w.group(in.word(i), i);
    take([&](const Atom& a) { return w.in(a, g); });
  } else if (style == "region") {
    take([&](const Atom& a) { return w.matches(in.word(i), w.at(a), i); });
  } else
    throw Wrong(1, in_quotes(style) + " is no way of choosing atoms; atom, type, mol, group and region are");
  return list;
}

}  // namespace elamin::script

namespace elamin::script::command {

void create_atoms(Interpreter& in) {
  in.wants(3, "create_atoms TYPE single X Y Z, or random N SEED REGION");
  needs_box(in);
  World& w = in.world;
  const int type = static_cast<int>(in.integer(1, 1, w.atom_types));
  if (in.word(2) == "random") return create_random(in, type);
  if (in.word(2) != "single")
    throw Wrong(2, in_quotes(in.word(2)) + " of a lattice is not made; write atoms one by one (single), or let LAMMPS write a data file "
                                           "(write_data FILE)", true);
  Vec3 x(in.value(3), in.value(4), in.value(5));
  bool box = false;
  for (std::size_t i = 6; i < in.size(); ++i)
    if (in.word(i) == "units" && i + 1 < in.size() && (in.word(i + 1) == "box" || in.word(i + 1) == "lattice")) box = in.word(++i) == "box";
    else throw Wrong(i, in_quotes(in.word(i)) + " is no keyword of create_atoms that is taken; units is", true);
  if (!box) x *= w.lattice;
  if (!w.in_box(x)) {
    in.note("lies outside of the box: LAMMPS makes no atom there, and none is made here");
    return;
  }
  if (w.atoms.size() >= most_atoms) throw Wrong(0, fmt::format("makes more than {} atoms", most_atoms));
  w.create(type, x);
  const std::string& file = in.reading.files[in.where.file];
  if (const std::size_t at = file.rfind("sheet_"); at != std::string::npos && file.find('/', at) == std::string::npos)
    w.sheets[file].push_back(static_cast<int>(w.atoms.size()) - 1);
}

namespace {

/// Pairs that the bonds there are keep out of neighbour lists: within one, two and three bonds, as special_bonds says.
std::set<std::pair<int, int>> left_out(const World& w, const std::vector<int>& among) {
  std::set<std::pair<int, int>> pairs;
  int deepest = 0;
  for (int k = 0; k < 3; ++k)
    if (w.special_lj[k] == 0 && w.special_coul[k] == 0) deepest = k + 1;
  if (deepest == 0 || w.bonds.empty() || among.empty()) return pairs;
  std::vector<std::vector<int>> to(w.atoms.size());
  const auto matters = [&](const Glue<2>& b) {
    return deepest > 1 || std::binary_search(among.begin(), among.end(), b.atoms[0]) ||
           std::binary_search(among.begin(), among.end(), b.atoms[1]);
  };
  for (const auto& b : w.bonds)
    if (b.gone == always && matters(b))
      to[b.atoms[0]].push_back(b.atoms[1]), to[b.atoms[1]].push_back(b.atoms[0]);
  for (const int i : among) {
    std::vector<int> front{i}, all{i};
    for (int k = 0; k < deepest; ++k) {
      std::vector<int> after;
      for (const int f : front)
        for (const int t : to[f])
          if (!contains(all, t)) all.push_back(t), after.push_back(t);
      if (w.special_lj[k] == 0 && w.special_coul[k] == 0)
        for (const int a : after) pairs.insert({std::min(i, a), std::max(i, a)});
      front = std::move(after);
    }
  }
  return pairs;
}

/// Parts of two atoms, by their types from 1, in how far apart LAMMPS's neighbour lists hold them; none where that is not known.
std::vector<double> reach(const World& w) {
  const auto& styles = w.pairs.styles;
  const auto& said = w.pairs.coefficients;
  const bool grains = styles.size() == 1 && (styles[0].name == "granular" || styles[0].name == "gran/hertz/history") && styles[0].cutoff == 0 &&
                      std::none_of(said.begin(), said.end(), [](const PairCoefficient& c) { return c.text.find(" cutoff ") != std::string::npos; }) &&
                      std::none_of(w.fixes.begin(), w.fixes.end(), [](const Fix& f) { return f.style == "freeze"; });
  if (!grains) return {};
  std::vector<double> part(static_cast<std::size_t>(w.atom_types) + 1, w.skin / 2);
  for (const Atom& a : w.atoms)
    if (World::there(a)) part[a.type] = std::max(part[a.type], (a.diameter + w.skin) / 2);
  return part;
}

void many(Interpreter& in) {
  in.wants(7, "create_bonds many GROUP GROUP TYPE RMIN RMAX");
  World& w = in.world;
  const int first = w.group(in.word(2), 2), second = w.group(in.word(3), 3);
  const int type = static_cast<int>(in.integer(4, 1, w.bond_types));
  const double least = in.number(5), most = in.number(6);
  if (least < 0 || !(most > least)) throw Wrong(5, "two rising distances are wanted, from 0 on");
  std::vector<int> touched;
  std::vector<std::pair<int, int>> wanted;
  std::vector<double> parts = reach(w);
  if (!parts.empty() && most > 2 * *std::max_element(parts.begin(), parts.end())) parts.clear();       // where LAMMPS stops
  int beyond = 0;
  const auto near = [&](int i, int j) {
    const Atom &a = w.atoms[i], &b = w.atoms[j];
    const Vec3 d = w.at(a) - w.at(b);
    const double rsq = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (rsq < least * least || rsq > most * most) return;
    if (!parts.empty() && rsq > std::pow(parts[a.type] + parts[b.type], 2)) return void(++beyond);
    wanted.push_back({i, j}), touched.push_back(i);
  };
  std::vector<int> among, of_first, of_second;
  for (std::size_t k = 0; k < w.atoms.size(); ++k) {
    if (!World::there(w.atoms[k])) continue;
    const bool a = w.in(w.atoms[k], first), b = w.in(w.atoms[k], second);
    if (a) of_first.push_back(static_cast<int>(k));
    if (b) of_second.push_back(static_cast<int>(k));
    if (a || b) among.push_back(static_cast<int>(k));
  }
  if (of_first.size() == 1 || of_second.size() == 1) {           // one atom with all others
    const int one = of_first.size() == 1 ? of_first[0] : of_second[0];
    for (const int other : of_first.size() == 1 ? of_second : of_first)
      if (other != one) near(one, other);
  } else {
    Field x(3, static_cast<Eigen::Index>(among.size()));
    for (std::size_t k = 0; k < among.size(); ++k) x.col(static_cast<Eigen::Index>(k)) = w.at(w.atoms[among[k]]);
    const auto atom = [&](int k) -> const Atom& { return w.atoms[among[k]]; };
    for (const IndexPair& p : near_pairs(x, std::vector<double>(among.size(), most / 2 * (1 + 1e-9)), [&](int i, int j) {
           const Atom &a = atom(i), &b = atom(j);
           return (w.in(a, first) && w.in(b, second)) || (w.in(a, second) && w.in(b, first));
         }))
      near(among[p.first], among[p.second]);
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  const auto out = left_out(w, touched);
  int made = 0;
  for (const auto& [i, j] : wanted)
    if (!out.count({std::min(i, j), std::max(i, j)})) w.new_glue({i, j}), w.bonds.push_back({type, {i, j}, w.run_number()}), ++made;
  if (beyond > 0)
    in.note(fmt::format("makes no bond between {} pairs that are farther apart than LAMMPS's neighbour lists reach, the largest radii of "
                        "their types and the skin {}; `neighbor` widens that", beyond, w.skin));
  if (made == 0) in.note("makes no bond");
  w.shrink_box();
}

}  // namespace

void create_bonds(Interpreter& in) {
  in.wants(3, "create_bonds single/bond TYPE I J, single/angle TYPE I J K, or many GROUP GROUP TYPE RMIN RMAX");
  needs_box(in);
  World& w = in.world;
  const std::string& style = in.word(1);
  std::size_t end = 7;
  if (!w.molecular) throw Wrong(0, fmt::format("atom style {} has no bonds", w.atom_style));
  if (style == "many") many(in);
  else if (style == "single/bond") {
    in.wants(5, "create_bonds single/bond TYPE I J");
    const int type = static_cast<int>(in.integer(2, 1, w.bond_types));
    const int i = w.with_id(in.integer(3, 1, largest_id), 3), j = w.with_id(in.integer(4, 1, largest_id), 4);
    if (i == j) throw Wrong(4, "an atom is bonded to itself");
    w.new_glue({i, j});
    w.bonds.push_back({type, {i, j}, w.run_number()});
    end = 5;
  } else if (style == "single/angle") {
    in.wants(6, "create_bonds single/angle TYPE I J K");
    const int type = static_cast<int>(in.integer(2, 1, w.angle_types));
    const int i = w.with_id(in.integer(3, 1, largest_id), 3), j = w.with_id(in.integer(4, 1, largest_id), 4),
              k = w.with_id(in.integer(5, 1, largest_id), 5);
    if (i == j || j == k || i == k) throw Wrong(3, "an angle has one atom twice");
    w.new_glue({i, j, k});
    w.angles.push_back({type, {i, j, k}, w.run_number()});
    end = 6;
  } else throw Wrong(1, in_quotes(style) + " is not made here; many, single/bond and single/angle are", true);
  if (in.size() > end) {
    if (in.word(end) != "special" || in.size() != end + 2)
      throw Wrong(end, in_quotes(in.word(end)) + " is no keyword of create_bonds; special is");
    w.unspecial = !in.yes(end + 1);
  } else w.unspecial = false;
}

void set(Interpreter& in) {
  in.wants(5, "set STYLE ID KEYWORD VALUE …");
  needs_box(in);
  World& w = in.world;
  const std::vector<int> list = chosen(in, in.word(1), 2);
  for (std::size_t i = 3; i < in.size();) {
    const std::string& k = in.word(i);
    if (i + 1 >= in.size()) throw Wrong(i, in_quotes(k) + " is followed by nothing");
    const auto each = [&](const auto& put) {
      const Value v = each_value(in, i + 1);
      for (const int a : list) {
        const double x = v.at(a);
        if (!std::isfinite(x)) throw Wrong(i + 1, "is not finite");
        put(w.atoms[a], x);
      }
      i += 2;
    };
    const auto negative = [&] { throw Wrong(i + 1, "is negative; 0 or more is taken"); };
    if (k == "type") each([&](Atom& a, double v) {
      if (v != std::floor(v) || v < 1 || v > w.atom_types) throw Wrong(i + 1, fmt::format("is no type; 1 to {} is allowed", w.atom_types));
      w.change(a, a.type != static_cast<int>(v));
      a.type = static_cast<int>(v);
    });
    else if (k == "mol") each([&](Atom& a, double v) {
      if (v < 0 || v > largest_id) throw Wrong(i + 1, "is no number of a molecule");
      a.molecule = static_cast<int>(v);
    });
    else if (k == "x" || k == "y" || k == "z") each([&](Atom& a, double v) {
      newborn(w, a);
      a.x[k[0] - 'x'] = v;
    });
    else if (k == "vx" || k == "vy" || k == "vz") {
      moving(in);
      each([&](Atom& a, double v) { a.v[k[1] - 'x'] = v; });
    }
    else if (k == "diameter" || k == "density") {
      if (!w.sphere) throw Wrong(i, fmt::format("atom style {} has no {}", w.atom_style, k));
      if (k == "density") each([&](Atom& a, double v) {
        if (v < 0) negative();
        w.change(a, a.density != v);
        a.density = v;
      });
      else each([&](Atom& a, double v) {         // LAMMPS keeps the mass
        if (v < 0) negative();
        w.change(a, a.diameter != v);
        if (v > 0 && a.diameter > 0) a.density *= std::pow(a.diameter / v, 3);
        a.diameter = v;
      });
    } else if (k == "mass") {
      if (!w.sphere) throw Wrong(i, "the mass of such atoms is of their type; `mass` sets it");
      each([&](Atom& a, double v) {
        if (v < 0) negative();
        const double density = a.diameter > 0 ? v / (pi / 6 * a.diameter * a.diameter * a.diameter) : v;
        w.change(a, a.density != density);
        a.density = density;
      });
    } else if (k == "bond" || k == "angle") {
      const int t = static_cast<int>(in.integer(i + 1, 1, k == "bond" ? w.bond_types : w.angle_types));
      std::vector<bool> in_list(w.atoms.size());
      for (const int a : list) in_list[a] = true;
      const auto change = [&](auto& glue) {
        for (auto& g : glue)
          if (g.gone == always && std::all_of(g.atoms.begin(), g.atoms.end(), [&](int a) { return in_list[a]; })) {
            if (g.born < w.run_number()) throw Wrong(i, "changes glue that was there in an earlier run; glue keeps its kind", true);
            g.type = t;
          }
      };
      if (k == "bond") change(w.bonds);
      else change(w.angles);
      i += 2;
    } else if (k == "charge") i += 2;
    else if (k == "image") i += 4;
    else if (k == "angmom") i += 4;
    else if (k == "omega") {
      moving(in);
      for (int c = 0; c < 3; ++c, ++i) {
        const Value v = each_value(in, i + 1);
        for (const int a : list) w.atoms[a].omega[c] = v.at(a);
      }
      ++i;
    }
    else
      throw Wrong(i, in_quotes(k) + " is nothing that is set here; type, mol, x, y, z, diameter, density, mass, vx, vy, vz, bond and angle "
                                    "are", true);
  }
}

void velocity(Interpreter& in) {
  in.wants(3, "velocity GROUP set VX VY VZ");
  World& w = in.world;
  const int g = w.group(in.word(1), 1);
  if (in.word(2) == "create" || in.word(2) == "scale" || in.word(2) == "ramp" || in.word(2) == "zero")
    return in.not_in_motion(), in.ignore("velocities at the start matter in motion only");
  if (in.word(2) != "set") throw Wrong(2, in_quotes(in.word(2)) + " is no way of setting velocities; set is", true);
  in.wants(6, "velocity GROUP set VX VY VZ");
  moving(in);
  const double unit = in.unit_of_length(6);
  bool sum = false;
  for (std::size_t i = 6; i + 1 < in.size(); i += 2)
    if (in.word(i) == "sum") sum = in.yes(i + 1);
  for (int c = 0; c < 3; ++c) {
    if (in.word(3 + c) == "NULL") continue;
    const Value v = each_value(in, 3 + c);
    for (std::size_t k = 0; k < w.atoms.size(); ++k)
      if (World::there(w.atoms[k]) && w.in(w.atoms[k], g)) w.atoms[k].v[c] = unit * v.at(k) + (sum ? w.atoms[k].v[c] : 0);
  }
}

void displace_atoms(Interpreter& in) {
  in.wants(6, "displace_atoms GROUP move DX DY DZ, ramp C LO HI C LO HI, rotate PX PY PZ RX RY RZ DEGREES, or random DX DY DZ SEED");
  World& w = in.world;
  const int g = w.group(in.word(1), 1);
  const std::string& how = in.word(2);
  if (how != "move" && how != "ramp" && how != "rotate" && how != "random")
    throw Wrong(2, in_quotes(how) + " is no displacement; move, ramp, rotate and random are");
  const double unit = in.unit_of_length(6);
  const auto each = [&](const auto& to) {
    for (std::size_t k = 0; k < w.atoms.size(); ++k) {
      Atom& a = w.atoms[k];
      if (World::there(a) && w.in(a, g)) newborn(w, a), a.x = to(k, a.x);
    }
  };
  if (how == "move") {
    const std::array<Value, 3> d{each_value(in, 3), each_value(in, 4), each_value(in, 5)};
    each([&](std::size_t k, const Vec3& x) { return Vec3(x + unit * Vec3(d[0].at(k), d[1].at(k), d[2].at(k))); });
  } else if (how == "ramp") {
    in.wants(9, "displace_atoms GROUP ramp C LO HI C LO HI");
    const int c = in.axis(3), along = in.axis(6);
    const double least = unit * in.number(4), most = unit * in.number(5), lo = unit * in.number(7), hi = unit * in.number(8);
    if (lo == hi) throw Wrong(8, "the ramp has no length");
    each([&](std::size_t, Vec3 x) {
      x[c] += least + std::clamp((x[along] - lo) / (hi - lo), 0.0, 1.0) * (most - least);
      return x;
    });
  } else if (how == "random") {
    in.wants(7, "displace_atoms GROUP random DX DY DZ SEED");
    const Vec3 most = unit * Vec3(in.number(3), in.number(4), in.number(5));
    const auto seed = static_cast<int>(in.integer(6, 1, 2147483646));
    each([&](std::size_t, Vec3 x) {
      ParkMiller random(seed, x);
      for (int c = 0; c < 3; ++c) x[c] += most[c] * 2 * (random.next() - 0.5);
      return x;
    });
  } else {
    in.wants(10, "displace_atoms GROUP rotate PX PY PZ RX RY RZ DEGREES");
    const Vec3 point = unit * Vec3(in.number(3), in.number(4), in.number(5)), axis(in.number(6), in.number(7), in.number(8));
    if (!(axis.norm() > 0)) throw Wrong(6, "the axis has no length");
    const Vec3 e = axis / axis.norm();
    const double angle = pi * in.number(9) / 180;
    each([&](std::size_t, const Vec3& x) {
      const Vec3 d = x - point, along = d.dot(e) * e, across = d - along;
      return Vec3(point + along + std::cos(angle) * across + std::sin(angle) * e.cross(across));
    });
  }
  w.shrink_box();
}

void compute(Interpreter& in) {
  in.wants(4, "compute ID GROUP STYLE …");
  Compute c;
  c.style = in.word(3), c.group = in.word(2);
  in.world.group(c.group, 2);
  if (c.style != "reduce") in.ignore(because::output);
  else {
    in.wants(6, "compute ID GROUP reduce MODE INPUT …");
    c.mode = in.word(4);
    for (std::size_t i = 5; i < in.size() && in.word(i) != "replace"; ++i) c.inputs.push_back(in.word(i));
    static const std::vector<std::string> modes{"min", "max", "sum", "ave", "sumsq", "avesq"};
    if (!contains(modes, c.mode))
      throw Wrong(4, in_quotes(c.mode) + " is no mode of reduce; there are: " + listed(modes));
  }
  in.names.computes[in.word(1)] = std::move(c);
}

void uncompute(Interpreter& in) {
  in.wants(2, "uncompute ID", 2);
  if (!in.names.computes.erase(in.word(1))) throw Wrong(1, in_quotes(in.word(1)) + " is no compute");
}

}  // namespace elamin::script::command
