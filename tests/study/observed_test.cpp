// What may be observed besides places and reactions, in every study: columns, [[expect]], [[event]], sweeps.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"
#include "study/truss.hpp"

namespace {

std::string observe(const std::string& name, const std::string& quantity, const std::string& rest) {
  return "[[observe]]\nname = \"" + name + "\"\nquantity = \"" + quantity + "\"\n" + rest + "\n";
}

std::string expect(const std::string& observable, const std::string& at, double value, const std::string& rtol) {
  char text[64];
  std::snprintf(text, sizeof text, "%.17g", value);
  return "[[expect]]\nobservable = \"" + observable + "\"\nat = \"" + at + "\"\nvalue = " + text + "\nrtol = " + rtol + "\n";
}

}  // namespace

TEST_CASE("a truss on its path: tension, angle, difference and stiffness, as events and as expected", "[observed]") {
  const ScratchDirectory scratch;
  const double z = 0.2, r = std::hypot(1, z), rest = std::sqrt(1.25), tension = 2 * (r - rest);
  const double stiffness = -4 * (1 - rest / (r * r * r));                   // dλ/dz, see truss.hpp
  const std::string file = scratch.file(
      "p.toml",
      truss + observe("tension", "tension", "group = \"all\"\nreduce = \"max\"") + observe("strain", "strain", "group = \"all\"") +
          observe("top", "angle", "group = \"feet\"\nto = \"apex\"\naxis = [0, 0, 1]") +
          observe("z_of_feet", "position.z", "group = \"feet\"") + observe("height", "difference", "of = [\"z\", \"z_of_feet\"]") +
          observe("compliance", "derivative", "of = \"height\"") + observe("by_height", "derivative", "of = \"tension\"\nby = \"height\"") +
          "[path]\nto = 0.4\nmethod = \"arc_length\"\nhighest = 0.4\n[[event]]\nname = \"pressed\"\nobservable = \"tension\"\nvalue = " + std::to_string(-0.2) + "\n" +
          "[[event]]\nname = \"low\"\nobservable = \"height\"\nvalue = 0.2\n[[event]]\nname = \"soft\"\nobservable = \"compliance\"\nvalue = -2.5\n" +
          expect("tension", "low:1", tension, "1e-9") + expect("strain", "low:1", (r - rest) / rest, "1e-9") + expect("lambda", "low:1", truss_load(z), "1e-9") +
          expect("compliance", "low:1", 1 / stiffness, "1e-8") + expect("by_height", "low:1", 2 * z / r, "1e-8") + expect("compliance", "soft:1", -2.5, "1e-8") +
          expect("height", "limit:1", truss_limit_z, "1e-8") + expect("by_height", "limit:1", 2 * truss_limit_z / std::hypot(1, truss_limit_z), "1e-7"));
  const Answer answer = elamin_says("verify '" + file + "' --quiet");
  INFO(answer.text);
  CHECK(answer.status == 0);
  const auto events = table_of(scratch / "p/events.csv");
  CHECK(row_of(events, "pressed:1")["z"] == Approx(std::sqrt((rest - 0.1) * (rest - 0.1) - 1)).epsilon(1e-9));
  CHECK(row_of(events, "low:1")["top"] == Approx(0).margin(1e-15));          // the mean of the feet lies below the apex
  // Where the compliance is c, 1 − rest/r³ = −1/(4 c).
  CHECK(row_of(events, "soft:1")["z"] == Approx(std::sqrt(std::pow(rest / (1 - 1 / (4 * 2.5)), 2.0 / 3) - 1)).epsilon(1e-8));
}

TEST_CASE("a cantilever in equilibrium: moment, curvature, energy, the slope of its tip, over a sweep", "[observed]") {
  const ScratchDirectory scratch;
  const double P = 1e-9, B = 2;
  const std::string file = scratch.file(
      "p.toml",
      "[[beam]]\nname = \"beam\"\nparticles = 11\nfrom = [0, 0, 0]\nto = [0, 0, 10]\ndiameter = 1\nbond_stiffness = 100\nangle_stiffness = 2\n"
      "[[group]]\nname = \"root\"\nof = \"beam\"\nfirst = 2\n[[group]]\nname = \"tip\"\nof = \"beam\"\nlast = 1\n[[group]]\nname = \"fourth\"\nof = \"beam\"\nids = [4]\n"
      "[[support]]\ngroup = \"root\"\n[[load]]\ngroup = \"tip\"\nforce = [1e-9, 0, 0]\n" +
          observe("moment", "moment", "group = \"fourth\"") + observe("most", "curvature", "group = \"beam\"\nreduce = \"max\"") +
          observe("slope", "slope", "group = \"beam\"\naxis = [0, 0, 1]\nabout = [0, 1, 0]") + observe("at_root", "slope", "group = \"beam\"\naxis = [0, 0, 1]\nend = \"first\"") +
          observe("energy_of_beam", "energy", "group = \"beam\"") + observe("aside", "displacement.x", "group = \"tip\"") +
          observe("stiffness", "derivative", "of = \"aside\"") + observe("width", "extent.x", "group = \"beam\"") + observe("length", "end_to_end", "group = \"beam\"") +
          "[[sweep]]\nkey = \"load.1.force.1\"\nvalues = [1e-9, 2e-9]\n");
  REQUIRE(elamin_says("'" + file + "' --quiet").status == 0);
  const auto rows = table_of(scratch / "p/sweep.csv");
  REQUIRE(rows.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    const TableRow& row = rows[k];
    const double load = P * (k + 1.0);
    // The hinge at particle i (from 0), 10 − i from the tip, bears P (10 − i) and turns by that over B.
    double slope = 0, energy = 0, aside = 0;
    for (int i = 1; i < 10; ++i) slope += load * (10 - i) / B, aside += load * (10 - i) * (10 - i) / B, energy += load * load * (10 - i) * (10 - i) / (2 * B);
    CHECK(row["moment"] == Approx(7 * load).epsilon(1e-9));
    CHECK(row["most"] == Approx(9 * load / B).epsilon(1e-9));
    CHECK(row["slope"] == Approx(slope).epsilon(1e-9));
    CHECK(row["at_root"] == 0);
    CHECK(row["energy_of_beam"] == Approx(energy).epsilon(1e-9));
    CHECK(row["aside"] == Approx(aside).epsilon(1e-9));
    CHECK(row["stiffness"] == Approx(aside).epsilon(1e-9));                 // by the load factor, which is 1
    CHECK(row["width"] == Approx(aside).epsilon(1e-9));
    CHECK(row["length"] == Approx(10).epsilon(1e-12));
  }
}

