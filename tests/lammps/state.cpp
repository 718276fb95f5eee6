#include "lammps/state.hpp"

#include "catch.hpp"
#include "core/error.hpp"
#include "laws/section.hpp"
#include "lammps/data.hpp"
#include "results/sample.hpp"
#include "scratch_directory.hpp"

#include <algorithm>
#include <sstream>

using namespace elamin;

TEST_CASE("a written state is read back to the last bit", "[lammps_state]") {
  ScratchDirectory scratch;
  Model m = sample_model();
  m.id = {2, 3, 5, 7, 11};
  const double scale = GENERATE(1e-9, 1.0, 1e6);
  State state = m.start;
  state.position *= scale / 7;
  state.position(1, 3) = -0.1 * scale;
  const bool moving = GENERATE(false, true);
  if (moving) m.velocity = state.position * (1.0 / 3);
  const std::string file = scratch / "a.data";
  write_state(file, m, state, "a state");
  const LammpsData data = read_lammps_data(file);
  CHECK(data.position == state.position);
  CHECK(data.id == m.id);
  CHECK(data.type == m.type);
  CHECK(data.molecule == m.molecule);
  CHECK(data.diameter == m.diameter);
  CHECK(data.density == m.density);
  CHECK(data.velocity.cols() == (moving ? 5 : 0));
  if (moving) CHECK(data.velocity == m.velocity);
  REQUIRE(data.bond_types.size() == m.bond_types.size());
  for (std::size_t k = 0; k < m.bond_types.size(); ++k) {
    CHECK(data.bond_types[k].stiffness == m.bond_types[k].stiffness);
    CHECK(data.bond_types[k].rest_length == m.bond_types[k].rest_length);
  }
  REQUIRE(data.angle_types.size() == 1);
  CHECK(data.angle_types[0].stiffness == m.angle_types[0].stiffness);
  CHECK(data.angle_types[0].rest == pi);
  REQUIRE(data.bonds.size() == m.bonds.size());
  for (std::size_t k = 0; k < m.bonds.size(); ++k) {
    CHECK(data.bonds[k].type == m.bonds[k].type);
    CHECK(data.bonds[k].particles == m.bonds[k].particles);
  }
  REQUIRE(data.angles.size() == m.angles.size());
  for (std::size_t k = 0; k < m.angles.size(); ++k) CHECK(data.angles[k].particles == m.angles[k].particles);
}

TEST_CASE("angles that are not straight at rest are written as cosine/shift", "[lammps_state]") {
  ScratchDirectory scratch;
  Model m = sample_model();
  m.angle_types = {{0.1, pi}, {1.0 / 3, pi / 2}, {7, 2.5}, {1e-7 / 3, 0.0}, {2, pi - 2 * pi / 78}};
  m.angles.push_back(m.angles[0]), m.angles.push_back(m.angles[1]);
  for (int k = 0; k < 5; ++k) m.angles[k].type = k;
  write_state(scratch / "a.data", m, m.start, "a state");
  CHECK(text_of(scratch / "a.data").find("Angle Coeffs # cosine/shift\n\n1 0.20000000000000001 180\n2 ") != std::string::npos);
  const LammpsData data = read_lammps_data(scratch / "a.data");
  REQUIRE(data.angle_types.size() == m.angle_types.size());
  for (std::size_t k = 0; k < m.angle_types.size(); ++k) {
    CHECK(data.angle_types[k].stiffness == m.angle_types[k].stiffness);
    CHECK(std::abs(data.angle_types[k].rest - m.angle_types[k].rest) <= epsilon * m.angle_types[k].rest);
  }
  CHECK(data.angle_types[0].rest == pi);
}

TEST_CASE("the box of a written state holds all particles with room, flat and far ones too", "[lammps_state]") {
  ScratchDirectory scratch;
  Model m = sample_model();
  State state = m.start;
  if (GENERATE(false, true)) state.position.row(0).setConstant(1e9);
  write_state(scratch / "a.data", m, state, "a");
  std::istringstream lines(text_of(scratch / "a.data"));
  std::string line;
  int found = 0;
  while (std::getline(lines, line)) {
    const std::size_t at = line.find("lo ");
    if (at == std::string::npos) continue;
    std::istringstream words(line);
    double lo, hi;
    words >> lo >> hi;
    const int c = line[at - 1] - 'x';
    ++found;
    CHECK(lo < state.position.row(c).minCoeff() - 0.2);
    CHECK(hi > state.position.row(c).maxCoeff() + 0.2);
  }
  CHECK(found == 3);
}

