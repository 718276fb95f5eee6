#include "results/run_directory.hpp"

#include "catch.hpp"
#include "core/error.hpp"
#include "input/state_supplement.hpp"
#include "lammps/data.hpp"
#include "results/files.hpp"
#include "results/sample.hpp"
#include "scratch_directory.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

using namespace elamin;
using nlohmann::json;

namespace {

Problem sample_problem() {
  Problem problem;
  problem.file = "p.toml", problem.title = "a chain";
  problem.observe = {observe("mid_x", "two", Quantity::displacement, Component::x, Reduce::max)};
  return problem;
}

long rows_in(const std::string& file) {
  const std::string text = text_of(file);
  return std::count(text.begin(), text.end(), '\n');
}

}  // namespace

TEST_CASE("a run leaves its rows, states, log and summary", "[run_directory]") {
  ScratchDirectory scratch;
  const Model m = sample_model();
  const Problem problem = sample_problem();
  const Field forces = Field::Zero(3, 5);
  RunDirectory run(scratch / "deep/run", problem, m, "title = \"a chain\"\n");
  CHECK(text_of(scratch / "deep/run/resolved.toml") == "title = \"a chain\"\n");
  CHECK(rows_in(scratch / "deep/run/path.csv") == 1);
  run.add(sample_point(m, 0, 0, "initial"), forces, {});
  run.add(sample_point(m, 1, 0.5), forces, {});
  PathPoint event = sample_point(m, 2, 0.6, "branch:1");
  event.multiplicity = 2, event.report.residual = std::nan("");
  run.add(event, forces, {});
  CHECK(rows_in(scratch / "deep/run/path.csv") == 4);           // there before the run ends
  CHECK(rows_in(scratch / "deep/run/events.csv") == 2);
  CHECK(text_of(scratch / "deep/run/events.csv").find("\nbranch:1,0.6,2,2,0,") != std::string::npos);
  CHECK(!std::filesystem::exists(scratch / "deep/run/summary.json"));
  run.add(sample_point(m, 3, 1, "final"), forces, {});
  for (const char* name : {"initial", "branch-1", "final"})
    CHECK(std::filesystem::exists(scratch / ("deep/run/states/" + std::string(name) + ".data")));
  CHECK(run.state_file("branch:1") == scratch / "deep/run/states/branch-1.data");
  CHECK(read_lammps_data(run.state_file("branch:1")).position == event.state.position);
  CHECK(text_of(run.state_file("branch:1")).find("a chain; branch:1; load factor 0.59999999999999998\n") == 0);

  Summary summary;
  summary.title = problem.title, summary.status = status_name(Status::converged),
  summary.message = "reached the load factor 1\xff";
  summary.input = "p.toml", summary.input_sha256 = std::string(64, 'a');
  summary.times = {{"total", 1.5}, {"solve", std::nan("")}};
  summary.tolerances = {{"residual", 1e-10}};
  run.finish(summary);
  const std::string text = text_of(scratch / "deep/run/summary.json");
  CHECK(text.find("nan") == std::string::npos);
  const json j = json::parse(text);
  CHECK(j["status"] == "done");
  CHECK(j["message"].get<std::string>().find("reached the load factor 1") == 0);
  CHECK(j["points"] == 4);
  REQUIRE(j["events"].size() == 1);
  CHECK(j["events"][0]["label"] == "branch:1");
  CHECK(j["events"][0]["lambda"] == 0.6);
  CHECK(j["events"][0]["multiplicity"] == 2);
  CHECK(j["events"][0]["residual"].is_null());
  CHECK(j["events"][0]["mid_x"].get<double>() == Approx(0.6).epsilon(1e-15));
  CHECK(j["final"]["lambda"] == 1.0);
  CHECK(j["final"]["stable"] == true);
  CHECK(j["final"]["contact"] == 1.5);
  CHECK(j["final"]["wall"] == 0.25);
  CHECK(j["final"]["cohesion"] == -0.375);
  CHECK(j["final"]["energy"].get<double>() == Approx(1.0 / 3 + 0.3 + 1.5 + 0.25 - 0.375 - 1e-3).epsilon(1e-15));
  CHECK(j["final"]["energy"].get<double>() == sample_point(m, 3, 1).energy.total());      // all 17 digits
  for (const std::string& column : run.record().path().columns) CHECK(j["final"].contains(column));
  CHECK(j["times"]["total"] == 1.5);
  CHECK(j["times"]["solve"].is_null());
  CHECK(j["tolerances"]["residual"] == 1e-10);
  CHECK(j["version"] == version());
  CHECK(j["input_sha256"] == std::string(64, 'a'));

  run.log("one line");
  run.log("another");
  const std::string log = text_of(scratch / "deep/run/log.txt");
  CHECK(rows_in(scratch / "deep/run/log.txt") == 2);
  CHECK(log.find("20") == 0);                                    // begins with the date
  CHECK(log.find(" one line\n20") != std::string::npos);
  CHECK(log.find(" another\n") != std::string::npos);
}

