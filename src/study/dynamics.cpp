#include "study/trace.hpp"

#include "core/interrupt.hpp"
#include "core/timing.hpp"
#include "dynamics/motion.hpp"
#include "dynamics/lammps_bodies.hpp"
#include "dynamics/verlet.hpp"
#include "input/check.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {

namespace {

constexpr double between_looks = 0.1;          // seconds between two looks at interrupts and progress

// The steps that have a row, and those of them that have a frame.
struct Marks {
  explicit Marks(const Problem& problem) : every(problem.dynamics.every), last(problem.dynamics.steps) {
    if (problem.dynamics.record) frames = *problem.dynamics.record;
    else for (std::int64_t k = 0; k <= last; k += every) frames.push_back(static_cast<int>(k));
    others = frames;
    for (const ExpectTable& e : problem.expect)
      if (const auto step = step_of(e.at)) others.push_back(*step);
    for (std::vector<int>* list : {&frames, &others}) std::sort(list->begin(), list->end());
  }
  std::int64_t after(std::int64_t step) const {
    const auto other = std::upper_bound(others.begin(), others.end(), step);
    const std::int64_t next = std::min(last, (step / every + 1) * every);
    return other == others.end() ? next : std::min<std::int64_t>(next, *other);
  }
  bool frame(std::int64_t step) const { return std::binary_search(frames.begin(), frames.end(), step); }

  std::int64_t every, last;
  std::vector<int> frames, others;
};

Motion beginning(const Problem& problem, const Model& model, const Energy& energy) {
  Motion m = begin_motion(model);
  m.state = starting_state(problem, energy);
  return m;
}

bool finite(const Motion& m) {
  return m.state.position.allFinite() && m.velocity.allFinite() && m.force.allFinite() && m.body_velocity.allFinite() && m.body_force.allFinite() &&
         m.torque.allFinite();
}

// Of bodies that follow LAMMPS's rules the energy that LAMMPS reports, which their forces need not be the gradient of.
EnergyTerms terms(Energy& energy, const Motion& m) {
  EnergyTerms t = energy.terms(m.state);
  if (follows_lammps(energy.model())) t.body += lammps_body_forces(energy.model(), m.state).energy;
  return t;
}

}  // namespace

Outcome trace_dynamics(const Problem& problem, const Model& model, const Sink& sink, Archive* stopped) {
  Energy energy(model);
  sink.stage(Stage{}, energy);
  const Marks marks(problem);
  Verlet verlet(model, beginning(problem, model, energy), *problem.dynamics.timestep);
  Moment held;                                 // told only when there is a next one: the last is labelled
  const auto look = [&] {
    held.motion = verlet.motion();
    held.energy = terms(energy, held.motion), held.kinetic = verlet.kinetic();
  };
  const auto tell = [&](const char* label) {
    held.label = label;
    sink.moment(held, marks.frame(held.motion.step));
  };
  const auto line = [&](const Motion& m) {
    return fmt::format("step {:9}  time {:<12.7g}  kinetic energy {:<12.6g}", m.step, m.time, verlet.kinetic());
  };
  const auto carry = [&](Archive& archive) { archive(energy, verlet, held.label, held.motion, held.energy, held.kinetic); };
  if (stopped) carry(*stopped);
  else look();
  if (!finite(held.motion)) return {Status::not_converged, "the forces of the starting state are not finite: particles coincide, or do not fit into a curved wall"};
  std::int64_t stride = 1;                     // steps in one go
  while (held.motion.step < marks.last) {
    const bool first = held.motion.step == 0;
    const std::int64_t goal = marks.after(held.motion.step);
    while (verlet.motion().step < goal) {
      const Stopwatch watch;
      verlet.advance(std::min(stride, goal - verlet.motion().step));
      stride = watch.seconds() < between_looks ? std::min(2 * stride, marks.last) : std::max<std::int64_t>(1, stride / 2);
      const std::int64_t step = verlet.motion().step;
      if (!finite(verlet.motion())) {
        tell("final");
        return {Status::not_converged, fmt::format("the motion goes beyond all numbers between steps {} and {}; take a smaller timestep", held.motion.step, step)};
      }
      if (sink.checkpoint) sink.checkpoint(carry);
      if (interrupted()) {
        if (step > held.motion.step) tell(first ? "initial" : ""), look();
        tell("final");
        return {Status::interrupted, fmt::format("interrupted at step {}", step)};
      }
      sink.progress(line(verlet.motion()), static_cast<double>(step));
    }
    tell(first ? "initial" : "");
    look();
  }
  tell("final");
  return {Status::converged, fmt::format("{} steps, time {:.10g}", held.motion.step, held.motion.time)};
}

}  // namespace elamin
