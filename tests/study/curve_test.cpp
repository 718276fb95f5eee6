// [curve]: thresholds in a second parameter, against closed forms.
#include "catch.hpp"
#include "laws/section.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"
#include "study/truss.hpp"

#include <algorithm>
#include <cmath>

namespace {

using elamin::pi;

// Curves are computed until corrections are rounding: some 1e-15 of the load factor, more where forces cancel. [1]
constexpr double curve_rounding = 1e-12;

std::string curve(const std::string& of, const std::string& second, double from, double to, const std::string& more = "") {
  std::ostringstream text;
  text.precision(17);
  text << "[curve]\nof = \"" << of << "\"\nsecond = \"" << second << "\"\nfrom = " << from << "\nto = " << to << "\n" << more;
  return text.str();
}

/// The rows of curve.csv of a problem that must end well.
std::vector<TableRow> curve_of(const std::string& problem) {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", problem);
  const Answer answer = elamin_says("'" + file + "' --quiet", 60);
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  return table_of(scratch / "p/curve.csv");
}

// Ten links of stiffness K and B and length d between hinges, the upper of which may come down and, if it is said so, aside.
std::string hencky(const std::string& top_directions, const std::string& constants = "") {
  return R"(plane = "xz"
)" + constants + R"(
[[beam]]
name = "column"
particles = 11
center = [0, 0, 0]
axis = [0, 0, 1]
diameter = 1e-3
bond_stiffness = 400
angle_stiffness = 5e-5
[[group]]
name = "bottom"
of = "column"
first = 1
[[group]]
name = "top"
of = "column"
last = 1
[[support]]
group = "bottom"
[[support]]
group = "top"
directions = ")" + top_directions + R"("
[[load]]
group = "top"
total_force = [0, 0, -1]
[path]
method = "arc_length"
steps = 50
to = 0.05
)";
}

// P a = 4B sin²(π/2N), a = d − P/(2K).
double hencky_load(double b) {
  const double s = std::sin(pi / 20), k = 400, d = 1e-3;
  return 8 * b * s * s / (d + std::sqrt(d * d - 8 * b * s * s / k));
}

// Two bars of EA = 1 between feet at (∓1, 0) and an apex at height tan α, a load of 1 down on it.
const std::string tall_truss = R"toml(plane = "xz"
[constants]
degrees = 75
a = "degrees*pi/180"
[[grains]]
name = "truss"
positions = [[-1, 0, 0], [0, 0, "tan(a)"], [1, 0, 0]]
diameter = 0.1
[[group]]
name = "feet"
of = "truss"
ids = [1, 3]
[[group]]
name = "apex"
of = "truss"
ids = [2]
[[connect]]
between = ["feet", "apex"]
within = 4
bond_stiffness = "cos(a)/2"
[[support]]
group = "feet"
[[load]]
group = "apex"
force = [0, 0, -1]
[[observe]]
name = "height"
group = "apex"
quantity = "position.z"
[path]
method = "arc_length"
steps = 50
to = 1.2
)toml";

double radians(const TableRow& row) { return row["second"] * pi / 180; }

}  // namespace

TEST_CASE("the branch load of Hencky's column as its bending stiffness changes", "[curve]") {
  const std::vector<TableRow> rows =
      curve_of(hencky("x") + curve("branch:1", "beam.column.angle_stiffness", 4e-5, 2e-4, "steps = 10\nstops = [1e-4]\n"));
  REQUIRE(rows.size() > 10);
  for (const TableRow& row : rows) {
    CHECK(row["lambda"] == Approx(hencky_load(row["second"])).epsilon(curve_rounding));
    CHECK(row["negative"] == 0);
    CHECK(row["multiplicity"] == 1);
  }
  CHECK(rows.front().text("label") == "start");
  CHECK(rows.back().text("label") == "end");
  CHECK(rows.back()["second"] == 2e-4);
  CHECK(std::count_if(rows.begin(), rows.end(), [](const TableRow& row) { return row["second"] == 1e-4; }) == 1);
}

TEST_CASE("a column on a lateral spring leans until it bends: two branch points meet", "[curve]") {
  // The tilt of a straight column of length N a against the stiffness c of its spring: P = c N a, a = d − P/(2K). Springs so long that they
  // stay level.
  const std::string springs = R"([[grains]]
name = "anchors"
positions = [[-1000, 0, 0.005], [1000, 0, 0.005]]
diameter = 1e-3
[[support]]
group = "anchors"
[[connect]]
between = ["top", "anchors"]
within = 1001
bond_stiffness = "c/4"
)";
  const std::vector<TableRow> rows = curve_of(hencky("y", "[constants]\nc = 0.2\n") + springs +
                                              curve("branch:1", "constants.c", 0.2, 0.6, "steps = 10\n"));
  for (const TableRow& row : rows) {
    const double c = row["second"];
    CHECK(row["lambda"] == Approx(0.01 * c / (1 + 10 * c / 800)).epsilon(1e-11));     // the springs slope by 5e-5/1000
  }
  const TableRow meet = row_of(rows, "double:1");
  CHECK(meet["lambda"] == Approx(hencky_load(5e-5)).epsilon(1e-10));
  CHECK(meet["multiplicity"] == 2);
  CHECK(rows.back()["negative"] == 1);
}

