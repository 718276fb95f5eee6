// lambda_error: how far an event is off by rounding, held against the same problem with other rounding.
#include "catch.hpp"
#include "core/types.hpp"
#include "scratch_directory.hpp"
#include "study/results_of.hpp"
#include "study/truss.hpp"

#include <cmath>

namespace {

using elamin::pi;

struct Located { double load, error; };

std::vector<TableRow> events_of(const std::string& problem) {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", problem);
  const Answer answer = elamin_says("'" + file + "' --quiet", 60);
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  return table_of(scratch / "p/events.csv");
}

Located located(const std::string& problem, const std::string& label) {
  const TableRow row = row_of(events_of(problem), label);
  REQUIRE_FALSE(row.text("lambda_error").empty());
  return {row["lambda"], row["lambda_error"]};
}

std::string list(double x, double y, double z) {
  std::ostringstream text;
  text.precision(17);
  text << "[" << x << ", " << y << ", " << z << "]";
  return text.str();
}

/// A hinged column of 20 links, turned by an angle in its plane and enlarged; stiffness EA L²/EI.
std::string column(double turn, double size, double slender, int steps) {
  const auto along = [&](double s) { return list(size * s * std::sin(turn), 0, size * s * std::cos(turn)); };
  std::ostringstream text;
  text.precision(17);
  text << "plane = \"xz\"\n[[beam]]\nname = \"b\"\nparticles = 21\nfrom = " << along(0) << "\nto = " << along(1) << "\ndiameter = " << 0.01 * size
       << "\naxial_stiffness = " << slender << "\nbending_stiffness = " << size * size << "\n"
       << "[[group]]\nname = \"lo\"\nof = \"b\"\nfirst = 1\n[[group]]\nname = \"hi\"\nof = \"b\"\nlast = 1\n[[support]]\ngroup = \"lo\"\n[[support]]\ngroup = \"hi\"\n"
       << "displacement = " << along(-0.02) << "\n[[observe]]\nname = \"energy_of_all\"\ngroup = \"b\"\nquantity = \"energy\"\n"
       << "[path]\nevent_errors = true\nsteps = " << steps << "\nwhen_unstable = \"stop\"\nlocate = [\"branch\"]\n";
  return text.str();
}

}  // namespace

TEST_CASE("Limit points of a truss are off by less than their error, in any units and steps", "[event_error]") {
  for (const int steps : {7, 50, 400})
    for (const double scale : {1.0, 1e-6, 1e9}) {
      std::string problem = truss;
      const auto put = [&](const std::string& from, const std::string& to) { problem.replace(problem.find(from), from.size(), to); };
      std::ostringstream stiffness, force;
      stiffness << "bond_stiffness = " << scale, force << "force = [0, 0, " << -scale << "]";
      put("bond_stiffness = 1", stiffness.str()), put("force = [0, 0, -1]", force.str());
      const Located limit = located(problem + "[path]\nevent_errors = true\nmethod = \"arc_length\"\nto = 1\nsteps = " + std::to_string(steps) + "\n", "limit:1");
      INFO(steps << " steps, stiffness " << scale << ": off by " << limit.load - truss_limit << ", error " << limit.error);
      CHECK(std::abs(limit.load - truss_limit) <= limit.error);
      CHECK(limit.error < 1e-14 * std::abs(limit.load));
    }
}

TEST_CASE("Branch points of turned, enlarged and slender columns differ by less than their errors", "[event_error]") {
  // Driven by its top a chain buckles where P a = 4B sin²(π/2N) with the compressed links a = r₀ − P/2K, whatever the coordinates.
  for (const double slender : {1e4, 1e6, 1e8}) {
    const double r0 = 1.0 / 20, B = 1 / r0, twice_K = slender / r0, s = 4 * B * std::pow(std::sin(pi / 40), 2);
    const double a = (r0 + std::sqrt(r0 * r0 - 4 * s / twice_K)) / 2, exact = (r0 - a) * 20 / 0.02, exact_by_P = 2 * s / twice_K / (r0 + std::sqrt(r0 * r0 - 4 * s / twice_K)) * 20 / 0.02;
    INFO("EA L²/EI = " << slender << ": " << exact << " " << exact_by_P);
    for (const double turn : {0.0, 0.3, 1.1})
      for (const double size : {1.0, 1e-3, 700.0})
        for (const int steps : {11, 97}) {
          const Located branch = located(column(turn, size, slender, steps), "branch:1");
          INFO("turned by " << turn << ", size " << size << ", " << steps << " steps: off by " << branch.load - exact_by_P << ", error " << branch.error);
          CHECK(std::abs(branch.load - exact_by_P) <= branch.error);
          CHECK(branch.error < 1e-9 * branch.load * std::max(1.0, slender / 1e6));
        }
  }
}

TEST_CASE("A contact is off by less than its error", "[event_error]") {
  for (const double floor : {0.4375, 0.421875, 0.40625}) {                 // with radii of 1/16 no number of the problem is rounded
    std::string problem = truss;
    for (std::size_t at; (at = problem.find("diameter = 0.1\n")) != std::string::npos;) problem.replace(at, 14, "diameter = 0.125");
    std::ostringstream wall;
    wall.precision(17);
    wall << "[[wall]]\nname = \"floor\"\ngroup = \"apex\"\nshape = \"plane\"\npoint = [0, 0, " << floor - 0.0625 << "]\nnormal = [0, 0, 1]\neffective_modulus = 1e3\n";
    const Located contact = located(problem + wall.str() + "[path]\nevent_errors = true\nsteps = 20\nto = " + std::to_string(0.9 * truss_limit) + "\n", "contact:1");
    INFO("floor at " << floor << ": off by " << contact.load - truss_load(floor) << ", error " << contact.error);
    const double of_closed_form = 4 * floor * 3 * elamin::epsilon / 2;                // three roundings of what is about 1, times 4 z
    CHECK(std::abs(contact.load - truss_load(floor)) <= contact.error + of_closed_form);
    CHECK(contact.error < 1e-13);
  }
}

TEST_CASE("Errors of events are told where they are asked for, and change nothing else", "[event_error]") {
  const std::string asks = column(0.3, 1, 1e6, 11);
  std::string plain = asks;
  plain.replace(plain.find("event_errors = true\n"), 20, "");
  const std::vector<TableRow> with = events_of(asks), without = events_of(plain);
  REQUIRE(with.size() == without.size());
  CHECK(row_of(with, "branch:1")["lambda"] == row_of(without, "branch:1")["lambda"]);
  CHECK(row_of(without, "branch:1").cells.count("lambda_error") == 0);
}
