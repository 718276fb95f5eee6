// [[event]]: where an observable reaches a value.
#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"
#include "study/truss.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace {

std::string event(const std::string& name, const std::string& observable, double value, const std::string& more = "") {
  return "[[event]]\nname = \"" + name + "\"\nobservable = \"" + observable + "\"\nvalue = " + std::to_string(value) + "\n" + more;
}

}  // namespace

TEST_CASE("an observable that reaches a value is located, whatever the steps", "[events]") {
  for (const char* steps : {"7", "40"}) {
    const ScratchDirectory scratch;
    const std::string file = scratch.file("p.toml", truss + "[path]\nto = 0.4\nsteps = " + steps + "\n" + event("high", "z", 0.4) + event("low", "z", -0.7));
    REQUIRE(elamin_says("'" + file + "' --quiet").status == 0);
    const std::vector<TableRow> events = table_of(scratch / "p/events.csv");
    for (const auto& [label, z] : {std::pair{"high:1", 0.4}, {"low:1", -0.7}}) {
      const TableRow row = row_of(events, label);
      CHECK(row["z"] == Approx(z).epsilon(1e-10));
      CHECK(row["lambda"] == Approx(truss_load(z)).epsilon(1e-9));
      CHECK(row["residual"] < 1e-10);
    }
    CHECK(std::filesystem::exists(scratch / "p/states/high-1.data"));
    int count = 0;
    for (const TableRow& row : events) count += row.text("label").starts_with("high") || row.text("label").starts_with("low");
    CHECK(count == 2);
  }
}

TEST_CASE("an observable that reaches its value at a load factor to stop at is one event, and the path stops there", "[events]") {
  for (const double z : {0.0, 0.31, 0.1, -0.2, -0.43})
    for (const char* steps : {"6", "25"}) {
      CAPTURE(z, steps);
      const ScratchDirectory scratch;
      const double load = truss_load(z);
      const std::string stop = fmt::format("stops = [{:.17g}]\n", load), value = fmt::format("[[event]]\nname = \"there\"\nobservable = \"z\"\nvalue = {:.17g}\n", z);
      const std::string file = scratch.file("p.toml", truss + "[path]\nmethod = \"arc_length\"\nto = 0.4\nsteps = " + steps + "\n" + stop + value);
      REQUIRE(elamin_says("'" + file + "' --quiet").status == 0);
      int events = 0, stopped = 0;
      for (const TableRow& row : table_of(scratch / "p/events.csv")) events += row.text("label").starts_with("there");
      for (const TableRow& row : table_of(scratch / "p/path.csv"))
        if (row["lambda"] == load && std::abs(row["z"] - z) < 1e-12) ++stopped;
      CHECK(events == 1);
      CHECK(stopped >= 1);
    }
}

TEST_CASE("an event may be about a reaction, may end the path, and may be expected", "[events]") {
  const ScratchDirectory scratch;
  const std::string push = "[[observe]]\nname = \"thrust\"\ngroup = \"feet\"\nquantity = \"reaction.x\"\nreduce = \"max\"\n";
  const std::string expect = "[[expect]]\nobservable = \"thrust\"\nat = \"hard:1\"\nvalue = 0.05\nrtol = 1e-9\n[[expect]]\nobservable = \"thrust\"\nat = \"final\"\nvalue = 0.05\nrtol = 1e-9\n";
  const std::string file = scratch.file("p.toml", truss + push + "[path]\nto = 0.08\n" + event("hard", "thrust", 0.05, "stop = true\n") + expect);
  const Answer answer = elamin_says("verify --quiet '" + file + "'");
  INFO(answer.text);
  CHECK(answer.status == 0);
  const std::vector<TableRow> path = table_of(scratch / "p/path.csv");
  CHECK(path.back().text("label") == "hard:1");
  CHECK(path.back()["lambda"] < 0.08);
}
