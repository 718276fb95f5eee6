#pragma once
// summary.json: how a run ended, and on what it stands.
#include "core/archive.hpp"
#include "core/factor_counts.hpp"
#include "results/table.hpp"
#include "solve/report.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace elamin {

/// What an independent look at the last point of a run came to (see study/end_check.hpp).
struct EndCheck {
  bool passed = true;
  std::string what;                                            // is not as it was told; "" if it passed
  double residual = 0, energy_error = 0;                       // as found anew [1, energy]
  int directions = 0;                                          // along which the energy was followed, and told something, where the point is called stable
};

struct Summary {
  std::string title, status, message;                          // status: see status_name
  std::string input, input_sha256;                             // the problem file, and the hash of its bytes
  std::vector<std::pair<std::string, double>> times;           // what and seconds
  std::vector<std::pair<std::string, double>> tolerances;
  std::vector<std::string> zero_modes;                         // of the last equilibrium, by name: rattlers, rigid motions
  double imperfection = 0;                                     // how far a particle was moved at most before all [length]; 0: none was
  FactorCounts factorizations = {};
  int resumed = 0;                                             // how often the run was stopped and went on
  std::optional<EndCheck> check = {};                          // of equilibria
  std::vector<std::string> warnings = {};                      // what is doubtful about the model or the result, a sentence each
};

/// "done", "not_converged" or "interrupted".
std::string status_name(Status status);

/// Writes the summary of a run that has not ended: "status": "running", process, started. Throws OutputError as write_summary does.
void write_running(const std::string& file, const std::string& title);

/// Over that, where a file could not be written, which the message tells: "status": "interrupted". It may be that this cannot be written either.
void write_broken_off(const std::string& file, const std::string& title, const std::string& message);

/// The version of this program.
std::string version();

/// Writes status, message, warnings, points, events (rows as objects), final (all columns of the last row, or null), times, factorizations,
/// version, input_sha256, tolerances, where there is one the imperfection, and of a curve its points and, as objects, the rows that have a label. Numbers that are not finite become null. Throws OutputError if it cannot be
/// written.
void write_summary(const std::string& file, const Summary& summary, const Table& path, const Table& events, const Table& curve = {});

}  // namespace elamin
