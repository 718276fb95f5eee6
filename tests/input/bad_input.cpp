// Wrong files and what is said of them. Each file of bad/ begins with the sentences it must get, all of them and no
// other, as comments `# expect: SENTENCE`, without the name of the file; a '*' at the end stands for words of the TOML
// library.
#include "catch.hpp"

#include "core/error.hpp"
#include "core/suggest.hpp"
#include "study/prepare.hpp"
#include "scratch_directory.hpp"
#include "study/program.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>

using namespace std::string_literals;

namespace {

/// Everything that is looked at before a run; returns what is said, a sentence a line.
std::string mistakes_of(const std::string& file, const std::vector<elamin::Setting>& settings = {}) {
  try {
    elamin::prepare_runs(file, settings);
  } catch (const elamin::InputError& e) {
    return e.what();
  }
  return "";
}

bool agrees(const std::string& said, const std::string& expected) {
  if (expected.empty() || expected.back() != '*') return said == expected;
  return said.compare(0, expected.size() - 1, expected, 0, expected.size() - 1) == 0;
}

}  // namespace

TEST_CASE("Every wrong file gets its sentences") {
  int files = 0;
  const std::string folder = ELAMIN_ROOT "/tests/input/bad/";
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    ++files;
    const std::string file = entry.path().string(), mark = "# expect: ";
    std::vector<std::string> expected;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line) && line.compare(0, mark.size(), mark) == 0;) {
      const std::string sentence = line.substr(mark.size());
      // Either a place follows the name of the file, or a space.
      expected.push_back(file + (sentence[0] >= '0' && sentence[0] <= '9' ? ":" : ": ") + sentence);
    }
    const std::vector<std::string> said = lines_of(mistakes_of(file));
    INFO(file << "\nsaid:\n" << mistakes_of(file));
    CHECK_FALSE(expected.empty());
    REQUIRE(said.size() == expected.size());
    for (std::size_t i = 0; i < said.size(); ++i) {
      INFO("expected: " << expected[i]);
      CHECK(agrees(said[i], expected[i]));
    }
  }
  CHECK(files >= 45);
}

TEST_CASE("Files that are no text at all") {
  const std::string none = ELAMIN_ROOT "/tests/input/bad/none.toml";
  CHECK(mistakes_of(none) == none + ": there is no such file");
  CHECK(mistakes_of("") == "there is no such file");
  CHECK(mistakes_of(ELAMIN_ROOT "/tests") == ELAMIN_ROOT "/tests: is a folder, not a file");
  CHECK(mistakes_of("/dev/zero") == "/dev/zero:1:1: is not a text in UTF-8 from here on");
  const ScratchDirectory scratch;
  const auto said = [&](const std::string& bytes) { return mistakes_of(scratch.file("bad.toml", bytes)); };
  const std::string file = scratch / "bad.toml";
  CHECK(said("") ==
        file + ": holds no structure; add a [[beam]], [[loop]], [[sheet]], [[grains]], [[body]] or a [lammps] data file");
  CHECK(said("\n \n# nothing\n") ==
        file + ": holds no structure; add a [[beam]], [[loop]], [[sheet]], [[grains]], [[body]] or a [lammps] data file");
  CHECK(said("\x7f" "ELF\2\1\1\0\0"s) == file + ":1:8: is not a text in UTF-8 from here on");
  CHECK(said("title = \"column\"\ntitle = \"S\xe4ule\"\n") == file + ":2:11: is not a text in UTF-8 from here on");
  CHECK(said("# \xc0\xaf\n") == file + ":1:3: is not a text in UTF-8 from here on");
  CHECK(said("# \xed\xa0\x80\n") == file + ":1:3: is not a text in UTF-8 from here on");
  CHECK(said("title = \"Säule\" # Säule\nSäule = 1") ==
        file + ":2:2: not TOML: outside of quotes there are only ASCII characters");
  CHECK(said("title = \"a\\u0000b\"\n[[beam]]").find(file + ":1:9: title: must not hold the character 0\n") == 0);
}

