#include "catch.hpp"
#include "core/interrupt.hpp"
#include "solve/method.hpp"
#include "solve/minima.hpp"

using namespace elamin;
using Catch::Matchers::Contains;

namespace {

constexpr const char* gradient_methods[]{"LD_LBFGS", "LD_TNEWTON", "LD_TNEWTON_RESTART", "LD_TNEWTON_PRECOND", "LD_TNEWTON_PRECOND_RESTART",
                                         "LD_VAR1", "LD_VAR2", "LD_MMA", "LD_CCSAQ", "LD_SLSQP"};

double extent_of(const Model& m) { return (m.start.position.rowwise().maxCoeff() - m.start.position.rowwise().minCoeff()).norm(); }

// From the model's start at load factor 1, or from a state.
struct Found {
  Report report;
  State state;
};

Found find(const Model& model, const std::optional<Method>& method = {}, const State* from = nullptr) {
  Energy energy(model);
  Newton newton(energy);
  Found f{{}, from ? *from : model.start};
  if (!from) energy.kinematics().prescribe(f.state, 1);
  f.report = minimise(newton, f.state, method.value_or(NewtonOptions{}));
  return f;
}

void check_same(const Found& found, const Found& known, const Model& model) {
  INFO(found.report.why);
  REQUIRE(found.report.converged());
  CHECK(found.report.negative == 0);
  CHECK(found.report.residual <= 1e-10);
  CHECK(found.report.evaluations >= found.report.iterations);
  CHECK(std::abs(found.report.energy - known.report.energy) <= 1e-12 * std::abs(known.report.energy));
  CHECK(displacement(found.state, known.state).cwiseAbs().maxCoeff() <= 1e-7 * extent_of(model));
}

State mirrored(State s) {
  s.position.row(0) *= -1, s.low.row(0) *= -1;
  return s;
}

}  // namespace

TEST_CASE("NLopt's local methods find Newton's equilibria", "[solve][nlopt]") {
  const std::string name = GENERATE("column", "sheet", "beams", "grains");
  const Model model = name == "column" ? clamped_column(0.5) : name == "sheet" ? indented_sheet() : name == "beams" ? two_beams() : grains_in_slot();
  const Found known = find(model);
  REQUIRE(known.report.converged());
  if (name == "beams" || name == "grains") REQUIRE(Energy(model).touches(known.state).size() >= 2);
  for (const char* algorithm : gradient_methods) {
    INFO(name << ", " << algorithm);
    check_same(find(model, NloptOptions{.algorithm = algorithm}), known, model);
  }
}

TEST_CASE("a straight column above buckling ends buckled, by every method", "[solve][nlopt]") {
  for (const double overload : {1.5, 11.5, 19.0, 20.0}) {               // from 11.5 on some come near to other saddles on the way
    const Model model = clamped_column(overload);
    const Found known = find(model);
    REQUIRE(known.report.converged());
    const double bow = known.state.position.row(0).cwiseAbs().maxCoeff();
    REQUIRE(bow > 0.5);
    for (const char* algorithm : gradient_methods) {
      INFO(overload << ", " << algorithm);
      const Found found = find(model, NloptOptions{.algorithm = algorithm});
      CHECK_THAT(found.report.why, Contains("saddle"));
      // To which side is a matter of rounding.
      const bool same_side = found.state.position.row(0).dot(known.state.position.row(0)) > 0;
      check_same(same_side ? found : Found{found.report, mirrored(found.state)}, known, model);
    }
  }
}

TEST_CASE("the tolerance is reached by NLopt itself", "[solve][nlopt]") {
  const Model model = two_beams();
  for (const char* algorithm : gradient_methods) {
    Energy energy(model);
    Newton newton(energy);
    State state = model.start;
    energy.kinematics().prescribe(state, 1);
    const Report report = minimise_by_nlopt(newton, state, {.algorithm = algorithm, .tolerance = 1e-12});
    INFO(algorithm << ": " << report.why);
    REQUIRE(report.converged());
    energy.evaluate(state);
    CHECK(energy.relative(energy.gradient()) <= 1e-12);
    CHECK(report.history.size() >= 2);
    CHECK(report.negative == -1);                                 // it has not looked
  }
}