TEST_CASE("closed contacts of labelled states stand in contacts.csv", "[run_directory]") {
  ScratchDirectory scratch;
  Model m = sample_model();
  m.id = {2, 3, 5, 7, 11};
  const Problem problem = sample_problem();
  const Field forces = Field::Zero(3, 5);
  auto first_run = std::make_unique<RunDirectory>(scratch / "run", problem, m, "");
  RunDirectory& run = *first_run;
  const std::string header = "label,lambda,first,second,gap,force,fx,fy,fz,x,y,z\n";
  CHECK(text_of(scratch / "run/contacts.csv") == header);
  run.add(sample_point(m, 1, 0.5), forces, sample_touches());                       // no label
  CHECK(text_of(scratch / "run/contacts.csv") == header);
  run.add(sample_point(m, 2, 0.75, "contact:1"), forces, sample_touches());
  const std::string rows = "contact:1,0.75,3,7,-0.25,8,0,0,-8,1,2,3\n"
                           "contact:1,0.75,5,11,-0.125,5,3,4,0,0,0,0\n"
                           "contact:1,0.75,2,floor,-0.5,16,0,0,16,0,0,0\n"
                           "contact:1,0.75,3,floor,-0.75,32,0,0,32,0,0,0\n"
                           "contact:1,0.75,3,floor,-0.0625,3,-3,0,0,0,0,0\n";
  CHECK(text_of(scratch / "run/contacts.csv") == header + rows);                    // there before the run ends
  run.add_state("final", sample_point(m, 3, 0), {sample_touches()[3]});
  CHECK(text_of(scratch / "run/contacts.csv") == header + rows + "final,0,2,floor,-0.5,16,0,0,16,0,0,0\n");
  CHECK(std::filesystem::exists(run.state_file("final")));
  first_run.reset();
  RunDirectory again(scratch / "run", problem, m, "");
  CHECK(text_of(scratch / "run/contacts.csv") == header);
}

TEST_CASE("a state has beside it how its path goes on, with all digits", "[run_directory]") {
  ScratchDirectory scratch;
  const Model m = sample_model();
  Problem problem = sample_problem();
  problem.supports.resize(2);
  problem.supports[1].name = "top";
  RunDirectory run(scratch / "run", problem, m, "");
  Stage stage;
  stage.path.from = 1, stage.path.to = 0, stage.scaling = {{1, 0}, {0, 1}};
  run.enter(stage, m);
  PathPoint p = sample_point(m, 0, 1.0 / 3, "branch:2");
  Resume r;
  r.label = "branch:2", r.before = 0, r.after = 2;
  r.modes = Eigen::MatrixXd::Constant(3, 2, 1.0 / 3), r.modes(2, 1) = -1e-300 / 7;
  r.tangent = Vector::LinSpaced(3, -1.0 / 3, 0.7), r.direction = r.tangent / 3;
  r.load = -0.1 / 3, r.length = 1e-5 / 3, r.step = 1.0 / 7, r.shortest = 1e-9 / 7;
  r.closed = {{0, 4, -1}, {2, -1, 1}};
  p.resume = r;
  run.add(p, Field::Zero(3, 5), {});
  const auto stored = read_supplement(run.state_file("branch:2"));
  REQUIRE(stored);
  REQUIRE(stored->path);
  CHECK(stored->path->varied == std::vector<std::string>{"support.top"});
  CHECK_FALSE(stored->path->rising);
  const Resume& back = stored->path->resume;
  CHECK(back.label == r.label);
  CHECK((back.before == 0 && back.after == 2));
  CHECK(back.modes == r.modes);
  CHECK(back.tangent == r.tangent);
  CHECK(back.direction == r.direction);
  CHECK((back.load == r.load && back.length == r.length && back.step == r.step && back.shortest == r.shortest));
  CHECK(back.closed == r.closed);
}

