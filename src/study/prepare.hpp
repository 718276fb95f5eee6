#pragma once
// Many runs from one file.
#include "model/model.hpp"
#include "study/bisection.hpp"
#include "study/curve.hpp"
#include "input/problem.hpp"
#include "input/settings.hpp"

#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// One run, ready to go.
struct PreparedRun {
  std::vector<Setting> swept;          // what the sweeps set
  Problem problem;                     // with the expectations about this run alone
  Model model;
  std::vector<ExpectTable> together;   // expectations about all runs together
  ModelAt models;                      // where the problem asks for a curve
};

/// One run of a document. Throws InputError.
PreparedRun prepare_run(const Document& document, const std::vector<Setting>& settings, const std::vector<Setting>& swept,
                        const std::vector<OwnLaw>& own = {});

struct PreparedRuns {
  Document document;
  std::vector<OwnLaw> own;             // laws that the program brings along
  std::vector<PreparedRun> runs;
  std::optional<Bisection> bisection;  // then `runs` are its two ends
};

/// Every run of a file read and built, so that nothing runs before everything is right: one if there is no sweep; else all combinations of
/// what the sweeps set, the last sweep fastest, those with the same `zip` in step; of a bisection its two ends.
/// Throws InputError: a mistake of all runs is told once, one of some names the first of them.
PreparedRuns prepare_runs(const std::string& file, const std::vector<Setting>& settings = {});
PreparedRuns prepare_runs(const Document& document, const std::vector<Setting>& settings, const std::vector<OwnLaw>& own = {});

}  // namespace elamin
