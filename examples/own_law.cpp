// A law of one's own: a bond that stiffens, U = K (r − r₀)² + Q (r − r₀)⁴, in a chain of three particles pulled at its
// end. Formula, derivatives and a group are all it takes; assembly and everything above it know laws by their concept
// only.
#include "energy/law_group.hpp"

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
    const double r = d.norm(), e = r - r0;
    const Vec3 n = d / r;
    const double f1 = 2 * K * e + 4 * Q * e * e * e, f2 = 2 * K + 12 * Q * e * e;      // f′, f″ of f(r)
    Local<2> u;
    u.value = value(x);
    u.force_part(1) = f1 * n;
    u.force_part(0) = -f1 * n;
    const Mat3 nn = n * n.transpose();
    const Mat3 h = f2 * nn + f1 / r * (Mat3::Identity() - nn);
    u.block(0, 0) = u.block(1, 1) = h;
    u.block(0, 1) = u.block(1, 0) = -h;
    return u;
  }
};

int main() {
  const LawGroup<StiffeningBond> group({{1.0, 5.0, 1.0}}, {0, 0}, {{0, 1}, {1, 2}});
  Field x = Field::Zero(3, 3);
  x.row(0) << 0, 1.1, 2.3;
  double values[2], gradients[12];
  group.derivatives(State(x), {}, values, gradients, nullptr);
  std::printf("energies %.15g %.15g, force on the last particle %.15g\n", values[0], values[1], -gradients[9]);
  const double e = 0.2;                                   // stretch of the second bond
  const bool right = std::abs(gradients[9] - (2 * e + 20 * e * e * e)) < 1e-14;
  return right ? EXIT_SUCCESS : EXIT_FAILURE;
}
