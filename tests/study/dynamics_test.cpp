#include "catch.hpp"
#include "scratch_directory.hpp"
#include "study/lammps_case.hpp"

#include <filesystem>

namespace {

// Columns first … first + 2 of a frame, 3 × particles.
Eigen::MatrixXd columns(const std::vector<std::vector<std::string>>& frame, int first) {
  Eigen::MatrixXd m(3, frame.size() - 1);
  for (std::size_t i = 1; i < frame.size(); ++i)
    for (int c = 0; c < 3; ++c) m(c, static_cast<Eigen::Index>(i - 1)) = std::stod(frame[i][first + c]);
  return m;
}

double number_in(const std::vector<std::vector<std::string>>& table, const std::string& step, const std::string& column) {
  const auto at = std::find(table[0].begin(), table[0].end(), column) - table[0].begin();
  for (const auto& row : table)
    if (row[0] == step) return std::stod(row[at]);
  FAIL("no step " << step);
  return 0;
}

const std::string falling_grain = R"(
[[grains]]
name = "grain"
positions = [[0, 0, 2]]
diameter = 1
density = 2
[[gravity]]
acceleration = [0, 0, -10]
)";

}  // namespace

TEST_CASE("motions are LAMMPS's", "[study][dynamics][reference]") {
  for (const std::string name : {"dyn_clamped_beam", "dyn_grains_box", "dyn_two_beams"}) {
    const LammpsCase c(name);
    const ScratchDirectory scratch;
    const Answer answer = elamin_says("'" + scratch.file("case.toml", c.problem("dynamics")) + "' --quiet");
    INFO(name << ": " << answer.text);
    REQUIRE(answer.status == 0);
    const auto trajectory = csv_rows(scratch / "case/trajectory.csv");
    const auto records = nlohmann::json(c.expected["records"]);
    const double extent = [&] {
      const Eigen::MatrixXd x = matrix(records[0]["positions"]);
      return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
    }();
    double stiffest = 0;
    for (const auto& t : nlohmann::json(c.parameters["bond"]["types"])) stiffest = std::max(stiffest, t["K"].get<double>());
    for (const auto& r : records) {
      const int step = r["step"];
      INFO("step " << step);
      const double allowed = step <= 10 ? 1e-12 : 1e-9;      // of the reference, as its README has it
      const auto frame = csv_rows(scratch / ("case/frames/" + std::to_string(step) + ".csv"));
      const auto near = [&](const char* what, int first, double scale) {
        const Eigen::MatrixXd known = matrix(r[what]);
        CHECK((columns(frame, first) - known).cwiseAbs().maxCoeff() <= allowed * std::max(scale, known.cwiseAbs().maxCoeff()));
      };
      near("positions", 1, extent);
      if (step == 0) continue;                               // LAMMPS gives driven particles their velocity, and its drag, in the first step
      // Positions that differ by so much have forces that differ by the stiffness of two bonds times that.
      near("velocities", 4, 0), near("forces", 7, 4 * stiffest * extent);
      const std::string at = std::to_string(step);
      CHECK(number_in(trajectory, at, "energy") + number_in(trajectory, at, "kinetic") == Approx(r["energy_total"].get<double>()).epsilon(allowed));
      CHECK(number_in(trajectory, at, "kinetic") == Approx(r["energy_lammps"]["kinetic"].get<double>()).epsilon(allowed).margin(1e-300));
      CHECK(number_in(trajectory, at, "bond") == Approx(r["energy_lammps"]["bond"].get<double>()).epsilon(1e-9).margin(allowed * r["energy_total"].get<double>()));
    }
  }
}

