#include "catch.hpp"
#include "chain.hpp"
#include "path/continuation.hpp"

using namespace elamin;

namespace {

// Von Mises truss: two bars of length 1 at angle α to the base, apex pushed down; a bar is a harmonic bond, EA = 2K.
Model truss(double degrees, bool plane_symmetric) {
  const double a = degrees * 3.14159265358979323846 / 180;
  Model m;
  m.start.position = Field::Zero(3, 3), m.start.low = Field::Zero(3, 3);
  m.start.position.col(0) << -std::cos(a), 0, 0;
  m.start.position.col(1) << 0, 0, std::sin(a);
  m.start.position.col(2) << std::cos(a), 0, 0;
  const double length = std::hypot(std::cos(a), std::sin(a));
  m.bond_types = {{0.5, length}};
  m.bonds = {{0, {0, 1}}, {0, {1, 2}}};
  m.diameter.assign(3, 1), m.density.assign(3, 1), m.id = {1, 2, 3}, m.type.assign(3, 1), m.molecule.assign(3, 1);
  m.plane_normal = 1;
  hold(m, 0, 0), hold(m, 2, 2);
  if (plane_symmetric) hold(m, 1, 1, {true, false, false});
  m.loads.push_back({"", {1}, Vec3(0, 0, -1), Scaling()});
  return m;
}

}  // namespace

TEST_CASE("the limit point of a shallow truss, and the snap", "[path]") {
  for (const double degrees : {10.0, 20.0, 30.0})
    for (const int steps : {1, 7, 100}) {
      const Model model = truss(degrees, true);
      Energy energy(model);
      Newton newton(energy);
      const double a = degrees * 3.14159265358979323846 / 180;
      const double limit = 2 * std::pow(1 - std::pow(std::cos(a), 2.0 / 3), 1.5);      // F_max/EA
      Continuation path(newton, model.start, {.from = 0, .to = 1.5 * limit, .steps = steps, .when_unstable = WhenUnstable::jump, .start = {}, .stops = {}});
      INFO(degrees << "° in " << steps << " steps");
      int limits = 0;
      std::optional<PathPoint> last;
      while (auto point = path.next()) {
        if (point->label == "limit:1") {
          ++limits;
          CHECK(point->state.load_factor == Approx(limit).epsilon(1e-9));
          CHECK(point->multiplicity == 1);
        }
        last = point;
      }
      CHECK(limits == 1);
      CHECK(path.status() == Status::converged);
      CHECK(last->state.position(2, 1) < 0);                                          // snapped through
      CHECK(last->stability.negative == 0);
    }
}

TEST_CASE("load steps stop at a limit point when asked to, and cannot follow", "[path]") {
  const Model model = truss(20, true);
  Energy energy(model);
  Newton newton(energy);
  for (const WhenUnstable how : {WhenUnstable::stop, WhenUnstable::follow}) {
    Continuation path(newton, model.start, {.from = 0, .to = 1, .steps = 100, .when_unstable = how, .start = {}, .stops = {}});
    std::optional<PathPoint> last;
    while (auto point = path.next()) last = point;
    CHECK(last->label == "limit:1");
    CHECK(path.status() == (how == WhenUnstable::stop ? Status::converged : Status::not_converged));
  }
}

TEST_CASE("a path is the same from any stored point on", "[path]") {
  Model model = chain(14, 1, 0.05, 1);
  model.plane_normal = 1;
  hold(model, 0, 1), hold(model, 12, 13, {true, true, true}, Vec3(0, 0, -2));
  Energy energy(model);
  Newton newton(energy);
  const PathOptions options{.from = 0, .to = 1, .steps = 10, .when_unstable = WhenUnstable::jump, .start = {}, .stops = {}};
  Continuation whole(newton, model.start, options);
  std::vector<PathPoint> points;
  while (auto point = whole.next()) points.push_back(*point);
  REQUIRE(whole.status() == Status::converged);
  const PathPoint& middle = points[points.size() - 4];
  PathOptions rest = options;
  rest.start = middle.state.load_factor;
  Continuation again(newton, middle.state, rest);
  again.next();                                                                       // the stored point itself
  for (std::size_t k = points.size() - 3; k < points.size(); ++k) {
    const auto point = again.next();
    REQUIRE(point);
    CHECK(point->state.load_factor == points[k].state.load_factor);
    CHECK(point->energy.total() == Approx(points[k].energy.total()).epsilon(1e-14));
    CHECK((point->state.position - points[k].state.position).cwiseAbs().maxCoeff() <= 1e-12);
  }
}
