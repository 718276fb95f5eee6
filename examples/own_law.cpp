// A law of one's own: a bond that stiffens, U = K (r − r₀)² + Q (r − r₀)⁴, in a chain of three particles that a force pulls at its end. The
// formula and its derivatives are all it takes: Newton's method finds the equilibrium, a path would follow it.
#include "energy/energy.hpp"
#include "energy/law_group.hpp"
#include "laws/radial.hpp"
#include "solve/newton.hpp"

#include <cstdio>
#include <cstdlib>

using namespace elamin;

struct StiffeningBond {
  static constexpr int sites = 2;
  double K, Q, r0;

  double value(const Points<2>& x) const {
    const double e = x.edge(0, 1).hi.norm() - r0;
    return K * e * e + Q * e * e * e * e;
  }
  Local<2> derivatives(const Points<2>& x) const {
    const Vec3 d = x.edge(0, 1).hi;
    const double e = d.norm() - r0;
    return radial(d, value(x), 2 * K * e + 4 * Q * e * e * e, 2 * K + 12 * Q * e * e);      // U, f′ and f″ of f(r)
  }
};

int main() {
  const double K = 1, Q = 5, pull = 0.8;
  Model model;
  Field x = Field::Zero(3, 3);
  x.row(0) << 0, 1, 2;
  model.start = State(x);
  model.diameter.assign(3, 1.0), model.density.assign(3, 1.0);
  Support first;
  first.particles = {0};
  Load last;
  last.particles = {2}, last.force = Vec3(pull, 0, 0), last.scaling = Scaling::constant();
  model.supports = {first}, model.loads = {last};

  Energy energy(model);
  energy.add("stiffening", std::make_unique<LawGroup<StiffeningBond>>(std::vector{StiffeningBond{K, Q, 1.0}}, std::vector{0, 0},
                                                                       std::vector<std::array<int, 2>>{{0, 1}, {1, 2}}));
  State state = model.start;
  const Report report = Newton(energy).minimise(state);
  const double e = (state.at(2) - state.at(1)).hi.norm() - 1;
  std::printf("stretch %.15g, pull %.15g of %g\n", e, 2 * K * e + 4 * Q * e * e * e, pull);
  energy.terms(state).for_each([](const auto& name, double value) { std::printf("%s %.15g\n", std::string(name).c_str(), value); });
  return report.converged() && std::abs(2 * K * e + 4 * Q * e * e * e - pull) < 1e-12 * pull ? EXIT_SUCCESS : EXIT_FAILURE;
}
