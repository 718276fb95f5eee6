// Loops, sheets, grains and connections, from the file to the model.
#include "catch.hpp"

#include "input/model_of.hpp"

using namespace elamin;

namespace {


}  // namespace

TEST_CASE("Structures follow each other in their order, with their numbers") {
  const Model m = build_model(read_problem(good + "structures.toml"));
  std::vector<std::string> kinds;
  for (const Structure& s : m.structures) kinds.push_back(s.kind);
  CHECK(kinds == std::vector<std::string>{"loop", "loop", "sheet", "sheet", "sheet", "grains", "grains"});
  for (int i = 0; i < m.particles(); ++i) REQUIRE(m.id[i] == i + 1);

  const Structure& ring = structure(m, "ring");
  CHECK(ring.count == 12);
  const BondType bond = m.bond_types[ring.bond_type];
  const AngleType angle = m.angle_types[ring.angle_type];
  const double E = 1e3, t = 0.8, q = 1.25;
  CHECK(bond.rest_length == q);
  CHECK(bond.stiffness == Approx(E * t * t / (2 * q)).epsilon(1e-15));
  CHECK(angle.stiffness == Approx(E * t * t * t * t / (12 * q)).epsilon(1e-15));
  CHECK(angle.rest == Approx(pi * (1 - 2.0 / 12)).epsilon(1e-15));
  const Structure& other = structure(m, "stiff-ring");
  CHECK(m.bond_types[other.bond_type].rest_length == Approx(2 * std::sin(pi / 5)).epsilon(1e-15));
  CHECK(m.bond_types[other.bond_type].stiffness == 12.5);
  CHECK(m.angle_types[other.angle_type].rest == Approx(144.5 / 180 * pi).epsilon(1e-15));

  const Structure& plate = structure(m, "plate");
  CHECK(m.bond_types[plate.bond_type].rest_length == 1.01);
  CHECK(m.bond_types[plate.bond_type].stiffness == Approx(std::sqrt(3.0) / 4 * 2e3 * 0.25).epsilon(1e-15));
  CHECK(m.angle_types[plate.angle_type].stiffness == Approx(2e3 / 64 / (8 * std::sqrt(3.0))).epsilon(1e-15));
  CHECK(m.angle_types[plate.angle_type].rest == pi);
  CHECK(m.diameter[plate.first] == 0.75);
  CHECK(m.density[plate.first] == 3);
  const Structure& disc = structure(m, "disc");
  CHECK(m.bond_types[disc.bond_type].stiffness == 7);
  CHECK(m.bond_types[disc.bond_type].rest_length == 1);
  CHECK(m.diameter[disc.first] == 1);
  CHECK(disc.count == 19);                         // 1 + 6 + 6 at √3 + 6 at 2
  const Structure& tube = structure(m, "tube");
  CHECK(m.angle_types[tube.angle_type].rest < pi);
  for (int i = tube.first; i < tube.first + tube.count; ++i) {
    const Vec3 x = m.start.position.col(i);
    CHECK(std::hypot(x[1], x[2] - 30) == Approx(2.25).epsilon(1e-14));
  }

  const Structure& two = structure(m, "two");
  CHECK(two.count == 2);
  CHECK(m.density[two.first] == 4);
  CHECK(m.start.position.col(two.first + 1) == Vec3(31, 0.5, -0.25));
  CHECK(m.molecule[two.first] + 1 == m.molecule[two.first + 1]);
  const Structure& many = structure(m, "many");
  CHECK(m.diameter[many.first] == 0.5);
  CHECK(m.diameter[many.first + 1] == 0.25);
  CHECK(m.start.position.col(many.first + 1) == Vec3(41, 1, -2));
}

