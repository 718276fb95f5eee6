// Correct LAMMPS data files: every atom style, every section, the reference files.
#include "catch.hpp"
#include "core/error.hpp"
#include "laws/section.hpp"
#include "lammps/data.hpp"
#include "scratch_directory.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>

using namespace elamin;

namespace {

const std::string reference_files = std::string(ELAMIN_ROOT) + "/data/lammps/";

/// Every case that is there.
std::vector<std::string> cases() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(reference_files))
    if (std::filesystem::exists(entry.path() / "case.data")) names.push_back(entry.path().filename().string());
  return names;
}

const std::string box = "0 10 xlo xhi\n0 20 ylo yhi\n0 40 zlo zhi\n\n";

std::string two_atoms(const std::string& style, const std::string& first, const std::string& second) {
  return "title\n\n2 atoms\n2 atom types\n" + box + "Atoms" + style + "\n\n" + first + "\n" + second + "\n";
}

}  // namespace

TEST_CASE("the reference files are read as their parameters say", "[lammps_data]") {
  const std::vector<std::string> all = cases();
  CHECK(all.size() >= 11);
  for (const std::string& name : all) {
    INFO(name);
    const LammpsData data = read_lammps_data(reference_files + name + "/case.data");
    const auto parameters = nlohmann::json::parse(text_of(reference_files + name + "/case.json"));
    REQUIRE(data.id.size() == parameters["natoms"].get<std::size_t>());
    for (std::size_t i = 0; i < data.id.size(); ++i) REQUIRE(data.id[i] == static_cast<int>(i) + 1);
    const std::size_t bond_types = parameters.contains("bond") ? parameters["bond"]["types"].size() : 0;
    REQUIRE(data.bond_types.size() == bond_types);
    for (std::size_t k = 0; k < bond_types; ++k) {
      CHECK(data.bond_types[k].stiffness == parameters["bond"]["types"][k]["K"].get<double>());
      CHECK(data.bond_types[k].rest_length == parameters["bond"]["types"][k]["r0"].get<double>());
    }
    const std::size_t angle_types = parameters.contains("angle") ? parameters["angle"]["types"].size() : 0;
    REQUIRE(data.angle_types.size() == angle_types);
    for (std::size_t k = 0; k < angle_types; ++k)
      CHECK(data.angle_types[k].stiffness == parameters["angle"]["types"][k]["K"].get<double>());
    CHECK((data.bonds.empty() && data.angles.empty()) == (bond_types + angle_types == 0));
  }
}

TEST_CASE("bonds and angles of the reference files give their energies", "[lammps_data]") {
  for (const std::string& name : cases()) {
    const auto expected = nlohmann::json::parse(text_of(reference_files + name + "/expected.json"));
    if (!expected.contains("energy_lammps")) continue;      // equilibria are of another state
    INFO(name);
    const LammpsData data = read_lammps_data(reference_files + name + "/case.data");
    double bond = 0, angle = 0;
    for (const Bond& b : data.bonds) {
      const BondType t = data.bond_types[b.type];
      const double r = (data.position.col(b.particles[1]) - data.position.col(b.particles[0])).norm();
      bond += t.stiffness * (r - t.rest_length) * (r - t.rest_length);
    }
    for (const Angle& a : data.angles) {
      const Vec3 u = data.position.col(a.particles[0]) - data.position.col(a.particles[1]);
      const Vec3 v = data.position.col(a.particles[2]) - data.position.col(a.particles[1]);
      angle += data.angle_types[a.type].stiffness * (1 + u.dot(v) / (u.norm() * v.norm()));
    }
    // Sums of at most 400 terms, each with an error of some ε of its larger parts.
    if (!data.bonds.empty()) CHECK(bond == Approx(expected["energy_lammps"]["bond"].get<double>()).epsilon(1e-12));
    if (!data.angles.empty()) CHECK(angle == Approx(expected["energy_lammps"]["angle"].get<double>()).epsilon(1e-12));
  }
}

