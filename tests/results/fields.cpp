#include "results/fields.hpp"

#include "catch.hpp"
#include "chain.hpp"
#include "scratch_directory.hpp"
#include "solve/newton.hpp"

using namespace elamin;

namespace {

Fields fields_of(Energy& energy, const State& state) { return fields_at(energy, state, energy.touches(state)); }

// Three particles in the plane xz: a bond along z, and one of length 2 that turns by φ from z towards x, about +y.
Model knee(double turn, double rest = pi) {
  Model m = chain(3, 50, 0.25, 1);
  m.start.position.col(2) = Vec3(2 * std::sin(turn), 0, 1 + 2 * std::cos(turn));
  m.start.low.setZero();
  m.bond_types.push_back({10, 2}), m.bonds[1].type = 1;
  m.angle_types[0].rest = rest, m.plane_normal = 1;
  return m;
}

}  // namespace

TEST_CASE("a stretched bond: tension 2K(r - r0), strain, half of its energy on each end", "[fields]") {
  Model m = chain(2, 50, 0, 1);
  const double stretch = 1e-9;
  m.start.low(2, 1) += stretch;
  Energy energy(m);
  const Fields f = fields_of(energy, m.start);
  REQUIRE(f.bonds.size() == 1);
  CHECK(f.angles.empty());
  CHECK(f.bonds[0].length == Approx(1 + stretch).epsilon(2 * epsilon));
  CHECK(f.bonds[0].strain == Approx(stretch).epsilon(1e-14));
  CHECK(f.bonds[0].tension == Approx(2 * 50 * stretch).epsilon(1e-14));
  CHECK(f.energy[0] == Approx(25 * stretch * stretch).epsilon(1e-14));
  CHECK(f.energy[1] == f.energy[0]);
}

TEST_CASE("growth and stiffening: a bond's force is that of its law at the load factor", "[fields]") {
  Model m = chain(2, 50, 0, 1);
  m.changes.push_back({"all", {0, 1}, 0.5, 3, 0, Scaling()});
  Energy energy(m);
  State state = m.start;
  state.load_factor = 0.5;                                           // r₀ = 1.25, K = 125
  const Fields f = fields_of(energy, state);
  CHECK(f.bonds[0].strain == Approx(-0.2).epsilon(4 * epsilon));
  CHECK(f.bonds[0].tension == Approx(-2 * 125 * 0.25).epsilon(4 * epsilon));
}

TEST_CASE("a knee: turn, curvature and moment, signed in a plane, whichever way the angle is listed", "[fields]") {
  const double turn = GENERATE(0.7, -0.7, 1e-9);
  for (const double rest : {pi, pi - 0.2}) {
    Model m = knee(turn, rest);
    for (const bool reversed : {false, true}) {
      const double sign = reversed ? -1 : 1, from = rest == pi ? 0 : turn < 0 ? -0.2 : 0.2;     // the turn at rest has the sign of that as built
      if (reversed) std::swap(m.angles[0].particles[0], m.angles[0].particles[2]);
      Energy energy(m);
      const AngleField f = fields_of(energy, m.start).angles.at(0);
      const double M = 0.25 * std::sin(turn - from);
      CHECK(f.angle == Approx(sign * turn).epsilon(1e-13));
      CHECK(f.curvature == Approx(sign * turn / 1.5).epsilon(1e-13));
      CHECK(f.moment == Approx(sign * M).epsilon(1e-13));
      CHECK((f.moment_vector - Vec3(0, sign * M, 0)).norm() <= 1e-13 * std::abs(M));
    }
  }
}

TEST_CASE("in space a moment is minus the derivative of the energy by the angle", "[fields]") {
  const double turn = GENERATE(0.1, 0.9), step = 1e-5;
  for (const double rest : {pi, pi - 0.5}) {
    const auto bent = [&](double by) {
      Model m = knee(by, rest);
      m.plane_normal.reset();
      return m;
    };
    const auto energy_of = [&](double by) {
      const Model m = bent(by);
      return Energy(m).terms(m.start).angle;
    };
    const Model m = bent(turn);
    Energy energy(m);
    const AngleField f = fields_of(energy, m.start).angles.at(0);
    CHECK(f.angle == Approx(turn).epsilon(1e-14));
    CHECK(f.moment == Approx((energy_of(turn + step) - energy_of(turn - step)) / (2 * step)).margin(1e-9));    // B step²/6 and ε B/step
    CHECK((f.moment_vector - Vec3(0, f.moment, 0)).norm() <= 1e-15);
  }
}

