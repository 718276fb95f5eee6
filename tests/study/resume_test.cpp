// A run that is stopped, however, and goes on leaves the same files as one that never stopped.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/program.hpp"
#include "study/truss.hpp"

#include "core/directory_lock.hpp"
#include "core/interrupt.hpp"
#include "core/timing.hpp"
#include "study/resume.hpp"
#include "study/run.hpp"

#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

extern char** environ;

namespace {

namespace fs = std::filesystem;
using elamin::exit_done;
using elamin::exit_interrupted;
using elamin::RunOptions;

using Files = std::map<std::string, std::string>;

/// Every file but log.txt; of summaries all but the times, the factorisations (a run that goes on may do one again) and how often the run was resumed.
Files files_of(const std::string& directory) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(directory)) {
    if (!entry.is_regular_file() || entry.path().filename() == "log.txt") continue;
    std::string text = text_of(entry.path().string());
    if (entry.path().filename() == "summary.json") {
      auto all = nlohmann::ordered_json::parse(text);
      all.erase("times"), all.erase("factorizations"), all.erase("resumed");
      text = all.dump();
    }
    files[fs::relative(entry.path(), directory).string()] = text;
  }
  return files;
}

void same_files(const std::string& directory, const std::string& expected) {
  const Files found = files_of(directory), whole = files_of(expected);
  for (const auto& [name, text] : whole) {
    INFO(name);
    const auto there = found.find(name);
    CHECK(there != found.end());
    if (there != found.end()) CHECK((there->second == text));
  }
  for (const auto& [name, text] : found) {
    INFO(name << " is too much");
    CHECK(whole.count(name) == 1);
  }
}

/// Asks to stop when it has been looked at so often; a whole run counts the looks.
class Stop {
 public:
  explicit Stop(long at) : at_(at), asked_([this] { return ++looks_ >= at_ && at_ > 0; }) { elamin::stop_asked = &asked_; }
  ~Stop() { elamin::stop_asked = nullptr; }
  Stop(const Stop&) = delete;
  Stop& operator=(const Stop&) = delete;
  long looks() const { return looks_; }

 private:
  long at_, looks_ = 0;
  std::function<bool()> asked_;
};

/// Checkpoints at every row; none but where a run is stopped.
constexpr double always = 0, at_stops = 1e9;

/// Runs to the end, and returns how often it looks whether it is to stop.
long run_whole(const RunOptions& options) {
  const Stop counting(0);
  REQUIRE(elamin::run(options).exit_status == exit_done);
  return counting.looks();
}

/// Runs a file, then again with so many stops, in order over its course, and compares what both leave.
void compare_stopped(const std::string& text, int stops, double checkpoint = at_stops) {
  const ScratchDirectory scratch;
  RunOptions options{.file = scratch.file("p.toml", text), .settings = {}, .directory = scratch / "whole", .threads = 1, .quiet = true, .checkpoint = checkpoint};
  const long looks = run_whole(options);
  REQUIRE(!fs::exists(scratch / "whole/.elamin.checkpoint"));
  options.directory = scratch / "parts";
  std::mt19937 random(7);
  for (int k = 0, ended = -1; ended < 0; ++k) {
    // Looks begin anew with every session.
    const Stop stop(k < stops ? std::uniform_int_distribution<long>(1, std::max(2L, 2 * looks / (stops + 1)))(random) : 0);
    const int now = k == 0 ? elamin::run(options).exit_status
                           : elamin::resume({.directory = options.directory, .threads = 1, .checkpoint = checkpoint, .quiet = true}).exit_status;
    INFO("session " << k);
    if (now != exit_interrupted) REQUIRE((ended = now) == exit_done);
    else REQUIRE(k < stops);
  }
  same_files(options.directory, scratch / "whole");
  const Files before = files_of(options.directory);
  CHECK(elamin::resume({.directory = options.directory, .threads = 1, .quiet = true}).exit_status == exit_done);     // it is finished
  CHECK((files_of(options.directory) == before));
}

