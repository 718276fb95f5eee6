// Runs end: with the equilibrium, or with a sentence that names what is in the way.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"

#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <thread>
#include <unistd.h>

namespace {

const std::vector<std::string> methods{"newton", "ipopt", "nlopt:LD_LBFGS", "fire"};

struct Ended {
  Answer answer;
  std::vector<TableRow> path;
  bool says(const std::string& words) const { return answer.text.find(words) != std::string::npos; }
};

/// Runs a file with more arguments. No number in what it says or writes is NaN or infinite.
Ended run(const std::string& text, const std::string& more = "") {
  const ScratchDirectory scratch;
  Ended ended{elamin_says("'" + scratch.file("p.toml", text) + "' -o '" + (scratch / "out") + "' " + more), {}};
  const std::string table = std::filesystem::exists(scratch / "out/path.csv") ? text_of(scratch / "out/path.csv") : "";
  for (const char* word : {"nan", "inf,", "inf\n", " inf "}) {
    CHECK(table.find(word) == std::string::npos);
    CHECK(ended.answer.text.find(word) == std::string::npos);
  }
  if (!table.empty()) ended.path = table_of(scratch / "out/path.csv");
  return ended;
}

std::string with(const std::string& method) { return "--set solver.method='\"" + method + "\"'"; }

// One grain of radius r, held along the given directions, weight mg along −z.
std::string grain(const std::string& position, double r, double density, const std::string& held) {
  return "[[grains]]\nname = \"g\"\npositions = [" + position + "]\ndiameter = " + std::to_string(2 * r) + "\ndensity = " + std::to_string(density) +
         "\n[[gravity]]\nacceleration = [0, 0, -10]\n[[observe]]\nname = \"z\"\ngroup = \"g\"\nquantity = \"position.z\"\n" +
         (held.empty() ? "" : "[[support]]\ngroup = \"g\"\ndirections = \"" + held + "\"\n");
}

double weight(double r, double density) { return 10 * density * 4 / 3 * pi * r * r * r; }

// δ of  4/3 E √r δ^{3/2} = F.
double indentation(double force, double modulus, double r) { return std::pow(force / (4.0 / 3 * modulus * std::sqrt(r)), 2.0 / 3); }

std::string wall(const std::string& shape, double modulus) { return "[[wall]]\nname = \"w\"\n" + shape + "\neffective_modulus = " + std::to_string(modulus) + "\n"; }

}  // namespace

TEST_CASE("a centre that lies on its wall is driven off to the wall's side", "[study][ends]") {
  for (const double r : {1e-3, 0.5, 40.0})
    for (const std::string& method : methods) {
      INFO(r << " " << method);
      const double modulus = 40 * r;                            // of mg/r²: δ stays small
      for (const char* plane : {"shape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]", "shape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, -1]\nside = \"outside\"",
                                "shape = \"block\"\nlo = [-100, -100, -100]\nhi = [100, 100, 0]\nside = \"outside\""}) {
        const Ended e = run(grain("[0, 0, 0]", r, 0.1, "xy") + wall(plane, modulus), with(method));
        INFO(e.answer.text);
        REQUIRE(e.answer.status == 0);
        CHECK(e.path.back()["z"] == Approx(r - indentation(weight(r, 0.1), modulus, r)).epsilon(1e-9));
      }
    }
}

TEST_CASE("what starts at the centre of a bowl or on the axis of a tube falls to the bottom", "[study][ends]") {
  const double r = 0.5, R = 2, modulus = 100;
  const double bottom = -(R - r) - indentation(weight(r, 1), modulus, r);
  for (const std::string& method : methods)
    for (const char* shape : {"shape = \"sphere\"\ncenter = [0, 0, 0]\nradius = 2", "shape = \"cylinder\"\naxis = \"y\"\ncenter = [0, 0]\nradius = 2"}) {
      const Ended e = run(grain("[0, 0, 0]", r, 1, "") + wall(shape, modulus), with(method));
      INFO(method << " " << shape << "\n" << e.answer.text);
      REQUIRE(e.answer.status == 0);
      CHECK(e.path.back()["z"] == Approx(bottom).epsilon(1e-9));
    }
}