TEST_CASE("a ring that swells: its area goes with the square of what is imposed, in a study of modes too", "[observed]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file(
      "p.toml",
      "plane = \"xy\"\n[[loop]]\nname = \"ring\"\nparticles = 12\ncenter = [3, 0, 0]\nradius = 2\ndiameter = 1\nyoungs_modulus = 10\nrest = \"as_built\"\n"
      "[[group]]\nname = \"first\"\nof = \"ring\"\nfirst = 1\n[[group]]\nname = \"other\"\nof = \"ring\"\nids = [7]\n"
      "[[support]]\ngroup = \"first\"\n[[support]]\ngroup = \"other\"\ndirections = \"y\"\n[[change]]\ngroup = \"ring\"\nrest_length = 0.5\n" +
          observe("area", "area", "group = \"ring\"") + observe("growth", "derivative", "of = \"area\"") + observe("across", "distance", "group = \"first\"\nto = \"other\"") +
          "[modes]\ncount = 2\n");
  REQUIRE(elamin_says("'" + file + "' --quiet").status == 0);
  const TableRow row = table_of(scratch / "p/path.csv").at(0);
  const double radius = 2 * 1.5, of_unit = 6 * std::sin(pi / 6);
  CHECK(row["area"] == Approx(of_unit * radius * radius).epsilon(1e-9));
  CHECK(row["across"] == Approx(2 * radius).epsilon(1e-9));
  CHECK(row["growth"] == Approx(2 * of_unit * radius * 1).epsilon(1e-8));   // dr/dλ = 2 · 0.5
}

TEST_CASE("in motion: what flies apart, and a spring's tension and energy as it swings", "[observed]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file(
      "p.toml",
      "[[grains]]\nname = \"a\"\npositions = [[0, 0, 0]]\ndiameter = 1\ndensity = 1\n[[grains]]\nname = \"b\"\npositions = [[0, 4, 0]]\ndiameter = 1\ndensity = 1\n"
      "[[velocity]]\ngroup = \"b\"\nvelocity = [3, 0, 0]\n" +
          observe("apart", "distance", "group = \"a\"\nto = \"b\"") + observe("wide", "extent.x", "group = \"all\"") +
          observe("heading", "angle", "group = \"a\"\nto = \"b\"\naxis = [0, 1, 0]\nabout = [0, 0, -1]") + observe("more", "difference", "of = [\"apart\", \"wide\"]") +
          "[dynamics]\ntimestep = 0.25\nsteps = 4\nevery = 4\n" + expect("apart", "final", 5, "1e-15") + expect("heading", "final", std::atan2(3, 4), "1e-15") +
          expect("more", "final", 2, "1e-15"));
  const Answer answer = elamin_says("verify '" + file + "' --quiet");
  INFO(answer.text);
  CHECK(answer.status == 0);
}

TEST_CASE("a stiffness that sets in at a corner of the path is nothing there, and passes an event's value nowhere", "[observed]") {
  const ScratchDirectory scratch;
  // A spring over a hard floor that rises: from load factor ½ on it is pressed.
  const std::string file = scratch.file(
      "p.toml",
      "plane = \"xz\"\n[[beam]]\nname = \"spring\"\nparticles = 2\nfrom = [0, 0, 0]\nto = [0, 0, 4]\ndiameter = 1\nbond_stiffness = 3\nangle_stiffness = 1\n"
      "[[group]]\nname = \"top\"\nof = \"spring\"\nlast = 1\n[[group]]\nname = \"ball\"\nof = \"spring\"\nfirst = 1\n"
      "[[support]]\ngroup = \"top\"\n[[support]]\ngroup = \"ball\"\ndirections = \"xy\"\n"
      "[[wall]]\nname = \"floor\"\ngroup = \"ball\"\nshape = \"plane\"\npoint = [0, 0, -1]\nnormal = [0, 0, 1]\nhard = true\ndisplacement = [0, 0, 1]\n"
      "[solver]\nmethod = \"ipopt\"\n" +
          observe("force", "reaction.z", "group = \"top\"") + observe("stiffness", "derivative", "of = \"force\"") +
          "[path]\nsteps = 4\n[[event]]\nname = \"stiff\"\nobservable = \"stiffness\"\nvalue = -3\n" + expect("lambda", "contact:1", 0.5, "1e-9") +
          expect("stiffness", "lambda=0.75", -6, "1e-8") + expect("force", "final", -3, "1e-9"));
  const Answer answer = elamin_says("verify '" + file + "' --quiet");
  INFO(answer.text);
  CHECK(answer.status == 0);
  CHECK(row_of(table_of(scratch / "p/events.csv"), "contact:1").text("stiffness").empty());
  CHECK(table_of(scratch / "p/events.csv").size() == 1);
  CHECK(table_of(scratch / "p/path.csv").size() <= 10);
}
