// [refine]: what the levels set, and values with errors against the continuum.
#include "catch.hpp"
#include "core/error.hpp"
#include "scratch_directory.hpp"
#include "study/prepare.hpp"
#include "study/results_of.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>

namespace {

using elamin::pi;

/// What each level sets, a line each: "beam.b.particles=5 …".
std::vector<std::string> levels_of_text(const std::string& problem) {
  const auto prepared = elamin::prepare_runs(elamin::parse_document(problem, "p.toml"), {});
  std::vector<std::string> all;
  for (const elamin::PreparedRun& run : prepared.runs) {
    all.emplace_back();
    for (const elamin::Setting& s : run.swept) all.back() += (all.back().empty() ? "" : " ") + s.key + "=" + s.value;
  }
  return all;
}

std::string wrong_of_text(const std::string& problem) {
  try {
    levels_of_text(problem);
  } catch (const elamin::InputError& e) {
    std::string all;
    for (const elamin::Mistake& m : e.mistakes()) all += (all.empty() ? "" : "; ") + m.key + ": " + m.what;
    return all;
  }
  return "";
}

const std::string five = R"(plane = "xz"
[[beam]]
name = "b"
particles = 5
from = [0, 0, 0]
to = [0, 0, 4]
diameter = 1
)", by_stiffness = "bond_stiffness = 8\nangle_stiffness = 2\n", by_section = "axial_stiffness = 8\nbending_stiffness = 2\n",
    refined = "[study]\ntype = \"equilibrium\"\n[refine]\n";

std::string hold(const std::string& chosen) { return "[[group]]\nname = \"g\"\nof = \"b\"\n" + chosen + "\n[[support]]\ngroup = \"g\"\n[[support]]\ngroup = \"b\"\ndirections = \"x\"\n"; }

}  // namespace

TEST_CASE("A row keeps EA, EI, mass a length, the ends of what is held and the sum of loads", "[refine]") {
  CHECK(levels_of_text(five + by_stiffness + "density = 12\n" + hold("first = 1") + refined)[1] ==
        "beam.b.particles=9 beam.b.bond_stiffness=16.0 beam.b.angle_stiffness=4.0 beam.b.density=6.0");
  CHECK(levels_of_text(five + by_section + hold("middle = 1") + refined) == std::vector<std::string>{"beam.b.particles=5", "beam.b.particles=9", "beam.b.particles=17"});
  // A clamp is in the middle of a bond: particles 0 and 1 of 5, of 13 particles 0 to 2.
  CHECK(levels_of_text(five + by_section + hold("first = 2") + refined + "by = 3\n")[1] == "beam.b.particles=13 group.g.first=3");
  CHECK(levels_of_text(five + by_section + hold("last = 3") + refined + "by = 3\n")[1] == "beam.b.particles=13 group.g.last=6");
  CHECK(levels_of_text(five + by_section + hold("ids = [2, 3, 5]") + refined + "by = 3\n")[1] == "beam.b.particles=13 group.g.ids=[5, 6, 13]");
  CHECK(wrong_of_text(five + by_section + hold("first = 2") + refined) ==
        "group.g.first: are held neighbours, which clamp a row in the middle of their bond; with an even refine.by no bond has this middle: give by = 3, or the "
        "[[beam]] `clamped` ends");
  // A particle beyond an end stays one spacing beyond.
  CHECK(levels_of_text(five + by_section + "clamped = \"from\"\n" + hold("first = 2") + refined) ==
        std::vector<std::string>{"beam.b.particles=5", "beam.b.particles=8", "beam.b.particles=14"});
  // Loads on what lies between, too: 2 to 4 of 5 particles become 3 to 7 of 9, with the same sum.
  CHECK(levels_of_text(five + by_section + hold("first = 1") + "[[group]]\nname = \"l\"\nof = \"b\"\nids = [2, 3, 4]\n[[load]]\ngroup = \"l\"\nforce = [5, 0, 0]\n" + refined)[1] ==
        "beam.b.particles=9 group.l.ids=[3, 4, 5, 6, 7] load.1.force=[3.0, 0.0, 0.0]");
  CHECK(wrong_of_text("plane = \"xz\"\n[[beam]]\nname = \"b\"\nparticles = 4\nfrom = [0, 0, 0]\nto = [0, 0, 3]\ndiameter = 1\n" + by_section + hold("middle = 1") + refined) ==
        "group.g.middle: has no middle that stays, 1 of 4 particles; take an odd number of them");
  CHECK(levels_of_text(five + by_stiffness + "rest = 170\nrest_length = 1.5\n" + hold("first = 1") + "[[contact]]\nbetween = [\"b\", \"b\"]\neffective_modulus = 1\nexclude_bonds = 1\n" +
               refined)[1] == "beam.b.particles=9 beam.b.bond_stiffness=16.0 beam.b.angle_stiffness=4.0 beam.b.rest_length=0.75 beam.b.rest=175.0 contact.1.exclude_bonds=2");
}

