#include "model/loop.hpp"

#include "catch.hpp"
#include "model/beam.hpp"
#include "model/geometry.hpp"

using namespace elamin;

TEST_CASE("A ring is round, even and closed to the last bit", "[model]") {
  const double scale = GENERATE(1e-3, 1.0, 1e3);
  const int n = GENERATE(3, 4, 7, 100, 158);
  const Vec3 normal = GENERATE(Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, -2, 0.5)),
             center = scale * Vec3(0.1, -1.0 / 3, 0.7);
  const double radius = 0.37 * scale, q0 = chord(radius, n);
  CHECK(q0 == Approx(2 * radius * std::sin(exact_pi.hi / n)).epsilon(8 * epsilon));
  CHECK(ring_angle(n) == Approx(exact_pi.hi - 2 * exact_pi.hi / n).epsilon(4 * epsilon));
  Model m;
  add_loops(m, {{"ring", n, center, normal, radius, q0, 800, 1e6, {10, q0}, {1e-6, ring_angle(n)}}});
  REQUIRE(m.particles() == n);
  REQUIRE(m.bonds.size() == static_cast<std::size_t>(n));
  REQUIRE(m.angles.size() == static_cast<std::size_t>(n));
  const Exact exact_chord = distance(m.start.at(0), m.start.at(1));
  CHECK(std::abs(exact_chord.value() - q0) <= epsilon * q0 / 2);
  std::vector<int> bonds(n), middles(n);
  for (const Bond& b : m.bonds) {
    const Exact length = distance(m.start.at(b.particles[0]), m.start.at(b.particles[1]));
    CHECK(std::abs((length - exact_chord).value()) < 1e-28 * scale);
    for (const int p : b.particles) ++bonds[p];
  }
  for (const Angle& a : m.angles) {
    const ExactVector u = m.start.at(a.particles[0]) - m.start.at(a.particles[1]),
                      w = m.start.at(a.particles[2]) - m.start.at(a.particles[1]);
    CHECK(std::abs(std::acos(u.hi.dot(w.hi) / (u.hi.norm() * w.hi.norm())) - ring_angle(n)) < 1e-13);
    ++middles[a.particles[1]];
  }
  for (int k = 0; k < n; ++k) {
    CHECK((bonds[k] == 2 && middles[k] == 1));
    CHECK(std::abs((distance(m.start.at(k), exact(center)) - exact(radius)).value()) < 1e-28 * scale);
    CHECK(std::abs((m.start.position.col(k) - center).dot(normal.normalized())) < 4 * epsilon * scale);
  }
  CHECK((m.structures[0].kind == "loop" && m.structures[0].count == n && m.structures[0].bond_type == 0));
}

TEST_CASE("A ring starts on e1 and turns towards e2", "[model]") {
  Model m;
  const Ring ring{"", 8, {1, 2, 3}, {0, 0, 1}, 2, 1, 0, 0, {1, 1}, {1}};
  add_loops(m, {ring, ring});
  CHECK(m.start.position.col(0) == Vec3(3, 2, 3));
  CHECK(m.start.position.col(2) == Vec3(1, 4, 3));
  CHECK(m.start.position.col(4) == Vec3(-1, 2, 3));
  CHECK(m.start.position.row(2) == Eigen::RowVectorXd::Constant(16, 3));
  CHECK(m.bonds[8 + 7].particles == std::array{15, 8});
  CHECK(m.angles[8 + 7].particles == std::array{15, 8, 9});
  CHECK((m.angles[8].type == 1 && m.type[8] == 2 && m.molecule[15] == 2 && m.id[15] == 16));
}
