#include "catch.hpp"
#include "laws/check_law.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/harmonic_bond.hpp"
#include "laws/section.hpp"

using namespace elamin;

namespace {

// Harmonic bond whose Hessian forgets the transverse part: check_law must see it.
struct WrongHessian {
  static constexpr int sites = 2;
  HarmonicBond right{1, 1};
  double value(const Points<2>& x) const { return right.value(x); }
  Local<2> derivatives(const Points<2>& x) const {
    Local<2> u = right.derivatives(x);
    const Vec3 n = x.edge(0, 1).hi.normalized();
    const Mat3 h = 2 * right.K * n * n.transpose();
    u.block(0, 0) = u.block(1, 1) = h, u.block(0, 1) = u.block(1, 0) = -h;
    return u;
  }
};

// A gradient that is 10⁻⁶ too large: too small a mistake for the eye, not for check_law.
struct WrongGradient {
  static constexpr int sites = 3;
  CosineAngle right{1};
  double value(const Points<3>& x) const { return right.value(x); }
  Local<3> derivatives(const Points<3>& x) const {
    Local<3> u = right.derivatives(x);
    u.gradient *= 1 + 1e-6;
    return u;
  }
};

Points<3> row_with_turn(double turn) {        // 1 − cos of it is what a turn of the second side by atan(turn) costs
  Eigen::Matrix3d x;
  x << 0, 1, 2, 0, 0, turn, 0, 0, 0;
  return Points<3>(x);
}

}  // namespace

TEST_CASE("every law agrees with differences of its value", "[laws]") {
  std::mt19937 random(7);
  for (const double size : {1e-3, 1.0, 1e3})
    for (int k = 0; k < 50; ++k) {
      const Points<2> pair = random_points<2>(random, size);
      CHECK(check_law(HarmonicBond{3.5, 0.4 * size}, pair, shortest_edge(pair)) == std::vector<std::string>{});
      CHECK(check_law(HarmonicBond{1e11, 0}, pair, shortest_edge(pair)) == std::vector<std::string>{});
      const Points<3> triple = random_points<3>(random, size);
      CHECK(check_law(CosineAngle{0.7}, triple, shortest_edge(triple)) == std::vector<std::string>{});
    }
}

TEST_CASE("a wrong law fails the check", "[laws]") {
  std::mt19937 random(7);
  CHECK_FALSE(check_law(WrongHessian{}, random_points<2>(random, 1), 0.1).empty());
  CHECK_FALSE(check_law(WrongGradient{}, random_points<3>(random, 1), 0.1).empty());
}

TEST_CASE("laws where they are hard", "[laws]") {
  for (const double turn : {0.0, 1e-12, 1e-6, 1e-3, 0.3}) {
    CHECK(check_law(CosineAngle{2}, row_with_turn(turn), 1) == std::vector<std::string>{});
    Points<3> folded = row_with_turn(0);
    folded.position.col(2) << 0.2, turn, 0;                       // back over site 0
    CHECK(check_law(CosineAngle{2}, folded, 0.8) == std::vector<std::string>{});
  }
  for (const double distance : {1e-9, 1e-3}) {
    Eigen::Matrix<double, 3, 2> x;
    x << 0.3, 0.3 + distance, 0, 0, 0, 0;
    CHECK(check_law(HarmonicBond{2, 1}, Points<2>(x), distance) == std::vector<std::string>{});
  }
}

TEST_CASE("small strains keep all their digits", "[laws]") {
  // The row (3, 4, 0)·(1 + s) has length 5 (1 + s) exactly; s = 2⁻⁴⁰ ≈ 1e-12.
  const double s = std::ldexp(1.0, -40);
  Eigen::Matrix<double, 3, 2> x = Eigen::Matrix<double, 3, 2>::Zero();
  x.col(1) << 3 + 3 * s, 4 + 4 * s, 0;
  const HarmonicBond bond{7, 5};
  const Local<2> u = bond.derivatives(Points<2>(x));
  CHECK(u.value == Approx(7 * 25 * s * s).epsilon(8 * epsilon));
  CHECK(u.gradient[3] == Approx(2 * 7 * 5 * s * 0.6).epsilon(8 * epsilon));
  // The same strain far from the origin, where positions alone would round it away: the tails carry it.
  Points<2> far(x);
  for (int c = 0; c < 2; ++c)
    for (int i = 0; i < 2; ++i) {
      const Exact e = two_sum(1e6, x(c, i));
      far.position(c, i) = e.hi, far.low(c, i) = e.lo;
    }
  CHECK(bond.value(far) == Approx(7 * 25 * s * s).epsilon(8 * epsilon));
}

