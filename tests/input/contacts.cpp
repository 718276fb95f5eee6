// Contacts, walls and regions, and what they hold.
#include "catch.hpp"

#include "input/model_of.hpp"

using namespace elamin;

namespace {


const Wall& wall(const Model& m, const std::string& name) {
  for (const Wall& w : m.walls)
    if (w.name == name) return w;
  throw std::runtime_error("no wall " + name);
}

std::size_t size_of(const Model& m, const std::string& name) {
  for (const Group& g : m.groups)
    if (g.name == name) return g.particles.size();
  return 0;
}

}  // namespace

TEST_CASE("Effective moduli of contacts") {
  const Model m = build_model(read_problem(good + "structures.toml"));
  REQUIRE(m.contacts.size() == 4);
  const PairContact& unlike = m.contacts[0];
  CHECK(unlike.law == PairContact::Law::hertz);
  CHECK(unlike.effective_modulus == Approx(1 / ((1 - 0.0625) / 1e3 + (1 - 0.25) / 2e3)).epsilon(1e-15));
  CHECK(unlike.exclude_bonds == 3);
  CHECK(unlike.between == std::array<std::string, 2>{"plate", "disc"});
  CHECK(unlike.particles[0].front() == structure(m, "plate").first);
  CHECK(unlike.particles[1].size() == 19);
  CHECK(m.contacts[1].effective_modulus == Approx(1e3 / (2 * 0.75)).epsilon(1e-15));
  CHECK_FALSE(m.contacts[1].exclude_bonds);
  CHECK(m.contacts[2].effective_modulus == 12.5);
  CHECK(m.contacts[2].particles[0] == m.contacts[2].particles[1]);
  CHECK(m.contacts[3].law == PairContact::Law::lj);
  CHECK(m.contacts[3].epsilon == 0.5);
  CHECK(m.contacts[3].sigma == 0.25);
  CHECK(m.contacts[3].cutoff == 1.125);
  CHECK(m.contacts[3].exclude_bonds == 0);
  // Two like materials are the same as one.
  const std::string a = grains("a", "[[0, 0, 0]]") + energy_study + "[[contact]]\nbetween = [\"a\", \"a\"]\n";
  CHECK(model_of(a + "youngs_modulus = [3, 3]\npoissons_ratio = [0.3, 0.3]").contacts[0].effective_modulus ==
        Approx(model_of(a + "youngs_modulus = 3\npoissons_ratio = 0.3").contacts[0].effective_modulus).epsilon(1e-15));
}

TEST_CASE("Walls have their regions, moduli and motions") {
  const Model m = build_model(read_problem(good + "structures.toml"));
  REQUIRE(m.walls.size() == 6);
  const Wall& floor = wall(m, "floor");
  CHECK_FALSE(floor.inside);
  CHECK(floor.region.shape == Shape::plane);
  CHECK(floor.region.normal.norm() == Approx(1).epsilon(1e-15));
  CHECK(floor.region.normal[2] == Approx(4 * floor.region.normal[1]).epsilon(1e-15));
  CHECK(floor.effective_modulus == 3);
  CHECK(floor.displacement == Vec3(0, 0, 1));
  CHECK(static_cast<int>(floor.particles.size()) == structure(m, "plate").count);
  const Wall& box = wall(m, "box");
  CHECK(box.effective_modulus == 5);               // E alone
  CHECK(static_cast<int>(box.particles.size()) == m.particles());
  CHECK(box.region.open == std::array{true, false, false, false, false, true});
  const Wall& pipe = wall(m, "pipe");
  CHECK(pipe.effective_modulus == Approx(6 / (2 * 0.91)).epsilon(1e-15));
  CHECK(pipe.region.center == Vec3(0, 0.5, -0.25));
  CHECK(pipe.region.axis == 0);
  CHECK(pipe.region.axial_lo == -100);
  CHECK(pipe.region.open == std::array{true, false, true, false, false, false});
  CHECK(pipe.curved);
  CHECK(pipe.radius_change == -1);
  const Wall& endless = wall(m, "endless");
  CHECK(std::isinf(endless.region.axial_lo));
  CHECK(std::isinf(endless.region.axial_hi));
  CHECK(endless.region.center == Vec3(1, 0, 3));   // along the axis it says nothing
  CHECK(wall(m, "globe").region.center == Vec3(1, 2, 3));
  CHECK(wall(m, "funnel-wall").region.radius_hi == 1000);
}

