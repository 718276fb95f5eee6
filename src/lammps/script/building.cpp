// Commands that make, change and remove particles and what glues them.
#include "lammps/script/interpreter.hpp"

#include "core/near_pairs.hpp"
#include "core/suggest.hpp"
#include "core/text.hpp"
#include "lammps/data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace elamin::script::command {
namespace {

constexpr std::size_t most_atoms = 10000000;
constexpr int largest_id = 1000000000;


void needs_box(const Interpreter& in) {
  if (!in.world.has_box) throw Wrong(0, "stands before create_box or read_data");
}

bool in_box(const World& w, const Vec3& x) { return (x.array() >= w.lo.array()).all() && (x.array() < w.hi.array()).all(); }

/// Numbers from 0 to 1 as LAMMPS draws them here: x ← 16807 x mod (2³¹ − 1). Source: Park & Miller 1988, Comm. ACM 31, 1192.
class Random {
 public:
  explicit Random(long long seed) : seed_(seed) {
    for (int k = 0; k < 30; ++k) next();         // that LAMMPS throws away
  }
  double next() {
    seed_ = 16807 * seed_ % 2147483647;
    return static_cast<double>(seed_) * (1.0 / 2147483647);
  }

 private:
  long long seed_;
};

/// A box around a region, as far as there is one.
void clip(const ScriptRegion& r, Vec3& lo, Vec3& hi) {
  if (r.kind != ScriptRegion::Kind::shape || !r.inside || r.shape.shape == Shape::plane) return;
  const Region& s = r.shape;
  Vec3 a = s.lo, b = s.hi;
  if (s.shape == Shape::sphere) a = s.center.array() - s.radius, b = s.center.array() + s.radius;
  if (s.shape == Shape::cylinder || s.shape == Shape::cone) {
    const double radius = s.shape == Shape::cone ? std::max(s.radius_lo, s.radius_hi) : s.radius;
    a = s.center.array() - radius, b = s.center.array() + radius;
    a[s.axis] = s.axial_lo, b[s.axis] = s.axial_hi;
  }
  lo = lo.cwiseMax(a), hi = hi.cwiseMin(b);
}

void create_random(Interpreter& in, int type) {
  in.wants(6, "create_atoms TYPE random N SEED REGION");
  World& w = in.world;
  const long long n = in.integer(3, 0, static_cast<long long>(most_atoms)), seed = in.integer(4, 1, 2147483646);
  const bool region = in.word(5) != "NULL";
  Vec3 lo = w.lo, hi = w.hi;
  if (region) {
    w.matches(in.word(5), lo, 5);
    clip(w.regions.at(in.word(5)), lo, hi);
  }
  if (in.size() > 6) throw Wrong(6, in_quotes(in.word(6)) + " is no keyword of create_atoms that is taken", true);
  Random random(seed);
  long long tries = 100 * n + 100000;
  for (long long k = 0; k < n; ++k) {
    Vec3 x;
    do {
      if (--tries < 0) throw Wrong(5, "the region has next to no room in the box");
      for (int c = 0; c < 3; ++c) x[c] = lo[c] + random.next() * (hi[c] - lo[c]);
      if (w.dimension == 2) x[2] = lo[2] + 0.5 * (hi[2] - lo[2]);
    } while (region && !w.matches(in.word(5), x, 5));
    if (w.atoms.size() >= most_atoms) throw Wrong(3, fmt::format("makes more than {} atoms", most_atoms));
    if (in_box(w, x)) w.create(type, x);
  }
}

/// A range of atoms as `set` and `group` have them.
std::vector<int> chosen(Interpreter& in, const std::string& style, std::size_t i) {
  World& w = in.world;
  std::vector<int> list;
  const auto take = [&](const auto& wanted) {
    for (std::size_t k = 0; k < w.atoms.size(); ++k)
      if (World::there(w.atoms[k]) && wanted(w.atoms[k])) list.push_back(static_cast<int>(k));
  };
  if (style == "atom") {
    if (i < in.size() && in.word(i).find('*') == std::string::npos) return {w.with_id(in.integer(i, 1, largest_id), i)};
    const auto r = in.range(i, static_cast<int>(std::max<std::size_t>(w.of_id.size(), 2)) - 1);
    for (int id = r[0]; id <= r[1]; ++id)
      if (const int k = w.of_id[static_cast<std::size_t>(id)]; k >= 0) list.push_back(k);
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

void create_atoms(Interpreter& in) {
  in.wants(3, "create_atoms TYPE single X Y Z, or random N SEED REGION");
  needs_box(in);
  World& w = in.world;
  const int type = static_cast<int>(in.integer(1, 1, w.atom_types));
  if (in.word(2) == "random") return create_random(in, type);
  if (in.word(2) != "single")
    throw Wrong(2,
                in_quotes(in.word(2)) +
                    " of a lattice is not made; write atoms one by one (single), or let LAMMPS write a data file (write_data FILE)",
                true);
  Vec3 x(in.value(3), in.value(4), in.value(5));
  bool box = false;
  for (std::size_t i = 6; i < in.size(); ++i)
    if (in.word(i) == "units" && i + 1 < in.size() && (in.word(i + 1) == "box" || in.word(i + 1) == "lattice")) box = in.word(++i) == "box";
    else throw Wrong(i, in_quotes(in.word(i)) + " is no keyword of create_atoms that is taken; units is", true);
  if (!box) x *= w.lattice;
  if (!in_box(w, x)) {
    in.note("lies outside of the box: LAMMPS makes no atom there, and none is made here");
    return;
  }
  if (w.atoms.size() >= most_atoms) throw Wrong(0, fmt::format("makes more than {} atoms", most_atoms));
  w.create(type, x);
  const std::string& file = in.reading.files[static_cast<std::size_t>(in.where.file)];
  if (const std::size_t at = file.rfind("sheet_"); at != std::string::npos && file.find('/', at) == std::string::npos)
    w.sheets[file].push_back(static_cast<int>(w.atoms.size()) - 1);
}

namespace {

/// Pairs that the bonds there are keep out of neighbour lists: within one, two and three bonds, as special_bonds says.
std::set<std::pair<int, int>> left_out(const World& w, const std::vector<int>& among) {
  std::set<std::pair<int, int>> pairs;
  int deepest = 0;
  for (int k = 0; k < 3; ++k)
    if (w.special_lj[static_cast<std::size_t>(k)] == 0 && w.special_coul[static_cast<std::size_t>(k)] == 0) deepest = k + 1;
  if (deepest == 0 || w.bonds.empty() || among.empty()) return pairs;
  std::vector<std::vector<int>> to(w.atoms.size());
  const auto matters = [&](const Glue<2>& b) {
    return deepest > 1 || std::binary_search(among.begin(), among.end(), b.atoms[0]) ||
           std::binary_search(among.begin(), among.end(), b.atoms[1]);
  };
  for (const auto& b : w.bonds)
    if (b.gone == always && matters(b))
      to[static_cast<std::size_t>(b.atoms[0])].push_back(b.atoms[1]), to[static_cast<std::size_t>(b.atoms[1])].push_back(b.atoms[0]);
  for (const int i : among) {
    std::vector<int> front{i}, all{i};
    for (int k = 0; k < deepest; ++k) {
      std::vector<int> after;
      for (const int f : front)
        for (const int t : to[static_cast<std::size_t>(f)])
          if (std::find(all.begin(), all.end(), t) == all.end()) all.push_back(t), after.push_back(t);
      const auto c = static_cast<std::size_t>(k);
      if (w.special_lj[c] == 0 && w.special_coul[c] == 0)
        for (const int a : after) pairs.insert({std::min(i, a), std::max(i, a)});
      front = std::move(after);
    }
  }
  return pairs;
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
  const auto near = [&](int i, int j) {
    const Vec3 d = w.at(w.atoms[static_cast<std::size_t>(i)]) - w.at(w.atoms[static_cast<std::size_t>(j)]);
    const double rsq = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (rsq < least * least || rsq > most * most) return;
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
    for (std::size_t k = 0; k < among.size(); ++k) x.col(static_cast<Eigen::Index>(k)) = w.at(w.atoms[static_cast<std::size_t>(among[k])]);
    const auto atom = [&](int k) -> const Atom& { return w.atoms[static_cast<std::size_t>(among[static_cast<std::size_t>(k)])]; };
    for (const IndexPair& p : near_pairs(x, std::vector<double>(among.size(), most / 2 * (1 + 1e-9)), [&](int i, int j) {
           const Atom &a = atom(i), &b = atom(j);
           return (w.in(a, first) && w.in(b, second)) || (w.in(a, second) && w.in(b, first));
         }))
      near(among[static_cast<std::size_t>(p.first)], among[static_cast<std::size_t>(p.second)]);
  }
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
  const auto out = left_out(w, touched);
  int made = 0;
  for (const auto& [i, j] : wanted)
    if (!out.count({std::min(i, j), std::max(i, j)})) w.new_glue({i, j}), w.bonds.push_back({type, {i, j}, w.run_number()}), ++made;
  if (made == 0) in.note("makes no bond");
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
        const double x = v.at(static_cast<std::size_t>(a));
        if (!std::isfinite(x)) throw Wrong(i + 1, "is not finite");
        put(w.atoms[static_cast<std::size_t>(a)], x);
      }
      i += 2;
    };
    const auto negative = [&] { throw Wrong(i + 1, "is negative; 0 or more is taken"); };
    if (k == "type") each([&](Atom& a, double v) {
      if (v != std::floor(v) || v < 1 || v > w.atom_types) throw Wrong(i + 1, fmt::format("is no type; 1 to {} is allowed", w.atom_types));
      a.type = static_cast<int>(v);
    });
    else if (k == "mol") each([&](Atom& a, double v) {
      if (v < 0 || v > largest_id) throw Wrong(i + 1, "is no number of a molecule");
      a.molecule = static_cast<int>(v);
    });
    else if (k == "x" || k == "y" || k == "z") each([&](Atom& a, double v) {
      w.at(a);
      a.x[k[0] - 'x'] = v;
    });
    else if (k == "vx" || k == "vy" || k == "vz") each([&](Atom& a, double v) { a.v[k[1] - 'x'] = v; });
    else if (k == "diameter" || k == "density") {
      if (!w.sphere) throw Wrong(i, fmt::format("atom style {} has no {}", w.atom_style, k));
      if (k == "density") each([&](Atom& a, double v) { v < 0 ? negative() : void(a.density = v); });
      else each([&](Atom& a, double v) {         // LAMMPS keeps the mass
        if (v < 0) negative();
        if (v > 0 && a.diameter > 0) a.density *= std::pow(a.diameter / v, 3);
        a.diameter = v;
      });
    } else if (k == "mass") {
      if (!w.sphere) throw Wrong(i, "the mass of such atoms is of their type; `mass` sets it");
      each([&](Atom& a, double v) {
        if (v < 0) negative();
        a.density = a.diameter > 0 ? v / (3.14159265358979323846 / 6 * a.diameter * a.diameter * a.diameter) : v;
      });
    } else if (k == "bond" || k == "angle") {
      const int t = static_cast<int>(in.integer(i + 1, 1, k == "bond" ? w.bond_types : w.angle_types));
      std::vector<bool> in_list(w.atoms.size());
      for (const int a : list) in_list[static_cast<std::size_t>(a)] = true;
      const auto change = [&](auto& glue) {
        for (auto& g : glue)
          if (g.gone == always &&
              std::all_of(g.atoms.begin(), g.atoms.end(), [&](int a) { return in_list[static_cast<std::size_t>(a)]; })) {
            if (g.born < w.run_number()) throw Wrong(i, "changes glue that was there in an earlier run; glue keeps its kind", true);
            g.type = t;
          }
      };
      if (k == "bond") change(w.bonds);
      else change(w.angles);
      i += 2;
    } else if (k == "charge") i += 2;
    else if (k == "image") i += 4;
    else if (k == "omega" || k == "angmom") i += 4;
    else
      throw Wrong(
          i, in_quotes(k) + " is nothing that is set here; type, mol, x, y, z, diameter, density, mass, vx, vy, vz, bond and angle are",
          true);
  }
}

namespace {

void mark(World& w, int bit, const auto& wanted) {
  for (Atom& a : w.atoms)
    if (World::there(a) && wanted(a)) a.groups |= 1u << bit;
}

/// Whether a number is chosen by `v`, `a:b`, `a:b:c`, or a comparison such as `<= 3` or `<> 2 5`.
void mark_numbers(Interpreter& in, int bit, const auto& number_of_atom) {
  World& w = in.world;
  static const std::vector<std::string> signs{"<", ">", "<=", ">=", "==", "!=", "<>"};
  if (in.size() > 4 && std::find(signs.begin(), signs.end(), in.word(3)) != signs.end()) {
    const std::string& s = in.word(3);
    const long long a = in.integer(4, 0, largest_id), b = s == "<>" ? in.integer(5, 0, largest_id) : 0;
    return mark(w, bit, [&](const Atom& atom) {
      const long long v = number_of_atom(atom);
      return s == "<"    ? v < a
             : s == ">"  ? v > a
             : s == "<=" ? v <= a
             : s == ">=" ? v >= a
             : s == "==" ? v == a
             : s == "!=" ? v != a
                         : v >= a && v <= b;
    });
  }
  std::set<long long> singles;
  for (std::size_t i = 3; i < in.size(); ++i) {
    const std::string& t = in.word(i);
    if (t.find(':') == std::string::npos) {
      singles.insert(in.integer(i, 0, largest_id));
      continue;
    }
    std::array<long long, 3> r{0, 0, 1};
    std::size_t n = 0;
    for (std::size_t begin = 0; begin <= t.size() && n < 4; ++n) {
      const std::size_t colon = std::min(t.find(':', begin), t.size());
      const std::string part = t.substr(begin, colon - begin);
      if (n == 3 || part.empty() || part.size() > 9 || part.find_first_not_of("0123456789") != std::string::npos)
        throw Wrong(i, in_quotes(t) + " is no range; a:b and a:b:step are");
      r[n] = std::stoll(part);
      begin = colon + 1;
    }
    if (r[2] < 1) throw Wrong(i, "the step of the range is not above 0");
    mark(w, bit, [&](const Atom& a) {
      const long long v = number_of_atom(a);
      return v >= r[0] && v <= r[1] && (v - r[0]) % r[2] == 0;
    });
  }
  if (!singles.empty()) mark(w, bit, [&](const Atom& a) { return singles.count(number_of_atom(a)) > 0; });
}

}  // namespace

void group(Interpreter& in) {
  in.wants(3, "group NAME STYLE …");
  needs_box(in);
  World& w = in.world;
  const std::string name = in.word(1), style = in.word(2);
  if (style == "delete" || style == "clear") {
    const int bit = w.group(name, 1);
    if (bit == 0) throw Wrong(1, "the group all stays as it is");
    if (style == "delete")
      for (const Fix& f : w.fixes)
        if (f.group == name) throw Wrong(1, fmt::format("is the group of the fix {}, which is in force", f.id));
    for (Atom& a : w.atoms) a.groups &= ~(1u << bit);
    if (style == "delete") w.groups[static_cast<std::size_t>(bit)].clear();
    return;
  }
  if (style == "dynamic") throw Wrong(2, "groups that change as things move are not followed", true);
  if (style == "static") return;
  if (name == "all") throw Wrong(1, "the group all stays as it is");
  static const std::vector<std::string> styles{"type",  "id",       "molecule",  "region",  "variable",
                                               "union", "subtract", "intersect", "include", "empty"};
  if (std::find(styles.begin(), styles.end(), style) == styles.end())
    throw Wrong(
        2, in_quotes(style) + " is no style of a group; there are: " + listed(styles) + ", clear, delete" + did_you_mean(style, styles),
        true);
  if (style != "empty") in.wants(4, "group NAME " + style + " …");
  // What it is made of comes first: a mistake leaves no half a group.
  std::vector<int> others;
  for (std::size_t i = 3; i < in.size() && (style == "union" || style == "subtract" || style == "intersect"); ++i)
    others.push_back(w.group(in.word(i), i));
  int bit = -1;
  if (const auto found = w.find_group(name)) bit = *found;
  else {
    const auto hole = std::find(w.groups.begin() + 1, w.groups.end(), "");
    bit = static_cast<int>(hole - w.groups.begin());
    if (bit >= 32) throw Wrong(1, "is the 33rd group; LAMMPS has 32 at most");
    if (hole == w.groups.end()) w.groups.push_back(name);
    else *hole = name;
  }
  if (style == "id" && in.size() == 4 && in.word(3).find(':') == std::string::npos) {
    const long long id = in.integer(3, 0, largest_id);
    if (id < static_cast<long long>(w.of_id.size()) && w.of_id[static_cast<std::size_t>(id)] >= 0)
      w.atoms[static_cast<std::size_t>(w.of_id[static_cast<std::size_t>(id)])].groups |= 1u << bit;
  } else if (style == "id") mark_numbers(in, bit, [](const Atom& a) { return static_cast<long long>(a.id); });
  else if (style == "type") mark_numbers(in, bit, [](const Atom& a) { return static_cast<long long>(a.type); });
  else if (style == "molecule") mark_numbers(in, bit, [](const Atom& a) { return static_cast<long long>(a.molecule); });
  else if (style == "region") mark(w, bit, [&](const Atom& a) { return w.matches(in.word(3), w.at(a), 3); });
  else if (style == "variable") {
    const Value v = evaluate("v_" + in.word(3), w, in.names, 3, true);
    for (std::size_t k = 0; k < w.atoms.size(); ++k)
      if (World::there(w.atoms[k]) && v.at(k) != 0) w.atoms[k].groups |= 1u << bit;
  } else if (style == "union")
    mark(w, bit, [&](const Atom& a) { return std::any_of(others.begin(), others.end(), [&](int g) { return w.in(a, g); }); });
  else if (style == "intersect")
    mark(w, bit, [&](const Atom& a) { return std::all_of(others.begin(), others.end(), [&](int g) { return w.in(a, g); }); });
  else if (style == "subtract")
    mark(w, bit, [&](const Atom& a) {
      return w.in(a, others[0]) && std::none_of(others.begin() + 1, others.end(), [&](int g) { return w.in(a, g); });
    });
  else if (style == "include") {
    if (in.word(3) != "molecule") throw Wrong(3, in_quotes(in.word(3)) + " is nothing that a group includes; molecule is");
    std::set<int> molecules;
    for (const Atom& a : w.atoms)
      if (World::there(a) && w.in(a, bit)) molecules.insert(a.molecule);
    mark(w, bit, [&](const Atom& a) { return molecules.count(a.molecule) > 0; });
  }
}

void delete_atoms(Interpreter& in) {
  in.wants(3, "delete_atoms group NAME, or region NAME");
  needs_box(in);
  World& w = in.world;
  if (in.word(1) != "group" && in.word(1) != "region")
    throw Wrong(1, in_quotes(in.word(1)) + " is no way of choosing atoms that is taken; group and region are", true);
  std::vector<bool> gone(w.atoms.size());
  std::size_t count = 0;
  for (const int a : chosen(in, in.word(1), 2)) gone[static_cast<std::size_t>(a)] = true, ++count;
  bool compress = true;
  for (std::size_t i = 3; i < in.size(); i += 2)
    if (in.word(i) == "compress") compress = in.yes(i + 1);
    else if (in.word(i) == "bond" || in.word(i) == "mol") in.yes(i + 1);
    else throw Wrong(i, in_quotes(in.word(i)) + " is no keyword of delete_atoms");
  const auto there = static_cast<std::size_t>(std::count_if(w.atoms.begin(), w.atoms.end(), World::there));
  if (count == there && count > 0) {             // nothing is left: what comes is another problem
    in.end_pass();
    w.atoms.clear(), w.of_id.clear(), w.bonds.clear(), w.angles.clear(), w.runs.clear(), w.still.reset(), w.sheets.clear(), w.removals.clear();
    w.body_file.clear();
    return;
  }
  w.remove(gone);
  if (compress && !w.molecular && count > 0)
    in.note("LAMMPS numbers the atoms that are left anew (compress yes); here they keep their ids");
}

void delete_bonds(Interpreter& in) {
  in.wants(3, "delete_bonds GROUP multi, or GROUP bond TYPE, or GROUP angle TYPE");
  needs_box(in);
  World& w = in.world;
  const int g = w.group(in.word(1), 1);
  const std::string& style = in.word(2);
  std::size_t i = 3;
  std::array<int, 2> types{1, always - 1};
  if (style == "bond" || style == "angle") types = in.range(i++, style == "bond" ? w.bond_types : w.angle_types);
  else if (style == "stats") return in.ignore("output: a run of elamin writes its own");
  else if (style != "multi")
    throw Wrong(2, in_quotes(style) + " is no way of choosing glue that is taken; multi, bond and angle are", true);
  bool any = false, special = false;
  for (; i < in.size(); ++i)
    if (in.word(i) == "any") any = true;
    else if (in.word(i) == "special") special = true;
    else if (in.word(i) != "remove")
      throw Wrong(i, in_quotes(in.word(i)) + " is no keyword of delete_bonds that is taken; any, remove and special are", true);
  const auto inside = [&](int a) { return w.in(w.atoms[static_cast<std::size_t>(a)], g); };
  const auto meant = [&](const auto& glue) {
    return glue.gone == always && types[0] <= glue.type && glue.type <= types[1] &&
           (any ? std::any_of(glue.atoms.begin(), glue.atoms.end(), inside) : std::all_of(glue.atoms.begin(), glue.atoms.end(), inside));
  };
  if (!w.runs.empty()) {                         // as a [[remove]]: all glue within the group, bonds with the angles over them
    Removal r{w.run_number(), style == "angle", {}, in.word(1), in.text(), in.where};
    const auto over_bond = [&](const Glue<3>& a) {
      return (inside(a.atoms[0]) && inside(a.atoms[1])) || (inside(a.atoms[1]) && inside(a.atoms[2]));
    };
    for (const auto& b : w.bonds)
      if (b.gone == always && meant(b) != (style != "angle" && inside(b.atoms[0]) && inside(b.atoms[1]))) throw NeedsPositions{w.last_run};
    for (const auto& a : w.angles)
      if (a.gone == always &&
          (style != "bond" && meant(a)) != (r.angles ? inside(a.atoms[0]) && inside(a.atoms[1]) && inside(a.atoms[2]) : over_bond(a)))
        throw NeedsPositions{w.last_run};
    for (std::size_t k = 0; k < w.atoms.size(); ++k)
      if (World::there(w.atoms[k]) && inside(static_cast<int>(k))) r.members.push_back(static_cast<int>(k));
    w.removals.push_back(std::move(r));
  }
  const auto end = [&](auto& list) {
    for (auto& glue : list)
      if (meant(glue)) glue.gone = w.run_number();
  };
  if (style != "angle") end(w.bonds);
  if (style != "bond") end(w.angles);
  if (!special && style != "angle")
    in.note("without `special` LAMMPS leaves pairs that were bonded out of contacts; here they touch as all others");
}

namespace {

/// What the header of a data file says and LammpsData does not keep.
struct Header {
  Vec3 lo = Vec3::Constant(-0.5), hi = Vec3::Constant(0.5);
  int atom_types = 0, bond_types = 0, angle_types = 0;
};

Header header_of(const std::string& file) {
  Header h;
  const std::string text = elamin::read_data(file, "LAMMPS data file");
  int lines = 0;
  for (std::size_t begin = 0; begin < text.size() && lines < 100; ++lines) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::vector<Word> words;
    try {
      words = split(without_comment(std::string_view(text).substr(begin, end - begin)));
    } catch (const Wrong&) {                      // a title with a quote
    }
    begin = end + 1;
    const auto number = [&](std::size_t i) { return std::strtod(words[i].text.c_str(), nullptr); };
    for (int c = 0; c < 3; ++c)
      if (words.size() == 4 && words[2].text == std::string(1, static_cast<char>('x' + c)) + "lo") h.lo[c] = number(0), h.hi[c] = number(1);
    if (words.size() != 3 || words[2].text != "types") continue;
    const int n = static_cast<int>(std::clamp(number(0), 0.0, 1e6));
    if (words[1].text == "atom") h.atom_types = n;
    if (words[1].text == "bond") h.bond_types = n;
    if (words[1].text == "angle") h.angle_types = n;
  }
  return h;
}

bool six_digits(double v) { return std::strtod(fmt::format("{:.6g}", v).c_str(), nullptr) == v; }

}  // namespace

