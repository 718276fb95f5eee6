#include "results/table.hpp"

#include "catch.hpp"
#include "core/error.hpp"
#include "results/columns.hpp"
#include "results/sample.hpp"
#include "scratch_directory.hpp"

#include <bit>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <thread>

using namespace elamin;

TEST_CASE("cells of a CSV file", "[table]") {
  CHECK(csv_text({}) == "");
  CHECK(csv_text(true) == "true");
  CHECK(csv_text(false) == "false");
  CHECK(csv_text(-3) == "-3");
  CHECK(csv_text(std::string("branch:1")) == "branch:1");
  CHECK(csv_text(std::string("a,b")) == "\"a,b\"");
  CHECK(csv_text(std::string("say \"x\"\n")) == "\"say \"\"x\"\"\n\"");
  CHECK(csv_text(std::nan("")) == "");
  CHECK(csv_text(std::numeric_limits<double>::infinity()) == "");
  for (const double x : {0.1, 1.0 / 3, -1e-300, 5e-324, 1.7976931348623157e308})
    CHECK(std::strtod(csv_text(x).c_str(), nullptr) == x);
  std::mt19937_64 random(1);
  for (int k = 0; k < 100000; ++k) {
    const double x = std::bit_cast<double>(random());
    const std::string text = csv_text(x);
    if (std::isfinite(x)) CHECK((std::strtod(text.c_str(), nullptr) == x && text.size() <= 24));
    else CHECK(text.empty());
  }
  CHECK(csv_text(0.3) == "0.3");
  CHECK(csv_text(2.0) == "2");
  CHECK(csv_text(-0.0) == "-0");
  CHECK(csv_text(1e-7) == "1e-07");
  CHECK(csv_text(0.3, Digits::all) == "0.29999999999999999");
  CHECK(as_number(true) == 1.0);
  CHECK(as_number(2) == 2.0);
  CHECK(as_number(0.5) == 0.5);
  CHECK(!as_number(std::nan("")));
  CHECK(!as_number(std::string("1")));
  CHECK(!as_number({}));
}

TEST_CASE("a CSV file has every row as soon as it is added", "[table]") {
  ScratchDirectory scratch;
  CsvFile csv(scratch / "a.csv", {"x", "a,b"});
  CHECK(text_of(scratch / "a.csv") == "x,\"a,b\"\n");
  csv.add({1, 0.5});
  CHECK(text_of(scratch / "a.csv") == "x,\"a,b\"\n1,0.5\n");
  csv.add({Cell{}, true});
  CHECK(text_of(scratch / "a.csv") == "x,\"a,b\"\n1,0.5\n,true\n");
  CHECK_THROWS_AS(csv.add({1}), std::logic_error);
  CHECK_THROWS_AS(CsvFile(scratch / "none/a.csv", {"x"}), OutputError);
  if (std::ifstream("/dev/full")) CHECK_THROWS_AS(CsvFile("/dev/full", {"x"}), OutputError);
}

TEST_CASE("a CSV file that is written whole is there when it is kept, and nothing of it before", "[table]") {
  ScratchDirectory scratch;
  const std::string file = scratch / "a.csv", beside = file + ".new";
  std::ofstream(file) << "before\n";
  const std::string text(1 << 21, 'x');                           // more than is written at once
  {
    WholeCsv csv(file, {"t"});
    csv.add({text});
    CHECK(text_of(file) == "before\n");
    CHECK(std::filesystem::exists(beside));
  }
  CHECK(text_of(file) == "before\n");
  CHECK(!std::filesystem::exists(beside));
  WholeCsv csv(file, {"t"});
  for (int k = 0; k < 2; ++k) csv.add({text});
  CHECK_THROWS_AS(csv.add({1, 2}), std::logic_error);
  csv.keep();
  CHECK(text_of(file) == "t\n" + text + "\n" + text + "\n");
  CHECK(!std::filesystem::exists(beside));
  if (std::ifstream("/dev/full")) CHECK_THROWS_AS(WholeCsv("/dev/full", {"t"}).add({text}), OutputError);
}

