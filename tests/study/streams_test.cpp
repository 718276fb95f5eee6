// What is printed goes nowhere: the program says so, and what it computed is kept.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/program.hpp"

#include <nlohmann/json.hpp>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <thread>

#include <fcntl.h>
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
