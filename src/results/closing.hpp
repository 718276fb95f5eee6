#pragma once
// What a run says at its end, in tables for reading.
#include "results/ink.hpp"
#include "results/mode.hpp"
#include "results/table.hpp"

#include <string>
#include <vector>

namespace elamin {

/// The events of a path, or a sentence that there were none; of many the first ones.
std::string closing_table(const Table& events, const Ink& ink = {});

/// The last row of a study: energy, residual and stability, or time and kinetic energy of a motion, and a line for each observable.
std::string closing_values(const Table& path, const std::vector<std::string>& observables, const Ink& ink = {});

/// Number and eigenvalue of each mode, and the name of those that are zero.
std::string closing_modes(const std::vector<Mode>& modes, const Ink& ink = {});

}  // namespace elamin
