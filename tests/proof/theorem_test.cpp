// Proofs about structures whose answers are known, and matrices whose eigenvalues are.
#include "catch.hpp"
#include "chain.hpp"
#include "core/dense.hpp"
#include "proof/inertia.hpp"
#include "proof/theorem.hpp"

#include <random>

using namespace elamin;

namespace {

SparseMatrix lower(const Eigen::MatrixXd& full) { return Eigen::MatrixXd(full.triangularView<Eigen::Lower>()).sparseView(); }

Eigen::MatrixXd second_differences(int n) {
  Eigen::MatrixXd A = 2 * Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i + 1 < n; ++i) A(i, i + 1) = A(i + 1, i) = -1;
  return A;
}

/// Hencky's chain between hinges in the plane xz: N links of unit length at rest under the force P, and its straight state.
struct Hinged {
  static constexpr int N = 10;
  static constexpr double K = 400, B = 1;
  Model model = chain(N + 1, K, B, 1);
  State state;
  double a;

  /// P with P a = 4B sin²(mπ/(2N)), a = 1 − P/(2K), times `part`.
  static double critical(int m, double part = 1) {
    const double s = std::sin(m * pi / (2 * N)), Pa = 4 * B * s * s;
    return part * (K - std::sqrt(K * K - 2 * K * Pa));
  }
  explicit Hinged(double P) : a(1 - P / (2 * K)) {
    model.plane_normal = 1;
    hold(model, 0, 0), hold(model, N, N, {true, true, false});
    model.loads.push_back({"", {N}, Vec3(0, 0, -P), Scaling::constant()});
    state = model.start;
    for (int i = 0; i <= N; ++i) state.set(i, ExactVector{Vec3(0, 0, i * a), Vec3::Zero()});
  }
  /// Of ∂²E/∂x∂x across the chain: B/a² μ² − P/a μ, μ = 2 − 2 cos(kπ/N).
  std::vector<double> across() const {
    std::vector<double> all;
    for (int k = 1; k < N; ++k) {
      const double mu = 2 - 2 * std::cos(k * pi / N), P = 2 * K * (1 - a);
      all.push_back(B / (a * a) * mu * mu - P / a * mu);
    }
    return all;
  }
  proof::Theorem proof() const {
    std::string not_covered;
    const proof::Structure s = proof::structure_of(model, state, not_covered);
    REQUIRE(not_covered.empty());
    return proof::prove(s, state);
  }
};

}  // namespace

TEST_CASE("inertia of second differences between their eigenvalues", "[proof]") {
  const int n = 60;
  const auto eigenvalue = [&](int k) { return 2 - 2 * std::cos(k * pi / (n + 1)); };
  for (const int k : {0, 1, 2, 17, 30}) {
    const double shift = k == 0 ? 0 : eigenvalue(k) + 0.3 * (eigenvalue(k + 1) - eigenvalue(k));    // the nearer one is the k-th
    const double nearest = k == 0 ? eigenvalue(1) : shift - eigenvalue(k);
    const proof::Spectrum s = proof::spectrum_near_zero(lower(second_differences(n) - shift * Eigen::MatrixXd::Identity(n, n)));
    CHECK(s.negative == k);
    CHECK(s.least > 0.4 * nearest);
    CHECK(s.least <= nearest * (1 + 1e-10));                       // the closed form has rounding of its own, the shift, too
  }
  Eigen::MatrixXd neumann = second_differences(n);                 // 0 is an eigenvalue, and all entries are whole numbers
  neumann(0, 0) = neumann(n - 1, n - 1) = 1;
  CHECK(proof::spectrum_near_zero(lower(neumann)).least == 0);
}

TEST_CASE("the inertia of random matrices is right wherever it is told", "[proof]") {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  int told = 0;
  for (int k = 0; k < 200; ++k) {
    const int n = 2 + k % 13;
    Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(n, n, [&] { return normal(random); });
    A = (A + A.transpose()).eval();
    if (k % 4 == 0) A(0, 0) = 1e-14;                               // a pivot that without exchanges ruins the factor
    const Vector values = symmetric_eigen(A).values;
    const proof::Spectrum s = proof::spectrum_near_zero(lower(A));
    if (s.least == 0) continue;
    ++told;
    CHECK(s.negative == (values.array() < 0).count());
    CHECK(s.least <= values.cwiseAbs().minCoeff() + 1e-13 * values.cwiseAbs().maxCoeff());
  }
  CHECK(told >= 140);
  const proof::Spectrum small = proof::spectrum_near_zero(lower(Eigen::Matrix2d{{1e-20, 1}, {1, 1e-20}}));   // eigenvalues ±1
  CHECK(small.negative == 1);
  CHECK(small.least <= 1);
  CHECK(proof::spectrum_near_zero(lower(Eigen::Matrix2d{{0, 1}, {1, 0}})).least == 0);                        // no factor without exchanges
}

