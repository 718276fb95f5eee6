// Paths of tests/path/cases, each in several numbers of steps and by both methods where that makes sense: they go on to their end, and
// what happens on them is what theory, symmetry or the other runs say.
#include "catch.hpp"
#include "laws/section.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"
#include "study/truss.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <set>

namespace {

using elamin::pi;

constexpr double to_events = 1e-9;                 // events, relative

std::string case_file(const std::string& name) { return std::string(ELAMIN_ROOT) + "/tests/path/cases/" + name + ".toml"; }

/// A run of a case, changed by settings such as "path.steps=20". (What is set to arc length is not to end by the number of its points.)
struct Run {
  explicit Run(const std::string& name, const std::vector<std::string>& settings = {}) {
    std::string arguments = "'" + case_file(name) + "' --quiet -o '" + (scratch / "out") + "'";
    const auto has = [&](const std::string& s) { return std::find(settings.begin(), settings.end(), s) != settings.end(); };
    if (has("path.method=\"arc_length\"")) arguments += " --set path.points=4000";
    for (const std::string& s : settings) arguments += " --set '" + s + "'", what += s + " ";
    answer = elamin_says(arguments, 20);
    if (!std::filesystem::exists(scratch / "out/path.csv")) return;
    path = table_of(scratch / "out/path.csv");
    for (const TableRow& row : path)
      if (row.text("label").find(':') != std::string::npos) events.push_back(row);
    std::ifstream(scratch / "out/summary.json") >> summary;
    if (std::filesystem::exists(scratch / "out/contacts.csv")) contacts = table_of(scratch / "out/contacts.csv");
    for (const TableRow& row : table_of(scratch / "out/events.csv")) located_rows[row.text("label")] = row;
  }
  double end() const { return path.empty() ? NAN : path.back()["lambda"]; }
  std::vector<TableRow> of(const std::string& kind) const {
    std::vector<TableRow> found;
    for (const TableRow& row : events)
      if (row.text("label").starts_with(kind + ":")) found.push_back(row);
    return found;
  }
  std::vector<TableRow> on_branch(int k) const {
    std::vector<TableRow> found;
    for (const TableRow& row : path)
      if (row["branch"] == k) found.push_back(row);
    return found;
  }
  int branches() const {
    double most = 0;
    for (const TableRow& row : path) most = std::max(most, row["branch"]);
    return static_cast<int>(most);
  }
  std::string told() const {
    std::string all;
    for (const TableRow& row : events) all += row.text("label") + " " + row.text("lambda") + ", ";
    return all;
  }

  ScratchDirectory scratch;
  std::string what;
  Answer answer;
  std::vector<TableRow> path, events, contacts;
  std::map<std::string, TableRow> located_rows;  // of events.csv, by label
  nlohmann::json summary;
};

std::string kind_of(const TableRow& row) { return row.text("label").substr(0, row.text("label").find(':')); }
std::string in_steps(int n) { return "path.steps=" + std::to_string(n); }
const std::string by_arcs = "path.method=\"arc_length\"", by_load_steps = "path.method=\"load_steps\"", follows = "path.when_unstable=\"follow\"",
                  snaps = "path.when_unstable=\"jump\"";

/// Done, at this load factor exactly.
#define CHECK_ENDS_AT(run, load)                                         \
  do {                                                                   \
    INFO((run).what << "| " << (run).answer.text << "| " << (run).told()); \
    CHECK((run).answer.status == 0);                                     \
    CHECK((run).end() == (load));                                        \
  } while (false)

/// The same kinds of events at the same load factors, up to a first snap, which begins as far behind its event.
void same_events(const Run& a, const Run& b) {
  INFO(a.what << ": " << a.told() << "\n" << b.what << ": " << b.told());
  for (std::size_t k = 0; k < std::max(a.events.size(), b.events.size()); ++k) {
    REQUIRE(k < a.events.size());
    REQUIRE(k < b.events.size());
    CHECK(kind_of(a.events[k]) == kind_of(b.events[k]));
    CHECK(a.events[k]["lambda"] == Approx(b.events[k]["lambda"]).epsilon(to_events));
    if (kind_of(a.events[k]) == "jump") return;
  }
}

/// Every contact event says what touches, and something has no gap there.
void contacts_are_told(const Run& run, double size) {
  for (const TableRow& event : run.of("contact")) {
    const std::string& label = event.text("label");
    INFO(run.what << label << " at " << event.text("lambda"));
    CHECK(run.located_rows.at(label).text("what") != "");
    double least = INFINITY;
    for (const TableRow& c : run.contacts)
      if (c.text("label") == label) least = std::min(least, std::abs(c["gap"]));
    CHECK(least <= 1e-9 * size);
  }
}

/// Falls begin at an event and lose energy.
void falls_are_right(const Run& run) {
  for (std::size_t k = 0; k < run.path.size(); ++k) {
    const TableRow& row = run.path[k];
    if (!row.text("label").starts_with("jump:")) continue;
    INFO(run.what << row.text("label") << " at " << row.text("lambda") << ": " << run.located_rows.at(row.text("label")).text("what"));
    REQUIRE(k > 0);
    CHECK(row.text("parent") != "");
    CHECK(row.text("parent") == run.path[k - 1].text("label"));
    CHECK(row["negative"] == 0);
    double from = 0, to = 0;
    REQUIRE(std::sscanf(run.located_rows.at(row.text("label")).text("what").c_str(), "from energy %lf to %lf", &from, &to) == 2);
    CHECK(to <= from);
  }
}

/// Of a straight chain of n links between hinges: the shortening at which it buckles, P a = 4B sin²(π/2n), P = 2K(q₀ − a).
double hinged_shortening(int n, double length, double EA, double EI) {
  const double q0 = length / n, K = EA / (2 * q0), mu = 4 * EI / q0 * std::pow(std::sin(pi / (2 * n)), 2);
  const double a = q0 * (1 + std::sqrt(1 - 2 * mu / (K * q0 * q0))) / 2;
  return n * mu / (2 * K * a);
}

}  // namespace

TEST_CASE("beams bend to the side that they are pushed to, whatever the steps", "[paths][wrong_side_two_beams]") {
  const Run fine("two_beams_pushed", {in_steps(200)});
  CHECK_ENDS_AT(fine, 1);
  REQUIRE(fine.of("contact").size() >= 1);
  for (const auto& settings : std::vector<std::vector<std::string>>{{in_steps(5)}, {in_steps(17)}, {in_steps(20)}, {in_steps(60)}, {in_steps(17), by_arcs, snaps}, {in_steps(50), by_arcs, snaps}}) {
    const Run run("two_beams_pushed", settings);
    CHECK_ENDS_AT(run, 1);
    same_events(run, fine);
    falls_are_right(run);
    if (run.path.empty()) continue;
    for (const TableRow& row : run.path) {
      if (row.text("label") == "contact:1") break;              // until they touch
      INFO(run.what << row.text("label") << " at " << row.text("lambda"));
      CHECK((row.text("label") == "" || row.text("label") == "initial"));
      CHECK(row["thin_x"] >= 0);
      CHECK(row["thick_x"] <= 0);
    }
  }
}

TEST_CASE("a small side force unfolds the pitchfork: no event, whatever the steps", "[paths][imperfect_arc]") {
  const Run fine("column_pushed", {in_steps(200), by_load_steps, snaps});
  CHECK_ENDS_AT(fine, 3);
  for (const int n : {7, 17, 50, 100, 200})
    for (const auto& way : std::vector<std::vector<std::string>>{{by_arcs, follows}, {by_load_steps, snaps}}) {
      const Run run("column_pushed", {in_steps(n), way[0], way[1]});
      CHECK_ENDS_AT(run, 3);
      INFO(run.what << run.told());
      CHECK(run.events.empty());
      if (run.path.empty()) continue;
      for (const TableRow& row : run.path) CHECK(row["negative"] == 0);
      CHECK(run.path.back()["x"] > 0);
      CHECK(run.path.back()["x"] == Approx(fine.path.back()["x"]).epsilon(1e-8));
    }
}

TEST_CASE("a ring with the least supports has a double branch point, on the circle", "[paths][ring101_13]") {
  for (const int n : {5, 13, 50, 200})
    for (const std::string& method : {by_arcs, by_load_steps}) {
      const Run run("ring_least_supports", {in_steps(n), method, follows});
      CHECK_ENDS_AT(run, 1.3);
      INFO(run.what << run.told());
      CHECK(run.events.size() == 1);
      if (run.of("branch").empty()) continue;
      const TableRow event = run.located_rows.at("branch:1");
      CHECK(event["lambda"] == Approx(1).epsilon(to_events));
      CHECK(event["multiplicity"] == 2);
      CHECK(run.path.back()["negative"] == 2);
      // Positions: id molecule x y z … in the data file's section Atoms.
      std::ifstream file(run.scratch / "out/states/branch-1.data");
      std::vector<std::array<double, 2>> at;
      bool atoms = false;
      for (std::string line; std::getline(file, line);) {
        if (line.starts_with("Atoms")) atoms = true;
        else if (atoms && !line.empty() && std::isalpha(line[0])) break;
        double id, type, x, y;
        if (atoms && std::sscanf(line.c_str(), "%lf %lf %lf %lf", &id, &type, &x, &y) == 4) at.push_back({x, y});
      }
      REQUIRE(at.size() == 101);
      double cx = 0, cy = 0, least = INFINITY, most = 0;
      for (const auto& [x, y] : at) cx += x / 101, cy += y / 101;
      for (const auto& [x, y] : at) least = std::min(least, std::hypot(x - cx, y - cy)), most = std::max(most, std::hypot(x - cx, y - cy));
      CHECK(most - least <= 1e-7 * most);
    }
}

TEST_CASE("an oval that may lie in any direction is one branch", "[paths][ring_any_direction]") {
  const ScratchDirectory scratch;
  const Answer answer = elamin_says("verify --quiet '" + case_file("ring_any_direction") + "' -o '" + (scratch / "out") + "'", 120);
  INFO(answer.text);
  CHECK(answer.status == 0);
  for (const auto& entry : std::filesystem::directory_iterator(scratch / "out")) {
    if (!entry.is_directory()) continue;
    const std::vector<TableRow> path = table_of(entry.path().string() + "/path.csv");
    double branches = 0;
    int met = 0, half = 0;
    for (const TableRow& row : path) branches = std::max(branches, row["branch"]), met += row.text("label") == "met:1", half += row.text("label").starts_with("half:");
    INFO(entry.path().string());
    CHECK(branches >= 1);                                         // one way or both, each once
    CHECK(branches <= 2);
    CHECK(met >= 1);
    CHECK(half >= 1);
  }
}

