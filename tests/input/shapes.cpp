// Curves, chains, values from tables, single bonds and angles, from the file to the model.
#include "catch.hpp"

#include "input/model_of.hpp"

using namespace elamin;

TEST_CASE("Shapes of all kinds become what they say") {
  const Model m = build_model(read_problem(good + "shapes.toml"));
  const Structure& bent = structure(m, "bent");
  CHECK(bent.count == 9);
  const auto bond_of = [&](int i, int j) -> const BondType* {
    for (const Bond& b : m.bonds)
      if (std::minmax(b.particles[0], b.particles[1]) == std::minmax(i, j)) return &m.bond_types[b.type];
    return nullptr;
  };
  const auto angle_over = [&](int j) -> const AngleType* {
    for (const Angle& a : m.angles)
      if (a.particles[1] == j) return &m.angle_types[a.type];
    return nullptr;
  };
  // The curve is 2 + √1.25 long; the first particle stands one place before its beginning.
  const double spacing = (2 + std::sqrt(1.25)) / 7;
  CHECK((m.start.position.col(0) - Vec3(-spacing, 0, 0)).norm() < 1e-15);
  CHECK((m.start.position.col(1)).norm() == 0);
  CHECK(m.start.position.col(8) == Vec3(2, 1, 0.5));
  CHECK(m.diameter[0] == 0.2);
  CHECK(m.diameter[1] == 0.1);
  CHECK(m.density[0] == 800);
  CHECK(bond_of(0, 1)->stiffness == 3);                                        // values.csv
  CHECK(bond_of(1, 2)->rest_length == 0.75);
  CHECK(bond_of(5, 6)->stiffness == Approx(7 / (2 * bond_of(5, 6)->rest_length)).epsilon(1e-15));   // EA of each as long as it is
  CHECK(bond_of(3, 4)->rest_length < 0.99 * spacing);                           // over a corner
  CHECK(bond_of(7, 8)->rest_length == Approx(spacing).epsilon(1e-15));
  CHECK(angle_over(1)->stiffness == 1.5);
  CHECK(angle_over(7)->stiffness == 2);
  CHECK(angle_over(2)->stiffness == Approx(2 / spacing).epsilon(1e-15));
  // Chains have no angles of their own.
  CHECK(structure(m, "chain").angle_type == -1);
  CHECK(structure(m, "ring").angle_type == -1);
  const int ring = structure(m, "ring").first;
  CHECK(angle_over(ring) == nullptr);
  CHECK(bond_of(ring + 3, ring)->stiffness == 4);
  CHECK(m.diameter[ring + 1] == 0.2);
  CHECK(m.density[structure(m, "plate").first + 6] == 7);
  // Bonds one by one.
  const auto index = [&](int id) { return static_cast<int>(std::find(m.id.begin(), m.id.end(), id) - m.id.begin()); };
  CHECK(bond_of(index(20), index(1))->rest_length == 0.5);
  const int cloud = structure(m, "cloud").first;
  CHECK(bond_of(cloud, cloud + 1)->stiffness == Approx(3 / (2 * 0.5)));
  CHECK(m.diameter[cloud] == 0.1);
  CHECK(m.diameter[cloud + 2] == 0.125);
  CHECK(m.density[cloud + 2] == 5);
  CHECK(bond_of(index(29), index(30))->stiffness == 3);
  CHECK(bond_of(index(30), index(31))->stiffness == 2.5);
  CHECK(bond_of(cloud, cloud + 2) == nullptr);                                   // comes with the second stage
  int between = 0;
  for (const Bond& b : m.bonds) {
    const auto [i, j] = std::minmax(b.particles[0], b.particles[1]);
    between += i >= ring && i < ring + 4 && j >= structure(m, "plate").first && j < structure(m, "plate").first + 7;
  }
  CHECK(between == 8);
  // Angles.
  CHECK(angle_over(index(28))->rest == Approx(150 * pi / 180));
  CHECK(angle_over(index(29))->rest == Approx(170 * pi / 180));
  CHECK(angle_over(index(30))->stiffness == 0.25);
  CHECK(m.pressures.at(0).triangles.size() == 6);
}

TEST_CASE("A chain of angle stiffness zero, however it is said, has no angles") {
  const std::string chain = "[[beam]]\nname = \"c\"\nparticles = 5\nfrom = [0, 0, 0]\nto = [4, 0, 0]\ndiameter = 1\naxial_stiffness = 1\nbending_stiffness = 0\n"
                            "clamped = \"both\"\n[[support]]\ngroup = \"c\"\n" + energy_study;
  CHECK(model_of(chain).angles.empty());
  CHECK(model_of("[[sheet]]\nname = \"s\"\nsize = [3, 3]\nspacing = 1\nbond_stiffness = 1\nangle_stiffness = 0\n[[support]]\ngroup = \"s\"\n" + energy_study).angles.empty());
}