TEST_CASE("Groups are chosen by regions of every shape") {
  const Model m =
      model_of(grains("g", "[[0, 0, 0], [1, 0, 0], [2, 0, 0], [2, 2, 0], [2, 2, 2], [0, 0, 5]]") + energy_study + R"(
[[group]]
name = "plane"
inside = {shape = "plane", point = [1, 7, 7], normal = [1e-3, 0, 0]}
[[group]]
name = "block"
inside = {shape = "block", lo = [1, 0, 0], hi = [2, 2, 0]}
[[group]]
name = "endless"
inside = {shape = "cylinder", center = [0, 0], axis = "z", radius = 1}
[[group]]
name = "cylinder"
inside = {shape = "cylinder", center = [0, 0, 9], axis = "z", radius = 2.5, lo = 0, hi = 1}
[[group]]
name = "lying"
inside = {shape = "cylinder", center = [2, 2], axis = "x", radius = 0.5, lo = 1}
[[group]]
name = "sphere"
inside = {shape = "sphere", center = [2, 2, 1], radius = 1}
[[group]]
name = "cone"
inside = {shape = "cone", center = [0, 0], axis = "x", radius_lo = 0, radius_hi = 1, lo = 0, hi = 2}
[[group]]
name = "not-sphere"
outside = {shape = "sphere", center = [2, 2, 1], radius = 1}
)");
  CHECK(size_of(m, "plane") == 4);
  CHECK(size_of(m, "block") == 3);
  CHECK(size_of(m, "endless") == 3);
  CHECK(size_of(m, "cylinder") == 3);
  CHECK(size_of(m, "lying") == 1);
  CHECK(size_of(m, "sphere") == 2);
  CHECK(size_of(m, "cone") == 3);
  CHECK(size_of(m, "not-sphere") == 4);
  CHECK(said_of(grains("g", "[[0, 0, 0], [1, 0, 0]]") + "[[group]]\nname = \"far\"\n"
                "outside = {shape = \"sphere\", center = [0, 0, 0], radius = 9}\n" + energy_study) ==
        "7:11: group.far.outside: holds no particle of \"all\"; a group has at least one");
}