TEST_CASE("a state has its tails beside it, an event its null vectors, and a stage its name", "[run_directory]") {
  ScratchDirectory scratch;
  Model m = sample_model();
  m.id = {2, 3, 5, 7, 11};
  Problem problem = sample_problem();
  problem.stages.resize(1);
  auto first_run = std::make_unique<RunDirectory>(scratch / "run", problem, m, "");
  RunDirectory& run = *first_run;
  Stage stage;
  stage.name = "load", stage.path.from = 0.1 + 0.2, stage.scaling = {{1, 0}, {-1.0 / 3, 1}};
  run.enter(stage, m);
  PathPoint p = sample_point(m, 0, 1.0 / 3, "limit:1");
  p.state.low(2, 1) = 1e-18 / 3;
  run.add(p, Field::Zero(3, 5), {});
  CHECK(run.record().path().rows[0].back() == Cell(std::string("load")));
  const auto stored = read_supplement(run.state_file("limit:1"));
  REQUIRE(stored);
  CHECK(stored->load_factor == 1.0 / 3);
  CHECK(stored->low == p.state.low);
  REQUIRE(stored->stage);
  CHECK(stored->stage->name == "load");
  CHECK(stored->stage->from == 0.1 + 0.2);
  CHECK(stored->stage->scaling == stage.scaling);
  CHECK(!stored->path);
  CHECK(!read_supplement(scratch / "run/states/none.data"));

  Field first = Field::Zero(3, 5), second = Field::Zero(3, 5);
  first.col(1) = Vec3(0.5, 0, -1), second.col(4) = Vec3(0, 1.0 / 3, 0);
  run.add_null_vectors("limit:1", {first, second});
  CHECK(text_of(scratch / "run/states/limit-1.modes.csv") == "id,ux1,uy1,uz1,ux2,uy2,uz2\n2,0,0,0,0,0,0\n3,0.5,0,-1,0,0,0\n"
                                                             "5,0,0,0,0,0,0\n7,0,0,0,0,0,0\n11,0,0,0,0,0.3333333333333333,0\n");
  first_run.reset();
  RunDirectory again(scratch / "run", problem, m, "");
  for (const char* gone : {"limit-1.data", "limit-1.json", "limit-1.modes.csv"})
    CHECK(!std::filesystem::exists(scratch / (std::string("run/states/") + gone)));
}

TEST_CASE("modes: a table, a shape and a state each", "[run_directory]") {
  ScratchDirectory scratch;
  Model m = sample_model();
  m.id = {2, 3, 5, 7, 11}, m.diameter[3] = 0.25;
  Problem problem = sample_problem();
  problem.study = StudyType::modes, problem.modes.count = 3;
  {
    RunDirectory run(scratch / "run", problem, m, "");
    CHECK(!std::filesystem::exists(scratch / "run/modes.csv"));
    Mode turning, bending;
    turning.eigenvalue = 0.125, turning.zero_mode = "rotation of 'a' about x through (0, 0, 0)";
    turning.shape = Field::Zero(3, 5), turning.shape.col(1) = Vec3(0.6, 0, 0), turning.shape.col(2) = Vec3(0, 0, -0.8);
    bending.eigenvalue = -2, bending.shape = Field::Zero(3, 5);
    run.add(sample_point(m, 0, 1, "final"), Field::Zero(3, 5), {}, {0.125, -2});
    run.add_mode(turning, m.start);
    run.add_mode(bending, m.start);
    CHECK(text_of(scratch / "run/modes.csv") ==
          "mode,eigenvalue,zero_mode\n1,0.125,\"rotation of 'a' about x through (0, 0, 0)\"\n2,-2,\n");
    CHECK(text_of(scratch / "run/modes/mode-1.csv") == "id,ux,uy,uz\n2,0,0,0\n3,0.6,0,0\n"
                                                       "5,0,0,-0.8\n7,0,0,0\n11,0,0,0\n");
    const Field moved = read_lammps_data(scratch / "run/states/mode-1.data").position - m.start.position;
    CHECK(moved(2, 2) == Approx(-0.025).epsilon(1e-14));         // a tenth of the smallest diameter
    CHECK(moved(0, 1) == Approx(0.025 * 0.6 / 0.8).epsilon(1e-14));
    CHECK(moved.col(4).isZero(0));
    CHECK(read_lammps_data(scratch / "run/states/mode-2.data").position == m.start.position);
    const auto& columns = run.record().path().columns;
    CHECK(std::vector<std::string>(columns.end() - 6, columns.end() - 2) ==
          std::vector<std::string>{"mid_x", "eigenvalue_1", "eigenvalue_2", "eigenvalue_3"});
    run.finish({});
    const json j = json::parse(text_of(scratch / "run/summary.json"));
    CHECK(j["final"]["eigenvalue_2"] == -2.0);
    CHECK(j["final"]["eigenvalue_3"].is_null());                 // fewer dofs than modes asked for
  }
  RunDirectory run(scratch / "run", problem, m, "");
  for (const char* gone : {"run/modes.csv", "run/modes", "run/states/mode-1.data"})
    CHECK(!std::filesystem::exists(scratch / gone));
}