TEST_CASE("A byte-order mark is no letter") {
  const ScratchDirectory scratch;
  const auto said = [&](const std::string& bytes) { return mistakes_of(scratch.file("bad.toml", bytes)); };
  const std::string file = scratch / "bad.toml", column = text_of(ELAMIN_ROOT "/tests/input/good/column.toml");
  CHECK(said("\xEF\xBB\xBF" + column) == "");
  CHECK(said("\xEF\xBB\xBF" "tilte = \"a\"\n" + column).find(file + ":1:1: tilte: unknown key") == 0);
  CHECK(said("a = 1\xEF\xBB\xBF\n") == file + ":1:6: not TOML: outside of quotes there are only ASCII characters");
  CHECK(said("\xFF\xFEt\0i\0"s) == file + ":1:1: is a text in UTF-16; save it in UTF-8");
  CHECK(said("\xFE\xFF\0t\0i"s) == file + ":1:1: is a text in UTF-16; save it in UTF-8");
  scratch.file("grains.csv", "\xEF\xBB\xBFx,y,z\n0,0,0\n");
  CHECK(said("[[grains]]\nname = \"g\"\nfile = \"grains.csv\"\ndiameter = 1\n[study]\ntype = \"energy\"\n") == "");
}

TEST_CASE("The word that was meant") {
  const std::vector<std::string> beam{"name", "particles", "from", "to", "diameter", "thickness", "youngs_modulus", "density", "bond_stiffness"};
  const auto meant = [](const std::string& word, const std::vector<std::string>& words) {
    const std::string text = elamin::did_you_mean(word, words);
    return text.empty() ? text : text.substr(16, text.size() - 18);
  };
  CHECK(meant("E", beam) == "youngs_modulus");                 // letters of papers
  CHECK(meant("rho", beam) == "density");
  CHECK(meant("E", {"name", "radius"}) == "");
  CHECK(meant("tol", {"method", "tolerance", "max_iterations"}) == "tolerance");            // abbreviations, part by part
  CHECK(meant("max_iter", {"method", "tolerance", "max_iterations"}) == "max_iterations");
  CHECK(meant("disp.x", {"position.x", "displacement.x", "displacement.y"}) == "displacement.x");
  CHECK(meant("Disp.Y", {"position.x", "displacement.x", "displacement.y"}) == "displacement.y");
  CHECK(meant("disp.z", {"position.x", "displacement.x", "displacement.y"}) == "");
  CHECK(meant("ux", {"position.x", "displacement.x"}) == "displacement.x");
  CHECK(meant("youngs", beam) == "youngs_modulus");
  CHECK(meant("modulus", beam) == "youngs_modulus");           // parts
  CHECK(meant("particels", beam) == "particles");              // slips of the fingers
  CHECK(meant("chekc", {"energy", "check", "verify"}) == "check");
  CHECK(meant("fr", beam) == "");
  CHECK(meant("q", beam) == "");
  CHECK(meant("", beam) == "");
  const std::string file = ELAMIN_ROOT "/tests/input/good/column.toml";
  CHECK_THAT(mistakes_of(file, {{"beam.column.E", "1"}}), Catch::EndsWith("; did you mean \"youngs_modulus\"?"));
  CHECK_THAT(mistakes_of(file, {{"solver.tol", "1"}}), Catch::EndsWith("; did you mean \"tolerance\"?"));
}

TEST_CASE("What would exhaust the parser or the memory is refused") {
  const ScratchDirectory scratch;
  const auto said = [&](const std::string& text) { return mistakes_of(scratch.file("bad.toml", text)); };
  const std::string file = scratch / "bad.toml";
  std::string deep;
  for (int i = 0; i < 200000; ++i) deep += ".a";
  CHECK(said("x = 1\na" + deep + " = 1\n") == file + ":2:32: a dotted key has more than 16 parts; no key has so many");
  CHECK(said("x = \"..................\" # ..................\n[\"a\".'b'" + deep + "]\n") ==
        file + ":2:37: a dotted key has more than 16 parts; no key has so many");
  CHECK(said("x = '''\n'....................''' \ny.z.a" + deep + "=1") ==
        file + ":3:32: a dotted key has more than 16 parts; no key has so many");
  CHECK_THAT(said("x = " + std::string(200000, '[')), Catch::Contains(file + ":1:") && Catch::Contains("not TOML: "));
  std::string tables = "x = ";
  for (int i = 0; i < 100000; ++i) tables += "{a=";
  CHECK_THAT(said(tables), Catch::Contains(file + ":1:") && Catch::Contains("not TOML: "));
  std::string many;
  for (int i = 0; i < 1000; ++i) many += "[[beam]]\nnam = 1\n";
  const auto lines = lines_of(said(many));
  CHECK(lines.size() == 201);
  CHECK(lines.front() == file + ": has 5800 more mistakes than are told here");
}