void read_data(Interpreter& in) {
  in.wants(2, "read_data FILE …");
  namespace fs = std::filesystem;
  World& w = in.world;
  const fs::path root = fs::path(in.reading.files.front()).parent_path();
  const std::string file = (fs::path(in.word(1)).is_absolute() ? fs::path(in.word(1)) : root / in.word(1)).string();
  bool add = false;
  int group_bit = -1;
  Vec3 shift = Vec3::Zero();
  std::array<int, 3> offset{}, extra{};
  std::string group_name;
  for (std::size_t i = 2; i < in.size();) {
    const std::string& k = in.word(i);
    if (i + 1 >= in.size() && k != "nocoeff") throw Wrong(i, in_quotes(k) + " is followed by nothing");
    if (k == "add") {
      if (in.word(i + 1) != "append") throw Wrong(i + 1, "append is taken", true);
      add = true, i += 2;
    } else if (k == "offset" && i + 5 < in.size()) {
      for (std::size_t c = 0; c < 3; ++c) offset[c] = static_cast<int>(in.integer(i + 1 + c, 0, most_atoms));
      i += 6;
    } else if (k == "shift" && i + 3 < in.size()) shift = Vec3(in.number(i + 1), in.number(i + 2), in.number(i + 3)), i += 4;
    else if (k == "group") group_name = in.word(i + 1), i += 2;
    else if (k == "nocoeff") ++i;
    else if (k.starts_with("extra/")) {
      const int n = static_cast<int>(in.integer(i + 1, 0, 1000000));
      if (k == "extra/atom/types") extra[0] = n;
      if (k == "extra/bond/types") extra[1] = n;
      if (k == "extra/angle/types") extra[2] = n;
      i += 2;
    } else
      throw Wrong(i, in_quotes(k) + " is no keyword of read_data that is taken; add append, offset, shift, group, nocoeff and extra/… are",
                  true);
  }
  if (w.has_box && !add) throw Wrong(0, "there is a box already; `add append` adds to it");
  const LammpsData data = read_lammps_data(file, w.atom_style);
  const Header header = header_of(file);
  in.reading.data_files.push_back(file);
  if (!w.has_box) w.lo = header.lo + shift, w.hi = header.hi + shift, w.has_box = true;
  int largest = 0;
  for (const int t : data.type) largest = std::max(largest, t);
  for (const Body& b : data.bodies) largest = std::max(largest, b.type);
  const auto grow = [](int& now, int by, int extra_types) { now = std::max(now, by) + extra_types; };
  grow(w.atom_types, std::max(largest, header.atom_types) + offset[0], extra[0]);
  grow(w.bond_types, std::max(static_cast<int>(data.bond_types.size()), header.bond_types) + offset[1], extra[1]);
  grow(w.angle_types, std::max(static_cast<int>(data.angle_types.size()), header.angle_types) + offset[2], extra[2]);
  w.mass.resize(static_cast<std::size_t>(w.atom_types));
  w.bond_coefficients.resize(static_cast<std::size_t>(w.bond_types)), w.angle_coefficients.resize(static_cast<std::size_t>(w.angle_types));
  bool short_numbers = !data.bond_types.empty() || !data.angle_types.empty();
  for (std::size_t t = 0; t < data.bond_types.size(); ++t) {
    w.bond_coefficients[t + static_cast<std::size_t>(offset[1])] = {data.bond_types[t].stiffness, data.bond_types[t].rest_length, true};
    short_numbers = short_numbers && six_digits(data.bond_types[t].stiffness) && six_digits(data.bond_types[t].rest_length);
  }
  for (std::size_t t = 0; t < data.angle_types.size(); ++t) {
    w.angle_coefficients[t + static_cast<std::size_t>(offset[2])] = {data.angle_types[t].stiffness, data.angle_types[t].rest, true};
    short_numbers = short_numbers && six_digits(data.angle_types[t].stiffness);
  }
  if (short_numbers)
    in.note(
        "the coefficients in this data file have six digits, as write_data writes them: loads at which things buckle may be off by 0.3 %; "
        "bond_coeff and angle_coeff behind read_data give all digits");
  if (!group_name.empty()) {
    const auto found = w.find_group(group_name);
    group_bit = found ? *found : static_cast<int>(w.groups.size());
    if (group_bit >= 32) throw Wrong(0, "makes the 33rd group; LAMMPS has 32 at most");
    if (!found) w.groups.push_back(group_name);
  }
  int id_offset = 0;
  if (add)
    for (const Atom& a : w.atoms)
      if (World::there(a)) id_offset = std::max(id_offset, a.id);
  const auto put = [&](int id, int type, const Vec3& x) -> Atom& {
    Atom a;
    a.id = id + id_offset, a.type = type + offset[0], a.x = a.start = x + shift, a.born = w.run_number();
    if (group_bit >= 0) a.groups |= 1u << group_bit;
    if (a.id >= static_cast<int>(w.of_id.size())) w.of_id.resize(static_cast<std::size_t>(a.id) + 1, -1);
    w.of_id[static_cast<std::size_t>(a.id)] = static_cast<int>(w.atoms.size());
    return w.atoms.emplace_back(a);
  };
  const auto base = static_cast<int>(w.atoms.size());
  for (std::size_t k = 0; k < data.id.size(); ++k) {
    if (data.id[k] > static_cast<int>(most_atoms)) throw Wrong(1, fmt::format("an id is above {}", most_atoms));
    Atom& a = put(data.id[k], data.type[k], data.position.col(static_cast<Eigen::Index>(k)));
    a.molecule = data.molecule[k], a.diameter = data.diameter[k], a.density = data.density[k];
    if (data.velocity.cols() > 0) a.v = data.velocity.col(static_cast<Eigen::Index>(k));
    if (!w.sphere && data.mass.size() > k) w.mass[static_cast<std::size_t>(a.type - 1)] = data.mass[k];
  }
  for (const Bond& b : data.bonds)
    w.bonds.push_back({b.type + 1 + offset[1], {b.particles[0] + base, b.particles[1] + base}, w.run_number()});
  for (const Angle& a : data.angles)
    w.angles.push_back({a.type + 1 + offset[2], {a.particles[0] + base, a.particles[1] + base, a.particles[2] + base}, w.run_number()});
  if (data.bodies.empty()) return;
  if (!w.body_file.empty()) throw Wrong(1, "bodies come from one data file", true);
  w.body_file = file, w.bodies = true;
  for (std::size_t b = 0; b < data.bodies.size(); ++b)
    put(data.bodies[b].id, data.bodies[b].type, data.body_position.col(static_cast<Eigen::Index>(b))).is_body = true;
}

