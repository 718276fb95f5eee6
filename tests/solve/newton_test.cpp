#include "catch.hpp"
#include "chain.hpp"
#include "solve/newton.hpp"

using namespace elamin;

TEST_CASE("the pivoted inertia counts negative eigenvalues", "[solve]") {
  // diag blocks [[0, 1], [1, 0]] have one negative eigenvalue each; without pivoting there is no factorisation at all.
  const int n = 40;
  SparseMatrix m(n, n);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 0.0);
  for (int i = 0; i < n; i += 2) entries.emplace_back(i + 1, i, 1.0);
  m.setFromTriplets(entries.begin(), entries.end());
  PivotedFactor factor;
  factor.analyze(m);
  REQUIRE(factor.factorize(m));
  CHECK(factor.negative() == n / 2);
  REQUIRE(factor.factorize(m, 2.0));
  CHECK(factor.negative() == 0);
  const Vector b = Vector::LinSpaced(n, 1, 2);
  REQUIRE(factor.factorize(m));
  const Vector x = factor.solve(b);
  CHECK((Eigen::MatrixXd(m).selfadjointView<Eigen::Lower>() * x - b).norm() <= 1e-14 * b.norm());
}

TEST_CASE("Cholesky says whether a matrix is positive definite", "[solve]") {
  SparseMatrix m(3, 3);
  std::vector<Eigen::Triplet<double>> entries{{0, 0, 2.0}, {1, 1, 2.0}, {2, 2, 2.0}, {1, 0, -1.0}, {2, 1, -1.0}, {2, 0, 0.0}};
  m.setFromTriplets(entries.begin(), entries.end());
  Cholesky cholesky;
  cholesky.analyze(m);
  CHECK(cholesky.factorize(m));
  CHECK((Eigen::MatrixXd(m).selfadjointView<Eigen::Lower>() * cholesky.solve(Vector(Vector::Ones(3))) - Vector::Ones(3)).norm() < 32 * epsilon);
  CHECK_FALSE(cholesky.factorize(m, -0.6));        // eigenvalues 2 − √2 = 0.586, 2, 2 + √2
  CHECK(cholesky.factorize(m, -0.58));
}

TEST_CASE("the lowest eigenpairs, multiple ones too", "[solve]") {
  Model model = chain(30, round_bond, round_angle, 1);
  hold(model, 0, 1), hold(model, 28, 29);
  Energy energy(model);
  energy.evaluate(model.start);
  Factors factors(energy);
  const EigenPairs pairs = factors.lowest(6);
  const Eigen::MatrixXd H = Eigen::MatrixXd(energy.hessian()).selfadjointView<Eigen::Lower>();
  const EigenPairs dense = symmetric_eigen(H);
  for (int j = 0; j < 6; ++j) {
    CHECK(std::abs(pairs.values[j] - dense.values[j]) <= 64 * epsilon * H.norm());
    CHECK((H * pairs.vectors.col(j) - pairs.values[j] * pairs.vectors.col(j)).norm() <= 1e-5 * pairs.values[5]);
  }
  CHECK(pairs.values[0] == Approx(pairs.values[1]).epsilon(1e-9));      // x and y
  CHECK((pairs.vectors.transpose() * pairs.vectors - Eigen::MatrixXd::Identity(6, 6)).norm() < 1e-12);
}

TEST_CASE("the lowest of many eigenvalues that lie close to each other", "[solve]") {
  constexpr int n = 300;                                        // springs along x, each with a particle: H = diag(1 + j/1000)
  Model model = chain(2 * n, 1, 1, 1, Vec3::UnitX());
  model.angles.clear(), model.bonds.clear(), model.bond_types.clear();
  for (int j = 0; j < n; ++j) {
    model.bond_types.push_back({(1 + j / 1000.0) / 2, 1});
    model.bonds.push_back({j, {2 * j, 2 * j + 1}});
    hold(model, 2 * j, 2 * j), hold(model, 2 * j + 1, 2 * j + 1, {false, true, true});
  }
  Energy energy(model);
  energy.evaluate(model.start);
  const EigenPairs pairs = Factors(energy).lowest(3);
  for (int j = 0; j < 3; ++j) {
    // A round that moves a value by 1e-11, where lowest() ends, comes nearer by 1 − (1.002/1.007)² = 1 %: a hundred of them may be left.
    CHECK(std::abs(pairs.values[j] - (1 + j / 1000.0)) <= 1e-9);
    CHECK(std::abs(pairs.vectors(j, j)) >= 1 - 1e-6);                   // what a vector's square lacks of 1 is as much over 1e-3
  }
}