TEST_CASE("Settings that address nothing, or set nonsense") {
  const std::string file = ELAMIN_ROOT "/tests/input/good/column.toml";
  const auto said = [&](const std::string& key, const std::string& value) { return mistakes_of(file, {{key, value}}); };
  CHECK(mistakes_of(file) == "");
  CHECK(said("beam.column.particels", "3") ==
        "--set: \"beam.column.particels\": \"particels\" is no key; allowed: name, from_stage, section, particles, from, to, "
        "rise, angle, toward, profile, through, points, file, clamped, center, axis, "
        "spacing, diameter, thickness, youngs_modulus, density, bond_stiffness, angle_stiffness, rest_length, rest, "
        "axial_stiffness, bending_stiffness, values; "
        "did you mean \"particles\"?");
  CHECK(said("beam.colum.particles", "3") ==
        "--set: \"beam.colum.particles\": no [[beam]] is \"colum\"; there are: column; did you mean \"column\"?");
  CHECK(said("beam.2.particles", "3") == "--set: \"beam.2.particles\": no [[beam]] is \"2\"; there are: column");
  CHECK(said("beam.column", "3") ==
        "--set: \"beam.column\": is a table; name one of its keys: name, from_stage, section, particles, from, to, "
        "rise, angle, toward, profile, through, points, file, clamped, center, axis, spacing, diameter, thickness, youngs_modulus, "
        "density, bond_stiffness, angle_stiffness, rest_length, rest, axial_stiffness, bending_stiffness, values");
  CHECK(said("load.1.force", "[0, 0, 1]") == "--set: \"load.1.force\": there is no [[load]] in this file");
  CHECK(said("support.2.displacement.4", "1") == "--set: \"support.2.displacement.4\": has components 1 to 3");
  CHECK(said("path.steps.3", "1") == "--set: \"path.steps.3\": \"steps\" is a value, not a table");
  CHECK(
      said("", "1") ==
      "--set: \"\": \"\" is no key; allowed: title, plane, constants, lammps, beam, loop, sheet, grains, body, group, connect, bonds, angles, remove, glue, "
      "imperfection, support, load, gravity, pressure, change, contact, wall, viscosity, velocity, study, path, curve, refine, landscape, modes, "
      "solver, and 6 more");
  CHECK(said("path.parameter", "1") == "--set: path.parameter: must be a string or a list of strings, is 1");
  CHECK(said("path.parameter", "support.9") ==
        "--set: path.parameter: \"support.9\" names no table that a load factor scales; there are: support.1, support.2; "
        "did you mean \"support.1\"?");
  CHECK(said("path.steps", "many") ==
        "--set: path.steps: must be an integer from 1 to 1000000, is the string \"many\"");
  CHECK(said("path.steps", "1\nto = 2") ==
        "--set: path.steps: must be an integer from 1 to 1000000, is the string \"1?to = 2\", which is no expression: "
        "behind \"1\" there must be +, -, *, / or ^");
  CHECK(said("beam.column.diameter", "nan") == "--set: beam.column.diameter: must be a positive number, is nan");
  CHECK(said("title", "\xff") == "--set: title: is not a text in UTF-8");
  const std::string constants = ELAMIN_ROOT "/tests/input/good/constants.toml";
  CHECK(mistakes_of(constants) == "");
  CHECK(mistakes_of(constants, {{"constants.n", "38"}}) == "");
  CHECK(mistakes_of(constants, {{"constants.N", "38"}}) ==
        "--set: \"constants.N\": \"N\" is no constant of this file; there are: t, n, L, slender, I, small; did you mean \"n\"?");
  CHECK(mistakes_of(constants, {{"constants.n", "'L'"}}) ==
        "--set: constants.n: must be a finite number, is the string \"L\", where \"L\" stands further down; a constant uses those above it");
  CHECK(mistakes_of(constants, {{"constants", "38"}}) == "--set: \"constants\": is a table; name one of its numbers");
  CHECK(said("constants.t", "1") == "--set: \"constants.t\": \"t\" is no constant of this file; there is none");
  CHECK(said("path.from", "1") ==
        file + ":23:6: path.to: is the same load factor as from, 1; a path leads from one to another");
  CHECK_THROWS_WITH(elamin::parse_setting("path.steps"),
                    "--set: \"path.steps\": must be KEY=VALUE, such as path.steps=50");
  CHECK_THROWS_WITH(elamin::parse_setting("=5"), "--set: \"=5\": must be KEY=VALUE, such as path.steps=50");
}

TEST_CASE("Seconds between checkpoints") {
  for (const std::string wrong : {"nan", "-1", "inf", "often"}) {
    const auto answer = elamin_says("--checkpoint " + wrong + " none.toml");
    CHECK(answer.status == 1);
    CHECK(answer.text.find("--checkpoint: must be a number of seconds from 0 to 1e9, is " + wrong) != std::string::npos);
  }
}
