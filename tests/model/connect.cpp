#include "model/connect.hpp"

#include "catch.hpp"
#include "chain.hpp"
#include "model/beam.hpp"
#include "model/geometry.hpp"
#include "model/grains.hpp"
#include "model/sheet.hpp"

#include <random>
#include <set>

using namespace elamin;

namespace {

Model points(const Field& x) {
  Model m;
  add_grains(m, {{"points", x, std::vector<double>(x.cols(), 1), 1}});
  return m;
}

Field random_points(int n, double size) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> coordinate(-size, size);
  Field x(3, n);
  for (double& c : x.reshaped()) c = coordinate(engine);
  return x;
}

std::set<std::pair<int, int>> bonds_of(const Model& m) {
  std::set<std::pair<int, int>> pairs;
  for (const Bond& b : m.bonds) pairs.insert(std::minmax(b.particles[0], b.particles[1]));
  return pairs;
}

Connection connection(std::vector<int> first, std::vector<int> second, double within) {
  Connection c;
  c.first = std::move(first), c.second = std::move(second), c.within = within, c.bond_stiffness = 5;
  return c;
}

}  // namespace

TEST_CASE("Every near pair is bonded once, with its length as built", "[model]") {
  const double scale = GENERATE(1e-3, 1.0, 1e3), within = GENERATE(1e-6, 0.1, 0.4, 10.0);
  const int outliers = GENERATE(0, 1);
  Field x = random_points(300, 1);
  if (outliers) x.col(299) = Vec3(1e9, -1e8, 3);
  x *= scale;
  Model m = points(x);
  m.bonds = {{0, {0, 1}}, {0, {150, 10}}}, m.bond_types = {{1, 1}};
  std::set<std::pair<int, int>> expected{{0, 1}, {10, 150}};   // groups 0 … 199 and 100 … 299 overlap
  for (int i = 0; i < 200; ++i)
    for (int j = 100; j < 300; ++j)
      if (i != j && (x.col(i) - x.col(j)).norm() < within * scale) expected.insert(std::minmax(i, j));
  const int made = connect(m, connection(numbers(200), numbers(200, 100), within * scale));
  CHECK(bonds_of(m) == expected);
  CHECK(m.bonds.size() == expected.size());
  CHECK(made == static_cast<int>(expected.size()) - 2);
  for (std::size_t b = 2; b < m.bonds.size(); ++b) {
    const auto& [i, j] = m.bonds[b].particles;
    const BondType& type = m.bond_types[m.bonds[b].type];
    CHECK((m.bonds[b].type > 0 && type.stiffness == 5));
    CHECK(std::abs((distance(m.start.at(i), m.start.at(j)) - exact(type.rest_length)).value()) <=
          16 * epsilon * type.rest_length);
  }
  CHECK(m.angles.empty());
}

TEST_CASE("The nearest ones of each particle, those of lower index where they are equally far", "[model]") {
  const Vec3 shift = GENERATE(Vec3(0, 0, 0), Vec3(1e3 / 3, -7e2 / 9, 0.1));   // there the distances differ by rounding
  Field x(3, 7);
  x << 0, 1, -1, 0, 0, 0.3, 5, 0, 0, 0, 1, -1, 0, 0, 0, 0, 0, 0, 0, 1, 0;
  Model m = points(x.colwise() + shift);
  Connection c = connection({0}, numbers(6, 1), 2);
  c.bonds_per_particle = GENERATE(1, 2, 3, 4, 5, 9);
  const int made = connect(m, c);
  CHECK(made == std::min(c.bonds_per_particle, 5));
  std::set<std::pair<int, int>> expected;
  for (int k = 1; k <= made; ++k) expected.insert({0, k});   // four at 1, then the one at √1.09
  CHECK(bonds_of(m) == expected);
  if (shift.isZero(0)) CHECK(m.bond_types.size() == (made == 5 ? 2 : 1));
}

TEST_CASE("Distances that differ by rounding are equally far", "[model]") {
  Field x = Field::Zero(3, 4);
  x(0, 1) = 1 + 1e-13, x(1, 2) = 1, x(2, 3) = 1 - 1e-6;
  Model m = points(x);
  Connection c = connection({0}, numbers(3, 1), 2);
  c.bonds_per_particle = 2;
  CHECK(connect(m, c) == 2);
  CHECK(bonds_of(m) == std::set<std::pair<int, int>>{{0, 1}, {0, 3}});
}

