#include "catch.hpp"
#include "chain.hpp"
#include "core/dense.hpp"
#include "lammps/data.hpp"
#include "scratch_directory.hpp"
#include "study/column.hpp"
#include "study/spectrum.hpp"
#include "study/modes.hpp"
#include "study/program.hpp"

#include <nlohmann/json.hpp>


#include <set>

using namespace elamin;

namespace {

/// Modes are what they claim: ascending, orthonormal, H v = λ v. `open` is left of an eigenvalue, beside the largest one, and
/// so its root of a vector.
void check_modes(Energy& energy, const State& state, const std::vector<Mode>& modes, double open) {
  const Vector all = spectrum(energy, state);
  const double scale = all.cwiseAbs().maxCoeff();
  for (std::size_t k = 0; k < modes.size(); ++k) {
    CHECK(std::abs(modes[k].eigenvalue - all[static_cast<Eigen::Index>(k)]) <= open * scale);
    const Vector v = energy.kinematics().restrict(modes[k].shape);
    CHECK((energy.multiply(v) - modes[k].eigenvalue * v).norm() <= std::sqrt(open) * scale);
    for (std::size_t l = 0; l <= k; ++l)
      CHECK(std::abs(modes[k].shape.cwiseProduct(modes[l].shape).sum() - (k == l)) <= 1e-12);
  }
}

}  // namespace

TEST_CASE("modes of a chain that is free: rigid motions by name, then pairs of bending modes", "[modes]") {
  const double scale = GENERATE(1e-9, 1.0, 1e9);
  Model m = chain(6, 100 * scale, 1 * scale, 1);
  Energy energy(m);
  Newton newton(energy);
  const Equilibrium e = assess(newton, m.start, {});
  const std::vector<Mode> modes = lowest_modes(newton, e, 9);
  REQUIRE(modes.size() == 9);
  check_modes(energy, m.start, modes, 1e-12);
  std::set<std::string> names;
  for (int k = 0; k < 5; ++k) {
    CHECK(!modes[k].zero_mode.empty());
    names.insert(modes[k].zero_mode);
  }
  CHECK(names.size() == 5);                                    // the row does not turn about itself
  CHECK(names.count("translation of 'chain' along x") == 1);
  for (const Mode& mode : modes)
    if (mode.zero_mode == "translation of 'chain' along x")
      CHECK((mode.shape.row(0).array() - 1 / std::sqrt(6.0)).abs().maxCoeff() <= 1e-12);
  for (int k = 5; k < 9; ++k) CHECK(modes[k].zero_mode.empty());
  // Of each pair the first bends along x, the second along y, whatever rounding is.
  for (const int k : {5, 7}) {
    CHECK(modes[k].eigenvalue == Approx(modes[k + 1].eigenvalue).epsilon(1e-10));
    CHECK(modes[k].shape.row(0).norm() == Approx(1).epsilon(1e-7));
    CHECK(modes[k + 1].shape.row(1).norm() == Approx(1).epsilon(1e-7));
  }
}

TEST_CASE("modes of an unstable state, and more modes than there are", "[modes]") {
  Model m = chain(8, 1000, 1, 1);
  hold(m, 0, 1), hold(m, 6, 7, {true, true, true}, Vec3(0, 0, -0.2));
  Energy energy(m);
  Newton newton(energy);
  State state = m.start;
  energy.kinematics().prescribe(state, 1);
  const Report report = newton.correct(state);
  REQUIRE(report.converged());
  const Equilibrium e = assess(newton, state, report);
  CHECK(e.point.stability.negative > 2);
  const std::vector<Mode> modes = lowest_modes(newton, e, 100);
  REQUIRE(modes.size() == 12);
  check_modes(energy, state, modes, 1e-12);
  CHECK(modes[0].eigenvalue < 0);
  CHECK(lowest_modes(newton, e, 1).size() == 1);
}

TEST_CASE("the study of modes through the program", "[modes][study]") {
  const ScratchDirectory scratch;
  const std::string problem = column_and_ends + R"(
[[support]]
group = "bottom"
[[support]]
group = "top"
displacement = [0, 0, -0.25e-3]
[study]
type = "modes"
[modes]
count = 3
[[expect]]
observable = "eigenvalue_1"
value = -1e9
atol = 1e9
[[expect]]
observable = "negative"
value = 1
)";
  // Beyond its critical shortening 0.187 d and short of the next one the straight column has one negative eigenvalue.
  const std::string file = scratch.file("column.toml", problem);
  const Answer answer = elamin_says("verify '" + file + "' -o '" + (scratch / "out") + "'");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  const auto final = nlohmann::json::parse(text_of(scratch / "out/summary.json"))["final"];
  const auto rows = csv_rows(scratch / "out/modes.csv");
  REQUIRE(rows.size() == 4);
  for (int k = 1; k <= 3; ++k) CHECK(std::stod(rows[k][1]) == final["eigenvalue_" + std::to_string(k)].get<double>());
  CHECK(std::stod(rows[1][1]) < 0);
  CHECK(std::stod(rows[2][1]) > 0);
  CHECK(csv_rows(scratch / "out/path.csv").size() == 2);
  // The moved state is the final one and a tenth of the diameter of the mode.
  const Field moved = read_lammps_data(scratch / "out/states/mode-1.data").position - read_lammps_data(scratch / "out/states/final.data").position;
  CHECK(moved.colwise().norm().maxCoeff() == Approx(1e-4).epsilon(1e-10));
  const auto shape = csv_rows(scratch / "out/modes/mode-1.csv");
  REQUIRE(shape.size() == 15);
  double norm = 0, most = 0;
  for (std::size_t k = 1; k < shape.size(); ++k) norm += std::pow(std::stod(shape[k][1]), 2) + std::pow(std::stod(shape[k][3]), 2), most = std::max(most, std::stod(shape[k][1]));
  CHECK(norm == Approx(1).epsilon(1e-12));
  CHECK(most == Approx(std::stod(shape[7][1])).epsilon(1e-6));     // the middle moves most, towards +x
}

TEST_CASE("free motions are modes, by name", "[study]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("free.toml", R"(
[[beam]]
name = "rod"
particles = 6
from = [0, 0, 0]
to = [0, 0, 5]
diameter = 1
youngs_modulus = 100
[study]
type = "modes"
[modes]
count = 6
[[expect]]
observable = "negative"
value = 0
)");
  const Answer answer = elamin_says("verify '" + file + "' -o '" + (scratch / "out") + "'");
  INFO(answer.text);
  CHECK(answer.status == 0);
  const std::string modes = text_of(scratch / "out/modes.csv");
  for (const char* name : {"translation of 'rod' along x", "translation of 'rod' along y", "translation of 'rod' along z",
                           "rotation of 'rod' about x", "rotation of 'rod' about y"})
    CHECK(modes.find(name) != std::string::npos);
}
