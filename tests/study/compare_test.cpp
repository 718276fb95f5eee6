// One problem by many methods.
#include "catch.hpp"
#include "core/interrupt.hpp"
#include "input/read.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/compare.hpp"

using namespace elamin;
using Catch::Matchers::Contains;

namespace {

const std::string clamped = "[[support]]\ngroup = \"bottom\"\n[[support]]\ngroup = \"top\"\n";
// A little push to one side tells it which way to buckle.
const std::string pushed = column_and_ends + clamped + "displacement = [0, 0, -8e-4]\n[[group]]\nname = \"mid\"\nof = \"column\"\nmiddle = 2\n" +
                           "[[load]]\ngroup = \"mid\"\nforce = [1e-5, 0, 0]\n";

const std::vector<std::string> named{"newton", "nlopt:LD_LBFGS", "nlopt:LD_TNEWTON_PRECOND_RESTART", "nlopt:LD_MMA", "nlopt:LD_SLSQP"};

}  // namespace

TEST_CASE("all methods end at Newton's equilibrium, of one state and at the end of a path", "[compare]") {
  const ScratchDirectory scratch;
  for (const std::string study : {"[study]\ntype = \"equilibrium\"\n", "[study]\ntype = \"path\"\n[path]\nsteps = 4\n"}) {
    const Problem problem = read_problem(scratch.file("p.toml", pushed + study));
    const std::vector<Compared> rows = compare(problem, named, 60);
    REQUIRE(rows.size() == named.size());
    for (const Compared& r : rows) {
      INFO(study << r.method << ": " << r.refused << r.why);
      CHECK(r.refused.empty());
      REQUIRE(r.status == Status::converged);
      CHECK(r.residual <= 1e-10);
      CHECK(r.evaluations > 0);
      CHECK(r.points >= (study.find("path") == std::string::npos ? 1 : 5));
      if (r.method == "newton") {
        CHECK(!r.energy_difference);
        continue;
      }
      REQUIRE(r.energy_difference);
      CHECK(std::abs(*r.energy_difference) <= 1e-12);
      CHECK(*r.state_difference <= 1e-7);
    }
  }
}

TEST_CASE("what cannot is told, what takes too long is stopped, and the others run", "[compare]") {
  const ScratchDirectory scratch;
  const Problem problem = read_problem(scratch.file("p.toml", pushed + "[study]\ntype = \"equilibrium\"\n"));
  const std::vector<Compared> rows = compare(problem, {"nlopt:GN_ESCH", "nlopt:LD_LBFG", "newton"}, 60);
  REQUIRE(rows.size() == 3);
  CHECK_THAT(rows[0].refused, Contains("free dofs are too many"));
  CHECK_THAT(rows[1].refused, Contains("did you mean \"LD_LBFGS\"?"));
  CHECK(rows[2].status == Status::converged);

  const std::vector<Compared> late = compare(problem, {"nlopt:LD_LBFGS", "newton"}, 1e-9);
  for (const Compared& r : late) {
    CHECK((r.out_of_time || r.status == Status::converged));      // either may be faster than the clock
    if (r.out_of_time) CHECK_THAT(r.why, Contains("stopped after 1e-09 s"));
  }
  CHECK(late.size() == 2);
  CHECK(!interrupted());
}

TEST_CASE("Ctrl-C ends a comparison", "[compare]") {
  const ScratchDirectory scratch;
  const Problem problem = read_problem(scratch.file("p.toml", pushed + "[study]\ntype = \"equilibrium\"\n"));
  interrupt_requested = true;
  const std::vector<Compared> rows = compare(problem, named, 60);
  const bool still = interrupted();
  interrupt_requested = false;
  CHECK(still);
  REQUIRE(rows.size() == 1);
  CHECK(rows[0].status == Status::interrupted);
}