TEST_CASE("a wall too soft for a weight is named", "[study][ends]") {
  for (const std::string& method : methods) {
    const Ended e = run(grain("[0, 0, 0.6]", 0.5, 1, "xy") + wall("shape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]", 1), with(method));
    INFO(method << " " << e.answer.text);
    CHECK(e.answer.status == 2);
    CHECK(e.says("the centre of g 1 is pressed"));
    CHECK(e.says("the wall 'w'"));
  }
  // Held from falling by a beam, on the wrong side of the wall.
  const std::string beam = "[[beam]]\nname = \"b\"\nparticles = 8\nfrom = [0, 0, 0.6]\nto = [7, 0, 0.6]\ndiameter = 1\nyoungs_modulus = 1e3\ndensity = 1\n"
                           "[[group]]\nname = \"end\"\nof = \"b\"\nfirst = 2\n[[support]]\ngroup = \"end\"\n[[gravity]]\nacceleration = [0, 0, -9.81]\n" +
                           wall("shape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]", 1e-3);
  for (const std::string& method : methods) {
    const Ended e = run(beam, with(method));
    INFO(method << " " << e.answer.text);
    CHECK(e.answer.status == 2);
    CHECK(e.says("is pressed"));
  }
  const Ended path = run(beam + "[path]\nsteps = 2\n");
  CHECK(path.answer.status == 2);
  CHECK(path.says("the wall 'w'"));
}

TEST_CASE("a beam whose centres lie on the floor rises from it", "[study][ends]") {
  const std::string beam = R"(
[[beam]]
name = "b"
particles = 12
from = [0, 0, 0]
to = [0.011, 0, 0]
diameter = 1e-3
youngs_modulus = 1e6
density = 1000
[[group]]
name = "end"
of = "b"
first = 2
[[support]]
group = "end"
[[gravity]]
acceleration = [0, 0, -9.81]
)" + wall("shape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]", 1e6);
  double energy = 0;
  for (const std::string& method : methods) {
    const Ended e = run(beam, with(method));
    INFO(method << " " << e.answer.text);
    REQUIRE(e.answer.status == 0);
    if (energy == 0) energy = e.path.back()["energy"];
    CHECK(e.path.back()["energy"] == Approx(energy).epsilon(1e-9));
  }
}

TEST_CASE("an energy that is not finite is no result", "[study][ends]") {
  const std::string on_another = R"(
[[beam]]
name = "b"
particles = 3
from = [0, 0, 0]
to = [2, 0, 0]
diameter = 1
youngs_modulus = 1
[[group]]
name = "one"
of = "b"
ids = [1]
[[group]]
name = "rest"
of = "b"
ids = [2, 3]
[[support]]
group = "one"
displacement = [1, 0, 0]
[[support]]
group = "rest"
[study]
type = "energy"
)";
  const Ended e = run(on_another);
  INFO(e.answer.text);
  CHECK(e.answer.status == 2);
  CHECK(e.says("the energy is not finite here: b 1 and b 2"));
  const ScratchDirectory scratch;
  const Answer command = elamin_says("energy '" + scratch.file("p.toml", on_another) + "'");
  CHECK(command.status == 2);
  CHECK(command.text.find("inf") == std::string::npos);
}

TEST_CASE("where the energy of lj jumps at its cutoff, the cutoff is named", "[study][ends]") {
  const auto hanging = [](const std::string& size) {
    return R"([[grains]]
name = "held"
density = 1
positions = [[0, 0, 0]]
diameter = 1
[[grains]]
name = "free"
positions = [[0, 0, -2.45]]
diameter = 1
density = 1
[[contact]]
between = ["held", "free"]
law = "lj"
epsilon = 1
sigma = 1
cutoff = )" + size + R"(
[[support]]
group = "held"
[[support]]
group = "free"
directions = "xy"
[[gravity]]
acceleration = [0, 0, -0.1]
[study]
type = "equilibrium"
)" + wall("shape = \"plane\"\npoint = [0, 0, -3.05]\nnormal = [0, 0, 1]", 100);
  };
  const Ended at = run(hanging("2.5"));
  INFO(at.answer.text);
  CHECK(at.answer.status == 2);
  CHECK(at.says("at the cutoff of law \"lj\", 2.5, where its energy jumps by 0.0163"));
  CHECK(run(hanging("2.5\ncutoff_style = \"shifted\"")).answer.status == 0);
  CHECK(run(hanging("2.5\ncutoff_style = \"smooth\"\ninner_cutoff = 2")).answer.status == 0);
  // With a shorter cutoff nothing attracts it any more: it lies on the floor.
  CHECK(run(hanging("2.2")).answer.status == 0);
}

