#include "catch.hpp"
#include "reference.hpp"
#include "sheets.hpp"

#include <set>

using namespace elamin;

namespace {

constexpr int beyond_counting = std::numeric_limits<int>::max();

/// Largest |length − rest length| of the bonds.
double misfit(const Model& m) {
  double worst = 0;
  for (const Bond& b : m.bonds)
    worst = std::max(worst, std::abs((length_of(m, b) - exact(m.bond_types[b.type].rest_length)).value()));
  return worst;
}

/// Pairs nearer than `reach`, counted one by one.
int near_pairs(const Model& m, double reach) {
  int pairs = 0;
  for (int i = 0; i < m.particles(); ++i)
    for (int j = 0; j < i; ++j) pairs += (m.start.position.col(i) - m.start.position.col(j)).norm() < reach;
  return pairs;
}

int distinct_bonds(const Model& m) {
  std::set<std::pair<int, int>> pairs;
  for (const Bond& b : m.bonds) pairs.insert(std::minmax(b.particles[0], b.particles[1]));
  return static_cast<int>(pairs.size());
}

/// Whether the two have the same points in any order, to `tolerance`.
bool same_points(const Field& a, const Field& b, double tolerance) {
  if (a.cols() != b.cols()) return false;
  for (Eigen::Index i = 0; i < a.cols(); ++i)
    if ((b.colwise() - a.col(i)).colwise().norm().minCoeff() > tolerance) return false;
  return true;
}

/// The middle particles of the angles stand in line to rounding, the ends a bond from them.
void check_straight(const Model& m, double spacing) {
  double bent = 0;
  for (const Angle& a : m.angles) {
    const ExactVector u = m.start.at(a.particles[1]) - m.start.at(a.particles[0]),
                      w = m.start.at(a.particles[2]) - m.start.at(a.particles[1]);
    bent = std::max(bent, norm(w - u).value());
  }
  CHECK(bent < 1e-26 * spacing);
}

}  // namespace

TEST_CASE("Plates have the rows, bonds and angles of the reference's", "[model]") {
  const nlohmann::json data = reference("exact/plate_buckling.json");
  const nlohmann::json& plates = data["straight_simply_supported"];
  const double a = plates["spacing"];
  for (const nlohmann::json& level : plates["levels"]) {
    const int m = level["m_per_row"], n = level["n_rows"], even = (n + 1) / 2, odd = n / 2;
    const double lx = (m - 1) * a, ly = (n - 1) * a * std::sqrt(3) / 2;
    Sheet s = rectangle(lx, ly, a);
    s.center = {lx / 2, ly / 2, 0};
    const Model model = built(s);
    CHECK(model.particles() == even * m + odd * (m - 1));
    CHECK(sheet_particles(s) == model.particles());
    // Along the rows, and two of every particle of an odd row to each row beside it.
    CHECK(static_cast<int>(model.bonds.size()) == even * (m - 1) + odd * (m - 2) + 2 * (m - 1) * (n - 1));
    // Along the rows, and two about each particle of an inner row but the ends of even ones.
    CHECK(static_cast<int>(model.angles.size()) ==
          even * (m - 2) + odd * (m - 3) + 2 * (m - 1) * odd + 2 * (m - 2) * (even - 2));
    CHECK((model.bond_types.size() == 1 && model.bond_types[0].rest_length == a && model.bond_types[0].stiffness == 2));
    CHECK((model.angle_types.size() == 1 && model.angle_types[0].rest == exact_pi.hi &&
           model.angle_types[0].stiffness == 3));
    CHECK(misfit(model) < 1e-28 * lx);
    double off = 0;
    int p = 0;
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < m - j % 2; ++i, ++p)
        off = std::max(
            off, (model.start.position.col(p) - Vec3((i + (j % 2) / 2.0) * a, j * a * std::sqrt(3) / 2, 0)).norm());
    CHECK(off < 8 * epsilon * lx);
    check_straight(model, a);
    if (m == 27) CHECK(near_pairs(model, 1.2 * a) == static_cast<int>(model.bonds.size()));
  }
}

