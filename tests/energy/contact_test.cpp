#include "catch.hpp"
#include "chain.hpp"
#include "core/near_pairs.hpp"
#include "core/parallel.hpp"
#include "energy/energy.hpp"
#include "laws/check_law.hpp"
#include "model/grains.hpp"

#include <numeric>

using namespace elamin;

namespace {

Field scattered(int n, double size, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> in(-size / 2, size / 2);
  Field x(3, n);
  for (Eigen::Index k = 0; k < x.size(); ++k) x.data()[k] = in(random);
  return x;
}

PairContact hertz(std::vector<int> a, std::vector<int> b, double modulus, std::optional<int> exclude = {}) {
  PairContact c;
  c.particles = {std::move(a), std::move(b)}, c.effective_modulus = modulus, c.exclude_bonds = exclude;
  return c;
}

// Grains of very different sizes in a moving, growing cylinder, with cohesion.
Model heap() {
  Model m;
  const int n = 40;
  std::vector<double> diameter(n);
  for (int i = 0; i < n; ++i) diameter[i] = i == 0 ? 1.6 : 0.4 + 0.01 * i;
  add_grains(m, {{"grains", scattered(n, 2.2, 5), diameter, 1000.0}});
  m.contacts.push_back(hertz(numbers(n), numbers(n), 50));
  PairContact lj;
  lj.law = PairContact::Law::lj, lj.particles = {numbers(20), numbers(n)}, lj.epsilon = 0.01, lj.sigma = 0.9, lj.cutoff = 1.7;
  m.contacts.push_back(lj);
  Wall tube;
  tube.particles = numbers(n), tube.region.shape = Shape::cylinder, tube.region.radius = 1.9, tube.region.axial_lo = -1.6;
  tube.region.axial_hi = 1.7, tube.effective_modulus = 30, tube.curved = true;
  tube.displacement = Vec3(0.1, -0.05, 0.02), tube.radius_change = -0.2;
  m.walls.push_back(tube);
  hold(m, 0, 0, {true, true, true}, Vec3(0.1, 0.2, 0.05));
  m.gravity.push_back({"", numbers(n), Vec3(0, 0, -1e-4), Scaling::constant()});
  return m;
}


}  // namespace

TEST_CASE("near pairs of balls of any sizes are all found, each once", "[energy]") {
  const int n = 300;
  const Field x = scattered(n, 6, 1);
  std::vector<double> r(n);
  for (int i = 0; i < n; ++i) r[i] = i % 7 == 0 ? 0.0 : std::exp2(-8.0 * (i % 11) / 11) * 1.3;
  std::vector<IndexPair> all;
  for (int i = 0; i < n; ++i)
    for (int j = i + 1; j < n; ++j)
      if (r[i] > 0 && r[j] > 0 && (i + j) % 5 != 0 && (x.col(i) - x.col(j)).norm() <= r[i] + r[j]) all.push_back({i, j});
  CHECK(all.size() > 200);
  for (const double unit : {1e-3, 1.0, 1e3}) {
    std::vector<double> radii = r;
    for (double& s : radii) s *= unit;
    CHECK(near_pairs(x * unit, radii, [](int i, int j) { return (i + j) % 5 != 0; }) == all);
  }
}

TEST_CASE("contact energies, gradients and Hessians agree with differences", "[energy][contact]") {
  const Model model = heap();
  Energy energy(model);
  State state = model.start;
  energy.kinematics().prescribe(state, 0.6);
  energy.evaluate(state);
  const EnergyTerms terms = energy.last_terms();
  CHECK((terms.contact > 0 && terms.wall > 0 && terms.cohesion != 0));
  const Vector g = energy.gradient(), rate = energy.load_derivative();
  const Eigen::MatrixXd H = Eigen::MatrixXd(energy.hessian()).selfadjointView<Eigen::Lower>();
  const double step = 1e-5, scale = H.norm();
  // Hertz's law is C² only: where an overlap passes zero within ±2h, fourth-order differences have an error of h^{1/2}·scale
  // of the third derivative; everywhere else of h⁴. No overlap here is smaller than that.
  for (const Touch& t : energy.touches(state, 1)) REQUIRE(std::abs(t.gap) > 8 * step);
  for (int k = 0; k < energy.dofs(); ++k) {
    const auto along = [&](double s) {
      State moved = state;
      energy.kinematics().retract(moved, Vector::Unit(energy.dofs(), k), s);
      return moved;
    };
    CHECK(std::abs(difference([&](double s) { return energy.value(along(s)); }, step) - g[k]) <= 1e-8 * g.cwiseAbs().maxCoeff());
    const Vector column = difference([&](double s) -> Vector { energy.evaluate(along(s), false); return energy.gradient(); }, step);
    CHECK((column - H.col(k)).cwiseAbs().maxCoeff() <= 1e-8 * scale);
  }
  const Vector by_differences = difference([&](double s) -> Vector {
    State moved = state;
    energy.kinematics().prescribe(moved, state.load_factor + s);
    energy.evaluate(moved, false);
    return energy.gradient();
  }, step);
  CHECK(rate.norm() > 0);
  CHECK((rate - by_differences).cwiseAbs().maxCoeff() <= 1e-8 * scale);
}

