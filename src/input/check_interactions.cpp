#include "input/check_parts.hpp"
#include "input/check_region.hpp"
#include "input/conditions.hpp"
#include "input/schema_words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {

void check_direction(TablePlace& place, const char* key, const Vec3& direction, Mistakes& mistakes) {
  if (direction.isZero(0)) mistakes.add(place, key, "is zero; a direction has a length");
}

const char* name_of(Shape shape) {
  for (const auto& word : shape_words)
    if (word.value == shape) return word.text;
  return "";
}

void check_region(TablePlace& place, const Region& region, bool flat, Mistakes& mistakes) {
  const auto order = [&](double lo, double hi, bool may_meet, const std::string& along) {
    if (lo > hi)
      mistakes.add(place, "hi", fmt::format("lies below lo{}: {} < {}", along, hi, lo));
    else if (lo == hi && !may_meet)
      mistakes.add(place, "hi", fmt::format("is the same as lo{}: {}; there must be room between them", along, hi));
  };
  switch (region.shape) {
    case Shape::plane: return check_direction(place, "normal", region.normal, mistakes);
    case Shape::block:
      for (int c = 0; c < 3; ++c) order(region.lo[c], region.hi[c], flat, fmt::format(" along {}", "xyz"[c]));
      return;
    case Shape::sphere: return;
    case Shape::cylinder: return order(region.axial_lo, region.axial_hi, flat, "");
    case Shape::cone:
      order(region.axial_lo, region.axial_hi, false, "");
      if (region.radius_lo == 0 && region.radius_hi == 0)
        mistakes.add(place, "radius_hi", "is zero, and radius_lo too; a cone has a radius at one end at least");
      return;
  }
}

namespace {

class CheckInteractions {
 public:
  CheckInteractions(const Problem& problem, Names& names, Mistakes& mistakes)
      : problem_(problem), names_(names), mistakes_(mistakes) {}

  void check(ConnectTable& c) {
    names_.refer(c.place, "between", c.between);
    if (!c.rest.as_built && !c.place.keys.count("angle_stiffness"))
      mistakes_.add(c.place, "rest", "is of no use without angle_stiffness; without it there are no angles");
  }

  void check(ContactTable& c) {
    const bool whole = !c.place.broken;
    names_.refer(c.place, "between", c.between);
    if (whole && c.inner_cutoff && *c.inner_cutoff >= *c.cutoff)
      mistakes_.add(c.place, "inner_cutoff", fmt::format("is {}, and cutoff is {}; the shell in which the force goes to zero ends there, and begins before",
                                                         *c.inner_cutoff, *c.cutoff));
    if (!whole || c.law != "hertz") return;
    damping(c.place, c.damping);
    if (c.hard) return hard(c.place);
    const bool effective = written(c, "effective_modulus"), E = written(c, "youngs_modulus"),
               nu = written(c, "poissons_ratio");
    if (effective) return only_one(c.place, E, nu);
    if (!E)
      mistakes_.add(c.place, "youngs_modulus",
                    "is missing; give youngs_modulus and poissons_ratio, or effective_modulus");
    else if (!nu)
      mistakes_.add(c.place, "poissons_ratio",
                    "is missing; it must be a number above -1 and at most 0.5, or give effective_modulus alone");
    else if (c.youngs_modulus.size() != c.poissons_ratio.size())
      mistakes_.add(c.place, "poissons_ratio",
                    c.poissons_ratio.size() == 1 ? "is one number for two moduli; give a list of two"
                                                 : "are two numbers for one modulus; give one, or two moduli");
  }

  void check(WallTable& w, const Scaling& scaling) {
    const bool whole = !w.place.broken;
    names_.refer(w.place, "group", w.group);
    if (!whole) return;
    check_region(w.place, w.region, false, mistakes_);
    radius(w, scaling);
    damping(w.place, w.damping);
    if (w.hard) return hard(w.place);
    const bool effective = written(w, "effective_modulus"), E = written(w, "youngs_modulus"),
               nu = written(w, "poissons_ratio");
    if (effective)
      only_one(w.place, E, nu);
    else if (!E && !w.k_n)
      mistakes_.add(w.place, "youngs_modulus", "is missing; it must be a positive number, or give effective_modulus, or k_n for bodies");
  }

