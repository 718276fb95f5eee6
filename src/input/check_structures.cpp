#include "model/centerline.hpp"
#include "input/check_parts.hpp"
#include "input/check_region.hpp"
#include "input/schema_words.hpp"

#include <fmt/format.h>

namespace elamin {
namespace {

class CheckStructures {
 public:
  CheckStructures(const std::string& plane, Mistakes& mistakes) : in_plane_(!plane.empty()), mistakes_(mistakes) {}

  void check(BeamTable& b) {
    const auto written = [&](const char* key) { return b.place.keys.count(key) > 0; };
    const bool ends = written("from") || written("to"), middle = written("center") || written("axis");
    if (written("through") && (ends || middle)) {
      mistakes_.add(b.place, "through", "gives the place; leave out from, to, center and axis");
    } else if (ends && middle) {
      mistakes_.add(b.place, "has from or to as well as center or axis; give from and to, or center, axis and spacing");
    } else if (written("through")) {
      if (written("spacing")) mistakes_.add(b.place, "spacing", "follows from through and particles; leave it out");
      if (b.through) corners(b.place, *b.through);
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
      mistakes_.add(b.place, "its place is missing; give from and to, or center, axis and spacing, or through");
    }
    arch(b);
    if (b.clamped) {
      const int least = 2 + (*b.clamped == ClampedEnds::both ? 2 : 1);
      if (middle)
        mistakes_.add(b.place, "clamped", "needs ends; give from and to, or through");
      else if (b.particles > 0 && b.particles < least)
        mistakes_.add(b.place, "particles",
                      fmt::format("must be at least {} with {} clamped", least, least == 3 ? "an end" : "both ends"));
    }
    row_stiffness(b.place);
  }

  void check(LoopTable& l) {
    check_direction(l.place, "normal", l.normal, mistakes_);
    row_stiffness(l.place);
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
  void corners(TablePlace& place, const std::vector<Vec3>& through) {
    if (through.size() < 2)
      mistakes_.add(place, "through", "must be a list of two points at least, [[x, y, z], [x, y, z]]");
    for (std::size_t i = 1; i < through.size(); ++i)
      if (through[i] == through[i - 1]) {
        mistakes_.add(place, "through", fmt::format("has points {} and {} in the same place", i, i + 1));
        break;
      }
  }

  void arch(BeamTable& b) {
    const auto written = [&](const char* key) { return b.place.keys.count(key) > 0; };
    const bool is_arch = written("rise") || written("angle");
    if (is_arch && !(written("from") && written("to")))
      mistakes_.add(b.place, written("rise") ? "rise" : "angle",
                    "is of an arch, which stands on from and to; give both");
    for (const char* key : {"toward", "profile"})
      if (written(key) && !is_arch)
        mistakes_.add(b.place, key, "is of an arch; give rise or angle too, or leave it out");
    if (!is_arch) return;
    if (written("rise") && written("angle")) mistakes_.add(b.place, "angle", "follows from rise; give one of them");
    if (b.rise && *b.rise == 0) mistakes_.add(b.place, "rise", "must not be 0; leave it out for a straight beam");
    if (!written("toward") && !in_plane_ && written("from") && written("to"))
      mistakes_.add(b.place, "toward",
                    "is missing; the arch rises to this side of from and to. In a plane it may be left out");
    if (b.from && b.to && b.toward && *b.from != *b.to && !rises({*b.from, *b.to, *b.toward}))
      mistakes_.add(b.place, "toward", "leads to no side of the line between from and to");
    if (b.particles == 2) mistakes_.add(b.place, "particles", "must be at least 3 for an arch");
    if (b.profile != Profile::sine) return;
    if (!written("rise")) mistakes_.add(b.place, "profile", "of a sine needs rise");
    if (b.clamped)
      mistakes_.add(b.place, "clamped", "is not for a sine; hold its ends with a [[support]] and leave this out");
  }

  void row_stiffness(TablePlace& place) {
    const auto written = [&](const char* key) { return place.keys.count(key) > 0; };
    for (const auto& [whole, part] :
         {std::pair("axial_stiffness", "bond_stiffness"), {"bending_stiffness", "angle_stiffness"}})
      if (written(whole) && written(part))
        mistakes_.add(place, whole, fmt::format("stands beside {}; give one of them", part));
    const bool bonds = written("bond_stiffness") || written("axial_stiffness");
    const bool angles = written("angle_stiffness") || written("bending_stiffness");
    if (!written("youngs_modulus") && !(bonds && angles))
      mistakes_.add(place, "youngs_modulus",
                    "is missing; it must be a positive number, or give axial_stiffness and bending_stiffness, or "
                    "bond_stiffness and angle_stiffness");
  }

  void stiffness(TablePlace& place) {
    const auto written = [&](const char* key) { return place.keys.count(key) > 0; };
    if (!written("youngs_modulus") && !(written("bond_stiffness") && written("angle_stiffness")))
      mistakes_.add(place, "youngs_modulus",
                    "is missing; it must be a positive number, or give bond_stiffness and angle_stiffness");
  }

  bool in_plane_;
  Mistakes& mistakes_;
};

}  // namespace

void check_structures(Problem& problem, Names& names, Mistakes& mistakes) {
  CheckStructures structures(problem.plane, mistakes);
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
    for (const std::string& name : g.of) names.refer(g.place, "of", name);
    for (const std::string& name : g.except.value_or(std::vector<std::string>())) names.refer(g.place, "except", name);
    std::string selectors;
    int count = 0;
    for (const char* key : {"first", "last", "middle", "ids", "inside", "outside"})
      if (g.place.keys.count(key)) selectors += (count++ ? ", " : "") + std::string(key);
    if (count > 1) mistakes.add(g.place, "has " + selectors + "; give one of first, last, middle, ids, inside and outside");
    for (auto* region : {&g.inside, &g.outside})
      if (*region && !(*region)->place.broken) {
        check_region((*region)->place, (*region)->region, true, mistakes);
        g.place.broken = g.place.broken || (*region)->place.broken;
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