TEST_CASE("a motion leaves rows, frames and states", "[study][dynamics]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("fall.toml", falling_grain + R"(
[dynamics]
timestep = 0.01
steps = 25
every = 10
record = [0, 7]
[[observe]]
name = "speed"
group = "grain"
quantity = "velocity.z"
[[expect]]
observable = "speed"
at = "step=13"
value = -1.3
rtol = 1e-14
)");
  const Answer answer = elamin_says("verify '" + file + "'");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  const auto rows = csv_rows(scratch / "fall/trajectory.csv");
  std::vector<std::string> steps, labels;
  for (std::size_t k = 1; k < rows.size(); ++k) steps.push_back(rows[k][0]), labels.push_back(rows[k][1]);
  CHECK(steps == std::vector<std::string>{"0", "7", "10", "13", "20", "25"});
  CHECK(labels == std::vector<std::string>{"initial", "", "", "", "", "final"});
  // Under a constant force Verlet's steps are exact: z = 2 − g t²/2, and the energy stays.
  const double mass = 2 * 3.14159265358979312 / 6, t = 0.25;
  CHECK(number_in(rows, "25", "kinetic") == Approx(mass / 2 * 100 * t * t).epsilon(1e-14));
  CHECK(number_in(rows, "25", "balance") == Approx(number_in(rows, "0", "balance")).epsilon(1e-14));
  CHECK(std::filesystem::exists(scratch / "fall/frames/0.csv"));
  CHECK(std::filesystem::exists(scratch / "fall/frames/7.csv"));
  CHECK(!std::filesystem::exists(scratch / "fall/frames/10.csv"));
  CHECK(!std::filesystem::exists(scratch / "fall/path.csv"));
  const auto summary = nlohmann::json::parse(std::ifstream(scratch / "fall/summary.json"));
  CHECK(summary["status"] == "done");
  CHECK(summary["final"]["time"].get<double>() == Approx(0.25).epsilon(1e-15));

  // The final state goes on where the motion ended, velocities and all.
  const std::string on = scratch.file("on.toml", falling_grain + "[study]\ntype = \"dynamics\"\n[path]\nstart = \"fall/states/final.data\"\n"
                                                                 "[dynamics]\ntimestep = 0.01\nsteps = 25\n");
  const std::string whole = scratch.file("whole.toml", falling_grain + "[dynamics]\ntimestep = 0.01\nsteps = 50\n");
  REQUIRE(elamin_says("'" + on + "' --quiet").status == 0);
  REQUIRE(elamin_says("'" + whole + "' --quiet").status == 0);
  CHECK(number_in(csv_rows(scratch / "on/trajectory.csv"), "25", "kinetic") == Approx(number_in(csv_rows(scratch / "whole/trajectory.csv"), "50", "kinetic")).epsilon(1e-13));
}

TEST_CASE("motion and rest hand their states to each other", "[study][dynamics]") {
  const std::string column = R"(
plane = "xz"
[[beam]]
name = "column"
section = "cylinder"
particles = 12
from = [0, 0, 0]
to = [0, 0, 11e-3]
diameter = 1e-3
youngs_modulus = 1e6
density = 800
[[group]]
name = "clamp"
first = 2
[[support]]
group = "clamp"
[[load]]
group = "all"
force = [1e-7, 0, 0]
[[viscosity]]
coefficient = 2e-5
)";
  const ScratchDirectory scratch;
  const auto energy_in = [&](const std::string& name) -> double {
    return nlohmann::json::parse(std::ifstream(scratch / (name + "/summary.json")))["final"]["energy"];
  };
  REQUIRE(elamin_says("'" + scratch.file("rest.toml", column) + "' --quiet").status == 0);
  // At rest in equilibrium nothing moves: the residual is the largest force there is.
  const std::string still = scratch.file("still.toml", column + "[study]\ntype = \"dynamics\"\n[path]\nstart = \"rest/states/final.data\"\n[dynamics]\ntimestep = 1e-6\nsteps = 1000\n");
  const Answer answer = elamin_says("'" + still + "' --quiet");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  CHECK(energy_in("still") == Approx(energy_in("rest")).epsilon(1e-12));
  // Damped dynamics, and a motion that has lost most of its energy, come to the same minimum.
  REQUIRE(elamin_says("'" + scratch.file("relaxed.toml", column + "[dynamics]\nrelax = true\n") + "' --quiet").status == 0);
  CHECK(energy_in("relaxed") == Approx(energy_in("rest")).epsilon(1e-12));
  REQUIRE(elamin_says("'" + scratch.file("motion.toml", column + "[dynamics]\ntimestep = 1e-5\nsteps = 5000\n") + "' --quiet").status == 0);
  const std::string after = scratch.file("after.toml", column + "[study]\ntype = \"equilibrium\"\n[path]\nstart = \"motion/states/final.data\"\n");
  REQUIRE(elamin_says("'" + after + "' --quiet").status == 0);
  CHECK(energy_in("after") == Approx(energy_in("rest")).epsilon(1e-12));
}
