// Processes that mpirun starts together, the ranks: the same numbers as one process has.
#include "catch.hpp"
#include "results/files.hpp"
#include "scratch_directory.hpp"
#include "study/program.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <set>

#ifdef ELAMIN_MPIRUN

namespace {

// Open MPI starts nothing as root, or on fewer cores than ranks, unless it is told to; in a container one process may not read from another one's memory.
const std::string by_ranks = "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_btl_vader_single_copy_mechanism=none '" ELAMIN_MPIRUN "' --oversubscribe --bind-to none -n ";

Answer ranks_say(int ranks, const std::string& arguments) {
  return shell_says(by_ranks + std::to_string(ranks) + " '" ELAMIN_PROGRAM "' " + arguments);
}

std::optional<double> number_in(const std::string& cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size() ? std::optional(value) : std::nullopt;
}

const std::string buckling_chain = R"(
plane = "xz"
[[beam]]
name = "column"
section = "cylinder"
particles = 11
center = [0, 0, 0]
axis = [0, 0, 1]
diameter = 1.0e-3
youngs_modulus = 0.96e6
[[group]]
name = "bottom"
of = "column"
first = 1
[[group]]
name = "top"
of = "column"
last = 1
[[support]]
group = "bottom"
[[support]]
group = "top"
directions = "x"
[[load]]
group = "top"
total_force = [0, 0, -1]
)";

// A strip with two clamped ends, and a ball that comes down on its middle.
const std::string indented = R"(
[[sheet]]
name = "sheet"
shape = "rectangle"
size = [10.0e-3, 0.0104]
center = [0, 0, 0]
spacing = 1.0e-3
youngs_modulus = 1.0e6
[[group]]
name = "left"
of = "sheet"
inside = {shape = "block", lo = [-1, -1, -1], hi = [-0.0039, 1, 1]}
[[support]]
group = "left"
[[group]]
name = "right"
of = "sheet"
inside = {shape = "block", lo = [0.0039, -1, -1], hi = [1, 1, 1]}
[[support]]
group = "right"
[[wall]]
name = "ball"
group = "sheet"
shape = "sphere"
side = "outside"
center = [0, 0, 5.5e-3]
radius = 5.0e-3
youngs_modulus = 1.0e6
displacement = [0, 0, -1.2e-3]
)";

/// Of some columns each cell: the same words, and numbers that differ by 1e-10 of the column's largest at the most.
void check_same_table(const std::string& a, const std::string& b, const std::set<std::string>& columns) {
  const auto one = csv_rows(a), other = csv_rows(b);
  REQUIRE(one.size() == other.size());
  REQUIRE(one.size() > 1);
  REQUIRE(one[0] == other[0]);
  std::size_t held = 0;
  for (std::size_t c = 0; c < one[0].size(); ++c) {
    if (!columns.contains(one[0][c])) continue;
    ++held;
    INFO(a << ": " << one[0][c]);
    double largest = 0;
    for (std::size_t r = 1; r < one.size(); ++r)
      if (const auto value = number_in(one[r].at(c))) largest = std::max(largest, std::abs(*value));
    for (std::size_t r = 1; r < one.size(); ++r) {
      INFO("row " << r << ": " << one[r].at(c) << ", " << other[r].at(c));
      const auto x = number_in(one[r].at(c)), y = number_in(other[r].at(c));
      REQUIRE(x.has_value() == y.has_value());
      if (x) CHECK(std::abs(*x - *y) <= 1e-10 * largest);
      else CHECK(one[r][c] == other[r][c]);
    }
  }
  CHECK(held == columns.size());
}

/// Two ranks have what one process has: in path.csv and, if any events are expected, which are so many at least, in events.csv.
void check_same_as_alone(const std::string& problem, std::size_t events, const std::string& options = "") {
  const ScratchDirectory scratch;
  const std::string file = "'" + scratch.file("p.toml", problem) + "' --quiet -o ";
  const Answer alone = elamin_says(file + "'" + (scratch / "alone") + "'");
  INFO(alone.text);
  REQUIRE(alone.status == 0);
  const Answer together = ranks_say(2, file + "'" + (scratch / "together") + "'" + (options.empty() ? "" : " --set 'solver.petsc=\"" + options + "\"'"));
  INFO(together.text);
  REQUIRE(together.status == 0);
  CHECK(files_in(scratch / "alone") == files_in(scratch / "together"));
  check_same_table(scratch / "alone/path.csv", scratch / "together/path.csv", {"step", "label", "lambda", "energy", "stable", "negative"});
  REQUIRE(csv_rows(scratch / "alone/events.csv").size() >= events + 1);
  if (events > 0)
    check_same_table(scratch / "alone/events.csv", scratch / "together/events.csv", {"label", "lambda", "multiplicity", "energy", "stable", "negative"});
}

}  // namespace

