#include "problem/check.hpp"

#include "problem/schema.hpp"
#include "problem/suggest.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <map>
#include <set>

namespace elamin {

const std::vector<std::string>& standing_columns() {
  static const std::vector<std::string> columns{"step",     "label",  "branch",       "lambda",   "energy",
                                                "bond",     "angle",  "external",     "residual", "iterations",
                                                "negative", "stable", "multiplicity", "status"};
  return columns;
}

bool is_type_group(const std::string& name) {
  return name.size() > 4 && name.compare(0, 4, "type") == 0 &&
         name.find_first_not_of("0123456789", 4) == std::string::npos;
}

namespace {

std::string line_of(const TablePlace& place) {
  return place.line > 0 ? fmt::format("{} of line {}", place.key, place.line) : place.key;
}

class Check {
 public:
  Check(Problem& problem, const std::vector<std::string>& other_names, Mistakes& mistakes)
      : p_(problem), other_(other_names.begin(), other_names.end()), mistakes_(mistakes) {}

  void all() {
    if (p_.lammps) names_["lammps"] = p_.lammps->place;
    double particles = 0;
    for (BeamTable& b : p_.beams) {
      new_name(b.place, b.name);
      beam(b);
      particles += b.particles;
    }
    if (particles > most_particles)
      mistakes_.add(fmt::format("the structures have {:.0f} particles together; at most {} can be handled", particles,
                                most_particles));
    for (GroupTable& g : p_.groups) group(g);
    for (SupportTable& s : p_.supports) support(s);
    for (LoadTable& l : p_.loads) {
      reference(l.place, "group", l.group);
      const bool tried = l.place.keys.count("force") || l.place.keys.count("total_force");
      if (l.force && l.total_force)
        mistakes_.add(l.place, "total_force", "force is there too; give one of them");
      else if (!l.force && !l.total_force && !tried)
        mistakes_.add(l.place, "force or total_force is missing; give one of them, a list of three numbers [x, y, z]");
    }
    for (GravityTable& g : p_.gravity) reference(g.place, "group", g.group);
    for (ViscosityTable& v : p_.viscosity) reference(v.place, "group", v.group);
    path();
    std::set<std::string> observables;
    for (ObserveTable& o : p_.observe) observe(o, observables);
    for (ExpectTable& e : p_.expect) expect(e, observables);
  }

 private:
  /// Enters the name of a structure or group, which must be new.
  void new_name(TablePlace& place, const std::string& name) {
    if (name.empty()) return;
    if (name == "all" || name == "lammps" || is_type_group(name))
      mistakes_.add(place, "name",
                    quoted(name) + " is reserved; \"all\", \"lammps\" and \"type1\", \"type2\", … name themselves");
    else if (const auto [first, is_new] = names_.emplace(name, place); !is_new)
      mistakes_.add(place, "name", quoted(name) + " is taken by " + line_of(first->second) + "; names are unique");
  }

  /// A reference to a group that must be there already.
  void reference(TablePlace& place, const char* key, const std::string& name) {
    if (!place.keys.count(key) || (name.empty() && place.broken)) return;   // the default; or missing, and said so
    if (name == "all" || names_.count(name) || other_.count(name) || (p_.lammps && is_type_group(name))) return;
    std::vector<std::string> known{"all"};
    for (const auto& entry : names_) known.push_back(entry.first);
    for (const GroupTable& g : p_.groups)
      if (g.name == name)
        return mistakes_.add(place, key, quoted(name) + " comes further down; a group is made of those before it");
    if (p_.lammps) known.push_back("type1");
    mistakes_.add(place, key,
                  quoted(name) + " names no group; there are: " + listed(known) + did_you_mean(name, known));
  }

  void beam(BeamTable& b) {
    const auto written = [&](const char* key) { return b.place.keys.count(key) > 0; };
    const bool ends = written("from") || written("to"), middle = written("center") || written("axis");
    if (ends && middle) {
      mistakes_.add(b.place, "has from or to as well as center or axis; give from and to, or center, axis and spacing");
    } else if (ends) {
      if (!written("from"))
        mistakes_.add(b.place, "from", "is missing beside to; it must be a list of three numbers [x, y, z]");
      if (!written("to"))
        mistakes_.add(b.place, "to", "is missing beside from; it must be a list of three numbers [x, y, z]");
      if (written("spacing")) mistakes_.add(b.place, "spacing", "follows from from, to and particles; leave it out");
      if (b.from && b.to && *b.from == *b.to)
        mistakes_.add(b.place, "to", "is the same point as from; a beam has a length");
    } else if (middle) {
      if (!written("center"))
        mistakes_.add(b.place, "center", "is missing beside axis; it must be a list of three numbers [x, y, z]");
      if (!written("axis"))
        mistakes_.add(b.place, "axis", "is missing beside center; it must be a list of three numbers [x, y, z]");
      if (b.axis && b.axis->isZero(0)) mistakes_.add(b.place, "axis", "is zero; a direction has a length");
    } else {
      mistakes_.add(b.place, "its place is missing; give from and to, or center, axis and spacing");
    }
    if (!written("youngs_modulus") && !(written("bond_stiffness") && written("angle_stiffness")))
      mistakes_.add(b.place, "youngs_modulus",
                    "is missing; it must be a positive number, or give bond_stiffness and angle_stiffness");
  }

