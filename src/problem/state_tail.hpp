#pragma once
// What a stored state has besides its LAMMPS data file LABEL.data: LABEL.json with the load factor and the tails of the
// positions, so that a path goes on from it with the same numbers.
#include "model/model.hpp"

#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// Of a state in a path with stages: which one, the load factor that it begins at, and how much of each condition acts.
struct StoredStage {
  std::string name;
  double from = 0;
  std::vector<Scaling> scaling;        // in the order of conditions_of
};

struct StateTail {
  double load_factor = 0;
  Field tail;                          // 3 × particles, in ascending order of their ids [length]
  std::optional<StoredStage> stage;
};

/// LABEL.json of LABEL.data.
std::string tail_file(const std::string& data_file);

/// {"lambda": λ, "tail": [[x, y, z], …]}, a particle a line, with 17 digits; before the tail "stage": {"name", "from",
/// "scaling": [[fixed, rate], …]}, if there is one.
std::string tail_text(const State& state, const StoredStage* stage = nullptr);

/// What stands beside a data file; nothing if there is no such file. Throws InputError if it cannot be understood.
std::optional<StateTail> read_tail(const std::string& data_file);

}  // namespace elamin
