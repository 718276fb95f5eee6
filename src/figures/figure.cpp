#include "figures/figure.hpp"

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "figures/diagram.hpp"
#include "figures/drawing.hpp"
#include "figures/scene.hpp"
#include "results/results_directory.hpp"
#include "results/stored_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

namespace elamin {
namespace {

constexpr double column_width = 85 / 25.4 * 72, diagram_height = 135, margin = 3;       // 85 mm [pt]

Diagram landscape_or_tree(const Table& table, const Axes& axes, const std::string& file) {
  if (!axes.x.empty() || !axes.y.empty()) return landscape_diagram(table, axes, file);
  return tree_diagram(std::filesystem::path(file).replace_extension(".json").string());
}

// The values without particles, unless columns of sweep.csv are asked for.
Diagram sweep_or_refinement(const Table& table, const Axes& axes, const std::string& file) {
  const std::string refined = std::filesystem::path(file).replace_filename("refine.csv").string();
  if (axes.x.empty() && axes.y.empty() && std::filesystem::exists(refined))
    if (Diagram d = refinement_diagram(read_table(refined), refined); !d.empty()) return d;
  return sweep_diagram(table, axes, file);
}

// What the directory has in it; nothing if it has one point at most.
std::optional<Diagram> diagram_in(const FigureOptions& options) {
  using Read = Diagram (*)(const Table&, const Axes&, const std::string&);
  const std::pair<const char*, Read> tables[] = {
      {"sweep.csv", sweep_or_refinement}, {"modes.csv", modes_diagram}, {"trajectory.csv", motion_diagram},
      {"curve.csv", curve_diagram}, {"landscape.csv", landscape_or_tree}, {"path.csv", path_diagram}};
  for (const auto& [name, read] : tables) {
    const std::string file = (std::filesystem::path(options.directory) / name).string();
    if (!std::filesystem::exists(file)) continue;
    Diagram d = read(read_table(file), {options.x, options.y}, file);
    if (!options.diagram || d.empty()) return std::nullopt;
    return d;
  }
  throw InputError(fmt::format("{}: is not a directory of results: there is no path.csv, trajectory.csv, modes.csv or sweep.csv in it",
                               options.directory));
}

}  // namespace

std::string write_figure(const FigureOptions& options) {
  const std::string file = options.file.empty() ? (std::filesystem::path(options.directory) / "figure.svg").string() : options.file;
  const bool pdf = file.ends_with(".pdf");
  if (!pdf && !file.ends_with(".svg")) throw InputError(file + ": a figure is an SVG or a PDF; a name that ends in .svg or .pdf is needed");
  const std::optional<Diagram> diagram = diagram_in(options);
  std::vector<std::string> labels = options.shapes;
  if (labels.empty() && !diagram) labels = {"final"};
  std::vector<Scene> scenes;
  for (const std::string& label : labels) scenes.push_back(read_scene(options.directory, label));
  Drawing drawing;
  double y = margin;
  if (diagram) y = draw_diagram(drawing, *diagram, {margin, y}, column_width - 2 * margin, diagram_height);
  if (!scenes.empty()) y = draw_shapes(drawing, scenes, {margin, y + (diagram ? 6 : 0)}, column_width - 2 * margin);
  const std::string svg = drawing.svg(column_width, y + margin, std::filesystem::path(options.directory).lexically_normal().filename().string());
  if (pdf) write_pdf(svg, file);
  else write_text(file, svg);
  if (options.file.empty()) list_also(options.directory, "figure.svg");
  return file;
}

std::string terminal_figure(const FigureOptions& options, int width) {
  const std::optional<Diagram> diagram = diagram_in(options);
  return diagram ? braille(*diagram, width, std::clamp(width / 5, 8, 20)) : "";
}

}  // namespace elamin
