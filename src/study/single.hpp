#pragma once
// One run of one problem into one directory.
#include "model/model.hpp"
#include "results/expectations.hpp"
#include "results/mode.hpp"
#include "results/terminal.hpp"
#include "results/table.hpp"
#include "solve/report.hpp"
#include "study/checkpoint.hpp"
#include "study/curve.hpp"
#include "study/landscape.hpp"

namespace elamin {

struct [[nodiscard]] SingleResult {
  Status status = Status::converged;
  std::string why;
  Table path, events, curve, landscape;
  std::vector<std::string> observables;    // their columns in path
  std::vector<Mode> modes;                 // of a study of modes
  std::vector<std::string> zero_modes;     // of the last equilibrium, by name
  std::vector<std::string> warnings;       // as in summary.json
  std::vector<Verdict> verdicts;
};

struct SingleOptions {
  std::string directory;
  bool force = false;
  Progress::Style style = Progress::Style::silent;
  std::optional<RunRecord> record = {};    // none: it cannot be resumed
  double checkpoint = 1;                   // see RunOptions
  bool resumes = false;
  ModelAt models = {};                     // where the problem asks for a curve
};

/// Traces the study of a problem and writes everything it leaves to the directory as it goes, or goes on with that. What does not converge is in
/// the result, not thrown; InputError if the directory cannot be written, or is not for results unless `force` is given.
SingleResult run_single(const Problem& problem, const Model& model, const SingleOptions& options);

/// What a run that has ended came to, from its directory; without its modes.
SingleResult stored_result(const Problem& problem, const std::string& directory);

/// 0, 2 if not converged, 130 if interrupted.
int exit_status(const SingleResult& result);

}  // namespace elamin
