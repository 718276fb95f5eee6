// The plain forces of dynamics against those of the energy, for every kind of term.
#include "catch.hpp"
#include "chain.hpp"
#include "dynamics/verlet.hpp"
#include "energy/energy.hpp"
#include "plate.hpp"

#include <random>

using namespace elamin;

namespace {

void shake(Model& m, double size, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0, size);
  for (Eigen::Index p = 0; p < m.start.particles(); ++p)
    for (int c = 0; c < 3; ++c)
      if (m.plane_normal != c) m.start.position(c, p) += normal(random);
  m.start.low.setZero();
}

// Rounding of positions of this size moves a force by ε times it times the stiffness.
void same_forces(const Model& m, double stiffness) {
  Energy energy(m);
  State state = m.start;
  const Motion motion = Verlet(m, begin_motion(m), 1e-6).motion();
  const Field expected = energy.forces(state), difference = motion.force - expected;
  REQUIRE(expected.cwiseAbs().maxCoeff() > 0);
  const double tolerance = 1e-13 * expected.cwiseAbs().maxCoeff() + 16 * epsilon * stiffness * state.position.cwiseAbs().maxCoeff();
  CHECK(difference.cwiseAbs().maxCoeff() <= tolerance);
}

Model grains(int n, double spacing, double smallest, unsigned seed) {
  Model m;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(smallest, 1);
  m.start = State(Field(3, n * n * n));
  for (int p = 0; p < n * n * n; ++p) {
    m.start.position.col(p) = spacing * Vec3(p % n, p / n % n, p / n / n);
    m.diameter.push_back(uniform(random)), m.density.push_back(1), m.id.push_back(p + 1), m.type.push_back(1), m.molecule.push_back(p + 1);
  }
  shake(m, 0.05, seed);
  return m;
}

std::vector<int> everything(const Model& m) {
  std::vector<int> all(m.particles());
  for (int p = 0; p < m.particles(); ++p) all[p] = p;
  return all;
}

void touch(Model& m, double modulus) {
  PairContact c;
  c.between = {"all", "all"}, c.particles = {everything(m), everything(m)}, c.effective_modulus = modulus;
  m.contacts.push_back(c);
}

}  // namespace

TEST_CASE("plain forces of chains of any length", "[dynamics]") {
  for (int n = 2; n < 12; ++n) {
    Model m = chain(n, 100, 10, 1, {1, 2, 3});
    shake(m, 0.1, n);
    same_forces(m, 200);
  }
}

TEST_CASE("plain forces of chains out of order, and of a closed one", "[dynamics]") {
  Model m = chain(41, 100, 10, 1);
  std::mt19937 random(7);
  std::vector<int> order = everything(m);
  std::shuffle(order.begin(), order.end(), random);
  for (Bond& b : m.bonds)
    for (int& p : b.particles) p = order[p];
  for (Angle& a : m.angles)
    for (int& p : a.particles) p = order[p];
  const Field x = m.start.position;
  for (int p = 0; p < m.particles(); ++p) m.start.position.col(order[p]) = x.col(p);
  shake(m, 0.1);
  same_forces(m, 200);

  Model ring = chain(17, 100, 10, 1);
  for (int p = 0; p < 17; ++p) ring.start.position.col(p) = 3 * Vec3(std::cos(p * 2 * pi / 17), std::sin(p * 2 * pi / 17), 0);
  ring.bonds.push_back({0, {16, 0}}), ring.angles.push_back({0, {15, 16, 0}}), ring.angles.push_back({0, {16, 0, 1}});
  shake(ring, 0.1);
  same_forces(ring, 200);
}

TEST_CASE("plain forces of a sheet with several types", "[dynamics]") {
  Model m = plate(9, 7, true, 1, 100, 10).model;
  m.bond_types.push_back({50, 1.1}), m.angle_types.push_back({3});
  for (std::size_t k = 0; k < m.bonds.size(); k += 3) m.bonds[k].type = 1;
  for (std::size_t k = 0; k < m.angles.size(); k += 4) m.angles[k].type = 1;
  shake(m, 0.1);
  same_forces(m, 200);
}

