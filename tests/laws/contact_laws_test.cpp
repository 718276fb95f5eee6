#include "catch.hpp"
#include "laws/check_law.hpp"
#include "laws/cohesion.hpp"
#include "laws/hertz_contact.hpp"

using namespace elamin;

namespace {

Points<2> apart(double distance) {            // along (3, 4, 0)/5, away from the origin
  Points<2> x;
  x.position.col(0) << 0.7, -1.1, 0.4;
  for (int c = 0; c < 2; ++c) {
    const Exact e = two_sum(x.position(c, 0), distance * (3 + c) / 5);
    x.position(c, 1) = e.hi, x.low(c, 1) = e.lo;
  }
  x.position(2, 1) = 0.4;
  return x;
}

// Hertz's contact whose force has the power of the overlap wrong by a hair.
struct WrongContact {
  static constexpr int sites = 2;
  HertzContact right{3, 1};
  double value(const Points<2>& x) const { return right.value(x); }
  Local<2> derivatives(const Points<2>& x) const {
    Local<2> u = right.derivatives(x);
    u.gradient *= std::pow(-right.gap(x), 1e-6);
    return u;
  }
};

}  // namespace

TEST_CASE("Hertz's contact agrees with differences of its value", "[laws][contact]") {
  for (const double size : {1e-3, 1.0, 1e3})
    for (const double modulus : {1.0, 1e11})
      for (const double overlap : {1e-6, 1e-3, 0.1, 0.5, 0.9}) {
        INFO("size " << size << ", overlap " << overlap);
        const double r0 = 0.5 * size, r1 = 0.3 * size, contact_distance = r0 + r1;
        const HertzContact contact{hertz_stiffness(modulus, r0, r1), contact_distance};
        const Points<2> x = apart(contact_distance * (1 - overlap));
        CHECK(check_law(contact, x, std::min(overlap, 1 - overlap) * contact_distance) == std::vector<std::string>{});
        // 8/15 E √R δ^{5/2} and 4/3 E √R δ^{3/2} as they are printed
        const double R = r0 * r1 / (r0 + r1), delta = -contact.gap(x);
        CHECK(delta == Approx(overlap * contact_distance).epsilon(1e-9));
        const double energy = 8.0 / 15 * modulus * std::sqrt(R) * std::pow(delta, 2.5);
        const double force = 4.0 / 3 * modulus * std::sqrt(R) * std::pow(delta, 1.5);
        CHECK(contact.value(x) == Approx(energy).epsilon(16 * epsilon));
        CHECK(contact.force(-delta) == Approx(force).epsilon(16 * epsilon));
        CHECK(contact.derivatives(x).gradient.head<3>().norm() == Approx(contact.force(-delta)).epsilon(8 * epsilon));
      }
}

TEST_CASE("small overlaps keep all their digits", "[laws][contact]") {
  const double s = std::ldexp(1.0, -40);                          // the row (3, 4, 0)(1 − s) is 5 (1 − s) long exactly
  Eigen::Matrix<double, 3, 2> x = Eigen::Matrix<double, 3, 2>::Zero();
  x.col(1) << 3 - 3 * s, 4 - 4 * s, 0;
  const HertzContact contact{7, 5};
  CHECK(-contact.gap(Points<2>(x)) == Approx(5 * s).epsilon(4 * epsilon));
  CHECK(contact.derivatives(Points<2>(x)).gradient[3] == Approx(-7 * std::pow(5 * s, 1.5) * 0.6).epsilon(16 * epsilon));
}

TEST_CASE("spheres that do not overlap feel nothing", "[laws][contact]") {
  const HertzContact contact{7, 1};
  for (const double distance : {1.0, 1 + 1e-15, 1.5, 1e9}) {
    Eigen::Matrix<double, 3, 2> x = Eigen::Matrix<double, 3, 2>::Zero();
    x(1, 1) = distance;
    const Local<2> u = contact.derivatives(Points<2>(x));
    CHECK(contact.gap(Points<2>(x)) == Approx(distance - 1).margin(0));
    CHECK(contact.value(Points<2>(x)) == 0);
    CHECK(u.value == 0);
    CHECK(u.gradient.norm() == 0);
    CHECK(u.hessian.norm() == 0);
    CHECK(contact.force(contact.gap(Points<2>(x))) == 0);
  }
}

TEST_CASE("spheres whose centres meet have a finite energy and no direction", "[laws][contact]") {
  const HertzContact contact{7, 2};
  const Points<2> x(Eigen::Matrix<double, 3, 2>(Eigen::Matrix<double, 3, 2>::Constant(0.3)));
  const Local<2> u = contact.derivatives(x);
  CHECK(u.value == Approx(0.4 * 7 * std::pow(2, 2.5)).epsilon(8 * epsilon));
  CHECK(u.value == contact.value(x));
  CHECK(u.gradient.norm() == 0);
  CHECK(u.hessian.allFinite());
  CHECK(u.hessian == u.hessian.transpose());
}

TEST_CASE("cohesion agrees with differences of its value", "[laws][contact]") {
  std::mt19937 random(7);
  for (const double size : {1e-3, 1.0, 1e3})
    for (const double depth : {1e-7, 1.0, 1e6})
      for (const double distance : {0.3, 0.9, 1.0, 1.0 + 1e-9, std::pow(2, 1.0 / 6), 1.2445, 1.7, 2.4}) {
        INFO("size " << size << ", distance " << distance);
        const Cohesion cohesion{depth, size, 2.5 * size};
        const Points<2> x = apart(distance * size);
        CHECK(check_law(cohesion, x, std::min(distance, 1.0) * size / 5) == std::vector<std::string>{});
        const double s = std::pow(size / x.edge(0, 1).hi.norm(), 6);
        CHECK(cohesion.value(x) == Approx(4 * depth * (s * s - s)).epsilon(1e-14).margin(1e-14 * depth));
      }
}