TEST_CASE("elastica: at every hinge of a buckled chain M = -P x, the turns add up to that of its ends", "[fields]") {
  const int n = 21;
  Model m = chain(n, 500, 20, 1);
  m.plane_normal = 1;
  const double thrust = 1.4 * 20 * pi * pi / ((n - 1) * (n - 1));
  hold(m, 0, 0), hold(m, n - 1, n - 1, {true, true, false});
  m.loads.push_back({"", {n - 1}, Vec3(0, 0, -thrust), Scaling()});
  Energy energy(m);
  Newton newton(energy);
  State state = m.start;
  state.load_factor = 1;
  for (int i = 1; i + 1 < n; ++i) state.position(0, i) = std::sin(pi * i / (n - 1));
  REQUIRE(newton.minimise(state).converged());
  const Fields f = fields_of(energy, state);
  REQUIRE(f.angles.size() == n - 2);
  const double widest = state.position.row(0).maxCoeff();
  REQUIRE(widest > 4);
  double turns = 0;
  for (int i = 1; i + 1 < n; ++i) {
    CHECK(std::abs(f.angles[i - 1].moment + thrust * state.position(0, i)) <= 1e-9 * thrust * widest);
    turns += f.angles[i - 1].angle;
  }
  const auto slope = [&](int i) { return std::atan2(state.position(0, i + 1) - state.position(0, i), state.position(2, i + 1) - state.position(2, i)); };
  CHECK(turns == Approx(slope(n - 2) - slope(0)).epsilon(1e-12));
  // Across a cut the force is the thrust: along the bond its tension, the rest is what the moments at its ends need.
  for (int i = 0; i + 1 < n; ++i) CHECK(std::abs(f.bonds[i].tension + thrust * std::cos(slope(i))) <= 1e-9 * thrust);
  CHECK(f.energy.sum() == Approx(energy.terms(state).bond + energy.terms(state).angle).epsilon(1e-13));
}

TEST_CASE("grains on a floor: each is borne by its neighbours, the floor by all, Hertz's energy is 2/5 F times the overlap", "[fields]") {
  Model m = chain(3, 0, 0, 1);
  m.bonds.clear(), m.angles.clear();
  PairContact c;
  c.particles = {numbers(3), numbers(3)}, c.effective_modulus = 1e3;
  m.contacts.push_back(c);
  Wall floor;
  floor.particles = numbers(3), floor.effective_modulus = 1e3;
  floor.region.shape = Shape::plane, floor.region.center = Vec3(0, 0, -0.5), floor.region.normal = Vec3(0, 0, 1);
  m.walls.push_back(floor);
  for (int i = 0; i < 3; ++i) hold(m, i, i, {true, true, false});
  weigh(m, 2);
  Energy energy(m);
  Newton newton(energy);
  State state = m.start;
  REQUIRE(newton.minimise(state).converged());
  const std::vector<Touch> touches = energy.touches(state);
  REQUIRE(touches.size() == 3);
  const Fields f = fields_at(energy, state, touches);
  const double weight = 2 * pi / 6;
  for (int i = 0; i < 3; ++i) CHECK((f.contact_force.col(i) - Vec3(0, 0, weight)).norm() <= 1e-9 * weight);
  Vec3 on_floor = Vec3::Zero();
  double energy_of_all = 0;
  for (const Touch& t : touches) {
    const double radius = t.wall >= 0 ? 0.5 : 0.25;                  // effective
    CHECK(t.force.norm() == Approx(4.0 / 3 * 1e3 * std::sqrt(radius) * std::pow(-t.gap, 1.5)).epsilon(1e-12));
    if (t.wall >= 0) on_floor += t.force;
    energy_of_all += 0.4 * t.force.norm() * -t.gap;
  }
  CHECK(on_floor[2] == Approx(3 * weight).epsilon(1e-9));
  CHECK(f.energy.sum() == Approx(energy_of_all).epsilon(1e-12));
  CHECK(f.energy[2] == Approx(0.2 * weight * (1 - (state.position(2, 2) - state.position(2, 1)))).epsilon(1e-9));
}

TEST_CASE("the fields of a state as tables", "[fields]") {
  ScratchDirectory scratch;
  Model m = knee(pi / 2);
  m.id = {2, 3, 7};
  m.start.position.col(1)[2] = 1.5, m.start.position.col(2) = Vec3(2, 0, 1.5);
  Wall tube, floor;
  tube.name = "tube", tube.region.shape = Shape::cylinder, tube.region.axis = 0, tube.region.axial_hi = 4, tube.region.radius = 3;
  tube.region.open[1] = true, tube.displacement = Vec3(0, 1, 0);
  floor.name = "floor", floor.region.center = Vec3(0, 0, -1);
  m.walls = {tube, floor}, m.start.load_factor = 0.5;
  Energy energy(m);
  write_fields([&](const char* end) { return scratch / (std::string("s") + end); }, m, m.start, fields_of(energy, m.start));
  CHECK(text_of(scratch / "s.bonds.csv") == "first,second,length,strain,tension\n2,3,1.5,0.5,50\n3,7,2,0,0\n");
  CHECK(text_of(scratch / "s.particles.csv").find("id,kind,x,y,z,radius,energy,fx,fy,fz\n2,particle,0,0,0,0.5,") == 0);
  const std::string angles = text_of(scratch / "s.angles.csv");
  CHECK(angles.find("first,middle,third,turn,curvature,moment,mx,my,mz\n2,3,7,1.5707963267948966,") == 0);
  CHECK(angles.find(",0.25,0,0.25,0\n") != std::string::npos);
  CHECK(text_of(scratch / "s.walls.csv") == "name,shape,x,y,z,nx,ny,nz,xlo,ylo,zlo,xhi,yhi,zhi,lo,hi,radius_lo,radius_hi,open\n"
                                            "tube,cylinder,0,0.5,0,1,0,0,,,,,,,,4,3,3,hi\nfloor,plane,0,0,-1,0,0,1,,,,,,,,,,,\n");
}