TEST_CASE("Rings and sheets, and grains behind them", "[refine]") {
  const std::string ring = "plane = \"xy\"\n[[loop]]\nname = \"b\"\nparticles = 8\nradius = 1\ndiameter = 0.1\n" + by_section +
                           "[[grains]]\nname = \"grain\"\npositions = [[3, 0, 0]]\ndiameter = 0.1\n[[group]]\nname = \"g\"\nids = [1, 5, 9]\n[[support]]\ngroup = \"g\"\n";
  CHECK(levels_of_text(ring + refined)[1] == "loop.b.particles=16 group.g.ids=[1, 9, 17]");
  const std::string sheet = R"([constants]
h = 1
[[sheet]]
name = "s"
size = [4, 3.4641016151377544]
spacing = "h"
youngs_modulus = 1
density = 8
[[group]]
name = "g"
of = "s"
inside = {shape = "block", lo = [-9, -9, -1], hi = [9, )";
  const std::string rest = ", 1]}\n[[support]]\ngroup = \"g\"\n[[support]]\ngroup = \"s\"\ndirections = \"z\"\n";
  CHECK(levels_of_text(sheet + "-1.7" + rest + refined)[1] == "sheet.s.spacing=0.5 sheet.s.thickness=1.0 sheet.s.diameter=1.0 sheet.s.density=2.0");
  CHECK(levels_of_text(sheet + "\"-1.7 + h\"" + rest + refined + "divide = [\"constants.h\"]\n")[2].starts_with("constants.h=0.25 sheet.s.spacing=0.25 "));
  // The last two are another two.
  CHECK(wrong_of_text(sheet + "-1.7" + rest + "[[group]]\nname = \"c\"\nof = \"s\"\nlast = 2\n" + refined).starts_with("group.c: does not stay where it is: particle "));
  CHECK(wrong_of_text(sheet + "-1.7" + rest + "[[group]]\nname = \"c\"\nof = \"s\"\nids = [3]\n" + refined) ==
        "group.c.ids: are particles of a [[sheet]], which have other ids at another spacing; choose by `inside`");
}

TEST_CASE("What cannot be refined is refused by name", "[refine]") {
  const std::string ends = hold("first = 1");
  CHECK(wrong_of_text(five + by_section + ends + "[[bonds]]\npairs = [[1, 3]]\nbond_stiffness = 1\n" + refined) == "refine: cannot refine bonds.1, bonds between single particles");
  CHECK(wrong_of_text(five + by_section + ends + refined + "[[sweep]]\nkey = \"beam.b.diameter\"\nvalues = [1, 2]\n").find("does not go with [[sweep]]") != std::string::npos);
  CHECK(wrong_of_text(five + by_section + ends + "[study]\ntype = \"modes\"\n[modes]\ncount = 2\n[refine]\n") == "refine: is of a path or an equilibrium; other studies have no value without particles");
  CHECK(wrong_of_text(five + by_section + ends + refined + "divide = [\"constants.k\"]\n") == "refine.divide: \"constants.k\" is none of [constants]; name one, such as \"constants.h\"");
  CHECK(wrong_of_text(five + by_section + ends + refined + "by = 10\nlevels = 10\n") ==
        "refine.levels: would have rows of 5e+09 particles at the end; at most 100000000 are allowed");
  CHECK(wrong_of_text(five + by_section + ends + refined + "levels = 2\n") == "refine.levels: must be an integer from 3 to 10, is 2");
  CHECK(wrong_of_text(five + by_section + ends + "[study]\ntype = \"equilibrium\"\n[[expect]]\nobservable = \"energy\"\nvalue = 0\ncontinuum = true\n") ==
        "expect.1.bar: is missing; how wide the error bar may be, relative to the value; expect.1.continuum: is of the value without particles, which [refine] "
        "finds; there is none");
}

TEST_CASE("Euler's column between plain clamps and hinges, inside its error", "[refine]") {
  for (const bool clamps : {true, false}) {
    INFO(clamps);
    const std::string count = clamps ? "2" : "1";
    // Clamps are in the middle of the end bonds: what bends is 10 long.
    const std::string problem = "plane = \"xz\"\n[[beam]]\nname = \"b\"\nparticles = " + std::string(clamps ? "12" : "11") + "\ncenter = [0, 0, 0]\naxis = [0, 0, 1]\nspacing = 1\n" +
                                "diameter = 0.5\naxial_stiffness = 1e6\nbending_stiffness = 1\n[[group]]\nname = \"lo\"\nof = \"b\"\nfirst = " + count +
                                "\n[[group]]\nname = \"hi\"\nof = \"b\"\nlast = " + count + R"(
[[support]]
group = "lo"
[[support]]
group = "hi"
directions = "x"
[[load]]
group = "hi"
total_force = [0, 0, -1]
[path]
to = 1
when_unstable = "stop"
[refine]
by = 3
[[expect]]
observable = "lambda"
at = "branch:1"
continuum = true
rtol = 0
)";
    // EI π²/L² a link of chains that give way: P (1 − P/EA) = EI π²/L_e², to P/EA = 1e-6 of the length that bends.
    const double length = clamps ? 5 : 10, euler = pi * pi / (length * length), load = 2 * euler / (1 + std::sqrt(1 - 4 * euler / 1e6));
    std::ostringstream value;
    value.precision(17);
    value << load;
    const ScratchDirectory scratch;
    const std::string file = scratch.file("p.toml", problem + "value = " + value.str() + "\nbar = 1e-3\n");
    const Answer answer = elamin_says("verify '" + file + "' -o '" + (scratch / "r") + "'", 60);
    INFO(answer.text);
    CHECK(answer.status == 0);
    const auto rows = csv_rows(scratch / "r/refine.csv");
    CHECK(rows[1][1] == "lambda");
    CHECK(std::abs(std::stod(rows[1][4]) - 2) < 0.02);
    CHECK(rows[1][5] == "asymptotic");
    CHECK(std::stod(rows[1][2]) == Approx(load).epsilon(1e-4));
    std::ifstream written(scratch / "r/refine.json");
    const auto all = nlohmann::json::parse(written);
    CHECK(all["levels"].size() == 3);
    CHECK(all["quantities"][0]["at"] == "branch:1");
    // A value elsewhere, and an error wider than it may be.
    const std::string off = scratch.file("off.toml", problem + "value = " + std::to_string(1.01 * load) + "\nbar = 1e-3\n");
    CHECK(elamin_says("verify '" + off + "' --quiet", 60).status == 3);
    const std::string wide = scratch.file("wide.toml", problem + "value = " + value.str() + "\nbar = 1e-9\n");
    CHECK(elamin_says("verify '" + wide + "' --quiet", 60).status == 3);
    // In parts, and put together.
    for (const char* part : {"1/2", "2/2"}) CHECK(elamin_says("'" + file + "' --quiet -o '" + (scratch / "parts") + "' --part " + part, 60).status == 0);
    CHECK(elamin_says("collect '" + (scratch / "parts") + "'", 60).status == 0);
    CHECK(csv_rows(scratch / "parts/refine.csv") == rows);
  }
}

