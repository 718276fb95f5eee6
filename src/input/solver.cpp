#include "input/solver.hpp"

#include "core/suggest.hpp"
#include "dynamics/relax.hpp"
#include "input/parts.hpp"
#include "solve/ipopt.hpp"

#include <fmt/format.h>

#include <string_view>
#include <tuple>

namespace elamin {

namespace {

constexpr std::array solver_words{
    "auto", "newton", "ipopt", "fire", "nlopt:LD_LBFGS", "nlopt:LD_TNEWTON", "nlopt:LD_TNEWTON_RESTART", "nlopt:LD_TNEWTON_PRECOND",
    "nlopt:LD_TNEWTON_PRECOND_RESTART", "nlopt:LD_VAR1", "nlopt:LD_VAR2", "nlopt:LD_SLSQP", "nlopt:LD_MMA", "nlopt:LD_CCSAQ", "nlopt:LN_COBYLA",
    "nlopt:LN_BOBYQA", "nlopt:LN_NEWUOA", "nlopt:LN_PRAXIS", "nlopt:LN_NELDERMEAD", "nlopt:LN_SBPLX", "nlopt:G_MLSL", "nlopt:G_MLSL_LDS",
    "nlopt:GN_DIRECT", "nlopt:GN_DIRECT_L", "nlopt:GN_CRS2_LM", "nlopt:GN_ISRES", "nlopt:GN_ESCH"};
Keys::Names nlopt_words() {
  Keys::Names words;
  for (const char* w : solver_words)
    if (std::string_view(w).starts_with("nlopt:")) words.push_back(w);
  return words;
}

}  // namespace

void describe(Keys& keys, SolverTable& t) {
  keys.about("How equilibria are found.");
  keys.word("method", t.method, solver_words, "auto: Newton's method, or what settles packings of loose grains");
  keys.may("tolerance", t.tolerance, "residual, relative to the largest internal force", Range{0, 1e-2, true});
  keys.may("max_iterations", t.max_iterations, "by default as many as suit the method", Range{1, most_steps});
  keys.may("petsc", t.petsc, "under mpirun: options of PETSc and MUMPS, \"-mat_mumps_icntl_14 80\"");
  const std::string what = "the method " + t.method + "; it is for NLopt's";
  keys.either("method", {{{"auto", "newton", "ipopt", "fire"}, what.c_str(), !t.by_nlopt(), [] {}},
                         {nlopt_words(), "the method", t.by_nlopt(), [&] {
                            keys.may("max_evaluations", t.nlopt.max_evaluations, "of the energy", range::count);
                            keys.may("polish", t.nlopt.polish, "ends with Newton's method");
                            keys.may("precondition", t.nlopt.precondition, "in variables in which the Hessian at the start is the identity");
                            keys.may("bounds", t.nlopt.bounds, "of global methods: half the width of the box about the start [length]",
                                     range::positive);
                            int seed = static_cast<int>(t.nlopt.seed);
                            keys.may("seed", seed, "of random numbers", range::id);
                            t.nlopt.seed = static_cast<unsigned long>(seed);
                          }}});
}

bool SolverTable::operator==(const SolverTable& other) const {
  const auto numbers = [](const SolverTable& t) {
    const NloptOptions& n = t.nlopt;
    return std::tuple(t.method, t.tolerance, t.max_iterations, t.petsc, n.max_evaluations, n.polish, n.precondition, n.bounds, n.seed);
  };
  return numbers(*this) == numbers(other);
}

std::optional<int> standard_iterations(const SolverTable& t) {
  if (t.by_nlopt()) return std::nullopt;
  if (t.by_newton()) return NewtonOptions{}.max_iterations;
  return t.method == "ipopt" ? IpoptOptions{}.max_iterations : static_cast<int>(RelaxOptions{}.max_steps);
}

void check_solver(Problem& problem, Mistakes& mistakes) {
  SolverTable& s = problem.solver;
  if (!s.petsc.empty() && s.petsc.front() != '-')
    mistakes.add(s.place, "petsc", "must be options as PETSc has them, each with a dash before it, as \"-mat_mumps_icntl_14 80\", is " + in_quotes(s.petsc));
  const bool newton = s.by_newton();
  if (!newton && problem.study == StudyType::modes)
    mistakes.add(s.place, "method", "must be \"auto\" or \"newton\" in a study of modes, is " + in_quotes(s.method));
  if (!newton && problem.follows_path()) {
    const auto by_newton = [&](TablePlace& place, const char* key, const char* what) {
      mistakes.add(place, key, fmt::format("{} follows stable and unstable equilibria, which {} does not; use solver.method = "
                                           "\"newton\"", what, in_quotes(s.method)));
    };
    if (problem.path.method == PathMethod::arc_length) by_newton(problem.path.place, "method", "arc length");
    else if (problem.path.when_unstable == WhenUnstable::follow) by_newton(problem.path.place, "when_unstable", "\"follow\"");
    if (problem.path.branches > 0) by_newton(problem.path.place, "branches", "branch switching");
    if (problem.path.deflate > 0) by_newton(problem.path.place, "deflate", "deflation");
    for (StageTable& t : problem.stages)
      if (t.method == PathMethod::arc_length) by_newton(t.place, "method", "arc length");
  }
}

}  // namespace elamin
