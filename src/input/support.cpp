#include "core/suggest.hpp"
#include "input/parts.hpp"
#include "input/conditions.hpp"
#include "input/stages.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace elamin {

void describe(Keys& keys, SupportTable& t) {
  keys.about("What is held, and moved with the load factor or in time.");
  keys.may_name("name", t.name, "for path.parameter, stages and --set");
  keys.must("group", t.group, "what it holds");
  keys.may("directions", t.directions, "the letters of the coordinates that are held; by default all, where rotations does not say otherwise");
  keys.may("rotations", t.rotations,
           "of bodies: the letters of two or three axes about which they do not rotate; by default all, where directions does not say otherwise");
  keys.may("displacement", t.displacement, "at load factor 1 [length]");
  keys.may("velocity", t.velocity, "in dynamics: x = x(0) + V t");
  keys.may("constant", t.constant, "in full from the start, not scaled by the load factor");
  keys.may("from_stage", t.from_stage, "the stage it is in force from; by default from the start");
  keys.table("rotation", t.rotation);
}

namespace {

void check_support(const Problem& problem, SupportTable& s, Mistakes& mistakes) {
  for (const auto& [key, words] : {std::pair("directions", &s.directions), {"rotations", &s.rotations}}) {
    if (!*words) continue;
    const std::string& d = **words;
    if (d.empty() || std::set<char>(d.begin(), d.end()).size() != d.size() || d.find_first_not_of("xyz") != std::string::npos)
      return mistakes.add(s.place, key, "must be one, two or three of the letters x, y and z, is " + in_quotes(d));
  }
  const std::string d = s.directions.value_or(s.rotations ? "" : "xyz");
  const std::set<char> letters(d.begin(), d.end());
  if (s.rotation && (s.directions || s.rotations) && s.rotations.value_or("").size() != 3)
    mistakes.add(s.place, "rotation", "needs all rotations held; write rotations = \"xyz\"");
  for (const auto& [key, by] : {std::pair("displacement", s.displacement), {"velocity", s.velocity}})
    for (int c = 0; c < 3; ++c)
      if (by[c] != 0 && !letters.count("xyz"[c]))
        mistakes.add(s.place, key, fmt::format("moves along {}, which is not among the directions \"{}\"; give 0 there or hold that direction", "xyz"[c], d));
  if (s.velocity.isZero(0)) return;
  if (problem.study != StudyType::dynamics)
    mistakes.add(s.place, "velocity", "belongs to dynamics, study.type = \"dynamics\"; elsewhere give a displacement");
  else if (problem.dynamics.relax)
    mistakes.add(s.place, "velocity", "does not go with dynamics.relax, which ends in an equilibrium; leave one of them out");
}

}  // namespace

void check_supports(Problem& problem, Names& names, Mistakes& mistakes) {
  for (SupportTable& s : problem.supports) {
    names.refer(s.place, "group", s.group);
    check_support(problem, s, mistakes);
    check(s.rotation, s.place, mistakes);
  }
}

namespace {

/// Which support holds each coordinate of each particle; two that hold one alike are fine.
class Holders {
 public:
  Holders(const Problem& problem, const Model& model, Mistakes& mistakes)
      : problem_(problem),
        model_(model),
        mistakes_(mistakes),
        in_force_(in_force_by_stage(problem)),
        holder_(3 * (static_cast<std::size_t>(model.particles()) + 2 * model.bodies.size()), -1) {}

  void hold(int table, const Support& s) {
    const auto claim = [&](std::size_t place, const std::array<bool, 3>& held, const auto& compare) {
      for (int c = 0; c < 3; ++c) {
        if (!held[c]) continue;
        int& holder = holder_[3 * place + c];
        if (holder < 0)
          holder = table;
        else
          compare(holder, c);
      }
    };
    const std::size_t particles = model_.id.size(), bodies = model_.bodies.size();
    for (const int i : s.particles)
      claim(i, s.held, [&](int earlier, int c) { compare(table, earlier, called(model_, i), c); });
    for (const int b : s.bodies) {
      const std::string name = called(model_, model_.particles() + b);
      claim(particles + b, s.held, [&](int earlier, int c) { compare(table, earlier, name, c); });
      claim(particles + bodies + b, s.constrained_rotations, [&](int earlier, int) { compare_turns(table, earlier, name); });
    }
  }

