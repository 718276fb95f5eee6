#include "catch.hpp"
#include "laws/rounded/check_pair.hpp"
#include "laws/rounded/multi.hpp"
#include "laws/rounded/reference_bodies.hpp"

using namespace elamin;

namespace {

using Form = RoundedKernel::Form;

const RoundedKernel quartic{100, 4, 0.3, Form::coded};

/// The nearest features of two bodies, by kind: "vf", "ee", …; empty: too far.
std::string kinds(const Couple& c) {
  std::vector<RoundedContact> contact;
  RoundedClosest{{1, 1, 1, Form::coded}}.contacts(c.a, c.b, contact);
  if (contact.empty()) return {};
  const std::string letters = "vef";
  std::string k{letters[static_cast<int>(contact[0].first.kind)], letters[static_cast<int>(contact[0].second.kind)]};
  std::sort(k.begin(), k.end());
  return k;
}

/// Calls f with couples of every two shapes at this gap.
template <class F>
void for_couples(double gap, int each, const F& f) {
  std::mt19937 random(7);
  for (const NamedShape& a : test_shapes())
    for (const NamedShape& b : test_shapes())
      for (int k = 0; k < each; ++k) {
        INFO(a.name << " and " << b.name << ", gap " << gap << ", " << k);
        f(couple(a.shape, b.shape, gap, random));
      }
}

/// RoundedMulti that forgets how the turns of the two bodies act together.
struct WithoutLever {
  RoundedMulti law;
  double value(const RoundedBody& a, const RoundedBody& b) const { return law.value(a, b); }
  PairLocal derivatives(const RoundedBody& a, const RoundedBody& b) const {
    PairLocal u = law.derivatives(a, b);
    u.block(1, 3).setZero(), u.block(3, 1).setZero();
    return u;
  }
};

}  // namespace

TEST_CASE("rounded bodies have the energies, forces and torques of the reference", "[laws][rounded]") {
  for (const ReferenceCase& c : static_cases()) {
    INFO(c.name);
    for (std::size_t k = 0; k < c.bodies.size(); ++k)
      CHECK(mistakes(c.bodies[k].core, c.bodies[k].radius) == std::vector<std::string>{});
    const nlohmann::json& p = c.expected["potential"];
    const bool unique = p["closest"]["contact_unique"].get<bool>();
    CHECK(wrenches(c, RoundedMulti{}, Form::coded).off(p["multi"]) <= 2e-12);   // with the gates of the reference
    CHECK(wrenches(c, RoundedClosest{}, Form::coded).off(p["closest"], unique) <= 2e-12);
    CHECK(wrenches(c, RoundedClosest{}, Form::printed).off(p["closest_printed_law"], unique) <= 2e-12);
  }
}

TEST_CASE("contact lists name kind, gap and weight of the reference", "[laws][rounded]") {
  std::map<std::string, int> met;
  for (const ReferenceCase& c : static_cases()) {
    INFO(c.name);
    std::vector<std::pair<double, double>> found, expected;
    std::multiset<std::string> found_kinds, expected_kinds;
    for (std::size_t i = 0; i < c.bodies.size(); ++i)
      for (std::size_t j = i + 1; j < c.bodies.size(); ++j) {
        std::vector<RoundedContact> contacts;
        RoundedMulti law;
        law.kernel = c.kernel(i, j);
        law.contacts(c.body(i), c.body(j), contacts);
        for (const RoundedContact& k : contacts) {
          found.emplace_back(k.gap, k.weight);
          const int sum = static_cast<int>(k.first.kind) + static_cast<int>(k.second.kind);
          const bool edges = k.first.kind == FeatureKind::edge && k.second.kind == FeatureKind::edge;
          found_kinds.insert(edges ? "EE" : std::vector<std::string>{"VV", "VE", "VF"}[sum]);
        }
      }
    for (const auto& k : c.expected["potential"]["multi"]["contacts"]) {
      expected.emplace_back(k[3].get<double>(), k[4].get<double>());
      expected_kinds.insert(k[0].get<std::string>().substr(0, 2));
    }
    for (const std::string& k : found_kinds) ++met[k];
    CHECK(found_kinds == expected_kinds);
    std::sort(found.begin(), found.end()), std::sort(expected.begin(), expected.end());
    REQUIRE(found.size() == expected.size());
    for (std::size_t k = 0; k < found.size(); ++k) {
      CHECK(std::abs(found[k].first - expected[k].first) <= 1e-13);
      if (found[k].first != Approx(-0.05905881177476435))
        CHECK(std::abs(found[k].second - expected[k].second) <= 1e-10);
    }
  }
  CHECK(met.size() == 4);
}