TEST_CASE("a minimum is found from far away, at any scale", "[solve]") {
  for (const double length : {1e-3, 1.0, 1e3})
    for (const double modulus : {1.0, 1e11}) {
      Model model = chain(20, round_bond * modulus * length, round_angle * modulus * length * length * length, length, Vec3::UnitX());
      hold(model, 0, 1);
      model.loads.push_back({"", {19}, Vec3(0, 0.02, -0.01) * modulus * length * length * round_angle, Scaling()});
      Energy energy(model);
      Newton newton(energy);
      State state = model.start;
      energy.kinematics().prescribe(state, 1);
      const Report report = newton.minimise(state);
      REQUIRE(report.converged());
      CHECK(report.negative == 0);
      CHECK(report.residual <= 1e-13);
      CHECK(report.iterations <= 12);
    }
}

TEST_CASE("slenderness costs no iterations and no digits", "[solve]") {
  // Cantilevers under PL²/EI = 2 at the tip: stretching N² times stiffer than bending.
  std::vector<int> iterations;
  for (const int n : {20, 200, 2000}) {
    Model model = chain(n + 2, round_bond, round_angle, 1, Vec3::UnitX());
    model.plane_normal = 2;
    hold(model, 0, 1);
    const double L = n + 0.5;
    model.loads.push_back({"", {n + 1}, Vec3(0, 2 * round_angle / (L * L), 0), Scaling()});
    Energy energy(model);
    Newton newton(energy);
    State state = model.start;
    energy.kinematics().prescribe(state, 1);
    const Report report = newton.minimise(state);
    REQUIRE(report.converged());
    CHECK(report.residual <= 1e-13);
    // Elastica: w/L = 0.4934575 (Mattiasson 1981), approached as 1/N² (and by the stretch, PL²/EI/(16 N²)·…).
    CHECK(state.position(1, n + 1) / L == Approx(0.4934575).epsilon(3.0 / (n * n) + 3e-7));
    iterations.push_back(report.iterations);
  }
  CHECK(iterations[2] <= iterations[0] + 3);
}

TEST_CASE("a saddle is left, a stationary point is kept", "[solve]") {
  Model model = chain(24, round_bond, round_angle, 1);
  model.plane_normal = 1;
  hold(model, 0, 1), hold(model, 22, 23, {true, true, true}, Vec3(0, 0, -0.4));
  Energy energy(model);
  Newton newton(energy);
  State state = model.start;
  energy.kinematics().prescribe(state, 1);
  const Report straight = newton.correct(state);
  REQUIRE(straight.converged());
  energy.evaluate(state);
  CHECK(newton.factors().inertia().negative > 0);
  CHECK(state.position.row(0).cwiseAbs().maxCoeff() == 0);
  const double before = energy.value(state);
  const Report fallen = newton.minimise(state);
  REQUIRE(fallen.converged());
  CHECK(fallen.negative == 0);
  CHECK(energy.value(state) < before);
  CHECK(state.position.row(0).cwiseAbs().maxCoeff() > 1);
}

TEST_CASE("what cannot converge says so", "[solve]") {
  Model model = chain(20, round_bond, round_angle, 1, Vec3::UnitX());
  hold(model, 0, 1);
  model.loads.push_back({"", {21 - 2}, Vec3(0, 1, 0), Scaling()});
  Energy energy(model);
  Newton newton(energy, {.tolerance = 1e-10, .max_iterations = 2});
  State state = model.start;
  energy.kinematics().prescribe(state, 1);
  const Report report = newton.minimise(state);
  CHECK(report.status == Status::not_converged);
  CHECK(report.why.find("2 iterations were not enough") == 0);
  CHECK(std::isfinite(report.residual));
}
