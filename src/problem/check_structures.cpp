#include "problem/check_parts.hpp"
#include "problem/check_region.hpp"
#include "problem/schema_words.hpp"

#include <fmt/format.h>

namespace elamin {
namespace {

class CheckStructures {
 public:
  explicit CheckStructures(Mistakes& mistakes) : mistakes_(mistakes) {}

  void check(BeamTable& b) {
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
      if (b.axis) check_direction(b.place, "axis", *b.axis, mistakes_);
    } else {
      mistakes_.add(b.place, "its place is missing; give from and to, or center, axis and spacing");
    }
    stiffness(b.place);
  }

  void check(LoopTable& l) {
    check_direction(l.place, "normal", l.normal, mistakes_);
    stiffness(l.place);
  }

  void check(SheetTable& s) {
    check_direction(s.place, "normal", s.normal, mistakes_);
    stiffness(s.place);
  }

  void check(GrainsTable& g) {
    const bool positions = g.place.keys.count("positions") > 0, file = g.place.keys.count("file") > 0;
    if (positions && file) mistakes_.add(g.place, "file", "positions are there too; give one of them");
    if (!positions && !file)
      mistakes_.add(g.place, "positions or file is missing; give positions = [[x, y, z], …] or file = \"grains.csv\"");
    if (positions && !file && !g.place.keys.count("diameter"))
      mistakes_.add(g.place, "diameter", "is missing; it must be a positive number");
  }

 private:
  void stiffness(TablePlace& place) {
    const auto written = [&](const char* key) { return place.keys.count(key) > 0; };
    if (!written("youngs_modulus") && !(written("bond_stiffness") && written("angle_stiffness")))
      mistakes_.add(place, "youngs_modulus",
                    "is missing; it must be a positive number, or give bond_stiffness and angle_stiffness");
  }

  Mistakes& mistakes_;
};

}  // namespace

void check_structures(Problem& problem, Names& names, Mistakes& mistakes) {
  CheckStructures structures(mistakes);
  double particles = 0;
  const auto all = [&](auto& tables) {
    for (auto& table : tables) {
      names.add(table.place, table.name);
      structures.check(table);
    }
  };
  all(problem.beams);
  all(problem.loops);
  all(problem.sheets);
  all(problem.grains);
  for (const BeamTable& b : problem.beams) particles += b.particles;
  for (const LoopTable& l : problem.loops) particles += l.particles;
  if (particles > most_particles)
    mistakes.add(fmt::format("the structures have {:.0f} particles together; at most {} can be handled", particles,
                             most_particles));
}

void check_groups(Problem& problem, Names& names, Mistakes& mistakes) {
  for (GroupTable& g : problem.groups) {
    names.refer(g.place, "of", g.of);
    std::string selectors;
    int count = 0;
    for (const char* key : {"first", "last", "middle", "ids", "inside"})
      if (g.place.keys.count(key)) selectors += (count++ ? ", " : "") + std::string(key);
    if (count > 1) mistakes.add(g.place, "has " + selectors + "; give one of first, last, middle, ids and inside");
    if (g.inside && !g.inside->place.broken) {
      check_region(g.inside->place, g.inside->region, true, mistakes);
      g.place.broken = g.place.broken || g.inside->place.broken;
    }
    if (g.ids && !g.place.broken) {
      std::set<int> seen;
      for (const int id : *g.ids)
        if (!seen.insert(id).second) {
          mistakes.add(g.place, "ids", fmt::format("{} is there twice; once is enough", id));
          break;
        }
    }
    names.add(g.place, g.name);
  }
}

}  // namespace elamin
