#include "catch.hpp"
#include "core/error.hpp"
#include "results/observables.hpp"
#include "results/sample.hpp"

using namespace elamin;

TEST_CASE("observables of a group", "[observables]") {
  using Q = Quantity;
  using C = Component;
  using R = Reduce;
  const Model m = sample_model();
  Problem problem;
  State state = m.start;
  state.position.col(1) += Vec3(3, 4, 0);
  state.position.col(2) += Vec3(0, 0, -2);
  Field forces(3, 5);
  forces << -1, 9, 9, 9, -5,
            -2, 9, 9, 9, 77,
            -2, 9, 9, 9, 1;
  const auto value = [&](const std::string& group, Q q, C c, R r) {
    problem.observe = {observe("a", "all", Q::position, C::x, R::mean), observe("b", group, q, c, r)};
    const Observables observables(problem, m);
    const auto values = observables.evaluate(state, forces, {});
    REQUIRE(values.size() == 2);
    return values[1];
  };
  SECTION("position and displacement") {
    CHECK(value("two", Q::position, C::x, R::max) == 3.1);
    CHECK(value("two", Q::position, C::x, R::min) == 0.2);
    CHECK(value("two", Q::position, C::x, R::mean) == Approx((3.1 + 0.2) / 2).epsilon(1e-15));
    CHECK(value("two", Q::position, C::y, R::sum) == 4);
    // the start stands at 2/3: x − x_start is rounded at the size of x
    CHECK(value("two", Q::displacement, C::z, R::min) == Approx(-2).epsilon(1e-15));
    CHECK(value("two", Q::displacement, C::norm, R::max) == Approx(5).epsilon(1e-15));
    CHECK(value("two", Q::displacement, C::norm, R::mean) == Approx((5 + 2) / 2.0).epsilon(1e-15));
    CHECK(value("two", Q::displacement, C::norm, R::sum) ==
          Approx(std::sqrt(9 + 16 + 4.0)).epsilon(1e-15));  // of the sum
  }
  SECTION("reactions: minus the force, at held coordinates only") {
    CHECK(value("all", Q::reaction, C::x, R::sum) == 6);
    CHECK(value("all", Q::reaction, C::y, R::sum) == 2);            // the last particle is free along y
    CHECK(value("ends", Q::reaction, C::z, R::sum) == 1);
    CHECK(value("ends", Q::reaction, C::norm, R::sum) == Approx(std::sqrt(36.0 + 4 + 1)).epsilon(1e-15));
    CHECK(value("ends", Q::reaction, C::norm, R::min) == Approx(3).epsilon(1e-15));
    CHECK(value("ends", Q::reaction, C::norm, R::max) == Approx(std::sqrt(26.0)).epsilon(1e-15));
    CHECK(value("two", Q::reaction, C::norm, R::max) == 0);
  }
  SECTION("velocity") {
    CHECK(value("all", Q::velocity, C::norm, R::max) == 0);
    Model moving = m;
    moving.velocity = Field::Constant(3, 5, 2);
    problem.observe = {observe("v", "two", Q::velocity, C::y, R::mean)};
    CHECK(Observables(problem, moving).evaluate(state, forces, {})[0] == 2);
  }
}

TEST_CASE("a displacement far below the rounding of the position keeps its digits", "[observables]") {
  const Model m = sample_model();
  Problem problem;
  problem.observe = {observe("d", "two", Quantity::displacement, Component::z, Reduce::mean),
                     observe("n", "two", Quantity::displacement, Component::norm, Reduce::max)};
  State state = m.start;
  for (const int i : {1, 2}) {
    ExactVector x = state.at(i);
    x.set(2, x[2] + 1.2345678901234567e-25);
    state.set(i, x);
  }
  REQUIRE(state.position == m.start.position);
  const auto values = Observables(problem, m).evaluate(state, Field::Zero(3, 5), {});
  // tails are rounded at ε² of the position, 2.5e-32
  CHECK(values[0] == Approx(1.2345678901234567e-25).epsilon(1e-6));
  CHECK(values[1] == Approx(1.2345678901234567e-25).epsilon(1e-6));
}

TEST_CASE("a length has the same bits wherever its vector is stored", "[observables]") {
  const Model m = sample_model();
  Problem problem;
  problem.observe = {observe("least", "all", Quantity::position, Component::norm, Reduce::min), observe("most", "all", Quantity::position, Component::norm, Reduce::max)};
  State state = m.start;
  for (int k = 1; k <= 50; ++k) {
    for (int i = 0; i < m.particles(); ++i) state.position.col(i) = Vec3(std::sin(k), std::sin(2 * k), std::sin(3 * k));
    const auto values = Observables(problem, m).evaluate(state, Field::Zero(3, 5), {});
    CHECK(values[0] == values[1]);
  }
}

TEST_CASE("a reaction that cancels is summed without loss", "[observables]") {
  const Model m = sample_model();
  Problem problem;
  problem.observe = {observe("r", "ends", Quantity::reaction, Component::x, Reduce::sum)};
  Field forces = Field::Zero(3, 5);
  forces(0, 0) = 1e20, forces(0, 4) = -1e20 - 16384;
  CHECK(Observables(problem, m).evaluate(m.start, forces, {})[0] == 16384);
}

