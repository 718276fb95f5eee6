#include "laws/rounded/friction.hpp"

#include "catch.hpp"
#include "laws/rounded/bodies.hpp"
#include "laws/rounded/multi.hpp"

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
      power += on[0].force.dot(va.velocity) + on[0].torque.dot(va.angular_velocity);
      power += on[1].force.dot(vb.velocity) + on[1].torque.dot(vb.angular_velocity);
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

TEST_CASE("forces of bodies are minus the gradient, their contacts those of contacts()", "[laws][rounded]") {
  std::mt19937 random(11);
  const RoundedKernel kernel{100, 2, 0.3, RoundedKernel::Form::coded};
  int met = 0, edges = 0;
  const auto check = [&](const auto& law, const RoundedBody& a, const RoundedBody& b) {
    std::vector<RoundedContact> with, listed;
    const std::array<Wrench, 2> on = law.forces(a, b, &with);
    const PairLocal u = law.derivatives(a, b);
    law.contacts(a, b, listed);
    Eigen::Matrix<double, 12, 1> f;
    f << on[0].force, on[0].torque, on[1].force, on[1].torque;
    CHECK((f + u.gradient).norm() <= 1e-12 * std::max(1.0, u.gradient.norm()));
    CHECK(law.forces(a, b)[0].force == on[0].force);
    REQUIRE(with.size() == listed.size());
    Vec3 force = Vec3::Zero();                                        // of all contacts on A
    for (std::size_t k = 0; k < with.size(); ++k) {
      CHECK(with[k].gap == listed[k].gap);
      CHECK(with[k].weight == listed[k].weight);
      CHECK(with[k].point == listed[k].point);
      CHECK(with[k].gate == listed[k].gate);
      force += -with[k].weight * kernel.slope(with[k].gap) * with[k].normal + kernel.value(with[k].gap) * with[k].gate;
      edges += with[k].first.kind == FeatureKind::edge && with[k].second.kind == FeatureKind::edge && with[k].weight < 1;
    }
    CHECK((force - on[0].force).norm() <= 1e-12 * std::max(1.0, on[0].force.norm()));
    met += !with.empty();
  };
  for (const NamedShape& a : test_shapes())
    for (const NamedShape& b : test_shapes())
      for (int k = 0; k < 40; ++k) {
        const RoundedBody one = placed(a.shape, Vec3::Zero(), random_rotation(random));
        const double far = std::uniform_real_distribution<double>(0.7, 1)(random) * (a.shape.bounding_radius() + b.shape.bounding_radius());
        const RoundedBody two = placed(b.shape, far * random_vector(random).normalized(), random_rotation(random));
        if (cores_overlap(one, two)) continue;
        check(RoundedMulti{kernel}, one, two), check(RoundedClosest{kernel}, one, two);
      }
  CHECK(met > 300);
  CHECK(edges > 20);
}