TEST_CASE("a straight chain is proven a minimum below its load and a saddle of each index above", "[proof]") {
  for (const auto& [P, negative] : {std::pair(0.0, 0), {Hinged::critical(1, 0.99), 0}, {Hinged::critical(1, 1.01), 1},
                                    {Hinged::critical(2, 1.1), 2}, {Hinged::critical(4, 1.05), 4}}) {
    const Hinged chain(P);
    const proof::Theorem t = chain.proof();
    INFO(P << ": " << t.why_not);
    REQUIRE(t.holds);
    CHECK(t.negative == negative);
    double nearest = HUGE_VAL;
    for (const double value : chain.across()) nearest = std::min(nearest, std::abs(value));
    CHECK(t.inverse * nearest >= 1 - 1e-9);                        // a bound of ‖H⁻¹‖ …
    CHECK(t.inverse * nearest < 1.2);                              // … that is not far from it: σ is 0.9 of the estimate
    CHECK(t.inverse * t.change < 1);
    CHECK(t.moved + t.error <= t.radius);
    CHECK(t.moved < 1e-13);                                        // the state is that of a in doubles: 10 · 2⁻⁵³ along the chain
  }
}

TEST_CASE("what cannot be proven is not", "[proof]") {
  for (const int m : {1, 2, 3}) {                                  // critical points
    const proof::Theorem t = Hinged(Hinged::critical(m)).proof();
    CHECK_FALSE(t.holds);
    CHECK(t.why_not.find("singular") != std::string::npos);
  }
  Hinged moved(Hinged::critical(1, 0.5));                          // from where the ball of the equilibrium does not reach
  for (const double by : {1e-3, 1e-2}) {
    moved.state.position(0, 5) = by;
    CHECK_FALSE(moved.proof().holds);
  }
  Hinged free(0);                                                  // a motion along the plane costs nothing
  free.model.supports.clear();
  CHECK_FALSE(free.proof().holds);
}

TEST_CASE("a state a little away is proven to be that near", "[proof]") {
  Hinged chain(Hinged::critical(1, 0.5));
  const double by = 1e-8;
  chain.state.position(0, 5) = by;
  const proof::Theorem t = chain.proof();
  INFO(t.why_not);
  REQUIRE(t.holds);
  CHECK(t.moved == Approx(by).epsilon(1e-6));                      // |x̄ − state| is `by` but for the square of it
  CHECK(t.error < 1e-20);
}

TEST_CASE("contacts are proven closed or open, and one that just touches is not decided", "[proof]") {
  for (const double by : {-1e-12, 0.0, 1e-12}) {                   // between the particles, of radius 1/2, and a wall beside the chain
    Hinged chain(Hinged::critical(1, 0.5));
    Wall wall;
    wall.name = "beside", wall.particles = numbers(Hinged::N + 1), wall.effective_modulus = 1e-3;
    wall.region.normal = Vec3::UnitX(), wall.region.center = Vec3(-0.5 - by, 0, 0);
    chain.model.walls = {wall};
    const proof::Theorem t = chain.proof();
    INFO(by << ": " << t.why_not);
    REQUIRE(t.holds);                                              // the stiffness of Hertz's contact begins with 0: H is continuous
    CHECK(t.negative == 0);
    const auto all = static_cast<std::size_t>(Hinged::N + 1);
    CHECK(t.closed.size() == (by < 0 ? all : 0));
    CHECK(t.undecided.size() == (by == 0 ? all : 0));
    CHECK(t.open.size() == (by > 0 ? all : 0));
  }
}

// Both overlaps δ: H = 3/2 k √δ (n₁n₁ᵀ + n₂n₂ᵀ), whose eigenvalues are 3/2 k √δ (1 ± n₁·n₂).
TEST_CASE("a ball that nothing but two inclined walls holds is proven a minimum, with their stiffness", "[proof]") {
  constexpr double delta = 1e-3, radius = 0.5;
  const std::array<Vec3, 2> normals{Vec3(1, 0, 1).normalized(), Vec3(-1, 0, 2).normalized()};
  const double k = 4.0 / 3 * std::sqrt(radius), least = 1.5 * k * std::sqrt(delta) * (1 - std::abs(normals[0].dot(normals[1])));
  Model model = chain(1, 1, 1, 2 * radius);
  model.plane_normal = 1;
  for (const Vec3& n : normals) {
    Wall wall;
    wall.name = "wedge", wall.particles = {0}, wall.effective_modulus = 1;
    wall.region.normal = n, wall.region.center = (delta - radius) * n;
    model.walls.push_back(wall);
  }
  model.loads.push_back({"", {0}, -k * std::pow(delta, 1.5) * (normals[0] + normals[1]), Scaling::constant()});
  std::string not_covered;
  const proof::Structure s = proof::structure_of(model, model.start, not_covered);
  REQUIRE(not_covered.empty());
  const proof::Theorem t = proof::prove(s, model.start);
  INFO(t.why_not);
  REQUIRE(t.holds);
  CHECK(t.negative == 0);
  CHECK(t.shift == Approx(0.9 * least).epsilon(1e-9));
  CHECK(t.inverse >= 1 / least);
}
