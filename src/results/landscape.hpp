#pragma once
// Landscapes as a table, as JSON and as trees.
#include "path/landscape.hpp"
#include "results/json.hpp"

namespace elamin {

/// Of landscape.csv: at each load factor a row with the label "graph" and one for each node, minima first, then by energy; behind all of them the changes.
/// Columns as in path.csv, and: of a saddle `barrier` is its energy above the higher of the two minima that it joins, barrier_back above the lower one; of
/// a minimum `barrier` is that of the lowest saddle that joins it to another one; minima, saddles and euler, of the graph, count images.
std::vector<std::string> landscape_columns(const std::vector<std::string>& observables);
Table landscape_table(const Landscapes& all, const std::vector<std::string>& observables,
                      const std::function<std::vector<double>(const PathPoint&)>& observe);

/// A disconnectivity diagram: a leaf for each minimum, where its energy is, and lines up to the lowest saddles over which minima are reached
/// from each other; x counts the leaves, y is the energy. Source: Becker & Karplus 1997, J. Chem. Phys. 106, 1495.
struct LandscapeTree {
  struct Leaf { NodeImage minimum; double x, y; };
  std::vector<Leaf> leaves;
  std::vector<std::vector<std::array<double, 2>>> lines;
};
LandscapeTree tree_of(const Landscape& landscape);

/// landscape.json; file: that of the state of an image.
Json landscape_json(const Landscapes& all, const std::function<std::string(const Landscape&, const NodeImage&)>& file);

}  // namespace elamin
