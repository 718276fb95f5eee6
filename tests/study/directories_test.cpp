// Where results go, and what of other things stays.
#include "catch.hpp"
#include "results/files.hpp"
#include "scratch_directory.hpp"
#include "study/program.hpp"

namespace {

const std::string grain_and_body = R"(
[[grains]]
name = "grain"
positions = [[0, 0, 0]]
diameter = 1
density = 1
[[body]]
name = "ball"
shape = "sphere"
rounding_diameter = 1
position = [2, 0, 0]
density = 1
[[support]]
group = "all"
)";
const std::string in_time = R"(
[study]
type = "dynamics"
[dynamics]
timestep = 0.1
steps = 2
record = [1]
)";
const std::string of_modes = R"(
[study]
type = "modes"
)";

}  // namespace

TEST_CASE("every file of a run is listed, so that the next run leaves nothing of it", "[study][directories]") {
  const ScratchDirectory scratch;
  const std::string free = grain_and_body.substr(0, grain_and_body.find("[[support]]"));
  for (const std::string& text : {free + in_time, free + of_modes}) {
    const Answer answer = elamin_says("'" + scratch.file("p.toml", text) + "' --quiet -o '" + (scratch / "out") + "'");
    INFO(answer.text);
    CHECK(answer.status == 0);
    CHECK(listed_in(scratch / "out") == files_in(scratch / "out"));
    CHECK(std::filesystem::exists(scratch / (text == free + in_time ? "out/frames/1.bodies.csv" : "out/modes/mode-6.bodies.csv")));
  }
}

TEST_CASE("a sweep stops at a directory that holds something else, or takes --force", "[study][directories]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", grain_and_body + "[study]\ntype = \"equilibrium\"\n[[sweep]]\nkey = \"grains.grain.diameter\"\nvalues = [1, 2]\n");
  const std::string run = "'" + file + "' --quiet -o '" + (scratch / "out") + "'", inside = "out/2_diameter=2/states";
  std::filesystem::create_directories(scratch / inside);
  scratch.file(inside + "/final.data", "mine"), scratch.file(inside + "/kept.data", "mine");
  const std::string refusal = ": is not empty and not the results of a run: it holds ";
  CHECK(elamin_says(run).text.starts_with((scratch / "out") + "/2_diameter=2" + refusal + "states; "));
  CHECK(files_in(scratch / "out").size() == 2);
  std::filesystem::create_directory(scratch / "other");
  std::filesystem::rename(scratch / "out/2_diameter=2", scratch / "other/states");
  const std::string other = "'" + file + "' --quiet -o '" + (scratch / "other") + "'";
  CHECK(elamin_says(other).status == 1);
  CHECK(elamin_says(other + " --force").status == 0);
  CHECK(elamin_says(other).status == 0);
  CHECK(text_of(scratch / "other/states/states/final.data") == "mine");
  CHECK(elamin_says(run + " --force").status == 0);
}

TEST_CASE("nothing is written through symbolic links in a directory of results", "[study][directories]") {
  const ScratchDirectory scratch;
  const std::string run = "'" + scratch.file("p.toml", grain_and_body + in_time) + "' --quiet -o '" + (scratch / "out") + "'", mine = scratch.file("mine", "mine");
  REQUIRE(elamin_says(run).status == 0);
  const std::string named = GENERATE(".elamin", ".elamin.new", ".gitignore.new", "summary.json", "summary.json.new", "states", "states/final.data", "states/final.data.new", "trajectory.csv");
  CAPTURE(named);
  const std::filesystem::path link = scratch / ("out/" + named);
  const bool folder = named == "states";
  if (folder) std::filesystem::create_directory(scratch / "elsewhere");
  std::filesystem::remove_all(link);
  std::filesystem::create_symlink(folder ? scratch / "elsewhere" : mine, link);
  for (const char* again : {"", " --force"}) {
    const Answer answer = elamin_says(run + again);
    INFO(answer.text);
    CHECK((answer.status == 0 || answer.text.find("is a symbolic link, through which nothing is written; remove it") != std::string::npos ||
           answer.text.find("is not empty and not the results of a run") != std::string::npos));
    CHECK(text_of(mine) == "mine");
    if (folder) CHECK(std::filesystem::is_empty(scratch / "elsewhere"));
  }
}