TEST_CASE("the same bits every time", "[solve][nlopt]") {
  const Model column = clamped_column(1.5), truss = two_bar_truss(-0.4, 0.01);
  for (const char* algorithm : {"LD_LBFGS", "LD_MMA"})
    CHECK(find(column, NloptOptions{.algorithm = algorithm}).state.position == find(column, NloptOptions{.algorithm = algorithm}).state.position);
  for (const char* algorithm : {"G_MLSL", "GN_CRS2_LM", "GN_ESCH", "GN_ISRES"})
    CHECK(find(truss, NloptOptions{.algorithm = algorithm, .max_evaluations = 4000}).state.position ==
          find(truss, NloptOptions{.algorithm = algorithm, .max_evaluations = 4000}).state.position);
}

TEST_CASE("methods without derivatives on what is small", "[solve][nlopt]") {
  const Model truss = two_bar_truss(0.6, 0.01), column = clamped_column(0.5, 10), bent = two_bar_truss(0.5, 0.3);
  for (const Model* model : {&truss, &bent, &column}) {
    const Found known = find(*model);
    REQUIRE(known.report.converged());
    for (const char* algorithm : {"LN_COBYLA", "LN_BOBYQA", "LN_NEWUOA", "LN_PRAXIS", "LN_NELDERMEAD", "LN_SBPLX"}) {
      const int dofs = Energy(*model).dofs();
      if (!nlopt_refuses(algorithm, dofs, false).empty()) continue;
      INFO(algorithm << ", " << dofs << " dofs");
      check_same(find(*model, NloptOptions{.algorithm = algorithm}), known, *model);
    }
  }
}

