// Whole runs into their directories, pictures and pages of them.
#include "core/parallel.hpp"
#include "energy/wall_group.hpp"
#include "figures/figure.hpp"
#include "figures/drawing.hpp"
#include "figures/scene.hpp"
#include "python/module.hpp"
#include "report/report.hpp"
#include "results/surfaces.hpp"
#include "results/fields.hpp"
#include "results/results_directory.hpp"
#include "study/prepare.hpp"
#include "study/run.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

namespace elamin::python {

namespace {

// The exit status and the verdicts of [[expect]], as sentences with whether they are met.
py::tuple run_document(const Document& document, const std::vector<PythonLaw>& laws, const std::string& directory, bool quiet, bool force,
                       bool report, int threads) {
  if (threads < 0) throw InputError(fmt::format("threads: must be an integer of at least 0, is {}", threads));
  const RunResult result = without_lock([&] {
    std::vector<OwnLaw> own;
    for (const PythonLaw& law : laws) own.push_back(own_law(law));
    const int usual = threads_here();
    const RunOptions options{.file = document.file, .settings = {}, .directory = directory, .threads = threads > 0 ? threads : usual,
                             .force = force, .quiet = quiet, .report = report};
    PreparedRuns prepared = prepare_runs(complete(document), {}, own);
    for (const PreparedRun& run : prepared.runs)
      if (!own.empty() && run.problem.in_time())
        throw InputError("a law of your own is not felt by what moves in time; ask for equilibria or a path, or take the law away");
    const RunResult done = run(prepared, options);
    set_threads(usual);
    std::fflush(stdout);
    return done;
  });
  py::list verdicts;
  for (const Verdict& v : result.verdicts) verdicts.append(py::make_tuple(v.met, v.sentence));
  return py::make_tuple(result.exit_status, result.directory, verdicts);
}

Scene scene_at(const Model& model, const State& state) {
  Scene scene;
  for (int p = 0; p < model.particles(); ++p) scene.particles.push_back({state.position.col(p), model.diameter[p] / 2});
  const std::vector<BondField> bonds = bond_fields(model, state);
  for (std::size_t b = 0; b < bonds.size(); ++b)
    scene.bonds.push_back({model.bonds[b].particles[0], model.bonds[b].particles[1], bonds[b].tension});
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    Surface surface = surface_of(model.shapes[model.bodies[b].shape]);
    const Pose& pose = state.bodies[b];
    for (Vec3& point : surface.points) point = pose.position.hi + pose.rotation * point;
    scene.bodies.push_back({std::move(surface.points), std::move(surface.polygons)});
  }
  for (const Wall& wall : model.walls) scene.walls.push_back(wall_at(wall, state.load_factor).region.rounded());
  return scene;
}

std::string picture(const System& s, const State& state, double width, const std::string& title) {
  constexpr double margin = 3;
  if (!(width > 2 * margin && std::isfinite(width)))
    throw InputError(fmt::format("width: must be a number of points above {}, is {}", 2 * margin, width));
  return without_lock([&] {
    Drawing drawing;
    const double height = draw_shapes(drawing, {scene_at(s.model, state)}, {margin, margin}, width - 2 * margin) + margin;
    return drawing.svg(width, height, title);
  });
}

std::string figure(const std::string& directory, const std::string& x, const std::string& y, const std::vector<std::string>& shapes,
                   bool diagram, const std::string& file) {
  return without_lock([&] { return write_figure({directory, x, y, shapes, diagram, file}); });
}

}  // namespace

void add_runs(py::module_& module) {
  module.def("run", &run_document, py::arg("document"), py::arg("laws"), py::arg("directory"), py::arg("quiet"), py::arg("force"),
             py::arg("report"), py::arg("threads"));
  module.def("picture", &picture, py::arg("system"), py::arg("state"), py::arg("width"), py::arg("title"));
  module.def("figure", &figure, py::arg("directory"), py::arg("x"), py::arg("y"), py::arg("shapes"), py::arg("diagram"), py::arg("file"));
  module.def("write_pdf", [](const std::string& svg, const std::string& file) {
    return without_lock([&] { return write_pdf(svg, file), 0; });
  }, py::arg("svg"), py::arg("file"));
  module.def("report_page", [](const std::vector<std::string>& directories) {
    return without_lock([&] { return report_page({directories, "", true}); });
  }, py::arg("directories"));
  module.def("require_results", &require_results, py::arg("directory"),
             "Raises InputError where the directory holds something else than results.");
  module.def("list_also", &list_also, py::arg("directory"), py::arg("name"));
}

}  // namespace elamin::python
