// What is printed or written goes nowhere: the program says so, and what it computed is kept.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/program.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

namespace {

const std::string printing_column = pressed_column + "[path]\nsteps = 10\n";

/// Runs `elamin ARGUMENTS` through bash, with what follows them there; the status.
int status_of(const std::string& arguments, const std::string& more) {
  const int status = std::system(("bash -c \"'" ELAMIN_PROGRAM "' " + arguments + " " + more + "\"").c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

std::string status_in(const std::string& directory) { return nlohmann::json::parse(text_of(directory + "/summary.json"))["status"]; }

}  // namespace

TEST_CASE("a standard output that is full is no success, and a run keeps what it has", "[study][streams]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("column.toml", printing_column), said = scratch / "said";
  for (const char* command : {"energy --json ", "energy ", "check "}) {
    INFO(command);
    CHECK(status_of(command + file, "> /dev/full 2> " + said) == 2);
    CHECK(text_of(said).find("standard output cannot be written") != std::string::npos);
  }
  CHECK(status_of("schema", "> /dev/full 2> " + said) == 2);
  CHECK(status_of(file + " -o " + (scratch / "out"), "> /dev/full 2> " + said) == 2);
  CHECK(text_of(said).find("standard output cannot be written") != std::string::npos);
  CHECK(status_in(scratch / "out") == "done");
}

TEST_CASE("with standard output closed, and read by nobody, a run leaves the same files", "[study][streams]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("column.toml", printing_column);
  REQUIRE(status_of(file + " -o " + (scratch / "whole"), "> /dev/null") == 0);
  CHECK(status_of(file + " -o " + (scratch / "closed"), "<&- >&- 2>&-") == 0);
  CHECK(status_of(file + " -o " + (scratch / "unread"), "| true; exit \\${PIPESTATUS[0]}") == 0);
  for (const char* directory : {"closed", "unread"})
    for (const char* name : {"path.csv", "events.csv", "states/final.data"})
      CHECK(text_of(scratch / directory + "/" + name) == text_of(scratch / "whole/" + name));
}

TEST_CASE("a terminal that is closed stops a run in order", "[study][streams]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("column.toml", printing_column);
  const pid_t child = fork();
  if (child == 0) {
    execl(ELAMIN_PROGRAM, ELAMIN_PROGRAM, file.c_str(), "--quiet", "--set", "path.steps=1000000", "-o", (scratch / "out").c_str(), nullptr);
    _exit(127);
  }
  while (!std::filesystem::exists(scratch / "out/path.csv") || std::filesystem::file_size(scratch / "out/path.csv") < 2000)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(child, SIGHUP);
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 130);
  CHECK(status_in(scratch / "out") == "interrupted");
  CHECK(std::filesystem::exists(scratch / "out/states/final.data"));
}

// METIS, which orders the unknowns of large structures, has a handler of its own for SIGTERM while it works.
TEST_CASE("a run that is told to end while unknowns are ordered ends", "[study][streams]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("sheet.toml", R"([[sheet]]
name = "sheet"
shape = "rectangle"
size = [180, 156]
spacing = 1
youngs_modulus = 1000
density = 1
[[group]]
name = "rim"
of = "sheet"
inside = { shape = "block", lo = [-91, -80, -1], hi = [-88, 80, 1] }
[[support]]
group = "rim"
[[gravity]]
acceleration = [0, 0, -1e-6]
[study]
type = "equilibrium"
)");
  for (const char* after : {"0.5", "0.6", "0.8"}) {
    INFO(after);
    const std::string out = scratch / after, told = std::string("timeout --preserve-status -s TERM ") + after + " '" ELAMIN_PROGRAM "' " + file + " --quiet -o " + out;
    const int status = std::system((told + " > /dev/null 2>&1").c_str());
    CHECK(WEXITSTATUS(status) == 130);
    CHECK(status_in(out) == "interrupted");
  }
}

TEST_CASE("a sweep and a bisection run to their end where standard output is full, and what is wrong is no crash where standard error is", "[study][streams]") {
  const ScratchDirectory scratch;
  const std::string sweep = scratch.file("sweep.toml", printing_column + "[[sweep]]\nkey = \"path.steps\"\nvalues = [2, 3, 4]\n");
  CHECK(status_of(sweep + " -o " + (scratch / "sweep"), "> /dev/full 2> /dev/null") == 2);
  CHECK(csv_rows(scratch / "sweep/sweep.csv").size() == 4);
  const std::string halving = scratch.file("halving.toml", printing_column + "[[sweep]]\nkey = \"beam.column.youngs_modulus\"\nbetween = [0.5e6, 2e6]\n"
                                           "bisect = \"energy\"\nlevel = 1e-30\n");
  CHECK(status_of(halving + " -o " + (scratch / "halving"), "> /dev/full 2> /dev/null") == 2);
  CHECK(status_in(scratch / "halving") == "not_converged");              // the same at both ends, and both were run
  CHECK(csv_rows(scratch / "halving/sweep.csv").size() == 3);
  CHECK(status_of("no_such_file.toml", "2> /dev/full") == 1);
}

TEST_CASE("a file that meets its limit at any byte ends a run in a sentence, what was written is whole, and the run goes on to the same bits", "[study][streams]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("column.toml", printing_column + "frames = 3\n"), said = scratch / "said";
  REQUIRE(status_of(file + " --quiet -o " + (scratch / "whole"), "") == 0);
  std::uintmax_t largest = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(scratch / "whole"))
    if (entry.is_regular_file()) largest = std::max(largest, entry.file_size());
  std::uint64_t seed = 19;
  int stopped = 0, resumed = 0;
  for (rlim_t limit = 0; limit < largest; limit += 1 + (seed = seed * 6364136223846793005u + 1442695040888963407u) % (largest / 20)) {
    INFO(limit);
    const std::string out = scratch / "out";
    std::filesystem::remove_all(out);
    const pid_t child = fork();
    if (child == 0) {
      const int descriptor = open(said.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
      const rlimit limits{limit, limit};
      if (limit > 0) dup2(descriptor, STDERR_FILENO);                     // which is not to be a file of no bytes
      setrlimit(RLIMIT_FSIZE, &limits);
      execl(ELAMIN_PROGRAM, ELAMIN_PROGRAM, file.c_str(), "--quiet", "--checkpoint", "0", "-o", out.c_str(), nullptr);
      _exit(127);
    }
    int status = 0;
    waitpid(child, &status, 0);
    REQUIRE(WIFEXITED(status));
    REQUIRE(WEXITSTATUS(status) == 2);
    if (limit > 200) CHECK(text_of(said).find(": cannot be written: File too large") != std::string::npos);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out)) {
      if (entry.path().extension() != ".csv") continue;
      const std::string text = text_of(entry.path().string());
      CHECK((text.empty() || text.back() == '\n'));
    }
    if (std::filesystem::exists(out + "/summary.json")) {
      ++stopped;
      CHECK(nlohmann::json::parse(text_of(out + "/summary.json"))["status"] == "interrupted");
    }
    if (std::filesystem::exists(out + "/.elamin.checkpoint")) {
      ++resumed;
      REQUIRE(status_of("resume --quiet " + out, "") == 0);
      for (const char* name : {"path.csv", "events.csv", "states/final.data"}) CHECK(text_of(out + "/" + name) == text_of(scratch / "whole/" + name));
    }
  }
  CHECK(stopped > 5);
  CHECK(resumed > 5);
}