TEST_CASE("A distance that is `within` to rounding is within", "[model]") {
  for (const double s : {0.1, 0.3, 1e-3, 7e3}) {
    Field x(3, 11);
    for (int k = 0; k < 11; ++k) x.col(k) = Vec3(k * s, 1e3 * s / 3, 0);
    Model m = points(x);
    CHECK(connect(m, connection(numbers(11), numbers(11), s)) == 10);
    Model fewer = points(x);
    CHECK(connect(fewer, connection(numbers(11), numbers(11), s * (1 - 1e-6))) == 0);
    CHECK((fewer.bonds.empty() && fewer.bond_types.empty()));
  }
}

TEST_CASE("A post on a beam: bond types by length, angle types by rest angle", "[model]") {
  const ExactVector left = exact(Vec3(-2, 0, 0)), right = exact(Vec3(2, 0, 0)), foot = exact(Vec3(0, 0, 1)),
                    top = exact(Vec3(0, 0, 4));
  Model m;
  add_beams(m, {{"beam", row(left, right, 5).centers, 1, 1, 0, {1, 1}, {1}}, {"post", row(foot, top, 4).centers, 1, 1, 0, {1, 1}, {1}}});
  Connection c = connection(numbers(4, 5), numbers(5), 1.5);   // the foot to the middle and, at √2, to its neighbours
  c.angle_stiffness = 7;
  REQUIRE(connect(m, c) == 3);
  REQUIRE(m.bonds.size() == 4 + 3 + 3);
  REQUIRE(m.bond_types.size() == 4);
  CHECK(m.bonds[7].particles == std::array{1, 5});
  CHECK(m.bonds[8].particles == std::array{2, 5});
  CHECK(m.bonds[9].particles == std::array{3, 5});
  CHECK(m.bonds[7].type == m.bonds[9].type);
  CHECK(m.bond_types[m.bonds[7].type].rest_length == std::sqrt(2.0));
  CHECK(m.bond_types[m.bonds[8].type].rest_length == 1);
  // Each bond continues into the post (1) and along the beam (2).
  REQUIRE(m.angles.size() == 3 + 2 + 9);
  int straight = 0, square = 0, half = 0, obtuse = 0;
  for (std::size_t a = 5; a < m.angles.size(); ++a) {
    const AngleType& type = m.angle_types[m.angles[a].type];
    CHECK(type.stiffness == 7);
    straight += type.rest == exact_pi.hi;
    square += std::abs(type.rest - exact_pi.hi / 2) < 4 * epsilon;
    half += std::abs(type.rest - exact_pi.hi / 4) < 4 * epsilon;
    obtuse += std::abs(type.rest - 3 * exact_pi.hi / 4) < 4 * epsilon;
  }
  CHECK((straight == 1 && square == 2 && half == 2 && obtuse == 4));
  CHECK(m.angle_types.size() == 2 + 4);
}

TEST_CASE("Rest length and rest angle may be given", "[model]") {
  Model m;
  add_beams(m, {{"a", row(exact(Vec3(0, 0, 0)), exact(Vec3(3, 0, 0)), 4).centers, 1, 1, 0, {1, 1}, {1}},
                {"b", row(exact(Vec3(4, 0, 0)), exact(Vec3(4, 3, 0)), 4).centers, 1, 1, 0, {1, 1}, {1}}});
  Connection c = connection(numbers(4), numbers(4, 4), 1.5);
  c.rest_length = 0.8, c.angle_stiffness = 2, c.as_built = false, c.rest = 3;
  REQUIRE(connect(m, c) == 2);   // (3, 4) and the diagonal (3, 5)
  CHECK((m.bond_types.size() == 3 && m.bond_types[2].rest_length == 0.8));
  CHECK((m.angle_types.size() == 3 && m.angle_types[2].rest == 3 && m.angle_types[2].stiffness == 2));
  CHECK(m.angles.size() == 4 + 2 + 3);
}