 private:
  template <class Table> static bool written(const Table& t, const char* key) { return t.place.keys.count(key) > 0; }

  void only_one(TablePlace& place, bool E, bool nu) {
    if (E) mistakes_.add(place, "effective_modulus", "youngs_modulus is there too; give one of them");
    if (nu && !E) mistakes_.add(place, "poissons_ratio", "is of no use beside effective_modulus; leave it out");
  }

  /// What is impenetrable has no modulus, and only some methods know it.
  void hard(TablePlace& place) {
    for (const char* key : {"youngs_modulus", "poissons_ratio", "effective_modulus"})
      if (place.keys.count(key)) mistakes_.add(place, key, "is of no use with hard = true; what is impenetrable has no modulus");
    if (problem_.in_time())
      mistakes_.add(place, "hard", "cannot be had in dynamics; give it a modulus");
    else if (problem_.study == StudyType::dynamics || problem_.solver.method != "ipopt")
      mistakes_.add(place, "hard", "needs a method for inequality constraints: solver.method = \"ipopt\"");
  }

  void damping(TablePlace& place, const DampingKeys& d) {
    using Model = ContactDamping::Model;
    const auto wrong = [&](const char* key, const char* what) { mistakes_.add(place, key, what); };
    if (d.model == Model::none) {
      if (d.coefficient) wrong("damping_coefficient", "is of no use without damping: \"velocity\", \"mass_velocity\" or \"viscoelastic\"");
      if (d.restitution) wrong("restitution", "is of no use without damping = \"tsuji\"");
      if (d.friction > 0) wrong("friction", "needs damping, which limits it at small sliding velocities");
    } else if (d.model == Model::tsuji) {
      if (d.coefficient) wrong("damping_coefficient", "is not for damping = \"tsuji\", which has restitution");
      if (!d.restitution) wrong("restitution", "is missing; damping = \"tsuji\" needs a number between 0 and 1");
    } else {
      if (d.restitution) wrong("restitution", "is for damping = \"tsuji\" only; give damping_coefficient");
      if (!d.coefficient) wrong("damping_coefficient", "is missing; it must be a number not below 0");
    }
  }

  /// The radius must stay one at every load factor in use.
  void radius(WallTable& w, const Scaling& scaling) {
    if (w.radius_change == 0) return;
    const Region& r = w.region;
    if (r.shape == Shape::plane || r.shape == Shape::block)
      return mistakes_.add(w.place, "radius_change", fmt::format("a {} has no radius; leave it out", name_of(r.shape)));
    const bool cone = r.shape == Shape::cone;
    for (const double lambda : load_factors(problem_)) {
      const double change = scaling.at(lambda) * w.radius_change;
      const double smallest = cone ? std::min(r.radius_lo, r.radius_hi) + change : r.radius + change;
      const double largest = cone ? std::max(r.radius_lo, r.radius_hi) + change : smallest;
      if (smallest >= 0 && largest > 0) continue;
      return mistakes_.add(w.place, "radius_change",
                           fmt::format("makes a radius {} at load factor {}; a radius is {}", smallest, lambda,
                                       cone ? "not negative, and positive at one end at least" : "positive"));
    }
  }

  const Problem& problem_;
  Names& names_;
  Mistakes& mistakes_;
};

}  // namespace

void check_interactions(Problem& problem, Names& names, Mistakes& mistakes) {
  for (WallTable& w : problem.walls) names.add_wall(w.place, w.name);
  CheckInteractions interactions(problem, names, mistakes);
  for (ConnectTable& c : problem.connections) interactions.check(c);
  for (ContactTable& c : problem.contacts) interactions.check(c);
  for (std::size_t k = 0; k < problem.walls.size(); ++k)
    interactions.check(problem.walls[k], scaling_of(problem, condition_of("wall", problem.walls, k)));
}

}  // namespace elamin
