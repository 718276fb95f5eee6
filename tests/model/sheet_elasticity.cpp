#include "catch.hpp"
#include "reference.hpp"
#include "sheets.hpp"

using namespace elamin;

namespace {

/// Energy of the bonds at x over the area that they take, about each particle with six bonds: the smallest and the
/// largest.
std::array<double, 2> energy_density(const Model& m, const State& x) {
  std::vector<double> share(m.particles());   // half of each bond to each of its ends
  for (const Bond& b : m.bonds) {
    const BondType& type = m.bond_types[b.type];
    const Exact stretch = distance(x.at(b.particles[0]), x.at(b.particles[1])) - exact(type.rest_length);
    for (const int p : b.particles) share[p] += type.stiffness * stretch.value() * stretch.value() / 2;
  }
  const std::vector<int> bonds = bonds_of_each(m);
  const double a = m.bond_types[0].rest_length;
  std::array<double, 2> range{std::numeric_limits<double>::infinity(), 0};
  for (int p = 0; p < m.particles(); ++p)
    if (bonds[p] == 6) range = {std::min(range[0], share[p]), std::max(range[1], share[p])};
  return {range[0] / (a * a * std::sqrt(3) / 2), range[1] / (a * a * std::sqrt(3) / 2)};
}

/// Where x ↦ F x takes the particles in the plane z = 0.
State mapped(const Model& m, const Eigen::Matrix2d& F) {
  State x = m.start;
  for (int p = 0; p < m.particles(); ++p) {
    ExactVector moved = x.at(p);
    for (int c = 0; c < 2; ++c) moved.set(c, exact(F(c, 0)) * m.start.at(p)[0] + exact(F(c, 1)) * m.start.at(p)[1]);
    x.set(p, moved);
  }
  return x;
}

}  // namespace

TEST_CASE("A stretched sheet has the energy of the homogeneous lattice", "[model]") {
  const nlohmann::json data = reference("exact/plate_homogeneous.json");
  const double K = data["K"];
  for (const nlohmann::json& r : data["results"]) {
    const double strain = r["strain"], c11 = (1 + strain) * (1 + strain), c12 = r["C12"], c22 = r["C22"];
    Sheet s = rectangle(0.02, 0.015, 1e-3, -r["direction_deg_from_a_bond"].get<double>() * degree);
    s.bond_stiffness = K;
    const Model m = built(s);
    Eigen::Matrix2d F;   // FᵀF = C, F upper triangular
    F << std::sqrt(c11), c12 / std::sqrt(c11), 0, std::sqrt(c22 - c12 * c12 / c11);
    const double expected = r["energy_per_reference_area"],
                 accuracy = 16 * epsilon / std::abs(strain);   // F is given to ε
    for (const double density : energy_density(m, mapped(m, F))) CHECK(std::abs(density / expected - 1) < accuracy);
  }
}

TEST_CASE("Small strains cost what they cost an isotropic plate, in whatever direction the lattice lies", "[model]") {
  const double scale = GENERATE(1e-3, 1e3), angle = GENERATE(0.0, 7.0, 30.0, 52.0) * degree, small = 1e-7;
  for (const auto& [xx, yy, xy] :
       {std::array{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}, {1.0, -0.3, 0.4}, {1.0, 1.0, 0.0}}) {
    const Sheet s = rectangle(20 * scale, 15 * scale, scale, angle);
    const Model m = built(s);
    Eigen::Matrix2d strain;
    strain << xx, xy, xy, yy;
    strain *= small;
    // W = λ/2 (tr ε)² + μ ε:ε with λ = μ = √3 K/2: Y = 4K/√3, ν = 1/3.
    const double mu = std::sqrt(3) / 2 * s.bond_stiffness;
    const double expected = mu / 2 * std::pow(strain.trace(), 2) + mu * strain.squaredNorm();
    for (const double density : energy_density(m, mapped(m, Eigen::Matrix2d::Identity() + strain)))
      CHECK(std::abs(density / expected - 1) < 8 * small);
  }
}