TEST_CASE("a truss sways first if it is steeper than arccos(2^(−3/2))", "[curve]") {
  const double steep = 180 / pi * std::acos(std::pow(2, -1.5));
  // Sway where r³ = L₀ y²: there and back, as two of them come together where y² = 2.
  const std::vector<TableRow> sway = curve_of(tall_truss + curve("branch:1", "constants.degrees", 75, 60, "steps = 10\n"));
  for (const TableRow& row : sway) {
    const double y = row["height"], r = std::hypot(1, y), l0 = 1 / std::cos(radians(row));
    if (row.text("label").starts_with("turn")) continue;
    CHECK(r * r * r == Approx(l0 * y * y).epsilon(curve_rounding));
    CHECK(row["lambda"] == Approx(2 * y * (1 / r - 1 / l0)).epsilon(1e-11));
  }
  CHECK(row_of(sway, "turn:1")["second"] == Approx(180 / pi * std::acos(2 / std::pow(3, 1.5))).epsilon(curve_rounding));
  const std::vector<TableRow> half = curve_of(tall_truss + curve("branch:1", "constants.degrees", 75, 60, "steps = 10\nuntil = \"turn:1\"\n"));
  CHECK(half.back().text("label") == "turn:1");
  CHECK(half.size() < sway.size());
  CHECK(sway.back()["lambda"] == Approx(0.76859681475999079427).epsilon(curve_rounding));        // the other branch point of the truss at 75°
  // Limit points: λ = 2 (1 − cos^(2/3) α)^(3/2).
  const std::vector<TableRow> snap = curve_of(tall_truss + curve("limit:1", "constants.degrees", 60, 75, "steps = 10\n"));
  for (const TableRow& row : snap)
    CHECK(row["lambda"] == Approx(2 * std::pow(1 - std::pow(std::cos(radians(row)), 2.0 / 3), 1.5)).epsilon(curve_rounding));
  for (const auto& rows : {sway, snap}) {
    CHECK(row_of(rows, "hilltop:1")["second"] == Approx(steep).epsilon(curve_rounding));
    CHECK(row_of(rows, "hilltop:1")["lambda"] == Approx(std::sqrt(0.5)).epsilon(curve_rounding));
  }
}

TEST_CASE("a side load takes two thirds' powers from a load that sways, and the curve has its cusp at the perfect truss", "[curve]") {
  const std::string side = "[[load]]\nname = \"side\"\ngroup = \"apex\"\nforce = [1e-3, 0, 0]\nconstant = true\n";
  const std::vector<TableRow> rows =
      curve_of(tall_truss + side + curve("limit:1", "load.side.force.1", 1e-3, -1e-3, "steps = 20\nstops = [1e-4, 1e-7, 1e-8, 1e-9]\n"));
  const TableRow cusp = row_of(rows, "cusp:1");
  CHECK(std::abs(cusp["second"]) < 1e-16);                      // rounding of forces of 0.1
  CHECK(cusp["lambda"] == Approx(0.15156855763440564909).epsilon(curve_rounding));
  std::map<double, double> lost;
  for (const TableRow& row : rows) lost[row["second"]] = cusp["lambda"] - row["lambda"];
  // λ = λ_c − c ε^(2/3) + O(ε^(4/3)); of the difference at 1e-9 rounding is 1e-10.
  for (const double e : {1e-7, 1e-8}) CHECK(std::log10(lost.at(e) / lost.at(e == 1e-7 ? 1e-8 : 1e-9)) == Approx(2.0 / 3).epsilon(1e-4));
  CHECK(lost.at(-1e-3) == Approx(lost.at(1e-3)).epsilon(1e-10));
}

