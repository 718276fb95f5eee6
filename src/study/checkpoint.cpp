#include "study/checkpoint.hpp"

#include "core/interrupt.hpp"
#include "core/text.hpp"
#include "core/error.hpp"
#include "core/text_file.hpp"
#include "results/run_directory.hpp"
#include "study/prepare.hpp"

#include <fmt/format.h>

#include <fstream>
#include <iterator>
#include <map>

namespace elamin {

extern const char* const fingerprint_of_sources;                // made by fingerprint.cmake

namespace {

namespace fs = std::filesystem;

constexpr double largest_part = 0.01;                           // of the time of a run, that keeping what is carried may take, and writing it

constexpr std::size_t digits = 64;                              // of a SHA-256

std::string heading() { return fmt::format("elamin {} checkpoint\n", version()); }
// What its bytes mean depends on the sources, and the bits that follow on the compiler.
std::string second_line() { return fmt::format("build {}\n", build_fingerprint()); }

std::string text_of(Checkpoint& c) {
  Archive archive;
  archive(c.record, c.phase, c.resumed, c.state);
  return heading() + second_line() + sha256(archive.bytes()) + "\n" + archive.bytes();
}

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

std::string build_fingerprint() { return fingerprint_of_sources; }

std::optional<RunRecord> record_of(const Document& document, const std::vector<Setting>& settings, bool report,
                                   const std::vector<std::pair<std::string, std::string>>& inputs) {
  std::error_code error;
  if (!fs::is_regular_file(document.file, error)) return {};
  RunRecord record{document.file, "", bytes_of(document.file), {}, report, RunRecord::all, inputs};
  if (sha256(record.text) != document.sha256) return {};
  for (const Setting& s : settings) record.settings.emplace_back(s.key, s.value);
  return record;
}

std::vector<std::pair<std::string, std::string>> input_hashes(const PreparedRuns& prepared) {
  std::map<std::string, std::string> known;
  std::vector<std::pair<std::string, std::string>> all;
  for (const PreparedRun& run : prepared.runs)
    for (const std::string& file : inputs_of(run.problem))
      if (const auto [hash, is_new] = known.try_emplace(file); is_new) all.emplace_back(file, hash->second = sha256(bytes_of(file)));
  return all;
}

std::optional<Checkpoint> read_checkpoint(const std::string& directory) {
  const std::string file = checkpoint_file(directory);
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return {};
  const std::string all = bytes_of(file), first = heading();
  if (!all.starts_with(first)) throw InputError(fmt::format("{}: is no checkpoint of elamin {}; a run goes on with the version that began it", file, version()));
  const std::string second = second_line();
  if (all.compare(first.size(), second.size(), second) != 0)
    throw InputError(fmt::format("{}: is a checkpoint of another build of elamin {}; a run goes on with the build that began it", file, version()));
  const std::size_t sum = first.size() + second.size(), begin = sum + digits + 1;
  if (all.size() < begin || all.compare(sum, digits, sha256(all.substr(begin))) != 0)
    throw InputError(file + ": is not whole or damaged: its bytes have not the checksum that stands in it; run the problem again");
  Checkpoint c;
  Archive archive(all.substr(begin));
  archive(c.record, c.phase, c.resumed, c.state);
  return c;
}

void write_checkpoint(const std::string& directory, Checkpoint c) {
  const fs::path folder = located(c.record.file).parent_path();
  c.record.folder = fs::path(folder).lexically_proximate(located(directory)).string();
  const std::string text = text_of(c);
  if (c.phase == Phase::begun) return write_text(checkpoint_file(directory), text);
  flush_to_disk(directory);
  write_to_disk(checkpoint_file(directory), text);
}

void remove_checkpoint(const std::string& directory) {
  std::error_code error;
  fs::remove(checkpoint_file(directory), error);
}

Checkpointing::Checkpointing(RunDirectory& results, std::optional<RunRecord> record, double every, int resumed)
    : results_(results), any_(record.has_value()), every_(every) {
  if (!any_) return;
  latest_.record = std::move(*record), latest_.resumed = resumed;
}

void Checkpointing::offer(const std::function<void(Archive&)>& carry) {
  const double most = every_ > 0 ? largest_part * elapsed_.seconds() : infinity;
  if (!any_ || (keeping_ > most && !interrupted())) return;
  results_.keep_dropped_frames();                               // what is kept, in memory too, speaks of them
  const auto keep = [&] {
    const Timed timed(keeping_);
    Archive archive;
    carry(archive);
    latest_.state = std::string(archive.bytes());               // no longer than it is: strings that are assigned to grow to twice as much
    latest_.phase = Phase::going, kept_ = true;
  };
  keep();
  if (since_.seconds() < every_ || writing_ > most) return;
  const Timed timed(writing_);
  if (!results_.settled()) write(Phase::dropping), results_.settle(), keep();
  write(Phase::going);
  std::string().swap(latest_.state), kept_ = false;             // what is on the disk needs no memory
  since_ = Stopwatch();
}

void Checkpointing::replace(std::string state) {
  if (!any_) return;
  latest_.state = std::move(state);
  write(Phase::going);
}

void Checkpointing::write(Phase phase) {
  latest_.phase = phase;
  write_checkpoint(results_.directory(), latest_);
  written_ = true;
}

void Checkpointing::stop() {
  if (kept_) write(latest_.phase);
}

void Checkpointing::try_to_stop() {
  try {
    stop();
  } catch (const OutputError&) {                                // the one before it stays
  }
}

void Checkpointing::end(const std::function<void(Archive&)>& carry) {
  if (!any_) return;
  Archive archive;
  carry(archive);
  latest_.state = archive.bytes(), latest_.phase = Phase::ending, kept_ = true;
  if (written_) write(Phase::ending);
}

void Checkpointing::remove() { remove_checkpoint(results_.directory()); }

}  // namespace elamin