TEST_CASE("two ranks and one process: a chain, its first branch point, and the branch that leaves it", "[ranks]") {
  // Closed form: P a = 4B sin²(π/20), a = d − P/(2K): 0.00464.
  check_same_as_alone(buckling_chain + "[path]\nmethod = \"arc_length\"\nsteps = 3\nto = 0.006\nbranches = 1\n", 1);
}

TEST_CASE("two ranks and one process: a sheet in contact", "[ranks]") { check_same_as_alone(indented + "[path]\nsteps = 2\n", 13); }

TEST_CASE("two ranks and one process: lowest modes, by SLEPc", "[ranks]") {
  const ScratchDirectory scratch;
  std::string below = buckling_chain;
  below.replace(below.find("[0, 0, -1]"), 10, "[0, 0, -0.003]");
  // In space each bends both ways: pairs of equal eigenvalues, which one Krylov space alone does not tell.
  const std::string in_space = below.substr(below.find("[[beam]]"));
  for (const std::string& problem : {below, in_space}) {
    const std::string file = "'" + scratch.file("p.toml", problem + "[study]\ntype = \"modes\"\n[modes]\ncount = 4\n") + "' --quiet --force -o ";
    const Answer alone = elamin_says(file + "'" + (scratch / "alone") + "'");
    INFO(alone.text);
    REQUIRE(alone.status == 0);
    const Answer together = ranks_say(2, file + "'" + (scratch / "together") + "'");
    INFO(together.text);
    REQUIRE(together.status == 0);
    check_same_table(scratch / "alone/modes.csv", scratch / "together/modes.csv", {"mode", "eigenvalue"});
  }
}

TEST_CASE("approximate factors and iterations find the same equilibrium of a sheet", "[ranks]") {
  const std::string options = GENERATE("-mat_mumps_icntl_35 1 -mat_mumps_cntl_7 1e-10", "-pc_type gamg");
  check_same_as_alone(indented + "[path]\nsteps = 1\nlocate = []\n", 0, options);
}

TEST_CASE("ranks: wrong input is said once", "[ranks]") {
  const ScratchDirectory scratch;
  const Answer nothing = ranks_say(2, "'" + (scratch / "nothing.toml") + "'");
  CHECK(nothing.status == 1);
  CHECK(nothing.text.find("nothing.toml: ") != std::string::npos);
  CHECK(nothing.text.find("nothing.toml: ") == nothing.text.rfind("nothing.toml: "));
}

TEST_CASE("a sweep by three ranks, one of them killed, is finished by the next call", "[ranks][sweep]") {
  const ScratchDirectory scratch;
  const std::string problem = buckling_chain + "[path]\nmethod = \"arc_length\"\nto = 0.05\n[[sweep]]\nkey = \"path.steps\"\nvalues = [200, 201, 202, 203, 204, 205, 206, 207]\n";
  const std::string file = "'" + scratch.file("sweep.toml", problem) + "' --quiet -o ";
  const std::string together = scratch / "together", pid = scratch / "pid";
  const Answer alone = elamin_says(file + "'" + (scratch / "alone") + "'");
  INFO(alone.text);
  REQUIRE(alone.status == 0);
  // Each rank tells its number; rank 1 is killed as soon as the first run has its directory.
  const std::string kill = "while ! ls '" + together + "'/*/summary.json; do sleep 0.01; done; kill -9 $(cat '" + pid + ".1')";
  const std::string begun = by_ranks + "3 sh -c 'echo $$ >\"" + pid + ".$OMPI_COMM_WORLD_RANK\"; exec \"$0\" \"$@\"' '" ELAMIN_PROGRAM "' " + file + "'" + together + "'";
  CHECK(std::system(("{ (" + kill + ") & " + begun + "; s=$?; wait; exit $s; } >/dev/null 2>&1").c_str()) != 0);
  CHECK_FALSE(std::filesystem::exists(together + "/sweep.csv"));
  const Answer next = ranks_say(3, file + "'" + together + "'");
  INFO(next.text);
  REQUIRE(next.status == 0);
  CHECK(text_of(scratch / "alone/sweep.csv") == text_of(together + "/sweep.csv"));
  CHECK(files_in(scratch / "alone") == files_in(together));
}

#endif
