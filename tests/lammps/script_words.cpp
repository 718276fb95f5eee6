// Lines, words and formulas as LAMMPS takes them: what is expected was printed by LAMMPS 29 Sep 2021.
#include "catch.hpp"
#include "lammps/script_reading.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

using namespace elamin;

namespace {

std::string words_in(const std::string& text) {
  std::vector<std::string> words;
  for (const script::Line& line : script::lines_of(text)) {
    for (const script::Word& w : script::split(script::without_comment(line.text))) words.push_back("<" + w.text + ">");
    words.push_back("|");
  }
  return fmt::format("{}", fmt::join(words, ""));
}

script::Names names() {
  script::Names n;
  n.variables["i"] = {script::Variable::Style::loop, {}, 2, 12, true, 0};
  n.variables["w"] = {script::Variable::Style::index, {"2.5", "3"}, 1, 1, false, 0};
  n.variables["q"] = {script::Variable::Style::equal, {"0.1+0.2"}, 1, 1, false, 0};
  n.variables["a"] = {script::Variable::Style::atom, {"x*y+id"}, 1, 1, false, 0};
  n.variables["s"] = {script::Variable::Style::string, {"abc"}, 1, 1, false, 0};
  return n;
}

const std::string three_atoms =
    "units si\natom_style hybrid sphere angle\nregion b block -1 1 -1 1 -2 3\ncreate_box 2 b\nchange_box all boundary f f f\n"
    "create_atoms 1 single 0.1 0.2 0.3\ncreate_atoms 2 single 0.5 -0.2 0.4\ncreate_atoms 2 single -0.5 -0.7 2.4\nset type 2 diameter 0.5\n"
    "group g type 2\nregion r sphere 0.5 0 0 0.6\ntimestep 1e-3\n";

script::World world() { return reading_of(three_atoms).passes.at(0).world; }

}  // namespace

TEST_CASE("lines of a script become words", "[script]") {
  CHECK(words_in("a  b\tc\r\n\n  # all of it\nd#e\n") == "<a><b><c>||<d>|");
  CHECK(words_in("a b &\n  c & \nd\ne") == "<a><b><c><d>|<e>|");
  CHECK(words_in("print \"one # two\" 'a \"b\" c' x\"y") == "<print><one # two><a \"b\" c><x\"y>|");
  CHECK(words_in("print \"\"\"two\nlines \"quoted\" \"\"\" end\nnext") == "<print><two\nlines \"quoted\" ><end>|<next>|");
  CHECK(words_in("a # comment &\nb") == "<a>|");                // as LAMMPS has it: the comment goes on
  CHECK_THROWS_AS(script::split("a \"b"), script::Wrong);
  CHECK_THROWS_AS(script::split("a \"b\"c"), script::Wrong);
  const auto lines = script::lines_of("first\na &\n bc\n");
  REQUIRE(lines.size() == 2);
  CHECK(lines[1].place(0).line == 2);
  CHECK(lines[1].place(lines[1].text.find("bc")).line == 3);
  CHECK(lines[1].place(lines[1].text.find("bc")).column == 2);
}

TEST_CASE("variables are put into lines outside of quotes", "[script]") {
  const script::World w = world();
  const script::Names n = names();
  const script::Substitution by{[&](const std::string& v) { return script::text_of(v, w, n); }, [&](const std::string& f) { return script::immediate(f, w, n); }};
  CHECK(script::substituted("$i ${w}$s ${q} $(v_q) $(v_q:%.3f) \"$i\" '${nothing}'", by) == "02 2.5abc 0.3 0.2999999999999999889 0.300 \"$i\" '${nothing}'");
  CHECK_THROWS_WITH(script::substituted("${nothing}", by), "there is no variable \"nothing\"");
  CHECK_THROWS_AS(script::substituted("$", by), script::Wrong);
  CHECK_THROWS_AS(script::substituted("${q", by), script::Wrong);
  CHECK_THROWS_AS(script::substituted("$(1+", by), script::Wrong);
  CHECK_THROWS_AS(script::substituted("$a", by), script::Wrong);
  CHECK_THROWS_AS(script::immediate("1:%s", w, n), script::Wrong);
  CHECK_THROWS_AS(script::immediate("1:%d %f", w, n), script::Wrong);
  CHECK_THROWS_AS(script::immediate("1:%.9999999f", w, n), script::Wrong);
}

