// Proves again what `elamin prove` has written into a proof.json: that there is exactly one equilibrium in the ball, how near the stored
// state is to it, how many negative eigenvalues its Hessian has and which contacts are closed. All that is taken from elamin are the laws
// in intervals, src/proof/laws.hpp; of the file it takes the structure, the centre and the claim, not the bounds. See docs/proofs.md.
//   check_proof PROOF.json
#include "proof/laws.hpp"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>

using namespace elamin;
using Json = nlohmann::json;
using D = Interval<double>;
using Q = Interval<Quad>;

struct Refuted : std::runtime_error { using std::runtime_error::runtime_error; };

/// A place as the sum of two doubles for each coordinate.
struct Place { double x[3], low[3]; };

struct Proof {
  Json file;
  std::vector<Place> centre, state;
  std::vector<std::array<int, 3>> dof;
  int dofs = 0;
  double radius, moved;
  int negative;

  explicit Proof(const char* name) : file(Json::parse(std::ifstream(name))) {
    const Json& t = file.at("theorem");
    radius = t.at("radius"), moved = t.at("moved"), negative = t.at("negative");
    for (const auto& [key, places] : {std::pair("centre", &centre), {"state", &state}})
      for (const Json& p : file.at(key)) places->push_back({{p[0], p[1], p[2]}, {p[3], p[4], p[5]}});
    dof = file.at("structure").at("dofs").get<std::vector<std::array<int, 3>>>();
    for (const auto& of : dof)
      for (const int d : of) dofs = std::max(dofs, d + 1);
    if (centre.size() != dof.size() || state.size() != dof.size()) throw Refuted("there are not as many places as particles");
  }

  /// x_j − x_i, or x_j (i = −1), for all points within `ball` of the centre; √2 < 1.5.
  template <class I>
  Vector3<I> edge(int i, int j, double ball) const {
    Vector3<I> d;
    for (int c = 0; c < 3; ++c) {
      const Place &to = centre[j], &from = centre[std::max(i, 0)];
      d[c] = i < 0 ? I(to.x[c]) + I(to.low[c]) : (I(to.x[c]) - I(from.x[c])) + (I(to.low[c]) - I(from.low[c]));
      if (dof[j][c] >= 0 || (i >= 0 && dof[i][c] >= 0)) d[c] += I(-ball, ball) * I(i < 0 ? 1.0 : 1.5);
    }
    return d;
  }

  /// Calls with_edge(law, i, j), with_edges(law, particles), at_wall(law, i) for every element.
  template <class E, class A, class W>
  void for_each(const E& with_edge, const A& with_edges, const W& at_wall) const {
    const auto elements = [&](const char* kind, const auto& use) {
      const Json& of = file.at("structure").at(kind);
      const auto laws = of.at("laws").get<std::vector<std::vector<double>>>();
      for (const Json& e : of.at("elements")) use(laws.at(e[0].get<std::size_t>()), e);
    };
    elements("bonds", [&](const auto& l, const Json& e) { with_edge(proof::Bond{l[0], l[1], l[2]}, e[1].get<int>(), e[2].get<int>()); });
    elements("contacts", [&](const auto& l, const Json& e) { with_edge(proof::Contact{l[0], l[1]}, e[1].get<int>(), e[2].get<int>()); });
    elements("angles", [&](const auto& l, const Json& e) {
      with_edges(proof::Angle{l[0], l[1], l[2], static_cast<int>(l[3])}, std::array<int, 3>{e[1], e[2], e[3]});
    });
    elements("planes", [&](const auto& l, const Json& e) {
      at_wall(proof::Plane{l[0], l[1], Vec3(l[2], l[3], l[4]), Vec3(l[5], l[6], l[7])}, e[1].get<int>());
    });
    elements("rounds", [&](const auto& l, const Json& e) {
      at_wall(proof::Round{l[0], l[1], l[2], Vec3(l[3], l[4], l[5]), static_cast<int>(l[6]), l[7] != 0}, e[1].get<int>());
    });
  }
};

double norm(const std::vector<Q>& v) {
  Q sum;
  for (const Q& x : v) sum += square(x);
  return D(sqrt(sum)).hi;
}

