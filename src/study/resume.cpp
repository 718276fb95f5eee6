#include "study/resume.hpp"

#include "core/directory_lock.hpp"
#include "core/error.hpp"
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

}  // namespace

RunResult resume(const ResumeOptions& options) {
  std::error_code error;
  if (!fs::is_directory(options.directory, error)) throw InputError(options.directory + ": there is no such directory");
  { const DirectoryLock probe(options.directory); }
  const bool ended = has_ended(options.directory);
  const std::optional<Checkpoint> stopped = read_checkpoint(options.directory);
  if (ended) remove_checkpoint(options.directory);              // it may have been killed before it could
  if (ended || (!stopped && fs::exists(fs::path(options.directory) / "sweep.csv", error))) {
    if (!options.quiet) fmt::print("{}: is finished\n", options.directory);
    return {exit_done, options.directory, {}};
  }
  if (!stopped)
    throw InputError(options.directory + ": holds nothing to go on from: it is not the results of a run, or of one that was stopped before it had begun; run the problem again");
  const RunRecord& record = stopped->record;
  if (record.run == RunRecord::not_alone) throw InputError(options.directory + ": is one of the runs of a bisection; resume the directory above");
  const fs::path folder = fs::path(record.folder).is_absolute() ? fs::path(record.folder) : (located(options.directory) / record.folder).lexically_normal();
  std::vector<Setting> settings;
  for (const auto& [key, value] : record.settings) settings.push_back({key, value});
  // By the name that it was given where that leads to the same folder from here.
  const std::string file = located(record.file).parent_path() == folder ? record.file : (folder / fs::path(record.file).filename()).string();
  PreparedRuns prepared = prepare_runs(parse_document(record.text, file), settings);
  check_inputs(record, prepared);
  RunOptions run_options{.file = record.file, .settings = settings, .directory = options.directory, .threads = options.threads, .quiet = options.quiet,
                         .report = record.report, .checkpoint = options.checkpoint, .resumes = true};
  for (PreparedRun& run : prepared.runs) run.problem.file = record.file;
  if (record.run >= 0) {
    PreparedRun one = std::move(prepared.runs.at(static_cast<std::size_t>(record.run)));
    one.swept.clear();
    prepared.runs.clear(), prepared.runs.push_back(std::move(one));
  }
  run_options.record = record;
  return run(prepared, run_options);
}

}  // namespace elamin
