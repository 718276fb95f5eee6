// A path that is taken up again from a stored state goes on with the same numbers.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/results_of.hpp"
#include "study/truss.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace {

/// Runs the file, then again from each of its labelled states, and compares every row behind that state. A row at the very
/// load factor of the state may come again (an event that the state is).
void compare_restarts(const std::string& text, const std::vector<std::string>& labels, double tolerance) {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", text);
  REQUIRE(elamin_says("'" + file + "' --quiet -o '" + (scratch / "whole") + "'").status == 0);
  const std::vector<TableRow> whole = table_of(scratch / "whole/path.csv");
  for (const std::string& label : labels) {
    std::string state = label;
    std::replace(state.begin(), state.end(), ':', '-');
    INFO("from " << label);
    const Answer answer = elamin_says("'" + file + "' --quiet -o '" + (scratch / "rest") + "' --set path.start='\"whole/states/" + state + ".data\"'");
    INFO(answer.text);
    REQUIRE(answer.status == 0);
    std::vector<TableRow> rest = table_of(scratch / "rest/path.csv"), expected = whole;
    const auto from = std::find_if(expected.begin(), expected.end(), [&](const TableRow& r) { return r.text("label") == label; });
    REQUIRE(from != expected.end());
    REQUIRE(rest.front()["lambda"] == (*from)["lambda"]);
    REQUIRE(rest.front()["energy"] == Approx((*from)["energy"]).epsilon(1e-14));
    expected.erase(expected.begin(), from + 1);
    const std::string here = rest.front().text("lambda");
    rest.erase(rest.begin());
    while (rest.size() > expected.size() && rest.front().text("lambda") == here) rest.erase(rest.begin());
    REQUIRE(rest.size() == expected.size());
    for (std::size_t i = 0; i < rest.size(); ++i)
      for (const char* column : {"lambda", "energy", "bond", "angle", "z", "negative", "stage"}) {
        if (!rest[i].cells.count(column)) continue;
        INFO("row " << i << ", " << column);
        const std::string &a = rest[i].text(column), &b = expected[i].text(column);
        if (tolerance == 0 || a.empty() || std::isalpha(static_cast<unsigned char>(a[0]))) CHECK(a == b);
        else CHECK(std::stod(a) == Approx(std::stod(b)).epsilon(tolerance).margin(1e-20));
      }
  }
}

const std::string column = column_and_ends + R"(
[[support]]
group = "bottom"
[[support]]
group = "top"
displacement = [0, 0, -0.4e-3]
[[observe]]
name = "z"
group = "column"
quantity = "displacement.x"
reduce = "max"
[path]
steps = 10
[[expect]]
observable = "lambda"
at = "lambda=0.73"
value = 0.73
)";

}  // namespace

TEST_CASE("load steps go on from a stored state with the same numbers", "[restart]") {
  compare_restarts(column, {"initial", "branch:1", "jump:1"}, 1e-12);
}

TEST_CASE("a stored state says in which stage it is, and a restart goes on there", "[restart]") {
  const std::string stages = "[path]\nsteps = 10\n[[stage]]\nname = \"load\"\nto = 0.4\n[[stage]]\nname = \"unload\"\nto = 0.1\n[[stage]]\nname = \"hold\"\nto = 0.05\n";
  compare_restarts(truss + stages, {"initial", "load", "unload"}, 1e-12);
}

TEST_CASE("a support that entered before the state was stored goes on from there", "[restart]") {
  const std::string stages = R"(
[[support]]
name = "hand"
group = "apex"
directions = "z"
displacement = [0, 0, 0.3]
from_stage = "pull"
[path]
steps = 4
[[stage]]
name = "press"
vary = "load.weight"
to = 0.05
[[stage]]
name = "pull"
vary = "support.hand"
to = 1
[[stage]]
name = "back"
vary = "support.hand"
to = 0.5
)";
  compare_restarts(truss + stages, {"press", "pull"}, 1e-12);
}

TEST_CASE("what stands beside a state", "[restart]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", column);
  REQUIRE(elamin_says("'" + file + "' --quiet").status == 0);
  const auto json = nlohmann::json::parse(text_of(scratch / "p/states/branch-1.json"));
  CHECK(json["lambda"].get<double>() == row_of(table_of(scratch / "p/events.csv"), "branch:1")["lambda"]);
  CHECK(json["tail"].size() == 14);
  CHECK_FALSE(json.contains("stage"));
  // Null vectors of the event: orthonormal, zero where the ends are held.
  const auto modes = csv_rows(scratch / "p/states/branch-1.modes.csv");
  REQUIRE(modes.size() == 15);
  CHECK(modes[0] == std::vector<std::string>{"id", "ux1", "uy1", "uz1"});
  double square = 0;
  for (std::size_t i = 1; i < modes.size(); ++i)
    for (int c = 1; c <= 3; ++c) square += std::stod(modes[i][c]) * std::stod(modes[i][c]);
  CHECK(square == Approx(1).epsilon(1e-12));
  CHECK(std::stod(modes[1][1]) == 0);
  CHECK(std::abs(std::stod(modes[7][1])) > 0.1);
  CHECK_FALSE(std::filesystem::exists(scratch / "p/states/initial.modes.csv"));

  const std::string again = "' --quiet -o '" + (scratch / "q") + "' --set path.start='\"p/states/jump-1.data\"'";
  scratch.file("p/states/jump-1.json", "{\"lambda\": 0.5, \"tail\": [[0, 0, 1]]}");
  const Answer other = elamin_says("'" + file + again);
  CHECK(other.status == 1);
  CHECK(other.text.find("are not of one state") != std::string::npos);
  scratch.file("p/states/jump-1.json", "{\"lambda\": \"a\"}");
  const Answer broken = elamin_says("'" + file + again);
  CHECK(broken.status == 1);
  CHECK(broken.text.find("jump-1.json: must hold {\"lambda\"") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(scratch / "q"));
}