std::vector<Q> gradient(const Proof& p) {
  std::vector<Q> g(p.dofs);
  const auto add = [&](int at, const Vector3<Q>& f) {
    for (int c = 0; c < 3; ++c)
      if (p.dof[at][c] >= 0) g[p.dof[at][c]] += f[c];
  };
  p.for_each(
      [&](const auto& law, int i, int j) {
        const Vector3<Q> f = derivatives<Q>(law, p.edge<Q>(i, j, 0), false).gradient;
        add(j, f), add(i, -f);
      },
      [&](const proof::Angle& law, const std::array<int, 3>& at) {
        const auto f = derivatives<Q>(law, p.edge<Q>(at[0], at[1], 0), p.edge<Q>(at[1], at[2], 0), false);
        add(at[0], -f.u), add(at[1], f.u - f.w), add(at[2], f.w);
      },
      [&](const auto& law, int i) { add(i, derivatives<Q>(law, p.edge<Q>(-1, i, 0), false).gradient); });
  const Json& s = p.file.at("structure");
  const Q load_factor(s.at("load_factor").get<double>());
  for (const Json& l : s.at("loads")) {
    const Q part = Q(l[4].get<double>()) + Q(l[5].get<double>()) * load_factor;
    add(l[0], -part * Vector3<Q>(Q(l[1].get<double>()), Q(l[2].get<double>()), Q(l[3].get<double>())));
  }
  return g;
}

/// Row i of the lower triangle by columns.
using Rows = std::vector<std::map<int, D>>;

Rows hessian(const Proof& p, double ball) {
  Rows h(p.dofs);
  for (int i = 0; i < p.dofs; ++i) h[i][i] = D(0);
  const auto add = [&](int a, int b, const Matrix3<D>& block) {     // ∂²E/∂x_a∂x_b; every pair (a, b) and (b, a) comes
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c)
        if (const int i = p.dof[a][r], j = p.dof[b][c]; j >= 0 && i >= j) h[i][j] += block(r, c);
  };
  p.for_each(
      [&](const auto& law, int i, int j) {
        const Matrix3<D> b = derivatives<D>(law, p.edge<D>(i, j, ball), true).hessian;
        add(i, i, b), add(j, j, b), add(i, j, -b), add(j, i, -b);
      },
      [&](const proof::Angle& law, const std::array<int, 3>& at) {
        const auto d = derivatives<D>(law, p.edge<D>(at[0], at[1], ball), p.edge<D>(at[1], at[2], ball), true);
        const Matrix3<D> wu = d.uw.transpose();
        const Matrix3<D> middle = d.uu - d.uw - wu + d.ww;
        const Matrix3<D> blocks[3][3] = {{d.uu, d.uw - d.uu, -d.uw}, {wu - d.uu, middle, d.uw - d.ww}, {-wu, wu - d.ww, d.ww}};
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) add(at[r], at[c], blocks[r][c]);
      },
      [&](const auto& law, int i) { add(i, i, derivatives<D>(law, p.edge<D>(-1, i, ball), true).hessian); });
  return h;
}

/// M − σI ≈ LDLᵀ, row by row within the profile. Returns how many pivots are negative; error: how far rounding moves eigenvalues at most.
int negative_pivots(const Rows& m, double shift, double& error) {
  const int n = static_cast<int>(m.size());
  std::vector<int> first(n);
  std::vector<std::vector<double>> l(n);                            // of row i its columns first[i] … i − 1
  std::vector<double> d(n);
  int most = 0, negative = 0;
  double largest = std::abs(shift);
  for (int i = 0; i < n; ++i) {
    first[i] = m[i].begin()->first, most = std::max(most, i - first[i]);
    l[i].assign(i - first[i], 0.0);
    double pivot = 0;
    for (const auto& [j, value] : m[i]) {
      largest = std::max(largest, std::abs(shift) + value.mag());
      (j < i ? l[i][j - first[i]] : pivot) = value.middle() - (j < i ? 0.0 : shift);
    }
    for (int j = first[i]; j < i; ++j) {                            // l_ij d_j, then l_ij
      double sum = l[i][j - first[i]];
      const int from = std::max(first[i], first[j]);
      for (int k = from; k < j; ++k) sum -= l[j][k - first[j]] * l[i][k - first[i]];
      l[i][j - first[i]] = sum;
    }
    for (int j = first[i]; j < i; ++j) {
      const double y = l[i][j - first[i]];
      l[i][j - first[i]] = y / d[j], pivot -= y * l[i][j - first[i]];
    }
    if (!(std::abs(pivot) > 0) || !std::isfinite(pivot)) throw Refuted("a pivot is zero");
    d[i] = pivot, negative += pivot < 0;
  }
  std::vector<D> down(n, D(1)), all;                                // ‖ |L||D||L|ᵀ 1 ‖_∞
  for (int i = 0; i < n; ++i)
    for (int j = first[i]; j < i; ++j) down[j] += D(std::abs(l[i][j - first[i]]));
  for (int i = 0; i < n; ++i) down[i] = down[i] * D(std::abs(d[i]));
  all = down;
  double size = 0;
  for (int i = 0; i < n; ++i) {
    for (int j = first[i]; j < i; ++j) all[i] += D(std::abs(l[i][j - first[i]])) * down[j];
    size = std::max(size, all[i].hi);
  }
  const D u(0x1p-53), k(most + 4.0);
  error = (k * u / (D(1) - k * u) * D(size) + D(0x1p-52) * D(largest) + D(1e-290)).hi;
  return negative;
}

