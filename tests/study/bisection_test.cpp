// [[sweep]] with bisect: the value of a key at which an outcome changes.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/results_of.hpp"
#include "study/truss.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace {

nlohmann::json summary_of(const ScratchDirectory& scratch) { return nlohmann::json::parse(text_of(scratch / "p/summary.json")); }

std::string bisection(const std::string& rest) { return "[path]\nsteps = 5\n[[sweep]]\nkey = \"path.to\"\nbetween = [0.12, 0.05]\n" + rest; }

}  // namespace

TEST_CASE("the load at which a truss snaps, by halving", "[bisection]") {
  const ScratchDirectory scratch;
  const std::string expect = "[[expect]]\nobservable = \"threshold\"\nat = \"sweep\"\nvalue = " + std::to_string(truss_limit) + "\natol = 1e-5\n";
  const std::string file = scratch.file("p.toml", truss + bisection("tolerance = 1e-6\nbisect = \"z\"\n") + expect);
  const Answer answer = elamin_says("verify '" + file + "'");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  CHECK(answer.text.find("1 of 1 expectations met") != std::string::npos);
  const auto summary = summary_of(scratch);
  CHECK(summary["status"] == "done");
  const double lo = summary["threshold"][0], hi = summary["threshold"][1];
  CHECK(lo < truss_limit);
  CHECK(hi > truss_limit);
  CHECK(hi - lo <= 1e-6);
  CHECK(hi - lo > 2.5e-7);                                       // it halves no further than it must
  CHECK(summary["outcomes"] == nlohmann::json({"above", "below"}));
  const std::vector<TableRow> rows = table_of(scratch / "p/sweep.csv");
  CHECK(rows.size() == summary["runs"]);
  CHECK(rows.size() == 2 + 17);                                  // 0.07/2¹⁷ < 10⁻⁶
  for (std::size_t i = 0; i < rows.size(); ++i) {                // in the order of the key, on the right side of the threshold
    if (i > 0) CHECK(rows[i]["path.to"] > rows[i - 1]["path.to"]);
    CHECK((rows[i]["z"] > 0) == (rows[i]["path.to"] < truss_limit));
  }
}

TEST_CASE("an event that is missing is an outcome", "[bisection]") {
  const ScratchDirectory scratch;
  REQUIRE(elamin_says("'" + scratch.file("p.toml", truss + bisection("bisect = \"lambda\"\nat = \"limit:1\"\n")) + "' --quiet").status == 0);
  const auto summary = summary_of(scratch);
  CHECK(summary["threshold"][0] < truss_limit);
  CHECK(summary["threshold"][1] > truss_limit);
  CHECK(summary["outcomes"] == nlohmann::json({"missing", "above"}));
  const std::string message = summary["message"];
  CHECK(message.starts_with("lambda at limit:1 is missing with path.to = 0.0"));
  CHECK(message.find(" and there with 0.0") != std::string::npos);
  CHECK(summary["tolerance"].get<double>() == Approx(0.07e-3).epsilon(1e-12));
}

TEST_CASE("whole numbers are halved to neighbours, and several keys get one value", "[bisection]") {
  // The critical shortening of a clamped column falls with its length; data/exact/chain_critical.json has it.
  const std::string text = pressed_column + R"(
[path]
when_unstable = "stop"
[[sweep]]
key = ["beam.column.particles", "path.steps"]
between = [10, 40]
bisect = "lambda"
at = "branch:1"
level = 0.3
)";
  const ScratchDirectory scratch;
  const Answer answer = elamin_says("'" + scratch.file("p.toml", text) + "'");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  const auto summary = summary_of(scratch);
  const int lo = summary["threshold"][0], hi = summary["threshold"][1];
  CHECK(hi == lo + 1);
  for (const TableRow& row : table_of(scratch / "p/sweep.csv")) {
    CHECK(row["path.steps"] == row["beam.column.particles"]);
    CHECK((row["branch:1"] > 0.3) == (row["beam.column.particles"] <= lo));
  }
}

TEST_CASE("the same outcome at both ends leaves no threshold", "[bisection]") {
  const ScratchDirectory scratch;
  const Answer answer = elamin_says("'" + scratch.file("p.toml", truss + bisection("bisect = \"z\"\nlevel = -3\n")) + "'");
  CHECK(answer.status == 2);
  CHECK(answer.text.find("above at both ends") != std::string::npos);
  CHECK(summary_of(scratch)["threshold"].is_null());
  CHECK(table_of(scratch / "p/sweep.csv").size() == 2);
}

TEST_CASE("runs that halve the spacing are extrapolated together", "[bisection]") {
  // A clamped chain of n links of the whole length L buckles like a rod, but for a series in 1/n².
  const std::string text = R"(
plane = "xz"
[[beam]]
name = "rod"
particles = 11
from = [0, 0, 0]
to = [0, 0, 1]
diameter = 1e-3
bond_stiffness = 5e5
angle_stiffness = 10
[[group]]
name = "foot"
of = "rod"
first = 1
[[group]]
name = "head"
of = "rod"
last = 1
[[support]]
group = "foot"
[[support]]
group = "head"
directions = "x"
[[load]]
group = "head"
force = [0, 0, -12]
[path]
steps = 6
when_unstable = "stop"
locate = ["branch"]
[[sweep]]
key = "beam.rod.particles"
values = [11, 21, 41]
zip = "n"
[[sweep]]
key = "beam.rod.bond_stiffness"
values = [5e9, 10e9, 20e9]
zip = "n"
[[sweep]]
key = "beam.rod.angle_stiffness"
values = [10, 20, 40]
zip = "n"
[[expect]]
observable = "lambda"
at = "branch:1"
extrapolate = 2
value = 0.8224670334241132       # π² EI/L² of EI = B q = 1, over the load of 12
rtol = )";
  const ScratchDirectory scratch;
  const Answer met = elamin_says("verify '" + scratch.file("p.toml", text + "1e-7\n") + "'");
  INFO(met.text);
  CHECK(met.status == 0);
  CHECK(met.text.find("lambda at branch:1, extrapolated over 3 runs, is 0.822467") != std::string::npos);
  CHECK(elamin_says("verify --quiet '" + scratch.file("q.toml", text + "1e-15\n") + "'").status == 3);
}
