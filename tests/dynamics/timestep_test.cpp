#include "catch.hpp"
#include "chain.hpp"
#include "dynamics/timestep.hpp"
#include "dynamics/verlet.hpp"

#include <Eigen/Eigenvalues>

using namespace elamin;

namespace {

double largest_frequency(Energy& energy, const State& state) {
  energy.evaluate(state, true);
  Eigen::MatrixXd K = Eigen::MatrixXd(energy.hessian()).selfadjointView<Eigen::Lower>();
  Vector m(energy.dofs());
  for (int d = 0; d < energy.dofs(); ++d) m[d] = energy.model().mass(energy.kinematics().site_of(d));
  const Vector scale = m.cwiseSqrt().cwiseInverse();
  K = scale.asDiagonal() * K * scale.asDiagonal();
  return std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K).eigenvalues().tail<1>()[0]);
}

bool stays(const Model& m, double dt) {
  Verlet verlet(m, begin_motion(m), dt);
  verlet.advance(20000);
  return verlet.finite() && (verlet.motion().state.position - m.start.position).cwiseAbs().maxCoeff() < 0.1;
}

}  // namespace

TEST_CASE("the largest frequency is met from above within one per cent", "[dynamics]") {
  for (const int n : {3, 10, 60}) {
    Model m = chain(n, 100, 20, 1);
    for (int p = 0; p < n; ++p) m.density[p] = 1 + p % 3, m.start.position(0, p) += 0.01 * (p % 4);
    hold(m, 0, 0);
    Energy energy(m);
    const double w = largest_frequency(energy, m.start);
    const TimestepLimit limit = timestep_limit(energy, m.start);
    CHECK(limit.frequency >= w);
    CHECK(limit.frequency <= 1.01 * w);
    CHECK(limit.stable == Approx(2 / limit.frequency));
  }
}

TEST_CASE("a step just below the limit stays, one above does not", "[dynamics]") {
  Model m = chain(10, 100, 1, 1);
  hold(m, 0, 0), hold(m, 9, 9);
  for (int p = 1; p < 9; ++p) m.start.position(2, p) += 1e-9 * (p % 2 ? 1 : -1);
  for (const double drag : {0.0, 5.0}) {
    m.viscosity = {{{1, 2, 3, 4, 5, 6, 7, 8}, drag}};
    Energy energy(m);
    const TimestepLimit limit = timestep_limit(energy, m.start);
    CHECK(limit.drag == Approx(drag / m.mass(1)));
    CHECK(unstable(limit, 0.999 * limit.stable).empty());
    CHECK(unstable(limit, 1.001 * limit.stable).find("unstable") != std::string::npos);
    CHECK(stays(m, 0.99 * limit.stable));
    CHECK(!stays(m, 1.03 * limit.stable));
  }
}

TEST_CASE("nothing stiff has no limit", "[dynamics]") {
  Model m;
  m.start = State(Field(Field::Zero(3, 1)));
  m.diameter = {1}, m.density = {1}, m.id = {1}, m.type = {1}, m.molecule = {1};
  Energy energy(m);
  CHECK(std::isinf(timestep_limit(energy, m.start).stable));
  CHECK(unstable(timestep_limit(energy, m.start), 1e9).empty());
}
