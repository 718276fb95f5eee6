#include "study/bisection.hpp"

#include "core/heartbeat.hpp"
#include "core/interrupt.hpp"
#include "core/say.hpp"
#include "core/text_file.hpp"
#include "core/timing.hpp"
#include "input/check.hpp"
#include "results/columns.hpp"
#include "results/json.hpp"
#include "results/run_directory.hpp"
#include "results/summary.hpp"
#include "study/single.hpp"
#include "study/sweep.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <map>

namespace elamin {

double Bisection::middle() const {
  const double half = lo + (hi - lo) / 2;
  return integers ? std::trunc(half) : half;
}

bool Bisection::narrow() const {
  const double apart = std::abs(hi - lo);
  return apart <= tolerance || middle() == lo || middle() == hi;
}

std::vector<Setting> Bisection::settings(double value) const {
  std::vector<Setting> all;
  for (const std::string& key : keys) all.push_back({key, integers ? fmt::format("{:.0f}", value) : to_toml(value), place});
  return all;
}

bool bisects(const Sweep& s) { return s.place.keys.count("between") > 0 || s.place.keys.count("bisect") > 0; }

Bisection read_bisection(Sweep& s, const Problem& problem, Mistakes& mistakes) {
  Bisection b;
  b.keys = s.keys, b.observable = s.bisect, b.at = s.at, b.level = s.level;
  if (!s.place.keys.count("between")) {
    mistakes.add(s.place, "bisect", "needs between = [a, b], the values between which the outcome changes");
    return b;
  }
  b.place = s.place.keys.at("between");
  const auto wrong = [&](const std::string& what) { mistakes.add(s.place, "between", what); };
  double ends[2] = {0, 0};
  bool integers = true, numbers = s.between.size() == 2;
  for (std::size_t k = 0; numbers && k < 2; ++k) {
    const Node node = parse_value(s.between[k], b.place);
    const auto* integer = std::get_if<std::int64_t>(&node.value);
    const auto* real = std::get_if<double>(&node.value);
    numbers = integer || (real && std::isfinite(*real));
    integers = integers && integer && std::abs(*integer) < (std::int64_t(1) << 52);
    if (numbers) ends[k] = integer ? static_cast<double>(*integer) : *real;
  }
  if (!numbers) wrong("must be a list of two numbers, between which the outcome changes");
  else if (ends[0] == ends[1]) wrong(fmt::format("has {} twice; the outcome changes between two values", ends[0]));
  b.lo = ends[0], b.hi = ends[1], b.integers = integers;
  b.tolerance = s.tolerance.value_or(1e-3 * std::abs(b.hi - b.lo));

  if (s.bisect.empty()) mistakes.add(s.place, "bisect", "is missing; it must be an observable, whose passing of `level` is the outcome");
  else if (const std::string what = wrong_observable(problem, s.bisect, s.at); !what.empty()) mistakes.add(s.place, "bisect", what);
  if (const std::string what = s.at == at_sweep ? "must be a row of every run" : wrong_at(problem, s.at); !what.empty())
    mistakes.add(s.place, "at", what);
  return b;
}

namespace {

/// On which side of the level the observable of a run is, or that it has none.
enum class Side { below, above, missing };
const char* name_of(Side side) {
  return side == Side::below ? "below" : side == Side::above ? "above" : "missing";
}

/// The runs of a bisection, each made once.
class Halving {
 public:
  Halving(const PreparedRuns& prepared, const RunOptions& options)
      : prepared_(prepared), b_(*prepared.bisection), first_(prepared.runs.front()), options_(options),
        directory_(results_of_runs(options, first_.problem)) {}

  Side run(const PreparedRun& prepared, double value) {
    const std::string name = run_name(++count_, 10, prepared.swept);
    Progress progress(stdout, Progress::style_for(stdout, options_.quiet), 0, 0);
    const Stopwatch watch;
    std::optional<Heartbeat> at_work(std::in_place, heartbeat, [&](const auto&) {
      progress.wait(fmt::format("run {}: {}: at work for {:.0f} s", count_, name, watch.seconds()));
    });
    const SingleResult r = run_part(prepared, options_.directory + "/" + name, options_, RunRecord::not_alone);
    at_work.reset(), progress.finish();
    rows_[value] = sweep_row(swept_values(prepared), status_name(r.status), r.path, r.events, first_.problem);
    status_ = std::max(status_, exit_status(r));
    verdicts_.insert(verdicts_.end(), r.verdicts.begin(), r.verdicts.end());
    write_table();
    // Where a run did not get to its end, its last row is not how it ends.
    std::string why = r.why;
    const bool ended = b_.at != "final" || r.status == Status::converged;
    const auto observed = ended ? value_at(b_.observable, b_.at, {&r.path, &r.events}, why) : std::nullopt;
    const Side outcome = !observed ? Side::missing : *observed > b_.level ? Side::above : Side::below;
    if (!options_.quiet)
      say("run {}: {}: {} at {} {}\n", count_, name, b_.observable, b_.at,
                 observed ? fmt::format("is {:.10g}, {} {:.10g}", *observed, name_of(outcome), b_.level) : "is missing: " + why);
    return outcome;
  }
  Side run(double value) {
    PreparedRun next = prepare_run(prepared_.document, options_.settings, b_.settings(value), prepared_.own);
    next.problem.file = first_.problem.file;
    return run(next, value);
  }