// Grains of a box push each other apart until each pair overlaps by less than 1e-15 of a diameter: three in a row are a saddle then of
// forces that count as none.
TEST_CASE("grains that have parted are at rest, stable, whatever stands in a row", "[study][ends]") {
  const std::string grains = R"(
[[grains]]
name = "grains"
diameter = 0.03
density = 0.01
positions = [[-0.008795667501527155, 0.023354396304868758, 0.0171],
             [-0.05298787626936144, -0.020952747301024983, 0.0171],
             [-0.037443875573386014, -0.04321210895450743, 0.0171],
             [-0.033256417593966886, -0.016370562933436937, 0.0171],
             [-0.010942647731548986, 0.004114573804355836, 0.0171],
             [-0.00856538147325075, 0.019633267042056507, 0.0171],
             [-0.03132806152845915, 0.04008044825744021, 0.0171],
             [-0.050096915121019825, 0.018069556078910635, 0.0171],
             [-0.008765690949084541, 0.0062211218152496755, 0.0171],
             [-0.03811898450890522, -0.03200124215700285, 0.0171],
             [0.03187892427960689, 0.049635727026256134, 0.0171]]
[[contact]]
between = ["grains", "grains"]
youngs_modulus = 1e3
poissons_ratio = 0.5
[[wall]]
name = "box"
shape = "block"
lo = [-0.053, -0.053, -0.002]
hi = [0.053, 0.053, 0.1]
effective_modulus = 666.66666666666667
[study]
type = "equilibrium"
)";
  for (const std::string& method : {std::string("newton"), std::string("auto"), std::string("fire")}) {
    const Ended e = run(grains, with(method));
    INFO(method << e.answer.text);
    CHECK(e.answer.status == 0);
    CHECK(e.path.back().text("stable") == "true");
    CHECK(e.says("free at the end: "));
  }
}

TEST_CASE("what floats, and nothing pulls on it, is at rest, its free motions are named", "[study][ends]") {
  const std::string sheet = R"(
[[sheet]]
name = "sheet"
shape = "rectangle"
size = [3, 3]
spacing = 1
youngs_modulus = 1
[[grains]]
name = "grain"
positions = [[0, 0, 1.5]]
diameter = 2
)";
  const std::string glue = "[[connect]]\nbetween = [\"grain\", \"sheet\"]\nwithin = 2.5\nbonds_per_particle = 3\nbond_stiffness = 1\n";
  const std::string contact = "[[contact]]\nbetween = [\"grain\", \"sheet\"]\neffective_modulus = 1\n";
  for (const std::string& holding : {glue, contact}) {
    for (const std::string& method : methods) {
      const Ended e = run(sheet + holding + "[study]\ntype = \"equilibrium\"\n", with(method));
      INFO(method << "\n" << holding << e.answer.text);
      CHECK(e.answer.status == 0);
      CHECK(e.says("free at the end: translation of"));
      CHECK(e.path.back().text("stable") == "true");
    }
    const Ended e = run(sheet + holding + "[study]\ntype = \"path\"\n[path]\nsteps = 3\n");
    INFO(e.answer.text);
    CHECK(e.answer.status == 0);
    CHECK(e.says("free at the end: translation of"));
  }
  // A force that nothing bears, and one that another cancels.
  const std::string asks = "[study]\ntype = \"equilibrium\"\n", up = "[[load]]\ngroup = \"grain\"\nforce = [0, 0, 0.01]\n";
  const Ended pulled = run(sheet + glue + up + asks);
  CHECK(pulled.answer.status == 1);
  CHECK(pulled.says("none of its particles is held by a support; an equilibrium needs a [[support]]"));
  const Ended balanced = run(sheet + glue + up + "[[load]]\ngroup = \"sheet\"\ntotal_force = [0, 0, -0.01]\n" + asks);
  INFO(balanced.answer.text);
  CHECK(balanced.answer.status == 0);
}

