#include "input/observe.hpp"

#include "core/find.hpp"
#include "core/suggest.hpp"
#include "input/parts.hpp"
#include "input/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace elamin {

namespace {

constexpr Word<Reduce> reduce_words[]{{"mean", Reduce::mean}, {"sum", Reduce::sum}, {"min", Reduce::min}, {"max", Reduce::max}};
constexpr Word<RowEnd> end_words[]{{"first", RowEnd::first}, {"last", RowEnd::last}};

/// What is observed: quantity and component in one word.
struct Observed {
  Quantity quantity;
  Component component = Component::x;
  bool operator==(const Observed&) const = default;
};
namespace in_a_word {
using enum Quantity;
using enum Component;
constexpr Word<Observed> all[]{
    {"position.x", {position, x}}, {"position.y", {position, y}}, {"position.z", {position, z}}, {"position.norm", {position, norm}},
    {"displacement.x", {displacement, x}}, {"displacement.y", {displacement, y}}, {"displacement.z", {displacement, z}},
    {"displacement.norm", {displacement, norm}},
    {"rotation.x", {rotation, x}}, {"rotation.y", {rotation, y}}, {"rotation.z", {rotation, z}}, {"rotation.norm", {rotation, norm}},
    {"reaction.x", {reaction, x}}, {"reaction.y", {reaction, y}}, {"reaction.z", {reaction, z}}, {"reaction.norm", {reaction, norm}},
    {"torque.x", {torque, x}}, {"torque.y", {torque, y}}, {"torque.z", {torque, z}}, {"torque.norm", {torque, norm}},
    {"velocity.x", {velocity, x}}, {"velocity.y", {velocity, y}}, {"velocity.z", {velocity, z}}, {"velocity.norm", {velocity, norm}},
    {"angular_velocity.x", {angular_velocity, x}}, {"angular_velocity.y", {angular_velocity, y}},
    {"angular_velocity.z", {angular_velocity, z}}, {"angular_velocity.norm", {angular_velocity, norm}},
    {"gap", {gap}}, {"contacts", {contacts}},
    {"contact_force.x", {contact_force, x}}, {"contact_force.y", {contact_force, y}}, {"contact_force.z", {contact_force, z}},
    {"contact_force.norm", {contact_force, norm}},
    {"energy", {energy}}, {"tension", {tension}}, {"strain", {strain}}, {"moment", {moment}}, {"curvature", {curvature}},
    {"N.11", {membrane_force, c11}}, {"N.22", {membrane_force, c22}}, {"N.12", {membrane_force, c12}}, {"N.max", {membrane_force, most}},
    {"N.min", {membrane_force, least}},
    {"M.11", {bending_moment, c11}}, {"M.22", {bending_moment, c22}}, {"M.12", {bending_moment, c12}}, {"M.max", {bending_moment, most}},
    {"M.min", {bending_moment, least}},
    {"distance", {distance}}, {"angle", {angle}}, {"slope", {slope}},
    {"extent.x", {extent, x}}, {"extent.y", {extent, y}}, {"extent.z", {extent, z}},
    {"end_to_end", {end_to_end}}, {"area", {area}}, {"difference", {difference}}, {"derivative", {derivative}}};
}  // namespace in_a_word

Keys::Names words_of(bool (*chosen)(Quantity)) {
  Keys::Names words;
  for (const auto& w : in_a_word::all)
    if (chosen(w.value.quantity)) words.push_back(w.text);
  return words;
}

}  // namespace

void describe(Keys& keys, ObserveTable& t) {
  keys.about("A column of the results.");
  keys.name("name", t.name, "its name");
  Observed observed{t.quantity, t.component};
  const bool known = keys.must_word("quantity", observed, in_a_word::all, "what is observed, see docs/results.md");
  t.quantity = observed.quantity, t.component = observed.component;
  const auto group = [&] { keys.must("group", t.group, "of what; of a reaction, a gap and contacts a wall too"); };
  const auto reduce = [&] {
    keys.word("reduce", t.reduce, reduce_words,
              "how the values become one; by default the mean, of reactions, torques, contacts, their forces and energies the sum, of gaps the "
              "least");
  };
  const auto to = [&] { keys.must("to", t.to, "… to this group; of several particles or bodies the mean of their places counts"); };
  const auto of = [&] {
    keys.must_one_or_more("of", t.of, "of which other [[observe]], further up; of a difference two, the first less the second");
  };
  const auto axis = [&] { keys.may("axis", t.axis, "the direction that an angle is counted from"); };
  const auto about = [&] {
    keys.may("about", t.about, "the axis that an angle is counted about; by default the normal of the plane; without either an angle has no sign");
  };
  if (!known) return keys.may("group", t.group, ""), reduce(), keys.skip_the_rest();
  const auto is = [&](Quantity q) { return t.quantity == q; };
  using Q = Quantity;
  keys.either("quantity",
              {{words_of(is_reduced), "a field of a group", is_reduced(t.quantity), [&] { group(), reduce(); }},
               {{"distance"}, "a distance", is(Q::distance), [&] { group(), to(); }},
               {{"angle"}, "an angle", is(Q::angle),
                [&] {
                  group(), to();
                  keys.may_name("through", t.through, "the group that the angle is at, between the lines to the other two");
                  axis(), about();
                }},
               {{"slope"}, "a slope", is(Q::slope),
                [&] {
                  group();
                  keys.word("end", t.end, end_words, "the end of a row of particles whose last bond it is");
                  axis(), about();
                }},
               {words_of([](Q q) { return q == Q::extent || q == Q::end_to_end || q == Q::area; }), "a measure of one group",
                is(Q::extent) || is(Q::end_to_end) || is(Q::area), group},
               {{"difference"}, "a difference", is(Q::difference), of},
               {{"derivative"}, "a derivative", is(Q::derivative), [&] {
                  of();
                  keys.may("by", t.by, "by which other one, or by the load factor, along the path of equilibria");
                }}});
}