TEST_CASE("a push takes the root from a load at which one side gives way, and the curve turns there", "[curve]") {
  // A bead between two bars that grow by the part λ, and an oblique spring, all of U = (r − r₀)²: for small sides s of the bead
  //   E = (½ − 2λ) s² − ¼ s³ − F s + O(s⁴):  λ_c = ¼, and a limit point at λ_c − λ = √(3F)/4 (1 + O(√F)).
  const std::string bead = R"(plane = "xz"
[[grains]]
name = "held"
positions = [[0, 0, 1], [0, 0, -1], [1, 0, 1]]
diameter = 0.1
[[grains]]
name = "bead"
positions = [[0, 0, 0]]
diameter = 0.1
[[group]]
name = "ends"
of = "held"
ids = [1, 2]
[[group]]
name = "side"
of = "held"
ids = [3]
[[group]]
name = "straight"
of = ["ends", "bead"]
[[connect]]
between = ["bead", "ends"]
within = 1.1
bond_stiffness = 1
[[connect]]
between = ["bead", "side"]
within = 1.5
bond_stiffness = 1
[[support]]
group = "held"
[[support]]
group = "bead"
directions = "z"
[[change]]
group = "straight"
rest_length = 1
[[load]]
name = "push"
group = "bead"
force = [1e-3, 0, 0]
constant = true
[path]
method = "arc_length"
to = 1
steps = 50
)";
  const std::vector<TableRow> rows =
      curve_of(bead + curve("limit:1", "load.push.force.1", 1e-3, -1e-3, "steps = 20\nstops = [1e-6, 1e-8, 1e-10]\n"));
  const TableRow turn = row_of(rows, "turn:1");
  CHECK(std::abs(turn["second"]) < 1e-14);                      // located to 1e-9 of a step, over which it is a square
  CHECK(turn["lambda"] == Approx(0.25).epsilon(1e-9));
  std::map<double, double> lost, gained;
  for (const TableRow& row : rows)
    if (row["lambda"] < 0.25) lost[row["second"]] = 0.25 - row["lambda"];
    else gained[row["second"]] = row["lambda"] - 0.25;
  for (const double f : {1e-6, 1e-8, 1e-10}) {                 // nearer to the turn rounding of forces, 1e-17, decides
    CHECK(lost.at(f) == Approx(std::sqrt(3 * f) / 4).epsilon(10 * std::sqrt(f) + 1e-9));
    CHECK(gained.at(f) == Approx(std::sqrt(3 * f) / 4).epsilon(10 * std::sqrt(f) + 1e-9));      // and the one behind
  }
  CHECK(rows.back()["second"] == 1e-3);                         // the other root, above
}

TEST_CASE("a spring under a truss takes its limit points, which meet in a cusp", "[curve]") {
  // λ = truss_load(z) + 2K (½ − z): both limit points are at z = 0 where 2K = 4 (√(5/4) − 1).
  const std::string spring = R"([constants]
k = 0.1
[[grains]]
name = "anchor"
positions = [[0, 0, -9.5]]
diameter = 0.1
[[connect]]
between = ["apex", "anchor"]
within = 11
bond_stiffness = "k"
[[support]]
group = "anchor"
)";
  const std::string path = "[path]\nmethod = \"arc_length\"\nto = 0.4\nsteps = 20\n";
  const std::vector<TableRow> rows = curve_of(truss + spring + path + curve("limit:1", "constants.k", 0.1, 0.3, "steps = 20\n"));
  for (const TableRow& row : rows) {
    const double k = row["second"], z = row["z"], r = std::hypot(1, z);
    CHECK(row["lambda"] == Approx(truss_load(z) + 2 * k * (0.5 - z)).epsilon(curve_rounding));
    CHECK(std::abs(-4 * (1 - std::sqrt(1.25) / (r * r * r)) - 2 * k) < 1e-11);      // dλ/dz
  }
  const TableRow cusp = row_of(rows, "cusp:1");
  CHECK(cusp["second"] == Approx(2 * (std::sqrt(1.25) - 1)).epsilon(curve_rounding));
  CHECK(cusp["lambda"] == Approx(2 * (std::sqrt(1.25) - 1)).epsilon(curve_rounding));
  CHECK(rows.back()["second"] == 0.1);                          // back to the limit point on the other side
  CHECK(rows.back()["z"] == Approx(-rows.front()["z"]).epsilon(curve_rounding));
}

TEST_CASE("where a truss touches a floor that is lowered, beyond its limit point", "[curve]") {
  const std::string floor = R"([[wall]]
name = "floor"
group = "apex"
shape = "plane"
point = [0, 0, 0.3]
normal = [0, 0, 1]
youngs_modulus = 10
)";
  const std::string path = "[path]\nmethod = \"arc_length\"\nto = 0.4\nsteps = 20\n";
  const std::vector<TableRow> rows = curve_of(truss + floor + path +
                                             curve("contact:1", "wall.floor.point.3", 0.3, -0.2, "steps = 20\nstops = [0]\n"));
  for (const TableRow& row : rows) {
    CHECK(row["z"] == Approx(row["second"] + 0.05).epsilon(curve_rounding).margin(1e-13));
    CHECK(row["lambda"] == Approx(truss_load(row["second"] + 0.05)).epsilon(1e-11));
  }
  const TableRow meeting = row_of(rows, "meeting:1");
  CHECK(meeting["z"] == Approx(truss_limit_z).epsilon(1e-7));   // the overlap's stiffness begins like its root
  CHECK(meeting["lambda"] == Approx(truss_limit).epsilon(curve_rounding));
  CHECK(rows.back()["negative"] == 1);
}

