#pragma once
// The study, its path, and the stages of it.
#include "input/keys.hpp"
#include "path/options.hpp"


namespace elamin {

enum class StudyType { energy, equilibrium, path, landscape, modes, dynamics };

/// [study] is one word; the problem keeps the word alone.
struct StudyTable {
  TablePlace place;
  StudyType type;
};

struct ModesTable {
  TablePlace place;
  int count = 6;
  bool operator==(const ModesTable&) const = default;
};

struct PathTable {
  TablePlace place;
  std::vector<std::string> parameter;
  PathMethod method = PathOptions{}.method;
  int steps = PathOptions{}.steps;
  double from = PathOptions{}.from, to = PathOptions{}.to;
  std::optional<WhenUnstable> when_unstable;
  int branches = 0, eigenvalues = 0;
  std::vector<std::string> locate{"limit", "branch", "contact"};
  bool event_errors = false;
  std::optional<std::vector<double>> stops;
  std::optional<double> lowest, highest;
  std::optional<int> points;
  int deflate = 0;
  std::optional<std::vector<double>> deflate_at;
  std::optional<int> frames, every;
  std::optional<std::vector<std::string>> film;
  bool has_frames() const { return frames || every; }
  std::string start;
  std::optional<double> start_lambda;
  bool operator==(const PathTable&) const = default;
};

/// A part of a path with conditions of its own; what is left out is as in [path].
struct StageTable {
  TablePlace place;
  std::string name;
  std::optional<std::vector<std::string>> vary;
  std::vector<std::string> off;
  std::optional<double> from, to;
  std::optional<int> steps;
  std::optional<PathMethod> method;
  std::optional<WhenUnstable> when_unstable;
  bool operator==(const StageTable&) const = default;
};

/// An observable whose reaching of a value is located on a path.
struct EventTable {
  TablePlace place;
  std::string name, observable;
  double value = 0;
  bool stop = false;
  bool operator==(const EventTable&) const = default;
};

void describe(Keys& keys, StudyTable& t);
void describe(Keys& keys, ModesTable& t);
void describe(Keys& keys, PathTable& t);
void describe(Keys& keys, StageTable& t);
void describe(Keys& keys, EventTable& t);

}  // namespace elamin