TEST_CASE("a run that found nothing still has a summary", "[run_directory]") {
  ScratchDirectory scratch;
  const Model m = sample_model();
  const Problem problem = sample_problem();
  RunDirectory run(scratch / "run", problem, m, "");
  Summary summary;
  summary.status = status_name(Status::not_converged);
  run.finish(summary);
  const json j = json::parse(text_of(scratch / "run/summary.json"));
  CHECK(j["status"] == "not_converged");
  CHECK(j["final"].is_null());
  CHECK(j["events"].empty());
  CHECK(j["events"].is_array());
  CHECK(status_name(Status::interrupted) == "interrupted");
}

TEST_CASE("a second run in the same directory leaves nothing of the first, and nothing else is touched",
          "[run_directory]") {
  ScratchDirectory scratch;
  const Model m = sample_model();
  const Problem problem = sample_problem();
  {
    RunDirectory run(scratch / "run", problem, m, "");
    run.add(sample_point(m, 0, 0, "limit:1"), Field::Zero(3, 5), {});
    run.finish({});
  }
  const std::set<std::string> own = files_in(scratch / "run");
  CHECK(own.size() == 10);
  CHECK(listed_in(scratch / "run") == own);
  CHECK(text_of(scratch / "run/.gitignore") == "*\n");
  const std::vector<std::string> mine{"notes.txt", "states/mine.data", "states/mine.csv", "states/mine.json", "modes/mode-1.csv", "states/jump-1.data"};
  std::filesystem::create_directories(scratch / "run/modes");
  for (const std::string& name : mine) scratch.file("run/" + name, "mine");
  std::ofstream(scratch / "run/.elamin", std::ios::app) << "../outside.txt\n" << scratch / "outside.txt" << "\nstates\n\n";
  scratch.file("outside.txt", "mine");
  RunDirectory run(scratch / "run", problem, m, "");
  CHECK(!std::filesystem::exists(scratch / "run/states/limit-1.data"));
  CHECK(!std::filesystem::exists(scratch / "run/summary.json"));
  CHECK(rows_in(scratch / "run/path.csv") == 1);
  CHECK(rows_in(scratch / "run/events.csv") == 1);
  run.add(sample_point(m, 0, 0, "jump:1"), Field::Zero(3, 5), {});
  CHECK(std::filesystem::exists(scratch / "run/states/jump-1-again.data"));
  for (const std::string& name : mine) CHECK(text_of(scratch / ("run/" + name)) == "mine");
  CHECK(text_of(scratch / "outside.txt") == "mine");
}

TEST_CASE("a directory that holds something else is no place for results, unless forced", "[run_directory]") {
  ScratchDirectory scratch;
  const Model m = sample_model();
  const Problem problem = sample_problem();
  const std::string run = scratch / "run";
  std::filesystem::create_directories(run + "/states");
  scratch.file("run/resolved.toml", "mine"), scratch.file("run/states/mine.csv", "mine"), scratch.file("run/.elamin", "mine\n");
  const auto refused = [&] {
    const std::set<std::string> before = files_in(run);
    CHECK_THROWS_WITH(RunDirectory(run, problem, m, ""),
                      run + ": is not empty and not the results of a run: it holds .elamin, resolved.toml, states; choose another directory by -o, "
                            "or --force to write there all the same, over files of the same names");
    CHECK(files_in(run) == before);
  };
  refused();
  std::filesystem::remove(run + "/.elamin"), std::filesystem::create_directory(run + "/.elamin");
  refused();
  std::filesystem::remove(run + "/.elamin");
  { RunDirectory(run, problem, m, "", true); }
  CHECK(text_of(run + "/resolved.toml").empty());
  CHECK(text_of(run + "/states/mine.csv") == "mine");
  CHECK_NOTHROW(RunDirectory(run, problem, m, ""));                         // results by now, as an empty directory becomes
  std::filesystem::create_directory(scratch / "empty");
  CHECK_NOTHROW(RunDirectory(scratch / "empty", problem, m, ""));
}

TEST_CASE("a directory that cannot be made is a sentence, and a wrong observable makes none", "[run_directory]") {
  ScratchDirectory scratch;
  const Model m = sample_model();
  Problem problem = sample_problem();
  scratch.file("taken", "a file");
  try {
    RunDirectory(scratch / "taken", problem, m, "");
    FAIL("no error");
  } catch (const OutputError& e) {
    CHECK(std::string(e.what()).find("taken: cannot be created: ") != std::string::npos);
  }
  problem.observe[0].group = "nobody";
  CHECK_THROWS_AS(RunDirectory(scratch / "run", problem, m, ""), InputError);
  CHECK(!std::filesystem::exists(scratch / "run"));
}
