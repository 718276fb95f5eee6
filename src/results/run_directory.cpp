#include "results/run_directory.hpp"

#include "core/error.hpp"
#include "results/columns.hpp"
#include "results/lammps_state.hpp"
#include "results/text_file.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cctype>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <filesystem>

namespace elamin {
namespace {

namespace fs = std::filesystem;

std::string place(const std::string& directory, const std::string& name) {
  return (fs::path(directory) / name).string();
}

/// Creates the directory, or empties one of an earlier run of its results.
std::string prepared(const std::string& directory, const std::string& resolved_toml) {
  const std::string states = place(directory, "states");
  std::error_code error;
  fs::create_directories(states, error);
  if (error) throw InputError(fmt::format("{}: cannot be created: {}", directory, error.message()));
  if (fs::exists(place(directory, "resolved.toml"))) {
    fs::remove(place(directory, "summary.json"), error);
    for (const auto& entry : fs::directory_iterator(states, error))
      if (entry.path().extension() == ".data") fs::remove(entry.path(), error);
  }
  write_text(place(directory, "resolved.toml"), resolved_toml);
  return directory;
}

}  // namespace

RunDirectory::RunDirectory(std::string directory, const Problem& problem, const Model& model,
                           const std::string& resolved_toml)
    : record_(problem, model),
      model_(model),
      directory_(prepared(directory, resolved_toml)),
      title_(problem.title),
      log_(place(directory_, "log.txt"), std::ios::binary),
      path_(place(directory_, "path.csv"), record_.path().columns),
      events_(place(directory_, "events.csv"), record_.events().columns) {}

void RunDirectory::add(const PathPoint& point, const Field& forces) {
  record_.add(point, forces);
  path_.add(record_.path().rows.back());
  if (is_event(point.label)) events_.add(record_.events().rows.back());
  if (!point.label.empty())
    write_state(state_file(point.label), model_, point.state,
                fmt::format("{}; {}; load factor {:.17g}", title_.empty() ? "elamin" : title_, point.label,
                            point.state.load_factor));
}

void RunDirectory::log(const std::string& line) {
  std::tm local{};
  const std::time_t now = std::time(nullptr);
  localtime_r(&now, &local);
  log_ << fmt::format("{:%Y-%m-%d %H:%M:%S} {}\n", local, line) << std::flush;
  if (!log_)
    throw InputError(fmt::format("{}: cannot be written: {}", place(directory_, "log.txt"), std::strerror(errno)));
}

void RunDirectory::finish(const Summary& summary) {
  write_summary(place(directory_, "summary.json"), summary, record_.path(), record_.events());
}

std::string RunDirectory::state_file(const std::string& label) const {
  std::string name = label;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_') c = '-';
  return place(place(directory_, "states"), name + ".data");
}

}  // namespace elamin