/// Whether every gap has the sign that it is told to have, wherever within a distance of the centre the equilibrium is.
void check_gaps(const Proof& p, double within) {
  std::map<std::array<int, 2>, std::multiset<int>> signs;         // of two faces of walls the same particle may be near
  const auto keep = [&](int i, int j, const Q& g) { signs[{i, j}].insert(g.hi < 0 ? -1 : g.lo > 0 ? 1 : 0); };
  const auto edge = [&](const auto& law, int i, int j) {
    if constexpr (std::is_same_v<std::decay_t<decltype(law)>, proof::Contact>) keep(i, j, gap(law, p.edge<Q>(i, j, within)));
  };
  p.for_each(edge, [](const auto&, const auto&) {}, [&](const auto& law, int i) { keep(i, -1, gap(law, p.edge<Q>(-1, i, within))); });
  for (const auto& [key, told] : {std::pair("closed", -1), {"open", 1}})
    for (const Json& g : p.file.at("gaps").at(key))
      if (signs.at({g[0], g[1]}).count(told) == 0) throw Refuted("a gap has another sign than it is told to have, or two");
}

void check(const char* name) {
  const Proof p(name);
  std::vector<Q> way;
  for (std::size_t i = 0; i < p.dof.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const Place &to = p.centre[i], &at = p.state[i];
      way.push_back((Q(to.x[c]) - Q(at.x[c])) + (Q(to.low[c]) - Q(at.low[c])));
    }
  if (!(norm(way) <= p.moved)) throw Refuted("the state is farther from the centre than it is told");
  const double residual = norm(gradient(p));
  Rows M = hessian(p, 0);
  for (auto& row : M)
    for (auto& [j, value] : row) value = D(value.middle());
  const double shift = p.file.at("bounds").at("shift");             // any would do
  double error = 0, worst = 0;
  for (const double side : {1.0, -1.0}) {
    if (negative_pivots(M, side * shift, error) != p.negative) throw Refuted("the number of negative eigenvalues is another, or not told");
    worst = std::max(worst, error);
  }
  const double least = (D(shift) - D(worst)).lo;
  if (!(least > 0)) throw Refuted("the Hessian may be singular");
  const double inverse = (D(1) / D(least)).hi;
  const Rows h = hessian(p, p.radius);
  std::vector<D> sums(p.dofs);
  for (int i = 0; i < p.dofs; ++i)
    for (const auto& [j, value] : h[i]) {
      const D off((value - M[i].at(j)).mag());
      sums[i] += off;
      if (i != j) sums[j] += off;
    }
  double change = 0;
  for (const D& s : sums) change = std::max(change, s.hi);
  const D q = D(inverse) * D(change);
  if (!(q.hi < 1)) throw Refuted("the Hessian changes too much in the ball");
  if (!((D(inverse) * (D(residual) + D(change) * D(p.radius))).hi <= p.radius)) throw Refuted("the residual is too large for the ball");
  const double within = (D(inverse) * D(residual) / (D(1) - q)).hi;
  if (!((D(2) * D(p.moved) + D(within)).hi <= p.radius)) throw Refuted("the state is not well in the ball");
  check_gaps(p, within);
  std::printf("checked: within %.2g of the state there is exactly one equilibrium, at most %.2g away, with %d negative eigenvalues\n"
              "bounds found here: of the inverse of the Hessian %.2g, of its change in the ball %.2g, of the residual %.2g\n",
              0.95 * (p.radius - p.moved), 1.06 * (p.moved + within), p.negative, 1.06 * inverse, 1.06 * change, 1.06 * residual);
}

int main(int count, char** arguments) {
  if (count != 2) return std::fputs("check_proof PROOF.json\n", stderr), 1;
  try {
    check(arguments[1]);
    return 0;
  } catch (const std::exception& why) {
    std::printf("not proven: %s\n", why.what());
    return 2;
  }
}
