// [path] eigenvalues: the lowest ones at every point, as columns.
#include "catch.hpp"
#include "chain.hpp"
#include "core/dense.hpp"
#include "path/tracing.hpp"
#include "plate.hpp"
#include "reference.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/spectrum.hpp"
#include "study/modes.hpp"
#include "study/results_of.hpp"

#include <fmt/format.h>

using namespace elamin;

namespace {

// At every point of a path those of the dense solver, to its rounding; gives how often the Morse index has changed.
int compare(const Model& model, const Trace& t, int count) {
  LowestEigenvalues lowest(model, count);
  Energy energy(model);
  int changes = 0;
  for (std::size_t k = 0; k < t.points.size(); ++k) {
    const PathPoint& p = t.points[k];
    const std::vector<double> values = lowest.at(p.state);
    const Vector all = spectrum(energy, p.state);
    const double scale = all.cwiseAbs().maxCoeff();
    REQUIRE(values.size() == static_cast<std::size_t>(std::min<Eigen::Index>(count, all.size())));
    CAPTURE(k, p.label, p.state.load_factor);
    for (std::size_t j = 0; j < values.size(); ++j) {
      CAPTURE(j, values[j], all[static_cast<Eigen::Index>(j)]);
      CHECK(std::abs(values[j] - all[static_cast<Eigen::Index>(j)]) <= 1e-13 * scale);
    }
    const auto negative = std::count_if(values.begin(), values.end(), [&](double v) { return v < -1e-13 * scale; });
    if (p.multiplicity == 0) CHECK(negative == std::min(count, p.stability.negative));
    if (k > 0) changes += p.stability.negative != t.points[k - 1].stability.negative;
  }
  return changes;
}

}  // namespace

TEST_CASE("eigenvalues along a straight chain that loses its stability again and again", "[eigenvalues]") {
  // A step with few points takes several modes past each other at once.
  const int steps = GENERATE(3, 40);
  const bool plane = GENERATE(true, false);
  CAPTURE(steps, plane);
  Model m = chain(24, 1000, 1, 1);
  if (plane) m.plane_normal = 1;
  hold(m, 0, 1), hold(m, 22, 23, {true, true, true}, Vec3(0, 0, -1));
  Energy energy(m);
  Newton newton(energy);
  PathOptions options;
  options.to = 0.6, options.steps = steps, options.when_unstable = WhenUnstable::follow;
  const Trace t = trace(newton, m.start, options);
  REQUIRE(t.status == Status::converged);
  CHECK(compare(m, t, 3) > 2);
  CHECK(compare(m, t, 100) > 2);
}

TEST_CASE("eigenvalues of a plate, whose modes lie close together, as it is compressed", "[eigenvalues]") {
  const int steps = GENERATE(2, 10);
  Plate p = plate(8, 9, true, 1, 1, 0.05);
  p.hold(p.edge("straight_simply_supported"), [](const Vec3& x) { return Vec3(-0.1 * x[0], 0, 0); });
  Energy energy(p.model);
  Newton newton(energy);
  PathOptions options;
  options.steps = steps, options.when_unstable = WhenUnstable::follow;
  const Trace t = trace(newton, p.model.start, options);
  CAPTURE(steps, t.why);
  REQUIRE(t.status == Status::converged);
  CHECK(compare(p.model, t, 4) > 0);
}

