// Where the nearest features change, and what changes nothing.
#include "catch.hpp"
#include "laws/rounded/check_pair.hpp"
#include "laws/rounded/multi.hpp"

#include <map>

using namespace elamin;

namespace {

using Vec12 = Eigen::Matrix<double, 12, 1>;

const RoundedKernel kernel{100, 4, 0.3, RoundedKernel::Form::coded};

struct Pairing {
  Feature first, second;
  bool operator==(const Pairing&) const = default;
};

Pairing pairing(const Couple& c) {
  std::vector<RoundedContact> contact;
  RoundedClosest{{1, 1, 1, RoundedKernel::Form::coded}}.contacts(c.a, c.b, contact);
  return contact.empty() ? Pairing{{}, {FeatureKind::vertex, -1}} : Pairing{contact[0].first, contact[0].second};
}

/// Whether the contact is at quite another place.
bool leaps(const Couple& c, const Couple& d) {
  std::vector<RoundedContact> contact;
  const RoundedClosest law{{1, 1, 1, RoundedKernel::Form::coded}};
  law.contacts(c.a, c.b, contact), law.contacts(d.a, d.b, contact);
  return (contact.at(0).point - contact.at(1).point).norm() > 1e-3;
}

std::string kinds(const Pairing& p) {
  const std::string letters = "vef";
  std::string k{letters[static_cast<int>(p.first.kind)], letters[static_cast<int>(p.second.kind)]};
  std::sort(k.begin(), k.end());
  return k;
}

Vec12 random_motion(std::mt19937& random) {
  Vec12 m;
  for (int k = 0; k < 4; ++k) m.segment<3>(3 * k) = random_vector(random);
  return m.normalized();
}

/// The largest excess of |Δg| over 2 |Δ| max|∇²E|, and of the energy over what the gradients at the ends of a step
/// leave open, on a straight motion; both negative if E is C¹ with second derivatives as given.
template <class L>
double jump(const L& law, const Couple& from, const Vec12& motion, int steps) {
  const double size = from.a.shape->bounding_radius() + from.b.shape->bounding_radius();
  const AtPoses<L> at{law, from, size};
  std::vector<PairLocal> u;
  double bend = 0;
  for (int k = 0; k <= steps; ++k) {
    Points<4> x;
    for (int s = 0; s < 4; ++s) x.position.col(s) = (s % 2 ? size : 1.0) * motion.segment<3>(3 * s) * k / steps;
    u.push_back(at.derivatives(x));
    bend = std::max(bend, u.back().hessian.norm());
  }
  Vec12 step = motion / steps;
  step.segment<3>(3) *= size, step.segment<3>(9) *= size;
  double worst = -1e300;
  for (int k = 0; k < steps; ++k) {
    const double allowed = 2 * step.norm() * bend;
    worst = std::max(worst, (u[k + 1].gradient - u[k].gradient).norm() / allowed - 1);
    const double open = u[k + 1].value - u[k].value - (u[k].gradient + u[k + 1].gradient).dot(step) / 2;
    worst = std::max(worst, std::abs(open) / (allowed * step.norm()) - 1);
  }
  return worst;
}

/// One box on another, faces turned by a small angle against each other about an axis in the face.
Couple resting_boxes(double angle) {
  static const RoundedShape box = rounded_shape(box_core({1.0, 0.8, 1.3}), 0.1);
  const Vec3 axis = Vec3(0.6, 0.8, 0);
  return {placed(box, {0.013, -0.021, 1.3 + 0.2 - 0.03}, quaternion(angle * axis) * quaternion({0, 0, 0.3})),
      placed(box, Vec3::Zero(), quaternion({0, 0, 0}))};
}

}  // namespace

