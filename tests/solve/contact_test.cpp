#include "catch.hpp"
#include "chain.hpp"
#include "model/grains.hpp"
#include "path/equilibrium.hpp"

#include <numeric>
#include <random>

using namespace elamin;

namespace {

void meet(Model& m, double modulus) {
  PairContact c;
  c.particles = {numbers(m.particles()), numbers(m.particles())}, c.effective_modulus = modulus;
  m.contacts.push_back(c);
}

void floor(Model& m, double modulus, const Vec3& normal = Vec3::UnitZ()) {
  Wall w;
  w.particles = numbers(m.particles()), w.region.normal = normal.normalized(), w.effective_modulus = modulus;
  m.walls.push_back(w);
}

// The last iterations of a run square the residual, until rounding.
void check_quadratic(const Report& report) {
  std::vector<double> r;
  for (const Iteration& i : report.history)
    if (i.residual > 1e-13) r.push_back(i.residual);
  REQUIRE(r.size() >= 2);
  const double last = r[r.size() - 1], before = r[r.size() - 2];
  UNSCOPED_INFO("residuals " << before << ", " << last << ", " << report.residual);
  CHECK(report.residual <= 1e3 * last * last + 64 * epsilon);
  CHECK((last <= 1e3 * before * before || last > 1e-3));
}

}  // namespace

TEST_CASE("a column of grains settles from far above, in any units", "[solve][contact]") {
  for (const double unit : {1e-3, 1.0, 1e3})
    for (const double modulus : {1.0, 1e11}) {
      Model m;
      Field x(3, 4);
      x << 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 3, 6, 20;
      add_grains(m, {{"grains", x * unit, std::vector<double>(4, unit), 1e-4 * modulus / unit}});
      meet(m, modulus), floor(m, modulus), weigh(m, 1);
      m.supports.push_back({"", numbers(4), {true, true, false}, Vec3::Zero(), Scaling()});
      Energy energy(m);
      Newton newton(energy);
      State state = m.start;
      const Report report = newton.minimise(state);
      INFO(report.why);
      REQUIRE(report.converged());
      check_quadratic(report);
      // Every contact carries the weight above it: 4/3 E √R δ^{3/2} = n m g, R = d/2 at the floor, d/4 between grains.
      const double weight = m.mass(0);
      double z = 0;
      for (int i = 0; i < 4; ++i) {
        const double radius = i == 0 ? unit / 2 : unit / 4;
        const double overlap = std::pow((4 - i) * weight / (4.0 / 3 * modulus * std::sqrt(radius)), 2.0 / 3);
        z += (i == 0 ? unit / 2 : unit) - overlap;
        CHECK(state.position(2, i) == Approx(z).epsilon(1e-13));
      }
    }
}

TEST_CASE("grains thrown together settle, whatever their overlaps", "[solve][contact]") {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const int n = 60;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> in(-1.7, 1.7);
    Field x(3, n);
    for (Eigen::Index k = 0; k < x.size(); ++k) x.data()[k] = in(random);
    Model m;
    add_grains(m, {{"grains", x, std::vector<double>(n, 1.0), 1000.0}});
    meet(m, 1e6), weigh(m, 9.81);
    Wall box;
    box.particles = numbers(n), box.effective_modulus = 1e6, box.region.shape = Shape::block;
    box.region.lo = Vec3::Constant(-2.2), box.region.hi = Vec3::Constant(2.2);
    m.walls.push_back(box);
    Energy energy(m);
    Newton newton(energy);
    State state = m.start;
    const Report report = newton.minimise(state);
    INFO(report.why << ", " << report.iterations << " iterations");
    REQUIRE(report.converged());
    check_quadratic(report);
    CHECK(report.negative == 0);
    CHECK((state.position.array().abs() < 2.2).all());
    Vec3 weight = Vec3::Zero(), carried = Vec3::Zero();
    for (int i = 0; i < n; ++i) weight += m.mass(i) * Vec3(0, 0, -9.81);
    for (const Touch& t : energy.touches(state))
      if (t.wall >= 0) carried += t.force;
    CHECK((weight + carried).norm() <= 1e-9 * energy.force_scale());
  }
}

TEST_CASE("grains that touch nothing are named, not a failure", "[solve][contact]") {
  Model m;
  Field x(3, 3);
  x << 0, 5, 9, 0, 0, 0, 0.45, 3, 0.2;
  add_grains(m, {{"grains", x, {1, 1, 1}, 1.0}});
  meet(m, 100), floor(m, 100);
  Energy energy(m);
  Newton newton(energy);
  State state = m.start;
  const Report report = newton.minimise(state);
  REQUIRE(report.converged());
  const Equilibrium e = assess(newton, state, report);
  CHECK(e.point.stability.negative == 0);
  CHECK(e.point.stability.stable);
  CHECK(e.point.stability.zero >= 3 + 2 + 2);                 // the others are pushed out until they graze the floor
  bool named = false;
  for (const std::string& name : e.point.stability.zero_modes) named = named || name == "rattler: grains 2 touches nothing";
  CHECK(named);
}

TEST_CASE("what nothing stops is told by name", "[solve][contact]") {
  Model m;
  Field x(3, 2);
  x << 0, 3, 0, 0, 0.45, 2;
  add_grains(m, {{"grains", x, {1, 1}, 1.0}});
  floor(m, 1e3);
  m.walls[0].particles = {0};
  weigh(m, 1);
  Energy energy(m);
  Newton newton(energy);
  State state = m.start;
  const Report report = newton.minimise(state);
  CHECK(report.status == Status::not_converged);
  CHECK(report.why.find("grains 2") != std::string::npos);
}

TEST_CASE("a chain falls into a corner and rests there", "[solve][contact]") {
  Model m = chain(12, 500, 50, 1, Vec3(1, 0.1, 0));
  for (int i = 0; i < 12; ++i) m.start.position(2, i) += 4 + 0.3 * i, m.start.low(2, i) = 0;
  m.structures[0].name = "chain";
  meet(m, 1e4), floor(m, 1e4, Vec3(0, 1, 1)), floor(m, 1e4, Vec3(0, -1, 1));
  weigh(m, 1);
  Energy energy(m);
  Newton newton(energy);
  State state = m.start;
  const Report report = newton.minimise(state);
  INFO(report.why << ", " << report.iterations << " iterations");
  REQUIRE(report.converged());
  CHECK(energy.touches(state).size() >= 12);
  const Equilibrium e = assess(newton, state, report);
  CHECK(e.point.stability.zero == 1);                         // it may slide along the corner
  CHECK(e.point.stability.stable);
}
