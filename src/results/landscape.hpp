#pragma once
// Landscapes as a table, and as JSON with trees.
#include "path/landscape.hpp"
#include "results/json.hpp"

namespace elamin {

/// Of landscape.csv: at each load factor a row with the label "graph" and one for each node, minima first, then by energy; behind all of them the changes.
/// Columns as in path.csv, and: of a saddle `barrier` is its energy above the higher of the two minima that it joins, barrier_back above the lower one; of
/// a minimum `barrier` is that of the lowest saddle that joins it to another one; minima, saddles and euler, of the graph, count images.
Table landscape_table(const Landscapes& all, const std::vector<std::string>& observables,
                      const std::function<std::vector<double>(const PathPoint&)>& observe);

/// landscape.json; file: that of the state of an image.
Json landscape_json(const Landscapes& all, const std::function<std::string(const Landscape&, const NodeImage&)>& file);

}  // namespace elamin
