// A path has the same bits for any number of threads.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"

#include <set>

namespace {

// A strip of eleven rows of particles in its plane, clamped at both ends: so many that every loop over particles, bonds,
// angles and entries of the Hessian is shared.
const std::string strip = R"(
plane = "xy"
[[sheet]]
name = "strip"
shape = "rectangle"
size = [1000, 8.67]
spacing = 1
youngs_modulus = 1
[[group]]
name = "left"
of = "strip"
inside = { shape = "block", lo = [-501, -9, -1], hi = [-499.2, 9, 1] }
[[group]]
name = "right"
of = "strip"
inside = { shape = "block", lo = [499.2, -9, -1], hi = [501, 9, 1] }
[[group]]
name = "middle"
of = "strip"
inside = { shape = "block", lo = [-1, -9, -1], hi = [1, 9, 1] }
[[observe]]
name = "y"
group = "middle"
quantity = "position.y"
[[observe]]
name = "thrust"
group = "left"
quantity = "reaction.x"
[[support]]
group = "left"
)";

// All tables and states of a run.
std::set<std::string> results(const std::string& directory) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
    const std::string file = std::filesystem::relative(entry.path(), directory).string();
    if (entry.is_regular_file() && file != "log.txt" && file != "summary.json") files.insert(file);
  }
  return files;
}

// Runs it with one thread and with two, and compares every file but those with times in them.
std::vector<TableRow> same_with_two_threads(const std::string& text) {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", text);
  for (const char* threads : {"1", "2"}) {
    const Answer answer = elamin_says("'" + file + "' --quiet --threads " + threads + " -o '" + (scratch / threads) + "'");
    INFO(answer.text);
    REQUIRE(answer.status == 0);
  }
  const std::set<std::string> files = results(scratch / "1");
  CHECK(files == results(scratch / "2"));
  CHECK(files.count("path.csv") == 1);
  for (const std::string& name : files) {
    INFO(name);
    const bool same = text_of(scratch / ("1/" + name)) == text_of(scratch / ("2/" + name));
    CHECK(same);
  }
  return table_of(scratch / "1/path.csv");
}

}  // namespace

TEST_CASE("load steps into contact have the same bits for one and two threads", "[threads]") {
  const std::string pressed = R"(
[[support]]
group = "right"
[[contact]]
between = ["strip", "strip"]
law = "hertz"
effective_modulus = 1
[[wall]]
name = "disc"
group = "strip"
shape = "sphere"
radius = 300
center = [0, -305.2, 0]
side = "outside"
displacement = [0, 4, 0]
effective_modulus = 10
[[observe]]
name = "touching"
group = "disc"
quantity = "contacts"
[path]
steps = 3
eigenvalues = 1
)";
  const std::vector<TableRow> path = same_with_two_threads(strip + pressed);
  CHECK(path.front()["touching"] == 0);
  CHECK(path.back()["touching"] >= 1);
  CHECK(row_of(path, "contact:1")["lambda"] > 0);
}

TEST_CASE("branches in arc length have the same bits for one and two threads", "[threads]") {
  const std::string compressed = R"(
[[support]]
group = "right"
displacement = [-0.5, 0, 0]
[path]
method = "arc_length"
steps = 4
branches = 1
points = 5
when_unstable = "stop"
)";
  const std::vector<TableRow> path = same_with_two_threads(strip + compressed);
  CHECK(row_of(path, "branch:1")["lambda"] > 0);
  std::set<std::string> sides;
  for (const TableRow& row : path)
    if (row.text("parent") == "branch:1") sides.insert(row["y"] > 0 ? "up" : "down");
  CHECK(sides.size() == 2);
}
