// Commands that do something else in LAMMPS than they seem to say. The numbers are LAMMPS's (29 Sep 2021), of a dump with %.17g.
#include "catch.hpp"
#include "energy/energy.hpp"
#include "lammps/script_reading.hpp"

namespace elamin::as_lammps {                    // names of its own: tests of a folder are compiled together

using script::Reading;

namespace {

const std::string box = "units lj\natom_style sphere\nboundary f f f\nregion box block -5 5 -5 5 -5 5\ncreate_box 2 box\n";
const std::string atoms = "create_atoms 1 single 0 0 0\ncreate_atoms 2 single 0.8 0 0\n";
const std::string spheres = "set group all diameter 1.0\nset group all density 2\n";
const std::string stiff = "pair_style granular\npair_coeff * * hertz 1000 0 tangential linear_nohistory 0 0\n";
const std::string soft = "pair_style granular\npair_coeff * * hertz 0 0 tangential linear_nohistory 0 0\n";
const std::string two = box + atoms + spheres;  // 0.2 within each other
constexpr double touching = -44.721359549995775;          // the force on the first
const std::string end = "fix 1 all nve/sphere\nrun 0\n";

double first_force(const ImportedProblem& p) { return Energy(p.model).forces(p.model.start)(0, 0); }
double first_force(const std::string& text) { return first_force(imported(text)); }
bool near(double value, double expected) { return std::abs(value - expected) <= 1e-14 * std::abs(expected); }

std::string report_of(const std::string& text, const script::TranslationOptions& options = {}) {
  const Reading r = reading_of(text);
  return script::report(r, script::translated(r, r.passes.at(0), options, "p.data").notes);
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string refused_motion(const std::string& text) {
  try {
    report_of(text, {true, false, false});
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a mistake about the name that a command makes is told", "[script]") {
  const auto told = [](const std::string& line) { return script_mistakes(two + stiff + line + end); };    // the line is the 12th
  CHECK(told("fix grav grav gravity 1 vector 0 0 -1\n") == "12:10: fix: \"grav\" is no group; there are: all");
  CHECK(told("group clamp region clamp\n") == "12:20: group: \"clamp\" is no region; there are: box");
  CHECK(holds(told("region tube tube z 0 0 1 INF INF\n"), "12:13: region: \"tube\" is no style of a region"));
  CHECK(holds(told("fix setforse all setforse 0 0 0\n"), "12:18: fix: \"setforse\" is no fix that is known here"));
  CHECK(script_mistakes("units lj\nregion box box 0 1\ncreate_box 1 box\n").starts_with("2:12: region: \"box\" is no style of a region"));
  script::ReadingOptions skip;                   // what follows from what is left out is left out, and told
  skip.skip = true;
  const Reading r = reading_of(two + stiff + "region r prism 0 1 0 1 0 1 0 0 0\ngroup g region r\nvariable a python f\n"
                               "create_atoms 1 single ${a} 0 0\n" + end, skip);
  const std::string left_out = script::report(r, {});
  for (const char* line : {"in.lmp:12: region", "in.lmp:13: group", "in.lmp:14: variable", "in.lmp:15: create_atoms"}) CHECK(holds(left_out, line));
}

TEST_CASE("pairs that neigh_modify leaves out do not touch", "[script]") {
  const std::string groups = "group a id 1\ngroup b id 2\n";
  CHECK(near(first_force(two + stiff + end), touching));
  CHECK(near(first_force(two + stiff + "neigh_modify every 1 delay 0 check yes exclude type 1 1\n" + end), touching));
  for (const std::string what : {"type 1 2", "type 2 1", "group a b", "group b all"}) {
    INFO(what);
    CHECK(first_force(two + stiff + groups + "neigh_modify delay 0 exclude " + what + "\n" + end) == 0);
    CHECK(near(first_force(two + stiff + groups + "neigh_modify exclude " + what + "\nneigh_modify exclude none\n" + end), touching));
  }
  const std::string molecules = "units lj\natom_style hybrid sphere angle\nboundary f f f\nregion box block -5 5 -5 5 -5 5\ncreate_box 2 box\n" +
                                atoms + spheres + stiff;
  CHECK(first_force(molecules + "neigh_modify exclude molecule/intra all\n" + end) == 0);
  CHECK(near(first_force(molecules + "set atom 2 mol 1\nneigh_modify exclude molecule/intra all\n" + end), touching));
  CHECK(first_force(two + "pair_style lj/cut 2\npair_coeff * * 1 .7\nneigh_modify exclude type 1 2\n" + end) == 0);
  CHECK(holds(script_mistakes(two + stiff + "neigh_modify exclude molecule/inter all\n" + end), "12:22: neigh_modify: \"molecule/inter\" says of no pairs"));
  // Coefficients that change later do not bring them back.
  const ImportedProblem p = imported(two + stiff + "neigh_modify exclude type 1 2\nfix 1 all nve/sphere\nrun 1\n"
                                     "pair_coeff 1 2 hertz 500 0 tangential linear_nohistory 0 0\nrun 1\n");
  REQUIRE(p.problem.stages.size() == 2);
  REQUIRE(p.problem.contacts.size() == 4);
  CHECK(p.problem.contacts.back().effective_modulus == 0);
  CHECK(p.problem.contacts.back().from_stage == "run2");
}

TEST_CASE("atoms that are moved before a run of no steps, or before none, are where they are then", "[script]") {
  const std::string apart = box + "create_atoms 1 single 0 0 0\ncreate_atoms 2 single 2 0 0\n" + spheres + stiff + "group g id 2\nfix 1 all nve/sphere\n";
  for (const std::string run : {"run 0\n", "run 1\n"}) {
    INFO(run);
    CHECK(near(first_force(apart + "displace_atoms g move -1.2 0 0\n" + run), touching));
    CHECK(near(first_force(apart + "set atom 2 x 0.8\n" + run), touching));
  }
  CHECK(first_force(apart + "run 0\nset atom 2 x 0.8\n") == 0);
  CHECK(imported(apart + "set atom 2 x 0.8\n").model.start.position(0, 1) == 0.8);
}

TEST_CASE("behind a clear a run of no steps is a problem, too", "[script]") {
  const Reading r = reading_of(two + soft + "clear\n" + two + stiff + end);       // nothing was run before
  REQUIRE(r.passes.size() == 1);
  CHECK(near(first_force(imported(r)), touching));
  CHECK(reading_of(two + stiff + "fix 1 all nve\nrun 10\nclear\n" + two + stiff + end).passes.size() == 2);
  CHECK(reading_of(two + stiff + end + "clear\n" + two + stiff + end).passes.size() == 2);
}

}  // namespace elamin::as_lammps
