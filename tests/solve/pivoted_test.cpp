#include "catch.hpp"
#include "core/dense.hpp"
#include "processor_time.hpp"
#include "solve/bunch_kaufman.hpp"
#include "solve/mumps.hpp"

#include <cmath>
#include <memory>
#include <random>
#include <vector>

using namespace elamin;

namespace {

// A random symmetric band of n unknowns, indefinite, or with a zero diagonal.
SparseMatrix random_band(int n, bool hollow, std::mt19937& random) {
  std::uniform_real_distribution<double> entry(-1, 1);
  SparseMatrix h(n, n);
  for (int j = 0; j < n; ++j)
    for (int i = j; i < std::min(n, j + 6); ++i) h.insert(i, j) = i == j && hollow ? 0.0 : entry(random);
  h.makeCompressed();
  return h;
}

// What `factor` factorises, as a dense matrix.
Eigen::MatrixXd bordered(const SparseMatrix& h, double shift, const Eigen::MatrixXd& borders) {
  const Eigen::Index n = h.rows(), m = borders.cols();
  Eigen::MatrixXd whole = Eigen::MatrixXd::Zero(n + m, n + m);
  whole.topLeftCorner(n, n) = Eigen::MatrixXd(h).selfadjointView<Eigen::Lower>();
  whole.topLeftCorner(n, n).diagonal().array() += shift;
  whole.topRightCorner(n, m) = border_scale(h, shift) * borders;
  whole.bottomLeftCorner(m, n) = whole.topRightCorner(n, m).transpose();
  return whole;
}

}  // namespace

TEST_CASE("factors of indefinite matrices have their inertia and solve to rounding", "[solve][pivoted]") {
  std::mt19937 random(7);
  for (const int n : {1, 2, 3, 17, 64, 65, 150, 320})
    for (const int borders : {0, 1, 3})
      for (const bool hollow : {false, true})
        for (const bool small : {true, false}) {
          if (n <= borders || (n == 1 && hollow)) continue;
          CAPTURE(n, borders, hollow, small);
          std::unique_ptr<Factorization> factor;
          if (small) factor = std::make_unique<BunchKaufman>();
          else factor = std::make_unique<Mumps>();
          const SparseMatrix h = random_band(n, hollow, random);
          const Eigen::MatrixXd z = orthonormal(Eigen::MatrixXd::Random(n, borders));
          const double shift = hollow ? 0.0 : 0.1;
          const Eigen::MatrixXd whole = bordered(h, shift, z);
          factor->analyze(h, borders);
          REQUIRE(factor->factorize(h, shift, z));
          const Vector values = symmetric_eigen(whole).values;
          CHECK(factor->negative() == (values.array() < 0).count());
          const Eigen::MatrixXd b = Eigen::MatrixXd::Random(n, 2);
          Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n + borders, 2);
          right.topRows(n) = b;
          const Eigen::MatrixXd x = factor->solve(b), exact = solved(whole, right).topRows(n);
          // Both are wrong by the condition times what a backward-stable elimination adds to the matrix.
          const double condition = values.cwiseAbs().maxCoeff() / values.cwiseAbs().minCoeff();
          CHECK((x - exact).norm() <= 10 * (n + borders) * epsilon * condition * exact.norm());
        }
}

// A hinged chain of n links of length 1 under its first critical load: H = k T along it, T² − P T across, T = (−1, 2, −1), P the lowest eigenvalue of T.
TEST_CASE("a slender column at its critical load keeps a sparse factor beside its mode", "[solve][pivoted]") {
  const int n = 8300, dofs = 2 * n;
  const double k = 1e5, P = 2 - 2 * std::cos(pi / (n + 1));              // EA L²/EI = 7·10¹²
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(2 * i, 2 * i, 2 * k);
    entries.emplace_back(2 * i + 1, 2 * i + 1, (i == 0 || i == n - 1 ? 5 : 6) - 2 * P);
    if (i + 1 < n) entries.emplace_back(2 * i + 2, 2 * i, -k), entries.emplace_back(2 * i + 3, 2 * i + 1, -4 + P);
    if (i + 2 < n) entries.emplace_back(2 * i + 5, 2 * i + 1, 1);
  }
  SparseMatrix h(dofs, dofs);
  h.setFromTriplets(entries.begin(), entries.end());
  Eigen::MatrixXd mode = Eigen::MatrixXd::Zero(dofs, 1);
  for (int i = 0; i < n; ++i) mode(2 * i + 1, 0) = std::sqrt(2.0 / (n + 1)) * std::sin(pi * (i + 1) / (n + 1));
  Mumps factor;
  const auto seconds = [&](double shift, const Eigen::MatrixXd& borders) {
    factor.analyze(h, static_cast<int>(borders.cols()));
    const std::clock_t begin = std::clock();
    REQUIRE(factor.factorize(h, shift, borders));
    return processor_seconds(begin);
  };
  const double plain = seconds(1, {}), bordered = seconds(0, mode);
  CHECK(bordered <= 20 * plain);                                         // borders as large as k: 500 times as long
  CHECK(factor.negative() == 1);                                         // the border's
  // Along the second mode, whose eigenvalue is μ (μ − P); H and its factor are rounded by a few ε ‖T²‖, ‖T²‖ = 16.
  const double mu = 2 - 2 * std::cos(2 * pi / (n + 1));
  Vector second = Vector::Zero(dofs);
  for (int i = 0; i < n; ++i) second[2 * i + 1] = std::sqrt(2.0 / (n + 1)) * std::sin(2 * pi * (i + 1) / (n + 1));
  const Vector p = factor.solve(Vector(second * (mu * (mu - P))));
  CHECK((p - second).norm() <= 4 * 16 * epsilon / (mu * (mu - P)));
}

TEST_CASE("a singular matrix has no factor", "[solve][pivoted]") {
  SparseMatrix h(3, 3);
  h.insert(0, 0) = 1, h.insert(1, 1) = 0, h.insert(2, 2) = -2;
  h.makeCompressed();
  BunchKaufman dense;
  Mumps sparse;
  dense.analyze(h), sparse.analyze(h);
  CHECK_FALSE(dense.factorize(h));
  CHECK_FALSE(sparse.factorize(h));
  REQUIRE(dense.factorize(h, 0.5));
  CHECK(dense.negative() == 1);
}
