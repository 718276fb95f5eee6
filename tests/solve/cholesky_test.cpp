// A supernodal factor on several cores.
#include "catch.hpp"
#include "core/interrupt.hpp"
#include "core/parallel.hpp"
#include "scratch_directory.hpp"
#include "solve/cholesky.hpp"
#include "solve/mumps.hpp"
#include "solve/ordering.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <vector>

using namespace elamin;

namespace {

// Random couplings of the unknowns, three a site, of sites on a square grid that are within `reach` of each other; 1 more on the diagonal
// than makes it diagonally dominant: the smallest eigenvalue is 1 or more (Gershgorin).
SparseMatrix grid(int rows, int reach, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> entry(-1, 1);
  const int n = 3 * rows * rows;
  std::vector<Eigen::Triplet<double>> entries;
  Vector sums = Vector::Ones(n);
  for (int p = 0; p < rows * rows; ++p)
    for (int y = p / rows; y <= std::min(rows - 1, p / rows + reach); ++y)
      for (int x = std::max(0, p % rows - reach); x <= std::min(rows - 1, p % rows + reach); ++x)
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) {
            const int i = 3 * (y * rows + x) + b, j = 3 * p + a;
            if (i <= j) continue;
            const double value = entry(random);
            entries.emplace_back(i, j, value), sums[i] += std::abs(value), sums[j] += std::abs(value);
          }
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, sums[i]);
  SparseMatrix h(n, n);
  h.setFromTriplets(entries.begin(), entries.end());
  return h;
}

struct Threads {
  int before = omp_get_max_threads();
  ~Threads() { set_threads(before); }
};

Vector solution(const SparseMatrix& h, const Vector& b, int threads) {
  set_threads(threads);
  Cholesky factor;
  factor.analyze(h);
  REQUIRE(factor.factorize(h));
  return factor.solve(b);
}

}  // namespace

// Fronts of a grid of 40 × 40 sites that reach seven rows are up to 3 · 40 · 7 unknowns wide: several tiles.
TEST_CASE("a Cholesky factor has the same bits on any number of threads", "[solve][cholesky]") {
  const Threads threads;
  for (const auto& [rows, reach] : {std::pair{12, 1}, {60, 1}, {40, 7}}) {
    CAPTURE(rows, reach);
    const SparseMatrix h = grid(rows, reach, 5);
    const Vector b = Vector::LinSpaced(h.cols(), -1, 2);
    const Vector x = solution(h, b, 1);
    const Vector r = h.selfadjointView<Eigen::Lower>() * x - b;
    // The backward error of a Cholesky solution is far below n ε (Higham 2002, §10.1); ‖H‖ is at most twice the largest diagonal entry.
    CHECK(r.norm() <= 100 * epsilon * 2 * h.diagonal().maxCoeff() * x.norm());
    for (const int count : {1, 2, 3, 4}) CHECK(solution(h, b, count) == x);
  }
}

TEST_CASE("a matrix has a Cholesky factor if and only if it is positive definite, on any number of threads", "[solve][cholesky]") {
  const Threads threads;
  SparseMatrix h = grid(40, 7, 6);
  Cholesky factor;
  factor.analyze(h);
  const Vector b = Vector::Ones(h.cols());
  std::mt19937 random(7);
  for (const int count : {1, 2, 4}) {
    set_threads(count);
    CHECK(factor.factorize(h));
    const Vector x = factor.solve(b);
    for (int k = 0; k < 5; ++k) {
      const int j = std::uniform_int_distribution<int>(0, static_cast<int>(h.cols()) - 1)(random);
      double& entry = h.coeffRef(j, j);
      const double right = entry;
      for (const double wrong : {-1.0, std::nan("")}) {
        entry = wrong;
        CHECK_FALSE(factor.factorize(h));
      }
      entry = right;
    }
    CHECK(factor.factorize(h, -0.5));                                         // all eigenvalues are 1 or more, and no diagonal entry is 10⁴
    CHECK_FALSE(factor.factorize(h, -1e4));
    CHECK(factor.factorize(h));
    CHECK(factor.solve(b) == x);
  }
}

