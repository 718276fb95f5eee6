#pragma once
// The groups of a problem file, and all names in it.
#include "lammps/script/particles.hpp"

#include <set>

namespace elamin::script {

class GroupNames {
 public:
  GroupNames(const World& world, const Particles& particles) : world_(world), particles_(particles) {}

  /// A name that nothing has yet: this one, where it may be, with what is no letter as _.
  std::string unique(std::string name);
  /// The name of the group of these atoms, as they are in a run.
  std::string of(const std::vector<int>& members, const std::string& wanted, int run);
  std::string of_types(const std::vector<int>& types);
  /// The keys of a group that choose these: types where they are all that there are of them, else ids.
  std::string selection(const std::vector<int>& members, int run) const;
  /// The tables of all groups that were named.
  const std::string& tables() const { return text_; }

 private:
  const std::vector<int>& alive(int run) const;

  const World& world_;
  const Particles& particles_;
  std::map<std::vector<int>, std::string> known_, of_types_;
  std::set<std::string> names_;
  std::string text_;
};

}  // namespace elamin::script