TEST_CASE("a radial load on a body is a mistake of the file", "[study][ends]") {
  const Ended e = run("[[body]]\nname = \"one\"\nshape = \"cube\"\nedge = 1\nrounding_diameter = 0.2\n[[load]]\ngroup = \"one\"\nradial = 1\n"
                      "axis = [0, 0, 1]\n[study]\ntype = \"energy\"\n");
  CHECK(e.answer.status == 1);
  CHECK(e.says("is of particles, and \"one\" has bodies; give force"));
}

TEST_CASE("a state whose bodies have another shape is a mistake of the file", "[study][ends]") {
  const auto cubes = [](const std::string& edge) {
    std::string text = "[study]\ntype = \"equilibrium\"\n[[wall]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\nk_n = 20\n";
    for (const char* which : {"\"a\"\nposition = [0, 0, 0.6]", "\"b\"\nposition = [0, 0, 1.8]"})
      text += std::string("[[body]]\nname = ") + which + "\nshape = \"cube\"\nedge = " + edge + "\nrounding_diameter = 0.2\n";
    return text + "[[support]]\ngroup = \"a\"\n[[support]]\ngroup = \"b\"\n";
  };
  const ScratchDirectory scratch;
  REQUIRE(elamin_says("'" + scratch.file("first.toml", cubes("1")) + "' --quiet").status == 0);
  const Answer then = elamin_says("'" + scratch.file("then.toml", cubes("1.1")) + "' --quiet --set path.start='\"first/states/final.data\"'");
  CHECK(then.status == 1);
  CHECK(then.text.find("in another shape; it must be a state of this problem") != std::string::npos);
}

TEST_CASE("a driven motion goes on from its last state as if it had never stopped", "[study][ends][dynamics]") {
  const std::string pressed = R"(
plane = "xz"
[[beam]]
name = "column"
particles = 12
center = [0, 0, 0]
axis = [0, 0, 1]
diameter = 1.0e-3
youngs_modulus = 0.96e6
density = 800.0
[[group]]
name = "bottom"
of = "column"
first = 2
[[group]]
name = "top"
of = "column"
last = 2
[[support]]
group = "bottom"
[[support]]
name = "press"
group = "top"
velocity = [0, 0, -1e-3]
[[load]]
group = "column"
total_force = [1e-7, 0, 0]
[[viscosity]]
coefficient = 1e-6
[dynamics]
timestep = 1e-5
every = 100
[[observe]]
name = "shortening"
group = "top"
quantity = "displacement.z"
)";
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", pressed);
  const auto motion = [&](const std::string& name, int steps, const std::string& more = "") {
    const Answer answer = elamin_says("'" + file + "' --quiet -o '" + (scratch / name) + "' --set dynamics.steps=" + std::to_string(steps) + more);
    INFO(answer.text);
    REQUIRE(answer.status == 0);
    return table_of(scratch / (name + "/trajectory.csv"));
  };
  const auto whole = motion("whole", 2000), first = motion("first", 1000),
             then = motion("then", 1000, " --set path.start='\"first/states/final.data\"'");
  REQUIRE(whole.size() == 21);
  REQUIRE(then.size() == 11);
  const double rounding = 1e-9 * whole[10]["energy"];            // of forces that the stiff bonds make of the last digits
  for (std::size_t k = 0; k < then.size(); ++k) {
    INFO(k);
    for (const char* column : {"energy", "kinetic"}) CHECK(std::abs(then[k][column] - whole[10 + k][column]) <= rounding);
    CHECK(then[k]["shortening"] == Approx(whole[10 + k]["shortening"]).epsilon(1e-12));
  }
}

