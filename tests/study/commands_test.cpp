#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/program.hpp"

#include <nlohmann/json.hpp>

#include <csignal>
#include <filesystem>
#include <thread>
#include <unistd.h>

namespace {

// A clamped column of 14 particles in plane, pushed through its critical shortening 0.187 d.
const std::string pushed_column = column_and_ends + R"(
[[group]]
name = "mid"
of = "column"
middle = 2
[[support]]
group = "bottom"
[[support]]
group = "top"
displacement = [0, 0, -0.4e-3]
[study]
type = "path"
[path]
steps = 10
[[observe]]
name = "x"
group = "mid"
quantity = "position.x"
)";

}  // namespace

TEST_CASE("help, version and wrong commands", "[study]") {
  CHECK(program_says("--version").text.find("elamin ") == 0);
  CHECK(program_says("--version").status == 0);
  const Answer help = program_says("--help");
  CHECK(help.status == 0);
  for (const char* word : {"energy", "check", "verify", "Exit status", "--set"}) CHECK(help.text.find(word) != std::string::npos);
  CHECK(program_says("").status == 1);
  CHECK(program_says("--nonsense").status == 1);
  CHECK(program_says("no-such-file.toml").status == 1);
}

TEST_CASE("a run leaves what the contract says", "[study]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("column.toml", pushed_column);
  const Answer answer = elamin_says("'" + file + "'");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  for (const char* name : {"path.csv", "events.csv", "summary.json", "resolved.toml", "log.txt", "states/initial.data", "states/final.data", "states/branch-1.data"})
    CHECK(std::filesystem::exists(scratch / (std::string("column/") + name)));
  const auto summary = nlohmann::json::parse(text_of(scratch / "column/summary.json"));
  CHECK(summary["status"] == "done");
  CHECK(summary["events"].size() == 2);                          // stability is lost, and the jump
  CHECK(summary["input_sha256"].get<std::string>().size() == 64);
  CHECK(summary["points"] == csv_rows(scratch / "column/path.csv").size() - 1);
  // resolved.toml is a valid input that gives the same path, to the bit.
  REQUIRE(elamin_says("'" + (scratch / "column/resolved.toml") + "' -o '" + (scratch / "again") + "' --quiet").status == 0);
  CHECK(text_of(scratch / "again/path.csv") == text_of(scratch / "column/path.csv"));
}

TEST_CASE("same bits for one and two threads", "[study]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("column.toml", pushed_column);
  REQUIRE(elamin_says("'" + file + "' --threads 1 --quiet -o '" + (scratch / "one") + "'").status == 0);
  REQUIRE(elamin_says("'" + file + "' --threads 2 --quiet -o '" + (scratch / "two") + "'").status == 0);
  CHECK(text_of(scratch / "one/path.csv") == text_of(scratch / "two/path.csv"));
  CHECK(text_of(scratch / "one/states/final.data") == text_of(scratch / "two/states/final.data"));
}

TEST_CASE("stop at the first loss of stability, and restart from it", "[study]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("column.toml", pushed_column);
  REQUIRE(elamin_says("'" + file + "' --set path.when_unstable=stop --quiet -o '" + (scratch / "stop") + "'").status == 0);
  const auto summary = nlohmann::json::parse(text_of(scratch / "stop/summary.json"));
  CHECK(summary["final"]["label"] == "branch:1");
  const double critical = summary["events"][0]["lambda"];
  // A buckled state of the whole run, taken up again, ends where the whole run ends.
  REQUIRE(elamin_says("'" + file + "' --quiet -o '" + (scratch / "whole") + "' --set path.to=0.8").status == 0);
  const Answer rest = elamin_says("'" + file + "' --quiet -o '" + (scratch / "rest") + "' --set path.start='\"whole/states/final.data\"' --set path.start_lambda=0.8");
  INFO(rest.text);
  REQUIRE(rest.status == 0);
  REQUIRE(elamin_says("'" + file + "' --quiet -o '" + (scratch / "full") + "'").status == 0);
  const auto a = nlohmann::json::parse(text_of(scratch / "rest/summary.json"))["final"], b = nlohmann::json::parse(text_of(scratch / "full/summary.json"))["final"];
  CHECK(a["lambda"] == 1.0);
  CHECK(a["energy"].get<double>() == Approx(b["energy"].get<double>()).epsilon(1e-12));
  CHECK(a["x"].get<double>() == Approx(b["x"].get<double>()).epsilon(1e-9));
  CHECK(critical == Approx(0.46851988852531106).epsilon(1e-9));   // 0.18740795541012442e-3/0.4e-3, data/exact/chain_critical.json N = 10
}