/// Stops a run at so many places spread over it, one each: it is interrupted there, or whole, and goes on to the same files.
void stop_everywhere(const std::string& text, int stops) {
  const ScratchDirectory scratch;
  RunOptions options{.file = scratch.file("p.toml", text), .settings = {}, .directory = scratch / "whole", .threads = 1, .quiet = true, .checkpoint = at_stops};
  const long looks = run_whole(options);
  for (int k = 0; k < stops; ++k) {
    const long at = 1 + looks * (2 * k + 1) / (2 * stops);
    INFO("stopped at look " << at << " of " << looks);
    options.directory = scratch / std::to_string(k);
    {
      const Stop stop(at);
      REQUIRE(elamin::run(options).exit_status == exit_interrupted);
    }
    REQUIRE(elamin::resume({.directory = options.directory, .threads = 1, .checkpoint = at_stops, .quiet = true}).exit_status == exit_done);
    same_files(options.directory, scratch / "whole");
  }
}

/// A flat arch that is pressed at its crown: two branch points before it snaps.
const std::string arch = R"(plane = "xz"
[[beam]]
name = "a"
particles = 13
from = [-1, 0, 0]
to = [1, 0, 0]
rise = 0.3276815499288849
rest = "as_built"
diameter = 0.01
axial_stiffness = 12721.259807204735
bending_stiffness = 1
[[group]]
name = "feet"
ids = [1, 13]
[[group]]
name = "crown"
of = "a"
middle = 1
[[support]]
group = "feet"
[[load]]
group = "crown"
force = [0, 0, -20]
[path]
method = "arc_length"
steps = 20
branches = 4
frames = 5
)";
const std::string deflated = pressed_column_observed + "[path]\nsteps = 6\nwhen_unstable = \"follow\"\ndeflate = 4\n";

std::string example(const std::string& name) { return text_of(ELAMIN_ROOT "/problems/" + name + ".toml"); }

}  // namespace

TEST_CASE("load steps that are stopped go on with the same bits: snaps, films, eigenvalues, user events", "[resume]") {
  compare_stopped(pressed_column_observed + "[path]\nsteps = 40\nframes = 5\neigenvalues = 2\n[[event]]\nname = \"far\"\nobservable = \"z\"\nvalue = 1e-3\n", 6, always);
  compare_stopped(truss + "[path]\nsteps = 30\nto = 0.1\n", 4);
}

TEST_CASE("arc length with side branches, deflation and limit points goes on with the same bits", "[resume]") {
  compare_stopped(pressed_column_observed + "[path]\nmethod = \"arc_length\"\nsteps = 15\nbranches = 1\nframes = 6\n", 6);
  compare_stopped(example("truss_tall"), 5);
  compare_stopped(truss + "[path]\nsteps = 10\nto = 0.1\ndeflate = 2\n", 3);
}

TEST_CASE("what is looked for when a run is stopped is not taken for what is not there", "[resume]") {
  stop_everywhere(arch, 16);
  stop_everywhere(deflated, 16);
  stop_everywhere(pressed_column_observed + "[study]\ntype = \"modes\"\n[modes]\ncount = 3\n", 6);
  stop_everywhere(pressed_column_observed + "[study]\ntype = \"energy\"\n", 2);
}

TEST_CASE("paths with contacts, hard ones and bodies too, go on with the same bits", "[resume]") {
  compare_stopped(example("column_self_contact"), 4);
  compare_stopped(example("ring_hard_plates"), 4);
  compare_stopped(example("cubes_jammed"), 4, always);
}

TEST_CASE("stages go on with the same bits", "[resume]") {
  compare_stopped(example("arch_flipped"), 4);
  compare_stopped(example("arch_buckled"), 4);
}

