// A path has the same bits for any number of threads.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"

#include <filesystem>
#include <set>

#ifndef __SANITIZE_ADDRESS__                     // which would take many times as long, and has no say in bits

namespace {

// All tables and states of a run.
std::set<std::string> results(const std::string& directory) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory)) {
    const std::string file = std::filesystem::relative(entry.path(), directory).string();
    if (entry.is_regular_file() && file != "log.txt" && file != "summary.json") files.insert(file);
  }
  return files;
}

// Runs it with one thread, with two and with four, and compares every file but those with times in them.
std::vector<TableRow> same_with_any_threads(const std::string& text) {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", text);
  for (const char* threads : {"1", "2", "4"}) {
    const Answer answer = elamin_says("'" + file + "' --quiet --threads " + threads + " -o '" + (scratch / threads) + "'");
    INFO(answer.text);
    REQUIRE(answer.status == 0);
  }
  const std::set<std::string> files = results(scratch / "1");
  CHECK(files.count("path.csv") == 1);
  for (const std::string more : {"2", "4"}) {
    CHECK(files == results(scratch / more));
    for (const std::string& name : files) {
      INFO(name << " with " << more);
      const bool same = text_of(scratch / ("1/" + name)) == text_of(scratch / (more + "/" + name));
      CHECK(same);
    }
  }
  return table_of(scratch / "1/path.csv");
}

}  // namespace

// Both structures have so many particles that every loop over particles, bonds, angles and entries of the Hessian is shared.

TEST_CASE("load steps into contact have the same bits for one, two and four threads", "[threads]") {
  // A layer whose upper edge is driven down onto a disc.
  const std::vector<TableRow> path = same_with_any_threads(R"(
plane = "xy"
[[sheet]]
name = "layer"
shape = "rectangle"
size = [500, 8.67]
spacing = 1
youngs_modulus = 1
[[group]]
name = "top"
of = "layer"
inside = { shape = "block", lo = [-501, 3.8, -1], hi = [501, 9, 1] }
[[support]]
group = "top"
displacement = [0, -0.153, 0]
[[contact]]
between = ["layer", "layer"]
law = "hertz"
effective_modulus = 1
[[wall]]
name = "disc"
group = "layer"
shape = "sphere"
radius = 100
center = [0.1, -104.985, 0]
side = "outside"
effective_modulus = 1
[[observe]]
name = "thrust"
group = "top"
quantity = "reaction.y"
[[observe]]
name = "touching"
group = "disc"
quantity = "contacts"
[path]
steps = 1
)");
  CHECK(path.front()["touching"] == 0);
  CHECK(path.back()["touching"] >= 1);
  CHECK(row_of(path, "contact:1")["lambda"] > 0);
}

TEST_CASE("branches in arc length have the same bits for one, two and four threads", "[threads]") {
  // A strip in its plane that is compressed until it buckles to one side or the other.
  const std::vector<TableRow> path = same_with_any_threads(R"(
plane = "xy"
[[sheet]]
name = "strip"
shape = "rectangle"
size = [250, 8.67]
spacing = 1
youngs_modulus = 1
[[group]]
name = "left"
of = "strip"
inside = { shape = "block", lo = [-126, -9, -1], hi = [-124.2, 9, 1] }
[[group]]
name = "right"
of = "strip"
inside = { shape = "block", lo = [124.2, -9, -1], hi = [126, 9, 1] }
[[group]]
name = "middle"
of = "strip"
inside = { shape = "block", lo = [-1, -9, -1], hi = [1, 9, 1] }
[[support]]
group = "left"
[[support]]
group = "right"
displacement = [-2, 0, 0]
[[observe]]
name = "y"
group = "middle"
quantity = "displacement.y"
[path]
method = "arc_length"
steps = 4
branches = 1
points = 4
when_unstable = "stop"
)");
  CHECK(row_of(path, "branch:1")["lambda"] > 0);
  std::set<std::string> sides;
  for (const TableRow& row : path)
    if (row.text("parent") == "branch:1") sides.insert(row["y"] > 0 ? "up" : "down");
  CHECK(sides.size() == 2);
}

#endif
