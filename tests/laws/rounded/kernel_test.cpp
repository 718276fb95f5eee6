#include "laws/rounded/kernel.hpp"

#include "catch.hpp"

using namespace elamin;
using Form = RoundedKernel::Form;

TEST_CASE("the kernel of rounded surfaces: slopes, jumps, what LAMMPS reports", "[laws][rounded]") {
  for (const Form form : {Form::coded, Form::printed}) {
    const RoundedKernel U{100, 4, 0.5, form};
    // quadratic pieces: central differences are exact
    for (const double gap : {-0.3, -0.01, 0.01, 0.2, 0.49, 0.6}) {
      const double h = 0.005;
      CHECK(U.slope(gap) == Approx((U.value(gap + h) - U.value(gap - h)) / (2 * h)).margin(1e-11));
      CHECK(U.curvature(gap) == Approx((U.slope(gap + h) - U.slope(gap - h)) / (2 * h)).margin(1e-11));
    }
    CHECK(U.value(0.5) == 0);
    CHECK(U.value(std::nextafter(0.5, 1)) == 0);
    CHECK(U.value(0) == Approx(-4 * 0.25 / 2).epsilon(1e-15));
    CHECK(U.value(1e-300) == Approx(U.value(0)).epsilon(1e-15));
    CHECK(U.slope(1e-300) == Approx(U.slope(0)).margin(1e-15));
  }
  const RoundedKernel coded{100, 4, 0.5, Form::coded}, printed{100, 4, 0.5, Form::printed};
  CHECK(coded.slope(-4 * 0.5 / 100) == Approx(0).margin(1e-15));       // no force at δ = −s/k_n
  CHECK(coded.slope(0.5) == 0);
  CHECK(printed.slope(0) == 0);
  CHECK(printed.slope(0.5) == 2);                                      // k_na r_c
  for (const double gap : {-0.2, 0.0, 0.3, 0.5})
    CHECK(coded.reported(gap) == Approx(coded.value(gap) + 0.5).epsilon(1e-14));
  CHECK(coded.reported(0.51) == 0);
}
