// Processes that mpirun starts together, the ranks: the same numbers as one process has.
#include "catch.hpp"
#include "results/files.hpp"
#include "scratch_directory.hpp"
#include "study/program.hpp"

#include <charconv>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sys/resource.h>

#ifdef ELAMIN_MPIRUN

namespace {

// Open MPI starts nothing as root, or on fewer cores than ranks, unless it is told to.
const std::string by_ranks = "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 '" ELAMIN_MPIRUN "' --oversubscribe --bind-to none -n ";

Answer ranks_say(int ranks, const std::string& arguments) {
  Answer answer;
  std::FILE* pipe = popen((by_ranks + std::to_string(ranks) + " '" ELAMIN_PROGRAM "' " + arguments + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer;
  for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) answer.text.append(buffer.data(), n);
  const int status = pclose(pipe);
  answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return answer;
}

std::optional<double> number_in(const std::string& cell) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc() && end == cell.data() + cell.size() ? std::optional(value) : std::nullopt;
}

/// Cell by cell: the same words, and numbers that differ by 1e-10 of the column's largest at the most. What is the rounding of a residual is not held.
void check_same_table(const std::string& a, const std::string& b) {
  const auto one = csv_rows(a), other = csv_rows(b);
  REQUIRE(one.size() == other.size());
  REQUIRE(one.size() > 1);
  REQUIRE(one[0] == other[0]);
  for (std::size_t c = 0; c < one[0].size(); ++c) {
    const std::string& column = one[0][c];
    if (column == "residual" || column == "iterations" || column == "step_size" || column.starts_with("error")) continue;
    INFO(a << ": " << column);
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
}

void check_same_as_alone(const std::string& problem, const std::string& more, const std::vector<std::string>& tables) {
  const ScratchDirectory scratch;
  const std::string file = "'" ELAMIN_ROOT "/problems/" + problem + ".toml' --quiet " + more + " -o ";
  const Answer alone = elamin_says(file + "'" + (scratch / "alone") + "'");
  INFO(alone.text);
  const Answer together = ranks_say(2, file + "'" + (scratch / "together") + "'");
  INFO(together.text);
  REQUIRE(alone.status == 0);
  REQUIRE(together.status == 0);
  CHECK(files_in(scratch / "alone") == files_in(scratch / "together"));
  for (const std::string& table : tables) check_same_table(scratch / ("alone/" + table), scratch / ("together/" + table));
}

}  // namespace

TEST_CASE("two ranks and one process: three branch points of a column", "[ranks]") {
  check_same_as_alone("hencky_hinged", "--set path.steps=20", {"path.csv", "events.csv"});
}

TEST_CASE("two ranks and one process: a column buckles, and both its branches are followed", "[ranks]") {
  check_same_as_alone("column_square", "", {"path.csv", "events.csv"});
}

TEST_CASE("two ranks and one process: a sheet in contact", "[ranks]") {
  check_same_as_alone("sheet_indented", "--set path.steps=4", {"path.csv", "events.csv"});
}

TEST_CASE("two ranks and one process: the lowest modes of a mast, by SLEPc", "[ranks]") {
  check_same_as_alone("static/ring_modes", "", {"modes.csv"});
}

TEST_CASE("conjugate gradients with multigrid find the same equilibrium of a sheet", "[ranks]") {
  check_same_as_alone("sheet_indented", "--set path.steps=2 --set 'solver.petsc=\"-pc_type gamg\"'", {"path.csv"});
}

TEST_CASE("low-rank factors of MUMPS find the same equilibrium of a sheet", "[ranks]") {
  check_same_as_alone("sheet_indented", "--set path.steps=2 --set 'solver.petsc=\"-mat_mumps_icntl_35 1 -mat_mumps_cntl_7 1e-10\"'", {"path.csv"});
}

TEST_CASE("ranks: wrong input is said once", "[ranks]") {
  const ScratchDirectory scratch;
  const Answer nothing = ranks_say(2, "'" + (scratch / "nothing.toml") + "'");
  CHECK(nothing.status == 1);
  CHECK(nothing.text.find("nothing.toml: ") == nothing.text.rfind("nothing.toml: "));
  const std::string column = "'" ELAMIN_ROOT "/problems/hencky_hinged.toml' --set 'solver.petsc=\"pc_type gamg\"' --quiet -o '" + (scratch / "out") + "'";
  const Answer option = ranks_say(2, column);
  CHECK(option.status == 1);
  CHECK(option.text.find("solver.petsc: PETSc does not read \"pc_type gamg\"; options begin with a dash") != std::string::npos);
}

TEST_CASE("a sweep by three ranks, one of them killed, is finished by the next call", "[ranks][sweep]") {
  const ScratchDirectory scratch;
  // Ten columns; the runs take tenths of a second.
  const std::string sweep = "'" ELAMIN_ROOT "/problems/hencky_hinged.toml' --quiet --set 'sweep.1.key=\"beam.column.diameter\"'";
  std::ifstream in(ELAMIN_ROOT "/problems/hencky_hinged.toml");
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string chain = text.substr(0, text.find("[[expect]]"));
  const std::string file = "'" + scratch.file("sweep.toml", chain + "[[sweep]]\nkey = \"path.steps\"\nvalues = [200, 201, 202, 203, 204, 205, 206, 207, 208, 209]\n") + "' --quiet -o ";
  const Answer alone = elamin_says(file + "'" + (scratch / "alone") + "'");
  INFO(alone.text);
  REQUIRE(alone.status == 0);
  // The first rank that has a run under way kills itself: the shell that starts it limits its processor time.
  const std::string together = "'" + (scratch / "together") + "'";
  const std::string killed = by_ranks + "3 sh -c 'if [ $OMPI_COMM_WORLD_RANK = 1 ]; then ulimit -t 1; fi; exec \"$0\" \"$@\"' '" ELAMIN_PROGRAM "' " + file + together + " >/dev/null 2>&1";
  const int status = std::system(killed.c_str());
  CHECK(status != 0);
  const Answer next = ranks_say(3, file + together);
  INFO(next.text);
  REQUIRE(next.status == 0);
  std::ifstream one(scratch / "alone/sweep.csv"), other(scratch / "together/sweep.csv");
  CHECK(std::string{std::istreambuf_iterator<char>(one), {}} == std::string{std::istreambuf_iterator<char>(other), {}});
  CHECK(files_in(scratch / "alone") == files_in(scratch / "together"));
}

#endif
