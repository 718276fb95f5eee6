// What makes no sense is told, and nothing is called stable that is no equilibrium.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/program.hpp"

#include <algorithm>

using Catch::Matchers::Contains;

namespace {

const std::string heap = R"([[grains]]
name = "g"
positions = [[0, 0, 0], [0.6e-3, 0, 0], [5e-3, 0, 0]]
diameter = 1e-3
density = 1000
)";
const std::string elastic = "[[contact]]\nbetween = [\"g\", \"g\"]\nlaw = \"hertz\"\nyoungs_modulus = 1e6\npoissons_ratio = 0.3\n";

/// The column "stable" of path.csv, row by row.
std::vector<std::string> stable_in(const std::string& directory) {
  const auto rows = csv_rows(directory + "/path.csv");
  const auto column = std::find(rows[0].begin(), rows[0].end(), "stable") - rows[0].begin();
  std::vector<std::string> all;
  for (std::size_t k = 1; k < rows.size(); ++k) all.push_back(rows[k][static_cast<std::size_t>(column)]);
  return all;
}

}  // namespace

TEST_CASE("grains that overlap deeply at the start are named, whether they feel each other or not, and their energies are not called stable", "[study][nonsense]") {
  const ScratchDirectory scratch;
  for (const std::string& contact : {elastic, std::string()}) {
    const std::string file = scratch.file("heap.toml", heap + contact + "[study]\ntype = \"energy\"\n");
    const std::string sentence = "g 1 and g 2 overlap by 0.4 of a diameter at the start";
    CHECK_THAT(elamin_says("check " + file).text, Contains("warning: " + sentence));
    const Answer run = elamin_says(file);
    CHECK(run.status == 0);
    CHECK_THAT(run.text, Contains(sentence));
    CHECK_THAT(text_of(scratch / "heap/summary.json"), Contains(sentence));
    if (!contact.empty()) CHECK(stable_in(scratch / "heap") == std::vector<std::string>{"false"});
  }
  const std::string apart = scratch.file("apart.toml", heap + elastic + "[study]\ntype = \"energy\"\n");
  CHECK_THAT(elamin_says("check " + apart + " --set grains.g.diameter=0.7e-3").text, !Contains("overlap by"));
}

TEST_CASE("a row that did not converge is not stable, a column under load that is not at rest is not, and one at rest is", "[study][nonsense]") {
  const ScratchDirectory scratch;
  const std::string bent = scratch.file("bent.toml", pressed_column + "[[load]]\ngroup = \"column\"\nforce = [1e-6, 0, 0]\n[study]\ntype = \"equilibrium\"\n");
  CHECK(elamin_says(bent + " --set solver.max_iterations=1").status == 2);
  CHECK(stable_in(scratch / "bent") == std::vector<std::string>{"false"});
  CHECK(elamin_says(bent).status == 0);
  CHECK(stable_in(scratch / "bent") == std::vector<std::string>{"true"});
  CHECK(elamin_says(bent + " --set study.type=energy").status == 0);
  CHECK(stable_in(scratch / "bent") == std::vector<std::string>{"false"});
  const std::string rests = scratch.file("rests.toml", column_and_ends + "[[support]]\ngroup = \"bottom\"\n[study]\ntype = \"energy\"\n");
  CHECK(elamin_says(rests).status == 0);
  CHECK(stable_in(scratch / "rests") == std::vector<std::string>{"true"});
}

TEST_CASE("an expectation that nothing at all would meet too is named with its place", "[study][nonsense]") {
  const ScratchDirectory scratch;
  const auto expecting = [&](const std::string& tolerance) {
    return elamin_says("check " + scratch.file("column.toml", pressed_column + "[[expect]]\nobservable = \"lambda\"\nvalue = 0.5\n" + tolerance)).text;
  };
  for (const char* loose : {"rtol = 1.0\n", "atol = 0.5\n", "rtol = 0.5\natol = 0.25\n"}) CHECK_THAT(expecting(loose), Contains("the tolerance on lambda is as large as the value"));
  CHECK_THAT(expecting("rtol = 1e-3\n"), !Contains("as large as"));
  CHECK_THAT(expecting("atol = 0.4\n"), !Contains("as large as"));
}

TEST_CASE("units that look mixed and stiffnesses beyond the digits of a force are named", "[study][nonsense]") {
  const ScratchDirectory scratch;
  const auto checked = [&](const std::string& modulus, const std::string& thickness, const std::string& more) {
    return elamin_says("check " + scratch.file("b.toml", "plane = \"xz\"\n[[beam]]\nname = \"b\"\nparticles = 12\nfrom = [0, 0, 0]\nto = [110, 0, 0]\ndiameter = " + thickness +
                                                         "\ndensity = 1\nyoungs_modulus = " + modulus + "\n[[support]]\ngroup = \"b\"\n" + more)).text;
  };
  const std::string units = "as pascals and millimetres these do not go together", gravity = "with lengths in mm that is 9810";
  CHECK_THAT(checked("1e6", "10", ""), Contains(units));
  CHECK_THAT(checked("2e11", "0.4", ""), !Contains(units));                     // a steel beam in metres
  CHECK_THAT(checked("1e6", "1e-3", ""), !Contains(units));
  CHECK_THAT(checked("1", "10", "[[gravity]]\nacceleration = [0, 0, -9.81]\n"), Contains(gravity));
  CHECK_THAT(checked("1", "10", "[[gravity]]\nacceleration = [0, 0, -9810]\n"), !Contains(gravity));
  const std::string stiff = "[[bonds]]\npairs = [[3, 9]]\nbond_stiffness = ";
  CHECK_THAT(checked("1", "10", stiff + "1e14\n"), Contains("times as stiff as the softest"));
  CHECK_THAT(checked("1", "10", stiff + "1e9\n"), !Contains("times as stiff as the softest"));
}

TEST_CASE("supports that drive particles into each other are named, and ones that contradict each other refused", "[study][nonsense]") {
  const ScratchDirectory scratch;
  const auto checked = [&](const std::string& to, const std::string& more) {
    return elamin_says("check " + scratch.file("pair.toml",
        "[[grains]]\nname = \"g\"\npositions = [[0, 0, 3], [0, 0, -3]]\ndiameter = 2\n[[group]]\nname = \"one\"\nids = [1]\n[[group]]\nname = \"two\"\nids = [2]\n"
        "[[contact]]\nbetween = [\"g\", \"g\"]\nyoungs_modulus = 1e5\npoissons_ratio = 0.3\n[[support]]\ngroup = \"one\"\ndisplacement = [0, 0, " + to + "]\n"
        "[[support]]\ngroup = \"two\"\n" + more)).text;
  };
  const std::string sentence = "supports drive g 1 and g 2 into each other: at load factor";
  CHECK_THAT(checked("-12", ""), Contains(sentence));                           // right through
  CHECK_THAT(checked("-4.6", ""), Contains(sentence));
  CHECK_THAT(checked("-4.1", ""), !Contains(sentence));
  CHECK_THAT(checked("6", ""), !Contains(sentence));
  CHECK_THAT(checked("-4", "[[support]]\ngroup = \"one\"\ndisplacement = [0, 0, 4]\n"), Contains("one coordinate has one displacement"));
}