TEST_CASE("columns of every atom style", "[lammps_data]") {
  ScratchDirectory scratch;
  struct Style { const char *name, *row; double diameter, density; int molecule; };
  const Style style = GENERATE(Style{"atomic", "7 2 1 2 3", 0, 0, 0}, Style{"sphere", "7 2 0.5 800 1 2 3", 0.5, 800, 0},
                               Style{"bond", "7 9 2 1 2 3", 0, 0, 9}, Style{"angle", "7 9 2 1 2 3", 0, 0, 9},
                               Style{"molecular", "7 9 2 1 2 3", 0, 0, 9}, Style{"full", "7 9 2 -0.3 1 2 3", 0, 0, 9},
                               Style{"hybrid sphere angle", "7 2 1 2 3 0.5 800 9", 0.5, 800, 9},
                               Style{"hybrid angle sphere", "7 2 1 2 3 9 0.5 800", 0.5, 800, 9},
                               Style{"hybrid sphere bond", "7 2 1 2 3 0.5 800 9", 0.5, 800, 9},
                               Style{"hybrid molecular sphere", "7 2 1 2 3 9 0.5 800", 0.5, 800, 9},
                               Style{"hybrid sphere", "7 2 1 2 3 0.5 800", 0.5, 800, 0});
  INFO(style.name);
  const std::string row = style.row, other = "3" + row.substr(1);
  const auto check = [&](const LammpsData& data) {
    CHECK(data.id == std::vector<int>{3, 7});
    CHECK(data.type[1] == 2);
    CHECK(data.molecule[1] == style.molecule);
    CHECK(data.diameter[1] == style.diameter);
    CHECK(data.density[1] == style.density);
    CHECK(data.position.col(1) == Vec3(1, 2, 3));
    CHECK(data.velocity.cols() == 0);
  };
  check(read_lammps_data(scratch.file("a", two_atoms(" # " + std::string(style.name), row, other))));
  check(read_lammps_data(scratch.file("b", two_atoms("", other, row)), style.name));
  check(read_lammps_data(scratch.file("c", two_atoms(" # dipole", other, row)), style.name));   // the argument wins
  const LammpsData images =
      read_lammps_data(scratch.file("d", two_atoms("", other + " 0 0 0", row + " -1 2 3")), style.name);
  CHECK(images.position.col(0) == Vec3(1, 2, 3));
  CHECK(images.position.col(1) == Vec3(1 - 10, 2 + 2 * 20, 3 + 3 * 40));
}

TEST_CASE("hybrid without sub-styles is hybrid sphere angle if it has its columns", "[lammps_data]") {
  ScratchDirectory scratch;
  const LammpsData data =
      read_lammps_data(scratch.file("a", two_atoms(" # hybrid", "1 1 1 2 3 0.5 800 9", "2 1 1 2 4 0.5 800 9")));
  CHECK(data.diameter == std::vector<double>{0.5, 0.5});
  CHECK(data.molecule == std::vector<int>{9, 9});
  CHECK_THROWS_AS(read_lammps_data(scratch.file("b", two_atoms(" # hybrid", "1 1 1 2 3 0.5 800", "2 1 1 2 4 0.5 800"))),
                  InputError);
}

