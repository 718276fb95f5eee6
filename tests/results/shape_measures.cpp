// Distances, angles, slopes, extents and areas as observables, against what they are by construction.
#include "catch.hpp"
#include "core/error.hpp"
#include "results/observables.hpp"
#include "results/sample.hpp"

using namespace elamin;

namespace {

double value(const Model& m, const State& state, const ObserveTable& o) {
  Problem problem;
  problem.observe = {o};
  return Observables(problem, m).evaluate(state, Field::Zero(3, m.particles()), {}).at(0);
}

ObserveTable shape(Quantity q, const std::string& group, const std::string& to = "", const std::string& through = "") {
  ObserveTable o = observe("a", group, q, Component::x, Reduce::mean);
  o.to = to, o.through = through;
  return o;
}

ObserveTable against(ObserveTable o, const Vec3& axis, std::optional<Vec3> about = std::nullopt) {
  o.axis = axis, o.about = about;
  return o;
}

// Particles at these places, in groups "all", "0", "1", …
Model points(const std::vector<Vec3>& places) {
  Model m = sample_model();
  const auto n = static_cast<int>(places.size());
  m.start = State(Field::Zero(3, n));
  m.id.resize(n), m.type.assign(n, 1), m.molecule.assign(n, 1), m.diameter.assign(n, 1), m.density.assign(n, 1);
  m.bonds.clear(), m.angles.clear(), m.supports.clear(), m.walls.clear();
  m.groups = {{"all", {}}};
  for (int i = 0; i < n; ++i) {
    m.start.position.col(i) = places[i], m.id[i] = i + 1;
    m.groups[0].particles.push_back(i), m.groups.push_back({std::to_string(i), {i}});
  }
  return m;
}

}  // namespace

TEST_CASE("a row that encloses nothing, or is too short, has no area", "[observables]") {
  const Model m = points({{0, 0, 0}, {1, 2, 3}, {2, 4, 6}});
  const auto said = [&](const std::string& group) {
    try {
      value(m, m.start, shape(Quantity::area, group));
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  CHECK(said("all").find("\"all\" encloses no area at the start") != std::string::npos);
  CHECK(said("0").find("too few particles for a row; it must have 3") != std::string::npos);
}

TEST_CASE("distance and end_to_end keep the digits that the tails have, a group is where its mean is", "[observables]") {
  Model m = points({{100, 0, 0}, {100, 0, 0}, {102, 0, 4}});
  m.start.low(0, 1) = 3e-20, m.start.low(1, 1) = 4e-20;
  CHECK(value(m, m.start, shape(Quantity::distance, "1", "0")) == Approx(5e-20).epsilon(1e-14));
  m.groups.push_back({"both", {0, 2}});
  CHECK(value(m, m.start, shape(Quantity::distance, "both", "0")) == Approx(std::sqrt(5.0)).epsilon(1e-15));
  CHECK(value(m, m.start, shape(Quantity::end_to_end, "all")) == Approx(std::sqrt(20.0)).epsilon(1e-15));
}

TEST_CASE("angles: at a group between two others, from an axis, with a sign about one", "[observables]") {
  const double phi = GENERATE(1e-9, 0.3, 2.5, 3.14);
  const Mat3 R = Eigen::AngleAxisd(1, Vec3(3, 1, 2).normalized()).toRotationMatrix();
  const Vec3 y = R * Vec3::UnitY(), x = R * Vec3::UnitX();
  Model m = points({Vec3(2 * x), Vec3::Zero(), R * Vec3(5 * std::cos(phi), 0, -5 * std::sin(phi))});       // from x by φ about y
  const double tolerance = 4 * epsilon / phi;
  CHECK(value(m, m.start, shape(Quantity::angle, "0", "2", "1")) == Approx(phi).epsilon(tolerance));
  CHECK(value(m, m.start, shape(Quantity::angle, "2", "0", "1")) == Approx(phi).epsilon(tolerance));
  CHECK(value(m, m.start, against(shape(Quantity::angle, "1", "2"), 7 * x)) == Approx(phi).epsilon(tolerance));
  CHECK(value(m, m.start, against(shape(Quantity::angle, "1", "2"), x, 3 * y)) == Approx(phi).epsilon(tolerance));
  CHECK(value(m, m.start, against(shape(Quantity::angle, "1", "2"), x, -y)) == Approx(-phi).epsilon(tolerance));
  ObserveTable at = shape(Quantity::angle, "0", "2", "1");
  at.about = -y;
  CHECK(value(m, m.start, at) == Approx(2 * pi - phi).epsilon(tolerance));
}

TEST_CASE("in a plane angles are counted about its normal, at a group from 0 to 2 pi", "[observables]") {
  Model m = points({{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}});
  m.plane_normal = 1;
  for (const double z : {-1e-9, 0.0, 1e-9}) {                                // nearly straight: nothing happens at π
    m.start.position(2, 2) = z;
    CHECK(value(m, m.start, shape(Quantity::angle, "0", "2", "1")) == Approx(pi - z).epsilon(1e-15));
    CHECK(value(m, m.start, against(shape(Quantity::angle, "1", "2"), Vec3::UnitX())) == Approx(-z).margin(1e-24));
  }
}

TEST_CASE("the slope of an end is that of the bond of its last two particles, or of its first two", "[observables]") {
  Model m = points({{0, 0, 0}, {1, 0, 0.2}, {2, 0, 0}, {3, 0, -1}});
  ObserveTable o = against(shape(Quantity::slope, "all"), Vec3::UnitX(), -Vec3::UnitY());
  CHECK(value(m, m.start, o) == Approx(-pi / 4).epsilon(1e-15));
  o.end = RowEnd::first;
  CHECK(value(m, m.start, o) == Approx(std::atan(0.2)).epsilon(1e-15));
}

TEST_CASE("extents are of the places", "[observables]") {
  const Model m = points({{0, 2, -3}, {5, 2, 0}, {-1, 2, 4}});
  ObserveTable o = shape(Quantity::extent, "all");
  for (const auto& [c, expected] : {std::pair(Component::x, 6.0), {Component::y, 0.0}, {Component::z, 7.0}}) {
    o.component = c;
    CHECK(value(m, m.start, o) == expected);
  }
}

TEST_CASE("a ring's area, wherever it lies and points, of an ellipse, turned over it is negative", "[observables]") {
  const double scale = GENERATE(1e-3, 1.0, 1e3);
  const int n = 17;
  const Mat3 R = Eigen::AngleAxisd(2, Vec3(1, 1, -1).normalized()).toRotationMatrix();
  const auto ellipse = [&](double a, double b) {
    std::vector<Vec3> places;
    for (int k = 0; k < n; ++k) places.push_back(Vec3(7, -2, 5) * scale + R * Vec3(a * std::cos(2 * pi * k / n), b * std::sin(2 * pi * k / n), 0));
    return places;
  };
  const Model m = points(ellipse(scale, scale));
  const double of_unit = n / 2.0 * std::sin(2 * pi / n);
  for (const auto& [a, b] : {std::pair(1.0, 1.0), {1.5, 0.25}, {1.0, -1.0}})
    CHECK(value(m, points(ellipse(a * scale, b * scale)).start, shape(Quantity::area, "all")) == Approx(a * b * of_unit * scale * scale).epsilon(50 * epsilon));      // places are rounded at eight radii
}