TEST_CASE("A flat sheet fills its outline with bonds at rest, whatever its size, direction and normal", "[model]") {
  const double scale = GENERATE(1e-3, 1.0, 1e3),
               angle = GENERATE(0.0, 10.0, 15.0, 30.0, 45.0, 90.0, -17.0, 137.0, 200.0) * degree;
  const Vec3 normal = GENERATE(Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(1, -2, -0.5)),
             center = scale * Vec3(0.3, -0.1, 1.0 / 3);
  const bool round = GENERATE(false, true);
  const double a = 0.05 * scale;
  Sheet s = round ? circle(0.5 * scale, a, angle) : rectangle(scale, 0.7 * scale, a, angle);
  s.normal = normal, s.center = center;
  const Model m = built(s);
  CHECK(sheet_particles(s) == m.particles());
  CHECK(misfit(m) < 1e-28 * scale);
  CHECK(near_pairs(m, 1.2 * a) == static_cast<int>(m.bonds.size()));
  check_straight(m, a);

  const Frame f = frame_of(normal);
  const Eigen::Matrix2Xd x = (Eigen::Matrix<double, 3, 2>() << f.e1.hi, f.e2.hi).finished().transpose() *
                             (m.start.position.colwise() - center);
  const Eigen::RowVectorXd above = f.n.hi.transpose() * (m.start.position.colwise() - center);
  CHECK(above.cwiseAbs().maxCoeff() < 8 * epsilon * scale);
  const Eigen::Vector2d row(std::cos(angle), std::sin(angle)),
      first = x.col(m.bonds[0].particles[1]) - x.col(m.bonds[0].particles[0]);
  const Eigen::Rotation2Dd sixth(60 * degree);
  const bool along_row = (first / a - row).norm() < 1e-12;
  CHECK((along_row || (first / a - sixth * row).norm() < 1e-12 || (first / a - sixth * (sixth * row)).norm() < 1e-12));
  // Every lattice point within is there, and no other: all points of a larger patch are tried.
  const Eigen::Vector2d origin = round ? Eigen::Vector2d(0, 0) : Eigen::Vector2d(-scale / 2, -0.35 * scale),
                        next = sixth * row;
  int within = 0, found = 0;
  for (int j = -60; j <= 60; ++j)
    for (int i = -60; i <= 60; ++i) {
      const Eigen::Vector2d p = origin + a * (i * row + j * next);
      const double margin = 1e-8 * a;
      if (round ? p.norm() > 0.5 * scale + margin
                : std::abs(p[0]) > scale / 2 + margin || std::abs(p[1]) > 0.35 * scale + margin)
        continue;
      ++within;
      found += (x.colwise() - p).colwise().norm().minCoeff() < 1e-12 * scale;
    }
  CHECK(within == m.particles());
  CHECK(found == within);
}

TEST_CASE("A turn of the lattice by 60 degrees makes the same sheet", "[model]") {
  const double turn = GENERATE(60.0, 120.0, 180.0, 240.0, 300.0, 360.0), start = GENERATE(0.0, 7.0);
  for (const bool round : {false, true}) {
    const Sheet s = round ? circle(0.0105, 1e-3, start * degree) : rectangle(0.02, 0.013, 1e-3, start * degree);
    Sheet t = s;
    t.lattice_angle = (start + turn) * degree;
    const Model a = built(s), b = built(t);
    CHECK(same_points(a.start.position, b.start.position, 1e-15));
    CHECK((a.bonds.size() == b.bonds.size() && a.angles.size() == b.angles.size()));
  }
}

