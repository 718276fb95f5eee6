#include "laws/rounded/friction.hpp"

#include "catch.hpp"
#include "laws/rounded/bodies.hpp"

using namespace elamin;

TEST_CASE("damping and friction take energy, and leave momentum and angular momentum", "[laws][rounded]") {
  std::mt19937 random(29);
  for (const bool apart : {false, true})
    for (const double gap : {-0.05, 0.1}) {
      const RoundedFriction law{3, 5, 0.4, 100, 1e3, apart};
      const Couple c = couple(test_shapes()[3].shape, test_shapes()[2].shape, gap, random);
      std::vector<RoundedContact> contact;
      RoundedClosest{{100, 2, 0.3, RoundedKernel::Form::coded}}.contacts(c.a, c.b, contact);
      REQUIRE(contact.size() == 1);
      const Vec3 n = contact[0].normal;
      const BodyMotion va{random_vector(random), random_vector(random)}, vb{random_vector(random), random_vector(random)};
      const auto on = law.at(contact[0], c.a.pose, c.b.pose, va, vb);
      const Vec3 xa = c.a.pose.position.hi, xb = c.b.pose.position.hi;
      CHECK((on[0].force + on[1].force).norm() == 0);
      CHECK((on[0].torque + on[1].torque + xa.cross(on[0].force) + xb.cross(on[1].force)).norm() <= 1e-12);
      double power = 0;
      power += on[0].force.dot(va.velocity) + on[0].torque.dot(va.spin);
      power += on[1].force.dot(vb.velocity) + on[1].torque.dot(vb.spin);
      if (gap > 0 && !apart) CHECK(on[0].force.norm() == 0);
      else CHECK(power < 0);

      // By the formula: normal and tangential parts.
      const Vec3 v = va.at(contact[0].point - xa) - vb.at(contact[0].point - xb), vt = v - v.dot(n) * n;
      const bool normal = apart || gap < 0;
      CHECK(on[0].force.dot(n) == Approx(normal ? -3 * v.dot(n) : 0.0).margin(1e-12));
      const Vec3 sliding = on[0].force - on[0].force.dot(n) * n;
      const double expected = gap < 0 ? 5 * vt.norm() + 0.4 * 100 * 0.05 : 0.0;
      CHECK((sliding + expected * vt.normalized()).norm() <= 1e-10);

      // Slow: the regularised friction, proportional to the velocity; at rest nothing.
      const double slow = 1e-6;
      const auto creep = law.at(contact[0], c.a.pose, c.b.pose, {slow * vt, Vec3::Zero()}, {});
      CHECK((creep[0].force + (gap < 0 ? (5 + 1e3) * slow : 0.0) * vt).norm() <= 1e-12);
      CHECK(law.at(contact[0], c.a.pose, c.b.pose, {}, {})[0].force.norm() == 0);
    }
}