TEST_CASE("a slender column is followed along its side branches", "[paths][column_switched_stiff]") {
  for (const int n : {20, 50}) {
    const ScratchDirectory scratch;
    const Answer answer = elamin_says("verify --quiet '" + case_file("column_switched") + "' -o '" + (scratch / "out") + "' --set " + in_steps(n), 60);
    INFO(n << ": " << answer.text);
    CHECK(answer.status == 0);
    for (const auto& entry : std::filesystem::directory_iterator(scratch / "out")) {
      if (!entry.is_directory()) continue;
      const std::vector<TableRow> path = table_of(entry.path().string() + "/path.csv");
      std::map<double, TableRow> last;
      for (const TableRow& row : path) last[row["branch"]] = row;
      INFO(entry.path().string());
      REQUIRE(last.size() == 3);
      CHECK(last[1].text("label") == "bent:1");
      CHECK(last[2].text("label") == "bent:2");
      CHECK(last[1]["w"] == Approx(-last[2]["w"]).epsilon(1e-8));
    }
  }
}

TEST_CASE("the ends of a column meet and pass each other", "[paths][elastica_ends_pass]") {
  for (const int n : {20, 50})
    for (const char* EA : {"1e6", n == 20 ? "1e7" : "1e8"}) {      // the elastica is inextensible: 1e6 is off by 2e-5
      const std::string run = " --quiet '" + case_file("elastica_ends_pass") + "' --set beam.column.axial_stiffness=" + EA + " --set " + in_steps(n);
      const ScratchDirectory scratch;
      const Answer answer = elamin_says((EA == std::string("1e6") ? "" : "verify") + run + " -o '" + (scratch / "out") + "'", 60);
      INFO("EA = " << EA << ", " << n << " steps: " << answer.text);
      CHECK(answer.status == 0);
      for (const auto& entry : std::filesystem::directory_iterator(scratch / "out")) {
        if (!entry.is_directory()) continue;
        const std::vector<TableRow> events = table_of(entry.path().string() + "/events.csv");
        std::vector<double> bent;
        for (const TableRow& row : events)
          if (row.text("label").starts_with("bent:")) bent.push_back(row["lambda"]);
        REQUIRE(bent.size() == 2);
        CHECK(bent[0] == Approx(bent[1]).epsilon(to_events));
      }
    }
}

TEST_CASE("two events at one point are both told, at one load factor", "[paths][two_events_lost]") {
  for (const int n : {3, 5, 17, 20, 50, 200}) {
    const Run run("events_at_once", {in_steps(n), by_arcs, follows});
    CHECK_ENDS_AT(run, 1);
    INFO(run.what << run.told());
    REQUIRE(run.of("a").size() == 1);
    REQUIRE(run.of("b").size() == 1);
    CHECK(run.of("a")[0]["lambda"] == Approx(truss_load(0.25)).epsilon(to_events));
    CHECK(run.of("b")[0]["lambda"] == Approx(truss_load(0.25)).epsilon(to_events));
    CHECK(run.of("limit").size() == 2);
  }
}

TEST_CASE("two events about one value come once each at every crossing", "[paths][two_events_loop]") {
  const Run bowed("events_twins_bowed");
  CHECK_ENDS_AT(bowed, 1);
  const std::string start = "path.start=\"" + (bowed.scratch / "out/states/final.data") + "\"";
  for (const int n : {17, 50, 100}) {
    const Run run("events_twins", {in_steps(n), start});
    INFO(run.what << run.answer.text << run.told());
    CHECK(run.answer.status == 0);
    REQUIRE(!run.path.empty());
    CHECK(run.on_branch(0).back()["lambda"] == 1);
    CHECK(run.branches() >= 1);
    for (int k = 0; k <= run.branches(); ++k) {
      const std::vector<TableRow> rows = run.on_branch(k);
      std::vector<double> a, b;
      int crossings = 0;
      double side = 0;
      for (const TableRow& row : rows) {
        if (row.text("label").starts_with("a:")) a.push_back(row["lambda"]);
        else if (row.text("label").starts_with("b:")) b.push_back(row["lambda"]);
        else {
          if (side * row["y"] < 0) ++crossings;
          side = row["y"];
        }
      }
      INFO("branch " << k);
      CHECK(crossings >= 1);
      CHECK(a.size() == static_cast<std::size_t>(crossings));
      REQUIRE(a.size() == b.size());
      for (std::size_t i = 0; i < a.size(); ++i) CHECK(std::abs(a[i] - b[i]) <= to_events);
    }
  }
}

TEST_CASE("events on the first segment of a side branch are located", "[paths][event_first_segment]") {
  // The apex at (x, y), feet at (∓1, 0): Σ (1 − r₀/r)(x ± 1) = 0 across gives y, Σ 2K (r₀/r − 1) y the load.
  const double K = 0.12940952255126038, r0 = std::hypot(1, 3.7320508075688772935);
  const auto part = [&](double x, double y) { return 1 - r0 / std::hypot(x, y); };
  const auto across = [&](double x, double y) { return part(x + 1, y) * (x + 1) + part(x - 1, y) * (x - 1); };
  const auto load = [&](double x) {
    double low = 3, high = 3.7;
    REQUIRE(across(x, low) * across(x, high) < 0);
    for (int k = 0; k < 100; ++k) ((across(x, (low + high) / 2) < 0) == (across(x, low) < 0) ? low : high) = (low + high) / 2;
    return -2 * K * low * (part(x + 1, low) + part(x - 1, low));
  };
  for (const int n : {5, 20, 50, 200}) {
    const Run run("events_on_side_branch", {in_steps(n)});
    INFO(run.what << run.answer.text << run.told());
    CHECK(run.answer.status == 0);
    for (const auto& [name, x] : std::vector<std::pair<std::string, double>>{{"s0_001", 0.001}, {"s0_003", 0.003}, {"s0_01", 0.01}, {"s0_03", 0.03}, {"s0_1", 0.1}, {"s0_3", 0.3}}) {
      INFO(name << ", expected at " << load(x));
      const std::vector<TableRow> found = run.of(name);
      REQUIRE(!found.empty());
      double off = INFINITY;
      for (const TableRow& row : found) {
        CHECK(row["x"] == Approx(x).epsilon(to_events));
        off = std::min(off, std::abs(row["lambda"] / load(x) - 1));
      }
      CHECK(off <= to_events);
    }
  }
}

TEST_CASE("a hard contact at the end of a step is an event", "[paths][hard_contact_event_lost]") {
  for (const int n : {3, 4, 6, 7, 8, 9, 10, 11, 13, 50, 200}) {
    const Run run("hard_lid", {in_steps(n)});
    CHECK_ENDS_AT(run, 1);
    INFO(run.what << run.told());
    REQUIRE(run.events.size() == 1);
    CHECK(run.of("contact").size() == 1);
    CHECK(run.events[0]["lambda"] == Approx(0.5).epsilon(to_events));
    CHECK(run.path.back()["energy"] == Approx(0.25).epsilon(1e-9));     // K e², e half the way of the lid
  }
}

TEST_CASE("a strip meets a stop: every contact is one", "[paths][strip_spurious_contact]") {
  const Run fine("strip_meets_stop", {in_steps(100)});
  CHECK_ENDS_AT(fine, 1);
  for (const auto& settings : std::vector<std::vector<std::string>>{{in_steps(17)}, {in_steps(40)}, {in_steps(60)}, {in_steps(100)}, {in_steps(50), by_arcs, snaps}}) {
    const Run run("strip_meets_stop", settings);
    CHECK_ENDS_AT(run, 1);
    contacts_are_told(run, 1e-3);
    falls_are_right(run);
    same_events(run, fine);
  }
}

TEST_CASE("a beam is followed along stiff walls", "[paths][contact_stiff_arc_length]") {
  const Run soft("beam_stiff_walls", {in_steps(50), "wall.left.effective_modulus=1e10", "wall.right.effective_modulus=1e10"});
  CHECK_ENDS_AT(soft, 2);
  for (const int n : {20, 50, 100}) {
    const Run run("beam_stiff_walls", {in_steps(n)});
    CHECK_ENDS_AT(run, 2);
    contacts_are_told(run, 1e-3);
    INFO(run.what << run.told());
    CHECK(run.branches() == 2);
    CHECK(run.of("contact").size() >= 2);
    for (int k = 1; k <= run.branches(); ++k) CHECK(run.on_branch(k).back()["lambda"] == 2);
  }
}

TEST_CASE("a ring that floats between hard plates is pressed", "[paths][ring_free_between_plates]") {
  for (const int n : {20, 50}) {
    const Run run("ring_between_hard_plates", {in_steps(n)});
    CHECK_ENDS_AT(run, 0.8);
    INFO(run.what << run.told());
    // Before the lid is there nothing says how high the ring lies.
    CHECK(run.of("contact").size() >= 1);
    if (run.path.empty()) continue;
    const std::string log = text_of(run.scratch / "out/log.txt");
    CHECK(log.find("translation") != std::string::npos);
    CHECK(run.path.back()["touching"] >= 1);
    CHECK(std::abs(run.path.back()["force"]) > 1);
  }
}

TEST_CASE("boxes are pushed over an edge by both methods", "[paths][boxes_overhang_arc_length]") {
  std::vector<double> first, tips;
  for (const int n : {17, 40, 100})
    for (const std::string& method : {by_arcs, by_load_steps}) {
      const Run run("boxes_overhang", {in_steps(n), method, "path.to=0.32"});
      CHECK_ENDS_AT(run, 0.32);
      INFO(run.what << run.told());
      REQUIRE(run.of("contact").size() == 2);
      CHECK(run.of("contact")[1]["lambda"] == Approx(0.31875).epsilon(3e-6));
      first.push_back(run.of("contact")[0]["lambda"]), tips.push_back(run.of("contact")[1]["lambda"]);
      CHECK(first.back() == Approx(first.front()).epsilon(to_events));
      CHECK(tips.back() == Approx(tips.front()).epsilon(to_events));
    }
}

TEST_CASE("an arch in space is told to want a plane", "[paths][arch_without_plane]") {
  const Answer check = elamin_says("check '" + case_file("arch_without_plane") + "'");
  INFO(check.text);
  CHECK(check.status == 0);
  CHECK(check.text.find("sign") != std::string::npos);            // that rest angles have none in space
  const Run run("arch_without_plane");
  INFO(run.answer.text);
  CHECK(run.answer.status == 2);
  REQUIRE(!run.path.empty());
  CHECK(run.summary["message"].get<std::string>().find("plane") != std::string::npos);
  const Run in_plane("arch_without_plane", {"plane=\"xz\""});
  CHECK_ENDS_AT(in_plane, 15);
  REQUIRE(in_plane.of("limit").size() == 2);
  CHECK(in_plane.of("limit")[1]["lambda"] == Approx(-0.6963091405).epsilon(1e-9));
}

