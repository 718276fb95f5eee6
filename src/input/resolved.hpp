#pragma once
// The other direction: a problem as a file.
#include "input/problem.hpp"

#include <string>

namespace elamin {

/// The problem as TOML with every default written out: a valid problem file, from any folder, that reads back to the
/// same Problem, numbers to the last bit.
std::string resolved_toml(const Problem& problem);

/// The value of a key as TOML.
std::string to_toml(const Key& key, KeyValue value);

}  // namespace elamin
