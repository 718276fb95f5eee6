#include "catch.hpp"
#include "energy/energy.hpp"
#include "model/sheets.hpp"
#include "reference.hpp"
#include "solve/newton.hpp"

#include <random>

using namespace elamin;

namespace {

// A patch of the lattice within a circle has as many bonds, and as many angles, along each of the three directions: over
// cells() × (area of a cell) a homogeneous state has the energy of one cell.
Sheet patch(double radius, double spacing, double K, double B, double direction_deg) {
  Sheet s = circle(radius, spacing, -direction_deg * degree);
  s.bond_stiffness = K, s.angle_stiffness = B;
  return s;
}
double area(const Sheet& s, std::size_t elements) {
  return static_cast<double>(elements) / 3 * s.spacing * s.spacing * std::sqrt(3) / 2;
}

}  // namespace

// The rim is put where the reference's right Cauchy-Green tensor has it; the inside, off its place, must find it. The
// stress P = Σ f ⊗ X / area of the forces f that hold the rim is uniaxial, for C22 and C12 are where the energy is least.
TEST_CASE("A stretched patch relaxes to the homogeneous state and pulls along one direction", "[energy][reference]") {
  const nlohmann::json data = reference("exact/plate_homogeneous.json");
  const double K = data["K"], t = data["t"];
  for (const nlohmann::json& r : data["results"]) {
    const double strain = r["strain"], c12 = r["C12"], c22 = r["C22"], direction = r["direction_deg_from_a_bond"];
    INFO(direction << "° strain " << strain);
    const Sheet s = patch(5 * t, t, K, K * t * t / 6, direction);
    Model m = built(s);
    m.plane_normal = 2;
    // F upper triangular, FᵀF = C.
    Eigen::Matrix2d F;
    F << 1 + strain, c12 / (1 + strain), 0, std::sqrt(c22 - c12 * c12 / ((1 + strain) * (1 + strain)));
    const std::vector<int> bonds = bonds_of_each(m);
    std::vector<int> rim, inner;
    const auto moved = [&](int p) {
      const Eigen::Vector2d u = (F - Eigen::Matrix2d::Identity()) * m.start.position.col(p).head<2>();
      return Vec3(u[0], u[1], 0);
    };
    for (int p = 0; p < m.particles(); ++p) (bonds[p] < 6 ? rim : inner).push_back(p);
    for (const int p : rim) m.supports.push_back({"", {p}, {true, true, true}, moved(p), Scaling()});
    Energy energy(m);
    Newton newton(energy);
    State state = m.start;
    energy.kinematics().prescribe(state, 1);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> in(-0.05 * t, 0.05 * t);
    for (const int p : inner) state.position(0, p) += in(random), state.position(1, p) += in(random);
    const Report report = newton.minimise(state);
    REQUIRE(report.converged());
    // F is known to ε, its strain to ε/strain, the energy to twice that; a few roundings more at the rim.
    const double accuracy = 1e-13 + 16 * epsilon / std::abs(strain);
    for (const int p : inner)
      CHECK((state.position.col(p) - m.start.position.col(p) - moved(p)).norm() <=
            1e-12 * std::abs(strain) * t + 32 * epsilon * t);
    const EnergyTerms terms = energy.terms(state);
    CHECK(terms.bond / area(s, m.bonds.size()) ==
          Approx(static_cast<double>(r["energy_per_reference_area"])).epsilon(accuracy));
    CHECK(terms.angle <= 1e-12 * terms.bond);  // straight triples stay straight
    Eigen::Matrix2d P = Eigen::Matrix2d::Zero();
    const Field forces = energy.forces(state);
    for (const int p : rim) P -= forces.col(p).head<2>() * m.start.position.col(p).head<2>().transpose();
    P /= area(s, m.bonds.size());
    const double expected = r["force_per_reference_width"];
    // P = F S with S along e1 alone; its first column is along F e1 = e1.
    Eigen::Matrix2d uniaxial = Eigen::Matrix2d::Zero();
    uniaxial(0, 0) = expected;
    CHECK((P - uniaxial).cwiseAbs().maxCoeff() <= accuracy * std::abs(expected));
  }
}

TEST_CASE("A lattice rolled to a cylinder", "[energy][reference]") {
  const nlohmann::json data = reference("exact/plate_bending.json");
  const double a = data["spacing"];
  for (const nlohmann::json& r : data["cylinder"]) {
    const double ratio = r["a_over_R"];
    INFO(r["direction_deg"] << "° a/R " << ratio);
    const Sheet s = patch(3 * a, a, data["K"], data["B"], r["direction_deg"]);
    const Model m = built(s);
    Energy energy(m);
    State state = m.start;
    const Exact R = exact(a) / exact(ratio);
    for (int p = 0; p < m.particles(); ++p) {
      ExactVector x = m.start.at(p);
      const Exact half_turns = x[0] / (R * exact_pi), quarter = {half_turns.hi / 4, half_turns.lo / 4};
      const CosineSine half = cosine_sine(quarter);  // of x/2R
      x.set(0, Exact{2, 0} * R * half.sine * half.cosine);
      x.set(2, Exact{2, 0} * R * half.sine * half.sine);  // R (1 − cos(x/R))
      state.set(p, x);
    }
    const EnergyTerms terms = energy.terms(state);
    // The places are exact; an angle term is formed to some ε, the shortening of a chord, (a/R)²/24, to ε of the bond.
    CHECK(terms.angle / area(s, m.angles.size()) ==
          Approx(static_cast<double>(r["bending_energy_per_area"])).epsilon(1e-13));
    CHECK(terms.bond / area(s, m.bonds.size()) ==
          Approx(static_cast<double>(r["stretch_energy_per_area"])).epsilon(1e-13));
    CHECK(terms.angle / area(s, m.angles.size()) ==
          Approx(static_cast<double>(r["ratio"]) * static_cast<double>(data["Btilde"]) * ratio * ratio / (2 * a * a))
              .epsilon(1e-13));
  }
}

TEST_CASE("A lattice on a saddle, a bowl and a trough", "[energy][reference]") {
  const nlohmann::json data = reference("exact/plate_bending.json");
  const double a = data["spacing"];
  for (const nlohmann::json& r : data["graph"]) {
    INFO(r["k1"] << ", " << r["k2"] << ", " << r["direction_deg"] << "°");
    const Sheet s = patch(a, a, data["K"], data["B"], r["direction_deg"]);
    const Model m = built(s);
    REQUIRE(m.angles.size() == 3);  // those at the origin
    Energy energy(m);
    State state = m.start;
    for (int p = 0; p < m.particles(); ++p) {
      ExactVector x = m.start.at(p);
      const Exact k1 = exact(static_cast<double>(r["k1"]) / 2), k2 = exact(static_cast<double>(r["k2"]) / 2);
      x.set(2, k1 * x[0] * x[0] + k2 * x[1] * x[1]);
      state.set(p, x);
    }
    CHECK(energy.terms(state).angle / area(s, 3) ==
          Approx(static_cast<double>(r["bending_energy_per_area_at_origin"])).epsilon(1e-13));
  }
}
