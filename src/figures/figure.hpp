#pragma once
// `elamin plot`: one figure of a run, a sweep, a motion or modes, as wide as a column of a paper.
#include <string>
#include <vector>

namespace elamin {

struct FigureOptions {
  std::string directory;               // of the results
  std::string x, y;                    // columns; "": see diagram.hpp
  std::vector<std::string> shapes;     // labels of states, see read_scene; without any the last state where there is no diagram
  bool diagram = true;                 // false: the shapes alone
  std::string file;                    // FIG.svg; "": DIR/figure.svg
};

/// Draws and writes the figure; returns its file. Throws InputError if the directory has no results in it, something asked for is missing or
/// the file cannot be written.
std::string write_figure(const FigureOptions& options);

}  // namespace elamin
