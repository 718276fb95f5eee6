#include "catch.hpp"

#include "input/model_of.hpp"

#include <numeric>

using namespace elamin;

namespace {


std::string column(int particles) {
  return "[[beam]]\nname = \"column\"\nparticles = " + std::to_string(particles) + "\nfrom = [0, 0, 0]\nto = [0, 0, " +
         std::to_string(particles - 1) +
         "]\ndiameter = 1\nyoungs_modulus = 3\ndensity = 7\n"
         "[[support]]\ngroup = \"column\"\n";
}

/// Ids of the particles of a group, from 1.
std::vector<int> group(const Model& m, const std::string& name) {
  std::vector<int> ids;
  for (const Group& g : m.groups)
    if (g.name == name)
      for (const int i : g.particles) ids.push_back(m.id[i]);
  return ids;
}

std::vector<int> ids_of(int first, int last) {
  std::vector<int> ids(last - first + 1);
  std::iota(ids.begin(), ids.end(), first);
  return ids;
}

using Ids = std::vector<int>;

}  // namespace

TEST_CASE("A beam's stiffnesses follow from its section") {
  const Model m = build_model(read_problem(good + "everything.toml"));
  REQUIRE(m.bond_types.size() == 3);
  const double t = 0.9e-3, E = 0.96e6, q = 0.07;   // square, with a rest length of its own
  CHECK(m.bond_types[0].rest_length == q);
  CHECK(m.bond_types[0].stiffness == Approx(E * t * t / (2 * q)).epsilon(1e-15));
  CHECK(m.angle_types[0].stiffness == Approx(E * t * t * t * t / (12 * q)).epsilon(1e-15));
  CHECK(m.bond_types[1].stiffness == 123.456);
  CHECK(m.angle_types[1].stiffness == 7.89e-4);
  CHECK(m.bond_types[1].rest_length == Approx(0.011).epsilon(1e-15));
  const double d = 0.01;                           // cylinder: thickness and spacing are the diameter
  CHECK(m.bond_types[2].rest_length == Approx(d).epsilon(1e-15));
  CHECK(m.bond_types[2].stiffness == Approx(pi * d / 8).epsilon(1e-15));
  CHECK(m.angle_types[2].stiffness == Approx(pi * d * d * d / 64).epsilon(1e-15));
  CHECK(m.structures[1].youngs_modulus == 0);
  CHECK(m.type == Ids{1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3});
  CHECK(m.mass(11) == Approx(3 * pi / 6 * 1e-6).epsilon(1e-15));
  CHECK(m.plane_normal == 1);
  CHECK(m.start.load_factor == -0.1);
}

TEST_CASE("The state to start from stands beside the reference") {
  const Model m = build_model(read_problem(good + "everything.toml"));
  REQUIRE(m.restart);
  CHECK(m.restart->load_factor == 0.05);
  CHECK(m.restart->position.col(10).z() == Approx(0.2).epsilon(1e-15));
  CHECK(m.start.position.col(10).z() == 0.1);
  CHECK_FALSE(model_of(column(3)).restart);

  const ScratchDirectory scratch;
  const std::string atoms =
      "A state\n\n2 atoms\n1 atom types\n\n-1 1 xlo xhi\n-1 1 ylo yhi\n-1 1 zlo zhi\n\nAtoms # sphere\n\n1 1 1 1 0 0 "
      "0\n2 1 1 1 0 0 0.5\n";
  scratch.file("s.data", atoms);
  const std::string file = scratch.file("p.toml", column(3) + "[path]\nstart = \"s.data\"");
  CHECK_THROWS_WITH(build_model(read_problem(file)),
                    file + ":12:9: path.start: holds 2 particles, the problem 3; it must be a state of this problem");
  const std::string plane = scratch.file("q.toml", "plane = \"xz\"\n" + column(2) + "[path]\nstart = \"s.data\"");
  CHECK(build_model(read_problem(plane)).restart->position(2, 1) == 0.5);
  scratch.file("s.data",
               "A state\n\n2 atoms\n1 atom types\n\n-1 1 xlo xhi\n-1 1 ylo yhi\n-1 1 zlo zhi\n\nAtoms # sphere\n\n1 1 "
               "1 1 0 0 0\n2 1 1 1 0 0.25 1\n");
  CHECK_THROWS_WITH(build_model(read_problem(plane)),
                    plane + ":12:1: path: column 2 is not in the plane \"xz\" of column 1: y is 0.25 instead of 0");
}

