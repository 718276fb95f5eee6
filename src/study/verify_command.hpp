#pragma once
#include "study/run.hpp"

namespace elamin {

/// `elamin verify`: runs every file, each into its directory below `options.directory` if that is given, and prints one
/// line for every expectation. Returns the exit status: 3 if one is not met, else the worst of the runs.
int verify_command(const std::vector<std::string>& files, const RunOptions& options);

}  // namespace elamin
