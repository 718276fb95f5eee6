#include "catch.hpp"
#include "solve/method.hpp"
#include "solve/minima.hpp"

using namespace elamin;
using Catch::Matchers::Contains;

TEST_CASE("methods have the names of the problem file", "[solve][method]") {
  CHECK(name_of(AutoOptions{}) == "auto");
  CHECK(name_of(NewtonOptions{}) == "newton");
  CHECK(name_of(IpoptOptions{}) == "ipopt");
  CHECK(name_of(NloptOptions{.algorithm = "LD_MMA"}) == "nlopt:LD_MMA");
}

TEST_CASE("a search that ends at a saddle is sent down and asked again", "[solve][method]") {
  const Model model = clamped_column(1.5);
  Energy energy(model);
  Newton newton(energy);
  State state = model.start;
  energy.kinematics().prescribe(state, 1);
  int asked = 0;
  const Report report = stable_end(newton, state, [&](State& s) {
    ++asked;
    // Of the straight column, stationary; thereafter of the buckled one.
    return asked == 1 ? newton.correct(s) : newton.minimise(s, Pace::downhill);
  });
  INFO(report.why);
  CHECK(asked == 2);
  CHECK(report.converged());
  CHECK(report.negative == 0);
  CHECK_THAT(report.why, Contains("1 saddle was left"));
  CHECK(report.iterations > 3);
  CHECK(state.position.row(0).cwiseAbs().maxCoeff() > 0.5);
  energy.evaluate(state);
  CHECK(energy.relative(energy.gradient()) == report.residual);
  CHECK(energy.last_terms().total() == report.energy);
}

TEST_CASE("a search that does not converge is not asked again", "[solve][method]") {
  const Model model = clamped_column(1.5);
  Energy energy(model);
  Newton newton(energy);
  State state = model.start;
  int asked = 0;
  const Report report = stable_end(newton, state, [&](State&) {
    ++asked;
    Report r;
    r.why = "no luck", r.iterations = 7;
    return r;
  });
  CHECK(asked == 1);
  CHECK(report.status == Status::not_converged);
  CHECK(report.why == "no luck");
  CHECK(report.iterations == 7);
  CHECK(report.negative == -1);
}

TEST_CASE("the residual is brought down to rounding at the end", "[solve][method]") {
  const Model model = two_beams();
  Energy energy(model);
  Newton newton(energy);
  State state = model.start;
  energy.kinematics().prescribe(state, 1);
  const Report report = minimise(newton, state, NloptOptions{.tolerance = 1e-4});
  INFO(report.why);
  REQUIRE(report.converged());
  CHECK_THAT(report.why, Contains("below 0.0001") && Contains("simplified Newton step"));
  CHECK(report.residual <= 1e-6);
}

TEST_CASE("hard contacts are refused by what does not know them", "[solve][method]") {
  Model m = grains_in_slot();
  m.walls[0].hard = true;
  Energy energy(m);
  Newton newton(energy);
  for (const Method& method : {Method(NewtonOptions{}), Method(NloptOptions{})}) {
    CHECK_THAT(refusal(method, energy), Contains("hard contacts") && Contains("\"ipopt\""));
    State state = m.start;
    const Report report = minimise(newton, state, method);
    CHECK(report.status == Status::not_converged);
    CHECK(report.why == refusal(method, energy));
    CHECK(state.position == m.start.position);
  }
  CHECK(refusal(IpoptOptions{}, energy).empty());
}

TEST_CASE("where nothing is free there is nothing to do", "[solve][method]") {
  Model m = clamped_column(0.5, 10);
  hold(m, 0, 9);
  m.supports.erase(m.supports.begin(), m.supports.end() - 1);
  Energy energy(m);
  REQUIRE(energy.dofs() == 0);
  Newton newton(energy);
  State state = m.start;
  CHECK(minimise(newton, state, NloptOptions{}).converged());
}