TEST_CASE("a side branch begins at its branch point and ends at `to`", "[paths][branch_leaps_past_end]") {
  const double critical = hinged_shortening(20, 1, 1e6, 1) / 1.4804e-5;
  for (const int n : {3, 5, 17, 20, 50, 200}) {
    const Run run("column_slender_branches", {in_steps(n)});
    CHECK_ENDS_AT(run, 1);
    INFO(run.what << run.told());
    REQUIRE(run.events.size() == 1);
    CHECK(run.of("branch").size() == 1);
    CHECK(run.events[0]["lambda"] == Approx(critical).epsilon(to_events));
    REQUIRE(run.branches() == 2);
    for (int k = 1; k <= 2; ++k) {
      for (const TableRow& row : run.on_branch(k)) {
        CHECK(row["lambda"] >= critical * (1 - 1e-9));
        CHECK(row["lambda"] <= 1);
        CHECK(row["negative"] == 0);
      }
      CHECK(run.on_branch(k).back()["lambda"] == 1);
    }
    CHECK(run.on_branch(1).back()["w"] == Approx(-run.on_branch(2).back()["w"]).epsilon(1e-8));
    CHECK(std::abs(run.on_branch(1).back()["w"]) == Approx(2 / pi * std::sqrt((1 - critical) * 1.4804e-5)).epsilon(1e-2));
  }
}

TEST_CASE("a lid meets a grain that rests, by both methods", "[paths][grain_lid_arc_length]") {
  // Overlaps δ = (3F/4E√r)^⅔ at both walls.
  const auto overlap = [](double force) { return std::pow(0.75 * force / (1e3 * std::sqrt(0.5)), 2.0 / 3); };
  const double critical = (0.01 + overlap(1e-3)) / 0.02;
  double low = 0, high = 1e3;
  for (int k = 0; k < 200; ++k) ((overlap((low + high) / 2) + overlap((low + high) / 2 + 1e-3) < 0.01) ? low : high) = (low + high) / 2;
  for (const int n : {3, 5, 10, 17, 50, 200})
    for (const std::string& method : {by_arcs, by_load_steps}) {
      const Run run("grain_under_lid", {in_steps(n), method});
      CHECK_ENDS_AT(run, 1);
      INFO(run.what << run.told());
      REQUIRE(run.events.size() == 1);
      CHECK(run.of("contact").size() == 1);
      CHECK(run.events[0]["lambda"] == Approx(critical).epsilon(to_events));
      CHECK(std::abs(run.path.back()["force"]) == Approx(low).epsilon(1e-8));
      contacts_are_told(run, 1);
    }
}

TEST_CASE("a lid that meets four corners at once is one event", "[paths][box_lid_contact_twice]") {
  for (const int n : {3, 5, 11, 17, 50, 200})
    for (const std::string& method : {by_arcs, by_load_steps}) {
      const Run run("box_under_lid", {in_steps(n), method});
      CHECK_ENDS_AT(run, 1);
      INFO(run.what << run.told());
      REQUIRE(run.events.size() == 1);
      CHECK(run.of("contact").size() == 1);
      CHECK(run.events[0]["lambda"] == Approx(0.5).epsilon(to_events));     // 0.1 down, of 0.2
      contacts_are_told(run, 1);
      int corners = 0;
      for (const TableRow& c : run.contacts) corners += c.text("label") == "contact:1" && c.text("second") == "lid";
      CHECK(corners == 4);
      CHECK(run.path.size() < static_cast<std::size_t>(n) + 20);            // what does not move yet does not bend
    }
}

TEST_CASE("a ring snaps to one oval of a family and goes on, whatever the steps", "[paths][ring_snaps_to_oval]") {
  for (const char* name : {"ring_snaps_to_oval", "ring_of_few_links_snaps"}) {
    const Run first(name, {in_steps(12), by_load_steps});
    for (const std::string& method : {by_arcs, by_load_steps})
      for (const int n : {5, 7, 20, 33}) {
        const Run run(name, {in_steps(n), method});
        CHECK_ENDS_AT(run, first.end());
        CHECK(run.path.back()["energy"] == Approx(first.path.back()["energy"]).epsilon(1e-10));
        CHECK(run.events.size() == 2);
        falls_are_right(run);
        same_events(first, run);
      }
  }
}

TEST_CASE("what may bend in any direction slides along a wall, whatever the steps", "[paths][slides_along_wall]") {
  for (const auto& [name, walls] : std::map<std::string, std::vector<std::string>>{
           {"column_slides_along_walls", {"wall.right.point=[1,0,0]", "wall.left.point=[-1,0,0]"}}, {"mast_slides_along_wall", {"wall.wall.point=[9,0,0]"}}}) {
    const Run first(name, {in_steps(12), by_load_steps}), without(name, walls);
    CHECK_ENDS_AT(without, 1);
    REQUIRE(first.events.size() == 4);
    CHECK(first.events[2].text("label") == "contact:1");
    for (const std::string& method : {by_arcs, by_load_steps})
      for (const int n : {5, 7, 20, 33, 50}) {
        const Run run(name, {in_steps(n), method});
        CHECK_ENDS_AT(run, 1);
        CHECK(run.path.back()["energy"] == Approx(without.path.back()["energy"]).epsilon(1e-10));      // there is a direction in which nothing is in the way
        CHECK(run.path.back()["wall"] == 0);
        CHECK(run.path.back()["negative"] == 0);
        falls_are_right(run);
        same_events(first, run);
      }
  }
}

TEST_CASE("a step to a limit point stays on its branch, whatever the steps", "[paths][limit_of_another_branch]") {
  const Run first("columns_all_but_symmetric", {in_steps(60), by_load_steps});
  REQUIRE(first.of("limit").size() == 2);
  for (const std::string& method : {by_arcs, by_load_steps})
    for (const int n : {9, 10, 12, 13, 15, 40}) {
      const Run run("columns_all_but_symmetric", {in_steps(n), method});
      CHECK_ENDS_AT(run, 1);
      falls_are_right(run);
      same_events(first, run);
    }
}

TEST_CASE("a column that bends away from a stiff stop stays on its branch, whatever the steps", "[paths][leaves_stiff_stop]") {
  const Run first("column_against_stiff_stop", {in_steps(60)});
  REQUIRE(first.of("limit").size() == 10);
  for (const int n : {3, 4, 6, 24, 50, 200}) {
    const Run run("column_against_stiff_stop", {in_steps(n)});
    CHECK_ENDS_AT(run, 4.3125);
    same_events(first, run);
  }
}

TEST_CASE("limit points that lie close together are met by load steps, whatever the steps", "[paths][limits_close_together]") {
  const Run first("arch_and_ball", {in_steps(100)});
  REQUIRE(first.of("limit").size() == 1);
  for (const int n : {4, 7, 13, 29}) {
    const Run run("arch_and_ball", {in_steps(n)});
    CHECK_ENDS_AT(run, 1);
    REQUIRE(run.of("limit").size() == 1);
    CHECK(run.of("limit")[0]["lambda"] == Approx(first.of("limit")[0]["lambda"]).epsilon(to_events));
    falls_are_right(run);
  }
}

TEST_CASE("load steps stay on the branch of an unfolded pitchfork beside contacts, whatever the steps", "[paths][pitchfork_beside_contacts]") {
  for (const char* name : {"column_into_corner", "columns_pushed_aside"}) {
    const Run first(name, {in_steps(100)});
    CHECK_ENDS_AT(first, 1);
    for (const int n : {4, 5, 13, 28, 29, 60}) {
      const Run run(name, {in_steps(n)});
      CHECK_ENDS_AT(run, 1);
      same_events(first, run);
      CHECK(run.path.back()["energy"] == Approx(first.path.back()["energy"]).epsilon(to_events));
    }
  }
}

TEST_CASE("side branches that leave a branch point steeply are followed, whatever the steps", "[paths][side_branches_steep]") {
  for (const int n : {13, 20, 30, 40, 50}) {
    const Run run("arch_side_branches", {in_steps(n)});
    INFO(run.what << run.answer.text);
    CHECK(run.answer.status == 0);
    CHECK(run.of("branch").size() >= 4);
    CHECK(run.branches() == 2);
  }
}

TEST_CASE("a beam that is glued to a body begins at rest", "[paths][glued_at_rest]") {
  for (const int particles : {4, 7, 20}) {
    const Run run("beam_glued_to_hub", {"beam.a.particles=" + std::to_string(particles)});
    CHECK_ENDS_AT(run, 1);
    CHECK(run.path.front()["energy"] < 1e-25);
  }
}

TEST_CASE("a column in space falls from a double branch point, whatever the steps", "[paths][column_twelve_jump]") {
  const double mu = 4 * std::pow(std::sin(pi / 10), 2), d = 1e-3, E = 0.96e6, K = pi * E * d / 8, B = pi * E * d * d * d / 64;     // 8 are free
  const double a = d * (1 + std::sqrt(1 - 2 * B * mu / (K * d * d))) / 2, critical = 9 * (B * mu / (2 * K * a)) / 0.74e-3;
  for (const int particles : {8, 12, 13})
    for (const int n : {5, 40, 49, 50, 51, 60, 100, 200}) {
      if (particles != 12 && n != 40) continue;
      const Run run("column_short_falls", {in_steps(n), "beam.column.particles=" + std::to_string(particles)});
      CHECK_ENDS_AT(run, 1);
      falls_are_right(run);
      INFO(run.what << run.told());
      REQUIRE(run.events.size() == 2);
      REQUIRE(run.of("branch").size() == 1);
      CHECK(run.of("jump").size() == 1);
      if (particles == 12) CHECK(run.events[0]["lambda"] == Approx(critical).epsilon(to_events));
      CHECK(run.located_rows.at("branch:1")["multiplicity"] == 2);
      CHECK(run.path.back()["negative"] == 0);
    }
}

TEST_CASE("every fall of two beams has its event and loses energy", "[paths][jump_gains_energy]") {
  for (const int n : {50, 100, 200}) {
    const Run run("two_beams_fall", {in_steps(n)});
    CHECK_ENDS_AT(run, 1);
    falls_are_right(run);
    contacts_are_told(run, 6.7e-6);
  }
}

// A wall or a grain pushes it at no force until the other side is met; then the row is pressed, and the ball is a pendulum upside down: it slips out.
TEST_CASE("a ball floats until it is caught", "[paths][free_ball]") {
  // 1.7 apart in the end: two overlaps of 0.15, U = 8/15 E √R δ^{5/2} each, R = 1/4.
  const double pressed = 2 * 8.0 / 15 * 0.5 * std::pow(0.15, 2.5);
  for (const int n : {3, 10, 17, 50})
    for (const std::string& method : {by_arcs, by_load_steps}) {
      const std::string contacts = "path.locate=[\"limit\",\"branch\",\"contact\"]";
      const Run followed("ball_between_two", {in_steps(n), method, follows, contacts});
      CHECK_ENDS_AT(followed, 1);
      INFO(followed.what << followed.told());
      REQUIRE(followed.events.size() == 2);
      CHECK(followed.of("contact")[0]["lambda"] == Approx(1.0 / 3).epsilon(to_events));
      CHECK(followed.of("contact")[1]["lambda"] == Approx(0.5).epsilon(to_events));
      CHECK(followed.path.back()["negative"] == 1);
      CHECK(followed.path.back()["energy"] == Approx(pressed).epsilon(1e-12));
      const Run slips("ball_between_two", {in_steps(n), method, snaps, contacts});
      if (method == by_load_steps) {                             // a fall ends where rounding leads it
        CHECK_ENDS_AT(slips, 1);
        falls_are_right(slips);
        CHECK(slips.path.back()["energy"] <= 1e-30 * pressed);
      }
      const Run quiet("ball_between_two", {in_steps(n), method, snaps});
      CHECK_ENDS_AT(quiet, 1);
    }
}