TEST_CASE("near the borders of features the derivatives hold, and across them the potentials are continuous",
    "[laws][rounded]") {
  std::mt19937 random(11);
  std::map<std::string, int> met;
  for (const NamedShape& a : test_shapes())
    for (const NamedShape& b : test_shapes())
      for (int k = 0; k < 40; ++k) {
        const Couple c = couple(a.shape, b.shape, k % 2 ? -0.06 : 0.05, random);
        const Vec12 motion = random_motion(random);
        const Pairing start = pairing(c);
        double lo = 0, hi = 0;
        while (hi < 0.3 && pairing(moved(c, hi * motion)) == start) lo = hi, hi += 0.01;
        if (hi >= 0.3) continue;                                       // no border on this way
        for (int m = 0; m < 60; ++m) (pairing(moved(c, (lo + hi) / 2 * motion)) == start ? lo : hi) = (lo + hi) / 2;
        const std::string border = kinds(start) + " to " + kinds(pairing(moved(c, hi * motion)));
        INFO(a.name << " and " << b.name << ", " << k << ": " << border);
        ++met[border];
        for (const double side : {-1e-3, 1e-3}) {
          const Couple near = moved(c, (lo + side) * motion);
          CHECK(check_pair(RoundedClosest{kernel}, near, 3e-4) == std::vector<std::string>{});
          CHECK(check_pair(RoundedMulti{kernel}, near, 3e-4) == std::vector<std::string>{});
        }
        const double d = 1e-7;
        // An edge that turns past parallel to a face or edge: the closest point leaps from one end of it, and the
        // gradient with it.
        if (!leaps(moved(c, lo * motion), moved(c, hi * motion)))
          CHECK(jump(RoundedClosest{kernel}, moved(c, (lo - d) * motion), 2 * d * motion, 1) <= 0);
        CHECK(jump(RoundedMulti{kernel}, moved(c, (lo - d) * motion), 2 * d * motion, 1) <= 0);
      }
  for (const std::string border : {"vv to ev", "ev to vv", "ev to fv", "fv to ev", "ev to ee", "ee to ev"}) {
    INFO(border);
    CHECK(met[border] >= 5);
  }
}

TEST_CASE("along long ways the potentials of rounded bodies are C¹", "[laws][rounded]") {
  std::mt19937 random(13);
  for (const NamedShape& a : test_shapes())
    for (const NamedShape& b : test_shapes()) {
      INFO(a.name << " and " << b.name);
      const Couple c = couple(a.shape, b.shape, -0.05, random);
      Vec12 motion = random_motion(random);
      motion.segment<3>(6) = motion.segment<3>(0);                     // turning on each other, not flying apart
      CHECK(jump(RoundedMulti{kernel}, c, motion, 4000) <= 0);
    }
}

TEST_CASE("a box that tips over a face: multi is C¹, closest has a kink", "[laws][rounded]") {
  const Couple c = resting_boxes(-0.05);
  Vec12 motion = Vec12::Zero();
  motion.segment<3>(3) = 0.1 * Vec3(0.6, 0.8, 0);
  CHECK(jump(RoundedMulti{kernel}, c, motion, 4001) <= 0);
  CHECK(jump(RoundedClosest{kernel}, c, motion, 4001) > 1);
}

TEST_CASE("a motion of the whole, the order of two bodies and the unit of length change nothing", "[laws][rounded]") {
  std::mt19937 random(17);
  const auto check = [&](const auto& law, const auto& law_at_scale, const Couple& c) {
    const PairLocal u = law.derivatives(c.a, c.b);
    REQUIRE(u.gradient.norm() > 0);

    const Eigen::Quaterniond Q = random_rotation(random);
    Couple turned = c;
    for (RoundedBody* body : {&turned.a, &turned.b}) {
      body->pose.position = {Q * body->pose.position.hi, Vec3::Zero()};
      body->pose.rotation = Q * body->pose.rotation;
    }
    const PairLocal v = law.derivatives(turned.a, turned.b);
    CHECK(std::abs(v.value - u.value) <= 1e-12 * u.gradient.norm());
    Eigen::Matrix<double, 12, 12> R = Eigen::Matrix<double, 12, 12>::Zero();
    for (int k = 0; k < 4; ++k) R.block<3, 3>(3 * k, 3 * k) = Q.toRotationMatrix();
    CHECK((v.gradient - R * u.gradient).norm() <= 1e-12 * (u.gradient.norm() + u.hessian.norm()));
    CHECK((v.hessian - R * u.hessian * R.transpose()).norm() <= 1e-10 * u.hessian.norm());

    Couple far = c;
    for (RoundedBody* body : {&far.a, &far.b})
      body->pose.position = body->pose.position + ExactVector{Vec3(1e9, -1e9, 1e9), Vec3::Zero()};
    CHECK((law.derivatives(far.a, far.b).gradient - u.gradient).norm() <=
        1e-14 * (u.gradient.norm() + u.hessian.norm()));

    const PairLocal w = law.derivatives(c.b, c.a);
    CHECK(std::abs(w.value - u.value) <= 1e-13 * u.gradient.norm());
    const Vec12 other = (Vec12() << w.gradient.tail<6>(), w.gradient.head<6>()).finished();
    CHECK((other - u.gradient).norm() <= 1e-12 * (u.gradient.norm() + u.hessian.norm()));

    for (const double s : {1e-3, 1e3}) {
      const RoundedShape a = scaled(*c.a.shape, s), b = scaled(*c.b.shape, s);
      const PairLocal z = law_at_scale(s).derivatives(placed(a, s * c.a.pose.position.hi, c.a.pose.rotation),
          placed(b, s * c.b.pose.position.hi, c.b.pose.rotation));
      CHECK(std::abs(z.value / (s * s) - u.value) <= 1e-12 * u.gradient.norm());
      CHECK((z.gradient.head<3>() / s - u.gradient.head<3>()).norm() <= 1e-12 * (u.gradient.norm() + u.hessian.norm()));
      CHECK((z.gradient.segment<3>(3) / (s * s) - u.gradient.segment<3>(3)).norm() <=
          1e-12 * (u.gradient.norm() + u.hessian.norm()));
    }
  };
  const auto at_scale = [](double s) { return RoundedKernel{100, 4, 0.3 * s, RoundedKernel::Form::coded}; };
  for (const NamedShape& a : test_shapes())
    for (const NamedShape& b : test_shapes())
      for (const double gap : {-0.08, 0.1}) {
        INFO(a.name << " and " << b.name << ", gap " << gap);
        const Couple c = couple(a.shape, b.shape, gap, random);
        check(RoundedMulti{kernel}, [&](double s) { return RoundedMulti{at_scale(s)}; }, c);
        check(RoundedClosest{kernel}, [&](double s) { return RoundedClosest{at_scale(s)}; }, c);
      }
}