TEST_CASE("Groups select by end, middle, id and place") {
  const Model m = model_of(column(10) + R"(
[[group]]
name = "everything"
[[group]]
name = "first"
first = 3
[[group]]
name = "last"
of = "column"
last = 2
[[group]]
name = "all_of_it"
last = 10
[[group]]
name = "inner"
ids = [9, 2, 5, 4]
[[group]]
name = "inner_last"
of = "inner"
last = 2
[[group]]
name = "one_id"
of = "inner"
ids = [4]
[[group]]
name = "block"
inside = {shape = "block", lo = [0, 0, 2], hi = [0, 0, 4]}
[[group]]
name = "block_of"
of = "first"
inside = {shape = "block", lo = [-1, -1, 1], hi = [1, 1, 1e9]}
)");
  CHECK(m.groups[0].name == "all");
  CHECK(m.groups[1].name == "column");
  CHECK(m.groups[2].name == "everything");
  CHECK(m.groups.size() == 11);
  CHECK(group(m, "all") == ids_of(1, 10));
  CHECK(group(m, "everything") == ids_of(1, 10));
  CHECK(group(m, "first") == Ids{1, 2, 3});
  CHECK(group(m, "last") == Ids{9, 10});
  CHECK(group(m, "all_of_it") == ids_of(1, 10));
  CHECK(group(m, "inner") == Ids{2, 4, 5, 9});
  CHECK(group(m, "inner_last") == Ids{5, 9});
  CHECK(group(m, "one_id") == Ids{4});
  CHECK(group(m, "block") == Ids{3, 4, 5});   // its faces belong to it
  CHECK(group(m, "block_of") == Ids{2, 3});
}

TEST_CASE("Groups are what is in any of some and in none of others") {
  const Model m = model_of(column(10) + R"(
[[group]]
name = "first"
first = 3
[[group]]
name = "last"
last = 2
[[group]]
name = "ends"
of = ["last", "first"]
[[group]]
name = "inside"
except = "ends"
[[group]]
name = "one"
ids = [8]
[[group]]
name = "but_one"
of = ["first", "inside", "first"]
except = ["last", "one"]
last = 3
[[group]]
name = "without"
of = "inside"
except = ["one", "first"]
)");
  CHECK(group(m, "ends") == Ids{1, 2, 3, 9, 10});
  CHECK(group(m, "inside") == ids_of(4, 8));
  CHECK(group(m, "but_one") == ids_of(5, 7));
  CHECK(group(m, "without") == ids_of(4, 7));
}

TEST_CASE("The middle of a chain") {
  const auto middle = [](int particles, int n) {
    return group(model_of(column(particles) + "[[group]]\nname = \"m\"\nmiddle = " + std::to_string(n)), "m");
  };
  CHECK(middle(5, 1) == Ids{3});
  CHECK(middle(5, 3) == Ids{2, 3, 4});
  CHECK(middle(6, 2) == Ids{3, 4});
  CHECK(middle(6, 1) == Ids{3});
  CHECK(middle(5, 2) == Ids{2, 3});
  CHECK(middle(5, 5) == ids_of(1, 5));
}

TEST_CASE("Supports, loads, weight and drag") {
  const Model m = build_model(read_problem(good + "everything.toml"));
  REQUIRE(m.supports.size() == 3);
  CHECK(m.supports[0].group == "feet");
  CHECK(m.supports[0].particles == Ids{0, 1});
  CHECK(m.supports[0].held == std::array{true, false, true});
  CHECK(m.supports[0].displacement == Vec3(0.1, 0, -1e-4));
  CHECK(m.supports[0].scaling == Scaling::constant());
  CHECK(m.supports[1].held == std::array{true, true, true});
  CHECK(m.supports[2].held == std::array{true, false, true});
  CHECK(m.supports[2].particles == ids_of(15, 18));
  REQUIRE(m.loads.size() == 2);
  CHECK(m.loads[0].force == Vec3(1e-9, 0, 3));
  CHECK(m.loads[0].scaling == Scaling::constant());
  CHECK(m.loads[1].particles == Ids{4, 5, 6});
  CHECK(m.loads[1].force == Vec3(0, 0, 1));           // 3 in all, shared by three
  REQUIRE(m.gravity.size() == 1);
  CHECK(m.gravity[0].acceleration == Vec3(0.3, 0, -9.81));
  CHECK(m.gravity[0].scaling == Scaling());
  CHECK(m.gravity[0].particles == ids_of(0, 10));
  REQUIRE(m.viscosity.size() == 1);
  CHECK(m.viscosity[0].coefficient == 0.1);
}

TEST_CASE("Supports that agree may overlap, and an energy needs none") {
  CHECK(model_of(column(4) +
                 "displacement = [0, 0, 1]\n[[group]]\nname = \"end\"\nlast = 1\n[[support]]\ngroup = \"end\"\n"
                 "displacement = [0, 0, 1]")
            .supports.size() == 2);
  CHECK(model_of(column(4) + "[[support]]\ngroup = \"all\"\nconstant = true").supports.size() == 2);
  std::string bare = column(4);
  bare.resize(bare.find("[[support]]"));
  CHECK(model_of(bare + "[study]\ntype = \"energy\"").supports.empty());
  CHECK_THROWS(model_of(bare));
}