TEST_CASE("verify meets, misses and says so", "[study]") {
  const ScratchDirectory scratch;
  const std::string expect = "[[expect]]\nobservable = \"lambda\"\nat = \"branch:1\"\nrtol = 1e-9\nsource = \"closed form\"\nvalue = ";
  const std::string good = scratch.file("good.toml", pushed_column + expect + "0.46851988852531106\n");
  const std::string bad = scratch.file("bad.toml", pushed_column + expect + "0.5\n");
  CHECK(elamin_says("verify --quiet '" + good + "'").status == 0);
  const Answer missed = elamin_says("verify --quiet '" + bad + "'");
  CHECK(missed.status == 3);
  CHECK(missed.text.find("NOT MET") != std::string::npos);
  CHECK(elamin_says("verify --quiet '" + good + "' '" + bad + "'").status == 3);
}

TEST_CASE("a sweep leaves one directory a run and one row a run", "[study]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("sweep.toml", pushed_column + "[[sweep]]\nkey = \"beam.column.particles\"\nvalues = [14, 16, 18, 20]\n");
  const Answer answer = elamin_says("'" + file + "' -o '" + (scratch / "out") + "'");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  const auto rows = csv_rows(scratch / "out/sweep.csv");
  REQUIRE(rows.size() == 5);
  CHECK(rows[0][0] == "beam.column.particles");
  CHECK(std::stod(rows[1][2]) == Approx(0.46851988852531106).epsilon(1e-9));
  int directories = 0;
  for (const auto& entry : std::filesystem::directory_iterator(scratch / "out")) directories += entry.is_directory();
  CHECK(directories == 4);
}

TEST_CASE("check says what was understood", "[study]") {
  const ScratchDirectory scratch;
  const Answer answer = elamin_says("check '" + scratch.file("column.toml", pushed_column) + "'");
  CHECK(answer.status == 0);
  for (const char* words : {"14 particles, 13 bonds, 12 angles, 20 free dofs", "ends: clamped, clamped; 11 bonds can stretch; effective length 0.012", "no rigid motion is free"})
    CHECK(answer.text.find(words) != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(scratch / "column"));
  scratch.file("v.csv", "diameter,density,bond_stiffness,angle_stiffness\n0.1,2,3,\n0.1,2,5,4\n0.2,2,,\n");
  const std::string own = elamin_says("check '" + scratch.file("own.toml", "[[beam]]\nname = \"b\"\nparticles = 3\nfrom = [0, 0, 0]\nto = [2, 0, 0]\ndiameter = 0.1\n"
                                      "youngs_modulus = 1\nvalues = \"v.csv\"\n[study]\ntype = \"energy\"\n") + "'").text;
  INFO(own);
  CHECK(own.find("v.csv: diameter 0.1 to 0.2, density 2, K = 3 to 5, q0 = 1, B = 4\n  ends: free, free; 2 bonds can stretch\n") != std::string::npos);
  CHECK(own.find("EI") == std::string::npos);
  const std::string held = elamin_says("check '" + scratch.file("held.toml", "[[beam]]\nname = \"b\"\nparticles = 3\nfrom = [0, 0, 0]\nto = [2, 0, 0]\ndiameter = 0.1\n"
                                       "youngs_modulus = 1\n[[support]]\ngroup = \"b\"\n[study]\ntype = \"energy\"\n") + "'").text;
  INFO(held);
  CHECK(held.find("  all of its particles are held\n") != std::string::npos);
}

TEST_CASE("what does not converge keeps what it has and exits with 2", "[study]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("column.toml", pushed_column);
  const Answer answer = elamin_says("'" + file + "' --set solver.max_iterations=1 --set path.steps=1 -o '" + (scratch / "out") + "' --quiet");
  INFO(answer.text);
  CHECK(answer.status == 2);
  CHECK(nlohmann::json::parse(text_of(scratch / "out/summary.json"))["status"] == "not_converged");
  CHECK(csv_rows(scratch / "out/path.csv").size() >= 2);
}

TEST_CASE("an interrupted run keeps what it has and exits with 130", "[study]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("column.toml", pushed_column);
  const pid_t child = fork();
  if (child == 0) {
    std::freopen("/dev/null", "w", stdout);
    execl(ELAMIN_PROGRAM, ELAMIN_PROGRAM, file.c_str(), "--set", "path.steps=1000000", "-o", (scratch / "out").c_str(), nullptr);
    _exit(127);
  }
  while (!std::filesystem::exists(scratch / "out/path.csv") || std::filesystem::file_size(scratch / "out/path.csv") < 2000)
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 130);
  CHECK(nlohmann::json::parse(text_of(scratch / "out/summary.json"))["status"] == "interrupted");
  CHECK(std::filesystem::exists(scratch / "out/states/final.data"));
}
