#include "results/expectations.hpp"

#include "input/check.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elamin {
namespace {

struct Found { const Table* table = nullptr; const Row* row = nullptr; };

Found labelled(const Table& table, const std::string& label) {
  const int column = table.column("label");
  for (const Row& row : table.rows)
    if (column >= 0 && row[column] == Cell(label)) return {&table, &row};
  return {};
}

Found at_value(const Table& table, const char* name, double wanted) {
  const int column = table.column(name);
  Found found;
  for (const Row& row : table.rows)
    if (const auto value = as_number(row[column]); value && std::abs(*value - wanted) <= 1e-12 * std::abs(wanted))
      found = {&table, &row};
  return found;
}

std::string labels_in(const Table& table) {
  const int column = table.column("label");
  std::vector<std::string> labels;
  for (const Row& row : table.rows)
    if (const std::string label = csv_text(row[column]); !label.empty()) labels.push_back(label);
  return labels.empty() ? "none" : listed(labels);
}

Found on_curve(const std::string& at, const Table* curve, std::string* why) {
  if (!curve || curve->rows.empty()) return *why = "the run has no curve", Found{};
  const std::optional<double> second = second_of(at);
  const Found found = second ? at_value(*curve, "second", *second) : labelled(*curve, at.substr(at.find('.') + 1));
  if (!found.row) *why = second ? "the curve does not get there" : "nothing of that is on the curve; there are: " + labels_in(*curve);
  return found;
}

Found in_landscapes(const std::string& at, const Table* table, std::string* why) {
  const auto place = in_landscape(at);
  if (!table || table->rows.empty() || !place) return *why = "the run has no landscape", Found{};
  const int label = table->column("label"), lambda = table->column("lambda");
  std::optional<double> load = place->load_factor;                 // by default that of the last graph
  if (!load && !place->label.starts_with("change:"))
    for (const Row& row : table->rows)
      if (row[label] == Cell("graph")) load = as_number(row[lambda]);
  for (const Row& row : table->rows)
    if (row[label] == Cell(place->label) && (!load || as_number(row[lambda]) == load)) return {table, &row};
  *why = "nothing of that is in the landscape; there are: " + labels_in(*table);
  return {};
}

/// The row that `at` means; else *why says what there is.
Found find(const std::string& at, const Table& path, const Table& events, std::string* why) {
  if (path.rows.empty()) return *why = "the run has no equilibrium", Found{};
  if (at == "initial") return {&path, &path.rows.front()};
  if (at == "final") return {&path, &path.rows.back()};
  if (const auto step = step_of(at)) {
    const int column = path.column("step");
    for (const Row& row : path.rows)
      if (row[column] == Cell(*step)) return {&path, &row};
    return *why = "the motion has no such step; the last one is " + csv_text(path.rows.back()[column]), Found{};
  }
  if (at.starts_with("lambda=")) {
    const auto lambda = load_factor_of(at);
    if (!lambda) return *why = "what follows \"lambda=\" is not a number", Found{};
    const Found found = at_value(path, "lambda", *lambda);
    if (!found.row) *why = fmt::format("no equilibrium of the path has this load factor; the last one has {}",
                                       csv_text(path.rows.back()[path.column("lambda")]));
    return found;
  }
  for (const Table* table : {&events, &path})
    if (const Found found = labelled(*table, at); found.row) return found;
  if (const int stage = path.column("stage"); stage >= 0)
    for (auto row = path.rows.rbegin(); row != path.rows.rend(); ++row)
      if ((*row)[stage] == Cell(at)) return {&path, &*row};
  *why = "there is no such event; there are: " + labels_in(events);
  return {};
}

/// "file:line:column: column at row", which a sentence begins with.
std::string what_of(const Problem& problem, const ExpectTable& e) {
  return fmt::format("{}:{}:{}: {} at {}", problem.file, e.place.line, e.place.column, e.observable, e.at);
}

Verdict held(const std::string& what, double value, const ExpectTable& e, const std::string& besides = "") {
  const double off = std::abs(value - e.value), allowed = e.rtol * std::abs(e.value) + e.atol;
  return {fmt::format("{} is {:.17g}, expected {:.17g}: off by {:.2g}, {:.2g} allowed{}", what, value, e.value, off, allowed,
                      besides), off <= allowed};
}

}  // namespace

std::optional<double> value_at(const std::string& name, const std::string& at, const RunTables& run, std::string& why) {
  const Found found = is_of_curve(at)       ? on_curve(at, run.curve, &why)
                      : is_of_landscape(at) ? in_landscapes(at, run.landscape, &why)
                                            : find(at, *run.path, *run.events, &why);
  if (!found.row) return std::nullopt;
  const int column = found.table->column(name);
  if (column < 0) return why = "there is no such column; there are: " + listed(found.table->columns), std::nullopt;
  const auto value = as_number((*found.row)[column]);
  if (!value) why = "has no number there";
  return value;
}

Verdict check_extrapolated(const Problem& problem, const ExpectTable& e, const std::vector<RunTables>& runs) {
  const std::string what = fmt::format("{}, extrapolated over {} runs,", what_of(problem, e), runs.size());
  std::vector<double> row;                             // R_i0, R_i1, …
  double before = 0;                                   // the last of the row before
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::string why;
    const auto value = value_at(e.observable, e.at, runs[i], why);
    if (!value) return {fmt::format("{} in run {}: {}", what, i + 1, why), false};
    std::vector<double> next{*value};
    double weight = 1;
    for (const double r : row) {
      weight *= e.extrapolate == 1 ? 2 : 4;
      next.push_back((weight * next.back() - r) / (weight - 1));
    }
    before = row.empty() ? *value : row.back();
    row = std::move(next);
  }
  return held(what, row.back(), e, fmt::format("; {:.2g} from the runs without the last", std::abs(row.back() - before)));
}

Verdict check_threshold(const Problem& problem, const ExpectTable& e, std::optional<std::array<double, 2>> threshold) {
  if (!threshold) return {what_of(problem, e) + ": the outcome is the same at both ends", false};
  return held(what_of(problem, e), (*threshold)[0] + ((*threshold)[1] - (*threshold)[0]) / 2, e);
}

std::vector<Verdict> check_expectations(const Problem& problem, const Table& path, const Table& events, const Table& curve, const Table& landscape) {
  std::vector<Verdict> verdicts;
  for (const ExpectTable& e : problem.expect) {
    std::string why;
    const auto value = value_at(e.observable, e.at, {&path, &events, &curve, &landscape}, why);
    verdicts.push_back(value ? held(what_of(problem, e), *value, e) : Verdict{what_of(problem, e) + ": " + why, false});
  }
  return verdicts;
}

}  // namespace elamin
