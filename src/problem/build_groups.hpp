#pragma once
// Which particles a name stands for.
#include "model/model.hpp"
#include "problem/mistakes.hpp"
#include "problem/problem.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// All groups by name. One whose particles are not known, because a table it comes from is broken, is there but
/// empty-handed.
class Groups {
 public:
  /// `whole`: no structure is broken, so that "all" is known.
  Groups(const Model& model, bool whole, Mistakes& mistakes);

  /// The particles of a name that is broken.
  void add_unknown(const std::string& name) { sets_[name] = std::nullopt; }
  /// A [[group]] of what is there already; a mistake if it selects what is not there, or nothing.
  void add(const GroupTable& table);
  /// The particles of the group that a table's key names, or null: not known, and why was told.
  const std::vector<int>* find(const TablePlace& table, const char* key, const std::string& name);
  /// In the order in which they were made.
  std::vector<Group> groups() const;

 private:
  void put(const std::string& name, std::vector<int> particles);
  /// The chosen ones of a set; nothing after a mistake.
  std::optional<std::vector<int>> chosen(const GroupTable& table, const std::vector<int>& from);
  std::optional<std::vector<int>> with_ids(const GroupTable& table, const std::vector<int>& from);

  const Model& model_;
  Mistakes& mistakes_;
  std::map<std::string, std::optional<std::vector<int>>> sets_;
  std::vector<std::string> order_;
};

}  // namespace elamin
