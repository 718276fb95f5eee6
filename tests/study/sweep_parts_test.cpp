// A sweep in parts, which are put together.
#include "catch.hpp"
#include "results/files.hpp"
#include "scratch_directory.hpp"
#include "study/program.hpp"

#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace {

namespace fs = std::filesystem;

const std::string grain_under_weight = R"(
[[grains]]
name = "grain"
positions = [[0, 0, 0.5]]
diameter = 1
density = 1
[[wall]]
name = "floor"
shape = "plane"
normal = [0, 0, 1]
point = [0, 0, 0]
effective_modulus = 1e6
[[gravity]]
acceleration = [0, 0, -9.81]
constant = true
[study]
type = "equilibrium"
[[sweep]]
key = "gravity.1.acceleration"
values = [[0, 0, -1], [0, 0, -2], [0, 0, -3], [0, 0, -4], [0, 0, -5]]
)";

std::string parts_text(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

TEST_CASE("parts of a sweep, run in any order and twice, are put together to what one run of it leaves", "[study][sweep]") {
  const ScratchDirectory scratch;
  const std::string file = "'" + scratch.file("p.toml", grain_under_weight) + "'", out = " -o '" + (scratch / "parts") + "'";
  const Answer whole = elamin_says(file + " --quiet -o '" + (scratch / "whole") + "'");
  INFO(whole.text);
  REQUIRE(whole.status == 0);

  CHECK(elamin_says(file + out + " --part 2/3").text.find("2 of 2 runs of part 2/3") != std::string::npos);
  const Answer early = elamin_says("collect '" + (scratch / "parts") + "'");
  CHECK(early.status == 2);
  CHECK(early.text.find(": 3 of 5 runs have not ended: 1, 3, 4; ") != std::string::npos);
  CHECK(csv_rows(scratch / "parts/sweep.csv").size() == 3);

  const auto written = fs::last_write_time(fs::directory_iterator(scratch / "parts/2_acceleration=_0__0__-2_/states")->path());
  const std::string together = "'" ELAMIN_PROGRAM "' " + file + out + " --quiet --part ";
  REQUIRE(std::system((together + "3/3 & " + together + "1/3 & wait").c_str()) == 0);
  CHECK(elamin_says(file + out + " --quiet --part 2/3").status == 0);           // nothing is left to do
  CHECK(fs::last_write_time(fs::directory_iterator(scratch / "parts/2_acceleration=_0__0__-2_/states")->path()) == written);
  const Answer all = elamin_says("collect '" + (scratch / "parts") + "'");
  INFO(all.text);
  CHECK(all.status == 0);
  CHECK(parts_text(scratch / "parts/sweep.csv") == parts_text(scratch / "whole/sweep.csv"));
  CHECK(files_in(scratch / "parts") == files_in(scratch / "whole"));
  CHECK(elamin_says("collect '" + (scratch / "parts") + "'").text.ends_with("/parts: is finished\n"));
}

TEST_CASE("a directory of parts takes those of one sweep alone", "[study][sweep]") {
  const ScratchDirectory scratch;
  const std::string file = "'" + scratch.file("p.toml", grain_under_weight) + "'", out = " --quiet -o '" + (scratch / "parts") + "'";
  REQUIRE(elamin_says(file + out + " --part 1/5").status == 0);
  const Answer other = elamin_says(file + out + " --part 2/5 --set grains.grain.density=2");
  CHECK(other.status == 1);
  CHECK(other.text.find("parts of another sweep are in it") != std::string::npos);
  CHECK(csv_rows(scratch / "parts/1_acceleration=_0__0__-1_/path.csv").size() == 2);
  const Answer used = elamin_says(file + " --quiet -o '" + (scratch / "parts/1_acceleration=_0__0__-1_") + "' --part 1/5");
  CHECK(used.status == 1);
  CHECK(used.text.find("is not empty: it holds ") != std::string::npos);
  for (const std::string wrong : {"0/5", "6/5", "1/0", "1", "a/b", "1/5x", "-1/5"})
    CHECK(elamin_says(file + out + " --part=" + wrong).text == "--part: must be K/N with K from 1 to N, as 3/20, is " + wrong + "\n");
  const std::string single = grain_under_weight.substr(0, grain_under_weight.find("[[sweep]]"));
  CHECK(elamin_says("'" + scratch.file("one.toml", single) + "' --part 1/5").text.ends_with(
      "one.toml: is not a sweep over given values, which alone can be run in parts (--part)\n"));
  CHECK(elamin_says("collect '" + (scratch / "nothing") + "'").status == 1);
}
