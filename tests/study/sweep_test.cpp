#include "catch.hpp"

#include "core/error.hpp"
#include "study/prepare.hpp"
#include "study/sweep.hpp"
#include "scratch_directory.hpp"

using namespace elamin;

namespace {

const char* swept = R"(
[[beam]]
name = "column"
particles = 5
from = [0, 0, 0]
to = [0, 0, 8]
diameter = 2
youngs_modulus = 3
[[support]]
group = "column"
)";

/// The runs of column + sweeps, each as "key = value, …".
std::vector<std::string> runs_of(const std::string& sweeps, const std::vector<Setting>& settings = {}) {
  const ScratchDirectory scratch;
  std::vector<std::string> texts;
  for (const PreparedRun& run : prepare_runs(scratch.file("p.toml", swept + sweeps), settings).runs) {
    texts.emplace_back();
    for (const Setting& s : run.swept) texts.back() += (texts.back().empty() ? "" : ", ") + s.key + " = " + s.value;
  }
  return texts;
}

using Texts = std::vector<std::string>;

}  // namespace

TEST_CASE("Without a sweep there is one run") {
  CHECK(runs_of("") == Texts{""});
}

TEST_CASE("Values and ranges") {
  const std::string key = "[[sweep]]\nkey = \"beam.column.diameter\"\n";
  CHECK(runs_of(key + "values = [1, 2.5, 1e-3]") ==
        Texts{"beam.column.diameter = 1", "beam.column.diameter = 2.5", "beam.column.diameter = 0.001"});
  CHECK(runs_of(key + "range = [14, 19, 2]") ==
        Texts{"beam.column.diameter = 14", "beam.column.diameter = 16", "beam.column.diameter = 18"});
  CHECK(runs_of(key + "range = [3, 1, -1]") ==
        Texts{"beam.column.diameter = 3", "beam.column.diameter = 2", "beam.column.diameter = 1"});
  const Texts tenths = runs_of(key + "range = [0.1, 0.5, 0.1]");  // 0.1 is no sum of halves: the end is in all the same
  REQUIRE(tenths.size() == 5);
  CHECK(tenths[2] == "beam.column.diameter = 0.3");
  CHECK(runs_of("[[sweep]]\nkey = \"path.when_unstable\"\nvalues = [\"jump\", \"stop\"]") ==
        Texts{"path.when_unstable = \"jump\"", "path.when_unstable = \"stop\""});
  CHECK(runs_of("[[sweep]]\nkey = \"support.1.displacement\"\nvalues = [[0, 0, 1], [0, 0, 2.5]]") ==
        Texts{"support.1.displacement = [0, 0, 1]", "support.1.displacement = [0, 0, 2.5]"});
}

TEST_CASE("Values may be expressions, of the constants that their run has") {
  const std::string constants = "[constants]\nt = 3\nL = \"2*t\"\n";
  CHECK(runs_of(constants + "[[sweep]]\nkey = \"beam.column.diameter\"\nvalues = [1, \"t/2\"]") ==
        Texts{"beam.column.diameter = 1", "beam.column.diameter = 1.5"});
  CHECK(runs_of(constants + "[[sweep]]\nkey = \"beam.column.particles\"\nrange = [4, \"L\", \"2\"]") ==
        Texts{"beam.column.particles = 4", "beam.column.particles = 6"});
  CHECK(runs_of(constants + "[[sweep]]\nkey = \"constants.t\"\nvalues = [4, \"t/2\"]\n"
                            "[[sweep]]\nkey = \"beam.column.particles\"\nvalues = [\"L+1\"]") ==
        Texts{"constants.t = 4, beam.column.particles = 9", "constants.t = 1.5, beam.column.particles = 4"});
  CHECK_THROWS_WITH(runs_of("[[sweep]]\nkey = \"constants.t\"\nvalues = [1, 2]"), Catch::Contains("\"t\" is no constant of this file; there is none"));
}

TEST_CASE("In tables and names of directories words have no quotes, and numbers no digits that are not needed") {
  const ScratchDirectory scratch;
  const std::string sweeps = "[[sweep]]\nkey = \"path.when_unstable\"\nvalues = [\"jump\"]\n[[sweep]]\nkey = \"path.to\"\nvalues = [0.1, \"3*0.1\"]\n";
  const std::vector<PreparedRun> runs = prepare_runs(scratch.file("p.toml", swept + sweeps), {}).runs;
  REQUIRE(runs.size() == 2);
  CHECK(swept_values(runs[0]) == std::vector<Cell>{std::string("jump"), 0.1});
  CHECK(swept_values(runs[1]) == std::vector<Cell>{std::string("jump"), 3 * 0.1});
  CHECK(run_name(1, 2, runs[0].swept) == "1_when_unstable=jump_to=0.1");
  CHECK(run_name(2, 2, runs[1].swept) == "2_when_unstable=jump_to=0.30000000000000004");
}

TEST_CASE("Several sweeps: all combinations, or in step") {
  const std::string a = "[[sweep]]\nkey = \"path.to\"\nvalues = [1, 2]\n",
                    b = "[[sweep]]\nkey = \"path.steps\"\nvalues = [10, 20, 30]\n",
                    c = "[[sweep]]\nkey = \"beam.column.diameter\"\nvalues = [3, 4]\n";
  CHECK(runs_of(a + b) == Texts{"path.to = 1, path.steps = 10", "path.to = 1, path.steps = 20",
                                "path.to = 1, path.steps = 30", "path.to = 2, path.steps = 10",
                                "path.to = 2, path.steps = 20", "path.to = 2, path.steps = 30"});
  const std::string zip = "zip = \"pair\"\n";
  CHECK(runs_of(a + zip + c + zip) ==
        Texts{"path.to = 1, beam.column.diameter = 3", "path.to = 2, beam.column.diameter = 4"});
  CHECK(runs_of(a + zip + b + c + zip).size() == 6);
}

