// Laws whose parameters change, and the pressure on an edge.
#include "catch.hpp"
#include "laws/check_law.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/edge_pressure.hpp"
#include "laws/harmonic_bond.hpp"

using namespace elamin;

namespace {

// gradient_rate against differences of the gradient of `at`, the law as a function of its parameter.
template <class L, class At>
bool rate_agrees(const At& at, const L& rate, const Points<L::sites>& x, double step) {
  using Gradient = Eigen::Matrix<double, 3 * L::sites, 1>;
  const Gradient exact = at(0).gradient_rate(x, rate);
  const Gradient differences = difference([&](double s) -> Gradient { return at(s).derivatives(x).gradient; }, step);
  const double scale = at(0).derivatives(x).gradient.norm() / step * std::pow(epsilon, 0.2) + exact.norm();
  return exact.norm() > 0 && (exact - differences).norm() <= 100 * std::pow(epsilon, 0.8) * scale;
}

}  // namespace

TEST_CASE("gradients change with the laws' parameters as differences say", "[laws]") {
  std::mt19937 random(11);
  const double h = std::pow(epsilon, 0.2);
  for (int k = 0; k < 50; ++k) {
    const Points<2> pair = random_points<2>(random, 1);
    CHECK(rate_agrees([](double s) { return HarmonicBond{3.5 + 0.7 * s, 0.4}; }, HarmonicBond{0.7, 0}, pair, h));
    CHECK(rate_agrees([](double s) { return HarmonicBond{3.5, 0.4 - 0.3 * s}; }, HarmonicBond{0, -0.3}, pair, h));
    CHECK(rate_agrees([](double s) { return HarmonicBond{3.5 - s, 0.4 + 0.2 * s}; }, HarmonicBond{-1, 0.2}, pair, h));
    const Points<3> triple = random_points<3>(random, 1);
    for (const double rest : {pi, 2.0})
      CHECK(rate_agrees([&](double s) { return CosineAngle{2 + 0.3 * s, rest}; }, CosineAngle{0.3, rest}, triple, h));
    const Vec3 n = Vec3(0.3, -0.4, 0.8).normalized();
    const ExactVector c{Vec3(0.1, 0.2, -0.1), Vec3::Zero()};
    CHECK(rate_agrees([&](double s) { return EdgePressure{2 - s, n, c}; }, EdgePressure{-1, n, c}, pair, h));
  }
}

TEST_CASE("a rest length keeps a change that a double would round away", "[laws]") {
  const double tail = std::ldexp(1.0, -60);
  Eigen::Matrix<double, 3, 2> x = Eigen::Matrix<double, 3, 2>::Zero();
  x.col(1) << 3, 4, 0;
  CHECK(5.0 + tail == 5.0);
  const Local<2> u = HarmonicBond{7, 5, tail}.derivatives(Points<2>(x));      // r − r₀ = −tail
  CHECK(u.gradient[3] == Approx(-2 * 7 * tail * 0.6).epsilon(8 * epsilon));
  CHECK(u.value == Approx(7 * tail * tail).epsilon(8 * epsilon));
}

TEST_CASE("pressure on an edge agrees with differences of its value", "[laws]") {
  std::mt19937 random(5);
  for (const double size : {1e-3, 1.0, 1e3})
    for (int k = 0; k < 50; ++k) {
      const Points<2> pair = random_points<2>(random, size);
      const EdgePressure law{2.5, Vec3(0.2, -0.5, 0.7).normalized(), {size * Vec3(0.3, -0.2, 0.1), Vec3::Zero()}};
      CHECK(check_law(law, pair, shortest_edge(pair)) == std::vector<std::string>{});
    }
}

TEST_CASE("pressure on all edges is p times the area, wherever the polygon stands", "[laws]") {
  // A triangle with sides 3, 4, 5, counterclockwise about z, area 6; far away its corners still are doubles.
  for (const Vec3& origin : {Vec3(0, 0, 0), Vec3(1e9, -3e9, 2e9)}) {
    Mat3 corner;
    corner << 0, 3, 3, 0, 0, 4, 0, 0, 0;
    corner.colwise() += origin;
    double energy = 0;
    Field force = Field::Zero(3, 3);
    for (int i = 0; i < 3; ++i) {
      Eigen::Matrix<double, 3, 2> edge;
      edge << corner.col(i), corner.col((i + 1) % 3);
      const Local<2> u = EdgePressure{0.5, Vec3::UnitZ(), {origin + Vec3(0.25, 0.5, 8), Vec3::Zero()}}.derivatives(Points<2>(edge));
      energy += u.value;
      force.col(i) -= u.gradient.head<3>(), force.col((i + 1) % 3) -= u.gradient.tail<3>();
    }
    CHECK(energy == 3);                                   // all of it exact in these numbers
    CHECK(force.col(0) == Vec3(1, 0, 0));                 // half of p times the sides that meet there, inwards
    CHECK(force.col(1) == Vec3(-1, 0.75, 0));
    CHECK(force.col(2) == Vec3(0, -0.75, 0));
  }
}
