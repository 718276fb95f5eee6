// N and M of sheets against cuts through the lattice, equilibrium and the plate that the lattice is.
#include "results/fields.hpp"

#include "catch.hpp"
#include "chain.hpp"
#include "model/append.hpp"
#include "model/sheets.hpp"
#include "plate.hpp"
#include "results/stored_run.hpp"
#include "scratch_directory.hpp"
#include "solve/newton.hpp"

#include <map>

using namespace elamin;

namespace {

std::vector<StressResultants> resultants(const Model& m, const State& state) {
  return stress_resultants(m, state, bond_fields(m, state), angle_fields(m, state));
}

// Where x ↦ R F x takes a sheet, F in its plane z = 0.
State moved(const Model& m, const Mat3& F, const Mat3& R = Mat3::Identity()) {
  State state = m.start;
  for (int i = 0; i < m.particles(); ++i) state.set(i, exact(Vec3(R * F * m.start.position.col(i))));
  return state;
}

const Mat3 turned = Eigen::AngleAxisd(2.0, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();

double largest(const Vec3& v) { return v.cwiseAbs().maxCoeff(); }

}  // namespace

TEST_CASE("a plate pulled along its rows: N is the force on a row over the distance of rows, on every particle", "[resultants]") {
  const double scale = GENERATE(1e-3, 1e3), strain = GENERATE(1e-7, 0.1, -1e-3);
  const int n = 8;
  Plate p = plate(11, n, false, scale, 3, 0.02 * scale * scale);
  Model& m = p.model;
  const double force = 2 * 3 * scale * strain, length = scale * (1 + strain);
  const double height = std::sqrt(scale * scale - length * length / 4);      // of the next row: the bonds to it keep their length
  Load left, right;
  for (const auto& row : p.rows) left.particles.push_back(row.front()), right.particles.push_back(row.back());
  left.force = Vec3(-force, 0, 0), right.force = Vec3(force, 0, 0);
  m.loads = {left, right}, m.plane_normal = 2;
  const int corner = p.rows[0][0], beside = p.rows[0][1];
  hold(m, corner, corner, {true, true, true});
  hold(m, beside, beside, {false, true, true});
  Energy energy(m);
  Newton newton(energy);
  State state = m.start;
  state.load_factor = 1;
  REQUIRE(newton.minimise(state).converged());
  for (const StressResultants& r : resultants(m, state)) {
    REQUIRE(r.known);
    CHECK(r.N[0] == Approx(force / height).epsilon(1e-9));                   // the solver's tolerance is 1e-10
    CHECK(std::max(std::abs(r.N[1]), std::abs(r.N[2])) <= 1e-9 * std::abs(r.N[0]));
    CHECK(largest(r.M) <= 1e-9 * std::abs(force));
    CHECK(principal(r.N)[strain > 0 ? 0 : 1] == Approx(force / height).epsilon(1e-9));
  }
}

TEST_CASE("in a homogeneous state N is what the bonds that a line cuts bear per length, for lines along all rows", "[resultants]") {
  const double angle = GENERATE(0.0, 17.0, 30.0) * degree;
  const Sheet s = rectangle(6, 5, 0.5, angle);
  const Model m = built(s);
  Mat3 F = Mat3::Identity();
  F.topLeftCorner<2, 2>() << 1.1, 0.2, -0.05, 0.93;
  // T r t tᵀ of each of the three directions of bonds.
  std::array<Vec3, 3> bonds;
  std::array<double, 3> tension;
  for (int d = 0; d < 3; ++d) {
    const double phi = angle + d * 60 * degree;
    bonds[d] = F * Vec3(0.5 * std::cos(phi), 0.5 * std::sin(phi), 0);
    tension[d] = 2 * 2 * (bonds[d].norm() - 0.5);
  }
  // F = R U: the axes of the sheet turn with R.
  const double psi = std::atan2(F(1, 0) - F(0, 1), F(0, 0) + F(1, 1));
  const Vec3 e1(std::cos(psi), std::sin(psi), 0), e2(-e1[1], e1[0], 0);
  for (const Mat3& R : {Mat3(Mat3::Identity()), turned}) {
    const State state = moved(m, F, R);
    for (const StressResultants& r : resultants(m, state)) {
      const auto force_across = [&](const Vec3& normal) -> Vec3 {            // N ν
        const double a = normal.dot(e1), b = normal.dot(e2);
        return (r.N[0] * a + r.N[2] * b) * e1 + (r.N[2] * a + r.N[1] * b) * e2;
      };
      for (int d = 0; d < 3; ++d) {                                          // a line along bonds d: one of each of the others a bond's length
        const Vec3 along = bonds[d], normal = Vec3(-along[1], along[0], 0).normalized();
        Vec3 cut = Vec3::Zero();
        for (int other = 0; other < 3; ++other) {
          const double across = bonds[other].dot(normal);
          if (other != d) cut += (across > 0 ? 1 : -1) * tension[other] / bonds[other].norm() * bonds[other];
        }
        CHECK((force_across(normal) - cut / along.norm()).norm() <= 1e-14 * 2 / 0.5);      // a dozen roundings of tensions that are 2 K a times a strain
      }
      CHECK(largest(r.M) <= 1e-13);
    }
  }
}

TEST_CASE("a cylinder under tension along its axis: N22 times the circumference is the force", "[resultants]") {
  Model m = built(cylinder(1, 2, 0.3));
  State state = m.start;
  for (int i = 0; i < m.particles(); ++i) state.position(2, i) *= 1.05;
  const auto all = resultants(m, state);
  // Rows are rings. Between two of them: the force along the axis of every bond that is not level.
  std::map<long, double> force;
  double level = 0;
  for (const Bond& b : m.bonds) {
    const Vec3 d = state.position.col(b.particles[1]) - state.position.col(b.particles[0]);
    if (std::abs(d[2]) < 1e-9) level = d.norm();
    else force[std::lround(100 * (state.position(2, b.particles[0]) + state.position(2, b.particles[1])))] +=
        2 * m.bond_types[b.type].stiffness * (d.norm() - m.bond_types[b.type].rest_length) * std::abs(d[2]) / d.norm();
  }
  const double around = std::lround(2 * pi / (2 * std::asin(level / 2))), rows = 1.05 * (m.start.position.row(2).maxCoeff() - m.start.position.row(2).minCoeff());
  const double up = rows / force.size(), sagitta = 1 - std::cos(pi / around), slant = std::hypot(up, sagitta);      // of a triangle, against the axis
  REQUIRE(force.size() > 3);
  for (const auto& [at, f] : force)
    for (const StressResultants& r : all) {
      CHECK(r.N[1] * around * level * up / slant == Approx(f).epsilon(1e-12));
      CHECK(std::abs(r.N[2]) <= 1e-12 * r.N[1]);
    }
}

TEST_CASE("a plate bent by couples at the ends of its rows: M is a couple over the distance of rows, elsewhere 0", "[resultants]") {
  const double B = 0.4, a = 0.5, small = 1e-6;
  Plate p = plate(12, 7, false, a, 300, B);
  Model& m = p.model;
  const double couple = B * small, height = a * std::sqrt(3) / 2;
  // A pair of forces at the last two particles of each row, so that the row bends towards +z.
  Load up, down;
  for (const auto& row : p.rows) {
    up.particles.push_back(row.front()), up.particles.push_back(row.back());
    down.particles.push_back(row[1]), down.particles.push_back(row[row.size() - 2]);
  }
  up.force = Vec3(0, 0, couple / a), down.force = -up.force;
  m.loads = {up, down};
  const int corner = p.rows[0][5], beside = p.rows[0][6], other = p.rows[6][5];
  hold(m, corner, corner, {true, true, true});
  hold(m, beside, beside, {false, true, true});
  hold(m, other, other, {false, false, true});
  Energy energy(m);
  Newton newton(energy);
  State state = m.start;
  state.load_factor = 1;
  REQUIRE(newton.minimise(state).converged());
  const auto all = resultants(m, state);
  for (const auto& row : p.rows)
    for (std::size_t i = 0; i < row.size(); ++i) {
      const bool end = i == 0 || i + 1 == row.size();
      // Turns are of the order of 1e-6, their squares and the solver's tolerance are what is left.
      CHECK(std::abs(all[row[i]].M[0] - (end ? 0 : couple / height)) <= 1e-8 * couple / height);
      CHECK(std::max(std::abs(all[row[i]].M[1]), std::abs(all[row[i]].M[2])) <= 1e-8 * couple / height);
    }
}

TEST_CASE("a plate of small curvature has the moments of the isotropic one, M = D k and D k/3, whichever way its lattice lies and it points", "[resultants]") {
  const double angle = GENERATE(0.0, 30.0, 90.0) * degree, scale = GENERATE(1e-3, 1.0), sign = GENERATE(1.0, -1.0);
  const Sheet s = rectangle(9 * scale, 8 * scale, scale, angle);
  const Model m = built(s);
  const double curvature = sign * 1e-7 / scale, D = 3 * std::sqrt(3) / 4 * 3;
  for (const Mat3& R : {Mat3(Mat3::Identity()), turned}) {
    State state = m.start;
    for (int i = 0; i < m.particles(); ++i) {
      const Vec3 x = m.start.position.col(i);
      state.set(i, exact(Vec3(R * Vec3(x[0], x[1], curvature * x[0] * x[0] / 2))));
    }
    const auto all = resultants(m, state);
    const std::vector<int> bonds = bonds_of_each(m);
    int inner = 0;
    for (int i = 0; i < m.particles(); ++i) {
      if (bonds[i] != 6) continue;
      ++inner;
      // Places are rounded at their size, ten times the spacing: a turn of 1e-7 to 1e-8 of itself, or 1e-15 if it stands upright.
      CHECK(all[i].M[0] == Approx(D * curvature).epsilon(2e-7));
      CHECK(all[i].M[1] == Approx(D * curvature / 3).epsilon(6e-7));
      CHECK(std::abs(all[i].M[2]) <= 2e-7 * D * std::abs(curvature));
    }
    CHECK(inner > 20);
  }
}

TEST_CASE("stress resultants stand in the table of particles, of sheets only", "[resultants]") {
  const ScratchDirectory scratch;
  Plate p = plate(3, 3, false, 1, 2, 0);
  Appender(p.model, 1).apart(1, 1, 0);                            // a grain
  Energy energy(p.model);
  State state = moved(p.model, 1.5 * Mat3::Identity());
  write_fields([&](const char* end) { return scratch / (std::string("s") + end); }, p.model, state, fields_at(energy, state, {}));
  CHECK(text_of(scratch / "s.particles.csv").find("id,kind,x,y,z,radius,energy,fx,fy,fz,N11,N22,N12,M11,M22,M12\n") == 0);
  // T = 2 K (r − a) = 2 in all bonds: N = √3 T/r of both axes.
  const Table particles = read_table(scratch / "s.particles.csv");
  REQUIRE(particles.rows.size() == 10);
  for (const Row& row : particles.rows) {
    REQUIRE(row.size() == 16);
    if (as_number(row[0]) == 10) {
      CHECK(std::holds_alternative<Nothing>(row[10]));
      continue;
    }
    CHECK(std::get<double>(row[10]) == Approx(std::sqrt(3) * 2 / 1.5).epsilon(1e-13));
    CHECK(std::get<double>(row[11]) == Approx(std::sqrt(3) * 2 / 1.5).epsilon(1e-13));
  }
}
