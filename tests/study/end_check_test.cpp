// What looks at the last point of a run again sees answers that were made wrong on purpose.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/end_check.hpp"
#include "study/prepare.hpp"
#include "study/program.hpp"
#include "study/trace.hpp"

#include <nlohmann/json.hpp>

namespace {

using namespace elamin;
using Catch::Matchers::Contains;

constexpr double tight = 1e-10;

/// The last point of a column that is pushed to `to` times twice its buckling load.
struct Pushed {
  explicit Pushed(const std::string& path) : runs(prepare_runs(scratch.file("column.toml", pressed_column + "[path]\n" + path), {})) {
    const PreparedRun& run = runs.runs.front();
    const Sink sink{.stage = [](const Stage&, Energy&) {}, .point = [&](const PathPoint& p, bool) { last = p; }, .modes = {}, .note = [](const std::string&) {}};
    REQUIRE(trace(run.problem, run.model, {}, sink).status == Status::converged);
  }
  EndCheck check() const { return check_end(runs.runs.front().model, last, tight); }
  const Model& model() const { return runs.runs.front().model; }

  ScratchDirectory scratch;
  PreparedRuns runs;
  PathPoint last;
};

}  // namespace

TEST_CASE("true answers pass the check at the end: straight, just before buckling, buckled, unstable and said to be so", "[study][end_check]") {
  for (const char* path : {"to = 0.1", "to = 0.49", "to = 1.0", "to = 1.0\nmethod = \"arc_length\"\nwhen_unstable = \"follow\""}) {
    INFO(path);
    const Pushed column(path);
    const EndCheck check = column.check();
    INFO(check.what);
    CHECK(check.passed);
    CHECK((check.directions >= 3) == column.last.stability.stable);
    CHECK(check.residual <= tight);
  }
}

TEST_CASE("the check at the end sees a position that is 1e-6 of a diameter off, an energy in its tenth digit, and a saddle that is called stable", "[study][end_check]") {
  Pushed column("to = 1.0");
  REQUIRE(column.check().passed);
  for (const int particle : {2, 5, 11})
    for (const int coordinate : {0, 2}) {
      const PathPoint right = column.last;
      column.last.state.position(coordinate, particle) += 1e-9;
      CHECK_FALSE(column.check().passed);
      CHECK_THAT(column.check().what, Contains("the residual is "));
      column.last = right;
    }
  column.last.energy.bond *= 1 + 1e-9;
  CHECK_THAT(column.check().what, Contains("the energy is "));

  Pushed saddle("to = 1.0\nmethod = \"arc_length\"\nwhen_unstable = \"follow\"");
  REQUIRE(saddle.last.stability.negative > 0);
  saddle.last.stability = {}, saddle.last.stability.stable = true;
  CHECK_FALSE(saddle.check().passed);
  CHECK_THAT(saddle.check().what, Contains("called stable, but the energy falls along the lowest mode"));
}

TEST_CASE("summary.json tells what the check at the end came to", "[study][end_check]") {
  const ScratchDirectory scratch;
  REQUIRE(elamin_says(scratch.file("column.toml", pressed_column)).status == 0);
  const auto check = nlohmann::json::parse(text_of(scratch / "column/summary.json"))["check"];
  CHECK(check["verdict"] == "passed");
  CHECK(check["residual"] <= tight);
  CHECK(check["directions"] >= 3);
}
