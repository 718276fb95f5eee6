#pragma once
// One problem by every method that can, side by side.
#include "input/problem.hpp"
#include "input/settings.hpp"
#include "solve/report.hpp"

#include <optional>
#include <string>
#include <vector>

namespace elamin {

struct CompareOptions {
  std::string file;
  std::vector<Setting> settings;
  std::vector<std::string> methods;    // as solver.method; none: those that are tried by default
  double limit = 60;                   // seconds a method may take
  bool json = false;
  int threads = 0;                     // 0: usual_threads()
};

/// What came of one method.
struct Compared {
  std::string method;
  std::string refused;                 // why it cannot, one sentence; then the rest is empty
  Status status = Status::not_converged;
  bool out_of_time = false;
  std::string why;                     // how the study ended
  double energy = 0, residual = 0;     // at the last equilibrium
  std::optional<double> energy_difference;     // from the first method that converged, relative
  std::optional<double> state_difference;      // largest one of a coordinate, relative to the extent of all particles
  int points = 0;                      // equilibria that were asked for
  int iterations = 0, evaluations = 0; // over all of them
  double seconds = 0;
};

/// Runs the study of a problem once with each method; nothing is written. Differences are those of the last equilibria.
std::vector<Compared> compare(const Problem& problem, const std::vector<std::string>& methods, double limit);

/// The methods that are tried where none are named: "newton" first.
std::vector<std::string> compared_methods();

/// `elamin compare`: prints the table, or JSON. Throws InputError as reading does, and for a study that has no equilibrium to find.
/// 0; 2 if a method did not converge that ran, 130 if interrupted.
int compare_command(const CompareOptions& options);

}  // namespace elamin