TEST_CASE("grains alone", "[lammps_state]") {
  ScratchDirectory scratch;
  Model m = sample_model();
  m.bonds.clear(), m.angles.clear(), m.bond_types.clear(), m.angle_types.clear();
  m.molecule = {1, 2, 3, 4, 5}, m.diameter = {0.1, 0.2, 0.3, 0.4, 0.5};
  write_state(scratch / "a.data", m, m.start, "grains");
  const std::string text = text_of(scratch / "a.data");
  for (const char* section : {"Coeffs", "Bonds", "Angles"}) CHECK(text.find(section) == std::string::npos);
  const LammpsData data = read_lammps_data(scratch / "a.data");
  CHECK(data.position == m.start.position);
  CHECK(data.molecule == m.molecule);
  CHECK(data.diameter == m.diameter);
  CHECK(data.bond_types.empty());
  CHECK(data.angle_types.empty());
}

TEST_CASE("particles without bonds, density or a sane title", "[lammps_state]") {
  ScratchDirectory scratch;
  Model m = sample_model();
  m.bonds.clear(), m.angles.clear(), m.bond_types.clear(), m.angle_types.clear();
  std::fill(m.density.begin(), m.density.end(), 0.0);
  std::string title = "two\nlines ";
  for (int i = 0; i < 200; ++i) title += "é";
  write_state(scratch / "a.data", m, m.start, title);
  const std::string text = text_of(scratch / "a.data");
  const std::string first = text.substr(0, text.find('\n'));
  CHECK(first.find("two lines") == 0);
  CHECK(first.find("a density that is not given is written as 1") != std::string::npos);
  CHECK(first.size() < 255);                                // LAMMPS reads no longer line
  CHECK((first.size() - first.find(';')) + 10 + 2 * std::count(first.begin(), first.end(), '\xc3') ==
        first.size());  // whole characters
  const LammpsData data = read_lammps_data(scratch / "a.data");
  CHECK(data.bonds.empty());
  CHECK(data.density == std::vector<double>(5, 1.0));
  CHECK_THROWS_AS(write_state(scratch / "none/a.data", m, m.start, ""), OutputError);
}

TEST_CASE("types that no bond or angle has are left out of a state, the others counted anew", "[lammps_state]") {
  ScratchDirectory scratch;
  Model m = sample_model();
  const std::vector<BondType> bond_types = m.bond_types;
  const std::vector<AngleType> angle_types = m.angle_types;
  m.bond_types.assign(100'000, {7, 1}), m.angle_types.assign(100'000, {3, 1});
  for (Bond& b : m.bonds) m.bond_types[5000 + 10 * b.type] = bond_types[b.type], b.type = 5000 + 10 * b.type;
  for (Angle& a : m.angles) m.angle_types[999 + a.type] = angle_types[a.type], a.type = 999 + a.type;
  const std::string file = scratch / "a.data";
  write_state(file, m, m.start, "a state");
  const std::string text = text_of(file);
  CHECK(text.size() < 2000);
  CHECK(text.starts_with("a state; types that no bond or angle has are left out\n"));
  const LammpsData data = read_lammps_data(file);
  REQUIRE((data.bonds.size() == m.bonds.size() && data.angles.size() == m.angles.size()));
  for (std::size_t k = 0; k < m.bonds.size(); ++k) {
    const BondType &own = m.bond_types[m.bonds[k].type], &read = data.bond_types[data.bonds[k].type];
    CHECK((own.stiffness == read.stiffness && own.rest_length == read.rest_length && data.bonds[k].particles == m.bonds[k].particles));
  }
  for (std::size_t k = 0; k < m.angles.size(); ++k)
    CHECK(data.angle_types[data.angles[k].type].stiffness == m.angle_types[m.angles[k].type].stiffness);
}
