#pragma once
// Named sets of particles and bodies, and which of them a name stands for.
#include "input/keys.hpp"
#include "input/region.hpp"
#include "model/model.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

struct GroupTable {
  TablePlace place;
  std::string name, from_stage;          // of its particles: the stage they are there from
  std::vector<std::string> of{"all"};
  std::optional<std::vector<std::string>> except;
  std::optional<int> first, last, middle;
  std::optional<std::vector<int>> ids;
  struct Inside {
    TablePlace place;
    Region region;
    bool operator==(const Inside&) const = default;
  };
  std::optional<Inside> inside, outside;
  bool operator==(const GroupTable&) const = default;
};

void describe(Keys& keys, GroupTable::Inside& t);
void describe(Keys& keys, GroupTable& t);

/// Particles and bodies by index, each ascending; where they are counted, particles come first.
struct Members {
  std::vector<int> particles, bodies;
  int count() const { return static_cast<int>(particles.size() + bodies.size()); }
};

/// All groups by name. One whose members are not known, because a table it comes from is broken, is there but
/// empty-handed.
class Groups {
 public:
  /// `whole`: no structure is broken, so that "all" is known.
  Groups(const Model& model, bool whole, Mistakes& mistakes);

  /// Labels of atom types name their groups too, where the name is not taken.
  void add_labels(const std::vector<std::pair<std::string, int>>& labels);
  /// The members of a name that is broken.
  void add_unknown(const std::string& name) { sets_[name] = std::nullopt; }
  /// A [[group]] of what is there already; a mistake if it selects what is not there, or nothing.
  void add(const GroupTable& table);
  /// The members of the group that a table's key names, or null: not known, and why was told, or the table is broken.
  const Members* find(const TablePlace& table, const char* key, const std::string& name);
  /// Those of both groups that a key `between` names, or nothing.
  std::optional<std::array<Members, 2>> find(const TablePlace& table, const std::array<std::string, 2>& between);
  /// In the order in which they were made.
  std::vector<Group> groups() const;

 private:
  void put(const std::string& name, Members members);
  /// What is in any of the groups `of` and in none of those that are excepted; nothing after a mistake.
  std::optional<Members> source(const GroupTable& table);
  /// The chosen ones of a set; nothing after a mistake.
  std::optional<Members> chosen(const GroupTable& table, const Members& from);
  std::optional<Members> with_ids(const GroupTable& table, const Members& from);

  const Model& model_;
  Mistakes& mistakes_;
  std::map<std::string, std::optional<Members>> sets_;
  std::vector<std::string> order_;
};

}  // namespace elamin
