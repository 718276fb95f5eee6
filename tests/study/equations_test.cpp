// Where the derivation's equations hold to leading order only: with which order and which coefficient the particles
// approach the continuum. The equations themselves are the files problems/static/equation_*.toml.
#include "catch.hpp"
#include "energy/energy.hpp"
#include "laws/section.hpp"
#include "model/loop.hpp"
#include "model/sheet.hpp"
#include "scratch_directory.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>

using namespace elamin;

namespace {

double angle_energy(const Model& model) {
  Energy energy(model);
  return energy.terms(model.start).angle;
}

struct EnergyError {
  double x;         // spacing over radius
  double error;     // energy over that of the continuum, minus 1
};

/// log(e₁/e₂)/log(x₁/x₂).
double order(const EnergyError& coarse, const EnergyError& fine) {
  return std::log(coarse.error / fine.error) / std::log(coarse.x / fine.x);
}

/// N particles on a circle of radius R against a beam of length 2πR: U = π EI/R.
EnergyError bent_chain(int particles, Section section) {
  const double R = 3, E = 2, t = 0.7, q0 = chord(R, particles);
  Model model;
  Ring ring;
  ring.name = "ring", ring.particles = particles, ring.radius = R, ring.diameter = t;
  ring.bond = {bond_stiffness(section, E, t, q0), q0};
  ring.angle = {angle_stiffness(section, E, t, q0)};
  add_loops(model, {ring});
  const double I = section == Section::cylinder ? pi * t * t * t * t / 64 : t * t * t * t / 12;
  return {q0 / R, angle_energy(model) / (pi * E * I / R) - 1};
}

/// A tube whose rows run at an angle to the circumference.
Sheet tube(double radius, double height, double degrees) {
  Sheet s;
  s.name = "tube", s.shape = Sheet::Shape::cylinder;
  s.radius = radius, s.height = height, s.lattice_angle = degrees * pi / 180;
  s.spacing = s.diameter = 1, s.bond_stiffness = 1, s.angle_stiffness = 1;
  return s;
}

/// Energy of a particle of the tube against D/(2R²) on its area a²√3/2, D = (3√3/4) B. Of two heights the rims are the same:
/// what the higher one has more is the inside of the plate.
EnergyError bent_plate(double radius, double degrees) {
  std::array<double, 2> U{}, particles{};
  for (int k = 0; k < 2; ++k) {
    Model model;
    const Sheet sheet = tube(radius, 6 + 6 * k, degrees);
    add_sheets(model, {sheet});
    U[k] = angle_energy(model), particles[k] = model.particles();
  }
  const double a = rolled(tube(radius, 6, degrees)).spacing, D = 3 * std::sqrt(3) / 4;
  const double continuum = D / (2 * radius * radius) * std::sqrt(3) / 2 * a * a;
  return {a / radius, (U[1] - U[0]) / (particles[1] - particles[0]) / continuum - 1};
}

/// A particle and its six neighbours, 12 bonds: the energy of four cells a²√3/2 of an endless plate under the same strain.
class Patch {
 public:
  explicit Patch(double degrees) {
    Sheet s;
    s.name = "patch", s.shape = Sheet::Shape::circle;
    s.radius = s.spacing = s.diameter = 1, s.lattice_angle = degrees * pi / 180;
    s.bond_stiffness = std::sqrt(3) / 4, s.angle_stiffness = 1;          // E t = 1
    add_sheets(model_, {s});
    energy_ = std::make_unique<Energy>(model_);
  }

  /// Nominal stress P = ∂W/∂F = −Σ f Xᵀ/area of the map x = F X, over E.
  Eigen::Matrix2d stress(const Eigen::Matrix2d& F) {
    State state = model_.start;
    for (int i = 0; i < model_.particles(); ++i) {
      const Vec3 X = model_.start.position.col(i);
      const Eigen::Vector2d x = F * X.head<2>();
      state.set(i, {Vec3(x[0], x[1], 0), Vec3::Zero()});
    }
    const Field f = energy_->forces(state);
    const Eigen::Matrix2d sum = f.topRows<2>() * model_.start.position.topRows<2>().transpose();
    return -sum / (4 * std::sqrt(3) / 2);
  }