// Unlike the ball it bears forces, of its own. Grains from one side push it away and nothing else changes; from both they catch and pinch it.
TEST_CASE("a shell that bears forces of its own floats until it is caught", "[paths][shell_floats]") {
  for (const int n : {3, 10, 17, 50}) {
    const Run away("shell_floats", {in_steps(n), "support.ram.displacement=[0,0,-0.28]"});
    CHECK_ENDS_AT(away, 1);
    INFO(n << " steps" << away.what << away.told());
    CHECK(away.path.front()["energy"] > 0);
    CHECK(away.path.back()["energy"] == Approx(away.path.front()["energy"]).epsilon(1e-9));
    CHECK(away.path.back()["negative"] == 0);
    CHECK(away.path.size() <= 2 * n + 20u);                      // it does not creep
    const Run pinched("shell_floats", {in_steps(n)});
    CHECK_ENDS_AT(pinched, 1);
    // Where grains that roll it about catch it, and where it slips out between them, rounding decides: free it has its own energy, pinched more.
    const bool slipped = pinched.path.back()["contact"] == 0;
    CHECK(slipped == (pinched.path.back()["energy"] == Approx(away.path.front()["energy"]).epsilon(1e-12)));
    CHECK((slipped || pinched.path.back()["energy"] > away.path.front()["energy"]));
    CHECK(pinched.path.back()["negative"] == 0);
    CHECK(pinched.path.size() <= 2 * n + 20u);
  }
}

// A wall pushes cubes that touch, but for the last one, towards another wall: they go as far as they must, and bear a force only from where all touch.
TEST_CASE("loose cubes are pushed together at no force", "[paths][endless_loose_cubes]") {
  const double squeezed = 0.01, force = squeezed / (2 / (4 * 70.0) + 4 / (4 * 40.0));       // four corners each: springs in series
  for (const int n : {3, 10, 37})
    for (const std::string& method : {by_arcs, by_load_steps}) {
      const Run run("cubes_loose", {in_steps(n), method});
      CHECK_ENDS_AT(run, 1);
      INFO(run.what << run.told());
      REQUIRE(run.events.size() == 2);
      CHECK(run.of("contact")[0]["lambda"] == Approx(0.25).epsilon(to_events));
      CHECK(run.of("contact")[1]["lambda"] == Approx(0.5).epsilon(to_events));
      CHECK(run.path.back()["energy"] == Approx(force * squeezed / 2).epsilon(1e-9));
      CHECK(run.path.back()["negative"] == 0);
      const Run never("cubes_loose", {in_steps(n), method, "body.cube2.rounding_diameter=0.2"});
      CHECK_ENDS_AT(never, 1);
      CHECK(never.events.empty());
      CHECK(never.path.back()["energy"] <= 1e-20 * force * squeezed);
    }
}

TEST_CASE("a column that is let go comes back along its branch, whatever the steps", "[paths][column_let_go]") {
  for (const int n : {5, 8, 12, 17, 30, 50}) {
    const Run run("column_let_go", {in_steps(n), "path.points=4000"});
    CHECK_ENDS_AT(run, 0);
    CHECK(run.events.empty());
    CHECK(run.path.back()["energy"] == Approx(run.path.front()["energy"]).epsilon(1e-12));
  }
}

TEST_CASE("a stage with steps of its own has as many points as they need", "[paths][column_back_in_more_steps]") {
  const Run run("column_back_in_more_steps", {"path.steps=4"});
  CHECK_ENDS_AT(run, 0);
}

TEST_CASE("a heap that meets its mirror image goes on with both contacts closed", "[paths][heap_mirrored]") {
  const Run first("heap_mirrored", {in_steps(8), by_arcs});
  for (const std::string& method : {by_arcs, by_load_steps})
    for (const int n : {5, 17, 50}) {
      const Run run("heap_mirrored", {in_steps(n), method});
      CHECK_ENDS_AT(run, 1);
      CHECK(run.of("contact").size() == 3);
      same_events(first, run);
    }
}

TEST_CASE("where a heap lets its lid go the load factor turns, and it snaps", "[paths][heap_lets_go]") {
  const Run first("heap_lets_go", {in_steps(8), by_load_steps});
  for (const std::string& method : {by_arcs, by_load_steps})
    for (const int n : {5, 17, 50}) {
      const Run run("heap_lets_go", {in_steps(n), method});
      CHECK_ENDS_AT(run, 1);
      CHECK(run.of("limit").size() == 1);
      falls_are_right(run);
      same_events(first, run);
    }
}

TEST_CASE("a slender ring has one branch point of two modes, whatever the steps", "[paths][ring_slender]") {
  for (const int n : {20, 40, 71}) {
    const Run run("ring_slender", {in_steps(n)});
    CHECK_ENDS_AT(run, 1.4082524301844548);
    REQUIRE(run.events.size() == 1);
    // Two stiffnesses of a polygon of 170 bonds under pressure, as tests/bench/path_stress.cpp has them (ring_critical).
    CHECK(run.of("branch").front()["lambda"] == Approx(0.95366368473).epsilon(1e-9));
    CHECK(run.located_rows.at("branch:1")["multiplicity"] == 2);
  }
}

TEST_CASE("a column that is pushed by less than the tolerance of its residual has no branch point, whatever the steps", "[paths][column_pushed_unseen]") {
  for (const int n : {3, 4, 5, 7, 9, 17}) {
    const Run run("column_pushed_unseen", {in_steps(n)});
    CHECK_ENDS_AT(run, 0.67004566489771789);
    CHECK(run.events.empty());
  }
}

// In space nothing but the push, 1e-9 of the load, resists rotation about the axis beyond the critical load; in a plane the branch of the other side
// passes by near.
TEST_CASE("a slender column that is pushed next to nothing has no branch point, whatever the steps", "[paths][column_pushed_in_space]") {
  const auto same_end = [](const std::string& name, const std::string& first_steps, const std::vector<std::string>& others) {
    const Run first(name, {first_steps});
    CHECK(first.summary["status"] == "done");
    CHECK(first.events.empty());
    for (const std::string& steps : others) {
      INFO(name << " " << steps);
      const Run run(name, {steps});
      CHECK_ENDS_AT(run, first.end());
      CHECK(run.events.empty());
      CHECK(run.path.back()["energy"] == Approx(first.path.back()["energy"]).epsilon(1e-10));
    }
  };
  same_end("column_pushed_in_space", in_steps(14), {in_steps(5), in_steps(40)});
  same_end("column_pushed_passes", in_steps(3), {in_steps(8), in_steps(21)});
}

TEST_CASE("a slender column snaps from its branch point to a minimum, whatever the steps", "[paths][column_snaps_slender]") {
  const Run first("column_snaps_slender", {in_steps(40)});
  CHECK_ENDS_AT(first, 2.0665538235128222);
  REQUIRE(first.of("branch").size() == 1);
  const Run other("column_snaps_slender", {in_steps(181)});
  CHECK_ENDS_AT(other, 2.0665538235128222);
  same_events(first, other);
  for (const Run* run : {&first, &other}) CHECK(run->path.back()["negative"] == 0);
  CHECK(other.path.back()["energy"] == Approx(first.path.back()["energy"]).epsilon(1e-10));
}

TEST_CASE("a snap from a branch point of a bent path begins where any number of steps has it", "[paths][snap_of_bent_column]") {
  for (const int n : {7, 20, 50}) {
    const Run run("snap_of_bent_column", {in_steps(n)});
    CHECK_ENDS_AT(run, 3.1836987299696533);
    REQUIRE(run.events.size() == 3);
    const double at = run.of("branch").front()["lambda"];
    CHECK(at == Approx(3.1184476207678165).epsilon(to_events));
    CHECK(run.of("jump").front()["lambda"] == Approx(at + 1e-4 * 3.1836987299696533).epsilon(1e-12));
  }
}

TEST_CASE("a branch point on a bent side branch is exact, however the branch bends between the steps", "[paths][branch_points_on_side_branch]") {
  for (const int n : {5, 40, 90}) {
    const Run run("branch_points_on_side_branch", {in_steps(n)});
    INFO(run.what << run.told());
    const std::vector<TableRow> points = run.of("branch");
    REQUIRE(points.size() >= 31);
    CHECK(points[28]["lambda"] == Approx(0.20797527187934706).epsilon(1e-12));
    CHECK(points[30]["lambda"] == Approx(0.2648753495692400).epsilon(1e-12));
  }
}

// Unstable, on the way back, a column meets a stop that is all but rigid: nᵀH⁻¹n < 0 there, the load factor turns where the contact is made, and the contact makes it stable.
TEST_CASE("the load turns at a stiff contact on the way back, whatever the steps", "[paths][column_back_at_stop]") {
  const Run first("column_back_at_stop", {in_steps(10)});
  CHECK_ENDS_AT(first, 0.84529362413277542);
  REQUIRE(first.of("limit").size() == 2);
  CHECK(first.path.back()["negative"] == 0);
  for (const int n : {17, 50}) {
    const Run other("column_back_at_stop", {in_steps(n)});
    INFO(n << " steps");
    same_events(first, other);
    CHECK(other.path.back()["energy"] == Approx(first.path.back()["energy"]).epsilon(1e-12));
  }
}

TEST_CASE("a stiff contact is made once and lost once, whatever the steps", "[paths][stiff_contact_lost]") {
  const Run first("stiff_contact_lost", {in_steps(30)});
  CHECK_ENDS_AT(first, 1);
  REQUIRE(first.of("contact").size() == 2);
  contacts_are_told(first, 0.578);
  for (const int n : {5, 9, 17}) {
    const Run other("stiff_contact_lost", {in_steps(n)});
    CHECK_ENDS_AT(other, 1);
    same_events(first, other);
    CHECK(other.path.back()["energy"] == Approx(first.path.back()["energy"]).epsilon(1e-12));
  }
}

// Two grains of one size stand on the floor: the lid presses on one until it has come down to the other, where nothing presses on the first either.
TEST_CASE("a lid meets two grains at one load factor, which is told once, whatever the steps", "[paths][heap_meets_lid]") {
  const Run first("heap_meets_lid", {in_steps(8), by_load_steps});
  CHECK_ENDS_AT(first, 1);
  REQUIRE(first.events.size() == 3);
  for (const std::string& method : {by_arcs, by_load_steps})
    for (const int n : {5, 17, 50, 155}) {
      INFO(method << ", " << n << " steps");
      const Run run("heap_meets_lid", {in_steps(n), method});
      CHECK_ENDS_AT(run, 1);
      same_events(first, run);
    }
}

