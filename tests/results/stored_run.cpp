#include "results/stored_run.hpp"

#include "catch.hpp"
#include "core/error.hpp"
#include "results/run_directory.hpp"
#include "results/sample.hpp"
#include "scratch_directory.hpp"

using namespace elamin;

TEST_CASE("a run's directory is read as it was written", "[stored_run]") {
  ScratchDirectory scratch;
  const Model m = sample_model();
  Problem problem;
  problem.title = "say \"x\", y";
  RunDirectory run(scratch / "run", problem, m, "");
  PathPoint event = sample_point(m, 1, 0.1 + 0.2, "branch:1");
  event.what = "a, \"b\"\nc", event.energy.bond = 1e-300;
  run.add(sample_point(m, 0, 0, "initial"), Field::Zero(3, 5), {});
  run.add(event, Field::Zero(3, 5), sample_touches());
  Field shape = Field::Random(3, 5);
  run.add_null_vectors("branch:1", {Field::Zero(3, 5), shape});
  CHECK(!read_run(scratch / "run").summary);                       // it may have been stopped
  Summary summary;
  summary.title = problem.title, summary.status = "done", summary.tolerances = {{"residual", 1e-10}};
  run.finish(summary);

  const StoredRun read = read_run(scratch / "run");
  CHECK(read.path.columns == run.record().path().columns);
  REQUIRE(read.events.rows.size() == 1);
  const auto text = [](const Row& row) {
    std::vector<std::string> all;
    for (const Cell& c : row) all.push_back(csv_text(c));
    return all;
  };
  REQUIRE(read.path.rows.size() == 2);
  for (int k : {0, 1}) CHECK(text(read.path.rows[k]) == text(run.record().path().rows[k]));
  CHECK(text(read.events.rows[0]) == text(run.record().events().rows[0]));
  CHECK(read.contacts.rows.size() == 5);
  REQUIRE(read.summary);
  CHECK(read.summary->title == problem.title);
  CHECK(read.summary->tolerances == summary.tolerances);
  CHECK(read.version == version());
  REQUIRE(read.states.size() == 2);
  CHECK(read.states[1].label == "branch:1");
  CHECK(read.states[1].row == 1);
  const State state = read_state(read.states[1], m);
  CHECK(state.position == event.state.position);
  CHECK(state.load_factor == 0.1 + 0.2);
  const std::vector<Field> vectors = read_displacements(null_vectors_file(read.states[1].file), m);
  REQUIRE(vectors.size() == 2);
  CHECK(vectors[1] == shape);
  CHECK(read_displacements(null_vectors_file(read.states[0].file), m).empty());

  CHECK(runs_in(scratch / "run") == std::vector<std::string>{scratch / "run"});
  CHECK_THROWS_AS(runs_in(scratch / "nowhere"), InputError);
  scratch.file("sweep.csv", "n,status\n1,done\n2,do");
  CHECK(runs_in(scratch / "").size() == 1);
  CHECK(read_table(scratch / "sweep.csv").rows.size() == 1);        // the second is not whole
  Model other = m;
  other.id.back() = 9;
  CHECK_THROWS_AS(read_state(read.states[1], other), InputError);
  scratch.file("bad.csv", "a,b\n1\n");
  CHECK_THROWS_WITH(read_table(scratch / "bad.csv"), Catch::Matchers::Contains("bad.csv:2: 1 entries for 2 columns"));
}
