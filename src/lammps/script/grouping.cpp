// Groups, and commands that remove particles and what glues them.
#include "core/find.hpp"
#include "lammps/script/building.hpp"

#include "core/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace elamin::script::command {
namespace {

void mark(World& w, int bit, const auto& wanted) {
  for (Atom& a : w.atoms)
    if (World::there(a) && wanted(a)) a.groups |= 1u << bit;
}

/// Whether a number is chosen by `v`, `a:b`, `a:b:c`, or a comparison such as `<= 3` or `<> 2 5`.
void mark_numbers(Interpreter& in, int bit, const auto& number_of_atom) {
  World& w = in.world;
  static const std::vector<std::string> signs{"<", ">", "<=", ">=", "==", "!=", "<>"};
  if (in.size() > 4 && contains(signs, in.word(3))) {
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
    if (style == "delete") w.groups[bit].clear();
    return;
  }
  if (style == "dynamic") throw Wrong(2, "groups that change as things move are not followed", true);
  if (style == "static") return;
  if (name == "all") throw Wrong(1, "the group all stays as it is");
  static const std::vector<std::string> styles{"type",  "id",       "molecule",  "region",  "variable",
                                               "union", "subtract", "intersect", "include", "empty"};
  if (!contains(styles, style))
    throw Wrong(2, in_quotes(style) + " is no style of a group; there are: " + listed(styles) + ", clear, delete" +
                       did_you_mean(style, styles), true);
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
    if (id < static_cast<long long>(w.of_id.size()) && w.of_id[id] >= 0)
      w.atoms[w.of_id[id]].groups |= 1u << bit;
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
  else if (style == "subtract") {                // those of the first come in, then members of the others go, as in LAMMPS
    mark(w, bit, [&](const Atom& a) { return w.in(a, others[0]); });
    for (std::size_t i = 1; i < others.size(); ++i)
      for (Atom& a : w.atoms)
        if (World::there(a) && w.in(a, others[i])) a.groups &= ~(1u << bit);
  } else if (style == "include") {
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
  for (const int a : chosen(in, in.word(1), 2)) gone[a] = true;
  bool compress = true, bonds = false, molecules = false;
  for (std::size_t i = 3; i < in.size(); i += 2)
    if (in.word(i) == "compress") compress = in.yes(i + 1);
    else if (in.word(i) == "bond") bonds = in.yes(i + 1);
    else if (in.word(i) == "mol") molecules = in.yes(i + 1);
    else throw Wrong(i, in_quotes(in.word(i)) + " is no keyword of delete_atoms");
  std::set<int> whole;                           // molecules that go
  for (std::size_t k = 0; k < w.atoms.size() && molecules; ++k)
    if (gone[k] && w.atoms[k].molecule > 0) whole.insert(w.atoms[k].molecule);
  for (std::size_t k = 0; k < w.atoms.size(); ++k) gone[k] = World::there(w.atoms[k]) && (gone[k] || whole.count(w.atoms[k].molecule) > 0);
  const auto cut = [&](const auto& glue) {
    const auto goes = [&](int i) { return gone[i]; };
    return std::any_of(glue.begin(), glue.end(), [&](const auto& g) {
      return g.gone == always && std::any_of(g.atoms.begin(), g.atoms.end(), goes) && !std::all_of(g.atoms.begin(), g.atoms.end(), goes);
    });
  };
  if (!bonds && (cut(w.bonds) || cut(w.angles)))
    throw Wrong(0, "leaves bonds or angles of atoms that are gone, at which LAMMPS stops or takes what lies in its memory; `bond yes` deletes them, too");
  const auto count = static_cast<std::size_t>(std::count(gone.begin(), gone.end(), true));
  const auto there = static_cast<std::size_t>(std::count_if(w.atoms.begin(), w.atoms.end(), World::there));
  if (count == there && count > 0) {             // nothing is left: what comes is another problem
    in.end_pass();
    w.atoms.clear(), w.of_id.clear(), w.bonds.clear(), w.angles.clear(), w.runs.clear(), w.still.reset(), w.sheets.clear(), w.removals.clear();
    w.body_file.clear();
    return;
  }
  const bool leaves_out = w.special_lj[1] == 0 || w.special_lj[2] == 0;
  if (bonds && leaves_out && (cut(w.bonds) || cut(w.angles)))
    in.note("LAMMPS leaves pairs out of contacts still that were second or third neighbours over atoms that are gone; here they touch as "
            "all others");
  w.remove(gone);
  if (compress && !w.molecular && count > 0)
    in.note("LAMMPS numbers the atoms that are left anew (compress yes); here they keep their ids");
}

void reset_atom_ids(Interpreter& in) {
  in.note("LAMMPS numbers the atoms anew from here on; here they keep their ids, by which they are chosen further on");
  in.ignore("atoms keep their ids");
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
  else if (style == "stats") return in.ignore(because::output);
  else if (style != "multi")
    throw Wrong(2, in_quotes(style) + " is no way of choosing glue that is taken; multi, bond and angle are", true);
  bool any = false, special = false;
  for (; i < in.size(); ++i)
    if (in.word(i) == "any") any = true;
    else if (in.word(i) == "special") special = true;
    else if (in.word(i) != "remove")
      throw Wrong(i, in_quotes(in.word(i)) + " is no keyword of delete_bonds that is taken; any, remove and special are", true);
  const auto inside = [&](int a) { return w.in(w.atoms[a], g); };
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
      if (style != "angle" && b.gone == always && meant(b) != (inside(b.atoms[0]) && inside(b.atoms[1]))) throw NeedsPositions{w.last_run};
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

}  // namespace elamin::script::command
