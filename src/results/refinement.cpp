#include "results/refinement.hpp"

#include "core/find.hpp"
#include "results/columns.hpp"
#include "results/json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <ranges>

namespace elamin {
namespace {

/// Equilibria are computed to rounding, which is more than ε where structures are slender: of a value, or of what is usual in its column.
constexpr double rounding_of_values = 1e-11;

std::string name_of(Approach approach) { return std::array{"asymptotic", "rounding", "not asymptotic", "none"}[static_cast<std::size_t>(approach)]; }

double last_change(const std::vector<double>& f) { return std::abs(f.back() - f[f.size() - 2]); }

/// The number in a column at `at` of each of the runs.
std::vector<std::optional<double>> values_at(const std::string& column, const std::string& at, const std::vector<RunTables>& runs) {
  std::string why;
  std::vector<std::optional<double>> values;
  for (const RunTables& run : runs) values.push_back(value_at(column, at, run, why));
  return values;
}

/// Events that all levels have, in the order of the last one; what the others are is remarked.
std::vector<std::string> common_events(const std::vector<RunTables>& runs, std::vector<std::string>& remarks) {
  std::vector<std::string> common, all;
  std::map<std::vector<std::size_t>, std::vector<std::string>> missing;    // by the levels where they are
  for (const RunTables& run : std::views::reverse(runs))
    for (const Row& row : run.events->rows)
      if (const std::string label = csv_text(row[run.events->column("label")]); !contains(all, label)) all.push_back(label);
  for (const std::string& label : all) {
    const auto differs = [&](const char* column) {
      const auto numbers = values_at(column, label, runs);
      return std::ranges::count(numbers, numbers[0]) < std::ssize(numbers);
    };
    const auto shown = [](const std::optional<double>& number) { return number ? fmt::format("{}", *number) : "none"; };
    const auto loads = values_at("lambda", label, runs);
    std::vector<std::size_t> in;
    for (std::size_t k = 0; k < runs.size(); ++k)
      if (loads[k]) in.push_back(k + 1);
    constexpr std::array told{"multiplicity", "negative_before", "negative_after"};
    const auto unlike = std::ranges::find_if(told, differs);
    if (in.size() < runs.size()) missing[in].push_back(label);
    else if (unlike == told.end()) common.push_back(label);
    else remarks.push_back(fmt::format("{} is not the same at all levels: {} is {}", label, *unlike,
                                       fmt::join(values_at(*unlike, label, runs) | std::views::transform(shown), ", ")));
  }
  for (const auto& [in, labels] : missing)
    remarks.push_back(fmt::format("at level {} alone, and not compared: {}", fmt::join(in, ", "), fmt::join(labels, ", ")));
  return common;
}

/// The median of the sizes in a column.
double usual_in(const Table& table, const std::string& column) {
  std::vector<double> sizes;
  const int c = table.column(column);
  for (const Row& row : table.rows)
    if (const auto value = c < 0 ? std::nullopt : as_number(row[c])) sizes.push_back(std::abs(*value));
  if (sizes.empty()) return 0;
  const auto middle = sizes.begin() + std::ssize(sizes) / 2;
  std::ranges::nth_element(sizes, middle);
  return *middle;
}

}  // namespace

Extrapolated extrapolate(const std::vector<double>& values, double by, double rounding) {
  Extrapolated limit{values.back(), {}, {}, Approach::none};
  const double least = 3 * rounding;
  if (last_change(values) <= least) {
    limit.approach = Approach::rounding, limit.error = std::max(least, last_change(values));
    return limit;
  }
  std::vector<double> f = values;
  double before = 0, first = 0;                                // the orders that have been taken out last, and first
  while (f.size() >= 3) {
    const double ratio = (f[f.size() - 2] - f[f.size() - 3]) / (f.back() - f[f.size() - 2]), observed = std::log(ratio) / std::log(by);
    if (before == 0 && ratio > 0) limit.order = observed;
    const double q = ratio > 0 ? std::round(observed) : 0;
    const bool by_chance = before > 0 && q > before + first;   // two terms nearly cancel: the next order is no higher than that
    if (last_change(f) <= least || !(q > before) || std::abs(observed - q) > order_within || by_chance) {
      if (before > 0) break;
      if (std::abs(ratio) >= 1 + (by - 1) / 3) limit.approach = Approach::not_asymptotic, limit.error = 3 * last_change(f) / (by - 1);
      return limit;
    }
    std::vector<double> next;
    for (std::size_t k = 1; k < f.size(); ++k) next.push_back(f[k] + (f[k] - f[k - 1]) / (std::pow(by, q) - 1));
    f = std::move(next), first = before == 0 ? q : first, before = q;
  }
  double error = last_change(f);                               // of a sequence whose differences fall by halves or more it is a bound
  if (f.size() > 2) {
    const double change_before = std::abs(f[f.size() - 2] - f[f.size() - 3]);
    error = std::max(error, error >= change_before / 2 ? change_before : change_before / std::pow(by, before + first));
  }
  limit.value = f.back(), limit.error = std::max(error, least), limit.approach = Approach::asymptotic;
  return limit;
}

RefinedValues refined_values(const Problem& problem, const std::vector<RunTables>& runs, const std::vector<ExpectTable>& continuum) {
  RefinedValues refined;
  std::vector<std::pair<std::string, std::string>> wanted;
  std::vector<std::string> quantities{"lambda", "energy"}, rows = common_events(runs, refined.remarks);
  for (const std::string& name : observable_columns(problem)) quantities.push_back(name);
  for (const StageTable& s : problem.stages) rows.push_back(s.name);
  rows.push_back("final");
  for (const ExpectTable& e : continuum)
    if (!contains(rows, e.at) && !is_event(e.at)) rows.push_back(e.at);
  for (const std::string& at : rows)
    for (const std::string& q : quantities)
      if (q != "lambda" || is_event(at)) wanted.emplace_back(at, q);
  for (const ExpectTable& e : continuum)
    if (std::pair p{e.at, e.observable}; contains(rows, e.at) && !contains(wanted, p)) wanted.push_back(p);
  for (const auto& [at, quantity] : wanted) {
    const auto values = values_at(quantity, at, runs), errors = values_at("lambda_error", at, runs);
    if (contains(values, std::nullopt)) continue;
    RefinedValue value{at, quantity, {}, {}};
    double rounding = 0;
    for (std::size_t k = 0; k < runs.size(); ++k) {
      value.levels.push_back(*values[k]);
      rounding = std::max({rounding, rounding_of_values * std::max(std::abs(*values[k]), usual_in(*runs[k].path, quantity)),
                           quantity == "lambda" ? errors[k].value_or(0) : 0.0});
    }
    value.limit = extrapolate(value.levels, problem.refine->by, rounding);
    refined.values.push_back(std::move(value));
  }
  return refined;
}

Verdict check_continuum(const Problem& problem, const ExpectTable& e, const RefinedValues& refined) {
  const std::string what = fmt::format("{}:{}:{}: {} at {}, refined,", problem.file, e.place.line, e.place.column, e.observable, e.at);
  for (const RefinedValue& v : refined.values) {
    if (v.at != e.at || v.quantity != e.observable) continue;
    const Extrapolated& limit = v.limit;
    if (!limit.error) return {fmt::format("{} is {:.17g} at the last level, and no error can be told: {}", what, limit.value, fmt::join(v.levels, ", ")), false};
    const double off = std::abs(limit.value - e.value), widest = *e.bar * (e.value == 0 ? 1.0 : std::abs(e.value));
    return {fmt::format("{} is {:.17g} ± {:.2g}{}, expected {:.17g}: off by {:.2g}; the error may be {:.2g}", what, limit.value, *limit.error,
                        limit.order ? fmt::format(" (order {:.3f})", *limit.order) : "", e.value, off, widest),
            off <= *limit.error + e.rtol * std::abs(e.value) + e.atol && *limit.error <= widest};
  }
  const std::string why = refined.remarks.empty() ? "it is not at all levels" : fmt::format("{}", fmt::join(refined.remarks, "; "));
  return {fmt::format("{} has no value: {}", what, why), false};
}

std::string value_and_error(const Extrapolated& limit) {
  if (!limit.error || !(*limit.error > 0)) return fmt::format("{:.10g}", limit.value);
  const auto decade = [](double x) { return static_cast<int>(std::floor(std::log10(std::abs(x)))); };
  const int exponent = decade(*limit.error), largest = limit.value == 0 ? exponent : decade(limit.value);
  const int digits = std::clamp(largest - exponent + 1, 1, 16);
  return fmt::format("{:.{}g} ± {:.2g}", limit.value, digits + 1, *limit.error);
}

Table refined_table(const RefinedValues& refined, std::size_t levels) {
  Table table{{"at", "quantity", "value", "error", "order", "approach"}, {}};
  for (std::size_t k = 1; k <= levels; ++k) table.columns.push_back(fmt::format("level_{}", k));
  for (const RefinedValue& v : refined.values) {
    Row row{v.at, v.quantity, v.limit.value, cell_of(v.limit.error), cell_of(v.limit.order), name_of(v.limit.approach)};
    row.insert(row.end(), v.levels.begin(), v.levels.end());
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string closing_refined(const RefinedValues& refined) {
  std::size_t at = 2, quantity = 8, value = 13;
  for (const RefinedValue& v : refined.values)
    at = std::max(at, v.at.size()), quantity = std::max(quantity, v.quantity.size()), value = std::max(value, value_and_error(v.limit).size());
  std::string text = fmt::format("{:<{}}  {:<{}}  {:<{}}  {:>5}\n", "at", at, "quantity", quantity, "value ± error", value, "order");
  for (const RefinedValue& v : refined.values) {
    const std::string remark = v.limit.approach == Approach::not_asymptotic ? "  not in the asymptotic range"
                               : v.limit.approach == Approach::none         ? "  the levels do not approach a value: no error"
                                                                            : "";
    text += fmt::format("{:<{}}  {:<{}}  {:<{}}  {:>5}{}\n", v.at, at, v.quantity, quantity, value_and_error(v.limit), value,
                        v.limit.order ? fmt::format("{:.2f}", *v.limit.order) : "-", remark);
  }
  for (const std::string& remark : refined.remarks) text += remark + "\n";
  return text;
}

Json refined_json(const RefinedValues& refined) {
  Json quantities = Json::array();
  for (const auto& [at, quantity, levels, limit] : refined.values)
    quantities.push_back({{"at", at}, {"quantity", quantity}, {"value", json_of(limit.value)}, {"error", json_of(limit.error)},
                          {"order", json_of(limit.order)}, {"approach", name_of(limit.approach)}, {"levels", levels}});
  return {{"quantities", quantities}, {"remarks", refined.remarks}};
}

}  // namespace elamin
