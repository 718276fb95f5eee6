// A program outside of elamin's sources: runs a problem file as the program does, and evaluates its energy by hand.
#include <elamin/elamin.hpp>

#include <cstdio>

int main(int, char** arguments) {
  using namespace elamin;
  RunOptions options;
  options.file = arguments[1], options.directory = arguments[2], options.quiet = true;
  const RunResult result = run(options);
  bool met = !result.verdicts.empty();
  for (const Verdict& v : result.verdicts) met = met && v.met;

  const Problem problem = read_problem(options.file);
  const Model model = build_model(problem);
  Energy energy(model);
  energy.evaluate(model.start);
  std::printf("expectations %s, %d free dofs, largest force %.3g\n", met ? "met" : "not met", energy.dofs(), energy.gradient().lpNorm<Eigen::Infinity>());
  return result.exit_status == exit_done && met && energy.dofs() > 0 ? 0 : 1;
}