#ifndef __SANITIZE_ADDRESS__                     // which maps far more than any of these limits

TEST_CASE("under any limit of memory a run ends, in a sentence where that is too little, and what was begun says so", "[study][memory]") {
  const ScratchDirectory scratch;
  const std::string column = scratch.file("column.toml", printing_column), said = scratch / "said", problems = ELAMIN_ROOT "/problems/";
  const std::string sheet = scratch.file("sheet.toml", R"(
[[sheet]]
name = "plate"
shape = "rectangle"
size = [0.15, 0.15]
spacing = 1.0e-3
youngs_modulus = 1.0e6
density = 800.0
[[group]]
name = "edge"
of = "plate"
inside = {shape = "block", lo = [-1, -1, -1], hi = [-0.0740, 1, 1]}
[[support]]
group = "edge"
[[gravity]]
acceleration = [0, 0, -0.01]
[path]
steps = 1
)");
  int done = 0, refused = 0, broken_off = 0;
  for (const std::string& file : {column, problems + "sheet_indented.toml", problems + "boxes_stacked.toml", sheet})
    for (const int kilobytes : {100000, 160000, 240000, 300000, 400000}) {
      INFO(file << " " << kilobytes);
      const std::string out = scratch / "out";
      std::filesystem::remove_all(out);
      const std::string limited = "bash -c \"ulimit -v " + std::to_string(kilobytes) + "; timeout -s KILL 60 '" ELAMIN_PROGRAM "' " + file + " --threads 2 --quiet -o " + out +
                                  " > " + said + " 2>&1\"";
      const int status = WEXITSTATUS(std::system(limited.c_str()));
      INFO(text_of(said));
      ++(status == 0 ? done : refused);
      if (status == 0) continue;
      const bool foreseen = text_of(said).find("GB before anything is solved; there are ") != std::string::npos;
      CHECK(status == (foreseen ? 1 : 2));
      CHECK((foreseen || text_of(said).find("not enough memory") != std::string::npos));
      if (!std::filesystem::exists(out + "/summary.json")) continue;
      ++broken_off;
      CHECK(status_in(out) == "interrupted");
    }
  CHECK(done > 5);
  CHECK(refused > 5);
  CHECK(broken_off > 2);
}

#endif
