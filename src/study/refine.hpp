#pragma once
// The levels of a file with [refine], and what they tell together.
#include "results/results_directory.hpp"
#include "study/prepare.hpp"
#include "study/single.hpp"

namespace elamin {

/// What each level sets: the file's spacing, divided by 1, by, by², … (see finer_structure). Throws InputError where a level cannot be.
std::vector<std::vector<Setting>> levels_of(const Document& document, const std::vector<Setting>& settings, const std::vector<OwnLaw>& own);

/// The values without particles as refine.csv and refine.json, told on the terminal unless `quiet`, and held against the expectations of the continuum.
std::vector<Verdict> finish_refinement(const PreparedRuns& prepared, const std::vector<std::optional<SingleResult>>& results, ResultsDirectory& directory,
                                       bool quiet);

}  // namespace elamin
