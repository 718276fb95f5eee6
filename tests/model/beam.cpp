#include "catch.hpp"
#include "core/exact.hpp"
#include "model/beam.hpp"
#include "model/geometry.hpp"

using namespace elamin;

namespace {

double length_of(const ExactVector& v) { return (v.hi + v.lo).norm(); }

Model beam_from(const Vec3& from, const Vec3& to, int n) {
  Model model;
  add_beams(model, {{"beam", row(exact(from), exact(to), n).centers, 1e-3, 0, 0, {10, 1e-3}, {1e-6}}});
  return model;
}

}  // namespace

TEST_CASE("An oblique beam is uniform and straight to 1e-30") {
  const double scale = GENERATE(1e-3, 1.0, 1e3);
  const int n = GENERATE(2, 3, 10, 78, 1000);
  const Vec3 from = scale * Vec3(0.1, -0.7, 1.0 / 3), to = scale * Vec3(-0.9, 0.3, 0.77);
  const Model m = beam_from(from, to, n);
  REQUIRE(m.particles() == n);
  CHECK(m.start.position.col(0) == from);
  CHECK(m.start.position.col(n - 1) == to);
  CHECK(m.start.low.col(0).isZero(0));
  CHECK(m.start.low.col(n - 1).isZero(0));
  const ExactVector whole = exact(to) - exact(from);
  double bent = 0, uneven = 0, rounding = 0;
  for (int i = 1; i + 1 < n; ++i) {
    bent = std::max(bent, length_of(cross(m.start.at(i) - m.start.at(0), whole)) / (scale * scale));
    uneven = std::max(uneven, length_of((m.start.at(i + 1) - m.start.at(i)) - (m.start.at(i) - m.start.at(i - 1))) / scale);
    rounding = std::max(rounding, m.start.low.col(i).norm() / scale);
  }
  CHECK(bent < 1e-30);
  CHECK(uneven < 1e-30);
  if (n > 2) CHECK(rounding > 1e-18);   // the tails are needed: positions alone would not be straight
}

TEST_CASE("A row about its centre has the asked length and direction") {
  const Vec3 center(0.3, -2.0, 0.1),
      axis = GENERATE(Vec3(0, 0, 1), Vec3(0, 0, -7), Vec3(1, 2, -3), Vec3(1e-200, 3e-200, 0), Vec3(1e250, 1, 1e249));
  const double spacing = 1e-3;
  const int n = 77;
  const auto [from, to] = ends_of_row(center, axis, spacing, n);
  const ExactVector row = to - from, middle = from + to;
  const Exact length = distance(from, to);
  CHECK(std::abs((length - two_product(spacing, n)).value()) < 1e-28 * spacing * n);
  for (int c = 0; c < 3; ++c) CHECK(std::abs((middle[c] - Exact{2 * center[c], 0}).value()) < 1e-30);
  CHECK(row.hi.dot(axis / axis.cwiseAbs().maxCoeff()) > 0);
  CHECK(row.hi.normalized().cross((axis / axis.cwiseAbs().maxCoeff()).normalized()).norm() < 1e-15);
}

TEST_CASE("Lengths are exact for vectors of any size") {
  const double s = GENERATE(1e-300, 1e-3, 1.0, 1e300);
  // 2² + 3² + 6² = 7²: no rounding at all but that of s itself.
  const Exact d = distance(exact(Vec3(0, 0, 0)), exact(Vec3(2, -3, 6) * s));
  CHECK(d.hi == Approx(7 * s).epsilon(1e-15));
  CHECK(distance(exact(Vec3(1, 2, 3)), exact(Vec3(1, 2, 3))).value() == 0);
  const Exact root_two = distance(exact(Vec3(0, 0, 0)), exact(Vec3(1, 1, 0)));
  CHECK(std::abs((root_two * root_two - Exact{2, 0}).value()) < 1e-30);
}

TEST_CASE("Beams are appended one after another with ids, types and molecules of their own") {
  Model m;
  m.start = State(Field::Zero(3, 2));
  m.id = {5, 9}, m.type = {1, 3}, m.molecule = {0, 2}, m.diameter = {1, 1}, m.density = {1, 1};
  m.velocity = Field::Ones(3, 2);
  m.bond_types = {{1, 1}};
  const ExactVector o = exact(Vec3::Zero()), x = exact(Vec3(1, 0, 0)), y = exact(Vec3(0, 1, 0));
  add_beams(m, {{"a", row(o, x, 2).centers, 0.5, 7, 1, {2, 3}, {4}}, {"b", row(o, y, 4).centers, 0.25, 0, 2, {5, 6}, {7}}});
  CHECK(m.id == std::vector<int>{5, 9, 10, 11, 12, 13, 14, 15});
  CHECK(m.type == std::vector<int>{1, 3, 4, 4, 5, 5, 5, 5});
  CHECK(m.molecule == std::vector<int>{0, 2, 3, 3, 4, 4, 4, 4});
  CHECK(m.diameter == std::vector<double>{1, 1, 0.5, 0.5, 0.25, 0.25, 0.25, 0.25});
  CHECK(m.density == std::vector<double>{1, 1, 7, 7, 0, 0, 0, 0});
  CHECK(m.velocity.cols() == 8);
  CHECK(m.velocity.rightCols(6).isZero(0));
  CHECK(m.velocity.leftCols(2).isOnes(0));
  REQUIRE(m.bonds.size() == 4);
  CHECK(m.bonds[0].type == 1);
  CHECK(m.bonds[0].particles == std::array{2, 3});
  CHECK(m.bonds[3].type == 2);
  CHECK(m.bonds[3].particles == std::array{6, 7});
  REQUIRE(m.angles.size() == 2);
  CHECK(m.angles[1].type == 1);
  CHECK(m.angles[1].particles == std::array{5, 6, 7});
  CHECK(m.bond_types[2].rest_length == 6);
  REQUIRE(m.structures.size() == 2);
  CHECK(m.structures[1].name == "b");
  CHECK(m.structures[1].first == 4);
  CHECK(m.structures[1].count == 4);
  CHECK(m.structures[1].bond_type == 2);
  CHECK(m.structures[1].angle_type == 1);
}