TEST_CASE("Rest angles: a word or degrees, and straight is exactly pi") {
  const auto rest = [](const std::string& value) {
    const std::string beam =
        "[[beam]]\nname = \"b\"\nparticles = 5\nfrom = [0, 0, 0]\nto = [4, 0, 0]\ndiameter = 1\nyoungs_modulus = 1\n";
    return model_of(beam + value + energy_study).angle_types[0].rest;
  };
  CHECK(rest("") == pi);
  CHECK(rest("rest = \"straight\"\n") == pi);
  CHECK(rest("rest = \"as_built\"\n") == pi);
  CHECK(rest("rest = 180\n") == pi);
  CHECK(rest("rest = 90.0\n") == Approx(pi / 2).epsilon(1e-15));
  CHECK(rest("rest = 0\n") == 0);
}

TEST_CASE("A connection glues two structures") {
  const std::string two = grains("a", "[[0, 0, 0], [1, 0, 0]]") + grains("b", "[[0, 1, 0], [1, 1, 0]]") + energy_study +
                          "[[connect]]\nbetween = [\"a\", \"b\"]\nbond_stiffness = 3\n";
  const Model m = model_of(two + "within = 1.1\n");
  REQUIRE(m.bonds.size() == 2);
  CHECK(m.bonds[0].particles == std::array{0, 2});
  CHECK(m.bond_types.at(m.bonds[0].type).stiffness == 3);
  CHECK(m.bond_types[m.bonds[0].type].rest_length == 1);
  CHECK(m.angles.empty());
  CHECK(model_of(two + "within = 1.5\n").bonds.size() == 4);
  CHECK(model_of(two + "within = 1.5\nbonds_per_particle = 1\nrest_length = 0.75\n").bond_types[0].rest_length == 0.75);
  const std::string more =
      "[[connect]]\nbetween = [\"a\", \"a\"]\nwithin = 1.1\nbond_stiffness = 3\nangle_stiffness = 5\nrest = ";
  CHECK(model_of(two + "within = 1.1\n" + more + "\"straight\"\n").angle_types.at(0).rest == pi);
  CHECK(model_of(two + "within = 1.1\n" + more + "\"as_built\"\n").angle_types.at(0).rest ==
        Approx(pi / 2).epsilon(1e-15));
  CHECK(model_of(two + "within = 1.1\n" + more + "60\n").angle_types.at(0).rest == Approx(pi / 3).epsilon(1e-15));
}

TEST_CASE("Grains of a plane stay in it") {
  CHECK(said_of("plane = \"xz\"\n" + grains("a", "[[0, 0, 0], [2, 0, 0]]")) == "");
  CHECK(said_of("plane = \"xz\"\n" + grains("a", "[[0, 0, 0], [2, 1, 0]]")) ==
        "2:1: grains.a: a 2 is not in the plane \"xz\" of a 1: y is 1 instead of 0");
}

namespace {

std::string beam(const std::string& more) {
  return "plane = \"xz\"\n[[beam]]\nname = \"b\"\ndiameter = 1\nyoungs_modulus = 1\n" + more + energy_study;
}

}  // namespace