TEST_CASE("small turns and small openings keep all their digits", "[laws]") {
  const double t = std::ldexp(1.0, -40);
  const CosineAngle angle{3};
  const Local<3> u = angle.derivatives(row_with_turn(t));         // cos φ = 1/√(1 + t²)
  CHECK(u.value == Approx(3 * t * t / 2).epsilon(8 * epsilon));
  CHECK(u.gradient[7] == Approx(3 * t).epsilon(8 * epsilon));     // B sin φ/|w|
  Points<3> folded = row_with_turn(0);
  folded.position.col(2) << 0, t, 0;                              // cos θ = 1/√(1 + t²)
  const Local<3> f = angle.derivatives(folded);
  CHECK(f.value == Approx(6).epsilon(8 * epsilon));
  CHECK(f.gradient[7] == Approx(-3 * t).epsilon(8 * epsilon));
}

TEST_CASE("the edges of the domain", "[laws]") {
  Eigen::Matrix<double, 3, 2> same = Eigen::Matrix<double, 3, 2>::Constant(0.3);
  const Local<2> u = HarmonicBond{2, 0.5}.derivatives(Points<2>(same));
  CHECK(u.value == 2 * 0.25);                                     // as LAMMPS: K r₀², no force
  CHECK(u.gradient.norm() == 0);
  CHECK(u.hessian.allFinite());
  Points<3> meet = row_with_turn(0);
  meet.position.col(2) = meet.position.col(1);
  CHECK(CosineAngle{1}.value(meet) == std::numeric_limits<double>::infinity());
  CHECK(CosineAngle{1}.derivatives(meet).value == std::numeric_limits<double>::infinity());
  CHECK(CosineAngle{1}.derivatives(meet).gradient.allFinite());
}

TEST_CASE("energies do not change under rotation", "[laws]") {
  std::mt19937 random(3);
  const Mat3 turn = Eigen::AngleAxisd(1.234, Vec3(1, 2, -0.5).normalized()).toRotationMatrix();
  for (int k = 0; k < 20; ++k) {
    const Points<2> pair = random_points<2>(random, 1);
    const Points<3> triple = random_points<3>(random, 1);
    const HarmonicBond bond{2, 0.3};
    const CosineAngle angle{2};
    CHECK(bond.value(Points<2>(turn * pair.position)) == Approx(bond.value(pair)).epsilon(1e-13).margin(1e-15));
    CHECK(angle.value(Points<3>(turn * triple.position)) == Approx(angle.value(triple)).epsilon(1e-13).margin(1e-15));
  }
}

TEST_CASE("section stiffnesses are EA/2q₀ and EI/q₀", "[laws]") {
  const double E = 0.96e6, t = 1.1e-3, q0 = 0.9e-3;
  CHECK(2 * q0 * bond_stiffness(Section::cylinder, E, t, q0) == Approx(E * pi * t * t / 4).epsilon(4 * epsilon));
  CHECK(q0 * angle_stiffness(Section::cylinder, E, t, q0) == Approx(E * pi * std::pow(t, 4) / 64).epsilon(8 * epsilon));
  CHECK(2 * q0 * bond_stiffness(Section::square, E, t, q0) == Approx(E * t * t).epsilon(4 * epsilon));
  CHECK(q0 * angle_stiffness(Section::square, E, t, q0) == Approx(E * std::pow(t, 4) / 12).epsilon(8 * epsilon));
}
