#pragma once
// Everything that a page tells of one run.
#include "results/json.hpp"
#include "results/run_stages.hpp"

#include <vector>

namespace elamin {

// What a page draws: the structure, and the states of it that a run stored.

/// The structure in JSON: `id`, `radius`, `bonds` (pairs of particles from 0), `structures` (name, first, count, first_body,
/// bodies), `surfaces` of the shapes of bodies (points, triangles) and `bodies` (shape), `walls`, `supports` and `loads` (who, which
/// way), `fields` (what is known of each bond, particle or particle of a sheet: key, name, of), `stages` (name; `absent` particles and
/// `unbound` bonds; of `supports` and `walls`, whether in force), `flat`, the normal of the plane if there is one (0, 1, 2), or null.
/// Arrays of numbers are base64 of float or int32.
Json structure_data(const Model& model, const std::vector<RunStage>& stages);

/// The states in JSON, `list`: label, row, lambda, `stage` (of the structure's), `x` (3 × particles), `poses` (x, y, z, qx, qy, qz, qw of
/// each body), `fields` by their keys (tension of bonds; moment, energy, N11 … M12 of particles), `contacts` (pairs of ids, of the wall
/// k −1 − k; gap, force on the first, point, of each), `walls` (how far each has moved, how much its radius has grown), `loads` (how
/// much of each acts), `modes` (name, `u` of particles, `v` of bodies: motion and turn). Of more bytes than `most` only some are taken,
/// evenly, those with labels before others: `stored` and `kept` count them. A state that cannot be read is left out, and `missing`
/// says why.
Json states_data(const StoredRun& run, const std::vector<RunStage>& stages, const Model& model, std::size_t most);

/// A run's directory in JSON: `directory`, `title`, `status`, `message` (how it ended), `version`, `input` (file, sha256, `text` where it is
/// still what was run, else null), `resolved` (resolved.toml), `tolerances`, `times`, `zero_modes`, `described` (what `check` says),
/// `expected` (column, at, value, expected, allowed, met, source), the tables `path` and `events` (see
/// table_data), `in_time`; `structure` and `states` (see structure_data, states_data; of at most so many bytes), or `no_shape`, why there is none.
/// Throws InputError if the directory is none of a run.
Json run_data(const std::string& directory, std::size_t most_bytes);

/// A CSV file as {"columns": [name, …], "values": [[of the first column, …], …]}; what is empty is null.
Json table_data(const std::string& file);

}  // namespace elamin
