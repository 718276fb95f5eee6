#include "results/refinement.hpp"

#include "core/find.hpp"
#include "results/columns.hpp"
#include "results/json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace elamin {
namespace {

/// Equilibria are computed to rounding, which is more than ε where structures are slender: of a value, or of what is usual in its column.
constexpr double rounding_of_values = 1e-11;

struct Order { double ratio; std::optional<double> observed; };

Order order_of(const std::vector<double>& f, double by) {
  const std::size_t m = f.size() - 1;
  const double last = f[m] - f[m - 1], before = f[m - 1] - f[m - 2], ratio = before / last;
  return {ratio, ratio > 0 ? std::optional(std::log(ratio) / std::log(by)) : std::nullopt};
}

double last_change(const std::vector<double>& f) { return std::abs(f.back() - f[f.size() - 2]); }

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
    const Order order = order_of(f, by);
    if (before == 0) limit.order = order.observed;
    const double q = order.observed ? std::round(*order.observed) : 0;
    const bool by_chance = before > 0 && q > before + first;   // two terms nearly cancel: the next order is no higher than that
    if (last_change(f) <= least || !(q > before) || std::abs(*order.observed - q) > order_within || by_chance) {
      if (before > 0) break;
      if (std::abs(order.ratio) >= 1 + (by - 1) / 3) limit.approach = Approach::not_asymptotic, limit.error = 3 * last_change(f) / (by - 1);
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

namespace {

std::vector<std::string> labels_of(const Table& events) {
  std::vector<std::string> labels;
  for (const Row& row : events.rows) labels.push_back(csv_text(row[events.column("label")]));
  return labels;
}

/// Events that all levels have, in the order of the last one; what the others are is remarked.
std::vector<std::string> common_events(const std::vector<RunTables>& runs, std::vector<std::string>& remarks) {
  std::vector<std::string> common, all;
  std::map<std::vector<std::size_t>, std::vector<std::string>> missing;    // by the levels where they are
  for (auto run = runs.rbegin(); run != runs.rend(); ++run)
    for (const std::string& label : labels_of(*run->events))
      if (!contains(all, label)) all.push_back(label);
  for (const std::string& label : all) {
    std::vector<std::size_t> in;
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const std::vector<std::string> labels = labels_of(*runs[k].events);
      if (contains(labels, label)) in.push_back(k + 1);
    }
    if (in.size() < runs.size()) {
      missing[in].push_back(label);
      continue;
    }
    bool same = true;
    for (const char* column : {"multiplicity", "negative_before", "negative_after"}) {
      std::vector<std::string> numbers;
      std::string why;
      for (const RunTables& run : runs) {
        const auto value = value_at(column, label, run, why);
        numbers.push_back(value ? fmt::format("{}", *value) : "none");
      }
      if (!same || std::count(numbers.begin(), numbers.end(), numbers[0]) == static_cast<std::ptrdiff_t>(numbers.size())) continue;
      same = false, remarks.push_back(fmt::format("{} is not the same at all levels: {} is {}", label, column, fmt::join(numbers, ", ")));
    }
    if (same) common.push_back(label);
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
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

}  // namespace

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
    if (std::pair p{e.at, e.observable}; contains(rows, e.at) && !contains(wanted, p))
      wanted.push_back(p);
  for (const auto& [at, quantity] : wanted) {
    RefinedValue value{at, quantity, {}, {}};
    double rounding = 0;
    for (const RunTables& run : runs) {
      std::string why;
      const auto v = value_at(quantity, at, run, why);
      if (!v) break;
      value.levels.push_back(*v);
      rounding = std::max({rounding, rounding_of_values * std::max(std::abs(*v), usual_in(*run.path, quantity)),
                           quantity == "lambda" ? value_at("lambda_error", at, run, why).value_or(0) : 0.0});
    }
    if (value.levels.size() < runs.size()) continue;
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

const char* name_of(Approach approach) {
  switch (approach) {
    case Approach::asymptotic: return "asymptotic";
    case Approach::rounding: return "rounding";
    case Approach::not_asymptotic: return "not asymptotic";
    case Approach::none: return "none";
  }
  return "none";
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
    Row row{v.at, v.quantity, v.limit.value, cell_of(v.limit.error), cell_of(v.limit.order), std::string(name_of(v.limit.approach))};
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
  Json all;
  all["quantities"] = Json::array();
  for (const RefinedValue& v : refined.values) {
    Json one;
    one["at"] = v.at, one["quantity"] = v.quantity, one["value"] = json_of(v.limit.value), one["error"] = json_of(v.limit.error), one["order"] = json_of(v.limit.order);
    one["approach"] = name_of(v.limit.approach), one["levels"] = v.levels;
    all["quantities"].push_back(std::move(one));
  }
  all["remarks"] = refined.remarks;
  return all;
}

}  // namespace elamin