 private:
  bool together(int table, int earlier) const {
    return std::any_of(in_force_.begin(), in_force_.end(), [&](const auto& stage) { return stage[table] && stage[earlier]; });
  }
  void compare_turns(int table, int earlier, const std::string& name) {
    const SupportTable &a = problem_.supports[table], &b = problem_.supports[earlier];
    const Vec3 here = a.rotation ? a.rotation->vector() : Vec3(Vec3::Zero()), there = b.rotation ? b.rotation->vector() : Vec3(Vec3::Zero());
    if ((here.isZero(0) && there.isZero(0)) || told_.count({table, earlier}) || !together(table, earlier)) return;
    const bool alike = here == there && scaling_of(problem_, condition_of("support", problem_.supports, table)) ==
                                            scaling_of(problem_, condition_of("support", problem_.supports, earlier));
    if (!alike && told_.insert({table, earlier}).second)
      mistakes_.add(a.place, fmt::format("turns {} otherwise than {}; one body has one rotation", name, named(b.place)));
  }
  void compare(int table, int earlier, const std::string& name, int c) {
    const SupportTable &a = problem_.supports[table], &b = problem_.supports[earlier];
    if (a.velocity[c] != b.velocity[c] && told_.insert({table, earlier}).second)
      return mistakes_.add(a.place, "velocity", fmt::format("moves {} of {} otherwise than {} ({} here, {} there); one coordinate has "
                                                            "one velocity", "xyz"[c], name, named(b.place),
                                                            a.velocity[c], b.velocity[c]));
    const double here = a.displacement[c], there = b.displacement[c];
    if ((here == 0 && there == 0) || told_.count({table, earlier})) return;
    if (!together(table, earlier)) return;
    const Scaling at_a = scaling_of(problem_, condition_of("support", problem_.supports, table)),
                  at_b = scaling_of(problem_, condition_of("support", problem_.supports, earlier));
    if (here == there && at_a == at_b) return;
    told_.insert({table, earlier});
    const auto word = [](const Scaling& s) { return s.rate == 0 ? "constant" : "scaled"; };
    const std::string what = here != there ? fmt::format("{} here, {} there", here, there)
                                           : fmt::format("{} here, {} there", word(at_a), word(at_b));
    mistakes_.add(a.place, fmt::format("prescribes {} of {} otherwise than {} ({}); one coordinate has one displacement", "xyz"[c], name, named(b.place),
                                       what));
  }

  const Problem& problem_;
  const Model& model_;
  Mistakes& mistakes_;
  std::vector<std::vector<bool>> in_force_;     // of each stage; supports come first
  std::vector<int> holder_;
  std::set<std::pair<int, int>> told_;
};

/// How a support holds bodies: all six coordinates, unless directions or turns are named. Between none and all of the turns,
/// one alone is no condition on where a body is.
void hold_bodies(const Problem& problem, const Model& model, const SupportTable& table, Support& s, Mistakes& mistakes) {
  if (s.bodies.empty()) {
    for (const auto& [key, there] : {std::pair("rotations", table.rotations.has_value()), {"rotation", table.rotation.has_value()}})
      if (there) mistakes.add(table.place, key, fmt::format("is of bodies, and \"{}\" has none; leave it out", table.group));
    return;
  }
  for (const char letter : table.rotations.value_or(table.directions ? "" : "xyz")) s.constrained_rotations[letter - 'x'] = true;
  std::array<bool, 3> held = s.constrained_rotations;
  if (model.plane_normal)
    for (int c = 0; c < 3; ++c) held[c] = held[c] || c != *model.plane_normal;
  if (std::count(held.begin(), held.end(), true) == 1)
    mistakes.add(table.place, "rotations", "holds one rotation alone, which is no condition on where a body is; hold two or all of them");
  if (!table.rotation || table.rotation->place.broken) return;
  s.rotation = table.rotation->vector();
  if (!model.plane_normal) return;
  const int n = *model.plane_normal;
  if (s.rotation.cwiseAbs().sum() != std::abs(s.rotation[n]))
    mistakes.add(table.place, "rotation", fmt::format("leads out of the plane \"{}\"; its axis must be {}", problem.plane, "xyz"[n]));
}

}  // namespace

bool add_supports(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  bool whole = true;
  Holders holders(problem, model, mistakes);
  for (int t = 0; t < static_cast<int>(problem.supports.size()); ++t) {
    const SupportTable& table = problem.supports[t];
    const Members* members = groups.find(table.place, "group", table.group);
    if (!members) {
      whole = false;
      continue;
    }
    Support s{table.group, members->particles, {false, false, false}, table.displacement,
              scaling_of(problem, condition_of("support", problem.supports, t))};
    for (const char letter : table.directions.value_or(table.rotations ? "" : "xyz")) s.held[letter - 'x'] = true;
    s.velocity = table.velocity;
    s.bodies = members->bodies;
    hold_bodies(problem, model, table, s, mistakes);
    stay_in_plane(problem, model, table.place, "displacement", s.displacement, mistakes);
    stay_in_plane(problem, model, table.place, "velocity", s.velocity, mistakes);
    holders.hold(t, s);
    model.supports.push_back(std::move(s));
  }
  return whole;
}

}  // namespace elamin
