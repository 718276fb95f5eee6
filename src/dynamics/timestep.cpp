#include "dynamics/timestep.hpp"

#include "dynamics/contact_damping.hpp"
#include "energy/wall_group.hpp"
#include "laws/hertz_contact.hpp"

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include <limits>
#include <random>

namespace elamin {

namespace {

constexpr double accuracy = 0.005;              // of ω², twice: what is left open, and what is added to be safe
constexpr int most_iterations = 1000, between_looks = 8;

// The largest eigenvalue of M^{-1/2} K M^{-1/2} from above, by Lanczos's method from a random vector: the largest Ritz value θ
// and the size |β s| of its residual.
double largest_eigenvalue(Energy& energy, const Vector& root_mass, int& iterations) {
  const Eigen::Index n = root_mass.size();
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Vector v = Vector::NullaryExpr(n, [&] { return normal(random); }), before = Vector::Zero(n);
  v.normalize();
  std::vector<double> diagonal, beside;
  double upper = 0;
  for (iterations = 1; iterations <= most_iterations; ++iterations) {
    Vector w = energy.multiply(v.cwiseQuotient(root_mass)).cwiseQuotient(root_mass);
    diagonal.push_back(w.dot(v));
    w -= diagonal.back() * v;
    if (!beside.empty()) w -= beside.back() * before;
    const double beta = w.norm();
    const bool ended = iterations == n || !(beta > 1e-14 * std::abs(diagonal.back()));
    if (ended || iterations % between_looks == 0) {
      const auto k = static_cast<Eigen::Index>(diagonal.size());
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
      solver.computeFromTridiagonal(Eigen::Map<Vector>(diagonal.data(), k), Eigen::Map<Vector>(beside.data(), k - 1));
      const double theta = solver.eigenvalues()[k - 1], rest = beta * std::abs(solver.eigenvectors()(k - 1, k - 1));
      upper = theta + rest;
      if (ended || rest <= accuracy * theta || (theta <= 0 && rest == 0)) break;
    }
    beside.push_back(beta);
    before = v, v = w / beta;
  }
  return std::max(upper, 0.0) * (1 + accuracy);
}

// The sums over the rows of M^{-1/2} C M^{-1/2}, which bound its eigenvalues.
double quickest_decay(Energy& energy, const State& state) {
  const Model& model = energy.model();
  std::vector<double> c(model.particles(), 0.0);
  for (const Viscosity& w : model.viscosity)
    for (const int p : w.particles) c[p] += w.coefficient / model.mass(p);
  const auto strength = [](const DampedContact& d, double overlap) {
    return damping_coefficient(overlap, d.coefficient, d.roots) * std::max(1.0, d.rubs() ? 3.5 * d.tangential : 0.0);
  };
  for (const Touch& t : energy.touches(state)) {
    const int i = t.particle, j = t.other;
    const double mi = model.mass(i), ri = model.diameter[i] / 2;
    if (j >= 0) {
      const PairContact& table = model.contacts[energy.contact_rules().hertz(i, j)];
      const double mj = model.mass(j), rj = model.diameter[j] / 2;
      const DampedContact d(table.damping, mi * mj / (mi + mj), hertz_stiffness(table.effective_modulus, ri, rj), ri * rj / (ri + rj));
      const double eta = strength(d, -t.gap);
      c[i] += eta * (1 / mi + 1 / std::sqrt(mi * mj)), c[j] += eta * (1 / mj + 1 / std::sqrt(mi * mj));
    } else {
      const Wall& wall = model.walls[t.wall];
      c[i] += strength({wall.damping, mi, wall.effective_modulus * 4 / 3 * std::sqrt(ri), ri}, -t.gap) / mi;
    }
  }
  double most = 0;
  for (int d = 0; d < energy.dofs(); ++d) most = std::max(most, c[energy.kinematics().site_of(d)]);
  return most;
}

}  // namespace

TimestepLimit timestep_limit(Energy& energy, const State& state) {
  TimestepLimit limit;
  limit.stable = std::numeric_limits<double>::infinity();
  if (energy.dofs() == 0) return limit;
  Vector root_mass(energy.dofs());
  for (int d = 0; d < energy.dofs(); ++d) root_mass[d] = std::sqrt(energy.model().mass(energy.kinematics().site_of(d)));
  energy.evaluate(state, true);
  limit.frequency = std::sqrt(largest_eigenvalue(energy, root_mass, limit.iterations));
  limit.drag = quickest_decay(energy, state);
  const double w = limit.frequency, c = limit.drag;
  if (w > 0 || c > 0) limit.stable = 4 / (c + std::sqrt(c * c + 4 * w * w));
  return limit;
}

std::string unstable(const TimestepLimit& limit, double timestep) {
  if (timestep < limit.stable) return "";
  std::string why = fmt::format("a time step of {:.6g} is unstable: the fastest vibration has the frequency {:.6g} rad a unit of time", timestep, limit.frequency);
  if (limit.drag > 0) why += fmt::format(", drag and damping decay at up to {:.6g}", limit.drag);
  return why + fmt::format("; it must be below {:.6g}, and {:.6g} is advised", limit.stable, limit.advised());
}

}  // namespace elamin
