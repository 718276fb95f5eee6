#include "solve/ipopt.hpp"

#include "core/interrupt.hpp"
#include "core/timing.hpp"
#include "energy/step_limits.hpp"
#include "solve/ipopt_problem.hpp"
#include "solve/limits.hpp"
#include "solve/mumps.hpp"

#include <IpIpoptApplication.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

using Application = Ipopt::SmartPtr<Ipopt::IpoptApplication>;

// Ipopt's own tolerances are beyond reach: the residual decides. `begin`: the barrier's parameter.
Application application(int most_iterations, double begin, bool warm) {
  Application app = new Ipopt::IpoptApplication(false);
  Ipopt::OptionsList& o = *app->Options();
  const auto word = [&](const char* key, const char* value) { o.SetStringValue(key, value); };
  const auto number = [&](const char* key, double value) { o.SetNumericValue(key, value); };
  word("sb", "yes");
  o.SetIntegerValue("print_level", 0);
  word("linear_solver", "mumps");
  word("nlp_scaling_method", "none");
  number("tol", 1e-15), number("dual_inf_tol", 1e-200), number("constr_viol_tol", 1e-200), number("compl_inf_tol", 1e-15);
  number("diverging_iterates_tol", 1e100), number("max_cpu_time", 1e15);
  o.SetIntegerValue("acceptable_iter", 0);
  o.SetIntegerValue("max_iter", most_iterations);
  o.SetIntegerValue("watchdog_shortened_iter_trigger", 1), o.SetIntegerValue("watchdog_trial_iter_max", 8);
  number("mu_init", begin);
  number("bound_relax_factor", 0);
  if (warm) {
    word("warm_start_init_point", "yes");
    for (const char* push : {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
                             "warm_start_slack_bound_frac", "warm_start_mult_bound_push"})
      number(push, 1e-9);
  }
  for (const char* push : {"bound_push", "slack_bound_push"}) number(push, 1e-4);
  app->Initialize("");
  return app;
}

// Why Ipopt has ended by itself.
std::string told(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level:
    case Ipopt::Feasible_Point_Found: return "Ipopt calls this solved, but the residual is too large";
    case Ipopt::Infeasible_Problem_Detected: return "Ipopt finds no state near here in which nothing overlaps: hard contacts leave no room";
    case Ipopt::Search_Direction_Becomes_Too_Small: return "Ipopt's steps have become smaller than rounding";
    case Ipopt::Diverging_Iterates: return "Ipopt's states move away without end";
    case Ipopt::User_Requested_Stop: return "Ipopt was stopped";
    case Ipopt::Maximum_Iterations_Exceeded: return "Ipopt's iterations were not enough; a larger solver.max_iterations may do";
    case Ipopt::Restoration_Failed: return "Ipopt finds neither a step that lowers the energy nor a state in which less overlaps";
    case Ipopt::Error_In_Step_Computation: return "Ipopt could not compute a step: its equations cannot be solved here";
    case Ipopt::Maximum_CpuTime_Exceeded: return "Ipopt's time has run out";
    case Ipopt::Not_Enough_Degrees_Of_Freedom: return "there are fewer degrees of freedom than hard contacts that must stay closed";
    case Ipopt::Invalid_Problem_Definition:
    case Ipopt::Invalid_Option: return "Ipopt refuses the problem or its options: an error of this program";
    case Ipopt::Invalid_Number_Detected: 
      return "the energy or a derivative is not finite here: particles coincide, or do not fit into a curved wall";
    case Ipopt::Insufficient_Memory: return "there is not enough memory for Ipopt's factorisation";
    case Ipopt::Unrecoverable_Exception:
    case Ipopt::NonIpopt_Exception_Thrown:
    case Ipopt::Internal_Error: break;
  }
  return "Ipopt has failed by an error of its own";
}

// One run after another, each where the one before had to end, to an equilibrium.
void run(Energy& energy, ContactEquilibrium& equilibrium, State& state, const IpoptOptions& options, Report& report) {
  IpoptMemory memory;
  for (int idle = 0;;) {
    const int before = report.iterations;
    Ipopt::SmartPtr<IpoptProblem> problem = new IpoptProblem(energy, equilibrium, state, options, memory, report);
    const bool warm = std::any_of(state.hard.begin(), state.hard.end(), [](const HardForce& h) { return h.force > 0; });
    const Application app = application(std::max(0, options.max_iterations - report.iterations), memory.barrier, warm);
    const Ipopt::ApplicationReturnStatus status = app->OptimizeTNLP(Ipopt::GetRawPtr(problem));
    state = problem->state();
    idle = report.iterations > before ? 0 : idle + 1;
    if (problem->reached()) {
      report.status = Status::converged;
      report.why = fmt::format("the residual is below {:g}", options.tolerance);
      return;
    }
    if (interrupted()) {
      report.status = Status::interrupted, report.why = "interrupted";
      return;
    }
    if (problem->stale() && idle < limits::ipopt::most_rounds_without_gain && report.iterations < options.max_iterations) continue;
    report.status = Status::not_converged;
    report.why = problem->escaped().empty() ? told(status) : problem->escaped();
    report.why += fmt::format("; the residual is {:.2g}", report.residual);
    return;
  }
}

// Whether the state is an equilibrium already, with the forces that it has; then as exact as it can be.
bool is_equilibrium(Energy& energy, ContactEquilibrium& equilibrium, State& state, double tolerance) {
  energy.evaluate(state, false);
  if (!(energy.relative(energy.gradient()) <= tolerance)) return false;
  State near = state;
  const double thinnest = energy.kinematics().smallest_size();
  if (!equilibrium.correct(near, tolerance, nullptr, limits::ipopt::in_place * thinnest).converged()) return false;
  state = near;
  return true;
}

// Off a saddle, along the motion of lowest curvature that keeps the closed contacts; so far that this is not its rounding.
void leave_saddle(Energy& energy, ContactEquilibrium& equilibrium, State& state) {
  const Vector v = equilibrium.lowest(state, 1).vectors.col(0);
  const double part = std::min(limits::ipopt::rotation / std::max(distortion(energy, state, v), 1e-300), limits::ipopt::way / std::max(movement(energy, v), 1e-300));
  energy.kinematics().retract(state, v, part);
}

}  // namespace

Report minimise_by_ipopt(Energy& energy, State& state, const IpoptOptions& options) {
  const std::lock_guard lock(one_at_a_time());
  const Stopwatch watch;
  Report report;
  ContactEquilibrium equilibrium(energy);
  if (energy.dofs() == 0) report.status = Status::converged, report.why = "nothing is free to move";
  for (int saddles = 0; energy.dofs() > 0; ++saddles) {
    if (is_equilibrium(energy, equilibrium, state, options.tolerance))
      report.status = Status::converged, report.why = fmt::format("the residual is below {:g} from the start", options.tolerance);
    else
      run(energy, equilibrium, state, options, report);
    if (!report.converged() || state.hard.empty()) break;
    report.negative = equilibrium.inertia(state).negative;
    if (report.negative == 0) break;
    if (saddles == limits::ipopt::most_saddles) {
      report.status = Status::not_converged, report.why = "a saddle could not be left along its negative curvature";
      break;
    }
    leave_saddle(energy, equilibrium, state);
  }
  energy.evaluate(state);
  report.energy = energy.last_terms().total(), report.residual = energy.relative(energy.gradient());
  report.seconds = watch.seconds();
  return report;
}

}  // namespace elamin