TEST_CASE("formulas have LAMMPS's values", "[script]") {
  const script::World w = world();
  const script::Names n = names();
  // As LAMMPS printed ${z}, with 15 digits.
  const std::pair<const char*, const char*> values[]{
      {"-2^2", "4"}, {"2^3^2", "64"}, {"2^-1", "0.5"}, {"1+2*3-4/8", "6.5"}, {"7.5%4", "3.5"}, {"-7%4", "-3"}, {"!0+!5", "1"}, {"3>2&&1||0", "1"},
      {"1|^1", "0"}, {"2==2.0&&!(3!=3)", "1"}, {"1<2<3", "1"}, {"-(-3)", "3"}, {"--3", "3"}, {"1e3+1.5E-2", "1000.015"}, {".5", "0.5"},
      {"PI*2", "6.28318530717959"}, {"sqrt(2)*exp(1)-ln(10)", "1.54164593516507"}, {"log(1000)+abs(-2)", "5"}, {"atan2(1,-2)", "2.67794504458899"},
      {"round(2.5)+ceil(1.2)-floor(-1.2)", "7"}, {"asin(1)+acos(0)+atan(1)", "3.92699081698724"}, {"sin(1)*cos(1)/tan(1)", "0.291926581726429"},
      {"count(all)+count(g)", "5"}, {"mass(g)", "1.0471975511966"}, {"mass(all)", "1.5707963267949"}, {"xcm(g,x)", "0"}, {"xcm(all,z)", "1.03333333333333"},
      {"bound(g,zmax)-bound(all,xmin)", "2.9"}, {"count(all,r)+xcm(g,y,r)", "1.8"}, {"x[2]+y[3]*z[1]", "0.29"}, {"mass[1]+type[3]+id[2]", "4.5235987755983"},
      {"xlo+zhi+lx*ly", "6"}, {"vol", "20"}, {"atoms+dt+step", "3.001"}, {"v_q*v_w", "0.75"}, {"v_i+1", "3"}, {"2*(3+(4-1))^2", "72"},
      {"yes+on*true-no", "2"}, {"v_a[2]", "1.9"}};
  for (const auto& [formula, value] : values) {
    INFO(formula);
    CHECK(script::formatted("%.15g", script::number_of(formula, w, n, 0), 0) == value);
  }
  const script::Value each = script::evaluate("v_a + (z > 1)*10", w, n, 0, true);
  REQUIRE(each.each.size() == 3);
  CHECK(each.each[0] == 0.1 * 0.2 + 1);
  CHECK(each.each[2] == (-0.5 * -0.7 + 3) + 10);
}

TEST_CASE("variables have 15 digits in formulas, and all of them alone", "[script]") {
  // LAMMPS 29 Sep 2021: variable third equal 1/3; print $(v_third*3-1:%.17g)
  script::Names n;
  n.variables["third"] = {script::Variable::Style::equal, {"1/3"}, 1, 1, false, 0};
  CHECK(script::number_of("v_third*3-1", {}, n, 0) == -1.1102230246251565e-15);
  CHECK(script::number_of("v_third", {}, n, 0) == 1. / 3);
  CHECK(script::immediate("v_third:%.17g", {}, n) == "0.33333333333333298");
}

