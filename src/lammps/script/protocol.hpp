#pragma once
#include "lammps/script/interpreter.hpp"
#include "lammps/script/translation.hpp"

#include <array>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace elamin::script {

/// What a script does with its structures, run after run.
struct Protocol {
  std::string start_from;                       // a state that a motion goes on from
  bool touches = false;                         // there are walls or contacts
  std::vector<bool> driven;                     // of each run: whether its loads, supports or walls change in time
  double unit_time = 0;                         // of load factor 1
  std::vector<std::array<double, 2>> along;     // the load factor as each run begins and ends
  std::map<int, std::vector<std::string>> off;  // by run: tables that are not in force any more
  std::set<std::pair<std::string, char>> observed;   // groups whose reaction along an axis is wanted
};

/// The name of the stage that run k becomes.
std::string stage(int k);
/// The end of a problem file: [study]; [path] and its stages, or [dynamics]; [[observe]].
std::string protocol_text(const Protocol& of, const Reading& reading, const World& world, const TranslationOptions& options);

}  // namespace elamin::script
