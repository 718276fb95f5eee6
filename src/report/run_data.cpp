#include "report/run_data.hpp"

#include "core/error.hpp"
#include "core/text.hpp"
#include "input/read.hpp"
#include "results/expectations.hpp"
#include "study/commands.hpp"
#include "study/imperfection.hpp"

#include <filesystem>
#include <utility>

namespace elamin {

namespace {

Json table_data(const Table& table) {
  Json values = Json::array();
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    Json column = Json::array();
    for (const Row& row : table.rows) column.push_back(json_of(row[c]));
    values.push_back(std::move(column));
  }
  return {{"columns", table.columns}, {"values", std::move(values)}};
}

/// The problem file, if it is still the one that was run.
Json input_text(const Summary& summary) {
  try {
    const std::string text = read_text(summary.input);
    return sha256(text) == summary.input_sha256 ? Json(text) : Json(nullptr);
  } catch (const InputError&) {
    return nullptr;
  }
}

Json expected_data(const Problem& problem, const StoredRun& run) {
  Json all = Json::array();
  const std::vector<Verdict> verdicts = check_expectations(problem, run.path, run.events, run.curve, run.landscape);
  for (std::size_t k = 0; k < problem.expect.size(); ++k) {
    const ExpectTable& e = problem.expect[k];
    std::string why;
    const auto found = value_at(e.observable, e.at, {&run.path, &run.events, &run.curve, &run.landscape}, why);
    all.push_back({{"column", e.observable}, {"at", e.at}, {"value", found ? Json(*found) : Json(why)}, {"expected", e.value},
                   {"allowed", e.rtol * std::abs(e.value) + e.atol}, {"met", verdicts[k].met}, {"source", e.source}});
  }
  return all;
}

void add_summary(const StoredRun& run, Json& j) {
  const Summary s = run.summary.value_or(Summary{});
  j["title"] = s.title;
  j["status"] = run.summary ? s.status : "interrupted";
  j["message"] = run.summary ? s.message : "the run has not ended, or was killed: it wrote no summary.json";
  j["warnings"] = s.warnings;
  j["version"] = run.version;
  j["input"] = {{"file", s.input}, {"sha256", s.input_sha256}, {"text", input_text(s)}};
  j["tolerances"] = object(s.tolerances), j["times"] = object(s.times), j["zero_modes"] = s.zero_modes;
}

}  // namespace

Json table_data(const std::string& file) { return table_data(read_table(file)); }

Json run_data(const std::string& directory, std::size_t most_bytes) {
  const StoredRun run = read_run(directory);
  const std::string resolved = (std::filesystem::path(directory) / "resolved.toml").string();
  Json j{{"directory", directory}};
  add_summary(run, j);
  j["resolved"] = read_text(resolved);
  j["in_time"] = run.in_time;
  j["path"] = table_data(run.path), j["events"] = table_data(run.events);
  if (const std::string file = (std::filesystem::path(directory) / "landscape.json").string(); std::filesystem::exists(file))
    j["landscape"] = Json::parse(read_text(file), nullptr, false);
  j["described"] = "", j["expected"] = Json::array();
  try {
    const Problem problem = read_problem(resolved);
    if (j["title"] == "") j["title"] = problem.title;
    j["expected"] = expected_data(problem, run);
    if (problem.curve) j["curve"] = table_data(run.curve), j["curve"]["of"] = problem.curve->of, j["curve"]["second"] = problem.curve->second;
    Model model = model_of(problem);
    j["described"] = describe(problem, model);
    const std::vector<RunStage> stages = stages_of(run, problem, model);
    j["structure"] = structure_data(model, stages);
    j["states"] = states_data(run, stages, model, most_bytes);
  } catch (const InputError& error) {
    j["no_shape"] = error.what();
  }
  return j;
}

}  // namespace elamin
