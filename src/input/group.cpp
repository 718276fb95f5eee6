#include "input/group.hpp"

#include "core/suggest.hpp"
#include "input/parts.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <set>

namespace elamin {

void describe(Keys& keys, GroupTable::Inside& t) {
  keys.about("A region, as of a wall.");
  describe_region(keys, t.region);
}

void describe(Keys& keys, GroupTable& t) {
  keys.about("A named set of particles and bodies: all of other sets, or some of these.");
  keys.name("name", t.name, "its name");
  keys.may("from_stage", t.from_stage, "the stage that its particles are there from; by default from the start");
  keys.one_or_more("of", t.of, "what is in any of these groups …");
  keys.one_or_more("except", t.except, "… and in none of these");
  keys.may("first", t.first, "that many from the beginning", range::count);
  keys.may("last", t.last, "that many from the end", range::count);
  keys.may("middle", t.middle, "that many in the middle", range::count);
  keys.may("ids", t.ids, "these", range::id);
  keys.table("inside", t.inside);
  keys.table("outside", t.outside);
  keys.at_most_one({"first", "last", "middle", "ids", "inside", "outside"});
}

void check_groups(Problem& problem, Names& names, Mistakes& mistakes) {
  for (GroupTable& g : problem.groups) {
    for (const std::string& name : g.of) names.refer(g.place, "of", name);
    for (const std::string& name : g.except.value_or(std::vector<std::string>())) names.refer(g.place, "except", name);
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

namespace {

std::vector<int> range_of(int first, int count) {
  std::vector<int> indices(count);
  std::iota(indices.begin(), indices.end(), first);
  return indices;
}

/// The part of a set that begins behind `skip` of its members.
Members part_of(const Members& from, int skip, int count) {
  Members part;
  const int particles = static_cast<int>(from.particles.size());
  for (int k = skip; k < skip + count; ++k)
    if (k < particles) part.particles.push_back(from.particles[k]);
    else part.bodies.push_back(from.bodies[k - particles]);
  return part;
}

/// What a group is chosen from, for messages.
std::string origin(const GroupTable& table) { return fmt::format("\"{}\"", fmt::join(table.of, "\" and \"")); }

/// What a set is made of, for messages.
std::string kinds(const Members& members) {
  return members.bodies.empty() ? "particles" : members.particles.empty() ? "bodies" : "particles and bodies";
}

}  // namespace

Groups::Groups(const Model& model, bool whole, Mistakes& mistakes) : model_(model), mistakes_(mistakes) {
  if (whole)
    put("all", {range_of(0, model.particles()), range_of(0, static_cast<int>(model.bodies.size()))});
  else
    add_unknown("all");
  for (const Structure& s : model.structures) {
    put(s.name, {range_of(s.first, s.count), range_of(s.first_body, s.bodies)});
    if (s.kind != "lammps") continue;
    std::map<int, Members> by_type;
    for (int i = s.first; i < s.first + s.count; ++i) by_type[model.type[i]].particles.push_back(i);
    for (int b = s.first_body; b < s.first_body + s.bodies; ++b) by_type[model.bodies[b].type].bodies.push_back(b);
    for (auto& [type, members] : by_type) put("type" + std::to_string(type), std::move(members));
  }
}

void Groups::add_labels(const std::vector<std::pair<std::string, int>>& labels) {
  for (const auto& [label, type] : labels) {
    if (sets_.count(label)) continue;
    const auto found = sets_.find("type" + std::to_string(type));
    if (found != sets_.end() && found->second) put(label, Members(*found->second));
    else add_unknown(label);                                // of a file that could not be read, or a type of nothing
  }
}

void Groups::put(const std::string& name, Members members) {
  order_.push_back(name);
  sets_[name] = std::move(members);
}

std::vector<Group> Groups::groups() const {
  std::vector<Group> all;
  for (const std::string& name : order_)
    if (const auto& members = sets_.at(name)) all.push_back({name, members->particles, members->bodies});
  return all;
}

const Members* Groups::find(const TablePlace& table, const char* key, const std::string& name) {
  if (table.broken) return nullptr;
  const auto found = sets_.find(name);
  if (found != sets_.end()) return found->second ? &*found->second : nullptr;
  // Other names were checked when the file was read; the types are known only now, if the data file could be read.
  const auto lammps = sets_.find("lammps");
  if (is_type_group(name) && lammps != sets_.end() && lammps->second) {
    std::vector<std::string> types;
    for (const std::string& known : order_)
      if (is_type_group(known)) types.push_back(known);
    mistakes_.add(table, key, in_quotes(name) + " names no group; the data file has: " + listed(types) + did_you_mean(name, types));
  }
  return nullptr;
}

std::optional<std::array<Members, 2>> Groups::find(const TablePlace& table, const std::array<std::string, 2>& between) {
  const Members* first = find(table, "between", between[0]);
  const Members* second = between[1] == between[0] ? first : find(table, "between", between[1]);
  if (!first || !second) return std::nullopt;
  return std::array{*first, *second};
}

void Groups::add(const GroupTable& table) {
  std::optional<Members> members;
  if (!table.place.broken) members = source(table);
  if (members) members = chosen(table, *members);
  if (members)
    put(table.name, std::move(*members));
  else if (!sets_.count(table.name))
    add_unknown(table.name);
}

std::optional<Members> Groups::source(const GroupTable& table) {
  Members all;
  const auto take = [&](const char* key, const std::vector<std::string>& names, const auto& combine) {
    for (const std::string& name : names) {
      const Members* members = find(table.place, key, name);
      if (!members) return false;
      all = {combine(all.particles, members->particles), combine(all.bodies, members->bodies)};
    }
    return true;
  };
  const auto unite = [](const std::vector<int>& a, const std::vector<int>& b) {
    std::vector<int> both;
    std::set_union(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
    return both;
  };
  const auto without = [](const std::vector<int>& a, const std::vector<int>& b) {
    std::vector<int> rest;
    std::set_difference(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(rest));
    return rest;
  };
  if (!take("of", table.of, unite) || !take("except", table.except.value_or(std::vector<std::string>()), without)) return std::nullopt;
  if (all.count() > 0) return all;
  mistakes_.add(table.place, "except", "leaves nothing of " + origin(table) + "; a group has at least one");
  return std::nullopt;
}

std::optional<Members> Groups::chosen(const GroupTable& table, const Members& from) {
  const int size = from.count();
  for (const auto& [key, count] : {std::pair("first", table.first), {"last", table.last}, {"middle", table.middle}}) {
    if (!count) continue;
    if (*count > size) {
      mistakes_.add(table.place, key, fmt::format("must be at most {}, the {} of {}, is {}", size, kinds(from), origin(table), *count));
      return std::nullopt;
    }
    // The middle n of N; where one side must have one more left over, it is the end: the lower ones are taken.
    const int skip = key == std::string("first") ? 0 : key == std::string("last") ? size - *count : (size - *count) / 2;
    return part_of(from, skip, *count);
  }
  if (table.ids) return with_ids(table, from);
  if (!table.inside && !table.outside) return from;

  Members members;
  const Region region = with_unit_normal((table.inside ? table.inside : table.outside)->region);
  const bool inside = table.inside.has_value();
  for (const int i : from.particles)
    if (region.contains(model_.start.at(i)) == inside) members.particles.push_back(i);
  for (const int b : from.bodies)
    if (region.contains(model_.start.bodies[b].position) == inside) members.bodies.push_back(b);
  if (members.count() == 0) {
    const std::string what = from.bodies.empty() ? "no particle" : from.particles.empty() ? "no body" : "no particle and no body";
    mistakes_.add(table.place, inside ? "inside" : "outside", fmt::format("holds {} of {}; a group has at least one", what, origin(table)));
    return std::nullopt;
  }
  return members;
}

std::optional<Members> Groups::with_ids(const GroupTable& table, const Members& from) {
  // Ids ascend with the index, of particles and of bodies.
  const auto find = [&](const std::vector<int>& list, int id, const auto& id_of) {
    const auto found = std::lower_bound(list.begin(), list.end(), id, [&](int k, int wanted) { return id_of(k) < wanted; });
    return found != list.end() && id_of(*found) == id ? *found : -1;
  };
  const auto particle = [&](int i) { return model_.id[i]; };
  const auto body = [&](int b) { return model_.bodies[b].id; };
  Members members;
  std::vector<int> absent;
  for (const int id : *table.ids) {
    if (const int i = find(from.particles, id, particle); i >= 0) members.particles.push_back(i);
    else if (const int b = find(from.bodies, id, body); b >= 0) members.bodies.push_back(b);
    else absent.push_back(id);
  }
  if (absent.empty()) {
    for (std::vector<int>* list : {&members.particles, &members.bodies}) std::sort(list->begin(), list->end());
    return members;
  }
  std::vector<int> ends;
  for (const int i : from.particles) ends.push_back(particle(i));
  for (const int b : from.bodies) ends.push_back(body(b));
  const auto [lowest, highest] = std::minmax_element(ends.begin(), ends.end());
  mistakes_.add(table.place, "ids",
                fmt::format("{}{} not in {}, whose ids lie from {} to {}", absent[0],
                            absent.size() > 1 ? fmt::format(" and {} more are", absent.size() - 1) : " is", origin(table),
                            *lowest, *highest));
  return std::nullopt;
}

}  // namespace elamin
