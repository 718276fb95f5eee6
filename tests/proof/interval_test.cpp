#include "catch.hpp"
#include "proof/interval.hpp"

#include <random>

using namespace elamin;

namespace {

using D = Interval<double>;
using Q = Interval<Quad>;

bool holds(const D& in, Quad x) { return Quad(in.lo) <= x && x <= Quad(in.hi); }

// Not wider than what four units in the last place on each side, and the rounding of the operation, make.
bool tight(const D& in, double x) { return in.hi - in.lo <= 16 * 0x1p-53 * std::abs(x); }

}  // namespace

TEST_CASE("intervals hold what exact arithmetic gives, and little more", "[proof]") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> digits(-2, 2), exponent(-60, 60);
  for (int k = 0; k < 20000; ++k) {
    const auto any = [&] { return std::ldexp(digits(random), static_cast<int>(exponent(random))); };
    const double a = any(), b = any();
    const Quad A = a, B = b;                                       // of doubles a product is exact in 113 bits, the rest good to 2⁻¹¹³
    CHECK(holds(D(a) + D(b), A + B));
    CHECK(holds(D(a) - D(b), A - B));
    CHECK(holds(D(a) * D(b), A * B));
    CHECK(holds(D(a) / D(b), A / B));
    CHECK(holds(square(D(a)), A * A));
    CHECK(tight(D(a) * D(b), a * b));
    CHECK(tight(D(a) / D(b), a / b));
    const D root = sqrt(D(std::abs(a)));
    CHECK(Quad(root.lo) * Quad(root.lo) <= Quad(std::abs(a)));
    CHECK(Quad(root.hi) * Quad(root.hi) >= Quad(std::abs(a)));
    CHECK(tight(root, std::sqrt(std::abs(a))));
  }
}

TEST_CASE("intervals of 113 bits hold identities to 2⁻¹⁰⁸", "[proof]") {
  for (int k = 1; k < 200; ++k) {
    const Q x(k), third = x / Q(3), root = sqrt(x);
    for (const auto& [in, is] : {std::pair(third * Q(3), Quad(k)), {root * root, Quad(k)}, {square(root), Quad(k)}}) {
      CHECK(bool(in.lo <= is && is <= in.hi));
      CHECK(static_cast<double>(in.hi - in.lo) <= k * 0x1p-108);
    }
    CHECK(bool(D(third).lo <= double(third.lo) && double(third.hi) <= D(third).hi));
  }
}

TEST_CASE("boxes hold all that is in them", "[proof]") {
  const D a(-1, 2), b(3, 5);
  CHECK((a * b).lo <= -5);
  CHECK((a * b).hi >= 10);
  CHECK(square(a).lo == 0);
  CHECK(square(a).hi >= 4);
  CHECK(positive(a) == D(0, 2));
  CHECK(sqrt(D(0, 4)).lo == 0);
  CHECK(sqrt(D(0, 4)).hi >= 2);
  CHECK(sqrt(D(0)) == D(0));
  CHECK((-b) == D(-5, -3));
}

TEST_CASE("where there is no bound there is none", "[proof]") {
  const D all = D::all(), zero(0);
  for (const D& x : {D(1) / D(-1, 1), D(1) / zero, D(1e308) * D(10), D(1e308) + D(1e308), all * zero, all - all, all / D(2),
                     sqrt(D(-2, -1)), sqrt(all)}) {
    CHECK(x.mag() == HUGE_VAL);
    CHECK_FALSE(x.bounded());
    CHECK_FALSE((x + D(1)).bounded());
    CHECK_FALSE((x * zero).bounded());
  }
  CHECK((D(1e-300) * D(1e-300)).lo <= 0);                          // underflow
  CHECK((D(1e-300) * D(1e-300)).hi > 0);
}