std::vector<std::size_t> made_of(const std::vector<ObserveTable>& all, std::size_t number) {
  std::set<std::size_t> parts{number};
  for (std::size_t k = number + 1; k-- > 0;) {
    if (!parts.count(k) || !of_observables(all[k].quantity)) continue;
    for (std::size_t i = 0; i < k; ++i)
      if (all[i].name == all[k].by || contains(all[k].of, all[i].name)) parts.insert(i);
  }
  return {parts.begin(), parts.end()};
}

namespace {

class CheckObserved {
 public:
  CheckObserved(const Problem& problem, Names& names, Mistakes& mistakes)
      : p_(problem), names_(names), mistakes_(mistakes), columns_(taken_columns(problem)) {}

  void check(ObserveTable& o) {
    names_.refer(o.place, "group", o.group, true);
    names_.refer(o.place, "to", o.to), names_.refer(o.place, "through", o.through);
    if (names_.is_wall(o.group) && !o.place.broken) wall(o);
    if (!o.place.broken) directions(o);
    if (of_observables(o.quantity)) others(o);
    if (o.name.empty()) return;
    if (contains(columns_, o.name))
      mistakes_.add(o.place, "name", in_quotes(o.name) + " is a column of the results already; taken are: " + listed(columns_));
    else if (contains(before_, o.name))
      mistakes_.add(o.place, "name", in_quotes(o.name) + " is the name of another [[observe]]; names are unique");
    else
      before_.push_back(o.name);
  }

 private:
  /// A wall is one thing: it has a reaction, a smallest gap and a number of contacts.
  void wall(ObserveTable& o) {
    if (o.quantity != Quantity::reaction && o.quantity != Quantity::gap && o.quantity != Quantity::contacts)
      mistakes_.add(o.place, "quantity",
                    in_quotes(o.group) + " is a wall; it has reaction.x, reaction.y, reaction.z, reaction.norm, gap and contacts");
    else if (o.reduce != default_reduce(o.quantity))
      mistakes_.add(o.place, "reduce", in_quotes(o.group) + " is a wall, which has one value; leave reduce out");
  }

  /// What an angle is counted from, and about.
  void directions(ObserveTable& o) {
    const bool slope = o.quantity == Quantity::slope;
    if (!slope && o.quantity != Quantity::angle) return;
    for (const auto& [key, vector] : {std::pair("axis", o.axis), {"about", o.about}})
      if (vector && vector->isZero(0)) return mistakes_.add(o.place, key, "must not be [0, 0, 0]; it is a direction");
    if (slope && !o.axis) return mistakes_.add(o.place, "axis", "is missing; it must be a list of three numbers [x, y, z]");
    if (!slope && o.axis && !o.through.empty()) return mistakes_.add(o.place, "axis", "through is there too; give one of them");
    if (!slope && !o.axis && o.through.empty())
      return mistakes_.add(o.place, "through is missing, the group that the angle is at; or axis, the direction that the way from group to `to` makes "
                                    "an angle with");
    if (!o.axis || (!o.about && p_.plane.empty())) return;
    const Vec3 about = o.about ? *o.about : Vec3::Unit(p_.plane == "yz" ? 0 : p_.plane == "xz" ? 1 : 2);
    if (o.axis->normalized().cross(about.normalized()).norm() < 1e-9)
      mistakes_.add(o.place, "axis", o.about ? "is along about; an angle is counted from another direction"
                                             : "is normal to the plane; an angle is counted from a direction in it");
  }

  /// What a difference or a derivative is made of.
  void others(ObserveTable& o) {
    const bool derivative = o.quantity == Quantity::derivative;
    if (derivative && (p_.in_time() || p_.study == StudyType::energy))
      mistakes_.add(o.place, "quantity", std::string("a derivative is along a path of equilibria; ") +
                                             (p_.in_time() ? "what moves in time has none" : "a study of an energy has none"));
    if (o.of.empty()) return;                          // missing, and told
    if (const std::size_t count = o.of.size(); count != (derivative ? 1 : 2))
      return mistakes_.add(o.place, "of", fmt::format("must be the {} [[observe]], is {} name{}", derivative ? "name of one" : "names of two", count,
                                                      count == 1 ? "" : "s"));
    for (const std::string& name : o.of) known(o, "of", name);
    if (derivative && o.by != "lambda") known(o, "by", o.by);
  }