TEST_CASE("a landscape that is stopped is explored anew, with the same bits", "[resume][landscape]") {
  compare_stopped(example("truss_landscape"), 5);
  compare_stopped(example("column_landscape"), 3);
}

TEST_CASE("motions go on with the same bits: grains, bodies, friction, films", "[resume]") {
  compare_stopped(example("grain_bounces"), 4);
  compare_stopped(example("cube_dropped"), 4);
  compare_stopped(example("column_swings"), 4);
}

TEST_CASE("a sweep goes on with the runs that are left, a bisection too", "[resume]") {
  compare_stopped(pressed_column_observed + "[path]\nsteps = 8\n[[sweep]]\nkey = \"beam.column.particles\"\nvalues = [10, 12, 14, 16]\n", 5);
  compare_stopped(pressed_column_observed + "[path]\nsteps = 4\n[[sweep]]\nkey = \"support.2.displacement.3\"\nbetween = [-0.1e-3, -0.4e-3]\n"
                                   "bisect = \"z\"\nat = \"final\"\nlevel = 0.5e-3\ntolerance = 1e-5\n", 4);
}

namespace {

/// Starts the program, and sends it a signal after so long if it has not ended; gives its exit status, −1: killed.
int signalled_after(std::vector<std::string> arguments, double seconds, int signal) {
  arguments.insert(arguments.begin(), ELAMIN_PROGRAM);
  std::vector<char*> line;
  for (std::string& a : arguments) line.push_back(a.data());
  line.push_back(nullptr);
  posix_spawn_file_actions_t silent;
  posix_spawn_file_actions_init(&silent);
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) posix_spawn_file_actions_addopen(&silent, stream, "/dev/null", O_WRONLY, 0);
  pid_t process = 0;
  REQUIRE(posix_spawn(&process, ELAMIN_PROGRAM, &silent, nullptr, line.data(), environ) == 0);
  posix_spawn_file_actions_destroy(&silent);
  int status = 0;
  for (double passed = 0; passed < seconds; passed += 1e-3, usleep(1000))
    if (waitpid(process, &status, WNOHANG) == process) return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  kill(process, signal);
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}
int killed_after(std::vector<std::string> arguments, double seconds) { return signalled_after(std::move(arguments), seconds, SIGKILL); }

}  // namespace

TEST_CASE("a program that is killed at any moment goes on with the same bits", "[resume][kills]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", pressed_column_observed + "[path]\nsteps = 60\nframes = 4\n");
  const auto run = [&](const std::string& directory) { return std::vector<std::string>{file, "-o", scratch / directory, "--quiet", "--threads", "1", "--checkpoint", "0"}; };
  REQUIRE(killed_after(run("whole"), 60) == exit_done);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> moment(0.01, 0.35);
  int kills = 0;
  for (int k = 0; k < 4; ++k) {
    const std::string directory = "parts" + std::to_string(k);
    for (int session = 0, status = -1; status < 0; ++session) {
      const bool begun = fs::exists(scratch / (directory + "/.elamin.checkpoint"));
      const double seconds = session < 3 ? moment(random) : 60;
      status = begun ? killed_after({"resume", scratch / directory, "--quiet", "--threads", "1", "--checkpoint", "0"}, seconds)
                     : killed_after(run(directory), seconds);
      kills += status < 0;
      if (status < 0 && fs::exists(scratch / (directory + "/summary.json")))
        CHECK_NOTHROW(nlohmann::json::parse(text_of(scratch / (directory + "/summary.json"))));
      if (status >= 0) CHECK(status == exit_done);
    }
    same_files(scratch / directory, scratch / "whole");
  }
  CHECK(kills >= 4);
}

