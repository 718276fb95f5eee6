#include "study/check_command.hpp"

#include "energy/kinematics.hpp"
#include "laws/section.hpp"
#include "model/rigid_motion.hpp"
#include "problem/sweep.hpp"

#include <fmt/format.h>

#include <cmath>

namespace elamin {

namespace {

// How an end of a row is held: no particle, one (pinned) or at least two (clamped) across its line.
struct End {
  int held = 0;
  std::string name() const { return held == 0 ? "free" : held == 1 ? "pinned" : "clamped"; }
};

End end_of(const Structure& s, const Kinematics& kinematics, bool last) {
  End end;
  for (; end.held < s.count; ++end.held) {
    const int p = last ? s.first + s.count - 1 - end.held : s.first + end.held;
    int free = 0;
    for (int c = 0; c < 3; ++c) free += kinematics.dof(p, c) >= 0;
    if (free > 1) break;
  }
  return end;
}

// Euler's factor: P = factor · π² EI/L².
double euler_factor(const End& a, const End& b) {
  const int least = std::min(std::min(a.held, b.held), 2), most = std::min(std::max(a.held, b.held), 2);
  if (least == 2) return 4;
  if (least == 1) return most == 2 ? 2.045748 : 1;
  return most == 2 ? 0.25 : 0;
}

void print_beam(const Model& model, const Structure& s, const Kinematics& kinematics) {
  const BondType& bond = model.bond_types[s.bond_type];
  const double K = bond.stiffness, q0 = bond.rest_length, B = s.angle_type < 0 ? 0 : model.angle_types[s.angle_type].stiffness;
  fmt::print("  bond stiffness K = {:.10g}, rest length q0 = {:.10g}, EA = 2 K q0 = {:.10g}\n", K, q0, 2 * K * q0);
  fmt::print("  angle stiffness B = {:.10g}, EI = B q0 = {:.10g}\n", B, B * q0);
  const End a = end_of(s, kinematics, false), b = end_of(s, kinematics, true);
  const int bonds = s.count - 1 - std::max(0, a.held - 1) - std::max(0, b.held - 1);
  // A clamp sits at the middle of its inner bond.
  const double length = (bonds + (a.held > 1 ? 0.5 : 0.0) + (b.held > 1 ? 0.5 : 0.0)) * q0;
  fmt::print("  ends: {}, {}; {} bonds can stretch; effective length {:.10g}\n", a.name(), b.name(), std::max(bonds, 0), length);
  if (const double factor = euler_factor(a, b); factor > 0 && bonds > 0 && B > 0)
    fmt::print("  Euler load {:.6g} pi^2 EI/L^2 = {:.10g}, strain {:.6g}\n", factor, factor * pi * pi * B * q0 / (length * length),
               factor * pi * pi * B / (2 * K * length * length));
}

void print_model(const Problem& problem, const Model& model) {
  const Kinematics kinematics(model);
  fmt::print("{}: {}\n", problem.file, problem.title.empty() ? "(no title)" : problem.title);
  fmt::print("{} particles, {} bonds, {} angles, {} free dofs{}\n", model.particles(), model.bonds.size(), model.angles.size(), kinematics.dofs(),
             problem.plane.empty() ? "" : ", plane " + problem.plane);
  for (const Structure& s : model.structures) {
    fmt::print("{} '{}': {} particles\n", s.kind, s.name, s.count);
    if (s.bond_type >= 0) print_beam(model, s, kinematics);
  }
  for (const Group& g : model.groups) fmt::print("group '{}': {} particles\n", g.name, g.particles.size());
  const std::vector<RigidMotion> motions = free_rigid_motions(model, model.start);
  if (motions.empty()) fmt::print("no rigid motion is free\n");
  for (const RigidMotion& m : motions) fmt::print("free rigid motion: {}\n", m.name);
}

}  // namespace

void check_command(const std::string& file, const std::vector<Setting>& settings) {
  const std::vector<PreparedRun> runs = prepare_runs(file, settings);
  print_model(runs.front().problem, runs.front().model);
  if (runs.size() > 1) fmt::print("a sweep of {} runs; the first one is shown\n", runs.size());
}

}  // namespace elamin