  void group(GroupTable& g) {
    reference(g.place, "of", g.of);
    std::string selectors;
    int count = 0;
    for (const char* key : {"first", "last", "middle", "ids", "inside"})
      if (g.place.keys.count(key)) selectors += (count++ ? ", " : "") + std::string(key);
    if (count > 1) mistakes_.add(g.place, "has " + selectors + "; give one of first, last, middle, ids and inside");
    if (g.inside && !g.inside->place.broken)
      for (int c = 0; c < 3; ++c)
        if (g.inside->lo[c] > g.inside->hi[c]) {
          g.place.broken = true;
          mistakes_.add(g.inside->place, "hi",
                        fmt::format("lies below lo along {}: {} < {}", "xyz"[c], g.inside->hi[c], g.inside->lo[c]));
        }
    if (g.ids && !g.place.broken) {
      std::set<int> seen;
      for (const int id : *g.ids)
        if (!seen.insert(id).second) {
          mistakes_.add(g.place, "ids", fmt::format("{} is there twice; once is enough", id));
          break;
        }
    }
    new_name(g.place, g.name);
  }

  void support(SupportTable& s) {
    reference(s.place, "group", s.group);
    const std::string& d = s.directions;
    std::set<char> letters(d.begin(), d.end());
    if (d.empty() || letters.size() != d.size() || d.find_first_not_of("xyz") != std::string::npos)
      return mistakes_.add(s.place, "directions",
                           "must be one, two or three of the letters x, y and z, is " + quoted(d));
    for (int c = 0; c < 3; ++c)
      if (s.displacement[c] != 0 && !letters.count("xyz"[c]))
        mistakes_.add(s.place, "displacement", fmt::format("moves along {}, which is not among the directions \"{}\"; "
                                                           "give 0 there or hold that direction", "xyz"[c], d));
  }

  void path() {
    PathTable& t = p_.path;
    if (t.place.broken) return;
    if (t.from == t.to)
      mistakes_.add(t.place, "to",
                    fmt::format("is the same load factor as from, {}; a path leads from one to another", t.to));
    if (t.start_lambda && t.start.empty())
      mistakes_.add(t.place, "start_lambda", "is of no use without start, the state to start from");
    if (t.start_lambda && *t.start_lambda == t.to && t.from != t.to)
      mistakes_.add(t.place, "start_lambda",
                    fmt::format("is the load factor where the path ends, {}; a path leads from one to another", t.to));
  }

  void observe(ObserveTable& o, std::set<std::string>& observables) {
    reference(o.place, "group", o.group);
    if (o.name.empty()) return;
    const auto& columns = standing_columns();
    if (std::find(columns.begin(), columns.end(), o.name) != columns.end())
      mistakes_.add(o.place, "name",
                    quoted(o.name) + " is a column of the results already; taken are: " + listed(columns));
    else if (!observables.insert(o.name).second)
      mistakes_.add(o.place, "name", quoted(o.name) + " is the name of another [[observe]]; names are unique");
  }

  void expect(ExpectTable& e, const std::set<std::string>& observables) {
    const bool event = e.at.find(':') != std::string::npos;
    std::vector<std::string> columns;
    for (const std::string& c : standing_columns())
      if (c != "label" && c != "status" && (event || c != "multiplicity")) columns.push_back(c);
    columns.insert(columns.end(), observables.begin(), observables.end());
    if (e.place.keys.count("observable") && !(e.observable.empty() && e.place.broken) &&
        std::find(columns.begin(), columns.end(), e.observable) == columns.end())
      mistakes_.add(e.place, "observable", quoted(e.observable) + " is no column of numbers there; there are: " +
                                               listed(columns) + did_you_mean(e.observable, columns));
    if (const std::string wrong = wrong_at(e.at); !wrong.empty()) mistakes_.add(e.place, "at", wrong);
  }

  /// Why there is no such row, or "".
  std::string wrong_at(const std::string& at) const {
    if (at == "final" || (at == "initial" && p_.study == StudyType::path)) return "";
    if (p_.study != StudyType::path) return "must be \"final\" in a study that is not a path, is " + quoted(at);
    const std::string allowed =
        "must be \"initial\", \"final\", an event such as \"branch:1\", \"limit:1\" or \"contact:1\", or \"lambda=0.5\", "
        "is " + quoted(at);
    if (at.compare(0, 7, "lambda=") == 0) {
      double lambda = 0;
      const auto [end, error] = std::from_chars(at.data() + 7, at.data() + at.size(), lambda);
      if (error != std::errc() || end != at.data() + at.size() || !std::isfinite(lambda)) return allowed;
      const auto [lo, hi] = std::minmax(p_.path.from, p_.path.to);
      if (lo < hi && (lambda < lo || lambda > hi))
        return fmt::format("lies outside the path, whose load factors run from {} to {}", lo, hi);
      return "";
    }
    const std::size_t colon = at.find(':');
    if (colon == std::string::npos)
      return allowed + did_you_mean(at, {"initial", "final", "branch:1", "limit:1", "contact:1"});
    const std::string kind = at.substr(0, colon), number = at.substr(colon + 1);
    if (kind != "branch" && kind != "limit" && kind != "contact") return allowed;
    if (number.empty() || number.size() > 9 || number[0] == '0' ||
        number.find_first_not_of("0123456789") != std::string::npos)
      return allowed;
    const auto& located = p_.path.locate;
    if (!p_.path.place.broken && std::find(located.begin(), located.end(), kind) == located.end())
      return quoted(kind) + " is not among path.locate; only located events have a row";
    return "";
  }

  Problem& p_;
  std::set<std::string> other_;
  Mistakes& mistakes_;
  std::map<std::string, TablePlace> names_;
};

}  // namespace

void check_problem(Problem& problem, const std::vector<std::string>& other_names, Mistakes& mistakes) {
  Check(problem, other_names, mistakes).all();
}

}  // namespace elamin
