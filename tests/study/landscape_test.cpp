// [landscape]: minima, saddles and barriers, against closed forms and equilibria that another program computed.
#include "catch.hpp"
#include "reference.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"
#include "study/truss.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace {

// Barriers are differences of energies, each of which has rounding: some 1e-15 of the larger one.
constexpr double rounding = 1e-14;

struct Ran {
  Answer answer;
  std::vector<TableRow> rows;
  nlohmann::json json;
  double operator()(const std::string& label, double load_factor, const char* column) const {
    for (const TableRow& row : rows)
      if (row.text("label") == label && row["lambda"] == load_factor) return row[column];
    throw std::out_of_range("no row " + label);
  }
};

/// A landscape; the table's cells have no quotes but those of `what`, the last column.
Ran explored(const std::string& problem, const std::string& options = "", int status = 0) {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", problem);
  Ran ran{elamin_says("'" + file + "' --quiet " + options, 120), {}, {}};
  INFO(ran.answer.text);
  REQUIRE(ran.answer.status == status);
  ran.rows = table_of(scratch / "p/landscape.csv");
  ran.json = nlohmann::json::parse(text_of(scratch / "p/landscape.json"));
  return ran;
}

std::string landscape(const std::vector<double>& at, double to, const std::string& more = "") {
  std::ostringstream text;
  text.precision(17);
  text << "[path]\nmethod = \"arc_length\"\nsteps = 50\nto = " << to << "\n[landscape]\nat = [";
  for (const double load : at) text << load << ", ";
  text << "]\n" << more;
  return text.str();
}

/// The height between lo and hi where the truss bears a load.
double height_at(double load, double lo, double hi) {
  for (int k = 0; k < 200; ++k) {
    const double mid = lo + (hi - lo) / 2;
    ((truss_load(mid) < load) == (truss_load(lo) < load) ? lo : hi) = mid;
  }
  return lo;
}

/// Its energy, (r − r₀)² of each bond, and the load's.
double truss_energy(double load, double z) {
  const double strain = std::sqrt(1 + z * z) - std::sqrt(1.25);
  return 2 * strain * strain + load * z;
}

}  // namespace

TEST_CASE("the barriers of a shallow truss are those of the closed form, until it snaps", "[landscape]") {
  const double high = 0.9 * truss_limit;
  const Ran ran = explored(truss + landscape({0, high, 1.1 * truss_limit}, 1.2 * truss_limit));
  // Without load: two images of one minimum, and the flat truss between them.
  CHECK(ran("minimum:1", 0, "multiplicity") == 2);
  CHECK(ran("minimum:1", 0, "barrier") == Approx(2 * std::pow(std::sqrt(1.25) - 1, 2)).epsilon(rounding));
  CHECK(std::abs(ran("saddle:1", 0, "z")) < 1e-15);
  CHECK(ran("saddle:1", 0, "negative") == 1);
  for (const double load : {0.0, high}) {
    CHECK(ran("graph", load, "minima") == 2);
    CHECK(ran("graph", load, "saddles") == 1);
    CHECK(ran("graph", load, "euler") == 1);
  }
  // With it three heights.
  const double up = height_at(high, truss_limit_z, 0.5), top = height_at(high, 0, truss_limit_z), down = height_at(high, -2, -0.5);
  const double barrier = truss_energy(high, top) - truss_energy(high, up), size = truss_energy(high, top);
  CHECK(ran("minimum:1", high, "z") == Approx(up).epsilon(1e-12));
  CHECK(ran("minimum:2", high, "z") == Approx(down).epsilon(1e-12));
  CHECK(ran("saddle:1", high, "z") == Approx(top).epsilon(1e-12));
  CHECK(std::abs(ran("saddle:1", high, "barrier") - barrier) < rounding * size);
  CHECK(std::abs(ran("saddle:1", high, "barrier_back") - (truss_energy(high, top) - truss_energy(high, down))) < rounding * size);
  // Behind the limit point of the path one minimum is left.
  CHECK(ran("graph", 1.1 * truss_limit, "minima") == 1);
  CHECK(ran("graph", 1.1 * truss_limit, "saddles") == 0);
  REQUIRE(ran.json["changes"].size() == 1);
  const nlohmann::json& change = ran.json["changes"][0];
  CHECK(change["event"] == "limit:1");
  CHECK(change["nodes"] == nlohmann::json::array({"minimum:1", "saddle:1"}));
  CHECK(std::abs(change["load_factor"].get<double>() - truss_limit) < 1e-7 * truss_limit);
  CHECK(ran.json["notes"].empty());
}