TEST_CASE("a program that is asked to stop at any moment says that it did, and goes on with the same bits", "[resume][kills]") {
  const ScratchDirectory scratch;
  std::mt19937 random(5);
  int stops = 0;
  for (const std::string& text : {arch, deflated}) {
    const std::string name = "p" + std::to_string(text.size()), file = scratch.file(name + ".toml", text);
    const auto run = [&](const std::string& directory) { return std::vector<std::string>{file, "-o", scratch / directory, "--quiet", "--threads", "1"}; };
    const elamin::Stopwatch watch;
    REQUIRE(killed_after(run(name), 60) == exit_done);
    std::uniform_real_distribution<double> moment(0.1 * watch.seconds(), watch.seconds());
    for (int k = 0; k < 8; ++k) {
      const std::string directory = name + "-" + std::to_string(k);
      int status = signalled_after(run(directory), moment(random), k % 2 ? SIGINT : SIGTERM);
      if (status == exit_interrupted) ++stops, status = killed_after({"resume", scratch / directory, "--quiet", "--threads", "1"}, 60);
      if (status < 0) {                                         // before it listened
        CHECK(!fs::exists(scratch / directory));
        continue;
      }
      CHECK(status == exit_done);
      same_files(scratch / directory, scratch / name);
    }
  }
  CHECK(stops >= 4);
}

TEST_CASE("what cannot go on is refused with a sentence", "[resume]") {
  const ScratchDirectory scratch;
  const auto refused = [&](const std::string& directory, const std::string& sentence) {
    CHECK_THROWS_WITH(elamin::resume({.directory = directory, .quiet = true}), Catch::Matchers::Contains(sentence));
  };
  refused(scratch / "none", "there is no such directory");
  fs::create_directory(scratch / "empty");
  refused(scratch / "empty", "holds nothing to go on from");
  scratch.file("grains.csv", "0,0,0\n0,0,3\n");
  RunOptions options{.file = scratch.file("p.toml", "[[grains]]\nname = \"g\"\nfile = \"grains.csv\"\ndiameter = 1\ndensity = 1\n"
                                                    "[[gravity]]\nacceleration = [0, 0, -1]\n[dynamics]\ntimestep = 1e-3\nsteps = 2000\nevery = 10\n"),
                     .settings = {}, .directory = scratch / "run", .threads = 1, .quiet = true, .checkpoint = 0};
  {
    const Stop stop(60);
    REQUIRE(elamin::run(options).exit_status == exit_interrupted);
  }
  scratch.file("grains.csv", "0,0,0\n0,0,4\n");
  refused(scratch / "run", "grains.csv: has changed since the run began");
  scratch.file("grains.csv", "0,0,0\n0,0,3\n");
  {
    const elamin::DirectoryLock lock(scratch / "run");
    refused(scratch / "run", "another run is at work in this directory");
    CHECK_THROWS_WITH(elamin::run(options), Catch::Matchers::Contains("another run is at work in this directory"));
  }
  const std::string checkpoint = text_of(scratch / "run/.elamin.checkpoint");
  scratch.file("run/.elamin.checkpoint", "elamin 0.0.1 checkpoint\n" + checkpoint);
  refused(scratch / "run", "a run goes on with the version that began it");
  scratch.file("run/.elamin.checkpoint", checkpoint.substr(0, checkpoint.size() / 2));
  refused(scratch / "run", "not whole");
  std::string damaged = checkpoint;
  damaged[damaged.size() * 2 / 3] ^= 4;
  scratch.file("run/.elamin.checkpoint", damaged);
  refused(scratch / "run", "damaged");
  std::string foreign = checkpoint;
  const std::size_t build = foreign.find("build ");
  REQUIRE(build != std::string::npos);
  foreign[build + 6] = foreign[build + 6] == '0' ? '1' : '0';
  scratch.file("run/.elamin.checkpoint", foreign);
  refused(scratch / "run", "a run goes on with the build that began it");
  scratch.file("run/.elamin.checkpoint", checkpoint);
  CHECK(elamin::resume({.directory = scratch / "run", .quiet = true}).exit_status == exit_done);
}