TEST_CASE("What a wall or a contact may hold needs no support") {
  const std::string one = grains("a", "[[0, 0, 1]]", "density = 1\n"),
                    other = grains("b", "[[0, 0, 2]]", "density = 1\n");
  const std::string gravity = "[[gravity]]\nacceleration = [0, 0, -1]\n";
  const std::string floor = "[[wall]]\nname = \"floor\"\nshape = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n"
                            "youngs_modulus = 1\ngroup = ";
  const std::string contact = "[[contact]]\nbetween = [\"a\", \"b\"]\neffective_modulus = ";
  const std::string falls = "which nothing holds; an equilibrium needs a [[support]], a [[wall]] or a [[contact]]";
  CHECK(said_of(one) == "");                       // free, and no force
  CHECK(said_of(one + gravity) == "1:1: grains.a: a force acts on a 1, " + falls);
  CHECK(said_of(one + gravity + energy_study) == "");
  CHECK(said_of(one + gravity + floor + "\"a\"") == "");
  CHECK(said_of(one + other + gravity + floor + "\"a\"") == "6:1: grains.b: a force acts on b 1, " + falls);
  CHECK(said_of(one + other + gravity + floor + "\"a\"\n" + contact + "1") == "");
  CHECK(said_of(one + other + gravity + floor + "\"a\"\n" + contact + "0") ==
        "6:1: grains.b: a force acts on b 1, " + falls);
  CHECK(said_of(one + other + gravity + "[[support]]\ngroup = \"a\"\n" + contact + "1") == "");
  const std::string together =
      "a 1 and all that it may touch are held by no [[support]] and no [[wall]], and the "
      "forces on them do not cancel";
  CHECK(said_of(one + other + gravity + contact + "1") == "1:1: grains.a: " + together + "\n6:1: grains.b: b 1" +
                                                              together.substr(3));
  // Pressed together by opposite forces: the contact holds them.
  const std::string up = "[[load]]\ngroup = \"a\"\nforce = [0, 0, 1]\n",
                    down = "[[load]]\ngroup = \"b\"\nforce = [0, 0, -1]\n";
  CHECK(said_of(one + other + up + down + contact + "1") == "");
  CHECK(said_of(one + other + up + down + "constant = true\n" + contact + "1") != "");
  // A beam that lies on a floor, and one that nothing may hold.
  const std::string beam =
      "[[beam]]\nname = \"beam\"\nparticles = 3\nfrom = [0, 0, 1]\nto = [2, 0, 1]\ndiameter = 1\nyoungs_modulus = 1\n";
  CHECK(said_of(beam) ==
        "1:1: beam.beam: none of its particles is held by a support; an equilibrium needs a [[support]]");
  CHECK(said_of(beam + floor + "\"all\"") == "");
  CHECK(said_of(beam + "[[contact]]\nbetween = [\"beam\", \"beam\"]\neffective_modulus = 1") != "");   // not by itself
}

TEST_CASE("Particles start on the side of the wall where they belong") {
  const std::string one = grains("a", "[[0, 0, 1]]");
  const auto floor = [&](const std::string& more) {
    return one + "[[wall]]\nname = \"w\"\nyoungs_modulus = 1\n" + more;
  };
  const std::string plane = "shape = \"plane\"\npoint = [0, 0, 2]\nnormal = [0, 0, 1]\n";
  const std::string below = "5:1: wall.w.side: a 1 is outside of it, at [0, 0, 1]; it must be inside";
  CHECK(said_of(floor(plane)) == below);
  CHECK(said_of(floor(plane) + energy_study) == "");
  CHECK(said_of(floor(plane + "effective_radius = \"curved\"\nside = \"outside\"\n")) == "");
  CHECK(said_of(floor(plane + "[path]\n")) == below);
  CHECK(said_of(floor(plane + "[modes]\ncount = 3\n")) == below);
  // A wall that moves: a path begins where it is then, an equilibrium has the way from 0 to 1.
  CHECK(said_of(floor(plane + "displacement = [0, 0, -2]\n[path]\nfrom = 1\nto = 2\n")) == "");
  CHECK(said_of(floor(plane + "displacement = [0, 0, -2]\n[path]\nfrom = 0.25\n")) == below);
  CHECK(said_of(floor(plane + "displacement = [0, 0, -2]\n")) == "");
  // What a support moves along is where the support has it.
  CHECK(said_of(floor(plane + "displacement = [0, 0, 10]\n[[support]]\ngroup = \"a\"\ndisplacement = [0, 0, "
                              "12]\n[path]\nfrom = 1\nto = 2\n")) == "");
  const std::string block = "shape = \"block\"\nlo = [1, 1, 1]\nhi = [2, 2, 2]\n";
  CHECK(said_of(floor(block)) != "");
  CHECK(said_of(floor(block + "open = [\"xlo\"]\n")) == "");   // acts on both sides
  const std::string five =
      "[[grains]]\nname = \"a\"\npositions = [[0, 0, 1], [3, 0, 1], [6, 0, 4], [9, 0, 1], [12, 0, 5]]\n"
      "diameter = 1\n[[wall]]\nname = \"w\"\nyoungs_modulus = 1\n";
  CHECK(said_of(five + plane) ==
        "5:1: wall.w.side: a 1 is outside of it, at [0, 0, 1], and 2 more are; it must be inside");
}