TEST_CASE("A circle is symmetric about its centre, a lattice point", "[model]") {
  const Sheet s = circle(7, 1);   // (5, 3) and (7, 0) are exactly on it
  const Model m = built(s);
  CHECK(m.particles() == 187);
  CHECK(same_points(m.start.position, -m.start.position, 1e-14));
  CHECK((m.start.position.colwise().norm().array() > 7 - 1e-12).count() == 18);
  CHECK(m.start.position.col(93).isZero(0));
}

TEST_CASE("A cylinder is closed without a seam and at rest as built", "[model]") {
  const double scale = GENERATE(1e-3, 1e3), angle = GENERATE(0.0, 30.0, 90.0, 17.0, -41.0, 130.0) * degree;
  const Vec3 normal = GENERATE(Vec3(0, 0, 1), Vec3(0, 0, -1), Vec3(2, -1, 0.3)), center = scale * Vec3(0.4, -0.2, 0.1);
  const double radius = 0.11 * scale, height = 0.5 * scale, a = 0.02 * scale;
  Sheet s = cylinder(radius, height, a, angle);
  s.normal = normal, s.center = center;
  const Rolled roll = rolled(s);
  REQUIRE(roll.closes);
  CHECK(std::abs(roll.spacing / a - 1) <
        0.6 / (2 * exact_pi.hi * radius / a));   // no lattice point is farther than 1/√3 from one
  const Model m = built(s);
  CHECK(sheet_particles(s) == m.particles());
  const double cell = roll.spacing * roll.spacing * std::sqrt(3) / 2;
  CHECK(std::abs(m.particles() * cell / (2 * exact_pi.hi * radius * height) - 1) < a / height);
  CHECK(misfit(m) <= epsilon * a);
  REQUIRE((m.bond_types.size() == 3 && m.angle_types.size() == 3));
  CHECK(distinct_bonds(m) == static_cast<int>(m.bonds.size()));
  CHECK(near_pairs(m, 1.2 * a) == static_cast<int>(m.bonds.size()));

  const Frame f = frame_of(normal);
  const Vec3 lowest = center + radius * f.e1.hi - height / 2 * f.n.hi;
  CHECK((m.start.position.colwise() - lowest).colwise().norm().minCoeff() < 8 * epsilon * scale);
  const std::vector<int> bonds = bonds_of_each(m);
  std::vector<int> angles(m.particles());
  for (const Angle& t : m.angles) ++angles[t.particles[1]];
  bool closed = true;
  double off_radius = 0, off_end = 0;
  for (int p = 0; p < m.particles(); ++p) {
    const Vec3 x = m.start.position.col(p) - center;
    const double z = x.dot(f.n.hi);
    off_radius = std::max(off_radius, std::abs((x - z * f.n.hi).norm() - radius));
    off_end = std::max(off_end, std::abs(z) - height / 2);
    if (std::abs(z) < height / 2 - roll.spacing) closed = closed && bonds[p] == 6 && angles[p] == 3;
  }
  CHECK(off_radius < 8 * epsilon * scale);
  CHECK(off_end < 1e-8 * a);
  CHECK(closed);
  double off_rest = 0;
  for (const Angle& t : m.angles) {
    const Vec3 u = (m.start.at(t.particles[0]) - m.start.at(t.particles[1])).hi,
               w = (m.start.at(t.particles[2]) - m.start.at(t.particles[1])).hi;
    off_rest = std::max(off_rest, std::abs(std::atan2(u.cross(w).norm(), u.dot(w)) - m.angle_types[t.type].rest));
  }
  CHECK(off_rest < 1e-13);
  // Rows climb at the lattice's angle, as near as the closing lets them.
  for (const Bond& b : m.bonds) {
    if (b.type != 0) continue;
    const Vec3 x = m.start.position.col(b.particles[0]) - center,
               along = (m.start.at(b.particles[1]) - m.start.at(b.particles[0])).hi;
    const double climb = std::atan2(along.dot(f.n.hi), along.dot(f.n.hi.cross(x).normalized()));
    CHECK(std::abs(std::remainder(climb - angle, 2 * exact_pi.hi)) < 0.06);
    break;
  }
}