  void known(ObserveTable& o, const char* key, const std::string& name) {
    if (!contains(before_, name))
      return mistakes_.add(o.place, key, in_quotes(name) + " is no [[observe]] further up; " + there_are(before_, name));
    if (o.quantity != Quantity::derivative) return;
    for (std::size_t k = 0; k < p_.observe.size(); ++k)
      if (p_.observe[k].name == name)
        for (const std::size_t part : made_of(p_.observe, k))
          if (p_.observe[part].quantity == Quantity::derivative)
            return mistakes_.add(o.place, key, in_quotes(name) + " is made of a derivative; there are first ones only");
  }

  const Problem& p_;
  Names& names_;
  Mistakes& mistakes_;
  std::vector<std::string> columns_, before_;
};

bool any_is(const std::vector<int>& members, const std::vector<bool>& are) {
  return std::any_of(members.begin(), members.end(), [&](int i) { return are[i]; });
}

/// Which particles and which bodies may touch anything.
std::array<std::vector<bool>, 2> touching(const Model& model) {
  std::vector<bool> particles(model.particles(), false), bodies(model.bodies.size(), false);
  const auto mark = [](std::vector<bool>& marked, const std::vector<int>& members) {
    for (const int i : members) marked[i] = true;
  };
  for (const PairContact& c : model.contacts)
    for (const auto& side : c.particles) mark(particles, side);
  for (const RoundedPair& r : model.rounded)
    for (int side = 0; side < 2; ++side) mark(particles, r.particles[side]), mark(bodies, r.bodies[side]);
  for (const Wall& w : model.walls) mark(particles, w.particles), mark(bodies, w.bodies);
  return {particles, bodies};
}

/// Why a group has not what is observed of it, or "".
std::string lacking(const ObserveTable& o, const Members& of, const Model& model, const std::array<std::vector<bool>, 2>& may_touch,
                    bool bonds_known) {
  const auto has = [&](int i) { return std::binary_search(of.particles.begin(), of.particles.end(), i); };
  const std::string group = in_quotes(o.group);
  const bool gap = o.quantity == Quantity::gap;
  if ((gap || o.quantity == Quantity::contact_force) && !any_is(of.particles, may_touch[0]) && !any_is(of.bodies, may_touch[1]))
    return "there is no [[contact]] and no [[wall]] for " + group + (gap ? "; a gap is to something that may touch" : "; nothing may touch it");
  if (of_bonds(o.quantity) && bonds_known &&
      std::none_of(model.bonds.begin(), model.bonds.end(), [&](const Bond& b) { return has(b.particles[0]) && has(b.particles[1]); }))
    return group + " has no two particles with a bond between them; tension and strain are of bonds";
  if (of_angles(o.quantity) && bonds_known &&
      std::none_of(model.angles.begin(), model.angles.end(), [&](const Angle& a) { return has(a.particles[1]); }))
    return group + " has no particle in the middle of an angle; moment and curvature are of angles";
  const auto is_within = [&](const Structure& s) {
    return s.kind == "sheet" && std::any_of(of.particles.begin(), of.particles.end(), [&](int i) { return s.has(i); });
  };
  if (of_sheets(o.quantity) && std::none_of(model.structures.begin(), model.structures.end(), is_within))
    return group + " has no particle of a [[sheet]]; N and M are of sheets";
  const std::size_t count = of.particles.size(), least = least_row(o.quantity);
  if (count < least) return fmt::format("{} has {} particle{}; {} are needed at least", group, count, count == 1 ? "" : "s", least);
  return "";
}

}  // namespace

void check_results(Problem& problem, Names& names, Mistakes& mistakes) {
  CheckObserved observed(problem, names, mistakes);
  for (ObserveTable& o : problem.observe) observed.check(o);
  check_expectations(problem, mistakes);
}

void check_observed(const Problem& problem, Groups& groups, const Model& model, Mistakes& mistakes) {
  if (problem.observe.empty()) return;
  const auto may_touch = touching(model);
  const auto from_start = [](const auto& tables) {
    return std::all_of(tables.begin(), tables.end(), [](const auto& t) { return t.from_stage.empty(); });
  };
  const bool bonds_known = from_start(problem.connections) && from_start(problem.bonds) && from_start(problem.angles);
  for (const ObserveTable& o : problem.observe) {
    if (o.place.broken || find_named(model.walls, o.group) || of_observables(o.quantity)) continue;
    for (const auto& [key, name] : {std::pair("to", o.to), {"through", o.through}})
      if (!name.empty()) groups.find(o.place, key, name);
    if (const Members* of = groups.find(o.place, "group", o.group))
      if (const std::string why = lacking(o, *of, model, may_touch, bonds_known); !why.empty()) mistakes.add(o.place, "quantity", why);
  }
}

}  // namespace elamin