TEST_CASE("Beams joined by nothing need a support each") {
  std::string two =
      column(4) +
      "[[beam]]\nname = \"other\"\nparticles = 3\nfrom = [5, 0, 0]\nto = [5, 0, 3]\ndiameter = 1\nyoungs_modulus = 3\n";
  CHECK_THROWS_WITH(model_of(two), Catch::Contains("beam.other: none of its particles is held"));
  CHECK(model_of(two +
                 "[[group]]\nname = \"o\"\nof = \"other\"\nlast = 2\n[[support]]\ngroup = \"o\"")
            .supports.size() == 2);
}

TEST_CASE("A LAMMPS data file keeps its ids and types, and beams count on") {
  const ScratchDirectory scratch;
  const std::string head =
      "A case\n\n3 atoms\n4 atom types\n1 bonds\n1 bond types\n\n-1 1 xlo xhi\n-1 1 ylo yhi\n-1 1 zlo zhi\n\nBond "
      "Coeffs # harmonic\n\n1 5 1\n\n";
  const std::string tail = "\nBonds\n\n1 1 10 20\n";
  scratch.file("c.data",
               head + "Atoms # hybrid sphere bond\n\n20 4 0 0 1 1 2 1\n10 2 0 0 0 1 2 1\n30 4 0 3 0 1 2 1\n" + tail);
  const std::string beam =
      "[[beam]]\nname = \"b\"\nparticles = 2\nfrom = [9, 0, 0]\nto = [9, 0, 1]\ndiameter = 1\nyoungs_modulus = 3\n";
  const auto model = [&](const std::string& rest) {
    return build_model(read_problem(scratch.file("p.toml", "[lammps]\ndata = \"c.data\"\n" + rest)));
  };
  const Model m = model(beam + "[[group]]\nname = \"g\"\nof = \"type4\"\nids = [30]\n[[support]]\ngroup = \"all\"");
  CHECK(m.id == Ids{10, 20, 30, 31, 32});
  CHECK(m.type == Ids{2, 4, 4, 5, 5});
  CHECK(m.bonds.size() == 2);
  CHECK(m.bond_types[0].stiffness == 5);
  CHECK(m.bonds[0].particles == std::array{0, 1});
  CHECK(group(m, "lammps") == Ids{10, 20, 30});
  CHECK(group(m, "type2") == Ids{10});
  CHECK(group(m, "type4") == Ids{20, 30});
  CHECK(group(m, "type5").empty());
  CHECK(group(m, "g") == Ids{30});

  const std::string file = scratch / "p.toml";
  CHECK_THROWS_WITH(
      model("[[support]]\ngroup = \"type3\""),
      file +
          ":4:9: support.1.group: \"type3\" names no group; the data file has: type2, type4; did you mean \"type2\"?");
  CHECK_THROWS_WITH(model("[[support]]\ngroup = \"type2\"\n[[load]]\ngroup = \"all\"\nforce = [0, 0, 1]"),
                    file +
                        ":1:1: lammps: a force acts on particle 30, which nothing holds; an equilibrium needs a "
                        "[[support]], a [[wall]] or a [[contact]]");
  CHECK(model("[[support]]\ngroup = \"type2\"").supports.size() == 1);   // particle 30 is free, and nothing drives it
  CHECK_THROWS_WITH(model(beam + "[[support]]\ngroup = \"b\""),
                    file + ":1:1: lammps: particle 10 is connected to no particle that a support holds; an equilibrium "
                           "needs a [[support]]");
  CHECK_THROWS_WITH(model("[[support]]\ngroup = \"all\"\n[[group]]\nname = \"g\"\nids = [11]"),
                    file + ":7:7: group.g.ids: 11 is not in \"all\", whose ids lie from 10 to 30");

  scratch.file("c.data", head + "Atoms # hybrid sphere bond\n\n20 4 0 0 1 1 2 1\n10 2 0 0 0 1 2 1\n2147483640 4 0 3 0 1 2 "
                                "2147483647\n" + tail);
  CHECK_THROWS_WITH(model(beam + "[[support]]\ngroup = \"all\""),
                    file + ":2:8: lammps.data: its numbers of particles, types or molecules reach 2147483647; there is no "
                           "room above for those of the other structures");
  CHECK(model("[[support]]\ngroup = \"all\"").id.back() == 2147483640);
  scratch.file("c.data",
               head + "Atoms # hybrid sphere bond\n\n20 4 0 0 0 1 2 1\n10 2 0 0 0 1 2 1\n30 4 0 3 0 1 2 1\n" + tail);
  CHECK_THROWS_WITH(model("[[support]]\ngroup = \"all\""),
                    file +
                        ":1:1: lammps: particle 20 is in the same place as particle 10, [0, 0, 0]; "
                        "particles must lie apart");
  CHECK(model("[study]\ntype = \"energy\"").particles() == 3);
  scratch.file("c.data", head + "Atoms # hybrid sphere bond\n\n20 4 0 0 x 1 2 1\n");
  CHECK_THROWS_WITH(model("[[support]]\ngroup = \"type2\""), Catch::Contains("c.data:"));
}