TEST_CASE("eigenvalues are columns of a path: those of buckled chains", "[eigenvalues][reference]") {
  for (const nlohmann::json& c : nlohmann::json(reference("exact/post_buckling_clamped.json")["cases"]))
    for (const bool plane : {true, false}) {
      const ScratchDirectory scratch;
      const double largest = c["states"].back()["end_shortening"];
      std::string stops;
      for (const auto& s : c["states"]) stops += fmt::format("{:.17g}, ", s["end_shortening"].get<double>());
      const std::string text = fmt::format(R"({}
[[beam]]
name = "column"
section = "{}"
particles = {}
center = [0, 0, 0]
axis = [0, 0, 1]
diameter = {:.17g}
youngs_modulus = {:.17g}
[[group]]
name = "bottom"
of = "column"
first = 2
[[group]]
name = "top"
of = "column"
last = 2
[[support]]
group = "bottom"
[[support]]
group = "top"
displacement = [0, 0, -1]
[path]
steps = 20
to = {:.17g}
stops = [{}]
when_unstable = "jump"
)", plane ? "plane = \"xz\"" : "", c["section"].get<std::string>(), c["N_free_particles"].get<int>() + 4, c["q0"].get<double>(),
                                           c["E"].get<double>(), largest, stops);
      const std::string file = scratch.file("p.toml", text);
      REQUIRE(elamin_says("'" + file + "' --quiet --set path.eigenvalues=3").status == 0);
      REQUIRE(elamin_says("'" + file + "' --quiet -o '" + (scratch / "without") + "'").status == 0);
      const std::vector<TableRow> path = table_of(scratch / "p/path.csv"), without = table_of(scratch / "without/path.csv");
      std::size_t found = 0;
      for (const auto& s : c["states"])
        for (const TableRow& row : path) {
          if (row["lambda"] != s["end_shortening"].get<double>()) continue;
          ++found;
          const auto& known = s[plane ? "smallest_eigenvalues_2D" : "smallest_eigenvalues_3D"];
          for (int j = 0; j < 3; ++j)
            CHECK(std::abs(row[fmt::format("eigenvalue_{}", j + 1)] - known[j].get<double>()) <= 1e-8 * known[2].get<double>() + 1e-12);
        }
      CHECK(found == c["states"].size());
      // At the branch point one is zero (in space two), and the rest of the path is as it is without.
      const TableRow branch = row_of(table_of(scratch / "p/events.csv"), "branch:1");
      CHECK(std::abs(branch["eigenvalue_1"]) <= 1e-9 * branch["eigenvalue_3"]);
      CHECK((std::abs(branch["eigenvalue_2"]) <= 1e-9 * branch["eigenvalue_3"]) == !plane);
      REQUIRE(path.size() == without.size());
      for (std::size_t i = 0; i < path.size(); ++i)
        for (const auto& [column, cell] : without[i].cells) CHECK(path[i].text(column) == cell);
      const auto header = csv_rows(scratch / "p/path.csv")[0];
      CHECK(std::vector<std::string>(header.end() - 5, header.end()) ==
            std::vector<std::string>{"eigenvalue_1", "eigenvalue_2", "eigenvalue_3", "parent", "negative_rigid"});
    }
}

TEST_CASE("eigenvalues may be expected, and stand in the table of a sweep, stages have them too", "[eigenvalues]") {
  const ScratchDirectory scratch;
  const std::string supports = "[[support]]\ngroup = \"bottom\"\n[[support]]\nname = \"head\"\ngroup = \"top\"\ndisplacement = [0, 0, -0.4e-3]\n";
  const std::string asked = "[path]\nsteps = 4\neigenvalues = 2\nwhen_unstable = \"follow\"\n";
  const std::string expect = "[[expect]]\nobservable = \"eigenvalue_1\"\nat = \"branch:1\"\nvalue = 0\natol = 1e-9\n";
  const std::string file = scratch.file("p.toml", column_and_ends + supports + asked + expect +
                                        "[[sweep]]\nkey = \"beam.column.youngs_modulus\"\nvalues = [1e6, 4e6]\n");
  const Answer answer = elamin_says("verify --quiet '" + file + "' -o '" + (scratch / "out") + "'");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  const std::vector<TableRow> sweep = table_of(scratch / "out/sweep.csv");
  REQUIRE(sweep.size() == 2);
  CHECK(sweep[0]["eigenvalue_1"] < 0);
  for (const char* column : {"eigenvalue_1", "eigenvalue_2"}) CHECK(sweep[1][column] == Approx(4 * sweep[0][column]).epsilon(1e-9));

  // Pressed, then let go of by the upper clamp but for a hinge: softer than at the start.
  const std::string stages = scratch.file("s.toml", column_and_ends + supports + "[path]\nsteps = 4\neigenvalues = 2\nto = 0.2\n" + R"(
[[group]]
name = "end"
of = "column"
ids = [14]
[[support]]
name = "hinge"
group = "end"
directions = "x"
[[stage]]
name = "press"
[[stage]]
name = "let_go"
to = 1.0
off = ["support.head"]
vary = "support.hinge"
)");
  const Answer staged = elamin_says("'" + stages + "' --quiet");
  INFO(staged.text);
  REQUIRE(staged.status == 0);
  const std::vector<TableRow> path = table_of(scratch / "s/path.csv");
  // Clamps begin half a bond further in: 12 bonds' length between two of them, 12.5 between one and the hinge.
  const double clamped = 4.730 / 12, hinged = 3.927 / 12.5;
  CHECK(path.back()["eigenvalue_1"] == Approx(std::pow(hinged / clamped, 4) * path.front()["eigenvalue_1"]).epsilon(0.03));
}