  int count() const { return count_; }
  int status() const { return status_; }
  std::vector<Verdict>& verdicts() { return verdicts_; }
  ResultsDirectory& directory() { return *directory_; }

 private:
  // All rows anew: they stand in the order of the key.
  void write_table() {
    CsvFile table(directory_->file("sweep.csv"), sweep_columns(swept_keys(first_), first_.problem, prepared_.own));
    for (const auto& [value, row] : rows_) table.add(row);
  }

  const PreparedRuns& prepared_;
  const Bisection& b_;
  const PreparedRun& first_;
  const RunOptions& options_;
  std::unique_ptr<ResultsDirectory> directory_;
  int count_ = 0, status_ = exit_done;
  std::map<double, Row> rows_;
  std::vector<Verdict> verdicts_;
};

}  // namespace

RunResult run_bisection(const PreparedRuns& prepared, const RunOptions& options) {
  const Stopwatch watch;
  Bisection b = *prepared.bisection;
  Halving runs(prepared, options);
  const Side at_lo = runs.run(prepared.runs[0], b.lo);
  Side at_hi = interrupted() ? at_lo : runs.run(prepared.runs[1], b.hi);
  const bool changes = at_lo != at_hi;
  while (changes && !b.narrow() && !interrupted()) {
    const double middle = b.middle();
    const Side here = runs.run(middle);
    if (interrupted()) break;
    if (here == at_lo) b.lo = middle;
    else b.hi = middle, at_hi = here;
  }

  RunResult result{interrupted() ? exit_interrupted : std::max<int>(runs.status(), changes ? exit_done : exit_not_converged),
                   options.directory, std::move(runs.verdicts())};
  std::optional<std::array<double, 2>> threshold;
  if (changes) threshold = {std::min(b.lo, b.hi), std::max(b.lo, b.hi)};
  for (const ExpectTable& e : prepared.runs.front().together)
    result.verdicts.push_back(check_threshold(prepared.runs.front().problem, e, threshold));

  const std::string keys = fmt::format("{}", fmt::join(b.keys, ", "));
  const std::string message =
      interrupted() ? "interrupted"
      : changes && (at_lo == Side::missing || at_hi == Side::missing)
          ? fmt::format("{} at {} is missing with {} = {:.17g} and there with {:.17g}", b.observable, b.at, keys,
                        at_lo == Side::missing ? b.lo : b.hi, at_lo == Side::missing ? b.hi : b.lo)
      : changes     ? fmt::format("{} at {} passes {:.10g} for {} between {:.17g} ({}) and {:.17g} ({})", b.observable, b.at, b.level,
                                  keys, b.lo, name_of(at_lo), b.hi, name_of(at_hi))
                    : fmt::format("{} at {} is {} at both ends, {} = {:.10g} and {:.10g}; there is no threshold to find between",
                                  b.observable, b.at, name_of(at_lo), keys, b.lo, b.hi);
  Json all;
  all["status"] = interrupted() ? "interrupted" : changes ? "done" : "not_converged";
  all["message"] = message;
  all["key"] = b.keys, all["observable"] = b.observable, all["at"] = b.at, all["level"] = b.level;
  all["tolerance"] = b.tolerance;
  all["threshold"] = nullptr;
  if (threshold) all["threshold"] = *threshold;
  all["outcomes"] = b.lo < b.hi ? std::array{name_of(at_lo), name_of(at_hi)} : std::array{name_of(at_hi), name_of(at_lo)};
  all["runs"] = runs.count();
  all["times"] = {{"total", watch.seconds()}};
  all["version"] = version();
  all["input"] = options.file, all["input_sha256"] = prepared.runs.front().problem.sha256;
  write_text(runs.directory().file("summary.json"), file_text(all));
  if (!interrupted()) remove_checkpoint(options.directory);
  if (!options.quiet)
    say("{}\n{} runs in {:.2f} s\nwritten: {}/sweep.csv\n", message, runs.count(), watch.seconds(), options.directory);
  else if (!changes) complain("{}\n", message);
  return result;
}

}  // namespace elamin
