#pragma once
// What can be said of a problem before anything is built: names, references, and keys that go together or do not.
#include "core/find.hpp"
#include "core/text.hpp"
#include "input/keys.hpp"
#include "input/problem.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace elamin {

/// Adds to the mistakes what is wrong and marks its tables as broken; of a table that is broken already, tells only
/// what its mistakes do not explain. `other_names`: of structures that were refused, so that their groups are not
/// missed too.
void check_problem(Problem& problem, const std::vector<std::string>& other_names, Mistakes& mistakes);

/// Columns that the tables of every run have; an observable may not take one of these names.
const std::vector<std::string>& standing_columns();

/// Those, or in time those of trajectory.csv, and the eigenvalues that a problem asks for.
std::vector<std::string> columns_of(const Problem& problem);

/// Those, and the columns that the tables of a curve or of a landscape have besides: no name of an observable or of a law.
std::vector<std::string> taken_columns(const Problem& problem);

/// Columns that a study of modes and a path with `eigenvalues` have besides: eigenvalue_1, …
std::vector<std::string> eigenvalue_columns(const Problem& problem);

/// The `at` of an expectation about all runs of a sweep together: the threshold that a bisection finds.
inline constexpr const char* at_sweep = "sweep";

/// The finite number behind a word such as "lambda="; nothing where `at` is not that.
std::optional<double> number_behind(std::string_view word, const std::string& at);

/// Whether a word is one of these with a number behind a colon.
template <class Words> bool is_numbered(const std::string& word, const Words& words) {
  const std::size_t colon = word.find(':');
  int number = 0;
  return colon != std::string::npos && reads_as(std::string_view(word).substr(colon + 1), number) && number > 0 && contains(words, word.substr(0, colon));
}

/// The load factor of "lambda=0.5"; nothing of another `at`.
std::optional<double> load_factor_of(const std::string& at);

/// The step of "step=100", in dynamics; nothing of another `at`.
std::optional<int> step_of(const std::string& at);

/// Why an observable is no column of numbers at `at` (see ExpectTable), or ""; and why no row of a run is meant by `at`.
std::string wrong_observable(const Problem& problem, const std::string& observable, const std::string& at);
std::string wrong_at(const Problem& problem, const std::string& at);

}  // namespace elamin
