#include "catch.hpp"
#include "lammps/data.hpp"
#include "scratch_directory.hpp"
#include "study/lammps_case.hpp"

#include <algorithm>
#include <tuple>

namespace {

const std::vector<std::string> statics{
    "angle_chain", "angle_sheet", "angle_triplets", "bond_chain", "bond_extreme", "bond_lattice", "bond_ring", "load_mixed_lj",
    "gran_bonded_included", "gran_mixed_types", "gran_packing_lj", "gran_packing_si", "gran_pairs", "gran_wound_chain",
    "overlay_chains", "overlay_cohesive_sheet", "wall_beam_corner", "wall_block_in", "wall_block_out", "wall_cone_in",
    "wall_cone_out", "wall_cylinder_in", "wall_cylinder_open", "wall_cylinder_out", "wall_planes", "wall_spheres"};

bool has_cone(const LammpsCase& c) {
  for (const auto& w : c.parameters.value("walls", nlohmann::json::array()))
    if (w["region"]["shape"] == "cone") return true;
  return false;
}

/// One closed contact: id of the first, id or wall of the second, its overlap and force.
using Contact = std::tuple<std::string, std::string, double, double>;

std::vector<Contact> known_contacts(const nlohmann::json& expected) {
  std::vector<Contact> all;
  for (const auto& t : expected.value("pair_contacts", nlohmann::json::array()))
    if (t["E_eff"] != 0) all.emplace_back(t["i"].dump(), t["j"].dump(), t["delta"], t["force"]);
  for (const auto& t : expected.value("wall_contacts", nlohmann::json::array()))
    all.emplace_back(t["atom"].dump(), t["wall"], t["delta"], t["force"]);
  std::sort(all.begin(), all.end());
  return all;
}

std::vector<Contact> written_contacts(const std::string& file) {
  std::vector<Contact> all;
  const auto rows = csv_rows(file);
  for (std::size_t i = 1; i < rows.size(); ++i) {
    CHECK(rows[i][0] == "final");
    all.emplace_back(rows[i][2], rows[i][3], -std::stod(rows[i][4]), std::stod(rows[i][5]));
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// The same pairs; overlaps within `length`, forces within 1e-12 of the largest and what that length makes of them.
void check_contacts(const std::vector<Contact>& written, const std::vector<Contact>& known, double length) {
  REQUIRE(written.size() == known.size());
  double largest = 0;
  for (const Contact& k : known) largest = std::max(largest, std::get<3>(k));
  for (std::size_t i = 0; i < known.size(); ++i) {
    const auto& [first, second, overlap, force] = known[i];
    INFO(first << " at " << second);
    CHECK(std::get<0>(written[i]) == first);
    CHECK(std::get<1>(written[i]) == second);
    CHECK(std::abs(std::get<2>(written[i]) - overlap) <= length);
    CHECK(std::abs(std::get<3>(written[i]) - force) <= 1e-12 * largest + 1.5 * force / overlap * length);
  }
}

double extent_of(const Eigen::MatrixXd& x) { return (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff(); }

}  // namespace

TEST_CASE("energies and forces are LAMMPS's", "[study][reference]") {
  for (const std::string& name : statics) {
    INFO(name);
    const LammpsCase c(name);
    const ScratchDirectory scratch;
    const std::string file = scratch.file("case.toml", c.problem("energy"));
    const Answer answer = elamin_says("energy '" + file + "' --json --forces '" + (scratch / "forces.csv") + "'");
    INFO(answer.text);
    REQUIRE(answer.status == 0);
    const auto energy = nlohmann::json::parse(answer.text)["energy"];
    const auto& known = c.expected["energy_lammps"];
    const auto computed = c.expected.value("energy_computed", nlohmann::json::object());
    const auto same = [&](const char* term, double value) { CHECK(energy[term].get<double>() == Approx(value).epsilon(1e-12)); };
    for (const char* term : {"bond", "angle"})
      if (known.contains(term)) same(term, known[term]);
    if (known.contains("lj")) same("cohesion", known["lj"]);
    if (known.contains("gravity")) same("external", known["gravity"].get<double>() + known.value("force", 0.0));
    same("contact", computed.value("granular", 0.0));
    same("wall", computed.value("wall", 0.0));
    const Eigen::MatrixXd f = forces_of(scratch / "forces.csv"), reference_forces = matrix(c.expected["forces"]);
    REQUIRE(f.cols() == reference_forces.cols());
    // At a cone LAMMPS takes the effective radius as fixed; what that leaves out is below 1e-3 there.
    const double tolerance = has_cone(c) ? 1e-3 : 1e-12;
    CHECK((f - reference_forces).cwiseAbs().maxCoeff() <= tolerance * reference_forces.cwiseAbs().maxCoeff());
  }
}

TEST_CASE("closed contacts are LAMMPS's", "[study][reference]") {
  for (const std::string& name : statics) {
    INFO(name);
    const LammpsCase c(name);
    const ScratchDirectory scratch;
    const std::string file = scratch.file("case.toml", c.problem("energy"));
    const Answer answer = elamin_says("'" + file + "' -o '" + (scratch / "out") + "' --quiet");
    INFO(answer.text);
    REQUIRE(answer.status == 0);
    const Eigen::MatrixXd x = elamin::read_lammps_data(c.directory + "/case.data", "").position;
    auto written = written_contacts(scratch / "out/contacts.csv"), known = known_contacts(c.expected);
    if (has_cone(c))                                         // the force is another one, see above
      for (auto* all : {&written, &known})
        for (Contact& t : *all) std::get<3>(t) = 0;
    check_contacts(written, known, 8 * 2.2e-16 * std::max(extent_of(x), x.cwiseAbs().maxCoeff()));
  }
}

TEST_CASE("equilibria are those that LAMMPS approaches", "[study][reference]") {
  for (const std::string name : {"eq_column_above", "eq_column_below", "eq_plate", "eq_beams_crossed", "eq_beams_groove", "eq_cantilever_floor"}) {
    INFO(name);
    const LammpsCase c(name);
    const auto& expected = c.expected["refined"];
    const ScratchDirectory scratch;
    const std::string file = scratch.file("case.toml", c.problem("equilibrium"));
    const Answer answer = elamin_says("'" + file + "' -o '" + (scratch / "out") + "' --quiet");
    INFO(answer.text);
    REQUIRE(answer.status == 0);
    const elamin::LammpsData state = elamin::read_lammps_data(scratch / "out/states/final.data", "");
    const Eigen::MatrixXd known = matrix(expected["positions"]);
    // What the reference's own residual leaves open: force over the softest stiffness.
    const double open = expected["largest_free_force"].get<double>() / expected["hessian_eigenvalue_min"].get<double>();
    const double extent = extent_of(known);
    CHECK((state.position - known).cwiseAbs().maxCoeff() <= open + 1e-13 * extent);
    const auto summary = nlohmann::json::parse(text_of(scratch / "out/summary.json"));
    const auto& final = summary["final"];
    // Single terms change in first order with the positions: by the work of the loads (or of the clamps that were moved
    // together) over what is left open. The total is stationary; it knows the rounding of the reference's positions,
    // ulp(extent) times the force in every bond.
    const auto& terms = expected["energy"];
    const double deflection = (known - elamin::read_lammps_data(c.directory + "/case.data", "").position).cwiseAbs().maxCoeff();
    const double loads = std::abs(terms.value("force", 0.0)) + std::abs(terms.value("gravity", 0.0));
    const double work = (loads > 0 ? loads : std::abs(terms["total"].get<double>())) * open / std::max(deflection, open);
    double clamp_force = 0;
    for (const auto& r : expected["reactions"])
      for (int d = 0; d < 3; ++d) clamp_force = std::max(clamp_force, std::abs(r[1 + d].get<double>()));
    const double total_open = clamp_force * extent * 2.2e-16 * static_cast<double>(known.cols());
    for (const auto& [ours, theirs] : {std::pair("bond", "bond"), std::pair("angle", "angle"), std::pair("contact", "granular"), std::pair("wall", "wall")}) {
      INFO(ours);
      const double value = terms.value(theirs, 0.0);
      CHECK(std::abs(final[ours].get<double>() - value) <= 1e-8 * value + work);
    }
    CHECK(std::abs(final["energy"].get<double>() - terms["total"].get<double>()) <= 1e-12 * std::abs(terms["total"].get<double>()) + total_open);
    CHECK(final["negative"] == 0);
    CHECK(final["stable"] == true);
    check_contacts(written_contacts(scratch / "out/contacts.csv"), known_contacts(expected), open + 1e-13 * extent);
    // Reactions: minus the forces on the clamped particles.
    const std::string at_rest = scratch.file("rest.toml", c.problem("energy", scratch / "out/states/final.data"));
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