// Overlaps of 1e-11 of the size and less: what is left of each tells whether it is lost, not the size.
TEST_CASE("stiff contacts are lost one after the other, whatever the steps", "[paths][two_beams_part]") {
  const Run first("two_beams_part", {in_steps(10), by_load_steps});
  CHECK_ENDS_AT(first, 1);
  REQUIRE(first.of("contact").size() == 4);
  for (const std::string& method : {by_arcs, by_load_steps})
    for (const int n : {40, 81, 134}) {
      INFO(method << ", " << n << " steps");
      const Run run("two_beams_part", {in_steps(n), method});
      CHECK_ENDS_AT(run, 1);
      same_events(first, run);
    }
}

// A step from just before a limit point to where the other branch has its minimum.
TEST_CASE("no step goes over a limit point to another branch", "[paths][truss_there_and_back]") {
  for (const int n : {3, 4, 5, 6, 17}) {
    INFO(n << " steps");
    const Run run("truss_there_and_back", {in_steps(n)});
    const auto limits = run.of("limit");
    REQUIRE(limits.size() == 2);
    CHECK(limits[0]["lambda"] == Approx(1).epsilon(1e-9));
    CHECK(limits[1]["lambda"] == Approx(-1).epsilon(1e-9));
    falls_are_right(run);
  }
}

// Where a contact has just been made its gap vanishes, too: that is not where it is lost.
TEST_CASE("a contact is not lost where it was made", "[paths][two_beams_stiff]") {
  const Run first("two_beams_stiff", {in_steps(40), by_load_steps});
  CHECK_ENDS_AT(first, 1);
  REQUIRE(first.of("contact").size() == 4);
  for (const int n : {3, 4, 17}) {
    INFO(n << " steps");
    const Run run("two_beams_stiff", {in_steps(n), by_load_steps});
    CHECK_ENDS_AT(run, 1);
    same_events(first, run);
  }
}

// What moves a wall by the spacing of load factors moves forces by more than a residual may be.
TEST_CASE("a plate presses a ring however stiff it is and however short the steps", "[paths][ring_pressed_stiffly]") {
  constexpr double radius = 2.36938e-05, diameter = 3.9714858789078796e-07, plate = 2.6107753294637083e-05, down = 1.2111658574067991e-05;
  for (const int n : {20, 151, 200}) {
    const Run run("ring_pressed_stiffly", {in_steps(n), by_arcs, follows});
    CHECK_ENDS_AT(run, 1);
    REQUIRE(run.events.size() == 1);
    CHECK(run.of("contact").front()["lambda"] == Approx((plate - radius - diameter / 2) / down).epsilon(to_events));
    CHECK(run.path.size() < static_cast<std::size_t>(2 * n));
  }
}

TEST_CASE("the place of a contact that hardly anything tells does not depend on the steps", "[paths][ring_meets_plate_twice]") {
  const Run first("ring_meets_plate_twice", {in_steps(86), by_load_steps, snaps});
  CHECK_ENDS_AT(first, 1);
  REQUIRE(first.of("contact").size() == 2);
  for (const std::string& method : {by_arcs, by_load_steps})
    for (const int n : {3, 7, 20}) {
      const Run run("ring_meets_plate_twice", {in_steps(n), method, snaps});
      CHECK_ENDS_AT(run, 1);
      same_events(first, run);
    }
}

TEST_CASE("the load turns where a stiff contact is lost that kept a branch stable, whatever the steps", "[paths][two_beams_let_go]") {
  const Run first("two_beams_let_go", {in_steps(120)});
  CHECK_ENDS_AT(first, 1);
  REQUIRE(!first.of("limit").empty());
  for (const int n : {17, 40, 71}) {
    const Run run("two_beams_let_go", {in_steps(n)});
    CHECK_ENDS_AT(run, 1);
    same_events(first, run);
  }
}

TEST_CASE("a contact that is made and lost within a step is told", "[paths][two_beams_meet_briefly]") {
  const Run first("two_beams_meet_briefly", {in_steps(72), by_load_steps});
  CHECK_ENDS_AT(first, 1);
  REQUIRE(first.of("contact").size() == 4);
  for (const std::string& method : {by_arcs, by_load_steps})
    for (const int n : {3, 5}) {
      const Run run("two_beams_meet_briefly", {in_steps(n), method});
      CHECK_ENDS_AT(run, 1);
      same_events(first, run);
    }
}

TEST_CASE("a limit point is none of a branch though the load does hardly any work along its mode, whatever the steps", "[paths][two_beams_hardly_pushed]") {
  const Run first("two_beams_hardly_pushed", {in_steps(18)});
  CHECK_ENDS_AT(first, 1);
  REQUIRE(first.of("limit").size() == 2);
  CHECK(first.of("branch").empty());
  for (const int n : {10, 14, 40}) {
    const Run run("two_beams_hardly_pushed", {in_steps(n)});
    CHECK_ENDS_AT(run, 1);
    same_events(first, run);
  }
}

/// The same events whatever the steps, as many as told of one kind.
void same_in_steps(const std::string& name, double end, const std::string& kind, std::size_t count, const std::vector<int>& steps, const std::vector<std::string>& settings = {}) {
  const auto in = [&](int n) {
    std::vector<std::string> with{in_steps(n)};
    with.insert(with.end(), settings.begin(), settings.end());
    return with;
  };
  const Run first(name, in(steps.front()));
  CHECK_ENDS_AT(first, end);
  CHECK(first.of(kind).size() == count);
  for (std::size_t k = 1; k < steps.size(); ++k) {
    const Run run(name, in(steps[k]));
    CHECK_ENDS_AT(run, end);
    same_events(first, run);
  }
}

TEST_CASE("a limit point beside a branch point is where nothing is held, whatever the steps", "[paths][arch_events_close]") {
  same_in_steps("arch_events_close", 12.655618977496911, "limit", 2, {20, 7, 33, 144}, {by_arcs, follows});
}

TEST_CASE("a double branch point of a ring that hardly moves does not depend on the steps", "[paths][ring_hardly_moves]") {
  const Run first("ring_hardly_moves", {in_steps(60)});
  REQUIRE(first.of("branch").size() == 1);
  for (const int n : {5, 9, 14, 37}) same_events(first, Run("ring_hardly_moves", {in_steps(n)}));
}

TEST_CASE("a contact that the tangent meets on another branch is not gone to", "[paths][column_leaves_limit_ahead]") {
  same_in_steps("column_leaves_limit_ahead", 1.8782973757996093, "limit", 4, {60, 3, 10, 20, 30});
}

TEST_CASE("contacts that are lost one after the other are two events, however little they overlap", "[paths][two_beams_come_apart]") {
  same_in_steps("two_beams_come_apart", 1, "contact", 4, {119, 6, 20});
}

TEST_CASE("a contact that is lost and made within a step is told", "[paths][two_beams_part_briefly]") {
  same_in_steps("two_beams_part_briefly", 1, "contact", 3, {80, 5, 10}, {by_load_steps, snaps});
}

TEST_CASE("no load step goes over a bend that neither end tells", "[paths][two_beams_turn_back]") {
  same_in_steps("two_beams_turn_back", 1, "limit", 1, {80, 3}, {by_load_steps, snaps});
}

TEST_CASE("an unstable branch is not left for one beside it, whatever the steps", "[paths][two_beams_beside]") {
  same_in_steps("two_beams_beside", 1, "limit", 2, {199, 12, 16, 30});
}

TEST_CASE("a stiff contact gives no stability that the branch behind it does not have", "[paths][column_stopped_stiffly]") {
  same_in_steps("column_stopped_stiffly", 0.0070193515083156197, "branch", 1, {40, 4, 100});
}

TEST_CASE("contacts that are made and lost while others change are told in their order", "[paths][column_walks_along_stop]") {
  same_in_steps("column_walks_along_stop", 2.4116775665641983, "contact", 14, {60, 103}, {by_arcs, follows});
  same_in_steps("column_walks_along_stop", 2.4116775665641983, "contact", 14, {3, 20}, {by_load_steps, snaps});
}

// EA L²/EI = 5e8: a step off the saddle stretches the column; its first correction bends it too far, its second bends it back.
TEST_CASE("a stiff slender column leaves its saddle, whatever the steps", "[paths][column_leaves_saddle]") {
  same_in_steps("column_leaves_saddle", 0.013726239498445919, "jump", 1, {15, 6, 40});
}

// A contact that overlaps by rounding alone is stiffer than the heap, so the Morse index behind the event is that without it. The path begins beside
// a saddle between two contacts that bear next to nothing.
TEST_CASE("grains that leave a stiff lid where the branch turns back do so at one limit point, whatever the steps", "[paths][heap_leaves_lid]") {
  same_in_steps("heap_leaves_lid", 1, "limit", 1, {57, 31});
}

TEST_CASE("two limit points within a step are found, whatever the steps", "[paths][column_limits_in_a_step]") {
  same_in_steps("column_limits_in_a_step", 2.7977616279845514, "limit", 14, {57, 127});
}

TEST_CASE("a stiff contact that is made before another one is lost is an event of its own", "[paths][column_stop_made_before]") {
  same_in_steps("column_stop_made_before", 16.492892312274357, "contact", 63, {5, 23});
}

TEST_CASE("a branch does not go back where it turns at a contact", "[paths][column_turns_at_contact]") {
  same_in_steps("column_turns_at_contact", 7.8222381028621824, "limit", 8, {8, 5});
}

TEST_CASE("a path ends at its end, also where that is hard to locate", "[paths][column_stops_at_end]") {
  same_in_steps("column_stops_at_end", 5.3261656316246464, "contact", 66, {153, 14});
}

TEST_CASE("what is lost beside a limit point takes stability, however long the step is", "[paths][column_lost_beside_limit]") {
  same_in_steps("column_lost_beside_limit", 9.8091167207940089, "jump", 3, {113, 20});
}

TEST_CASE("contacts that are lost in pairs are located exactly", "[paths][column_leaves_in_pairs]") {
  same_in_steps("column_leaves_in_pairs", 3.1095117198668447, "contact", 14, {10, 23});
}

TEST_CASE("a limit point is told apart from a contact that is lost behind it by the force that is left", "[paths][heap_limit_beside_contact]") {
  const Run by_arc("heap_limit_beside_contact", {by_arcs, snaps, in_steps(81)}), by_load("heap_limit_beside_contact", {by_load_steps, snaps, in_steps(9)});
  CHECK_ENDS_AT(by_arc, 1);
  CHECK(by_arc.of("limit").size() == 1);
  same_events(by_arc, by_load);
}

// The wall is 10¹⁰ times as stiff as the ring: an overlap shrinks to a third an iteration, and stays the whole residual.
TEST_CASE("what bears nothing meets a stiff wall, near and far from the origin", "[paths][ring_meets_stiff_plate]") {
  for (const std::string name : {"ring_meets_stiff_plate", "ring_meets_far_plate"}) {
    const Run by_arc(name, {by_arcs, follows, in_steps(8)}), by_load(name, {by_load_steps, snaps, in_steps(6)});
    CHECK_ENDS_AT(by_arc, 1);
    CHECK(by_arc.of("contact").size() == 1);
    same_events(by_arc, by_load);
  }
}