void velocity(Interpreter& in) {
  in.wants(3, "velocity GROUP set VX VY VZ");
  World& w = in.world;
  const int g = w.group(in.word(1), 1);
  if (in.word(2) == "create" || in.word(2) == "scale" || in.word(2) == "ramp" || in.word(2) == "zero")
    return in.ignore("velocities at the start matter in motion only");
  if (in.word(2) != "set") throw Wrong(2, in_quotes(in.word(2)) + " is no way of setting velocities; set is", true);
  in.wants(6, "velocity GROUP set VX VY VZ");
  for (int c = 0; c < 3; ++c) {
    const auto i = static_cast<std::size_t>(3 + c);
    if (in.word(i) == "NULL") continue;
    const Value v = each_value(in, i);
    for (std::size_t k = 0; k < w.atoms.size(); ++k)
      if (World::there(w.atoms[k]) && w.in(w.atoms[k], g)) w.atoms[k].v[c] = v.at(k);
  }
}

void displace_atoms(Interpreter& in) {
  in.wants(6, "displace_atoms GROUP move DX DY DZ");
  World& w = in.world;
  const int g = w.group(in.word(1), 1);
  if (in.word(2) != "move") throw Wrong(2, in_quotes(in.word(2)) + " is no displacement that is taken; move is", true);
  const std::array<Value, 3> d{each_value(in, 3), each_value(in, 4), each_value(in, 5)};
  for (std::size_t k = 0; k < w.atoms.size(); ++k) {
    Atom& a = w.atoms[k];
    if (!World::there(a) || !w.in(a, g)) continue;
    w.at(a);
    if (a.born < w.run_number()) throw Wrong(0, "displaces atoms that were there in an earlier run; they go on from where they are", true);
    for (int c = 0; c < 3; ++c) a.x[c] += d[static_cast<std::size_t>(c)].at(k);
  }
}