TEST_CASE("a run that starts from a state in its own directory keeps that state", "[study][ends]") {
  const std::string toml = R"(
plane = "xz"
[[grains]]
name = "truss"
positions = [[-1, 0, 0], [0, 0, 0.36397023426620236], [1, 0, 0]]
diameter = 0.1
[[connect]]
between = ["feet", "apex"]
within = 1.1
bond_stiffness = 0.47
[[group]]
name = "feet"
of = "truss"
ids = [1, 3]
[[group]]
name = "apex"
of = "truss"
ids = [2]
[[support]]
group = "feet"
[[load]]
group = "apex"
force = [0, 0, -1]
[path]
method = "arc_length"
steps = 20
to = 0.05
)";
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", toml);
  const std::string out = "' --quiet -o '" + (scratch / "p") + "' ";
  for (const std::string label : {"limit-1", "final"}) {
    REQUIRE(elamin_says("'" + file + out).status == 0);
    const std::string state = scratch / ("p/states/" + label + ".data"), before = text_of(state);
    REQUIRE(!before.empty());
    const std::string again = "'" + file + out + "--set path.start='\"p/states/" + label + ".data\"' --set path.to=" + (label == "final" ? "0.1" : "0.05");
    std::string rows;
    for (int time = 0; time < 2; ++time) {
      const Answer answer = elamin_says(again);
      INFO(label << " " << answer.text);
      REQUIRE(answer.status == 0);
      CHECK(text_of(state) == before);
      if (time == 0) rows = text_of(scratch / "p/path.csv");
      CHECK(text_of(scratch / "p/path.csv") == rows);
    }
    CHECK(std::filesystem::exists(scratch / (label == "final" ? "p/states/final-again.data" : "p/states/final.data")));
  }
}

TEST_CASE("check and the log tell of rest angles without a sign and of bonds without stiffness", "[study][ends]") {
  const auto arch = [](const std::string& more) {
    return more + "[[beam]]\nname = \"arch\"\nparticles = 9\nfrom = [0, 0, 0]\nto = [1, 0, 0]\ntoward = [0, 0, 1]\nrise = 0.2\nrest = \"as_built\"\n"
                  "diameter = 0.05\nyoungs_modulus = 1\n[[support]]\ngroup = \"arch\"\n[study]\ntype = \"equilibrium\"\n";
  };
  const ScratchDirectory scratch;
  const std::string words = "'arch' has rest angles that are not straight";
  const auto checked = [&](const std::string& text) { return elamin_says("check '" + scratch.file("p.toml", text) + "'").text; };
  CHECK(checked(arch("")).find(words) != std::string::npos);
  CHECK(checked(arch("plane = \"xz\"\n")).find(words) == std::string::npos);
  REQUIRE(elamin_says("'" + scratch.file("p.toml", arch("")) + "' --quiet").status == 0);
  CHECK(text_of(scratch / "p/log.txt").find(words) != std::string::npos);
  const std::string grains = "[[grains]]\nname = \"g\"\npositions = [[0, 0, 0], [1, 0, 0]]\ndiameter = 1\n[[support]]\ngroup = \"g\"\n[[connect]]\n"
                             "between = [\"g\", \"g\"]\nwithin = 1.5\nbond_stiffness = ";
  CHECK(checked(grains + "1").find("stiffness 0") == std::string::npos);
  scratch.file("two.data", "two\n\n2 atoms\n1 bonds\n1 atom types\n1 bond types\n\n-2 2 xlo xhi\n-2 2 ylo yhi\n-2 2 zlo zhi\n\nBond Coeffs\n\n1 0.0 1.0\n\n"
                           "Atoms # hybrid sphere bond\n\n1 1 0.0 0.0 0.0 0.1 1.0 0\n2 1 1.0 0.0 0.0 0.1 1.0 0\n\nBonds\n\n1 1 1 2\n");
  CHECK(checked("[lammps]\ndata = \"two.data\"\natom_style = \"hybrid sphere bond\"\n[[support]]\ngroup = \"all\"\n")
            .find("1 of the bonds of lammps 'lammps' have stiffness 0 and hold nothing; the first joins particle 1 and particle 2") != std::string::npos);
}