TEST_CASE("Cylinders of rows around them: the numbers are those of a ring", "[model]") {
  Sheet s = cylinder(1 / (2 * std::sin(exact_pi.hi / 12)), 4 * std::sqrt(3) / 2, 1);
  const Rolled roll = rolled(s);
  CHECK((roll.n1 == 12 && roll.n2 == 0));
  s.height *= roll.spacing;   // four steps of the lattice as scaled
  const Model m = built(s);
  CHECK(m.particles() == 60);
  CHECK(m.bonds.size() == 5 * 12 + 4 * 24);
  CHECK(m.angles.size() == 5 * 12 + 3 * 24);
  CHECK(m.bond_types[0].rest_length == Approx(1).epsilon(4 * epsilon));   // the chord of 12 with that radius
  CHECK(m.angle_types[0].rest == Approx(exact_pi.hi * 10 / 12).epsilon(4 * epsilon));
  CHECK(m.angle_types[1].rest == Approx(m.angle_types[2].rest).epsilon(4 * epsilon));

  s.as_built = false, s.rest = 3, s.rest_length = 0.9;
  const Model other = built(s);
  CHECK((other.bond_types.size() == 1 && other.bond_types[0].rest_length == 0.9));
  CHECK((other.angle_types.size() == 1 && other.angle_types[0].rest == 3));
  CHECK(other.bonds.size() == m.bonds.size());
}

TEST_CASE("A cylinder across its rows has straight lines along its axis", "[model]") {
  Sheet s = cylinder(5, 20, 1, 90 * degree);
  const Model m = built(s);
  CHECK(m.angle_types[0].rest == exact_pi.hi);   // the rows run up
  CHECK(m.bond_types[0].rest_length == Approx(rolled(s).spacing).epsilon(4 * epsilon));
}

TEST_CASE("The narrowest cylinders meet no particle twice", "[model]") {
  for (const double angle : {0.0, 10.0, 19.0, 30.0, 77.0, 90.0})
    for (double around = 0.1; around < 6; around += 0.1) {
      const Sheet s = cylinder(around / (2 * exact_pi.hi), 7, 1, angle * degree);
      if (!rolled(s).closes) {
        CHECK(sheet_particles(s) == 0);
        CHECK(around < 3.3);
        continue;
      }
      const Model m = built(s);
      REQUIRE(sheet_particles(s) == m.particles());
      CHECK(distinct_bonds(m) == static_cast<int>(m.bonds.size()));
      for (const Bond& b : m.bonds) REQUIRE(b.particles[0] != b.particles[1]);
      for (const Angle& a : m.angles) REQUIRE(a.particles[0] != a.particles[2]);
      CHECK(misfit(m) <= 2 * epsilon);
    }
}

TEST_CASE("Sheets too large to build are counted as such", "[model]") {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  for (const double angle : {0.0, 45.0, 90.0})
    for (const auto& [x, y] : {std::pair(1e300, 1.0),
                               {1.0, 1e300},
                               {1e300, 1e300},
                               {1e5, 1e5},
                               {nan, 1.0},
                               {1.0, nan},
                               {inf, 1.0},
                               {1.0, inf}}) {
      CHECK(sheet_particles(rectangle(x, y, 1, angle * degree)) == beyond_counting);
      CHECK(sheet_particles(cylinder(x, y, 1, angle * degree)) == beyond_counting);
      CHECK(sheet_particles(circle(1e5 * std::max(x, y), 1, angle * degree)) == beyond_counting);
    }
  CHECK(sheet_particles(rectangle(1, 1, 1e-300)) == beyond_counting);
  CHECK(sheet_particles(rectangle(0, 0, 1)) == 1);
  CHECK(sheet_particles(rectangle(5, 0, 1)) == 6);
  CHECK(sheet_particles(circle(0.5, 1)) == 1);
  CHECK(sheet_particles(rectangle(40000, 40000, 1)) > 1'800'000'000);
}
