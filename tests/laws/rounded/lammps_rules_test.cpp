#include "laws/rounded/lammps_rules.hpp"

#include "catch.hpp"
#include "laws/rounded/bodies.hpp"
#include "laws/rounded/lammps_case.hpp"

#include <fmt/format.h>


using namespace elamin;

namespace {

std::string word(LammpsHow how) {
  if (how == LammpsHow::direct) return "direct";
  return how == LammpsHow::scaled ? "ja=" : how == LammpsHow::dropped ? "dropped" : "through";
}

}  // namespace

TEST_CASE("the rules of LAMMPS give its energies, forces and torques", "[laws][rounded][lammps]") {
  for (const ReferenceCase& c : static_cases()) {
    INFO(c.name);
    CHECK(lammps_forces(c, at_start(c)).off(c.expected["lammps"]) <= 1e-12);
  }
}

TEST_CASE("pairs of boxes and prisms in motion, with friction, area factor and parallel edges",
    "[laws][rounded][lammps]") {
  const ReferenceCase c = read_case("pairs", "polyhedra_pairs");
  const LammpsBodies all = at_start(c);
  CHECK(lammps_forces(c, all).off(c.expected["lammps"]) <= 1e-11);
  int scaled = 0, dropped = 0, parallel = 0;
  for (std::size_t k = 0; k < c.bodies.size(); k += 2) {
    const LammpsPair pair = lammps_rules(c, k, k + 1).pair(c.body(k), c.body(k + 1));
    scaled += pair.area_factor > 1, dropped += pair.dropped, parallel += pair.parallel;
  }
  CHECK(scaled >= 30);
  CHECK(dropped >= 5);
  CHECK(parallel >= 5);
}

TEST_CASE("the rules of LAMMPS list its contacts and know when they have no potential", "[laws][rounded][lammps]") {
  std::set<std::string> met;
  for (const ReferenceCase& c : static_cases()) {
    INFO(c.name);
    std::multiset<std::string> found, expected;                        // gaps to 12 digits
    bool conservative = lammps_rules(c, 0, 0).friction == 0 && !c.settings().contains("walls");
    const auto line = [](const std::string& how, double gap) { return how + fmt::format(" {:.10f}", gap); };
    for (std::size_t i = 0; i < c.bodies.size(); ++i)
      for (std::size_t j = i + 1; j < c.bodies.size(); ++j) {
        std::vector<LammpsContact> contacts;
        const LammpsPair pair = lammps_rules(c, i, j).pair(c.body(i), c.body(j), {}, {}, &contacts);
        conservative = conservative && pair.conservative();
        CHECK(!pair.overflow);
        for (const LammpsContact& k : contacts) {
          found.insert(line(word(k.how), k.gap)), met.insert(word(k.how));
          if (!pair.parallel) CHECK((k.point - k.foot).norm() - c.shapes[i].radius - c.shapes[j].radius ==
              Approx(k.gap).margin(1e-12));
        }
      }
    for (const auto& k : c.expected["lammps"]["contacts"]) {
      const std::string how = k[4];
      expected.insert(line(how.starts_with("ja=") ? "ja=" : how, k[3]));
    }
    CHECK(found == expected);
    // mid points are no gradient elsewhere, here by chance they are
    if (c.name == "ee_rods_parallel") CHECK(!conservative);
    else CHECK(conservative == c.expected["minus_gradient_of_reported_energy"]["consistent"].get<bool>());
  }
  CHECK(met.size() == 4);
}

TEST_CASE("more touching contacts than LAMMPS has room for are reported", "[laws][rounded][lammps]") {
  const int n = 20;
  CoreMesh drum{{}, {}, {{}, {}}};
  for (int k = 0; k < 2 * n; ++k)
    drum.vertices.push_back({std::cos(k % n * 2 * pi / n), std::sin(k % n * 2 * pi / n), k < n ? -0.3 : 0.3});
  for (int k = 0; k < n; ++k) {
    drum.faces[0].insert(drum.faces[0].begin(), k), drum.faces[1].push_back(n + k);
    drum.faces.push_back({k, (k + 1) % n, n + (k + 1) % n, n + k});
  }
  REQUIRE(mistakes(drum, 0.2) == std::vector<std::string>{});
  const RoundedShape shape = rounded_shape(drum, 0.2);
  const LammpsRules rules{{100, 2, 0.3, RoundedKernel::Form::coded}};
  const RoundedBody below = placed(shape, Vec3::Zero(), quaternion({0, 0, 0}));
  CHECK(rules.pair(below, placed(shape, {0.001, 0.002, 0.95}, quaternion({0.001, 0.002, pi / n}))).overflow);
  CHECK(!rules.pair(below, placed(shape, {0.9, 0.02, 0.95}, quaternion({0.001, 0.002, pi / n}))).overflow);
}

TEST_CASE("damping acts on touching contacts only, along and across the normal", "[laws][rounded][lammps]") {
  const RoundedShape rod = rounded_shape(rod_core(2), 0.25), box = rounded_shape(box_core({2, 2, 1}), 0.25);
  const Eigen::Quaterniond tilt = quaternion({0, 0, 0.3}) * quaternion({0, 1.1, 0});
  const LammpsRules rules{{100, 2, 0.3, RoundedKernel::Form::coded}, 3, 5, 0, 1};
  for (const double gap : {-0.05, 0.05}) {
    const RoundedBody a{&rod, {{{0.1, 0.2, 0.5 + 0.5 + gap + std::sin(1.1)}, Vec3::Zero()}, tilt}}, b{&box, {}};
    const BodyMotion v{{0.3, -0.2, 0.4}, {0.5, 0.1, -0.7}};
    std::vector<LammpsContact> contacts;
    const LammpsPair still = rules.pair(a, b), moving = rules.pair(a, b, v, {}, &contacts);
    REQUIRE(contacts.size() == 1);
    const Vec3 arm = contacts[0].point - a.pose.position.hi, at = v.velocity + v.angular_velocity.cross(arm),
        f = moving.on[0].force - still.on[0].force;
    const Vec3 expected = gap < 0 ? Vec3(-5 * at.x(), -5 * at.y(), -3 * at.z()) : Vec3::Zero();
    CHECK((f - expected).norm() <= 1e-12);
    CHECK((moving.on[0].torque - still.on[0].torque - arm.cross(expected)).norm() <= 1e-12);
    CHECK((moving.on[0].force + moving.on[1].force).norm() == 0);
  }
}