TEST_CASE("A lattice may be turned by any number of degrees") {
  const Model m = model_of("[[sheet]]\nname = \"s\"\nshape = \"circle\"\nradius = 1\nspacing = 1\nbond_stiffness = 1\nangle_stiffness = 0\n"
                           "lattice_angle = 1e308\n[[support]]\ngroup = \"s\"\n" + energy_study);
  CHECK(m.particles() == 7);
  CHECK(m.start.position.allFinite());
}

TEST_CASE("Tables of commas that are wrong are told with their lines") {
  const ScratchDirectory scratch;
  const auto said = [&](const std::string& csv, const std::string& table) {
    scratch.file("t.csv", csv);
    return sentences_of([&] { build_model(read_problem(scratch.file("p.toml", table + "[[support]]\ngroup = \"all\"\n" + energy_study))); });
  };
  const std::string row = "[[beam]]\nname = \"b\"\nparticles = 3\ndiameter = 0.1\nyoungs_modulus = 1\n", curve = row + "file = \"t.csv\"\n";
  CHECK(said("0,0,0\n1,0,0\n", curve) == "");
  CHECK(said("z,x,y\n0,0,0\n0,1,0 # the second\n\n", curve) == "");
  CHECK(said("x,y,w\n0,0,0\n", curve) == "1:5: \"w\" is no column of this table; there are: x, y, z");
  CHECK(said("x,y\n0,0\n", curve) == "1:1: the column \"z\" is missing");
  CHECK(said("0,0,0\n1,0\n1,a,0\n", curve) == "2:1: 2 columns, expected 3: x,y,z\n3:3: y: \"a\" is not a number");
  CHECK(said("0,0,0\n1,0,0\n1,0,0\n", curve) == "3:1: is the same point as the one before");
  CHECK(said("\n0,0,0\n", curve) == "2:1: is one point alone; a curve has two at least");
  CHECK(said("# nothing\n", curve) == "1:1: holds no row of numbers; the columns are x, y, z");

  const std::string values = row + "from = [0, 0, 0]\nto = [2, 0, 0]\nvalues = \"t.csv\"\n";
  CHECK(said("diameter\n1\n2\n3\n", values) == "");
  CHECK(said("diameter\n1\n2\n", values) == "8:10: beam.b.values: has 2 rows, and \"b\" has 3 particles; give a row for each");
  CHECK(said("1\n2\n3\n", values).find("1:1: \"1\" is no column of this table; there are: diameter, density") == 0);
  CHECK(said("diameter,bond_stiffness,angle_stiffness\n-1,1,1\n1,0,1\n1,1,\n", values) ==
        "2:1: diameter: must be a positive number, is -1\n"
        "2:1: angle_stiffness: particle 1 of \"b\" has no angle over it; leave the cell empty\n"
        "3:1: bond_stiffness: must be a positive number, is 0\n"
        "4:1: bond_stiffness: particle 3 of \"b\" has no bond behind it; leave the cell empty");

  const std::string cloud = grains("g", "[[0, 0, 0], [2, 0, 0], [4, 0, 0]]"), bonds = cloud + "[[bonds]]\nfile = \"t.csv\"\n";
  CHECK(said("1,2\n", bonds + "bond_stiffness = 1\n") == "");
  CHECK(said("diameter,density\n1,2\n,\n0.5,\n", cloud + "values = \"t.csv\"\n") == "");
  CHECK(said("diameter\n1\n", cloud + "values = \"t.csv\"\n").find("grains.g.values: has 1 rows, and \"g\" has 3 particles") != std::string::npos);
  CHECK(said("1,2\n1.5,3\n", bonds) ==
        "1:1: its stiffness is missing or not positive; give bond_stiffness, here or in the table\n2:1: 1.5 is no id of a particle; there are 1 to 3");
  CHECK(said("i,j,rest_length\n1,2,-1\n", bonds + "bond_stiffness = 1\n") == "2:1: rest_length must be a positive number, is -1");
  CHECK(said("i,j,k,rest\n1,2,3,200\n", cloud + "[[angles]]\nfile = \"t.csv\"\nangle_stiffness = 1\n") ==
        "2:1: rest must be an angle of 0 to 180 degrees, is 200");
}