  struct Tension { double secant, transverse; };        // stress over strain; √C₂₂, the stretch across
  /// Uniaxial stress along x: F = [[1 + ε, g], [0, h]] with P₁₂ = P₂₂ = 0.
  Tension stretch(double strain) {
    Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
    F(0, 0) += strain;
    const double difference = 1e-6;
    for (int k = 0; k < 20; ++k) {
      const Eigen::Vector2d P = stress(F).col(1);
      Eigen::Matrix2d J;
      for (int c = 0; c < 2; ++c) {
        Eigen::Matrix2d moved = F;
        moved(c, 1) += difference;
        J.col(c) = (stress(moved).col(1) - P) / difference;
      }
      F.col(1) -= J.inverse() * P;
    }
    const Eigen::Matrix2d P = stress(F);
    REQUIRE(P.col(1).norm() <= 1e-15);
    return {P(0, 0) / strain, F.col(1).norm()};
  }

 private:
  Model model_;
  std::unique_ptr<Energy> energy_;
};

}  // namespace

TEST_CASE("equations (10), (12), (14): a bent chain approaches the beam as 1 − x²/24 − 17x⁴/5760", "[equations]") {
  const Section section = GENERATE(Section::cylinder, Section::square);
  for (const int n : {16, 64}) {
    const EnergyError coarse = bent_chain(n, section), middle = bent_chain(2 * n, section), fine = bent_chain(4 * n, section);
    CHECK(order(coarse, middle) == Approx(2).epsilon(0.01));
    CHECK(order(middle, fine) == Approx(2).epsilon(0.0025));
    for (const EnergyError& a : {coarse, middle, fine}) {
      const double x2 = a.x * a.x;                                      // next: 367/967680 x⁶ of asin
      CHECK(std::abs(a.error + x2 / 24 + 17 * x2 * x2 / 5760) <= 4e-4 * x2 * x2 * x2 + 1e-14);
    }
  }
}

TEST_CASE("equations (26), (27): a plate rolled in any direction approaches D/(2R²) as 1 − (5/64)(a/R)²", "[equations]") {
  const double degrees = GENERATE(0.0, 4.0, 11.0, 15.0, 19.107, 26.0, 30.0, 41.0, 90.0);
  INFO("rows at " << degrees << " degrees");
  const EnergyError coarse = bent_plate(6, degrees), middle = bent_plate(12, degrees), fine = bent_plate(24, degrees);
  CHECK(order(coarse, middle) == Approx(2).epsilon(0.002));
  CHECK(order(middle, fine) == Approx(2).epsilon(0.0005));
  // The direction matters at the fourth order only, and little: its coefficient is between 0.0022 and 0.0025.
  for (const EnergyError& a : {coarse, middle, fine}) {
    const double x2 = a.x * a.x;
    CHECK(std::abs(a.error + 5 * x2 / 64 - 0.00236 * x2 * x2) <= 0.0002 * x2 * x2 + 1e-12);
  }
}

TEST_CASE("equation (21): a plate has the same modulus in every direction, and Poisson's ratio 1/3", "[equations]") {
  const double degrees = GENERATE(0.0, 5.0, 10.0, 15.0, 22.5, 30.0, 37.5, 45.0, 60.0, 90.0);
  INFO("tension at " << degrees << " degrees to the rows");
  Patch patch(degrees);
  // Rounding: forces of size K ε ± 1e-16.
  const double small = 1e-6;
  for (const double strain : {small, -small}) {
    const auto [secant, transverse] = patch.stretch(strain);
    CHECK(std::abs(secant - 1) <= 0.7 * small + 1e-9);
    CHECK(std::abs((1 - transverse) / strain - 1. / 3) <= 0.25 * small + 1e-9);
  }
  // At finite strain: E (1 + (1 − cos 6β) ε/3 + O(ε²)), linear along a row.
  const double slope = (1 - std::cos(6 * degrees * pi / 180)) / 3;
  for (const double strain : {0.02, 0.01, 0.005, -0.005, -0.01}) {
    const double off = patch.stretch(strain).secant - 1;
    if (slope < 1e-12) CHECK(std::abs(off) <= 1e-12);
    CHECK(std::abs(off - slope * strain) <= 0.7 * strain * strain + 1e-12);
  }
}

TEST_CASE("every equation has its problem file, and every problem file its row in the table", "[equations]") {
  const std::filesystem::path folder = ELAMIN_ROOT "/problems/static";
  const std::string table = text_of((folder / "README.md").string());
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    const std::string name = entry.path().filename().string();
    INFO(name);
    files.insert(name);
    CHECK(table.find("`" + name + "`") != std::string::npos);
    CHECK(text_of(entry.path().string()).find("[[expect]]") != std::string::npos);
  }
  for (int k = 1; k <= 27; ++k) CHECK(files.count("equation_" + std::to_string(k / 10) + std::to_string(k % 10) + ".toml") == 1);
}
