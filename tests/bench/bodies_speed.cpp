// Rigid bodies: pairs and steps per second.
//
//     bench bodies_speed DATA FORMULATION k_n k_na r_c c_n c_t TIMESTEP STEPS GRAVITY [lo|-  hi|-  of x, y, z]
//
// DATA: a LAMMPS data file of bodies. FORMULATION: lammps, multi or closest. Takes so many steps from rest under gravity along −z between the
// planes that are given and prints the seconds of the processor, one thread, and the kinetic energy at the end. With
// TIMESTEP 0 nothing moves: all near pairs are evaluated STEPS times, and it prints how many there are, how many pass the rules'
// test of the centres, the seconds for the forces, and for energy, gradient and Hessian (0 with lammps, which has none).
#include "dynamics/verlet.hpp"
#include "energy/body_groups.hpp"
#include "laws/rounded/closest.hpp"
#include "laws/rounded/lammps_rules.hpp"
#include "laws/rounded/multi.hpp"
#include "laws/rounded/reference_bodies.hpp"

#include <cstdio>
#include <ctime>

using namespace elamin;

namespace bodies_speed {

double seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

Model model_of(const std::vector<std::string>& words) {
  Model m;
  m.start = State(Field(3, 0));
  const auto number = [&](int k) { return std::stod(words[k]); };
  RoundedPair t;
  Gravity weight;
  const std::vector<ReferenceBody> bodies = read_bodies(words[0]);
  const auto n = static_cast<Eigen::Index>(bodies.size());
  m.body_velocity.resize(3, n), m.angular_momentum.resize(3, n);
  for (int k = 0; k < n; ++k) {
    const ReferenceBody& b = bodies[k];
    m.shapes.push_back(rounded_shape(b.core, b.radius));
    m.bodies.push_back({k, k + 1, b.type, b.mass, b.inertia});
    m.start.bodies.push_back({{b.x, Vec3::Zero()}, Eigen::Quaterniond::Identity()});
    m.body_velocity.col(k) = b.v, m.angular_momentum.col(k) = b.L;
    t.bodies[0].push_back(k);
  }
  t.bodies[1] = weight.bodies = t.bodies[0];
  t.formulation = words[1] == "lammps" ? RoundedFormulation::lammps : words[1] == "multi" ? RoundedFormulation::multi : RoundedFormulation::closest;
  t.kernel = {number(2), number(3), number(4), RoundedKernel::Form::coded};
  t.damping.normal = number(5), t.damping.tangential = number(6);
  m.rounded = {t};
  weight.acceleration = Vec3(0, 0, -number(9));
  m.gravity = {weight};
  for (int k = 10; k < static_cast<int>(words.size()); ++k) {
    if (words[k] == "-") continue;
    Wall w;
    const int axis = (k - 10) / 2;
    w.region.shape = Shape::plane, w.region.center = number(k) * Vec3::Unit(axis), w.region.normal = (k % 2 == 0 ? 1 : -1) * Vec3::Unit(axis);
    w.bodies = t.bodies[0], w.lammps = t.formulation == RoundedFormulation::lammps;
    w.kernel.normal = number(2), w.body_damping = t.damping;
    m.walls.push_back(w);
  }
  return m;
}

void time_pairs(const Model& m, int times) {
  BodyNeighbours neighbours(m);
  neighbours.refresh(m.start);
  const BodyRules& rules = neighbours.rules();
  const RoundedPair& table = m.rounded[0];
  const LammpsRules lammps{table.kernel, table.damping.normal, table.damping.tangential, 0, 1};
  int near = 0;
  double sum = 0;
  const double start = seconds();
  for (int k = 0; k < times; ++k)
    for (const auto& [i, j] : neighbours.pairs()) {
      const RoundedBody a = rules.body(i, m.start), b = rules.body(j, m.start);
      if (table.formulation == RoundedFormulation::lammps) sum += lammps.pair(a, b).on[0].force.x();
      else if (table.formulation == RoundedFormulation::multi) sum += RoundedMulti{table.kernel}.forces(a, b)[0].force.x();
      else sum += RoundedClosest{table.kernel}.forces(a, b)[0].force.x();
      if (k > 0) continue;
      const auto size = [](const RoundedShape& s) { return s.vertices.size() == 1 ? s.radius : s.extent; };
      near += (a.pose.position - b.pose.position).hi.norm() <= size(*a.shape) + size(*b.shape) + table.kernel.cutoff;
    }
  const double middle = seconds();
  if (table.formulation != RoundedFormulation::lammps)
    for (int k = 0; k < times; ++k)
      for (const auto& [i, j] : neighbours.pairs())
        sum += rounded_derivatives(table, rules.body(i, m.start), rules.body(j, m.start)).hessian(0, 0);
  const bool rules_only = table.formulation == RoundedFormulation::lammps;
  std::printf("%zu %d %.6f %.6f\n", neighbours.pairs().size(), near, middle - start, rules_only ? 0.0 : seconds() - middle);
  if (!std::isfinite(sum)) std::exit(2);
}

int main(int count, char** arguments) try {
  const std::vector<std::string> words(arguments + 1, arguments + count);
  if (words.size() < 10) {
    std::fputs("bodies_speed DATA FORMULATION k_n k_na r_c c_n c_t TIMESTEP STEPS GRAVITY [lo|- hi|- …]\n", stderr);
    return 1;
  }
  const Model model = model_of(words);
  const double timestep = std::stod(words[7]);
  const int steps = std::stoi(words[8]);
  if (timestep == 0) {
    time_pairs(model, steps);
    return 0;
  }
  Verlet verlet(model, begin_motion(model), timestep);
  const double start = seconds();
  const std::int64_t done = verlet.advance(steps);
  std::printf("%.6f %.17g\n", seconds() - start, verlet.kinetic());
  return done == steps && verlet.finite() ? 0 : 1;
} catch (const std::exception& e) {
  std::fprintf(stderr, "%s\n", e.what());
  return 1;
}

}  // namespace bodies_speed
