#include "study/run.hpp"

#include "core/interrupt.hpp"
#include "core/parallel.hpp"
#include "core/timing.hpp"
#include "problem/sweep.hpp"
#include "results/columns.hpp"
#include "results/summary.hpp"
#include "results/sweep_table.hpp"
#include "study/single.hpp"

#include <fmt/format.h>

#include <atomic>
#include <filesystem>
#include <thread>

namespace elamin {

namespace {

using Settings = std::vector<Setting>;

std::string default_directory(const std::string& file) {
  std::filesystem::path path(file);
  if (path.extension() == ".toml") return path.replace_extension().string();
  return file + ".results";
}

int cores() { return std::max(1, static_cast<int>(std::thread::hardware_concurrency())); }

// The name of a run's directory: its number and what is swept (but for expected values), the last word of each key.
constexpr std::size_t longest_name = 120;
std::string run_name(std::size_t number, std::size_t runs, const Settings& swept) {
  std::string name = fmt::format("{:0{}}", number + 1, fmt::formatted_size("{}", runs));
  for (const Setting& s : swept) {
    if (s.key.starts_with("expect")) continue;
    std::string part = "_" + s.key.substr(s.key.rfind('.') + 1) + "=";
    for (const char c : s.value) part += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '+' ? c : '_';
    if (name.size() + part.size() > longest_name) break;        // the number tells the runs apart anyway
    name += part;
  }
  return name;
}

// A swept value as it stands in sweep.csv: a number where it is one.
Cell cell_of(const std::string& value) {
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  return end && *end == 0 && !value.empty() ? Cell(number) : Cell(value);
}

RunResult run_one(const PreparedRun& run, const RunOptions& options, const std::string& directory) {
  const SingleResult result = run_single(run.problem, run.model, directory, Progress::style_for(stdout, options.quiet));
  if (!options.quiet) {
    fmt::print("{}", closing_table(result.events));
    for (const std::string& name : result.zero_modes) fmt::print("free at the end: {}\n", name);
    fmt::print("{}: {}\nwritten: {}\n", status_name(result.status), result.why, directory);
  } else if (result.status != Status::converged) {
    fmt::print(stderr, "{}: {}\n", status_name(result.status), result.why);
  }
  return {exit_status(result), directory, result.verdicts};
}

RunResult run_sweep(const std::vector<PreparedRun>& runs, const RunOptions& options, const std::string& directory) {
  const Stopwatch watch;
  std::filesystem::create_directories(directory);
  std::vector<std::string> keys;
  for (const Setting& s : runs.front().swept) keys.push_back(s.key);
  SweepTable table(directory + "/sweep.csv", sweep_columns(keys, observable_columns(runs.front().problem)));

  std::vector<SingleResult> results(runs.size());
  std::vector<std::exception_ptr> failures(runs.size());
  std::atomic<std::size_t> next{0}, finished{0};
  std::mutex printing;
  const auto work = [&] {
    set_threads(1);
    for (std::size_t k; (k = next++) < runs.size() && !interrupted();) {
      try {
        results[k] = run_single(runs[k].problem, runs[k].model, directory + "/" + run_name(k, runs.size(), runs[k].swept), Progress::Style::silent);
        std::vector<Cell> values;
        for (const Setting& s : runs[k].swept) values.push_back(cell_of(s.value));
        table.add(static_cast<int>(k), sweep_row(values, status_name(results[k].status), results[k].path, results[k].events));
      } catch (...) {
        failures[k] = std::current_exception();
      }
      const std::lock_guard lock(printing);
      ++finished;
      if (!options.quiet)
        fmt::print("run {} of {}: {}: {}\n", finished.load(), runs.size(), run_name(k, runs.size(), runs[k].swept), results[k].why);
    }
  };
  std::vector<std::thread> workers;
  for (int t = 1; t < std::min<int>(options.threads, static_cast<int>(runs.size())); ++t) workers.emplace_back(work);
  work();
  for (std::thread& w : workers) w.join();
  set_threads(options.threads);
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);

  RunResult result{interrupted() ? exit_interrupted : exit_done, directory, {}};
  for (const SingleResult& r : results) {
    result.exit_status = std::max(result.exit_status, exit_status(r));
    result.verdicts.insert(result.verdicts.end(), r.verdicts.begin(), r.verdicts.end());
  }
  if (!options.quiet)
    fmt::print("{} of {} runs in {:.2f} s\nwritten: {}/sweep.csv\n", finished.load(), runs.size(), watch.seconds(), directory);
  return result;
}

}  // namespace

RunResult run(const RunOptions& given) {
  RunOptions options = given;
  if (options.threads <= 0) options.threads = cores();
  set_threads(options.threads);
  const std::string directory = options.directory.empty() ? default_directory(options.file) : options.directory;
  const std::vector<PreparedRun> runs = prepare_runs(options.file, options.settings);
  return runs.size() == 1 && runs.front().swept.empty() ? run_one(runs.front(), options, directory) : run_sweep(runs, options, directory);
}

}  // namespace elamin