TEST_CASE("a curve is expected, and what is wrong with one is told", "[curve]") {
  const ScratchDirectory scratch;
  const std::string expects = "[[expect]]\nobservable = \"lambda\"\nat = \"second=1e-4\"\nvalue = " + std::to_string(0) + "\natol = 1\n"
                              "[[expect]]\nobservable = \"second\"\nat = \"curve.cusp:1\"\nvalue = 1\n";
  const std::string good = hencky("x") + curve("branch:1", "beam.column.angle_stiffness", 5e-5, 1.5e-4) + expects;
  Answer answer = elamin_says("verify --quiet '" + scratch.file("good.toml", good) + "'", 60);
  INFO(answer.text);
  CHECK(answer.status == 3);
  CHECK(answer.text.find("nothing of that is on the curve; there are: start, end") != std::string::npos);

  answer = elamin_says("'" +
                       scratch.file("gone.toml", hencky("x") + curve("branch:9", "beam.column.angle_stiffness", 5e-5, 1e-4)) + "'", 60);
  CHECK(answer.status == 2);
  CHECK(answer.text.find("the path has no branch:9 that a curve could begin with") != std::string::npos);

  const std::string counted = "[constants]\nn = 11\n";
  std::string other = hencky("x", counted) + curve("branch:1", "constants.n", 11, 20);
  other.replace(other.find("particles = 11"), 14, "particles = \"floor\"");
  other.replace(other.find("\"floor\""), 7, "\"n\"");
  answer = elamin_says("'" + scratch.file("other.toml", other) + "'", 60);
  CHECK(answer.status == 2);
  CHECK(answer.text.find("there is no such structure") != std::string::npos);

  for (const auto& [text, says] : {std::pair{curve("snap:1", "load.1.total_force.3", 1, 2),
                                             "must be a limit point, a branch point, a contact or a snap"},
                                   {curve("limit:1", "beam.column.particles", 11, 12), "is a whole number"},
                                   {curve("limit:1", "beam.column.center", 11, 12), "is no number"},
                                   {curve("limit:1", "beam.column.bend", 11, 12), "is no key"},
                                   {curve("limit:1", "beam.column.diameter", 1, 1), "is the same value as from"}}) {
    answer = elamin_says("check '" + scratch.file("bad.toml", hencky("x") + text) + "'");
    INFO(answer.text);
    CHECK(answer.status == 1);
    CHECK(answer.text.find(says) != std::string::npos);
  }
}

// Where the thick beam has been driven back it is straight and the contact bears next to nothing: an overlap of 1e-9 m, within which differences have to stay.
TEST_CASE("a limit point at a contact that is hardly closed is followed", "[curve]") {
  std::ifstream in(ELAMIN_ROOT "/problems/two_beams.toml");
  const std::string problem{std::istreambuf_iterator<char>(in), {}};
  const std::vector<TableRow> rows =
      curve_of(problem + curve("limit:1", "beam.thin.center.1", -0.0038523056653491437, -0.00395, "steps = 4\nstops = [-0.0039]\n"));
  REQUIRE(rows.size() > 2);
  for (const TableRow& row : rows) {
    const ScratchDirectory scratch;
    const std::string file = scratch.file("p.toml", problem);
    CHECK(elamin_says("'" + file + "' --quiet --set beam.thin.center.1=" + row.text("second"), 60).status == 0);
    CHECK(row_of(table_of(scratch / "p/events.csv"), "limit:1")["lambda"] == Approx(row["lambda"]).epsilon(1e-9));
  }
}

TEST_CASE("a snap leads to the event that it begins at, which is followed", "[curve]") {
  std::string snaps = tall_truss;
  snaps.replace(snaps.find("arc_length"), 10, "load_steps");
  for (const auto& [from, to, of] : {std::tuple{75, 71, "branch:1"}, std::tuple{40, 45, "limit:1"}}) {
    const auto rows = [&](const std::string& event) {
      return curve_of(snaps + curve(event, "constants.degrees", from, to, "steps = 4\n"));
    };
    const std::vector<TableRow> of_snap = rows("jump:1"), of_event = rows(of);
    INFO(of);
    REQUIRE(of_snap.size() == of_event.size());
    for (std::size_t k = 0; k < of_snap.size(); ++k) CHECK(of_snap[k]["lambda"] == of_event[k]["lambda"]);
  }
}