TEST_CASE("sections in any order, comments, blank lines, CRLF, tabs, hybrid coefficient lines", "[lammps_data]") {
  ScratchDirectory scratch;
  std::string text =
      "title\n3 atoms # three\n\t2 bonds\n 1 angles\n1 atom types\n2 bond types\n1 angle types\n0 dihedrals\n3 extra "
      "bond per atom\n"
      "0 1 xlo xhi\n\n0 1 ylo yhi\n0 1 zlo zhi\n0 0 0 xy xz yz\n"
      "Angles\n\n1 1 10 30 20\n\nVelocities\n\n30 1 2 3\n10 4 5 6\n20 7 8 9\n\nBond Coeffs # hybrid\n\n2 harmonic +5 "
      "0.25\n1 harmonic 1e3 1 # stiff\n"
      "Masses\n\n1 2.5\n\nBonds # two\n\n\n1 1 10 30\n# nothing\n2 2 30 20\n\nAtoms  #  bond \n\n30 1 1 0 0 1\n10 1 1 "
      "0 0 0\n20 1 1 0 0 2\n\n"
      "Angle   Coeffs # cosine\n\n1 7";
  for (const bool crlf : {false, true}) {
    if (crlf)
      for (std::size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n', i + 2))
        text.replace(i, 1, "\r\n");
    const LammpsData data = read_lammps_data(scratch.file("a", text));
    CHECK(data.id == std::vector<int>{10, 20, 30});
    CHECK(data.position.row(2) == Eigen::RowVector3d(0, 2, 1));
    CHECK(data.velocity.col(2) == Vec3(1, 2, 3));
    CHECK(data.velocity.col(0) == Vec3(4, 5, 6));
    REQUIRE(data.bonds.size() == 2);
    CHECK(data.bonds[0].particles == std::array<int, 2>{0, 2});
    CHECK(data.bonds[1].particles == std::array<int, 2>{2, 1});
    CHECK(data.bonds[1].type == 1);
    CHECK(data.bond_types[0].stiffness == 1e3);
    CHECK(data.bond_types[1].rest_length == 0.25);
    REQUIRE(data.angles.size() == 1);
    CHECK(data.angles[0].particles == std::array<int, 3>{0, 2, 1});
    CHECK(data.angle_types[0].stiffness == 7);
    CHECK(data.mass == std::vector<double>{2.5, 2.5, 2.5});
    CHECK(data.density == std::vector<double>{0, 0, 0});
  }
}

TEST_CASE("positions are read to the last bit", "[lammps_data]") {
  ScratchDirectory scratch;
  const LammpsData data = read_lammps_data(
      scratch.file("a", two_atoms(" # atomic", "1 1 0.10000000000000001 -2.2250738585072014e-308 1e300",
                                  "2 1 5e-324 -0 0.30000000000000004")));
  CHECK(data.position(0, 0) == 0.1);
  CHECK(data.position(1, 0) == -std::numeric_limits<double>::min());
  CHECK(data.position(2, 0) == 1e300);
  CHECK(data.position(0, 1) == std::numeric_limits<double>::denorm_min());
  CHECK(data.position(2, 1) == 0.1 + 0.2);
}

TEST_CASE("angle styles: cosine, cosine/shift, and lines that name theirs", "[lammps_data]") {
  ScratchDirectory scratch;
  const auto types = [&](const std::string& comment, const std::string& first, const std::string& second) {
    return read_lammps_data(scratch.file("a",
                                         "title\n3 atoms\n1 atom types\n1 angles\n2 angle types\nAtoms # atomic\n\n"
                                         "1 1 0 0 0\n2 1 1 0 0\n3 1 2 0 0\nAngles\n\n1 2 1 2 3\nAngle Coeffs" +
                                             comment + "\n\n1 " + first + "\n2 " + second + "\n"))
        .angle_types;
  };
  const auto check = [](const std::vector<AngleType>& t) {
    REQUIRE(t.size() == 2);
    CHECK(t[0].stiffness == 5);
    CHECK(t[0].rest == pi);
    CHECK(t[1].stiffness == 7);
    CHECK(t[1].rest == Approx(150 * pi / 180).epsilon(1e-15));
  };
  check(types(" # cosine/shift", "10 180", "14 150"));
  check(types(" # cosine/shift", "cosine 5", "14 150"));
  check(types(" # hybrid", "cosine 5", "cosine/shift 14 150"));
  check(types(" # cosine", "5", "cosine/shift 14 150.0"));
  check(types("", "5", "cosine/shift 14 1.5e2"));
  CHECK(types("", "5", "cosine/shift 14 0")[1].rest == 0);
  CHECK_THROWS_WITH(types("", "5", "14 150"),
                    Catch::Contains(":17:1: Angle Coeffs: 3 columns, expected 2: type and K of style cosine"));
  CHECK_THROWS_WITH(types(" # cosine/shift", "10 180", "14"),
                    Catch::Contains(":17:1: Angle Coeffs: 2 columns, expected 3: type, Umin and theta0 of style "
                                    "cosine/shift, U = -Umin/2 (1 + cos(theta - theta0))"));
  CHECK_THROWS_WITH(types(" # cosine/shift", "10 180", "14 181"),
                    Catch::Contains(":17:6: Angle Coeffs: theta0: 181 is out of range; 0 to 180 degrees are allowed"));
  CHECK_THROWS_WITH(types(" # cosine/shift", "10 180", "-14 18"),
                    Catch::Contains(":17:3: Angle Coeffs: Umin: -14 is negative"));
  CHECK_THROWS_WITH(
      types(" # hybrid", "cosine 5", "cosine/delta 14 150"),
      Catch::Contains(":17:3: Angle Coeffs: style \"cosine/delta\" is not available; cosine and cosine/shift are"));
}
