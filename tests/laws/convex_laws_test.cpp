// Hessians without what compression takes from them.
#include "catch.hpp"
#include "core/dense.hpp"
#include "laws/check_law.hpp"
#include "laws/cohesion.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/harmonic_bond.hpp"
#include "laws/hertz_contact.hpp"

#include <Eigen/Eigenvalues>

using namespace elamin;

namespace {

// `leave_out`: the derivatives without a part of what compression takes.
template <int n, class LeaveOut>
void check_convex(const Local<n>& own, const LeaveOut& leave_out) {
  const Local<n> none = leave_out(0.0), half = leave_out(0.5), all = leave_out(1.0);
  const double size = own.hessian.norm();
  CHECK((none.hessian - own.hessian).norm() <= 4 * epsilon * size);
  for (const Local<n>* u : {&none, &half, &all}) {
    CHECK(u->value == own.value);
    CHECK(u->gradient == own.gradient);
    CHECK(u->hessian == u->hessian.transpose());
  }
  const double rounding = 16 * epsilon * (size + all.hessian.norm());
  CHECK((half.hessian - (none.hessian + all.hessian) / 2).norm() <= rounding);
  CHECK(symmetric_eigen(all.hessian).values[0] >= -rounding);
}

Points<3> hinge(double turn) {
  Eigen::Matrix3d x;
  x << 0, 1, 1 + std::cos(turn), 0, 0, std::sin(turn), 0, 0, 0;
  return Points<3>(x);
}

}  // namespace

TEST_CASE("Hessians without compression are positive semidefinite and near to the laws' own", "[laws]") {
  std::mt19937 random(11);
  for (const double size : {1e-3, 1.0, 1e3})
    for (int k = 0; k < 100; ++k) {
      const Points<2> pair = random_points<2>(random, size), from = random_points<2>(random, size);
      const double r = pair.edge(0, 1).hi.norm();
      for (const double rest : {0.5 * r, r, 2 * r}) {
        const HarmonicBond bond{3.5, rest};
        check_convex<2>(bond.derivatives(pair), [&](double part) { return bond.convex(pair, pair, part); });
        check_convex<2>(bond.derivatives(pair, from), [&](double part) { return bond.convex(pair, from, part); });
      }
      const HertzContact contact{2, 1.2 * r};
      check_convex<2>(contact.derivatives(pair), [&](double part) { return contact.convex(pair, part); });
      for (const CutoffStyle style : {CutoffStyle::cut, CutoffStyle::shifted, CutoffStyle::smooth})
        for (const double sigma : {1.0, 0.85, 0.75, 0.4}) {              // pushed, pulled, and less so with the distance
          const Cohesion cohesion{0.3, sigma * r, 1.5 * r, style, 0.9 * r};
          check_convex<2>(cohesion.derivatives(pair), [&](double part) { return cohesion.convex(pair, part); });
        }
      const Points<3> triple = random_points<3>(random, size);
      for (const double rest : {pi, 2.0}) {
        const CosineAngle angle{0.7, rest};
        check_convex<3>(angle.derivatives(triple), [&](double part) { return angle.convex(triple, part); });
      }
    }
}

TEST_CASE("where nothing is pressed and every angle is at rest the Hessian is its own", "[laws]") {
  const HarmonicBond bond{2, 0.5};
  Eigen::Matrix<double, 3, 2> x;
  x << 0, 1, 0, 0.2, 0, -0.3;                                     // pulled
  CHECK(bond.convex(Points<2>(x), Points<2>(x), 1).hessian == bond.derivatives(Points<2>(x)).hessian);
  for (const double turn : {0.0, 0.4}) {
    const CosineAngle in_space{3, pi - turn}, in_plane{3, pi - turn, 2};
    for (const CosineAngle& angle : {in_space, in_plane}) {
      const Local<3> own = angle.derivatives(hinge(turn));
      CHECK((angle.convex(hinge(turn), 1).hessian - own.hessian).norm() <= 16 * epsilon * own.hessian.norm());
    }
  }
}
