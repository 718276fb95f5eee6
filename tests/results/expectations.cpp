#include "results/expectations.hpp"

#include "catch.hpp"
#include "results/record.hpp"
#include "results/sample.hpp"

#include <cmath>

using namespace elamin;

namespace {

struct ExpectedRun {
  Model model = sample_model();
  Problem problem;
  ExpectedRun() {
    problem.file = "p.toml";
    problem.observe = {observe("mid_x", "two", Quantity::displacement, Component::x, Reduce::max)};
    ExpectTable e;
    e.place.line = 40, e.place.column = 1;
    problem.expect = {e};
  }
  Verdict verdict(const std::string& observable, const std::string& at, double value, double rtol = 1e-8,
                  double atol = 0) {
    Record record(problem, model);
    const Field none = Field::Zero(3, 5);
    record.add(sample_point(model, 0, 0, "initial"), none, {});
    record.add(sample_point(model, 1, 0.5), none, {});
    PathPoint p = sample_point(model, 2, 0.6, "branch:1");
    p.multiplicity = 2, p.report.residual = std::nan("");
    record.add(p, none, {});
    record.add(sample_point(model, 3, 0.6), none, {});
    p = sample_point(model, 4, 1);
    p.stability.negative = 3, p.stability.stable = false;
    record.add(p, none, {});
    ExpectTable& e = problem.expect[0];
    e.observable = observable, e.at = at, e.value = value, e.rtol = rtol, e.atol = atol;
    const auto all = check_expectations(problem, record.path(), record.events());
    REQUIRE(all.size() == 1);
    return all[0];
  }
};

}  // namespace

TEST_CASE("expectations hold where the run gives what is expected, and only there", "[expectations]") {
  ExpectedRun run;
  CHECK(run.verdict("lambda", "branch:1", 0.6).met);
  CHECK(run.verdict("multiplicity", "branch:1", 2).met);
  CHECK(run.verdict("lambda", "final", 1).met);
  CHECK(run.verdict("negative", "final", 3).met);
  CHECK(run.verdict("stable", "final", 0).met);
  CHECK(run.verdict("stable", "initial", 1).met);
  CHECK(run.verdict("step", "initial", 0).met);
  CHECK(run.verdict("step", "lambda=0.5", 1).met);
  CHECK(run.verdict("step", "lambda=0.5000000000001", 1).met);           // 2e-13 relative
  CHECK(run.verdict("step", "lambda=6e-1", 3).met);                      // the last of two
  CHECK(run.verdict("step", "lambda=0", 0).met);
  CHECK(run.verdict("mid_x", "lambda=0.5", 0.5).met);
  CHECK(run.verdict("mid_x", "lambda=0.5", 0.6, 0.17).met);              // |0.5 − 0.6| ≤ 0.17 · 0.6
  CHECK(!run.verdict("mid_x", "lambda=0.5", 0.6, 0.16).met);
  CHECK(run.verdict("mid_x", "lambda=0.5", 0.6, 0, 0.11).met);
  CHECK(!run.verdict("mid_x", "lambda=0.5", 0.6, 0, 0.09).met);
  CHECK(run.verdict("mid_x", "lambda=0.5", 0.6, 0.1, 0.05).met);         // both together
  CHECK(!run.verdict("lambda", "branch:1", 0.6000001).met);
  CHECK(!run.verdict("lambda", "branch:1", std::nan(""), 1).met);
}

TEST_CASE("values of finer and finer runs are extrapolated", "[expectations]") {
  // v = 3 + h²/2 − h⁴ at h = 1, ½, ¼: two steps of Richardson's leave 3 exactly; v = 3 + h/2 − h² likewise, in all powers.
  const auto verdict = [](int powers, double value, double missing = 0) {
    std::vector<Table> paths;
    for (const double h : {1.0, 0.5, 0.25}) {
      const double x = powers == 2 ? h * h : h;
      Table path{{"label", "lambda", "u"}, {}};
      path.rows.push_back({std::string("final"), 1.0, h == missing ? Cell() : Cell(3 + x / 2 - x * x)});
      paths.push_back(path);
    }
    const Table events{{"label", "lambda", "u"}, {}};
    std::vector<RunTables> runs;
    for (const Table& path : paths) runs.push_back({&path, &events});
    Problem problem;
    problem.file = "p.toml";
    ExpectTable e;
    e.place.line = 40, e.place.column = 1;
    e.observable = "u", e.value = value, e.rtol = 1e-14, e.extrapolate = powers;
    return check_extrapolated(problem, e, runs);
  };
  CHECK(verdict(2, 3).met);
  CHECK(verdict(1, 3).met);
  CHECK(!verdict(2, 3.0001).met);
  CHECK(verdict(2, 3.0001).sentence.find("p.toml:40:1: u at final, extrapolated over 3 runs, is 3, expected 3.0001") == 0);
  CHECK(!verdict(2, 3, 0.5).met);
  CHECK(verdict(2, 3, 0.5).sentence.find("in run 2: has no number there") != std::string::npos);
}

TEST_CASE("a threshold is held by the middle of what encloses it", "[expectations]") {
  Problem problem;
  ExpectTable e;
  e.observable = "threshold", e.at = "sweep", e.value = 2, e.rtol = 0, e.atol = 0.1;
  CHECK(check_threshold(problem, e, {{1.5, 2.6}}).met);
  CHECK(!check_threshold(problem, e, {{1.5, 2.8}}).met);
  CHECK(!check_threshold(problem, e, std::nullopt).met);
}

TEST_CASE("what an expectation cannot find is not met, and the sentence says what there is", "[expectations]") {
  ExpectedRun run;
  const auto unmet = [&](const std::string& observable, const std::string& at) {
    const Verdict v = run.verdict(observable, at, 0, 1e9, 1e9);
    CHECK(!v.met);
    return v.sentence;
  };
  CHECK(unmet("lambda", "limit:1") == "p.toml:40:1: lambda at limit:1: there is no such event; there are: branch:1");
  CHECK(unmet("lambda", "lambda=0.7") ==
        "p.toml:40:1: lambda at lambda=0.7: no equilibrium of the path has this load factor; the last one has 1");
  CHECK(unmet("lambda", "lambda=x").find("what follows \"lambda=\" is not a number") != std::string::npos);
  CHECK(unmet("lambda", "lambda=").find("is not a number") != std::string::npos);
  CHECK(unmet("mid_y", "final").find("there is no such column; there are: step, label, branch, lambda, energy") !=
        std::string::npos);
  CHECK(unmet("label", "final").find("has no number there") != std::string::npos);
  CHECK(unmet("residual", "branch:1").find("has no number there") != std::string::npos);
  const Verdict off = run.verdict("lambda", "final", 2);
  CHECK(off.sentence == "p.toml:40:1: lambda at final is 1, expected 2: off by 1, 2e-08 allowed");
  CHECK(check_expectations(run.problem, {{"step"}, {}}, {{"label"}, {}})[0].sentence.find(
            "the run has no equilibrium") != std::string::npos);
}
