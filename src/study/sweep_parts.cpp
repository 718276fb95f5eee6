#include "study/sweep_parts.hpp"

#include "core/directory_lock.hpp"
#include "core/error.hpp"
#include "core/say.hpp"
#include "core/timing.hpp"
#include "results/columns.hpp"
#include "results/results_directory.hpp"
#include "results/run_directory.hpp"
#include "results/stored_run.hpp"
#include "results/sweep_table.hpp"
#include "study/resume.hpp"
#include "study/sweep.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

namespace elamin {
namespace {

namespace fs = std::filesystem;

constexpr double patience = 20;                                 // seconds, for another part that makes the directory

/// The directory as parts of this sweep share it. The first part makes it; all find the same record in it.
void join(const std::string& directory, const RunRecord& record) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) throw OutputError(fmt::format("{}: cannot be created: {}", directory, error.message()));
  const DirectoryLock lock(directory, patience);
  if (const std::optional<Checkpoint> there = read_checkpoint(directory)) {
    const RunRecord& r = there->record;
    if (r.text != record.text || r.settings != record.settings || r.report != record.report || r.inputs != record.inputs)
      throw InputError(fmt::format("{}: parts of another sweep are in it: the problem file, --set or a file that it reads was different; choose another "
                                   "directory by -o, or remove this one", directory));
    return;
  }
  require_empty(directory, "a sweep in parts begins in a new directory, see -o");
  begin_results(directory);
  write_checkpoint(directory, {record});
}

}  // namespace

SweepPart parse_part(const std::string& text) {
  SweepPart part{0, 0};
  const char* const end = text.data() + text.size();
  const auto [slash, wrong] = std::from_chars(text.data(), end, part.number);
  if (wrong != std::errc{} || slash == end || *slash != '/') part.number = 0;
  else if (const auto [stop, error] = std::from_chars(slash + 1, end, part.of); error != std::errc{} || stop != end) part.of = 0;
  if (part.number < 1 || part.number > part.of)
    throw InputError(fmt::format("--part: must be K/N with K from 1 to N, as 3/20, is {}", text));
  return part;
}

RunResult run_sweep_part(const PreparedRuns& prepared, const RunOptions& given) {
  const Stopwatch watch;
  RunOptions options = given;
  if (!is_sweep(prepared)) throw InputError(options.file + ": is not a sweep over given values, which alone can be run in parts (--part)");
  if (!options.record) throw InputError(options.file + ": only a sweep of a problem file can be run in parts");
  join(options.directory, *options.record);
  options.resumes = true;
  std::vector<std::size_t> own;
  for (auto k = static_cast<std::size_t>(options.part->number - 1); k < prepared.runs.size(); k += static_cast<std::size_t>(options.part->of)) own.push_back(k);
  const auto results = run_side_by_side(prepared.runs, own, options);
  RunResult all = result_of_runs(prepared, results, options.directory);
  if (!options.quiet)
    say("{} of {} runs of part {}/{} in {:.2f} s\n", ended(results), own.size(),
               options.part->number, options.part->of, watch.seconds());
  return all;
}

RunResult collect(const CollectOptions& options) {
  if (sweep_has_ended(options.directory)) {
    if (!options.quiet) say("{}: is finished\n", options.directory);
    return {exit_done, options.directory, {}};
  }
  if (std::error_code error; !fs::exists(checkpoint_file(options.directory), error))
    throw InputError(options.directory + ": is not the directory of a sweep that was run in parts");
  const StoppedRuns stopped = stopped_runs(options.directory);
  const std::vector<PreparedRun>& runs = stopped.prepared.runs;
  if (!is_sweep(stopped.prepared)) throw InputError(options.directory + ": is one run, not a sweep; elamin resume goes on with it");
  const Problem& first = runs.front().problem;
  ResultsDirectory directory(options.directory, inputs_in(options.directory, first));
  std::vector<std::optional<SingleResult>> results(runs.size());
  std::vector<std::size_t> missing;
  CsvFile table(directory.file("sweep.csv"), sweep_columns(swept_keys(runs.front()), first, stopped.prepared.own));
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const std::string place = options.directory + "/" + run_name(k + 1, runs.size(), runs[k].swept);
    if (!has_ended(place)) {
      missing.push_back(k + 1);
      continue;
    }
    results[k] = stored_result(runs[k].problem, place);
    table.add(sweep_row_of(runs[k], *results[k], first));
  }
  RunResult all = result_of_runs(stopped.prepared, results, options.directory);
  if (missing.empty()) remove_checkpoint(options.directory);
  else {
    all.exit_status = std::max<int>(all.exit_status, exit_not_converged);
    constexpr std::size_t most_shown = 10;
    const std::vector<std::size_t> shown(missing.begin(), missing.begin() + static_cast<std::ptrdiff_t>(std::min(most_shown, missing.size())));
    complain("{}: {} of {} runs have not ended: {}{}; run their parts again, then collect\n", options.directory, missing.size(), runs.size(),
               fmt::join(shown, ", "), missing.size() > shown.size() ? ", …" : "");
  }
  if (!options.quiet) say("{} of {} runs\nwritten: {}/sweep.csv\n", ended(results), runs.size(), options.directory);
  return all;
}

}  // namespace elamin