TEST_CASE("gaps and contacts of groups and of walls", "[observables]") {
  using Q = Quantity;
  using C = Component;
  using R = Reduce;
  const Model m = sample_model();
  Problem problem;
  const auto value = [&](const std::string& group, Q q, R r, C c = C::x, const std::vector<Touch>& touches = sample_touches()) {
    problem.observe = {observe("a", group, q, c, r)};
    return Observables(problem, m).evaluate(m.start, Field::Constant(3, 5, 7), touches)[0];
  };
  SECTION("groups: smallest gaps, closed contacts; a pair within the group counts for both") {
    CHECK(value("all", Q::gap, R::min) == -0.75);
    CHECK(value("all", Q::gap, R::max) == -0.125);               // of 2 and of 4
    CHECK(value("ends", Q::gap, R::mean) == (-0.5 - 0.125) / 2);
    CHECK(value("all", Q::contacts, R::sum) == 7);               // two pairs, three faces
    CHECK(value("two", Q::contacts, R::max) == 3);
    CHECK(value("two", Q::contacts, R::mean) == 2);
    CHECK(value("two", Q::contacts, R::max, C::y) == 3);         // a number has no component
    CHECK(value("all", Q::contacts, R::sum, C::x, {}) == 0);
    CHECK_FALSE(std::isfinite(value("all", Q::gap, R::min, C::x, {})));
    CHECK_FALSE(std::isfinite(value("all", Q::gap, R::mean, C::x, {sample_touches()[3]})));
  }
  SECTION("walls: force on the structure, over the particles that touch") {
    CHECK(value("floor", Q::reaction, R::sum, C::z) == 48);
    CHECK(value("floor", Q::reaction, R::mean, C::z) == 24);
    CHECK(value("floor", Q::reaction, R::max, C::norm) == Approx(std::sqrt(32 * 32 + 9.0)).epsilon(1e-15));
    CHECK(value("floor", Q::reaction, R::sum, C::norm) == Approx(std::sqrt(48 * 48 + 9.0)).epsilon(1e-15));
    CHECK(value("floor", Q::contacts, R::sum) == 3);
    CHECK(value("floor", Q::contacts, R::max) == 2);
    CHECK(value("floor", Q::contacts, R::mean) == 1.5);
    CHECK(value("floor", Q::gap, R::min) == -0.75);
    CHECK_FALSE(std::isfinite(value("floor", Q::gap, R::max)));  // 2, 3 and 4 are nowhere near it
    CHECK(value("side", Q::gap, R::min) == 0.375);
    CHECK(value("side", Q::contacts, R::sum) == 0);
    CHECK(value("side", Q::reaction, R::sum, C::norm) == 0);
    CHECK_FALSE(std::isfinite(value("side", Q::reaction, R::mean, C::norm)));
  }
  SECTION("which contacts are enough to tell the gaps") {
    const auto enough = [&](const std::string& group, Q q, R r, const std::vector<Touch>& touches) {
      problem.observe = {observe("a", group, q, C::x, r)};
      return Observables(problem, m).sufficient(touches);
    };
    CHECK(enough("all", Q::contacts, R::sum, {}));
    CHECK(enough("floor", Q::reaction, R::max, {}));
    CHECK_FALSE(enough("two", Q::gap, R::min, {sample_touches()[3]}));
    CHECK(enough("two", Q::gap, R::min, {sample_touches()[0]}));
    CHECK_FALSE(enough("two", Q::gap, R::mean, {sample_touches()[0]}));
    CHECK(enough("two", Q::gap, R::mean, {sample_touches()[0], sample_touches()[2]}));
    CHECK_FALSE(enough("side", Q::gap, R::min, {sample_touches()[0]}));
    CHECK(enough("side", Q::gap, R::min, {sample_touches()[6]}));
  }
}

TEST_CASE("a wall has no position", "[observables]") {
  const Model m = sample_model();
  Problem problem;
  problem.file = "p.toml";
  problem.observe = {observe("a", "side", Quantity::position, Component::x, Reduce::mean)};
  problem.observe[0].place.line = 3, problem.observe[0].place.column = 1, problem.observe[0].place.key = "observe.a";
  problem.observe[0].place.keys["quantity"] = {5, 12};
  try {
    Observables(problem, m);
    FAIL("no error");
  } catch (const InputError& e) {
    CHECK(std::string(e.what()) == "p.toml:5:12: observe.a.quantity: \"side\" is a wall; it has a reaction, gap and contacts only");
  }
}

TEST_CASE("observables of a group that is not there or empty", "[observables]") {
  const Model m = sample_model();
  Problem problem;
  problem.file = "p.toml";
  problem.observe = {observe("a", "nobody", Quantity::position, Component::x, Reduce::mean),
                     observe("b", "none", Quantity::position, Component::x, Reduce::mean)};
  problem.observe[0].place.line = 7, problem.observe[1].place.line = 12;
  problem.observe[0].place.column = problem.observe[1].place.column = 1;
  problem.observe[0].place.key = "observe.a", problem.observe[1].place.key = "observe.b";
  try {
    Observables(problem, m);
    FAIL("no error");
  } catch (const InputError& e) {
    CHECK(std::string(e.what()) ==
          "p.toml:7:1: observe.a.group: there is no group \"nobody\"; there are all, ends, two, none, floor, side\n"
          "p.toml:12:1: observe.b.group: the group \"none\" has no particle and no body; at least one is needed");
  }
}
