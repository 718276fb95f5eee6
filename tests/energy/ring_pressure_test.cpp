// A closed ring under pressure: the regular polygon, compressed, stops being a minimum where the reference says.
#include "catch.hpp"
#include "core/dense.hpp"
#include "energy/energy.hpp"
#include "model/loop.hpp"
#include "reference.hpp"

using namespace elamin;

namespace {

const Vec3 center(0.7, -0.3, 0);             // not the origin

enum class Kind { hydrostatic, dead_radial };

Model ring(const nlohmann::json& c, Kind kind, double p) {
  const int n = c["N"];
  const double R = c["pressure"]["R_polygon"], q0 = c["q0"], stiffness = c["K"], B = c["B"];
  Model m;
  add_loops(m, {{"ring", n, center, Vec3::UnitZ(), R, q0, 1, 1, {stiffness, chord(R, n)}, {B, pi}}});
  m.plane_normal = 2;
  std::vector<int> all(n);
  for (int i = 0; i < n; ++i) all[i] = i;
  if (kind == Kind::hydrostatic) {
    m.pressures.push_back({"ring", all, Vec3::UnitZ(), p, Scaling()});
  } else {
    m.loads.push_back({"ring", all, Vec3::Zero(), Scaling(), Field(3, n)});
    for (int i = 0; i < n; ++i) m.loads[0].own.col(i) = -p * q0 * (m.start.position.col(i) - center).normalized();
  }
  return m;
}

// The polygon at the radius where no radial force is left.
State compressed(Energy& energy, double R) {
  const Field X = energy.model().start.position.colwise() - center;
  const auto at = [&](double part) {
    State state = energy.model().start;
    for (Eigen::Index i = 0; i < X.cols(); ++i)
      for (int c = 0; c < 3; ++c) {
        const Exact x = (energy.model().start.at(static_cast<int>(i))[c] + (-center[c])) * Exact{part} + center[c];
        state.position(c, i) = x.hi, state.low(c, i) = x.lo;
      }
    state.load_factor = 1;
    return state;
  };
  const auto force = [&](double part) { return (energy.forces(at(part)).cwiseProduct(X)).sum() / R; };
  double a = 1, b = 1 - 1e-4, force_a = force(a), force_b = force(b);
  for (int k = 0; k < 50 && force_b != force_a; ++k) {
    const double next = b - force_b * (b - a) / (force_b - force_a);
    a = b, force_a = force_b, b = next, force_b = force(b);
  }
  return at(b);
}

// The smaller second derivative of the energy along radial cos mφ and tangential sin mφ. The block of these two is exact,
// as the Hessian is the same at every particle; its stiff direction is bound first, so that the soft one keeps its digits.
double soft(Energy& energy, const State& state, int m) {
  const int n = energy.model().particles();
  energy.evaluate(state);
  Vector u(energy.dofs()), w(energy.dofs());
  for (int i = 0; i < n; ++i) {
    const double phi = 2 * pi * i / n;
    const Vec3 r(std::cos(phi), std::sin(phi), 0), t(-std::sin(phi), std::cos(phi), 0);
    for (int c = 0; c < 2; ++c) u[energy.kinematics().dof(i, c)] = std::cos(m * phi) * r[c], w[energy.kinematics().dof(i, c)] = std::sin(m * phi) * t[c];
  }
  return energy.quadratic_form(u - w.dot(energy.multiply(u)) / w.dot(energy.multiply(w)) * w);
}

void check_case(const nlohmann::json& c) {
  const double R = c["pressure"]["R_polygon"];
  for (const auto& mode : c["pressure"]["modes"])
    for (const Kind kind : {Kind::hydrostatic, Kind::dead_radial}) {
      const int m = mode["m"];
      const double p = mode[kind == Kind::hydrostatic ? "p_hydrostatic" : "p_dead_radial"];
      INFO("N = " << c["N"] << ", m = " << m << (kind == Kind::hydrostatic ? ", hydrostatic" : ", dead radial"));
      for (const double side : {-1.0, 1.0}) {
        const Model model = ring(c, kind, p * (1 + side * 1e-9));
        Energy energy(model);
        const State state = compressed(energy, R);
        CHECK(side * soft(energy, state, m) < 0);
        CHECK(energy.relative(energy.gradient()) <= 1e-12);
        if (kind == Kind::hydrostatic) {
          const double radius = (state.position.col(0) - center).norm();
          CHECK(radius == Approx(double(mode["radius_at_critical"])).epsilon(2e-9 * (R - radius) / R));
          const double corner = 2 * pi / model.particles();
          const double area = model.particles() * radius * radius * std::sin(corner) / 2;
          CHECK(energy.last_terms().external == Approx(p * (1 + side * 1e-9) * area).epsilon(1e-13));
        }
      }
    }
}

}  // namespace

TEST_CASE("a ring buckles under the exact critical pressures", "[energy][reference]") {
  const nlohmann::json ring_json = reference("exact/ring.json"), cases = ring_json["cases"],
                       refined = ring_json["pressure_convergence_same_rod_EI_1e-6_EA_40000EI/R2"];
  CHECK(cases.size() + refined.size() >= 3);
  for (const nlohmann::json& c : cases) check_case(c);
  for (const nlohmann::json& c : refined) check_case(c);
}

TEST_CASE("the full Hessian of a ring loses two modes at the lowest critical pressure", "[energy][reference]") {
  const nlohmann::json ring_json = reference("exact/ring.json"), c = ring_json["cases"][0], mode = c["pressure"]["modes"][0];
  for (const Kind kind : {Kind::hydrostatic, Kind::dead_radial})
    for (const double side : {-1.0, 1.0}) {
      const double p = mode[kind == Kind::hydrostatic ? "p_hydrostatic" : "p_dead_radial"];
      const Model model = ring(c, kind, p * (1 + side * 1e-4));
      Energy energy(model);
      energy.evaluate(compressed(energy, c["pressure"]["R_polygon"]));
      const Eigen::MatrixXd H = Eigen::MatrixXd(energy.hessian()).selfadjointView<Eigen::Lower>();
      const Vector lowest = symmetric_eigen(H).values.head(6);
      INFO(lowest.transpose());
      const double zero = 10 * epsilon * H.norm();
      // Rigid motions: three zeros, but a dead radial load turns the ring round.
      const int turning = kind == Kind::dead_radial;
      CHECK((lowest.array() < -zero).count() == turning + (side > 0 ? 2 : 0));
      CHECK((lowest.array().abs() <= zero).count() == 3 - turning);
    }
}