TEST_CASE("what is no equilibrium is not called stable, and a path tells what Newton's method does in it", "[study][ends]") {
  const std::string beam = "plane = \"xz\"\n[[beam]]\nname = \"b\"\nparticles = 8\nfrom = [0, 0, 0]\nto = [7, 0, 0]\ndiameter = 1\nyoungs_modulus = 1\n"
                           "[[group]]\nname = \"end\"\nof = \"b\"\nfirst = 2\n[[support]]\ngroup = \"end\"\n[[load]]\ngroup = \"b\"\nforce = [0, 0, -1e-4]\n";
  const Ended modes = run(beam + "[solver]\nmax_iterations = 1\n[study]\ntype = \"modes\"\n");
  INFO(modes.answer.text);
  CHECK(modes.answer.status == 2);
  CHECK(modes.path.back().text("stable") == "false");
  CHECK_FALSE(modes.says(" stable"));
  const ScratchDirectory scratch;
  for (const std::string& method : methods) {
    REQUIRE(elamin_says("'" + scratch.file("p.toml", beam + "[path]\nsteps = 2\n") + "' --quiet " + with(method)).status == 0);
    CHECK((text_of(scratch / "p/log.txt").find("solver.method = \"" + method + "\" finds the equilibria between") != std::string::npos) == (method != "newton"));
  }
}

TEST_CASE("a path that gets nowhere ends with a sentence", "[study][ends]") {
  // Two supports drive two grains into each other: no step goes on where their centres meet.
  for (const double size : {1e-4, 1.0, 1e3}) {
    const std::string d = std::to_string(size), two = std::to_string(2 * size);
    const Ended colliding = run("[[grains]]\nname = \"g\"\npositions = [[0, 0, 0], [" + two + ", 0, 0]]\ndiameter = " + d +
                                "\n[[contact]]\nbetween = [\"g\", \"g\"]\neffective_modulus = 100\n[[group]]\nname = \"a\"\nids = [1]\n[[group]]\n"
                                "name = \"b\"\nids = [2]\n[[support]]\ngroup = \"a\"\ndisplacement = [" + two + ", 0, 0]\n[[support]]\ngroup = \"b\"\n"
                                "displacement = [-" + two + ", 0, 0]\n[path]\nsteps = 4\n");
    INFO(colliding.answer.text);
    CHECK(colliding.answer.status == 2);
    CHECK(colliding.says("at load factor 0.5"));
  }
  // A particle of a beam that its support brings onto its neighbour: the energy is not finite there.
  const std::string onto = "[[beam]]\nname = \"b\"\nparticles = 3\nfrom = [0, 0, 0]\nto = [2, 0, 0]\ndiameter = 1\nyoungs_modulus = 1\n[[group]]\n"
                           "name = \"one\"\nof = \"b\"\nids = [1]\n[[group]]\nname = \"rest\"\nof = \"b\"\nids = [2, 3]\n[[support]]\ngroup = \"one\"\n"
                           "displacement = [1, 0, 0]\n[[support]]\ngroup = \"rest\"\n[path]\nsteps = 10\n";
  for (const std::string& method : methods) {
    const Ended e = run(onto, with(method));
    INFO(method << " " << e.answer.text);
    CHECK(e.answer.status == 2);
    CHECK(e.path.size() >= 10);
    CHECK(run(onto + "[study]\ntype = \"equilibrium\"\n", with(method)).answer.status == 2);
  }
}