TEST_CASE("Beams through corners and on arcs, straight at rest or as built") {
  const std::string frame = "through = [[0, 0, 0], [0, 0, 12], [12, 0, 12]]\nparticles = 9\n";
  const Model straight = model_of(beam(frame)), built = model_of(beam(frame + "rest = \"as_built\"\n"));
  CHECK(straight.start.position.col(4) == Vec3(0, 0, 12));
  CHECK(straight.bond_types[0].rest_length == 3);
  REQUIRE(straight.angle_types.size() == 1);
  CHECK(straight.angle_types[0].rest == pi);
  REQUIRE(built.angle_types.size() == 2);
  for (std::size_t a = 0; a < built.angles.size(); ++a)
    CHECK(built.angle_types[built.angles[a].type].rest == (a == 3 ? Approx(pi / 2).epsilon(1e-15) : Approx(pi).epsilon(0).margin(0)));
  CHECK(built.angle_types[0].stiffness == built.angle_types[1].stiffness);

  // In the plane "xz" an arch from left to right rises along z; a negative rise hangs.
  const std::string ends = "from = [-1, 0, 0]\nto = [1, 0, 0]\nparticles = 9\n";
  CHECK(model_of(beam(ends + "rise = 0.25\n")).start.position.col(4).isApprox(Vec3(0, 0, 0.25), 1e-15));
  CHECK(model_of(beam(ends + "rise = -0.25\n")).start.position.col(4).isApprox(Vec3(0, 0, -0.25), 1e-15));
  CHECK(model_of(beam(ends + "rise = 0.25\nprofile = \"sine\"\n")).start.position.col(4).isApprox(Vec3(0, 0, 0.25), 1e-15));
  CHECK(model_of(beam(ends + "angle = 180\n")).start.position.col(4).isApprox(Vec3(0, 0, 1), 1e-15));
  CHECK(model_of(beam(ends + "angle = 180\ntoward = [5, 0, -1]\n")).start.position.col(4).isApprox(Vec3(0, 0, -1), 1e-15));
  const Model ring = model_of(beam(ends + "angle = 180\nrest = \"as_built\"\n"));
  REQUIRE(ring.angle_types.size() == 1);
  CHECK(ring.angle_types[0].rest == Approx(pi * (1 - 1.0 / 8)).epsilon(1e-15));
  const double q = ring.bond_types[0].rest_length;
  CHECK(q == Approx(2 * std::sin(pi / 16)).epsilon(1e-15));
  CHECK(ring.bond_types[0].stiffness == Approx(pi / (8 * q)).epsilon(1e-15));

  // A clamped end is where it is said, one particle stands beyond, and the joint on it has half a bond to bend.
  const Model rod = model_of("[[beam]]\nname = \"b\"\ndiameter = 1\naxial_stiffness = 30\nbending_stiffness = 6\n"
                             "from = [0, 0, 0]\nto = [6, 0, 0]\nparticles = 5\nclamped = \"from\"\n" + energy_study);
  CHECK(rod.start.position.col(0) == Vec3(-2, 0, 0));
  CHECK(rod.start.position.col(1).isZero(0));
  CHECK(rod.bond_types[0].rest_length == 2);
  CHECK(rod.bond_types[0].stiffness == 7.5);
  CHECK(rod.angle_types[rod.angles[0].type].stiffness == 6);
  for (const int a : {1, 2}) CHECK(rod.angle_types[rod.angles[a].type].stiffness == 3);
  const Model loop = model_of("[[loop]]\nname = \"l\"\ndiameter = 1\naxial_stiffness = 30\nbending_stiffness = 6\n"
                              "radius = 5\nparticles = 5\nrest_length = 2\n" + energy_study);
  CHECK(loop.bond_types[0].stiffness == 7.5);
  CHECK(loop.angle_types[0].stiffness == 3);
}

TEST_CASE("Beams that cannot be where they should") {
  const std::string frame = "through = [[0, 0, 0], [0, 0, 12], [8, 0, 12]]\n";
  CHECK(said_of(beam(frame + "particles = 10\n")) ==
        "7:13: beam.b.particles: 10 evenly along through put none on a corner; the nearest that do: 6 and 11");
  CHECK(said_of(beam("through = [[0, 0, 0], [0, 0, 1.1], [1, 0, 1.7320508]]\nparticles = 4\n")) ==
        "7:13: beam.b.particles: 4 evenly along through put none on a corner; no number near it does: the lengths between "
        "corners must have a common measure; they are 1.1, 1.183, while 1.1, 1.1 would do; or give every piece a [[beam]] of "
        "its own and join them with [[connect]]");
  CHECK(said_of(beam("from = [0, 0, 0]\nto = [0, 1, 0]\nrise = 1\nparticles = 4\n")) ==
        "7:6: beam.b.to: is no place to which an arch leads from here; from and to must lie apart in the plane");
  CHECK(said_of(beam("from = [0, 0, 0]\nto = [1, 0, 0]\nrise = 100\nprofile = \"sine\"\nparticles = 4\n")) ==
        "8:8: beam.b.rise: is too high for so few particles on a sine; take more of them, or a circle");
}
