#pragma once
// Does a run give what its file expects?
#include "problem/problem.hpp"
#include "results/table.hpp"

#include <string>
#include <vector>

namespace elamin {

struct Verdict {
  std::string sentence;
  bool met = false;
};

/// Holds every [[expect]] against the tables of a run: |value − expected| ≤ rtol·|expected| + atol (true counts as 1,
/// false as 0). at: an event's label; "initial" and "final", the first and the last row of the path; or "lambda=0.5",
/// the last row whose load factor agrees to 1e-12 relative. What is not there is not met, and the sentence says what
/// is. A sentence begins with the place in the problem file.
std::vector<Verdict> check_expectations(const Problem& problem, const Table& path, const Table& events);

}  // namespace elamin
