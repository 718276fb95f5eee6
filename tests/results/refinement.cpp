// The value without particles, of sequences whose limit and errors are known.
#include "catch.hpp"
#include "results/refinement.hpp"

#include <cmath>

namespace {

using namespace elamin;

/// 1 + Σ c h^p at h = 1, 1/b, …
std::vector<double> sequence(double by, int levels, const std::vector<std::pair<double, double>>& terms) {
  std::vector<double> f;
  for (int k = 0; k < levels; ++k) {
    double value = 1;
    for (const auto& [c, p] : terms) value += c * std::pow(by, -k * p);
    f.push_back(value);
  }
  return f;
}

}  // namespace

TEST_CASE("A power of the spacing is taken out, and what is left bounds the error", "[refine]") {
  for (const double by : {2.0, 3.0})
    for (const int p : {1, 2, 4}) {
      const auto f = sequence(by, 3, {{0.1, p}, {0.01, p + 2}});
      const Extrapolated limit = extrapolate(f, by, 1e-16);
      CHECK(limit.approach == Approach::asymptotic);
      CHECK(std::abs(*limit.order - p) < 0.2);
      CHECK(std::abs(limit.value - 1) <= *limit.error);
      CHECK(*limit.error < 0.3 * std::abs(f[2] - f[1]));
      // The error is (b^q − 1) times the one that is left, to what comes after.
      CHECK(*limit.error / std::abs(limit.value - 1) == Approx(std::pow(by, p + 2) - 1).epsilon(1e-6));
    }
}

TEST_CASE("With more levels orders are taken out one after another", "[refine]") {
  const auto f = sequence(2, 4, {{0.1, 2}, {0.01, 4}, {0.001, 6}});
  const Extrapolated limit = extrapolate(f, 2, 1e-16);
  CHECK(limit.approach == Approach::asymptotic);
  const double romberg[] = {(4 * f[2] - f[1]) / 3, (4 * f[3] - f[2]) / 3};
  CHECK(limit.value == Approx((16 * romberg[1] - romberg[0]) / 15).epsilon(1e-15));
  CHECK(std::abs(limit.value - 1) <= *limit.error);
  CHECK(*limit.error < 2e-5);
}

TEST_CASE("Where two terms nearly cancel no order is taken that is too high", "[refine]") {
  // A beam clamped at both ends that a load and a moved end bend: where its middle is. Once the square is taken out the differences fall by 2^8.
  const std::vector<double> measured{0.508167818960, 0.507926473506, 0.507869469687, 0.507855232027, 0.507851645085, 0.507850743122};
  const Extrapolated four = extrapolate({measured.begin(), measured.begin() + 4}, 2, 1e-11), six = extrapolate(measured, 2, 1e-11);
  CHECK(std::abs(four.value - six.value) <= *four.error);
  CHECK(*four.error < 1e-6);
  CHECK(*six.error < 1e-7);
  const auto f = sequence(2, 4, {{0.1, 2}, {-0.004, 4}, {0.015, 6}});
  const Extrapolated limit = extrapolate(f, 2, 1e-16);
  CHECK(limit.approach == Approach::asymptotic);
  CHECK(std::abs(limit.value - 1) <= *limit.error);
  CHECK(*limit.error < 0.1 * std::abs(f[3] - f[2]));
}

TEST_CASE("What has no whole order gets a wider error, or none", "[refine]") {
  const Extrapolated half = extrapolate(sequence(2, 3, {{0.1, 0.5}}), 2, 1e-16);
  CHECK(half.approach == Approach::not_asymptotic);
  CHECK(*half.order == Approx(0.5));
  CHECK(std::abs(half.value - 1) <= *half.error);
  const Extrapolated turning = extrapolate({1.1, 0.95, 1.025}, 2, 1e-16);          // 1 ± 0.1/2^k
  CHECK(turning.approach == Approach::not_asymptotic);
  CHECK_FALSE(turning.order);
  CHECK(std::abs(turning.value - 1) <= *turning.error);
  for (const std::vector<double>& f : {std::vector{1.0, 1.1, 1.3}, {1.0, 1.1, 0.95}, {1.0, 1.1, 1.2}, {1.0, 1.1, 1.19}}) {
    const Extrapolated none = extrapolate(f, 2, 1e-16);
    CHECK(none.approach == Approach::none);
    CHECK_FALSE(none.error);
    CHECK(none.value == f.back());
  }
}

TEST_CASE("What differs by rounding is as exact as that", "[refine]") {
  const Extrapolated same = extrapolate({3, 3, 3}, 2, 1e-12);
  CHECK(same.approach == Approach::rounding);
  CHECK(same.value == 3);
  CHECK(*same.error == Approx(3e-12));
  CHECK_FALSE(same.order);
  const auto f = sequence(2, 5, {{1e-3, 2}});                                       // the second sequence is rounding: no second order is looked for
  const Extrapolated exact = extrapolate(f, 2, 1e-13);
  CHECK(exact.approach == Approach::asymptotic);
  CHECK(*exact.error == Approx(3e-13));
  CHECK(std::abs(exact.value - 1) <= *exact.error);
}

TEST_CASE("Numbers are written with the digits that their error leaves", "[refine]") {
  CHECK(value_and_error({1.23456789, 1.2e-4, {}, Approach::asymptotic}) == "1.23457 ± 0.00012");
  CHECK(value_and_error({897.29496290389989, 0.0002, {}, Approach::asymptotic}) == "897.29496 ± 0.0002");
  CHECK(value_and_error({2, {}, {}, Approach::none}) == "2");
}
