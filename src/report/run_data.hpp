#pragma once
// Everything that a page tells of one run.
#include "results/json.hpp"

namespace elamin {

/// A run's directory in JSON: `directory`, `title`, `status`, `message` (how it ended), `version`, `input` (file, sha256, `text` where it is
/// still what was run, else null), `resolved` (resolved.toml), `tolerances`, `times`, `zero_modes`, `described` (what `check` says),
/// `expected` (column, at, value, expected, allowed, met, source), the tables `path` and `events` (see
/// table_data), `in_time`; `structure` and `states` (see shape_data.hpp; of at most so many bytes), or `no_shape`, why there is none.
/// Throws InputError if the directory is none of a run.
Json run_data(const std::string& directory, std::size_t most_bytes);

/// A CSV file as {"columns": [name, …], "values": [[of the first column, …], …]}; what is empty is null.
Json table_data(const std::string& file);

}  // namespace elamin
