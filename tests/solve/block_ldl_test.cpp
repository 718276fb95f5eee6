// LDLᵀ with pivots inside of supernodes, held against dense eigenvalues and equations.
#include "catch.hpp"
#include "core/dense.hpp"
#include "matrices.hpp"
#include "solve/block_ldl.hpp"
#include "solve/pivoted.hpp"

#include <cmath>
#include <random>

using namespace elamin;

namespace {

// Springs of random stiffness between neighbours of a grid, several unknowns a node; the lower triangle with the diagonal. Motions of all by the same cost nothing.
SparseMatrix grid(int rows, int columns, int each, std::mt19937& random) {
  const int n = rows * columns * each;
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(n, n);
  std::normal_distribution<double> number;
  const auto spring = [&](int i, int j) {
    Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(each, each, [&] { return number(random); });
    a = a * a.transpose();
    for (const auto& [p, q, sign] : {std::tuple(i, i, 1), std::tuple(j, j, 1), std::tuple(i, j, -1), std::tuple(j, i, -1)})
      h.block(p * each, q * each, each, each) += sign * a;
  };
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      if (r > 0) spring(r * columns + c, (r - 1) * columns + c);
      if (c > 0) spring(r * columns + c, r * columns + c - 1);
    }
  return SparseMatrix(Eigen::MatrixXd(h.triangularView<Eigen::Lower>()).sparseView());
}

}  // namespace

TEST_CASE("an indefinite matrix has its inertia and solutions from pivots inside of supernodes", "[solve][block_ldl]") {
  std::mt19937 random(7);
  for (const auto& [rows, columns, each] : {std::tuple(2, 60, 2), std::tuple(7, 9, 3), std::tuple(14, 15, 3)}) {
    const SparseMatrix h = grid(rows, columns, each, random);
    const Eigen::MatrixXd dense = whole(h);
    const Vector values = symmetric_eigen(dense).values;
    BlockLdl factor;
    factor.analyze(h);
    REQUIRE(factor.suits());
    for (const int k : {each, each + 1, each + 6}) {
      const double shift = -(values[k] + values[k - 1]) / 2;
      CAPTURE(rows, columns, k);
      REQUIRE(factor.factorize(h, shift));
      CHECK(factor.negative() == k);
      const Eigen::MatrixXd b = Eigen::MatrixXd::Random(h.cols(), 2), x = factor.solve(b);
      // Forward and backward errors within the growth that is allowed: 8 n ε ‖H‖ ‖x‖.
      CHECK((dense * x + shift * x - b).norm() <= 8 * static_cast<double>(h.cols()) * epsilon * dense.norm() * x.norm());
    }
  }
}

TEST_CASE("borders hold what is singular, one or several parts of it", "[solve][block_ldl]") {
  std::mt19937 random(11);
  const int each = 3;
  for (const bool parts : {false, true}) {
    SparseMatrix h = grid(6, 8, each, random);
    const int n = static_cast<int>(h.cols()), all = parts ? 2 * n : n;
    if (parts) {                                                   // the same beside it, coupled to nothing
      Eigen::MatrixXd two = Eigen::MatrixXd::Zero(all, all);
      two.topLeftCorner(n, n) = two.bottomRightCorner(n, n) = Eigen::MatrixXd(h);
      h = two.sparseView();
    }
    Eigen::MatrixXd z = Eigen::MatrixXd::Zero(all, parts ? 2 * each : each);
    for (int i = 0; i < all; ++i) z(i, i % each + (i >= n ? each : 0)) = 1 / std::sqrt(n / each);
    const Eigen::MatrixXd dense = whole(h);
    for (const bool indefinite : {false, true}) {
      Vector v = Vector::Random(all);
      v -= z * (z.transpose() * v);
      v.normalize();
      PivotedFactor factor;
      const int borders = static_cast<int>(z.cols());
      factor.analyze(h, borders);
      const Vector values = symmetric_eigen(dense).values;
      const double shift = !indefinite ? 0 : -(values[borders + 2] + values[borders + 1]) / 2;
      REQUIRE(factor.factorize(h, shift, z));
      CHECK(factor.negative() == borders + (indefinite ? 2 : 0));
      const Vector p = factor.solve(v), left = dense * p + shift * p - v;
      CHECK((z.transpose() * p).norm() <= 1e-12 * p.norm());
      CHECK((left - z * (z.transpose() * left)).norm() <= 8 * all * epsilon * dense.norm() * p.norm());
    }
  }
}

TEST_CASE("a factor that pivots inside of supernodes would spoil is refused, and made with all pivots", "[solve][block_ldl]") {
  // A chain in which every other unknown has no stiffness of its own: each is a supernode, or a part of one, that has no inverse.
  const int n = 400;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, i % 2 ? 1.0 : 1e-13);
  for (int i = 1; i < n; ++i) entries.emplace_back(i, i - 1, 1.0);
  SparseMatrix h(n, n);
  h.setFromTriplets(entries.begin(), entries.end());
  const Eigen::MatrixXd dense = whole(h);
  const Vector values = symmetric_eigen(dense).values;
  BlockLdl blocks;
  blocks.analyze(h);
  CHECK_FALSE(blocks.factorize(h));
  PivotedFactor factor;
  factor.analyze(h);
  REQUIRE(factor.factorize(h));
  CHECK(factor.negative() == (values.array() < 0).count());
  const Vector b = Vector::LinSpaced(n, 1, 2), x = factor.solve(b);
  CHECK((dense * x - b).norm() <= 8 * n * epsilon * dense.norm() * x.norm());
  std::mt19937 random(3);
  SparseMatrix flat = grid(5, 30, 2, random);
  blocks.analyze(flat);
  CHECK_FALSE(blocks.factorize(flat));                             // singular to rounding
}
