// The pressure on a triangle.
#include "catch.hpp"
#include "laws/check_law.hpp"
#include "laws/triangle_pressure.hpp"

using namespace elamin;

TEST_CASE("pressure on a triangle agrees with differences of its value", "[laws]") {
  std::mt19937 random(11);
  for (const double size : {1e-3, 1.0, 1e3})
    for (int k = 0; k < 20; ++k) {
      const Points<3> x = random_points<3>(random, size);
      CHECK(check_law(TrianglePressure{2.5, size * Vec3(0.3, -0.2, 0.1)}, x, shortest_edge(x)) == std::vector<std::string>{});
      const TrianglePressure law{1, size * Vec3(0.3, -0.2, 0.1)}, rate{-2, law.tip};
      CHECK((law.gradient_rate(x, rate) + 2 * law.derivatives(x).gradient).norm() <= 4 * epsilon * law.derivatives(x).gradient.norm());
    }
}

TEST_CASE("pressure on all faces of a body is p times its volume, wherever the tip is", "[laws]") {
  // A tetrahedron of volume 8, its faces counterclockwise from outside; all of it exact in these numbers.
  Eigen::Matrix<double, 3, 4> corner;
  corner << 0, 4, 0, 0, 0, 0, 4, 0, 0, 0, 0, 3;
  const int faces[4][3]{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  for (const Vec3& tip : {Vec3(0, 0, 0), Vec3(1, 2, -4), Vec3(64, -32, 16)}) {
    double energy = 0;
    Eigen::Matrix<double, 3, 4> force = Eigen::Matrix<double, 3, 4>::Zero();
    for (const auto& f : faces) {
      Mat3 x;
      for (int s = 0; s < 3; ++s) x.col(s) = corner.col(f[s]);
      const Local<3> u = TrianglePressure{0.75, tip}.derivatives(Points<3>(x));
      energy += u.value;
      for (int s = 0; s < 3; ++s) force.col(f[s]) -= u.gradient.segment<3>(3 * s);
    }
    CHECK(energy == Approx(6).epsilon(1e-12));
    // A third of p times the faces that meet there, inwards: at the origin three faces with areas 8, 6 and 6.
    CHECK((force.col(0) - Vec3(1.5, 1.5, 2)).norm() < 1e-11);
    CHECK(force.rowwise().sum().norm() < 1e-11);
  }
}