// EA L²/EI = 10⁹: half a spacing of the load factor stretches the driven bond by more than the rounding of forces.
TEST_CASE("user events of a slender column do not depend on the method", "[paths][column_events_softly]") {
  same_events(Run("column_events_softly", {by_arcs, follows, in_steps(4)}), Run("column_events_softly", {by_load_steps, snaps, in_steps(6)}));
}

// The contact at the rim that keeps the sheet stable fades within 1e-8 of the load factor, and its stiffness with it.
TEST_CASE("a sheet snaps at the limit points where contacts fade, whatever the steps", "[paths][sheet_leaves_rim]") {
  const auto last_limits = [](const Run& run) {
    CHECK_ENDS_AT(run, 0.3);
    std::vector<TableRow> limits = run.of("limit");
    REQUIRE(limits.size() >= 3);
    return std::vector<TableRow>(limits.end() - 3, limits.end());
  };
  const std::vector<TableRow> first = last_limits(Run("sheet_leaves_rim", {in_steps(10)})), other = last_limits(Run("sheet_leaves_rim", {in_steps(23)}));
  for (std::size_t k = 0; k < first.size(); ++k) CHECK(first[k]["lambda"] == Approx(other[k]["lambda"]).epsilon(to_events));
  CHECK(first.front()["lambda"] == Approx(0.28700226437).epsilon(to_events));
}

TEST_CASE("a branch turns where a stiff contact is made that makes it stable, whatever the steps", "[paths][two_beams_stable_again]") {
  const Run first("two_beams_stable_again", {follows, in_steps(7)});
  CHECK_ENDS_AT(first, 1);
  CHECK(first.of("limit").size() == 6);
  for (const int n : {5, 23}) same_events(first, Run("two_beams_stable_again", {follows, in_steps(n)}));
}

// Weight W and force λF at the height h over the centre, half sides a and b along and across the floor; two edges bear W = 2 k δ in the end, and the
// box stands inclined by θ = δ/2a:  λ F h = W (a − θ b)  but for θ².
TEST_CASE("a box on a floor tips where its edge leaves, however little it overlaps", "[paths][box_tips_slowly]") {
  const double W = 0.0099272200000000005, F = 0.023407353929643458, h = 0.013843347025812164, a = 0.11084856595632499 / 2, b = 0.11957230553250875 / 2;
  const double inclined = W / (2 * 171683.68248351323) / (2 * a);
  for (const int n : {13, 92}) {
    const Run run("box_tips_slowly", {follows, in_steps(n)});
    CHECK_ENDS_AT(run, 0);
    REQUIRE(run.events.size() == 1);
    CHECK(run.events[0].text("label") == "limit:1");
    CHECK(run.events[0]["lambda"] == Approx(W * (a - inclined * b) / (F * h)).epsilon(to_events));
  }
}

TEST_CASE("columns side by side that are all but alike buckle one after the other, or all in one snap", "[paths]") {
  constexpr double modulus = 0.96e6, critical = 0.0046413862487778006;       // as in problems/hencky_hinged.toml
  std::ifstream file(case_file("columns_side_by_side"));
  std::vector<double> loads;
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("youngs_modulus = ")) loads.push_back(critical * std::stod(line.substr(17)) / modulus);
  REQUIRE(loads.size() == 10);
  const int steps = GENERATE(1, 7);
  for (const std::string& method : {by_arcs, by_load_steps}) {
    const Run straight("columns_side_by_side", {in_steps(steps), method, follows});
    INFO(straight.what << straight.told() << straight.answer.text);
    CHECK(straight.answer.status == 0);
    REQUIRE(straight.of("branch").size() == loads.size());
    for (std::size_t k = 0; k < loads.size(); ++k) CHECK(straight.of("branch")[k]["lambda"] == Approx(loads[k]).epsilon(to_events));
  }
  const Run bent("columns_side_by_side", {in_steps(steps), by_load_steps, snaps});
  INFO(bent.what << bent.told() << bent.answer.text);
  CHECK(bent.answer.status == 0);
  CHECK(bent.of("branch")[0]["lambda"] == Approx(loads[0]).epsilon(to_events));
  CHECK(bent.path.back()["negative"] == 0);
}

TEST_CASE("a branch goes on behind a sharp limit point, not back where it came from", "[paths][column_turns_sharply]") {
  const Run first("column_turns_sharply", {follows, in_steps(36)});
  CHECK_ENDS_AT(first, 4683.5831185849738);
  CHECK(first.of("limit").size() == 8);
  same_events(first, Run("column_turns_sharply", {follows, in_steps(60)}));
}

// The rest lengths of its bonds are rounded: what they bear is no force, and holds nothing.
TEST_CASE("a ring that floats between plates is pushed by one onto the other", "[paths][ring_pushed_by_plates]") {
  const std::string particles = GENERATE("24|[7,19]", "60|[16,46]", "120|[31,91]");
  const std::size_t bar = particles.find('|');
  const std::string lower = "wall.lower.displacement=[0,1e-3,0]";
  for (const std::string& method : {by_arcs, by_load_steps})
    for (const int n : {5, 17, 40}) {
      const std::vector<std::string> settings{method, in_steps(n), "loop.ring.particles=" + particles.substr(0, bar), "group.poles.ids=" + particles.substr(bar + 1)};
      std::vector<std::string> driven = settings;
      driven.push_back(lower);
      const bool both = (method == by_arcs) == (n == 17);
      const Run run("ring_pushed_by_plates", both ? driven : settings);
      CHECK_ENDS_AT(run, 1);
      contacts_are_told(run, 1e-3);
      REQUIRE(run.of("contact").size() >= 2);
      CHECK(run.of("jump").empty());
      CHECK(run.of("contact")[0]["lambda"] == Approx(0.3 / 4).epsilon(to_events));
      CHECK(run.of("contact")[1]["lambda"] == Approx(0.4 / (both ? 5 : 4)).epsilon(to_events));
    }
}

// In five steps one of them leads from the side branch to beyond the point at which it ends, with tangents that tell most of the way.
TEST_CASE("a stable side branch that ends on a straight one leads to it, in long steps and by arc length, too", "[paths][column_met_from_aside]") {
  const Run fine("column_met_from_aside", {by_load_steps, in_steps(60)});
  CHECK_ENDS_AT(fine, 0.09);
  REQUIRE(fine.of("branch").size() == 3);
  CHECK(fine.located_rows.at("branch:3").text("what") == "reached along a side branch");
  for (const std::string& method : {by_arcs, by_load_steps})
    for (const int n : {4, 5, 6, 7, 17}) {
      const Run run("column_met_from_aside", {method, in_steps(n)});
      CHECK_ENDS_AT(run, 0.09);
      REQUIRE(run.of("branch").size() == 3);
      for (std::size_t k = 0; k < 3; ++k) CHECK(run.of("branch")[k]["lambda"] == Approx(fine.of("branch")[k]["lambda"]).epsilon(to_events));
      CHECK(run.path.back()["energy"] == Approx(fine.path.back()["energy"]).epsilon(1e-12));
    }
}

// On which side a snap lands rounding decides; what happens is the same but for the side.
TEST_CASE("where two mirror images of a branch with hard contacts meet, the contacts go on that belong to both", "[paths][column_hard_walls_mirrored]") {
  const Run first("column_hard_walls_mirrored", {in_steps(13)});
  CHECK_ENDS_AT(first, 0.5);
  for (const int n : {60, 25}) {
    const Run run("column_hard_walls_mirrored", {in_steps(n)});
    CHECK_ENDS_AT(run, 0.5);
    for (const char* kind : {"contact", "branch"}) {
      REQUIRE(run.of(kind).size() == first.of(kind).size());
      for (std::size_t k = 0; k < run.of(kind).size(); ++k) CHECK(run.of(kind)[k]["lambda"] == Approx(first.of(kind)[k]["lambda"]).epsilon(to_events));
    }
  }
}

TEST_CASE("a snap beside hard contacts lands in the nearest of alike minima, whatever the steps", "[paths][column_half_buckles]") {
  const Run first("column_half_buckles", {in_steps(7)});
  CHECK_ENDS_AT(first, 0.5);
  REQUIRE(first.of("branch").size() > 1);
  for (const int n : {12, 23, 50}) {
    const Run run("column_half_buckles", {in_steps(n)});
    CHECK_ENDS_AT(run, 0.5);
    REQUIRE(run.events.size() == first.events.size());
    for (std::size_t k = 0; k < run.events.size(); ++k) CHECK(run.events[k]["lambda"] == Approx(first.events[k]["lambda"]).epsilon(to_events));
  }
}

namespace {

const std::string locates_nothing = "path.locate=[]";

int factorizations(const Run& run) {
  int all = 0;
  for (const auto& of : run.summary["factorizations"]) all += of.get<int>();
  return all;
}

}  // namespace

TEST_CASE("a path that locates nothing ends where one does that locates all, in less than half the factorisations", "[paths][locate_nothing]") {
  for (const char* name : {"heap_leaves_lid", "sheet_leaves_rim", "strip_meets_stop", "two_beams_stiff", "two_beams_turn_back"}) {
    const Run all(name, {by_load_steps, snaps}), none(name, {by_load_steps, snaps, locates_nothing});
    INFO(name << ": " << all.answer.text << none.answer.text);
    REQUIRE(!all.path.empty());
    REQUIRE(!none.path.empty());
    CHECK(none.answer.status == 0);
    CHECK(none.end() == all.end());
    CHECK(none.path.back()["energy"] == Approx(all.path.back()["energy"]).epsilon(to_events));
    CHECK(none.of("jump").size() == none.events.size());
    CHECK(2 * factorizations(none) < factorizations(all));
  }
}

TEST_CASE("a snap that is not located begins within a quarter of a step before its event, and loses energy", "[paths][locate_nothing]") {
  for (const char* name : {"two_beams_turn_back", "two_beams_let_go", "two_beams_hardly_pushed", "two_beams_part_briefly"})
    for (const int n : {7, 20, 61}) {
      const Run all(name, {in_steps(n), by_load_steps, snaps}), none(name, {in_steps(n), by_load_steps, snaps, locates_nothing});
      INFO(name << " " << n << ": " << all.told() << " | " << none.told());
      REQUIRE(all.of("jump").size() == 1);
      REQUIRE(none.of("jump").size() == 1);
      const double step = (all.end() - all.path.front()["lambda"]) / n;
      const TableRow event = row_of(all.path, all.of("jump").front().text("parent")), snap = none.of("jump").front();
      CHECK(snap["lambda"] >= event["lambda"]);
      CHECK(snap["lambda"] <= event["lambda"] + (1 + 1e-9) * step / 4);
      double from = 0, to = 0;
      REQUIRE(std::sscanf(none.located_rows.at(snap.text("label")).text("what").c_str(), "from energy %lf to %lf", &from, &to) == 2);
      CHECK(to < from);
      CHECK(none.path.back()["energy"] == Approx(all.path.back()["energy"]).epsilon(to_events));
    }
}