TEST_CASE("plain forces of what shares edges: two bonds between two particles, branches, rest angles", "[dynamics]") {
  Model m = chain(12, 100, 10, 1);
  m.angle_types.push_back({5, 2.0});
  m.bonds.push_back({0, {3, 4}});
  m.angles.push_back({0, {2, 3, 7}}), m.angles.push_back({0, {0, 3, 4}}), m.angles.push_back({1, {5, 6, 7}}), m.angles.push_back({1, {8, 1, 3}});
  shake(m, 0.1);
  same_forces(m, 400);
}

TEST_CASE("plain forces of growth and of pressure", "[dynamics]") {
  Model m = chain(9, 100, 10, 1, Vec3::UnitX());
  for (int p = 0; p < 9; ++p) m.start.position.col(p) = 1.5 * Vec3(std::cos(p * 2 * pi / 9), std::sin(p * 2 * pi / 9), 0);
  m.bonds.push_back({0, {8, 0}});
  m.plane_normal = 2;
  m.changes.push_back({"", {0, 1, 2, 3, 4}, 0.2, -0.3, 0.5, {}});
  m.pressures.push_back({"loop", everything(m), Vec3::UnitZ(), 4, {}});
  m.start.load_factor = 0.7;
  shake(m, 0.05);
  same_forces(m, 200);
}

TEST_CASE("plain forces of contacts of alike and of very different sizes, and of cohesion", "[dynamics]") {
  for (const double smallest : {0.8, 0.1}) {
    Model m = grains(6, 0.8, smallest, 3);
    touch(m, 1000);
    same_forces(m, 3000);
    PairContact lj;
    lj.between = {"all", "all"}, lj.particles = {everything(m), everything(m)}, lj.law = PairContact::Law::lj;
    lj.epsilon = 2, lj.sigma = 0.7, lj.cutoff = 1.6;
    m.contacts.push_back(lj);
    same_forces(m, 1e5);
    m.contacts.back().cutoff_style = CutoffStyle::smooth, m.contacts.back().inner_cutoff = 1.1;
    same_forces(m, 1e5);
  }
}

TEST_CASE("plain forces of walls of every shape, inside and outside", "[dynamics]") {
  const Vec3 middle = Vec3::Constant(2);
  for (const Shape shape : {Shape::plane, Shape::block, Shape::sphere, Shape::cylinder, Shape::cone})
    for (const bool inside : {true, false})
      for (const bool curved : {false, true})
        for (const bool endless : {false, true}) {
          INFO(static_cast<int>(shape) << inside << curved << endless);
          Model m = grains(6, 0.8, 0.8, 5);
          Wall w;
          w.name = "wall", w.inside = inside, w.curved = curved, w.particles = everything(m), w.effective_modulus = 700;
          w.region.shape = shape, w.region.center = middle, w.region.normal = Vec3(1, -2, 2) / 3;
          w.region.lo = Vec3::Constant(0.2), w.region.hi = Vec3(3.5, 3.6, 3.4), w.region.axis = 1;
          w.region.radius = 1.9, w.region.radius_lo = 1.2, w.region.radius_hi = 2.1;
          if (!endless) w.region.axial_lo = 0.1, w.region.axial_hi = 3.7;
          w.displacement = Vec3(0.01, 0.02, 0.03), w.radius_change = -0.05;
          m.start.load_factor = 0.5;
          m.walls.push_back(w);
          same_forces(m, 3000);
        }
}

TEST_CASE("loads and weights act as they do at the load factor", "[dynamics]") {
  Model m = chain(7, 100, 10, 1);
  m.start.load_factor = 0.3;
  m.loads.push_back({"", {1, 2}, {1, 2, 3}, {}});
  m.loads.push_back({"", {4}, {-1, 0, 2}, Scaling::constant()});
  m.gravity.push_back({"", everything(m), {0, 1, -9}, {}});
  same_forces(m, 200);
}