TEST_CASE("random numbers are LAMMPS's", "[script]") {
  // LAMMPS 29 Sep 2021. All formulas draw from one generator, which has the seed of the first; displacements draw by place.
  const script::Reading r = reading_of(R"lmp(atom_style sphere
region box block -10 10 -10 10 -10 10
create_box 1 box
change_box all boundary f f f
create_atoms 1 single 0 0 0
create_atoms 1 single 6 -0.3 1.7
displace_atoms all random 0.1 0.2 0.3 12345
variable r equal random(-1,3,4711)
variable g equal normal(1,0.5,99)
print "$r"
variable a equal $r
create_atoms 1 single $(v_a) $(v_g) $(v_g)
create_atoms 1 single $(v_g) $(v_r) 0
variable s equal v_r+v_r
create_atoms 1 single $(v_s) 0 0
if "$r > 0" then "create_atoms 1 single 9 9 $(v_r)"
displace_atoms all move 0 0 0
)lmp");
  const std::vector<script::Atom>& atoms = r.passes.at(0).world.atoms;
  REQUIRE(atoms.size() == 6);
  CHECK(atoms[0].x == Vec3(0.076389951434168005, 0.17182750812351122, -0.14260645222040194));
  CHECK(atoms[1].x == Vec3(6.0544449293773832, -0.1881439086460247, 1.64799107939377));
  CHECK(atoms[2].x == Vec3(-0.031625747680664097, 0.44704757778385801, 0.62525797859535803));
  CHECK(atoms[3].x == Vec3(0.50035371999885203, 1.2727210521698, 0));
  CHECK(atoms[4].x == Vec3(0.386173725128171, 0, 0));
  CHECK(atoms[5].x == Vec3(9, 9, 0.46766328811645502));
  CHECK(script_mistakes("variable r atom random(0,1,7)\n" + small_script_head +
                        "create_atoms 1 single 0 0 0\ndisplace_atoms all move v_r 0 0\n").find("random() of every atom") != std::string::npos);
}

TEST_CASE("formulas that are none are told", "[script]") {
  const script::World w = world();
  script::Names n = names();
  n.variables["round"] = {script::Variable::Style::equal, {"v_round+1"}, 1, 1, false, 0};
  n.variables["wide"] = {script::Variable::Style::equal, {"1"}, 1, 1, false, 0};
  std::string before = "wide";
  for (int k = 0; k < 50; ++k) {                 // 2^50 numbers
    const std::string name = fmt::format("wide{}", k);
    n.variables[name] = {script::Variable::Style::equal, {fmt::format("v_{0}+v_{0}", before)}, 1, 1, false, 0};
    before = name;
  }
  for (const char* formula : {"", "1+", "(1", "1)", "2**3", "1 2", "x", "x[4]", "x[1e30]", "v_nothing", "v_s+1", "c_nothing", "f_1", "fx[1]", "sqrt(-1)", "ln(0)", "1/0",
                              "mass(nobody)", "count(all,nowhere)", "xcm(all,w)", "atan2(1)", "foo(1)", "foo", "v_round", "temp", "random(0,1)", "random(0,1,0)", "normal(0,1,1e9)", "v_a", "1e", "@",
                              "((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((((1"}) {
    INFO(formula);
    CHECK_THROWS_AS(script::number_of(formula, w, n, 0), script::Wrong);
  }
  CHECK_THROWS_AS(script::number_of("v_" + before, w, n, 0), script::Wrong);
}

TEST_CASE("conditions of if compare numbers and words", "[script]") {
  for (const char* yes : {"1 == 1.0", "abc == abc", "a != b", "!0", "(2 > 1) && (3 <= 3)", "0 || 1 |^ 0", "\"a b\" == 'a b'", "-1<0"}) CHECK(script::condition(yes, 0));
  for (const char* no : {"1 == 2", "abc != abc", "!1", "1 && 0", "1 |^ 1", "2 >= 3"}) CHECK_FALSE(script::condition(no, 0));
  for (const char* wrong : {"", "1 == a", "a < b", "(1", "1 1", "a", "== 1", "!a", "'a"}) CHECK_THROWS_AS(script::condition(wrong, 0), script::Wrong);
}