TEST_CASE("contacts made at once of which one opens soon are told, on the way back too, whatever the steps", "[paths][ball_touches_two]") {
  // The beam is straight where the ball comes to it: √(1/4 + (1.9 − 2λ)²) = 3/2.
  const double both = (1.9 - std::sqrt(2.0)) / 2;
  for (const int n : {3, 5, 11, 29, 50, 200}) {
    const Run run("ball_touches_two", {in_steps(n)});
    CHECK_ENDS_AT(run, 0);
    INFO(run.told());
    REQUIRE(run.events.size() == 4);
    CHECK(run.located_rows.at("contact:1").text("what") == "a 6 touches ball 1, a 7 touches ball 1");
    CHECK(run.located_rows.at("contact:2").text("what") == "a 7 leaves ball 1");
    CHECK(run.located_rows.at("contact:3").text("what") == "a 7 touches ball 1");
    for (const std::size_t k : {0, 3}) CHECK(run.events[k]["lambda"] == Approx(both).epsilon(1e-12));
    CHECK(run.events[1]["lambda"] == Approx(run.events[2]["lambda"]).epsilon(to_events));
  }
}

TEST_CASE("a contact that is lost where a step begins and made again within it is told, whatever the steps", "[paths][arches_nested]") {
  const Run one("arches_nested", {by_arcs, in_steps(11)});
  CHECK_ENDS_AT(one, 1);
  for (const int n : {3, 5, 29, 50}) {
    const Run run("arches_nested", {in_steps(n)});
    CHECK_ENDS_AT(run, 1);
    same_events(run, one);
    contacts_are_told(run, 1);
  }
}

TEST_CASE("a ring that bears forces of its own is pushed as it floats, whatever the steps", "[paths][ring_floats_bent]") {
  for (const std::string& method : {by_load_steps, by_arcs})
    for (const int n : {3, 7, 20, 50}) {
      const Run run("ring_floats_bent", {method, in_steps(n)});
      CHECK_ENDS_AT(run, 1);
      INFO(run.what << run.told());
      REQUIRE(run.events.size() == 2);                          // the lid comes to it, and then it to the floor: 0.2 and 0.4 of 2
      CHECK(run.events[0]["lambda"] == Approx(0.1).epsilon(to_events));
      CHECK(run.events[1]["lambda"] == Approx(0.2).epsilon(to_events));
      CHECK(run.located_rows.at("contact:1").text("what") == "ring 7 touches wall lid");
      CHECK(run.located_rows.at("contact:2").text("what") == "ring 19 touches wall floor");
    }
}

TEST_CASE("what nothing holds at the start comes to rest before its path begins, by both methods", "[paths][grains_fall_first]") {
  for (const std::string& method : {by_load_steps, by_arcs}) {
    const Run run("grains_fall_first", {method});
    CHECK_ENDS_AT(run, 1);
    for (const TableRow& row : run.path) CHECK(row["negative"] == 0);
  }
}

namespace {

/// The strain ε at which a hinged column of n links buckles: links of the length l (1 − ε) under the force  EA ε = 4 k/(l (1 − ε)) sin²(π/2n),  k = EI/l the
/// stiffness of an angle. With `bending` = EI/(EA l²).
double critical_strain(double bending, int n) {
  const double x = 16 * bending * std::pow(std::sin(pi / (2 * n)), 2);
  return x / 2 / (1 + std::sqrt(1 - x));                        // (1 − √(1 − x))/2 without cancellation
}

/// The critical load of column_critical_on_grid: EA = 1e6, EI/(EA l²) = 1e-4.
const double critical_load = 1e6 * critical_strain(1e-4, 10);
std::string loaded_by(double force) { return fmt::format("load.1.force=[0,0,{:.17g}]", -force); }

}  // namespace

TEST_CASE("an instability that lies on a load step is told, whatever the steps", "[paths][column_critical_on_grid][truss_limit_on_grid]") {
  for (const std::string& method : {by_load_steps, by_arcs})
    for (const int n : {2, 6, 10, 24}) {
      const Run column("column_critical_on_grid", {method, snaps, in_steps(n)});
      CHECK_ENDS_AT(column, 2);
      REQUIRE(column.of("branch").size() == 2);
      CHECK(column.of("branch")[0]["lambda"] == Approx(1).epsilon(to_events));
      CHECK(column.of("jump").size() == 2);
      const Run toggle("truss_limit_on_grid", {method, snaps, in_steps(n)});
      CHECK_ENDS_AT(toggle, 2);
      REQUIRE(toggle.of("limit").size() == 1);
      CHECK(toggle.of("limit")[0]["lambda"] == Approx(1).epsilon(to_events));
      CHECK(toggle.of("jump").size() == 1);
    }
}

// The end may be the branch point itself, or so near behind it that the two minima beside the straight state cannot be told from that.
TEST_CASE("a path that ends where it loses its stability ends there", "[paths][column_critical_on_grid]") {
  for (const double behind : {0.0, 2e-9, 1e-8})
    for (const std::string& method : {by_load_steps, by_arcs})
      for (const std::string& then : {snaps, follows}) {
        const Run run("column_critical_on_grid", {method, then, "path.to=1", in_steps(behind > 0 ? 4 : 7), loaded_by(critical_load * (1 + behind))});
        INFO(run.what << run.answer.text << run.told());
        CHECK(run.answer.status == 0);
        REQUIRE(run.of("branch").size() == 1);
        CHECK(run.of("branch")[0]["lambda"] == Approx(1 / (1 + behind)).epsilon(to_events));
        CHECK(run.of("jump").empty());
        for (const TableRow& row : run.path) CHECK(row["lambda"] <= 1 + 1e-12);
        CHECK(std::abs(run.end() - 1) <= 1e-12);
      }
}

TEST_CASE("a snap passes the next load step where that is too near to begin there", "[paths][column_critical_on_grid]") {
  for (const int n : {2, 4, 20}) {
    const Run run("column_critical_on_grid", {by_load_steps, in_steps(n), loaded_by(critical_load * (1 + 5e-9))});
    CHECK_ENDS_AT(run, 2);
    REQUIRE(run.of("branch").size() == 2);
    CHECK(run.of("branch")[0]["lambda"] == Approx(1 - 5e-9).epsilon(to_events));
    CHECK(run.of("jump").size() == 2);
  }
}

TEST_CASE("a column that is pushed next to nothing far beyond its critical load has no event", "[paths][column_pushed_far_beyond]") {
  const Run fine("column_pushed_far_beyond", {by_load_steps, in_steps(60)});
  CHECK_ENDS_AT(fine, 1);
  CHECK(fine.events.empty());
  for (const std::string& method : {by_load_steps, by_arcs})
    for (const int n : {10, 20, 40}) {
      const Run run("column_pushed_far_beyond", {method, in_steps(n)});
      CHECK_ENDS_AT(run, 1);
      CHECK(run.events.empty());
      CHECK(run.path.back()["w"] == Approx(fine.path.back()["w"]).epsilon(to_events));
    }
}

TEST_CASE("of two events on one step the first is told first, on the way back, too", "[paths][events_on_the_way_back]") {
  for (const std::string& method : {by_load_steps, by_arcs})
    for (const int n : {4, 8, 20}) {
      const Run run("events_on_the_way_back", {method, in_steps(n)});
      CHECK_ENDS_AT(run, 0);
      INFO(run.told());
      REQUIRE(run.events.size() == 4);
      const std::pair<const char*, double> expected[] = {{"half:1", 0.25}, {"other:1", 0.3}, {"other:2", 0.3}, {"half:2", 0.25}};
      for (int k = 0; k < 4; ++k) {
        CHECK(run.events[k].text("label") == expected[k].first);
        CHECK(run.events[k]["lambda"] == Approx(expected[k].second).epsilon(to_events));
      }
    }
}

// Of one that is straight, reversed, all load factors are those of the other one with the other sign.
TEST_CASE("a side branch of a column of few links arrives at the straight one, reversed or not", "[paths][column_side_branch_returns]") {
  const auto comes_back = [](const Run& run) {
    CHECK_ENDS_AT(run, Approx(1).epsilon(to_events));            // where it began: the other half is the way back
    CHECK(run.branches() == 1);
  };
  for (const int n : {5, 16}) {
    const Run run("column_side_branch_returns", {in_steps(n)});
    comes_back(run);
    REQUIRE(run.events.size() == 14);
    const auto load = [&](std::size_t k) { return run.events[k]["lambda"]; };
    CHECK(load(0) == Approx(1).epsilon(to_events));
    for (std::size_t k = 0; k < 7; ++k) CHECK(load(k + 7) == Approx(-load(k)).epsilon(to_events));
    CHECK(run.located_rows.at(run.events[7].text("label")).text("what") == "reached along a side branch");
  }
  std::vector<double> reached;
  for (const int n : {41, 132}) {
    const Run run("column_side_branch_arrives", {in_steps(n)});
    comes_back(run);
    const std::vector<TableRow> branches = run.of("branch");
    REQUIRE(branches.size() == 5);
    CHECK(branches[2]["lambda"] == Approx(branches[4]["lambda"]).epsilon(to_events));      // on the way there and back
    CHECK(run.located_rows.at("branch:4").text("what") == "reached along a side branch");
    reached.push_back(branches[3]["lambda"]);
  }
  CHECK(reached[0] == Approx(reached[1]).epsilon(to_events));
}

TEST_CASE("a stable path goes on to its end where it meets a straight branch beside a twin that is all but critical", "[paths][columns_twins_unload]") {
  const double critical = critical_strain(1e-3, 10) / 0.0009869604401089359;
  for (const std::string push : {"9.869604401089357e-06", "1e-8"})
    for (const int n : {5, 21}) {
      const Run run("columns_twins_unload", {in_steps(n), "load.1.force=[" + push + ",0,0]"});
      CHECK_ENDS_AT(run, 0);
      REQUIRE(run.events.size() == 3);
      CHECK(kind_of(run.events[1]) == "jump");
      CHECK(run.located_rows.at("branch:2").text("what") == "reached along a side branch");
      for (const char* branch : {"branch:1", "branch:2"}) CHECK(run.located_rows.at(branch)["lambda"] == Approx(critical).epsilon(to_events));
      CHECK(run.path.back()["wa"] == Approx(1.02 / 48 * std::stod(push)).epsilon(1e-6));       // F L³/48EI (1 + 2/n²)
      CHECK(std::abs(std::strtod(run.path.back().text("wb").c_str(), nullptr)) < 1e-12);      // it may be too small for a double
    }
}

