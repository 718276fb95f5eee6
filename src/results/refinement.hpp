#pragma once
// What results with finer and finer spacing tell of the value without particles: Richardson's extrapolation, with an error.
#include "results/expectations.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// How values f₀, f₁, … f_m at spacings h, h/b, … go to their limit.
enum class Approach {
  asymptotic,        // f_k = f + C h_k^p to begin with, p a whole number to `order_within`
  rounding,          // the last two differ by rounding
  not_asymptotic,    // they approach it, but not with such an order: a wider error
  none               // the differences do not fall so that an error could be told
};

/// The value without particles. Of the last three values, with d = f_m − f_{m−1} and d' = f_{m−1} − f_{m−2}, the observed order is
///   p = log(d'/d)/log b                                        (Roache 1998, §5.10)
/// and where that is a whole number q to `order_within`, all neighbours make a value of a new sequence,
///   f_k + (f_k − f_{k−1})/(b^q − 1)                            (Richardson 1911),
/// whose own order is looked at as long as it has three values and the order grows (Romberg 1955, but with orders that are observed). The limit is the last value of the
/// last sequence, and the error how far it is from the one before: of a sequence of order q' it is (b^q' − 1) ≥ 1 times the error that is left, and 1 or
/// more if p were not q. Else the limit is f_m and the error 3 |d|/(b − 1), Roache's (1994) GCI for first order with the factor 3 of an
/// order that is not observed, which is right where |d'/d| ≥ 1 + (b − 1)/3; with less there is none. `rounding`: of a value; three times that is the least error.
struct Extrapolated {
  double value = 0;
  std::optional<double> error, order;  // order: observed, of the values themselves
  Approach approach = Approach::none;
};
Extrapolated extrapolate(const std::vector<double>& values, double by, double rounding);

/// Observed orders are p + O(h): within this of a whole number they are taken for it. Half orders, of cracks and of contacts, are farther.
inline constexpr double order_within = 0.3;

/// One quantity at one row of the runs, and why it has no limit.
struct RefinedValue {
  std::string at, quantity;
  std::vector<double> levels;          // the values; empty if some level has none
  Extrapolated limit;
};

struct RefinedValues {
  std::vector<RefinedValue> values;
  std::vector<std::string> remarks;    // events that are not the same at all levels
};

/// Load factor, energy and everything observed at each event that all levels have, at each stage's end and at the end, and where an expectation looks; of runs
/// of these problems. Events are the same if label, multiplicity and Morse indices are.
RefinedValues refined_values(const Problem& problem, const std::vector<RunTables>& runs, const std::vector<ExpectTable>& continuum);

/// Whether a limit is what is expected: |value − expected| ≤ error + rtol |expected| + atol, and error ≤ bar |expected|.
Verdict check_continuum(const Problem& problem, const ExpectTable& expected, const RefinedValues& refined);

/// "3.00000012 ± 3.4e-07": two digits of the error, and the value to the last of them.
std::string value_and_error(const Extrapolated& limit);

/// refine.csv: at, quantity, value, error, order, approach, level_1, level_2, …; the same for a terminal; the same as JSON.
Table refined_table(const RefinedValues& refined, std::size_t levels);
std::string closing_refined(const RefinedValues& refined);
nlohmann::ordered_json refined_json(const RefinedValues& refined);

}  // namespace elamin
