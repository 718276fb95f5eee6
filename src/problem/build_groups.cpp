#include "problem/build_groups.hpp"

#include "problem/build_contacts.hpp"
#include "problem/check.hpp"
#include "problem/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace elamin {
namespace {

std::vector<int> range_of(int first, int count) {
  std::vector<int> particles(count);
  std::iota(particles.begin(), particles.end(), first);
  return particles;
}

}  // namespace

Groups::Groups(const Model& model, bool whole, Mistakes& mistakes) : model_(model), mistakes_(mistakes) {
  if (whole)
    put("all", range_of(0, model.particles()));
  else
    add_unknown("all");
  for (const Structure& s : model.structures) {
    put(s.name, range_of(s.first, s.count));
    if (s.kind != "lammps") continue;
    std::map<int, std::vector<int>> by_type;
    for (int i = s.first; i < s.first + s.count; ++i) by_type[model.type[i]].push_back(i);
    for (auto& [type, particles] : by_type) put("type" + std::to_string(type), std::move(particles));
  }
}

void Groups::put(const std::string& name, std::vector<int> particles) {
  order_.push_back(name);
  sets_[name] = std::move(particles);
}

std::vector<Group> Groups::groups() const {
  std::vector<Group> all;
  for (const std::string& name : order_)
    if (const auto& particles = sets_.at(name)) all.push_back({name, *particles});
  return all;
}

const std::vector<int>* Groups::find(const TablePlace& table, const char* key, const std::string& name) {
  const auto found = sets_.find(name);
  if (found != sets_.end()) return found->second ? &*found->second : nullptr;
  // Other names were checked when the file was read; the types are known only now, if the data file could be read.
  const auto lammps = sets_.find("lammps");
  if (is_type_group(name) && lammps != sets_.end() && lammps->second) {
    std::vector<std::string> types;
    for (const std::string& known : order_)
      if (is_type_group(known)) types.push_back(known);
    mistakes_.add(table, key,
                  quoted(name) + " names no group; the data file has: " + listed(types) + did_you_mean(name, types));
  }
  return nullptr;
}

void Groups::add(const GroupTable& table) {
  const std::vector<int>* from = table.place.broken ? nullptr : find(table.place, "of", table.of);
  std::optional<std::vector<int>> particles;
  if (from) particles = chosen(table, *from);
  if (particles)
    put(table.name, std::move(*particles));
  else if (!sets_.count(table.name))
    add_unknown(table.name);
}

std::optional<std::vector<int>> Groups::chosen(const GroupTable& table, const std::vector<int>& from) {
  const int size = static_cast<int>(from.size());
  for (const auto& [key, count] : {std::pair("first", table.first), {"last", table.last}, {"middle", table.middle}}) {
    if (!count) continue;
    if (*count > size) {
      mistakes_.add(table.place, key,
                    fmt::format("must be at most {}, the particles of \"{}\", is {}", size, table.of, *count));
      return std::nullopt;
    }
    // The middle n of N; where one side must have one more left over, it is the end: the lower ones are taken.
    const int skip = key == std::string("first") ? 0 : key == std::string("last") ? size - *count : (size - *count) / 2;
    return std::vector<int>(from.begin() + skip, from.begin() + skip + *count);
  }
  if (table.ids) return with_ids(table, from);
  if (!table.inside && !table.outside) return from;

  std::vector<int> particles;
  const Region region = with_unit_normal((table.inside ? table.inside : table.outside)->region);
  for (const int i : from)
    if (region.contains(model_.start.at(i)) == table.inside.has_value()) particles.push_back(i);
  if (particles.empty()) {
    mistakes_.add(table.place, table.inside ? "inside" : "outside",
                  fmt::format("holds no particle of \"{}\"; a group has at least one", table.of));
    return std::nullopt;
  }
  return particles;
}

std::optional<std::vector<int>> Groups::with_ids(const GroupTable& table, const std::vector<int>& from) {
  // Ids ascend with the index.
  const auto below = [&](int particle, int id) { return model_.id[particle] < id; };
  std::vector<int> particles, absent;
  for (const int id : *table.ids) {
    const auto found = std::lower_bound(from.begin(), from.end(), id, below);
    if (found != from.end() && model_.id[*found] == id)
      particles.push_back(*found);
    else
      absent.push_back(id);
  }
  if (absent.empty()) {
    std::sort(particles.begin(), particles.end());
    return particles;
  }
  mistakes_.add(table.place, "ids",
                fmt::format("{}{} not in \"{}\", whose ids lie from {} to {}", absent[0],
                            absent.size() > 1 ? fmt::format(" and {} more are", absent.size() - 1) : " is", table.of,
                            model_.id[from.front()], model_.id[from.back()]));
  return std::nullopt;
}

}  // namespace elamin