TEST_CASE("cohesion that ends smoothly, or is shifted, agrees with differences of its value", "[laws][contact]") {
  for (const double size : {1e-3, 1.0, 1e3})
    for (const double depth : {1e-7, 1e6})
      for (const double distance : {0.9, 1.1, 1.7, 1.95, 2.05, 2.2, 2.4}) {
        INFO("size " << size << ", distance " << distance);
        const Points<2> x = apart(distance * size);
        for (const CutoffStyle style : {CutoffStyle::shifted, CutoffStyle::smooth})
          CHECK(check_law(Cohesion{depth, size, 2.5 * size, style, 2 * size}, x, std::min(size / 50, std::abs(distance - 2) * size / 5)) == std::vector<std::string>{});
      }
}

// LAMMPS's own coefficients of the shell (pair_lj_smooth.cpp): force C1 + C2 t + C3 t² + C4 t³, t = r − inner.
TEST_CASE("smooth cohesion is LAMMPS's lj/smooth, shifted", "[laws][contact]") {
  const double e = 0.7, size = 1.1, inner = 2.2, cutoff = 3, width = cutoff - inner;
  const Cohesion smooth{e, size, cutoff, CutoffStyle::smooth, inner}, cut{e, size, cutoff};
  Local<2> at_inner = cut.derivatives(apart(inner));
  const auto along = [](const Points<2>& x) { return x.edge(0, 1).hi.normalized(); };
  const Vec3 n = along(apart(inner));
  const double c1 = -at_inner.force_part(1).dot(n), c2 = -n.dot(at_inner.block(1, 1) * n);
  const double c3 = -3 / (width * width) * (c1 + 2.0 / 3 * c2 * width), c4 = -1 / (3 * width * width) * (c2 + 2 * c3 * width);
  const auto work = [&](double t) { return t * (c1 + t * (c2 / 2 + t * (c3 / 3 + t * c4 / 4))); };
  const double scale = std::abs(c1) * width;
  for (const double r : {2.2, 2.3, 2.6, 2.9, 2.999, 3.0}) {
    INFO("r = " << r);
    const double t = r - inner, force = c1 + t * (c2 + t * (c3 + t * c4));
    Local<2> u = smooth.derivatives(apart(r));
    CHECK(std::abs(-u.force_part(1).dot(along(apart(r))) - force) <= 1e-13 * std::abs(c1));
    CHECK(std::abs(smooth.value(apart(r)) - (work(width) - work(t))) <= 1e-13 * scale);
  }
  const double shift = cut.value(apart(inner)) - work(width);     // continuous where the shell begins
  CHECK(std::abs(smooth.value(apart(1.3)) - (cut.value(apart(1.3)) - shift)) <= 1e-14 * e);
  const Cohesion shifted{e, size, cutoff, CutoffStyle::shifted};
  CHECK(std::abs(shifted.value(apart(1.3)) - (cut.value(apart(1.3)) - cut.value(apart(cutoff * (1 - 1e-16))))) <= 1e-14 * e);
}

TEST_CASE("cohesion: zero at sigma, minus epsilon at its minimum, nothing beyond the cutoff", "[laws][contact]") {
  const auto at = [](double distance) {
    Eigen::Matrix<double, 3, 2> x = Eigen::Matrix<double, 3, 2>::Zero();
    x(2, 1) = distance;
    return Points<2>(x);
  };
  const Cohesion cohesion{3, 1, 2};
  CHECK(cohesion.value(at(1)) == 0);
  const double t = std::ldexp(1.0, -40);                          // 4 ε (s² − s) = −24 ε t to first order in r = σ(1 + t)
  CHECK(cohesion.value(at(1 + t)) == Approx(-24 * 3 * t).epsilon(20 * t));
  CHECK(cohesion.value(at(std::pow(2, 1.0 / 6))) == Approx(-3).epsilon(4 * epsilon));
  CHECK(cohesion.value(at(2 - 1e-9)) < -0.1);
  for (const double distance : {2.0, 2.5, 1e200}) {
    const Local<2> u = cohesion.derivatives(at(distance));
    CHECK(cohesion.value(at(distance)) == 0);
    CHECK(u.value == 0);
    CHECK(u.gradient.norm() == 0);
    CHECK(u.hessian.norm() == 0);
  }
  for (const double distance : {0.0, 1e-160, 1e-60}) {             // the sites meet, or nearly: no NaN
    const Local<2> u = cohesion.derivatives(at(distance));
    CHECK(u.value == std::numeric_limits<double>::infinity());
    CHECK(cohesion.value(at(distance)) == u.value);
    CHECK(u.gradient.allFinite());
    CHECK(u.hessian.allFinite());
  }
  for (const Cohesion& none : {Cohesion{0, 1, 2}, Cohesion{1, 0, 2}, Cohesion{1, 1, 0}}) {
    CHECK(none.value(at(0)) == 0);
    CHECK(none.derivatives(at(0)).hessian.norm() == 0);
  }
}

TEST_CASE("a wrong contact fails the check", "[laws][contact]") {
  CHECK_FALSE(check_law(WrongContact{}, apart(0.9), 0.1).empty());
}
