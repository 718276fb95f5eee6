#include "results/expectations.hpp"

#include "problem/suggest.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace elamin {
namespace {

struct Found { const Table* table = nullptr; const Row* row = nullptr; };

Found labelled(const Table& table, const std::string& label) {
  const int column = column_index(table.columns, "label");
  for (const Row& row : table.rows)
    if (column >= 0 && row[column] == Cell(label)) return {&table, &row};
  return {};
}

Found at_load_factor(const Table& path, double lambda) {
  const int column = column_index(path.columns, "lambda");
  Found found;
  for (const Row& row : path.rows)
    if (const auto value = as_number(row[column]); value && std::abs(*value - lambda) <= 1e-12 * std::abs(lambda))
      found = {&path, &row};
  return found;
}

std::string event_labels(const Table& events) {
  std::vector<std::string> labels;
  for (const Row& row : events.rows) labels.push_back(csv_text(row[0]));
  return labels.empty() ? "none" : listed(labels);
}

/// The row that `at` means; else *why says what there is.
Found find(const std::string& at, const Table& path, const Table& events, std::string* why) {
  if (path.rows.empty()) return *why = "the run has no equilibrium", Found{};
  if (at == "initial") return {&path, &path.rows.front()};
  if (at == "final") return {&path, &path.rows.back()};
  const std::string prefix = "lambda=";
  if (at.rfind(prefix, 0) == 0) {
    double lambda = 0;
    const char* end = at.data() + at.size();
    const auto [stop, error] = std::from_chars(at.data() + prefix.size(), end, lambda);
    if (error != std::errc{} || stop != end || !std::isfinite(lambda))
      return *why = "what follows \"lambda=\" is not a number", Found{};
    const Found found = at_load_factor(path, lambda);
    if (!found.row) *why = fmt::format("no equilibrium of the path has this load factor; the last one has {}",
                                       csv_text(path.rows.back()[column_index(path.columns, "lambda")]));
    return found;
  }
  for (const Table* table : {&events, &path})
    if (const Found found = labelled(*table, at); found.row) return found;
  *why = "there is no such event; there are: " + event_labels(events);
  return {};
}

}  // namespace

std::vector<Verdict> check_expectations(const Problem& problem, const Table& path, const Table& events) {
  std::vector<Verdict> verdicts;
  for (const ExpectTable& e : problem.expect) {
    Verdict v;
    const std::string what =
        fmt::format("{}:{}:{}: {} at {}", problem.file, e.place.line, e.place.column, e.observable, e.at);
    std::string why;
    const Found found = find(e.at, path, events, &why);
    const int column = found.row ? column_index(found.table->columns, e.observable) : -1;
    const auto value = column >= 0 ? as_number((*found.row)[column]) : std::nullopt;
    if (!found.row) {
      v.sentence = fmt::format("{}: {}", what, why);
    } else if (column < 0) {
      v.sentence = fmt::format("{}: there is no such column; there are: {}", what, listed(found.table->columns));
    } else if (!value) {
      v.sentence = fmt::format("{}: has no number there", what);
    } else {
      const double off = std::abs(*value - e.value), allowed = e.rtol * std::abs(e.value) + e.atol;
      v.met = off <= allowed;
      v.sentence = fmt::format("{} is {:.17g}, expected {:.17g}: off by {:.2g}, {:.2g} allowed", what, *value, e.value,
                               off, allowed);
    }
    verdicts.push_back(std::move(v));
  }
  return verdicts;
}

}  // namespace elamin