TEST_CASE("aligned boxes have finite derivatives and the energy of their corners", "[laws][rounded]") {
  const RoundedShape cube = rounded_shape(cube_core(1), 0.1);
  const RoundedBody below = placed(cube, Vec3::Zero(), Eigen::Quaterniond::Identity());
  const RoundedBody above = placed(cube, {0, 0, 1.15}, Eigen::Quaterniond::Identity());
  const double U = kernel.value(-0.05);
  const PairLocal m = RoundedMulti{kernel}.derivatives(below, above),
      c = RoundedClosest{kernel}.derivatives(below, above);
  // four corners on four corners, each met twice with weight ½
  CHECK(m.value == Approx(4 * U).epsilon(1e-12));
  CHECK(m.gradient[8] == Approx(4 * kernel.slope(-0.05)).epsilon(1e-12));
  CHECK(m.gradient.segment<3>(3).norm() <= 1e-12);
  CHECK(c.value == Approx(U).epsilon(1e-12));
  CHECK(m.hessian.allFinite());
  CHECK(c.hessian.allFinite());
  // on itself, face on face
  for (const RoundedBody& same : {below, placed(cube, {1, 0, 0}, Eigen::Quaterniond::Identity())}) {
    CHECK(RoundedMulti{kernel}.derivatives(below, same).hessian.allFinite());
    CHECK(RoundedClosest{kernel}.derivatives(below, same).hessian.allFinite());
  }
}

TEST_CASE("edges that are nearly parallel: the distance keeps its digits", "[laws][rounded]") {
  const RoundedShape rod = rounded_shape(rod_core(2), 0.2);
  const double h = 0.35;
  const Eigen::Quaterniond Q = quaternion({0.4, -0.7, 0.2});
  for (double angle = 0.3; angle > 1e-18; angle /= 3) {
    INFO("angle " << angle);
    const RoundedBody a = placed(rod, Vec3::Zero(), Q), b = placed(rod, Q * Vec3(0.8, 0, h), Q * quaternion({0, 0, angle}));
    CHECK(std::abs(core_separation(a, b) - h) <= 1e-13);
    const PairLocal u = RoundedClosest{kernel}.derivatives(a, b);
    CHECK(u.hessian.allFinite());
    CHECK((u.gradient.segment<3>(0) + kernel.slope(h - 0.4) * (Q * Vec3::UnitZ())).norm() <= 1e-6);
    // Below the gate of the angle an end of each rod at the side of the other; the far ends are out of contact_distance.
    const double U = kernel.value(h - 0.4), m = RoundedMulti{kernel}.value(a, b);
    if (angle < 1e-4) CHECK(m == Approx(2 * U).epsilon(1e-6));
    CHECK(RoundedMulti{kernel}.derivatives(a, b).hessian.allFinite());
  }
}