TEST_CASE("Two plates laid on each other are glued all over", "[model]") {
  Sheet s;
  s.size = {30, 30}, s.spacing = s.diameter = 1;
  Sheet above = s;
  above.center[2] = 1;
  Model m;
  add_sheets(m, {s, above});
  const int n = m.structures[0].count;
  Connection c = connection(numbers(n), numbers(n, n), 1);
  c.angle_stiffness = 1;
  const std::size_t bonds = m.bonds.size(), angles = m.angles.size();
  CHECK(connect(m, c) == n);
  CHECK(m.bond_types.size() == 3);                // one for all of them
  CHECK(m.angle_types.size() == 1);               // all right angles; the plates do not bend, and have none of their own
  CHECK(m.angles.size() - angles == 2 * bonds);   // at both ends of each bond of each plate
}

TEST_CASE("Nothing near, nothing made, too much is refused", "[model]") {
  Model m = points(random_points(4500, 1));
  CHECK(connect(m, connection({}, {1}, 1)) == 0);
  CHECK(connect(m, connection({1}, {}, 1)) == 0);
  CHECK(connect(m, connection({1}, {1}, 1)) == 0);
  CHECK(connect(m, connection(numbers(4500), numbers(4500), 10)) == -1);
  CHECK((m.bonds.empty() && m.bond_types.empty()));
}

TEST_CASE("The nearest ones are found however far they are", "[model]") {
  Field x(3, 4);
  x << 0, 1, 100, 1000, 0, 0, 0, 0, 0, 0, 0, 0;
  Model m = points(x);
  Connection c = connection(numbers(4), numbers(4), 0);
  c.bonds_per_particle = 1;
  CHECK(connect(m, c) == 3);
  CHECK(bonds_of(m) == std::set<std::pair<int, int>>{{0, 1}, {1, 2}, {2, 3}});
  // As with a distance that takes in everything.
  Model far = points(random_points(60, 1)), near = far;
  Connection any = connection(numbers(60), numbers(60), 0), within = connection(numbers(60), numbers(60), 10);
  any.bonds_per_particle = within.bonds_per_particle = 3;
  CHECK(connect(far, any) == connect(near, within));
  CHECK(bonds_of(far) == bonds_of(near));
}

TEST_CASE("New bonds have a type for each stiffness and length, EA makes K = EA/(2 r0)", "[model]") {
  Field x(3, 4);
  x << 0, 2, 4, 7, 0, 0, 0, 0, 0, 0, 0, 0;
  Model m = points(x);
  add_bonds(m, {{{0, 1}, 5, 0, 0}, {{1, 2}, 5, 0, 0}, {{2, 3}, 0, 12, 0}, {{0, 2}, 0, 12, 3}, {{1, 3}, 6, 0, 2}});
  REQUIRE(m.bonds.size() == 5);
  CHECK(m.bond_types.size() == 3);                       // (5, 2), (2, 3) twice, (6, 2)
  CHECK(m.bonds[0].type == m.bonds[1].type);
  CHECK(m.bonds[2].type == m.bonds[3].type);
  CHECK(m.bond_types[m.bonds[2].type].stiffness == 2);
  CHECK(m.bond_types[m.bonds[4].type].stiffness == 6);
  CHECK(meeting_bonds(m, numbers(4), 0).size() == 1 + 3 + 3 + 1);
  CHECK(meeting_bonds(m, numbers(3), 0).size() == 3);
  add_angles(m, {{{0, 1, 2}, 3, -1}, {{1, 2, 3}, 3, -1}, {{1, 2, 3}, 3, 2.5}});
  CHECK(m.angle_types.size() == 2);
  CHECK(m.angle_types[m.angles[0].type].rest == pi);
}

TEST_CASE("Bonds that meet at an angle or more are the straight ones of a lattice", "[model]") {
  Sheet s;
  s.name = "s", s.size = {6, 6}, s.spacing = s.diameter = 1, s.bond_stiffness = s.angle_stiffness = 1;
  Model m;
  add_sheets(m, {s});
  CHECK(meeting_bonds(m, numbers(m.particles(), 0), 150 * pi / 180).size() == m.angles.size());
}