TEST_CASE("the barrier of a truss vanishes with the power 3/2 of what is left to its limit point", "[landscape]") {
  // With z = z(s) on the branch, λ = λ_c − s²:  ΔE = ∫ (δ − s²) z'(s) ds over |s| ≤ √δ = A δ^(3/2) (1 + B δ + O(δ²)),  z' = a₁ + 2a₂ s + 3a₃ s² + …,
  //   A = 4a₁/3,  B = 3a₃/(5a₁),  and from λ(z) = λ_c − c₂u² + c₃u³ + c₄u⁴, u = z − z_c:  a₁ = 1/√c₂,  a₃/a₁ = (5c₃²/(4c₂) + c₄)/(2c₂²).
  const double r = std::cbrt(std::sqrt(1.25)), z = truss_limit_z, r0 = std::sqrt(1.25), r5 = std::pow(r, 5);
  // λ = −4z + 4 r₀ z/r:  with f = z/r,  f' = 1/r³, f'' = −3z/r⁵, f''' = −3/r⁵ + 15z²/r⁷, f'''' = 45z/r⁷ − 105z³/r⁹.
  const double c2 = 4 * r0 * 3 * z / r5 / 2, c3 = 4 * r0 * (-3 / r5 + 15 * z * z / (r5 * r * r)) / 6;
  const double c4 = 4 * r0 * (45 * z / (r5 * r * r) - 105 * std::pow(z, 3) / (r5 * std::pow(r, 4))) / 24;
  const double a = 4 / (3 * std::sqrt(c2)), b = 3.0 / 5 * (5 * c3 * c3 / (4 * c2) + c4) / (2 * c2 * c2);
  std::vector<double> left, loads, barriers;
  for (const double part : {16e-4, 4e-4, 1e-4}) left.push_back(part * truss_limit), loads.push_back(truss_limit - left.back());
  const Ran ran = explored(truss + landscape(loads, 1.2 * truss_limit, "starts = 0\n"));
  for (const double load : loads) barriers.push_back(ran("saddle:1", load, "barrier"));
  for (std::size_t k = 0; k < 3; ++k) {
    const double next = b * left[k];
    const double size = truss_energy(loads[k], z);
    CAPTURE(k, next);
    CHECK(rounding * size / barriers[k] < 0.01 * std::abs(next));
    CHECK(std::abs(barriers[k] / (a * std::pow(left[k], 1.5)) - 1 - next) < 10 * next * next + rounding * size / barriers[k]);
    if (k == 0) continue;
    const double exponent = std::log(barriers[k - 1] / barriers[k]) / std::log(4);
    const double before = b * left[k - 1];                       // ln(1 + before) − ln(1 + next)
    CHECK(std::abs(exponent - 1.5) < std::abs(before));
    CHECK(std::abs(exponent - 1.5 - (before - next) / std::log(4)) < 10 * before * before + rounding * size / barriers[k]);
  }
}

TEST_CASE("the barrier of an arch vanishes with the power 3/2, too", "[landscape]") {
  std::string problem = text_of(ELAMIN_ROOT "/problems/arch_landscape.toml");
  problem.erase(problem.find("[landscape]"));
  const double limit = 0.35927109805549823;                      // data/exact/arch_clamped_tilted.json
  const std::vector<double> left{16e-4, 4e-4, 1e-4};
  std::ostringstream text;
  text.precision(17);
  text << problem << "[landscape]\nmodes = 1\nstarts = 0\nat = [" << limit - left[0] << ", " << limit - left[1] << ", " << limit - left[2] << "]\n";
  const Ran ran = explored(text.str());
  std::vector<double> barriers, exponents;
  for (const double l : left) barriers.push_back(ran("saddle:1", limit - l, "barrier"));
  for (int k : {0, 1}) exponents.push_back(std::log(barriers[k] / barriers[k + 1]) / std::log(4));
  // 3/2 + ¾ B δ/ln 4 + O(δ²): what the next term adds is a quarter from one to the next.
  const double first = exponents[0] - 1.5, second = exponents[1] - 1.5, size = 4.0 / 3 * std::log(4) * std::abs(first);       // |B| δ
  CAPTURE(first, second);
  CHECK(size < 0.1);
  CHECK(std::abs(first) < size);
  CHECK(std::abs(second - first / 4) < size * size);
}

TEST_CASE("a column gets from one side to the other over the straight one, then over its second mode", "[landscape]") {
  const std::string problem = text_of(ELAMIN_ROOT "/problems/column_landscape.toml");
  const nlohmann::json expected = reference("exact/landscapes.json")["column"];
  // Walks along soft modes find the saddles, and so does a line between the two minima, which a path that jumps and a reflection tell. Of the second mode
  // there are two images: half a wave to the left below and to the right above, and the other way round.
  for (const char* found_by : {"--set landscape.starts=0 --set landscape.strings=false",
                               "--set landscape.modes=0 --set landscape.starts=0 --set path.when_unstable=jump"}) {
    const Ran ran = explored(problem, found_by);
    for (const nlohmann::json& e : expected) {
      const double load = e["lambda"];
      const std::string saddle = load < 0.3 ? "saddle:1" : "saddle:2";
      CAPTURE(found_by, load);
      CHECK(ran("graph", load, "minima") == 2);
      CHECK(ran("graph", load, "saddles") == (load < 0.3 ? 1 : 2));
      CHECK(ran("minimum:2", load, "multiplicity") == 2);
      CHECK(ran("minimum:2", load, "energy") == Approx(e["minimum"].get<double>()).epsilon(1e-12));
      CHECK(ran(saddle, load, "energy") == Approx(e["saddle"].get<double>()).epsilon(1e-12));
      CHECK(ran(saddle, load, "barrier") == Approx(e["barrier"].get<double>()).epsilon(1e-12));
      CHECK(ran(saddle, load, "negative") == 1);
    }
    REQUIRE(ran.json["changes"].size() == 2);
    CHECK(ran.json["changes"][0]["event"] == "branch:1");
    if (found_by == std::string("--set landscape.starts=0 --set landscape.strings=false")) CHECK(ran.json["changes"][1]["event"] == "branch:2");
    for (const nlohmann::json& edge : ran.json["landscapes"][2]["edges"]) CHECK(edge["minima"][0] != edge["minima"][1]);     // its two sides
  }
}