TEST_CASE("a second signal ends the program at once, whatever it is at", "[study][ends]") {
  const ScratchDirectory scratch;                               // building half a million particles takes longer than the test
  const std::string file = scratch.file("p.toml", "[[sheet]]\nname = \"s\"\nshape = \"rectangle\"\nsize = [700, 700]\nspacing = 1\nyoungs_modulus = 1\n"
                                                  "[[support]]\ngroup = \"s\"\ndirections = \"z\"\n[[group]]\nname = \"a\"\nof = \"s\"\nfirst = 2\n"
                                                  "[[support]]\ngroup = \"a\"\n[study]\ntype = \"equilibrium\"\n");
  using namespace std::chrono;
  const auto takes_signals = [](pid_t child) {                  // the program has begun, and catches SIGINT: bit 1 of SigCgt
    const std::string process = "/proc/" + std::to_string(child);
    std::error_code none;
    if (!std::filesystem::equivalent(process + "/exe", ELAMIN_PROGRAM, none)) return false;
    const std::string status = text_of(process + "/status");
    return (std::stoul(status.substr(status.find('\n', status.find("SigCgt:")) - 1, 1), nullptr, 16) & 2) != 0;
  };
  for (const int second : {SIGINT, SIGTERM}) {
    const pid_t child = fork();
    if (child == 0) {
      execl(ELAMIN_PROGRAM, ELAMIN_PROGRAM, file.c_str(), "--quiet", "-o", (scratch / "out").c_str(), nullptr);
      _exit(127);
    }
    while (!takes_signals(child)) std::this_thread::sleep_for(milliseconds(5));
    const auto begin = steady_clock::now();
    kill(child, SIGINT);
    std::this_thread::sleep_for(milliseconds(150));
    kill(child, second);
    int status = 0;
    waitpid(child, &status, 0);
    REQUIRE(WIFEXITED(status));
    CHECK(WEXITSTATUS(status) == 130);
    CHECK(duration<double>(steady_clock::now() - begin).count() < 5);
  }
}

TEST_CASE("bodies that are dropped come to rest, or at a kink that is named", "[study][ends][bodies]") {
  const auto body = [](const std::string& name, const std::string& shape, const std::string& place) {
    return "[[body]]\nname = \"" + name + "\"\nshape = " + shape + "\nposition = " + place + "\n";
  };
  const auto plane = [](const std::string& name, const std::string& point, const std::string& normal) {
    return "[[wall]]\nname = \"" + name + "\"\nshape = \"plane\"\npoint = [" + point + "]\nnormal = [" + normal + "]\nk_n = 7800\n";
  };
  const std::string fall = "[[gravity]]\nacceleration = [0, 0, -1]\n[study]\ntype = \"equilibrium\"\n", low = "0, 0, -1";
  const std::string one = body("a", "\"tetrahedron\"\nedge = 0.98\nrounding_diameter = 0.49\nmass = 1.365",
                               "[-0.145, 0.0114, 1]\nrotation = {axis = [-0.088, 0.497, -0.227], angle = 81.55}") +
                          plane("u", low, "0.7, 0, 1") + plane("v", low, "-0.353, 0.604, 1") + plane("w", low, "-0.343, -0.61, 1") + fall;
  const std::string few = " --set solver.max_iterations=20";
  const Ended there = run(one, few);
  INFO(there.answer.text);
  CHECK(there.answer.status == 0);
  CHECK(run(one, with("newton") + few).says("20 iterations were not enough"));
  const Ended kink = run(body("a", "\"tetrahedron\"\nedge = 0.83\nrounding_diameter = 0.438\nmass = 1.71",
                              "[-0.147, 0.0846, 1]\nrotation = {axis = [0.0106, 0.4277, -0.1283], angle = 55.67}") +
                         body("b", "\"box\"\nsize = [0.803, 0.97, 0.434]\nrounding_diameter = 0.367\nmass = 0.7",
                              "[-0.00277, -0.112, 3.2]\nrotation = {axis = [0.0172, -0.0564, -0.944], angle = 152.56}") +
                         "[[contact]]\nbetween = [\"all\", \"all\"]\nlaw = \"rounded\"\nk_n = 7800\nformulation = \"closest\"\n" + plane("u", low, "0.8185, 0, 0.5745") +
                         plane("v", low, "-0.8185, 0, 0.5745") + plane("w", "0, -1.5, 0", "0, 1, 0") + plane("x", "0, 1.5, 0", "0, -1, 0") + fall);
  INFO(kink.answer.text);
  CHECK(kink.answer.status == 2);
  CHECK(kink.says("touch by formulation \"closest\""));
}
