#pragma once
// Does a run give what its file expects?
#include "input/problem.hpp"
#include "results/table.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

struct Verdict {
  std::string sentence;
  bool met = false;
};

/// The tables of a run.
struct RunTables {
  const Table* path;
  const Table* events;
  const Table *curve = nullptr, *landscape = nullptr;
};

/// The number in a column at `at` (see check_expectations); nothing if there is none, and then `why` says so.
std::optional<double> value_at(const std::string& column, const std::string& at, const RunTables& run, std::string& why);

/// Holds the values v₁ … v_m of the runs of a sweep, each with half the spacing of the one before, extrapolated against
/// what is expected (Romberg): R_i0 = v_i, R_ik = (fᵏ R_i,k−1 − R_i−1,k−1)/(fᵏ − 1), f = 4 for errors in even powers of
/// the spacing, 2 for errors in all powers; the value is R_m,m−1.
Verdict check_extrapolated(const Problem& problem, const ExpectTable& expected, const std::vector<RunTables>& runs);

/// Holds the middle of the two values between which a bisection has found the threshold against what is expected.
Verdict check_threshold(const Problem& problem, const ExpectTable& expected, std::optional<std::array<double, 2>> threshold);

/// Holds every [[expect]] against the tables of a run: |value − expected| ≤ rtol·|expected| + atol (true counts as 1,
/// false as 0). at: an event's label; "initial" and "final", the first and the last row of the path; a stage's
/// name, its last row; or "lambda=0.5", the last row whose load factor agrees to 1e-12 relative; of a curve "curve.cusp:1", a label, and
/// "second=0.5"; of a landscape "landscape.saddle:1", of the last load factor, or "landscape.saddle:1@0.5". What is not there is not met, and
/// the sentence says what is. A sentence begins with the place in the problem file.
std::vector<Verdict> check_expectations(const Problem& problem, const Table& path, const Table& events, const Table& curve = {},
                                        const Table& landscape = {});

}  // namespace elamin
