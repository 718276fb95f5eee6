#pragma once
// What a stored state has besides its LAMMPS data file LABEL.data: LABEL.json with the load factor, the tails of the
// positions and where the path was heading, so that a path goes on from it with the same numbers.
#include "model/model.hpp"
#include "path/point.hpp"

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

/// How the path of a state goes on, and which path that is.
struct StoredPath {
  std::vector<std::string> varied;     // labels of the conditions that its load factor scales …
  bool rising = true;                  // … upwards, from `from` to `to`
  Resume resume;
};

struct StateSupplement {
  double load_factor = 0;
  Field low;                          // 3 × particles, in ascending order of their ids [length]
  std::optional<StoredStage> stage;
  std::optional<StoredPath> path;      // where the state alone does not tell it
  std::vector<Pose> bodies = {};       // in the order of the model: of the position the tail alone (hi is 0), and the rotation
};

/// What a state stores of its bodies beside their data file.
std::vector<Pose> stored_poses(const State& state);

/// LABEL.json of LABEL.data.
std::string supplement_file(const std::string& data_file);

/// {"lambda": λ, "tail": [[x, y, z], …]}, a particle a line, with 17 digits; before the tail, if there is one, "stage":
/// {"name", "from", "scaling": [[fixed, rate], …]}, and "path": {"varied", "rising", "resume": what is not empty of Resume
/// by its names, one array for each of the modes}; behind it, if there are any, "bodies": [[x, y, z, qw, qx, qy, qz], …], tail
/// and rotation of each.
std::string supplement_text(const StateSupplement& stored);

/// What stands beside a data file; nothing if there is no such file. Throws InputError if it cannot be understood: vectors
/// over the free coordinates must be of one size, contacts between particles that there are.
std::optional<StateSupplement> read_supplement(const std::string& data_file);

}  // namespace elamin
