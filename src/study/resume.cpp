#include "study/resume.hpp"

#include "core/directory_lock.hpp"
#include "core/error.hpp"
#include "core/say.hpp"
#include "results/results_directory.hpp"
#include "results/stored_run.hpp"
#include "study/checkpoint.hpp"
#include "study/prepare.hpp"
#include "study/single.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace elamin {

namespace {

namespace fs = std::filesystem;

void check_inputs(const RunRecord& record, const PreparedRuns& prepared) {
  const auto now = input_hashes(prepared);
  if (now.size() != record.inputs.size()) throw InputError(fmt::format("{}: reads other files than when the run began", record.file));
  for (std::size_t k = 0; k < now.size(); ++k)
    if (now[k].second != record.inputs[k].second)
      throw InputError(fmt::format("{}: has changed since the run began, which cannot go on with it; put it back, or run {} anew", now[k].first, record.file));
}

void require_directory(const std::string& directory) {
  std::error_code error;
  if (!fs::is_directory(directory, error)) throw InputError(directory + ": there is no such directory");
  { const DirectoryLock probe(directory); }
}

}  // namespace

StoppedRuns stopped_runs(const std::string& directory) {
  require_directory(directory);
  const std::optional<Checkpoint> stopped = read_checkpoint(directory);
  if (!stopped)
    throw InputError(directory + ": holds nothing to go on from: it is not the results of a run, or of one that was stopped before it had begun; run the problem again");
  const RunRecord& record = stopped->record;
  if (record.run == RunRecord::not_alone) throw InputError(directory + ": is one of the runs of a bisection; resume the directory above");
  const fs::path folder = fs::path(record.folder).is_absolute() ? fs::path(record.folder) : (located(directory) / record.folder).lexically_normal();
  std::vector<Setting> settings;
  for (const auto& [key, value] : record.settings) settings.push_back({key, value});
  // By the name that it was given where that leads to the same folder from here.
  const std::string file = located(record.file).parent_path() == folder ? record.file : (folder / fs::path(record.file).filename()).string();
  StoppedRuns runs{record, settings, prepare_runs(parse_document(record.text, file), settings)};
  check_inputs(record, runs.prepared);
  for (PreparedRun& run : runs.prepared.runs) run.problem.file = record.file;
  return runs;
}

bool sweep_has_ended(const std::string& directory) {
  std::error_code error;
  return fs::exists(fs::path(directory) / "sweep.csv", error) && !fs::exists(checkpoint_file(directory), error);
}

RunResult resume(const ResumeOptions& options) {
  require_directory(options.directory);
  const bool ended = has_ended(options.directory);
  if (ended) remove_checkpoint(options.directory);              // it may have been killed before it could
  if (ended || sweep_has_ended(options.directory)) {
    if (!options.quiet) say("{}: is finished\n", options.directory);
    return {exit_done, options.directory, {}};
  }
  StoppedRuns stopped = stopped_runs(options.directory);
  const RunRecord& record = stopped.record;
  std::vector<PreparedRun>& runs = stopped.prepared.runs;
  if (record.run >= 0) {
    PreparedRun one = std::move(runs.at(static_cast<std::size_t>(record.run)));
    one.swept.clear();
    runs.clear(), runs.push_back(std::move(one));
  }
  return run(stopped.prepared, {.file = record.file, .settings = stopped.settings, .directory = options.directory, .threads = options.threads,
                                .quiet = options.quiet, .report = record.report, .checkpoint = options.checkpoint, .resumes = true, .record = record});
}

}  // namespace elamin