TEST_CASE("columns of path.csv, events.csv and sweep.csv fit their rows", "[table]") {
  const Model m = sample_model();
  const std::vector<std::string> names{"mid_x", "push"};
  Table path{path_columns(names), {}}, events{event_columns(names), {}};
  CHECK(path.columns == std::vector<std::string>{"step", "label", "branch", "lambda", "energy", "bond", "angle",
                                                 "contact", "wall", "cohesion", "body", "external", "residual", "iterations",
                                                 "negative", "stable", "mid_x", "push", "parent", "negative_rigid"});
  CHECK(events.columns == std::vector<std::string>{"label", "lambda", "multiplicity", "step", "branch", "energy",
                                                   "bond", "angle", "contact", "wall", "cohesion", "body", "external",
                                                   "residual", "iterations", "negative", "stable", "mid_x", "push",
                                                   "parent", "negative_rigid", "negative_before", "negative_after",
                                                   "what"});
  PathPoint p = sample_point(m, 3, 0.25, "branch:1");
  p.branch = 1, p.multiplicity = 2, p.stability.negative = 5, p.stability.stable = false, p.report.iterations = 8;
  p.parent = "limit:1", p.stability.negative_rigid = 4, p.negative_after = 6, p.what = "1 touches 2";
  path.rows.push_back(path_row(p, {0.75, -2}));
  events.rows.push_back(event_row(p, {0.75, -2}));
  const auto cell = [](const Table& t, const std::string& name) {
    return t.rows.at(0).at(t.column(name));
  };
  for (const Table* t : {&path, &events}) {
    REQUIRE(t->rows[0].size() == t->columns.size());
    CHECK(cell(*t, "step") == Cell(3));
    CHECK(cell(*t, "label") == Cell(std::string("branch:1")));
    CHECK(cell(*t, "branch") == Cell(1));
    CHECK(cell(*t, "lambda") == Cell(0.25));
    CHECK(cell(*t, "energy") == Cell(p.energy.total()));
    CHECK(cell(*t, "bond") == Cell(p.energy.bond));
    CHECK(cell(*t, "angle") == Cell(p.energy.angle));
    CHECK(cell(*t, "contact") == Cell(1.5));
    CHECK(cell(*t, "wall") == Cell(0.0625));
    CHECK(cell(*t, "cohesion") == Cell(-0.375));
    CHECK(cell(*t, "external") == Cell(p.energy.external));
    CHECK(cell(*t, "residual") == Cell(3e-14));
    CHECK(cell(*t, "iterations") == Cell(8));
    CHECK(cell(*t, "negative") == Cell(5));
    CHECK(cell(*t, "stable") == Cell(false));
    CHECK(cell(*t, "mid_x") == Cell(0.75));
    CHECK(cell(*t, "push") == Cell(-2.0));
    CHECK(cell(*t, "parent") == Cell(std::string("limit:1")));
    CHECK(cell(*t, "negative_rigid") == Cell(4));
  }
  CHECK(cell(events, "negative_before") == Cell());            // −1: not known
  CHECK(cell(events, "negative_after") == Cell(6));
  CHECK(cell(events, "what") == Cell(std::string("1 touches 2")));
  CHECK(cell(events, "multiplicity") == Cell(2));
  CHECK(path.column("multiplicity") == -1);

  // A path in stages says of which at the very end.
  CHECK(path_columns(names, true).back() == "stage");
  CHECK(event_columns(names, true).back() == "stage");
  for (const Row& r : {path_row(p, {0.75, -2}, "load"), event_row(p, {0.75, -2}, "load")}) CHECK(r.back() == Cell(std::string("load")));
  CHECK(event_row(p, {0.75, -2}, "load").size() == event_columns(names, true).size());

  Problem problem;
  problem.observe = {observe("mid_x", "two", Quantity::position, Component::x, Reduce::mean),
                     observe("push", "two", Quantity::reaction, Component::x, Reduce::sum)};
  problem.events.push_back({{}, "aside", "mid_x", 1, false});
  const auto columns = sweep_columns({"beam.column.particles"}, problem);
  const Row row = sweep_row({14}, "done", path, events, problem);
  REQUIRE(row.size() == columns.size());
  CHECK(row[Table{columns, {}}.column("beam.column.particles")] == Cell(14));
  CHECK(row[Table{columns, {}}.column("status")] == Cell(std::string("done")));
  CHECK(row[Table{columns, {}}.column("branch:1")] == Cell(0.25));
  CHECK(row[Table{columns, {}}.column("limit:1")] == Cell());
  CHECK(row[Table{columns, {}}.column("aside:1")] == Cell());
  CHECK(row[Table{columns, {}}.column("push")] == Cell(-2.0));
  CHECK(sweep_row({14}, "not_converged", {path.columns, {}}, {events.columns, {}}, problem).size() == columns.size());
  CHECK(is_event("limit:2"));
  CHECK(!is_event("final"));
}

TEST_CASE("rows of a sweep stand in the order of its runs", "[table]") {
  ScratchDirectory scratch;
  std::string expected = "run\n";
  {
    SweepTable sweep(scratch / "sweep.csv", {"run"});
    sweep.add(1, {1});
    CHECK(text_of(scratch / "sweep.csv") == "run\n");
    sweep.add(0, {0});
    CHECK(text_of(scratch / "sweep.csv") == "run\n0\n1\n");
    std::vector<std::thread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&, t] {
        for (int i = 49 - t; i >= 2; i -= 4) sweep.add(i, {i});
      });
    for (auto& t : threads) t.join();
    sweep.add(60, {60});                          // run 50 never ends: what is known is kept
  }
  for (int i = 0; i < 50; ++i) expected += std::to_string(i) + "\n";
  CHECK(text_of(scratch / "sweep.csv") == expected + "60\n");
}
