#include "dynamics/timestep.hpp"

#include "core/dense.hpp"
#include "dynamics/contact_damping.hpp"
#include "dynamics/inverse_mass.hpp"
#include "dynamics/lammps_bodies.hpp"
#include "energy/body_groups.hpp"
#include "laws/hertz_contact.hpp"

#include <fmt/format.h>

#include <random>

namespace elamin {

namespace {

constexpr double accuracy = 0.005;              // of ω², twice: what is left open, and what is added to be safe
constexpr int most_rounds = 1000, between_looks = 8;

// The largest eigenvalue of M^{-1/2} K M^{-1/2} from above, by Lanczos's method from a random vector: the largest Ritz value θ
// and the size |β s| of its residual.
double largest_eigenvalue(Energy& energy, const InverseMass& mass, int& iterations) {
  const Eigen::Index n = energy.dofs();
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  Vector v = Vector::NullaryExpr(n, [&] { return normal(random); }), before = Vector::Zero(n);
  v.normalize();
  std::vector<double> diagonal, beside;
  double upper = 0;
  for (iterations = 1; iterations <= most_rounds; ++iterations) {
    Vector w = mass.root(energy.multiply(mass.root(v), false));
    diagonal.push_back(w.dot(v));
    w -= diagonal.back() * v;
    if (!beside.empty()) w -= beside.back() * before;
    const double beta = w.norm();
    const bool ended = iterations == n || !(beta > 1e-14 * std::abs(diagonal.back()));
    if (ended || iterations % between_looks == 0) {
      const auto k = static_cast<Eigen::Index>(diagonal.size());
      const EigenPairs ritz = tridiagonal_eigen(Eigen::Map<Vector>(diagonal.data(), k), Eigen::Map<Vector>(beside.data(), k - 1));
      const double theta = ritz.values[k - 1], rest = beta * std::abs(ritz.vectors(k - 1, k - 1));
      upper = theta + rest;
      if (ended || rest <= accuracy * theta || (theta <= 0 && rest == 0)) break;
    }
    beside.push_back(beta);
    before = v, v = w / beta;
  }
  return std::max(upper, 0.0) * (1 + accuracy);
}

// What the damping at the contacts of bodies adds to the row sums, of bodies and particles: η (wᵢ + √(wᵢ wⱼ)), w from InverseMass.
void add_body_contacts(Energy& energy, const State& state, const InverseMass& mass, std::vector<double>& particles, std::vector<double>& bodies) {
  const Model& model = energy.model();
  const BodyRules& rules = energy.body_rules();
  const auto strength = [](const RoundedDamping& d) { return std::max(d.normal, d.tangential + d.slip); };
  std::vector<RoundedContact> contacts;
  for (const auto& [i, j] : energy.body_neighbours().pairs()) {
    const RoundedPair& table = model.rounded[rules.table(i, j)];
    contacts.clear();
    rounded_contacts(table, rules.body(i, state), rules.body(j, state), contacts);
    for (const RoundedContact& c : contacts) {
      if (c.gap > 0 && !table.damping.apart) continue;
      const auto at = [&](int e) {
        return rules.is_body(e) ? mass.at(e - rules.particles(), c.point - rules.position(e, state)) : 3.5 * mass.at(e);
      };
      const double wi = at(i), wj = at(j), eta = c.weight * strength(table.damping);
      const auto add = [&](int e, double w) { (rules.is_body(e) ? bodies[e - rules.particles()] : particles[e]) += eta * (w + std::sqrt(wi * wj)); };
      add(i, wi), add(j, wj);
    }
  }
  std::vector<RoundedWallTouch> touches;
  for (const Wall& wall : model.walls)
    for (const int b : wall.bodies) {
      touches.clear();
      rounded_wall_at(wall, state.load_factor).touches(model.body(b, state), touches);
      for (const RoundedWallTouch& t : touches)
        if (t.gap <= 0 || wall.body_damping.apart) bodies[b] += strength(wall.body_damping) * mass.at(b, t.point - state.bodies[b].position.hi);
    }
}

// The sums over the rows of M^{-1/2} C M^{-1/2}, which bound its eigenvalues.
double quickest_decay(Energy& energy, const State& state, const InverseMass& mass) {
  const Model& model = energy.model();
  std::vector<double> c(model.particles(), 0.0), bodies(model.bodies.size(), 0.0);
  std::vector<int> glue(model.particles(), -1);
  for (std::size_t k = 0; k < model.glued.size(); ++k) glue[model.glued[k].particle] = static_cast<int>(k);
  for (const Viscosity& w : model.viscosity) {
    for (const int p : w.particles) {
      if (glue[p] < 0) c[p] += w.coefficient * mass.at(p);
      else {
        const int b = model.glued[glue[p]].body;
        bodies[b] += w.coefficient * mass.at(b, (state.at(p) - state.bodies[b].position).hi);
      }
    }
    for (const int b : w.bodies) bodies[b] += w.coefficient * mass.at(b, Vec3::Zero());
  }
  add_body_contacts(energy, state, mass, c, bodies);
  const auto strength = [](const DampedContact& d, double overlap) {
    return damping_coefficient(overlap, d.coefficient, d.roots) * std::max(1.0, d.rubs() ? 3.5 * d.tangential : 0.0);
  };
  for (const Touch& t : energy.touches(state)) {
    const int i = t.particle, j = t.other;
    if (std::max(i, j) >= model.particles()) continue;           // bodies
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
  for (int d = 0; d < energy.dofs(); ++d) {
    const int s = energy.kinematics().site_of(d);
    most = std::max(most, s < model.particles() ? c[s] : bodies[energy.kinematics().body_of(s)]);
  }
  return most;
}

}  // namespace

TimestepLimit timestep_limit(Energy& energy, const State& state) {
  TimestepLimit limit;
  limit.stable = infinity;
  if (energy.dofs() == 0) return limit;
  if (follows_lammps(energy.model())) {
    Model stiff = energy.model();
    for (RoundedPair& t : stiff.rounded)
      if (t.formulation == RoundedFormulation::lammps) t.formulation = RoundedFormulation::multi;
    for (Wall& w : stiff.walls) w.lammps = false;
    Energy of(stiff);
    return timestep_limit(of, state);
  }
  const InverseMass mass(energy.model(), energy.kinematics(), state);
  energy.evaluate(state, true);
  limit.frequency = std::sqrt(largest_eigenvalue(energy, mass, limit.iterations));
  limit.drag = quickest_decay(energy, state, mass);
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