void compute(Interpreter& in) {
  in.wants(4, "compute ID GROUP STYLE …");
  Compute c;
  c.style = in.word(3), c.group = in.word(2);
  in.world.group(c.group, 2);
  if (c.style != "reduce") in.ignore("output: a run of elamin writes its own");
  else {
    in.wants(6, "compute ID GROUP reduce MODE INPUT …");
    c.mode = in.word(4);
    for (std::size_t i = 5; i < in.size() && in.word(i) != "replace"; ++i) c.inputs.push_back(in.word(i));
    static const std::vector<std::string> modes{"min", "max", "sum", "ave", "sumsq", "avesq"};
    if (std::find(modes.begin(), modes.end(), c.mode) == modes.end())
      throw Wrong(4, in_quotes(c.mode) + " is no mode of reduce; there are: " + listed(modes));
  }
  in.names.computes[in.word(1)] = std::move(c);
}

void uncompute(Interpreter& in) {
  in.wants(2, "uncompute ID", 2);
  if (!in.names.computes.erase(in.word(1))) throw Wrong(1, in_quotes(in.word(1)) + " is no compute");
}

}  // namespace elamin::script::command

namespace elamin::script {

void take_positions(Interpreter& in, const std::string& file) {
  const LammpsData data = read_lammps_data(file, "");
  World& w = in.world;
  std::vector<bool> found(w.atoms.size());
  for (std::size_t k = 0; k < data.id.size(); ++k) {
    const int id = data.id[k];
    const int i = id < static_cast<int>(w.of_id.size()) ? w.of_id[static_cast<std::size_t>(id)] : -1;
    if (i < 0) throw Wrong(0, fmt::format("{} holds an atom {} that is not there behind this run", in_quotes(file), id));
    w.atoms[static_cast<std::size_t>(i)].x = data.position.col(static_cast<Eigen::Index>(k));
    found[static_cast<std::size_t>(i)] = true;
  }
  for (std::size_t i = 0; i < w.atoms.size(); ++i)
    if (World::there(w.atoms[i]) && !found[i] && !w.atoms[i].is_body)
      throw Wrong(0, fmt::format("{} does not hold the atom {}, which is there behind this run", in_quotes(file), w.atoms[i].id));
}

}  // namespace elamin::script
