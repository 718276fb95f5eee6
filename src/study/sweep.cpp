#include "study/sweep.hpp"

#include "core/directory_lock.hpp"
#include "core/error.hpp"
#include "core/heartbeat.hpp"
#include "core/interrupt.hpp"
#include "core/parallel.hpp"
#include "core/say.hpp"
#include "core/timing.hpp"
#include "input/document.hpp"
#include "results/columns.hpp"
#include "results/results_directory.hpp"
#include "results/run_directory.hpp"
#include "results/stored_run.hpp"
#include "results/summary.hpp"
#include "results/table.hpp"
#include "solve/ranks.hpp"
#include "study/refine.hpp"
#include "study/resume.hpp"
#include "study/single.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <numeric>
#include <thread>

namespace elamin {

namespace {

/// A value as it is called: words without quotes.
std::string plain(const Setting& setting) {
  const Node node = parse_value(setting.value, setting.place);
  const auto* text = std::get_if<std::string>(&node.value);
  return text ? *text : setting.value;
}

}  // namespace

std::string run_name(std::size_t number, std::size_t runs, const std::vector<Setting>& swept) {
  constexpr std::size_t longest = 120;
  std::string name = fmt::format("{:0{}}", number, fmt::formatted_size("{}", runs));
  for (const Setting& s : swept) {
    if (s.key.starts_with("expect")) continue;
    std::string part = "_" + s.key.substr(s.key.rfind('.') + 1) + "=";
    for (const char c : plain(s)) part += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '+' ? c : '_';
    if (name.size() + part.size() > longest) break;        // the number tells the runs apart anyway
    name += part;
  }
  return name;
}

std::vector<std::string> swept_keys(const PreparedRun& run) {
  std::vector<std::string> keys;
  for (const Setting& s : run.swept) keys.push_back(s.key);
  return keys;
}

std::vector<Cell> swept_values(const PreparedRun& run) {
  std::vector<Cell> values;
  for (const Setting& s : run.swept) {
    char* end = nullptr;
    const double number = std::strtod(s.value.c_str(), &end);
    values.push_back(end && *end == 0 && !s.value.empty() ? Cell(number) : Cell(plain(s)));
  }
  return values;
}

std::unique_ptr<ResultsDirectory> results_of_runs(const RunOptions& options, const Problem& first) {
  const ResultsDirectory::Files inputs = inputs_in(options.directory, first);
  auto directory = options.resumes ? std::make_unique<ResultsDirectory>(options.directory, inputs)
                                   : std::make_unique<ResultsDirectory>(options.directory, options.force, inputs);
  if (options.record && !options.resumes) write_checkpoint(options.directory, {*options.record});
  return directory;
}

SingleResult run_part(const PreparedRun& run, const std::string& directory, const RunOptions& options, int number) {
  if (options.resumes && has_ended(directory)) {
    remove_checkpoint(directory);                               // it may have been killed before it could
    return stored_result(run.problem, directory);
  }
  SingleOptions single{.directory = directory, .force = options.force, .record = options.record, .checkpoint = options.checkpoint, .resumes = options.resumes,
                       .models = run.models};
  if (single.record) single.record->run = number;
  return run_single(run.problem, run.model, single);
}

RunNumbers in_order(const std::vector<std::size_t>& which) {
  return [which, i = std::size_t{0}]() mutable { return i < which.size() ? std::optional(which[i++]) : std::nullopt; };
}

std::vector<std::optional<SingleResult>> run_side_by_side(const std::vector<PreparedRun>& runs, const RunNumbers& next, std::size_t count, const RunOptions& options,
                                                          const std::function<void(std::size_t, const SingleResult&)>& ended) {
  const Stopwatch watch;
  std::vector<std::optional<SingleResult>> results(runs.size());
  std::vector<std::exception_ptr> failures(runs.size());
  std::atomic<std::size_t> finished{0};
  std::mutex printing, asking;
  Progress progress(stdout, Progress::style_for(stdout, options.quiet), 0, static_cast<double>(count));
  const Heartbeat at_work(heartbeat, [&](const auto&) {
    const std::lock_guard lock(printing);
    progress.wait(fmt::format("{} of {} runs after {:.0f} s", finished.load(), count, watch.seconds()));
  });
  const auto work = [&, asked = stop_asked] {
    set_threads(1), stop_asked = asked;
    const auto asked_next = [&] {
      const std::lock_guard lock(asking);
      return next();
    };
    for (std::optional<std::size_t> number; !interrupted() && (number = asked_next());) {
      const std::size_t k = *number;
      const std::string name = run_name(k + 1, runs.size(), runs[k].swept);
      try {
        SingleResult result = run_part(runs[k], options.directory + "/" + name, options, static_cast<int>(k));
        if (ended) ended(k, result);
        const std::lock_guard lock(printing);
        ++finished;
        const std::size_t warnings = result.warnings.size();
        progress.keep(fmt::format("run {} of {}: {}: {}{}", finished.load(), count, name, result.why,
                                  warnings == 0 ? "" : fmt::format(" ({} warning{})", warnings, warnings == 1 ? "" : "s")));
        progress.show("", static_cast<double>(finished.load()));
        results[k] = std::move(result);
      } catch (...) {
        failures[k] = std::current_exception();
      }
    }
  };
  std::vector<std::jthread> workers;
  for (int t = 1; t < std::min<int>(options.threads, static_cast<int>(count)); ++t) workers.emplace_back(work);
  work();
  workers.clear();
  set_threads(options.threads);
  {
    const std::lock_guard lock(printing);
    progress.finish();
  }
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
  return results;
}

std::size_t ended(const std::vector<std::optional<SingleResult>>& results) {
  return static_cast<std::size_t>(std::count_if(results.begin(), results.end(), [](const auto& r) { return r.has_value(); }));
}

Row sweep_row_of(const PreparedRun& run, const SingleResult& result, const Problem& first) {
  return sweep_row(swept_values(run), status_name(result.status), result.path, result.events, first, result.curve);
}

RunResult result_of_runs(const PreparedRuns& prepared, const std::vector<std::optional<SingleResult>>& results, const std::string& directory) {
  RunResult all{interrupted() ? exit_interrupted : exit_done, directory, {}};
  std::vector<RunTables> tables;
  for (const std::optional<SingleResult>& r : results) {
    if (!r) continue;
    all.exit_status = std::max(all.exit_status, exit_status(*r));
    all.verdicts.insert(all.verdicts.end(), r->verdicts.begin(), r->verdicts.end());
    tables.push_back({&r->path, &r->events});
  }
  const PreparedRun& first = prepared.runs.front();
  if (tables.size() == results.size())
    for (const ExpectTable& e : first.together)
      if (e.extrapolate) all.verdicts.push_back(check_extrapolated(first.problem, e, tables));
  return all;
}

namespace {

/// Where all levels of a [refine] are there, what they tell together.
void add_refinement(const PreparedRuns& prepared, const std::vector<std::optional<SingleResult>>& results, ResultsDirectory& directory, bool quiet,
                    RunResult& all) {
  if (!prepared.runs.front().problem.refine || ended(results) < results.size() || interrupted()) return;
  const std::vector<Verdict> verdicts = finish_refinement(prepared, results, directory, quiet);
  all.verdicts.insert(all.verdicts.end(), verdicts.begin(), verdicts.end());
}

}  // namespace

RunResult run_sweep(const PreparedRuns& prepared, const RunOptions& options) {
  const Stopwatch watch;
  const std::vector<PreparedRun>& runs = prepared.runs;
  const Problem& first = runs.front().problem;
  if (!options.force)
    for (std::size_t k = 0; k < runs.size(); ++k) require_results(options.directory + "/" + run_name(k + 1, runs.size(), runs[k].swept));
  const auto directory = results_of_runs(options, first);
  SweepTable table(directory->file("sweep.csv"), sweep_columns(swept_keys(runs.front()), first, prepared.own));
  std::vector<std::size_t> all(runs.size());
  std::iota(all.begin(), all.end(), 0);
  const auto results = run_side_by_side(runs, in_order(all), all.size(), options, [&](std::size_t k, const SingleResult& result) {
    table.add(static_cast<int>(k), sweep_row_of(runs[k], result, first));
  });
  if (ended(results) == runs.size() && !interrupted()) remove_checkpoint(options.directory);
  if (!options.quiet)
    say("{} of {} runs in {:.2f} s\nwritten: {}/sweep.csv\n", ended(results), runs.size(), watch.seconds(), options.directory);
  RunResult all_runs = result_of_runs(prepared, results, options.directory);
  add_refinement(prepared, results, *directory, options.quiet, all_runs);
  return all_runs;
}

namespace {

namespace fs = std::filesystem;

constexpr double lock_patience = 20;                            // seconds, for another part that makes the directory

/// The directory as parts of this sweep share it. The first part makes it; all find the same record in it.
void join(const std::string& directory, const RunRecord& record) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) throw OutputError(fmt::format("{}: cannot be created: {}", directory, error.message()));
  const DirectoryLock lock(directory, lock_patience);
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
  const auto results = run_side_by_side(prepared.runs, in_order(own), own.size(), options);
  RunResult all = result_of_runs(prepared, results, options.directory);
  if (!options.quiet)
    say("{} of {} runs of part {}/{} in {:.2f} s\n", ended(results), own.size(), options.part->number, options.part->of, watch.seconds());
  return all;
}

RunResult run_sweep_by_ranks(const PreparedRuns& prepared, const RunOptions& given) {
  Ranks& all = *ranks();
  struct Closing {                                              // whatever happens: the others wait for it
    Ranks& all;
    ~Closing() { all.close(); }
  } closing{all};
  RunOptions options = given;
  options.resumes = true;
  if (all.rank() == 0) {
    if (!options.record) throw InputError(options.file + ": only a sweep of a problem file can be run by many ranks");
    join(options.directory, *options.record);
    all.release(Ranks::Release::sweep), all.deal(static_cast<int>(prepared.runs.size()));
  }
  const RunNumbers dealt = [&] {
    const std::optional<int> number = all.take();
    return number ? std::optional(static_cast<std::size_t>(*number)) : std::nullopt;
  };
  const auto results = run_side_by_side(prepared.runs, dealt, prepared.runs.size(), options);
  if (all.rank() > 0) return result_of_runs(prepared, results, options.directory);
  all.close();
  return collect({options.directory, options.quiet});
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
  add_refinement(stopped.prepared, results, directory, options.quiet, all);
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
