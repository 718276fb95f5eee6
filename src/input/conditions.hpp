#pragma once
// The tables that act by the load factor: how a file names them, and how much of each acts.
#include "model/model.hpp"
#include "input/problem.hpp"

#include <string>
#include <vector>

namespace elamin {

struct Condition {
  TablePlace place;
  std::string kind, name;                       // "support", "" if it has none
  int number = 1;                               // among those of its kind, from 1
  bool constant = false;                        // as its table says

  /// What others call it: "support.top", or "support.2" if it has no name.
  std::string label() const { return kind + "." + (name.empty() ? std::to_string(number) : name); }
  /// Whether `word` is its name or its number.
  bool answers_to(const std::string& word) const {
    return word == label() || word == kind + "." + std::to_string(number);
  }
};

/// The condition of table i of this kind.
template <class Table> Condition condition_of(const std::string& kind, const std::vector<Table>& tables, std::size_t i) {
  Condition c{tables[i].place, kind, tables[i].name, static_cast<int>(i) + 1, false};
  if constexpr (requires { tables[i].constant; }) c.constant = tables[i].constant;
  return c;
}

/// Supports, loads, gravity, pressures, changes, walls, each in the order of the file.
std::vector<Condition> conditions_of(const Problem& problem);
std::vector<std::string> labels_of(const std::vector<Condition>& conditions);

/// Index of the condition that the word names, or −1.
int find_condition(const std::vector<Condition>& conditions, const std::string& word);

/// s(λ) of a condition. Without [path] parameter the load factor scales all that are not constant; with it those that it
/// names, constant or not, and all others act in full.
Scaling scaling_of(const Problem& problem, const Condition& condition);

/// Load factors between which a study is known to move, its ends.
std::vector<double> load_factors(const Problem& problem);

/// The scalings of a model that was built of all of its problem's tables, in the order of conditions_of.
std::vector<Scaling*> scalings_in(Model& model);
std::vector<Scaling> scalings_in(const Model& model);

}  // namespace elamin
