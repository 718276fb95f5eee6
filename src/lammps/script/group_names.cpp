#include "lammps/script/group_names.hpp"

#include "lammps/script/table_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>

namespace elamin::script {

std::string GroupNames::unique(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
  if (name.empty()) name = "some";
  const auto reserved = [](const std::string& w) {
    return w == "all" || w == "lammps" || (w.starts_with("type") && w.find_first_not_of("0123456789", 4) == std::string::npos);
  };
  if (name.size() > 58) name.resize(58);
  if (!std::isalpha(static_cast<unsigned char>(name[0])) && name[0] != '_') name = "_" + name;
  if (reserved(name)) name += "_";
  std::string n = name;
  for (int k = 2; !names_.insert(n).second; ++k) n = fmt::format("{}_{}", name, k);
  return n;
}

std::string GroupNames::of(const std::vector<int>& members, const std::string& wanted, int run) {
  if (wanted == "all" && members == alive(run)) return "all";
  if (const auto found = known_.find(members); found != known_.end()) return found->second;
  const std::string name = unique(wanted == "all" ? "some" : wanted);
  text_ += fmt::format("\n[[group]]\nname = \"{}\"\n{}", name, selection(members, run));
  return known_[members] = name;
}

std::string GroupNames::selection(const std::vector<int>& members, int run) const {
  std::set<int> types;
  for (const int i : members) types.insert(world_.atoms[i].type);
  const bool whole = std::all_of(alive(run).begin(), alive(run).end(), [&](int i) {
    return !types.count(world_.atoms[i].type) || std::binary_search(members.begin(), members.end(), i);
  });
  std::vector<std::string> items;
  if (whole) {
    for (const int t : types) items.push_back(fmt::format("\"type{}\"", t));
    return fmt::format("of = {}\n", list_of(items));
  }
  std::vector<int> ids;
  for (const int i : members) ids.push_back(particles_.id(i));
  std::sort(ids.begin(), ids.end());
  for (const int id : ids) items.push_back(std::to_string(id));
  return fmt::format("ids = {}\n", list_of(items));
}

std::string GroupNames::of_types(const std::vector<int>& types) {
  if (types == particles_.types()) return "all";
  if (types.size() == 1) return "type" + std::to_string(types[0]);
  if (const auto found = of_types_.find(types); found != of_types_.end()) return found->second;
  std::vector<std::string> items, parts;
  for (const int t : types) items.push_back(fmt::format("\"type{}\"", t)), parts.push_back(std::to_string(t));
  const std::string name = unique(types.size() < 5 ? fmt::format("types_{}", fmt::join(parts, "_"))
                                                   : fmt::format("types_{}_to_{}", types.front(), types.back()));
  text_ += fmt::format("\n[[group]]\nname = \"{}\"\nof = {}\n", name, list_of(items));
  return of_types_[types] = name;
}

const std::vector<int>& GroupNames::alive(int run) const {
  return world_.runs.empty() ? particles_.atoms() : world_.runs[run].atoms;
}

}  // namespace elamin::script