TEST_CASE("a line between two minima that are given leads to the saddle between them", "[landscape]") {
  // The truss falls through, and is unloaded to the load at which the path of the landscape knows the standing one alone.
  const ScratchDirectory scratch;
  const double load = 0.5 * truss_limit, beyond = 1.2 * truss_limit;
  const auto path = [&](double from, double to, const std::string& more) {
    std::ostringstream text;
    text.precision(17);
    text << truss << "[path]\nsteps = 10\nfrom = " << from << "\nto = " << to << "\n" << more;
    return text.str();
  };
  for (const auto& [name, text] : {std::pair{"falls.toml", path(0, beyond, "when_unstable = \"jump\"\n")},
                                   std::pair{"hangs.toml", path(beyond, load, "start = \"falls/states/final.data\"\n")},
                                   std::pair{"both.toml", path(0, load, "[landscape]\nmodes = 0\nstarts = 0\nrun = \"hangs\"\n")},
                                   std::pair{"apart.toml", path(0, load, "[landscape]\nmodes = 0\nstarts = 0\nrun = \"hangs\"\nstrings = false\n")}}) {
    const Answer answer = elamin_says("'" + scratch.file(name, text) + "' --quiet", 60);
    INFO(answer.text);
    REQUIRE(answer.status == 0);
  }
  const Ran both{{}, table_of(scratch / "both/landscape.csv"), {}}, apart{{}, table_of(scratch / "apart/landscape.csv"), {}};
  CHECK(apart("graph", load, "minima") == 2);
  CHECK(apart("graph", load, "saddles") == 0);
  CHECK(text_of(scratch / "apart/summary.json").find("not all minima are joined by the saddles that were found") != std::string::npos);
  CHECK(both("graph", load, "saddles") == 1);
  const double top = height_at(load, 0, truss_limit_z), up = height_at(load, truss_limit_z, 0.5);
  CHECK(both("saddle:1", load, "z") == Approx(top).epsilon(1e-12));
  CHECK(std::abs(both("saddle:1", load, "barrier") - (truss_energy(load, top) - truss_energy(load, up))) < rounding * truss_energy(load, top));
}

TEST_CASE("deflation and random starts find what no walk is made to", "[landscape]") {
  // The standing truss alone is known at this load.
  const double load = 0.5 * truss_limit;
  std::ostringstream text;
  text.precision(17);
  text << truss << "[path]\nsteps = 10\nto = " << load << "\n[landscape]\nmodes = 0\nstrings = false\nstarts = ";
  const Ran alone = explored(text.str() + "0\n"), deflated = explored(text.str() + "0\ndeflate = 2\n");
  CHECK(alone("graph", load, "minima") == 1);
  CHECK(deflated("graph", load, "minima") == 2);
  CHECK(deflated("graph", load, "saddles") == 1);
}

#ifndef __SANITIZE_ADDRESS__                     // which would take many times as long, and has no say in bits

TEST_CASE("a landscape has the same bits for any number of threads", "[landscape]") {
  const std::string problem = text_of(ELAMIN_ROOT "/problems/column_landscape.toml");
  std::vector<std::string> said;
  for (const char* threads : {"--threads 1", "--threads 2", "--threads 4"}) {
    const Ran ran = explored(problem, threads);
    said.push_back(ran.json.dump());
    for (const TableRow& row : ran.rows)
      for (const auto& [column, cell] : row.cells) said.back() += cell + ",";
  }
  CHECK((said[0] == said[1]));
  CHECK((said[0] == said[2]));
}

#endif

TEST_CASE("landscapes that cannot be", "[landscape]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", truss + landscape({2 * truss_limit}, 1.2 * truss_limit));
  const Answer nothing = elamin_says("'" + file + "' --quiet", 60);
  INFO(nothing.text);
  CHECK(nothing.status == 2);
  CHECK(nothing.text.find("no equilibrium is known that a landscape could begin with; choose one that the path meets") != std::string::npos);
}