TEST_CASE("the energy does not know when its list of candidates was made", "[energy][contact]") {
  const Model model = heap();
  Energy far(model), near(model);
  const Field push = scattered(model.particles(), 1, 9);
  State state = model.start;
  int versions = 0;
  for (int k = 0; k <= 60; ++k) {                             // `near` in small steps, `far` from the start every time
    state.position = model.start.position + 0.02 * k * push;
    State back = model.start;
    back.load_factor = state.load_factor;
    far.value(back);
    versions = far.pattern_version();
    CHECK(near.value(state) == far.value(state));
    CHECK(near.forces(state) == far.forces(state));
  }
  CHECK(versions > 1);
  CHECK(near.pattern_version() > 1);
  CHECK(near.pattern_version() < 40);                         // not rebuilt without need
}

TEST_CASE("contacts evaluate to the same bits on any number of threads", "[energy][contact]") {
  Model model;
  const int n = 3000;
  add_grains(model, {{"grains", scattered(n, 16, 2), std::vector<double>(n, 1.0), 1.0}});
  model.contacts.push_back(hertz(numbers(n), numbers(n), 7));
  set_threads(1);
  Energy one(model);
  one.evaluate(model.start);
  const Vector g = one.gradient();
  CHECK(g.norm() > 0);
  for (const int threads : {2, 4}) {
    set_threads(threads);
    Energy more(model);
    more.evaluate(model.start);
    CHECK(more.gradient() == g);
    CHECK(std::equal(one.hessian().valuePtr(), one.hessian().valuePtr() + one.hessian().nonZeros(), more.hessian().valuePtr()));
  }
}

TEST_CASE("which pairs feel each other", "[energy][contact]") {
  Model m = chain(10, 1, 1, 1);
  for (double& d : m.diameter) d = 2.5;                       // overlaps two bonds away at rest
  SECTION("by default as many bonds as overlap at rest") {
    m.contacts.push_back(hertz(numbers(10), numbers(10), 1));
    const ContactRules rules(m);
    CHECK(rules.excluded_bonds(0) == 2);
    CHECK(rules.hertz(0, 2) == -1);
    CHECK(rules.hertz(0, 3) == 0);
    CHECK(rules.hertz(3, 0) == 0);
    CHECK(Energy(m).value(m.start) == 0);
  }
  SECTION("as many as asked for") {
    m.contacts.push_back(hertz(numbers(10), numbers(10), 1, 0));
    CHECK(ContactRules(m).hertz(4, 5) == 0);
    CHECK(Energy(m).touches(m.start).size() == 9 + 8);
  }
  SECTION("the later of two tables holds, whichever side its groups are on; different laws add") {
    m.contacts.push_back(hertz(numbers(10), numbers(10), 1, 1));
    m.contacts.push_back(hertz({5}, {1, 2}, 0, 1));
    PairContact lj;
    lj.law = PairContact::Law::lj, lj.particles = {std::vector<int>{5}, std::vector<int>{1}}, lj.epsilon = 1, lj.sigma = 1, lj.cutoff = 9;
    m.contacts.push_back(lj);
    const ContactRules rules(m);
    CHECK(rules.hertz(1, 5) == 1);
    CHECK(rules.hertz(5, 2) == 1);
    CHECK(rules.hertz(5, 3) == 0);
    CHECK(rules.lj(1, 5) == 2);
    CHECK(rules.lj(5, 2) == -1);
    CHECK(rules.cutoff_radius(1) == 4.5);
  }
}

TEST_CASE("no step passes through anything", "[energy][contact]") {
  Model m;
  Field x(3, 3);
  x << 0, 10, 0, 0, 0, 0.6, 0, 0, 40;
  add_grains(m, {{"grains", x, {1.0, 2.0, 1.0}, 1.0}});
  m.contacts.push_back(hertz(numbers(3), numbers(3), 1));
  const Energy energy(m);
  const auto fly = [&](int p, const Vec3& u) {
    State to = m.start;
    to.position.col(p) += u;
    return energy.collision_free_step(m.start, to);
  };
  CHECK(fly(0, Vec3(20, 0, 0)) == Approx((10 - 0.8 * 1.5) / 20).epsilon(1e-12));
  CHECK(fly(0, Vec3(5, 0, 0)) == 1);
  CHECK(fly(0, Vec3(-1000, 0, 0)) == 1);
  CHECK(fly(0, Vec3(20, 4, 0)) == 1);                         // past it
  CHECK(fly(0, Vec3(1e15, 0, 0)) == Approx((10 - 0.8 * 1.5) / 1e15).epsilon(1e-12));
  const double away = 1e15 * fly(0, Vec3(-1e15, 0, 0));        // nothing is in the way, as far as it looks
  CHECK(away >= 500);
  CHECK(away < 1e5);
  CHECK(fly(2, Vec3(0, 0, -4000)) == Approx((40 - std::sqrt(0.64 - 0.36)) / 4000).epsilon(1e-12));
  SECTION("through no wall either, however thin") {
    Wall wall;
    wall.particles = {0, 1, 2}, wall.effective_modulus = 1, wall.region.center = Vec3(0, 0, -7);
    m.walls.push_back(wall);
    const double part = fly(0, Vec3(0, 0, -1000));
    CHECK(1000 * part <= 7 - 0.8 * 0.5 + 1e-3);
    CHECK(1000 * part >= 7 - 0.5);
    m.walls[0].displacement = Vec3(0, 0, 100);                // nor does a wall pass through them
    State to = m.start;
    to.load_factor = 1;
    const double rise = 100 * energy.collision_free_step(m.start, to);
    CHECK(rise <= 7 - 0.8 * 1 + 1e-3);                        // the larger one meets it first
    CHECK(rise >= 7 - 1);
  }
}