TEST_CASE("the potentials of rounded bodies agree with differences of themselves", "[laws][rounded]") {
  std::map<std::string, int> met;
  for (const double gap : {-0.08, 0.1})
    for_couples(gap, 6, [&](const Couple& c) {
      ++met[kinds(c)];
      for (const Form form : {Form::coded, Form::printed}) {
        RoundedKernel k = quartic;
        k.form = form;
        CHECK(check_pair(RoundedClosest{k}, c, 1e-2) == std::vector<std::string>{});
        CHECK(check_pair(RoundedMulti{k}, c, 1e-3) == std::vector<std::string>{});
      }
    });
  for (const std::string kind : {"vv", "ev", "fv", "ee"}) CHECK(met[kind] >= 10);
}

TEST_CASE("a wrong law of rounded bodies fails the check", "[laws][rounded]") {
  int failed = 0, all = 0;
  for_couples(-0.08, 1, [&](const Couple& c) {
    // of a sphere nothing is forgotten
    const bool turns = c.a.shape->vertices.size() > 1 && c.b.shape->vertices.size() > 1;
    all += turns, failed += !check_pair(WithoutLever{{quartic}}, c, 1e-3).empty();
    if (!turns) CHECK(check_pair(WithoutLever{{quartic}}, c, 1e-3) == std::vector<std::string>{});
  });
  CHECK(failed == all);
}

TEST_CASE("overlapping cores have the smallest translation that separates them", "[laws][rounded]") {
  std::map<std::string, int> met;
  for_couples(0, 4, [&](Couple c) {
    if (c.a.shape->faces.empty() && c.b.shape->faces.empty()) return;   // points and segments have no inside
    std::mt19937 random(3);
    c = couple(*c.a.shape, *c.b.shape, -c.a.shape->radius - c.b.shape->radius - 0.1, random);
    CHECK(cores_overlap(c.a, c.b));
    std::vector<RoundedContact> contact;
    RoundedClosest{quartic}.contacts(c.a, c.b, contact);
    REQUIRE(contact.size() == 1);
    const double depth = -core_separation(c.a, c.b);
    CHECK(depth == Approx(0.1).epsilon(1e-12));
    ++met[kinds(c)];
    CHECK(check_pair(RoundedClosest{quartic}, c, 1e-2) == std::vector<std::string>{});
    Couple apart = c;
    apart.a.pose.position.hi += depth * contact[0].normal;
    CHECK(std::abs(core_separation(apart.a, apart.b)) <= 1e-14);
    for (int k = 0; k < 200; ++k) {                                    // no shorter one
      apart.a.pose.position.hi = c.a.pose.position.hi + 0.99 * depth * random_vector(random).normalized();
      CHECK(cores_overlap(apart.a, apart.b));
    }
  });
  CHECK(met["fv"] >= 10);
  CHECK(met["ee"] >= 5);
}

TEST_CASE("a particle is a body of one vertex: both potentials are one, and no torque acts on it", "[laws][rounded]") {
  std::mt19937 random(31);
  const RoundedShape particle = rounded_shape(point_core(), 0.3);
  for (const NamedShape& s : test_shapes())
    for (const double gap : {-0.1, 0.1}) {
      INFO(s.name << ", gap " << gap);
      const Couple c = couple(particle, s.shape, gap, random);
      const PairLocal m = RoundedMulti{quartic}.derivatives(c.a, c.b), u = RoundedClosest{quartic}.derivatives(c.a, c.b);
      CHECK(m.value == Approx(quartic.value(gap)).epsilon(1e-10));
      CHECK(std::abs(m.value - u.value) <= 1e-14);
      CHECK((m.hessian - u.hessian).norm() <= 1e-12 * u.hessian.norm());
      for (PairLocal local : {m, u}) {
        CHECK(local.force_part(1).norm() <= 1e-14 * local.gradient.norm());
        CHECK(local.hessian.middleRows<3>(3).norm() <= 1e-14 * local.hessian.norm());
        CHECK(local.force_part(0).norm() > 0);
      }
    }
}