TEST_CASE("global methods find the lower of two minima", "[solve][nlopt]") {
  const Model model = two_bar_truss(-0.45, 0.01);                 // starts at the upper minimum of the energy: apex down
  const Found near = find(model), far = find(two_bar_truss(0.45, 0.01));
  REQUIRE(near.report.converged());
  REQUIRE(far.report.converged());
  REQUIRE(near.state.position(2, 1) < -0.4);
  REQUIRE(far.state.position(2, 1) > 0.4);
  REQUIRE(far.report.energy < near.report.energy);
  check_same(find(model, NloptOptions{}), near, model);           // a local one stays
  for (const char* algorithm : {"G_MLSL", "G_MLSL_LDS", "GN_DIRECT", "GN_DIRECT_L", "GN_CRS2_LM", "GN_ISRES", "GN_ESCH"}) {
    REQUIRE(nlopt_refuses(algorithm, 2, false).empty());
    INFO(algorithm);
    const Found found = find(model, NloptOptions{.algorithm = algorithm, .max_evaluations = 20'000});
    check_same(found, far, model);
    CHECK_THAT(found.report.why, Contains(algorithm));
    // In a box that does not reach so far there is only the one near by.
    check_same(find(model, NloptOptions{.algorithm = algorithm, .max_evaluations = 20'000, .bounds = 0.3}), near, model);
  }
}

TEST_CASE("what NLopt's methods cannot do is refused with what can", "[solve][nlopt]") {
  CHECK(nlopt_refuses("LD_LBFGS", 1'000'000, false).empty());
  CHECK(nlopt_refuses("LD_SLSQP", 500, false).empty());
  CHECK(nlopt_refuses("G_MLSL_LDS", 4, false).empty());
  CHECK_THAT(nlopt_refuses("LD_LBFGSS", 10, false), Contains("did you mean \"LD_LBFGS\"?") && Contains("LN_COBYLA") && Contains("G_MLSL_LDS"));
  CHECK_THAT(nlopt_refuses("ld_mma", 10, false), Contains("did you mean \"LD_MMA\"?"));
  CHECK_THAT(nlopt_refuses("LD_SLSQP", 100'000, false), Contains("dense") && Contains("100000 free dofs are too many") && Contains("LD_LBFGS"));
  CHECK_THAT(nlopt_refuses("LN_COBYLA", 5000, false), Contains("does without derivatives") && Contains("\"ipopt\""));
  CHECK_THAT(nlopt_refuses("GN_ESCH", 148, false), Contains("box") && Contains("LD_TNEWTON_PRECOND_RESTART"));
  CHECK_THAT(nlopt_refuses("LN_NEWUOA", 1, false), Contains("at least 2"));
  CHECK_THAT(nlopt_refuses("LD_MMA", 10, true), Contains("hard contacts") && Contains("\"ipopt\""));

  const Found refused = find(clamped_column(0.5), NloptOptions{.algorithm = "GN_ESCH"});
  CHECK(refused.report.status == Status::not_converged);
  CHECK_THAT(refused.report.why, Contains("148 free dofs are too many"));
}

TEST_CASE("too few evaluations are a result, and so is Ctrl-C", "[solve][nlopt]") {
  const Model model = clamped_column(20);
  const Found few = find(model, NloptOptions{.max_evaluations = 30});
  CHECK(few.report.status == Status::not_converged);
  CHECK(few.report.evaluations <= 32);
  CHECK_THAT(few.report.why, Contains("30 evaluations were not enough for LD_LBFGS"));
  CHECK(few.report.residual > 1e-10);
  CHECK(few.state.position.allFinite());

  interrupt_requested = true;
  const Found stopped = find(model, NloptOptions{});
  interrupt_requested = false;
  CHECK(stopped.report.status == Status::interrupted);
}

TEST_CASE("Newton's method ends what NLopt began", "[solve][nlopt]") {
  const Model model = clamped_column(20);
  const Found polished = find(model, NloptOptions{.max_evaluations = 30, .polish = true});
  CHECK(polished.report.converged());
  CHECK(polished.report.negative == 0);
  CHECK_THAT(polished.report.why, Contains("iterations of Newton's method") && Contains("30 evaluations were not enough"));
}

TEST_CASE("without the factor's variables NLopt manages what is well conditioned", "[solve][nlopt]") {
  const Model model = indented_sheet(9);
  const Found known = find(model);
  for (const char* algorithm : {"LD_LBFGS", "LD_TNEWTON_PRECOND_RESTART"}) {
    INFO(algorithm);
    check_same(find(model, NloptOptions{.algorithm = algorithm, .precondition = false}), known, model);
  }
}

TEST_CASE("nothing passes through anything on NLopt's way", "[solve][nlopt]") {
  // A heavy grain falls on a floor that it would be far below after one step of its own; another waits above it.
  Model m;
  Field x(3, 2);
  x << 0, 0, 0, 0, 3, 40;
  add_grains(m, {{"grains", x, {1, 1}, 1000.0}});
  PairContact c;
  c.particles = {numbers(2), numbers(2)}, c.effective_modulus = 1e6;
  m.contacts = {c};
  Wall floor;
  floor.particles = numbers(2), floor.effective_modulus = 1e6;
  m.walls = {floor};
  m.gravity.push_back({"", numbers(2), Vec3(0, 0, -10), Scaling::constant()});
  m.supports.push_back({"", numbers(2), {true, true, false}, Vec3::Zero(), Scaling()});
  const Found known = find(m);
  REQUIRE(known.report.converged());
  for (const char* algorithm : gradient_methods) {
    INFO(algorithm);
    const Found found = find(m, NloptOptions{.algorithm = algorithm});
    check_same(found, known, m);
    CHECK(found.state.position(2, 0) > 0.4);
    CHECK(found.state.position(2, 1) > found.state.position(2, 0) + 0.9);
  }
}