// With an odd number of bars the mode that turns the way it sways has another sign on the other half of a side branch.
TEST_CASE("the side branches of a double branch point arrive at another one", "[paths][pod_sways]") {
  for (const int bars : {4, 5})
    for (const int n : {5, 40, 173}) {
      std::string positions = "[";
      for (int k = 0; k < bars; ++k)
        positions += fmt::format("[{:.17g},{:.17g},0],", std::cos(68 * pi / 180) * std::cos(0.2 + 2 * pi * k / bars), std::cos(68 * pi / 180) * std::sin(0.2 + 2 * pi * k / bars));
      positions += fmt::format("[0,0,{:.17g}]]", std::sin(68 * pi / 180));
      const Run run("pod_sways", {in_steps(n), "grains.g.positions=" + positions, fmt::format("group.feet.first={}", bars), fmt::format("load.1.force=[0,0,{:.17g}]", -0.3049687782576506 / 4 * bars)});
      INFO(run.what << run.answer.text << run.told());
      CHECK(run.answer.status == 0);
      REQUIRE(run.events.size() >= 2);
      for (const TableRow& event : run.events) {
        CHECK(kind_of(event) == "branch");
        CHECK(std::abs(event["lambda"]) == Approx(1).epsilon(to_events));
        CHECK(run.located_rows.at(event.text("label"))["multiplicity"] == 2);
      }
    }
}

TEST_CASE("beside hard walls a saddle is left, a limit point has its snap, and a push is followed", "[paths][hard_walls_saddles]") {
  const std::map<std::string, std::vector<std::string>> kinds{{"arch_above_hard_floor", {"branch", "jump", "contact", "contact", "limit", "jump"}},
                                                              {"arch_onto_hard_floor", {"branch", "jump", "limit", "jump"}},
                                                              {"column_pushed_hard_walls", {"contact", "contact", "contact", "contact", "contact"}}};
  for (const auto& [name, expected] : kinds) {
    std::unique_ptr<Run> first;
    for (const int n : {4, 9, 60}) {
      auto walked = std::make_unique<Run>(name, std::vector{in_steps(n)});
      const Run& run = *walked;
      INFO(run.what << run.answer.text << run.told());
      CHECK(run.answer.status == 0);
      REQUIRE(run.events.size() == expected.size());
      for (std::size_t k = 0; k < expected.size(); ++k) {
        CHECK(kind_of(run.events[k]) == expected[k]);
        if (first) CHECK(run.events[k]["lambda"] == Approx(first->events[k]["lambda"]).epsilon(to_events));
      }
      if (first) CHECK(run.path.back()["energy"] == Approx(first->path.back()["energy"]).epsilon(to_events));
      else first = std::move(walked);
    }
  }
}

// The knee is a few millionths of the way; the limit point beyond it is the other branch's, and opens onward.
TEST_CASE("a step that passes the knee of a column that is all but perfect stays on the side of the push", "[paths][column_pushed_knee]") {
  for (const std::string push : {"3.1e-7", "-1e-7", "1e-6", "-2e-5"}) {
    double energy = 0;
    for (const int n : {2, 3, 8, 47})
      for (const std::string& by : {by_load_steps, by_arcs}) {
        const Run run("column_pushed_knee", {in_steps(n), by, "load.1.force=[" + push + ",0,0]"});
        CHECK_ENDS_AT(run, 1);
        CHECK(run.events.empty());
        CHECK(run.path.back()["w"] * std::stod(push) > 0);
        if (energy == 0) energy = run.path.back()["energy"];
        CHECK(run.path.back()["energy"] == Approx(energy).epsilon(1e-10));
      }
  }
}

TEST_CASE("a stage that begins at a limit point, where the one before has stopped, goes back along the stable branch", "[paths][column_stops_and_unloads]") {
  double energy = 0;
  for (const int n : {2, 5, 10, 50})
    for (const std::string& by : {by_load_steps, by_arcs, std::string("stage.s3.method=\"arc_length\"")}) {
      const Run run("column_stops_and_unloads", {"stage.s2.steps=" + std::to_string(n), "stage.s3.steps=" + std::to_string(n), by});
      CHECK_ENDS_AT(run, -1);
      REQUIRE(run.events.size() == 1);
      CHECK(kind_of(run.events[0]) == "limit");
      if (energy == 0) energy = run.path.back()["energy"];
      CHECK(run.path.back()["energy"] == Approx(energy).epsilon(1e-10));
    }
}

TEST_CASE("a stable branch that leaves a contact does not go back along its mirror image, whatever the steps", "[paths][column_unloads_beside_mirror]") {
  same_in_steps("column_unloads_beside_mirror", 0, "contact", 6, {50, 5, 13}, {by_arcs, follows});
}

// A step of the load factor has no length to tell by how far the branch has gone from where it began.
TEST_CASE("a branch that has hardly begun does not close to a loop, nor does it chatter between mirror images on its way back", "[paths][column_leaves_hardly_pushed]") {
  same_in_steps("column_leaves_hardly_pushed", 0, "contact", 13, {40, 12, 13}, {by_arcs, snaps});
  same_in_steps("column_leaves_hardly_pushed", 0, "contact", 13, {20, 7}, {by_load_steps, snaps});
}

TEST_CASE("behind a contact steps grow from what has been taken, so that no corner is missed", "[paths][column_turns_in_a_corner]") {
  same_in_steps("column_turns_in_a_corner", 0, "limit", 4, {13, 50, 90}, {by_arcs, follows});
  same_in_steps("column_turns_right_behind_stop", 0, "contact", 22, {50, 13, 90}, {by_arcs, follows});
}

// At a limit point the equations are singular: its tangent is the direction of the branch over that of the load factor.
TEST_CASE("a branch goes on from a branch point right behind a limit point", "[paths][column_branches_behind_limit]") {
  const Run first("column_branches_behind_limit", {in_steps(20)});
  CHECK(first.of("branch").size() == 18);
  for (const int n : {13, 30, 50}) {
    const Run run("column_branches_behind_limit", {in_steps(n)});
    CHECK(run.answer.status == 0);
    same_events(first, run);
  }
}

// The contact of two beams that are much softer than it overlaps by 1e-12 of their thickness at most.
TEST_CASE("a stiff contact that is lost where the branch turns back is told as a limit point", "[paths][beams_part_at_a_limit]") {
  same_in_steps("beams_part_at_a_limit", 1, "limit", 2, {100, 20, 46, 200});
}

TEST_CASE("a contact that overlaps by rounding where it is made does not hide the branch point before it", "[paths][column_touches_twice]") {
  same_in_steps("column_touches_twice", 6.057525974789618, "branch", 1, {67, 5, 10, 20});
}

TEST_CASE("two branch points on a step that ends on a contact are found, though their modes are not alike at its ends", "[paths][column_stable_before_contact]") {
  const Run first("column_stable_before_contact", {in_steps(20), by_arcs});
  CHECK(first.of("branch").size() == 18);
  for (const int n : {5, 7, 13}) {
    const Run run("column_stable_before_contact", {in_steps(n), by_arcs});
    CHECK(run.answer.status == 0);
    same_events(first, run);
  }
}

TEST_CASE("a limit point of the branch beside an unfolded pitchfork is no branch point", "[paths][column_pitchfork_unfolded_in_contact]") {
  same_in_steps("column_pitchfork_unfolded_in_contact", 1, "branch", 0, {13, 5, 40, 80}, {by_arcs, snaps});
}

TEST_CASE("a residual that bounces below its tolerance is no equilibrium, so that a limit point right behind a contact is not passed", "[paths][column_turns_behind_contact]") {
  same_in_steps("column_turns_behind_contact", 1, "limit", 10, {13, 5, 20, 50}, {by_arcs, follows});
}

TEST_CASE("a snap that begins hardly behind its branch point ends in one minimum, whatever the steps", "[paths][column_snaps_beside_branch]") {
  same_in_steps("column_snaps_beside_branch", 0.035246465239896947, "jump", 1, {14, 5, 30}, {by_load_steps, snaps});
}

TEST_CASE("an oval of a ring is neutral between the ends of its first step, too", "[paths][ring_hardly_oval]") {
  same_in_steps("ring_hardly_oval", 1.7186168952469987, "branch", 1, {4, 6, 20}, {by_arcs, follows});
}

TEST_CASE("contacts that are lost at load factors 3e-7 apart are two events, whatever the steps", "[paths][column_leaves_twice]") {
  same_in_steps("column_leaves_twice", 9.4625058141230003, "contact", 47, {132, 4, 40}, {by_arcs, follows});
}

TEST_CASE("a contact that has just been made is lost before another one is made, whatever the steps", "[paths][column_leaves_and_returns]") {
  same_in_steps("column_leaves_and_returns", 23.872070030084327, "contact", 44, {30, 9, 15}, {by_arcs, follows});
}

TEST_CASE("a limit point that is found only where soft modes are held is none", "[paths][column_unfolded_on_two_contacts]") {
  same_in_steps("column_unfolded_on_two_contacts", 8.6, "limit", 0, {50, 5, 17, 49, 200}, {by_arcs, follows});
}

TEST_CASE("what is neutral at both ends of a step has no sign between them", "[paths][ring_oval_hardly_neutral]") {
  same_in_steps("ring_oval_hardly_neutral", 0.94138743477112587, "branch", 1, {14, 5, 8, 25});
}

TEST_CASE("the load factor goes on behind a contact as its gap opens", "[paths][column_turns_before_contact_is_lost]") {
  same_in_steps("column_turns_before_contact_is_lost", 15.966757694717815, "limit", 20, {9, 4, 17});
}

TEST_CASE("a limit point of a branch that passes by opens the other way where contacts are closed, too", "[paths][column_limit_of_other_branch_in_contact]") {
  same_in_steps("column_limit_of_other_branch_in_contact", 8.6405738378936373, "limit", 3, {7, 5, 10, 50});
}

TEST_CASE("a fold of another branch along which the load does next to no work is no branch point", "[paths][column_nearly_symmetric_on_contacts]") {
  same_in_steps("column_nearly_symmetric_on_contacts", 53.316239786666912, "branch", 0, {6, 5, 50});
}

TEST_CASE("where a force is left along the critical mode there is no branch point", "[paths][column_all_but_symmetric]") {
  same_in_steps("column_all_but_symmetric", 153.1114957503279, "branch", 0, {10, 8, 12}, {by_load_steps, snaps});
}

TEST_CASE("on the way to where a contact is lost no other one is made", "[paths][heap_rocks_under_lid]") {
  same_in_steps("heap_rocks_under_lid", 1, "limit", 1, {10, 4, 5, 20}, {by_load_steps, snaps});
}

TEST_CASE("a column that is all but free to spin about its line is followed in few steps", "[paths][column_all_but_free_to_spin]") {
  for (const int n : {34, 20, 45}) {
    const Run run("column_all_but_free_to_spin", {in_steps(n), by_arcs, snaps});
    CHECK_ENDS_AT(run, 21.069287367090411);
    CHECK(run.events.empty());
    CHECK(run.path.size() < 300);
  }
}