TEST_CASE("Settings change the sweep, but not a key that is swept") {
  const std::string sweep = "[[sweep]]\nkey = \"beam.column.particles\"\nvalues = [4, 5]\n";
  CHECK(runs_of(sweep, {{"sweep.1.values", "[7]"}}) == Texts{"beam.column.particles = 7"});
  CHECK(runs_of(sweep, {{"beam.column.diameter", "3"}}).size() == 2);
  CHECK_THROWS_WITH(runs_of(sweep, {{"beam.1.particles", "3"}}),
                    "--set: beam.1.particles: is swept by line 11 of the file; set sweep.1.values instead");
}

TEST_CASE("Every run is prepared with its own settings") {
  const ScratchDirectory scratch;
  const auto runs = prepare_runs(
      scratch.file("p.toml", std::string(swept) + "[[sweep]]\nkey = \"beam.column.particles\"\nrange = [4, 6, 1]"),
      {{"title", "swept"}}).runs;
  REQUIRE(runs.size() == 3);
  for (int i = 0; i < 3; ++i) {
    CHECK(runs[i].problem.beams[0].particles == 4 + i);
    CHECK(runs[i].model.particles() == 4 + i);
    CHECK(runs[i].problem.title == "swept");
    CHECK(runs[i].swept[0].value == std::to_string(4 + i));
  }
}

TEST_CASE("A mistake of all runs is told once, and one of some names the first") {
  const ScratchDirectory scratch;
  const auto said = [&](const std::string& text) -> std::string {
    try {
      prepare_runs(scratch.file("p.toml", text));
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  const std::string file = scratch / "p.toml",
                    sweep = "[[sweep]]\nkey = \"beam.column.particles\"\nrange = [2, 36, 1]\n";
  CHECK(said(swept + sweep + "[[gravity]]\nacceleration = [0, 0, 1]") ==
        file + ":2:1: beam.column.density: is missing; it must be a positive number, gravity.1 of line 14 needs it");
  CHECK(said(swept + sweep + "[[group]]\nname = \"g\"\nmiddle = 5") ==
        file +
            ":16:10: group.g.middle: must be at most 2, the particles of \"all\", is 5 (in the run with "
            "beam.column.particles = 2; in 3 runs)");
  CHECK(said(swept + sweep + "[[group]]\nname = \"g\"\nmiddle = 3") ==
        file +
            ":16:10: group.g.middle: must be at most 2, the particles of \"all\", is 3 (in the run with "
            "beam.column.particles = 2)");
  CHECK(
      said(std::string(swept) + "[[sweep]]\nkey = \"beam.column.particles\"\nvalues = [3, \"x\"]") ==
      file +
          ":13:10: beam.column.particles: must be an integer from 2 to 100000000, is the string \"x\" (in the run with "
          "beam.column.particles = \"x\")");
}

TEST_CASE("A sweep may halve, or set several keys") {
  const ScratchDirectory scratch;
  const std::string path = "[path]\n[[sweep]]\nkey = [\"path.to\", \"path.steps\"]\n";
  CHECK(runs_of(path + "values = [1, 2]") == Texts{"path.to = 1, path.steps = 1", "path.to = 2, path.steps = 2"});
  const std::string halves = path + "bisect = \"energy\"\nlevel = 0.5\nbetween = ";
  const auto bisection = [&](const std::string& more) {
    return *prepare_runs(scratch.file("p.toml", std::string(swept) + halves + more)).bisection;
  };
  const Bisection whole = bisection("[3, 20]");
  CHECK(whole.keys == Texts{"path.to", "path.steps"});
  CHECK(whole.integers);
  CHECK(whole.middle() == 11);
  CHECK(whole.tolerance == Approx(0.017).epsilon(1e-12));
  CHECK(whole.level == 0.5);
  CHECK(whole.at == "final");
  CHECK(whole.settings(7)[1].value == "7");
  for (Bisection b = whole;; b.lo = b.middle())                  // towards either end, it ends at neighbours
    if (b.narrow()) { CHECK(b.hi - b.lo == 1); break; }
  for (Bisection b = whole;; b.hi = b.middle())
    if (b.narrow()) { CHECK(b.hi - b.lo == 1); break; }
  CHECK_THROWS_AS(bisection("[3, 20.5]"), InputError);           // path.steps is a whole number

  const std::string reals = std::string(swept) + "[path]\n[[sweep]]\nkey = \"path.to\"\nbisect = \"energy\"\nbetween = [2.0, 1]\n";
  const PreparedRuns down = prepare_runs(scratch.file("q.toml", reals));
  CHECK(down.runs.size() == 2);
  CHECK(down.runs[0].problem.path.to == 2);
  CHECK(down.bisection->middle() == 1.5);
  CHECK_FALSE(down.bisection->integers);
  CHECK_FALSE(prepare_runs(scratch.file("r.toml", swept)).bisection);
  // A tolerance below the spacing of doubles still comes to an end.
  Bisection fine = *down.bisection;
  fine.tolerance = 1e-300;
  int halvings = 0;
  for (; !fine.narrow() && halvings < 100; ++halvings) fine.lo = fine.middle();
  CHECK(halvings < 60);
}