TEST_CASE("Events that only some levels have are told, and not compared", "[refine]") {
  const ScratchDirectory scratch;
  const Answer answer = elamin_says("'" ELAMIN_ROOT "/problems/ring_between_plates.toml' -o '" + (scratch / "r") + "'", 60);
  INFO(answer.text);
  CHECK(answer.status == 0);
  CHECK(answer.text.find("at level 2, 3, 4 alone, and not compared: contact:5") != std::string::npos);
  CHECK(answer.text.find("the levels do not approach a value: no error") != std::string::npos);
}

TEST_CASE("A level that does not converge is told, and its end is not compared", "[refine]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", five + "axial_stiffness = 1e8\nbending_stiffness = 1\n[[group]]\nname = \"g\"\nof = \"b\"\nfirst = 1\n[[group]]\nname = \"t\"\n"
                                                  "of = \"b\"\nlast = 1\n[[support]]\ngroup = \"g\"\n[[load]]\ngroup = \"t\"\nforce = [1, 0, 0]\n[solver]\nmax_iterations = 3\n" + refined);
  const Answer answer = elamin_says("'" + file + "' -o '" + (scratch / "r") + "'", 60);
  INFO(answer.text);
  CHECK(answer.status == 2);
  CHECK(answer.text.find("level 3 ends early, and its end is not compared: 3 iterations were not enough") != std::string::npos);
  CHECK(csv_rows(scratch / "r/refine.csv").size() == 1);
}

TEST_CASE("Ends at different load factors are told, and not compared", "[refine]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", five + by_section + "rise = 0.6\nrest = \"as_built\"\n[[group]]\nname = \"feet\"\nids = [1, 5]\n[[group]]\nname = \"crown\"\n"
                                                  "of = \"b\"\nmiddle = 1\n[[support]]\ngroup = \"feet\"\n[[load]]\ngroup = \"crown\"\nforce = [-0.1, 0, 0]\n[path]\n"
                                                  "method = \"arc_length\"\nsteps = 20\npoints = 8\n[refine]\n");
  const Answer answer = elamin_says("'" + file + "' -o '" + (scratch / "r") + "'", 60);
  INFO(answer.text);
  CHECK(answer.status == 0);
  CHECK(answer.text.find("final is not at one load factor, and not compared: the levels end at 0.") != std::string::npos);
  for (const auto& row : csv_rows(scratch / "r/refine.csv")) CHECK(row[0] != "final");
}