TEST_CASE("a long factorisation ends when it is interrupted", "[solve][cholesky]") {
  const Threads threads;
  const SparseMatrix h = grid(60, 8, 8);
  Cholesky factor;
  factor.analyze(h);
  for (const int count : {1, 2}) {
    set_threads(count);
    int looks = 0;
    const std::function<bool()> asked = [&] { return ++looks > 100; };
    stop_asked = &asked;
    CHECK_FALSE(factor.factorize(h));
    CHECK(looks < 120);                                                       // then it goes no further
    stop_asked = nullptr;
    CHECK(factor.factorize(h));
  }
}

TEST_CASE("unknowns that are coupled alike are found, and an order of them is a permutation", "[solve][cholesky]") {
  const SparseMatrix h = grid(9, 1, 9);
  const std::vector<int> sets = coupled_alike(h);
  REQUIRE(sets.size() == 82);
  for (int s = 0; s <= 81; ++s) CHECK(sets[s] == 3 * s);
  std::vector<int> order = fill_reducing_order(h);
  std::sort(order.begin(), order.end());
  REQUIRE(order.size() == 243);
  for (int i = 0; i < 243; ++i) CHECK(order[i] == i);

  SparseMatrix chain(6, 6);                                                   // 0–1–2–3–4–5
  for (int i = 0; i < 6; ++i) chain.insert(i, i) = 2;
  for (int i = 0; i < 5; ++i) chain.insert(i + 1, i) = -1;
  chain.makeCompressed();
  CHECK(coupled_alike(chain) == std::vector<int>{0, 1, 2, 3, 4, 5, 6});
  CHECK(fill_reducing_order(chain).empty());
  SparseMatrix pairs(4, 4);
  for (int i = 0; i < 4; ++i) pairs.insert(i, i) = 2;
  pairs.insert(1, 0) = pairs.insert(3, 2) = -1;
  pairs.makeCompressed();
  CHECK(coupled_alike(pairs) == std::vector<int>{0, 2, 4});
}

TEST_CASE("what a factor takes is told beforehand", "[solve][cholesky]") {
  const int n = 30;
  SparseMatrix full(n, n), chain(n, n);
  for (int j = 0; j < n; ++j) {
    for (int i = j; i < n; ++i) full.insert(i, j) = 1;
    for (int i = j; i < std::min(n, j + 2); ++i) chain.insert(i, j) = 1;
  }
  full.makeCompressed(), chain.makeCompressed();
  CHECK(factor_size(full).entries == n * (n + 1) / 2);
  CHECK(factor_size(full).operations == n * (n + 1) * (2 * n + 1) / 6);
  CHECK(factor_size(chain).entries == 2 * n - 1);                              // a chain from its ends
  CHECK(factor_size(chain).operations == 4 * (n - 1) + 1);
  CHECK(factor_size(SparseMatrix(0, 0)).entries == 0);
}

TEST_CASE("a factor on disk solves as one in memory, refuses what is not positive definite, and leaves no files", "[solve][cholesky]") {
  const ScratchDirectory scratch;
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before ? before : "";
  const std::string folder = scratch / "factors";
  std::filesystem::create_directory(folder);
  setenv("TMPDIR", folder.c_str(), 1);
  const auto files = [&] { return std::distance(std::filesystem::directory_iterator(folder), {}); };
  const SparseMatrix h = grid(40, 2, 3);
  const Vector b = Vector::LinSpaced(h.rows(), -1, 1), x = solution(h, b, 1);
  {
    Mumps disk(Mumps::Kind::definite_on_disk);
    disk.analyze(h);
    REQUIRE(disk.factorize(h));
    CHECK(files() > 0);
    // Both are backward stable: errors of n ε at the most times the condition, ‖H‖₁ over the smallest eigenvalue, 1.
    double largest = 0;
    for (int j = 0; j < h.cols(); ++j) largest = std::max(largest, h.col(j).cwiseAbs().sum());
    CHECK((disk.solve(b) - x).norm() <= static_cast<double>(h.rows()) * epsilon * largest * x.norm());
    CHECK_FALSE(disk.factorize(h, -h.diagonal().mean()));
    REQUIRE(disk.factorize(h));
  }
  CHECK(files() == 0);
  before ? setenv("TMPDIR", kept.c_str(), 1) : unsetenv("TMPDIR");
}
