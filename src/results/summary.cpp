#include "results/summary.hpp"

#include "core/text_file.hpp"
#include "results/json.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include <unistd.h>

namespace elamin {
namespace {

Json object(const Table& table, const Row& row) {
  Json all = Json::object();
  for (std::size_t i = 0; i < row.size(); ++i) all[table.columns[i]] = json_of(row[i]);
  return all;
}

std::string unfinished(const std::string& title, const std::string& status, const std::string& message) {
  Json all;
  all["status"] = status;
  all["message"] = message;
  all["title"] = title;
  all["process"] = getpid();
  all["started"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
  all["version"] = version();
  return file_text(all);
}

}  // namespace

std::string status_name(Status status) {
  switch (status) {
    case Status::converged: return "done";
    case Status::not_converged: return "not_converged";
    case Status::interrupted: return "interrupted";
  }
  return "not_converged";
}

std::string version() { return ELAMIN_VERSION; }

void write_running(const std::string& file, const std::string& title) {
  write_text(file, unfinished(title, "running", "not ended yet, or stopped where it could not say so; then elamin resume goes on"));
}

void write_broken_off(const std::string& file, const std::string& title, const std::string& message) {
  write_over(file, unfinished(title, status_name(Status::interrupted), message));
}

void write_summary(const std::string& file, const Summary& summary, const Table& path, const Table& events, const Table& curve) {
  Json all;
  all["title"] = summary.title;
  all["status"] = summary.status;
  all["message"] = summary.message;
  all["warnings"] = summary.warnings;
  all["points"] = path.rows.size();
  all["events"] = Json::array();
  for (const Row& row : events.rows) all["events"].push_back(object(events, row));
  if (!curve.rows.empty()) {
    all["curve"] = {{"points", curve.rows.size()}, {"special", Json::array()}};
    const auto label = static_cast<std::size_t>(curve.column("label"));
    for (const Row& row : curve.rows)
      if (row[label] != Cell("")) all["curve"]["special"].push_back(object(curve, row));
  }
  all["final"] = path.rows.empty() ? Json(nullptr) : object(path, path.rows.back());
  all["zero_modes"] = summary.zero_modes;
  all["times"] = object(summary.times);
  const FactorCounts& counts = summary.factorizations;
  all["factorizations"] = {{"points", counts.of[0]}, {"events", counts.of[1]}, {"snaps", counts.of[2]}, {"refused", counts.refused}};
  all["version"] = version();
  all["input"] = summary.input;
  all["input_sha256"] = summary.input_sha256;
  all["tolerances"] = object(summary.tolerances);
  if (const auto& c = summary.check) {
    all["check"] = {{"verdict", c->passed ? "passed" : "failed"}, {"residual", json_of(c->residual)}, {"energy_error", json_of(c->energy_error)},
                    {"directions", c->directions}};
    if (!c->passed) all["check"]["what"] = c->what;
  }
  if (summary.resumed > 0) all["resumed"] = summary.resumed;
  if (summary.imperfection > 0) all["imperfection"] = {{"max_displacement", json_of(summary.imperfection)}};
  write_to_disk(file, file_text(all));
}

}  // namespace elamin
