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
  std::string file;                    // FIG.svg or FIG.pdf; "": DIR/figure.svg
};

/// Draws and writes the figure; returns its file. Throws InputError if the directory has no results in it, something asked for is missing or
/// the file cannot be written.
std::string write_figure(const FigureOptions& options);

/// The diagram for a terminal, as wide as that is, see braille; "" where there is one point at most. Throws InputError as
/// write_figure does.
std::string terminal_figure(const FigureOptions& options, int width);

}  // namespace elamin
