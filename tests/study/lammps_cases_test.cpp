#include "catch.hpp"
#include "reference.hpp"
#include "scratch_directory.hpp"
#include "study/program.hpp"

#include "problem/lammps_data.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>

#include <filesystem>

namespace {

std::string ids_text(const nlohmann::json& atoms) { return atoms.dump(); }

std::string vector_text(const nlohmann::json& v) {
  return fmt::format("[{:.17g}, {:.17g}, {:.17g}]", v[0].get<double>(), v[1].get<double>(), v[2].get<double>());
}

// The problem file of a case: its data file, loads and clamps as case.json says.
std::string problem_text(const std::string& directory, const nlohmann::json& c) {
  std::string toml = fmt::format("[study]\ntype = \"{}\"\n[lammps]\ndata = \"{}/case.data\"\n", c["kind"] == "equilibrium" ? "equilibrium" : "energy", directory);
  int number = 0;
  const auto group = [&](const nlohmann::json& atoms) -> std::string {
    if (atoms.is_string()) return "all";
    const std::string name = fmt::format("g{}", ++number);
    toml += fmt::format("[[group]]\nname = \"{}\"\nids = {}\n", name, ids_text(atoms));
    return name;
  };
  for (const auto& l : c.value("loads", nlohmann::json::array())) {
    const std::string on = group(l["atoms"]);
    if (l["kind"] == "force") toml += fmt::format("[[load]]\ngroup = \"{}\"\nforce = {}\n", on, vector_text(l["force"]));
    if (l["kind"] == "gravity") toml += fmt::format("[[gravity]]\ngroup = \"{}\"\nacceleration = {}\n", on, vector_text(l["acceleration"]));
    if (l["kind"] == "viscous") toml += fmt::format("[[viscosity]]\ngroup = \"{}\"\ncoefficient = {:.17g}\n", on, l["gamma"].get<double>());
  }
  if (c.contains("equilibrium")) toml += fmt::format("[[support]]\ngroup = \"{}\"\n", group(c["equilibrium"]["clamped"]));
  return toml;
}

Eigen::MatrixXd matrix(const nlohmann::json& rows, int first_column = 1) {
  Eigen::MatrixXd m(3, rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (int c = 0; c < 3; ++c) m(c, i) = rows[i][first_column + c];
  return m;
}

Eigen::MatrixXd forces_of(const std::string& file) {
  const auto rows = csv_rows(file);
  Eigen::MatrixXd m(3, rows.size() - 1);
  for (std::size_t i = 1; i < rows.size(); ++i)
    for (int c = 0; c < 3; ++c) m(c, i - 1) = std::stod(rows[i][1 + c]);
  return m;
}

}  // namespace

TEST_CASE("energies and forces are LAMMPS's", "[study][reference]") {
  for (const std::string name : {"angle_chain", "angle_sheet", "angle_triplets", "bond_chain", "bond_extreme", "bond_lattice", "bond_ring", "load_mixed_lj"}) {
    INFO(name);
    const std::string directory = std::string(ELAMIN_ROOT) + "/data/lammps/" + name;
    const auto c = reference("lammps/" + name + "/case.json"), expected = reference("lammps/" + name + "/expected.json");
    const ScratchDirectory scratch;
    const std::string file = scratch.file("case.toml", problem_text(directory, c));
    const Answer answer = elamin_says("energy '" + file + "' --json --forces '" + (scratch / "forces.csv") + "'");
    INFO(answer.text);
    REQUIRE(answer.status == 0);
    const auto energy = nlohmann::json::parse(answer.text)["energy"];
    const auto& known = expected["energy_lammps"];
    for (const char* term : {"bond", "angle"})
      if (known.contains(term)) CHECK(energy[term].get<double>() == Approx(known[term].get<double>()).epsilon(1e-12));
    if (known.contains("gravity")) {
      const double gravity = known["gravity"], force = known["force"];
      CHECK(energy["external"].get<double>() == Approx(gravity + force).epsilon(1e-12));
    }
    const Eigen::MatrixXd f = forces_of(scratch / "forces.csv"), reference_forces = matrix(expected["forces"]);
    REQUIRE(f.cols() == reference_forces.cols());
    CHECK((f - reference_forces).cwiseAbs().maxCoeff() <= 1e-12 * reference_forces.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("equilibria are those that LAMMPS approaches", "[study][reference]") {
  for (const std::string name : {"eq_column_above", "eq_column_below", "eq_plate"}) {
    INFO(name);
    const std::string directory = std::string(ELAMIN_ROOT) + "/data/lammps/" + name;
    const auto c = reference("lammps/" + name + "/case.json"), expected = reference("lammps/" + name + "/expected.json")["refined"];
    const ScratchDirectory scratch;
    const std::string file = scratch.file("case.toml", problem_text(directory, c));
    const Answer answer = elamin_says("'" + file + "' -o '" + (scratch / "out") + "' --quiet");
    INFO(answer.text);
    REQUIRE(answer.status == 0);
    const elamin::LammpsData state = elamin::read_lammps_data(scratch / "out/states/final.data", "");
    const Eigen::MatrixXd known = matrix(expected["positions"]);
    // What the reference's own residual leaves open: force over the softest stiffness.
    const double open = expected["largest_free_force"].get<double>() / expected["hessian_eigenvalue_min"].get<double>();
    const double extent = (known.rowwise().maxCoeff() - known.rowwise().minCoeff()).maxCoeff();
    CHECK((state.position - known).cwiseAbs().maxCoeff() <= open + 1e-13 * extent);
    const auto summary = nlohmann::json::parse(text_of(scratch / "out/summary.json"));
    // Single terms change in first order with the positions: by the loads' work over what is left open. The total is
    // stationary; it knows the rounding of the reference's positions, ulp(extent) times the force in every bond.
    const double deflection = (known - elamin::read_lammps_data(directory + "/case.data", "").position).cwiseAbs().maxCoeff();
    const double work = std::abs(expected["energy"]["force"].get<double>()) * open / std::max(deflection, open);
    double clamp_force = 0;
    for (const auto& r : expected["reactions"])
      for (int d = 0; d < 3; ++d) clamp_force = std::max(clamp_force, std::abs(r[1 + d].get<double>()));
    const double total_open = clamp_force * extent * 2.2e-16 * static_cast<double>(known.cols());
    const auto& terms = expected["energy"];
    CHECK(std::abs(summary["final"]["bond"].get<double>() - terms["bond"].get<double>()) <= 1e-8 * terms["bond"].get<double>() + work);
    CHECK(std::abs(summary["final"]["angle"].get<double>() - terms["angle"].get<double>()) <= 1e-8 * terms["angle"].get<double>() + work);
    CHECK(std::abs(summary["final"]["energy"].get<double>() - terms["total"].get<double>()) <= 1e-12 * std::abs(terms["total"].get<double>()) + total_open);
    CHECK(summary["final"]["negative"] == 0);
    CHECK(summary["final"]["stable"] == true);
    // Reactions: minus the forces on the clamped particles.
    const std::string at_rest = scratch.file("rest.toml", "[study]\ntype = \"energy\"\n" +
        problem_text("", c).substr(problem_text("", c).find("[lammps]")).replace(0, 8, "[lammps]"));
    std::string text = text_of(at_rest);
    text.replace(text.find("/case.data"), 10, scratch / "out/states/final.data");
    scratch.file("rest.toml", text);
    REQUIRE(elamin_says("energy '" + at_rest + "' --json --forces '" + (scratch / "forces.csv") + "'").status == 0);
    const Eigen::MatrixXd f = forces_of(scratch / "forces.csv");
    double largest = 0, off = 0;
    for (const auto& r : expected["reactions"])
      for (int d = 0; d < 3; ++d) {
        largest = std::max(largest, std::abs(r[1 + d].get<double>()));
        off = std::max(off, std::abs(f(d, r[0].get<int>() - 1) + r[1 + d].get<double>()));
      }
    // Positions in the file are rounded: stiffness times the last digit of the extent, beside the reference's residual.
    const double rounding = expected["hessian_eigenvalue_max"].get<double>() * (extent * 2.2e-16 + open * 1e-3);
    CHECK(off <= 1e-12 * largest + rounding + 10 * expected["largest_free_force"].get<double>());
  }
}
