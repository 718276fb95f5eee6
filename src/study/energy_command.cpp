#include "study/energy_command.hpp"

#include "energy/energy.hpp"
#include "problem/build.hpp"
#include "problem/read.hpp"
#include "results/table.hpp"
#include "study/trace.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace elamin {

namespace {

// Drag acts on a moving state; it has no energy.
void add_drag(const Model& model, Field& forces) {
  if (model.velocity.cols() == 0) return;
  for (const Viscosity& v : model.viscosity)
    for (const int p : v.particles) forces.col(p) -= v.coefficient * model.velocity.col(p);
}

void write_forces(const std::string& file, const Model& model, const Field& forces) {
  CsvFile csv(file, {"id", "fx", "fy", "fz"});
  for (int p = 0; p < model.particles(); ++p)
    csv.add({model.id[p], forces(0, p), forces(1, p), forces(2, p)});
}

}  // namespace

void energy_command(const EnergyOptions& options) {
  const Problem problem = read_problem(options.file, options.settings);
  const Model model = build_model(problem);
  Energy energy(model);
  State state = starting_state(problem, energy);
  if (options.load_factor) energy.kinematics().prescribe(state, *options.load_factor);
  const EnergyTerms terms = energy.terms(state);
  Field forces = energy.forces(state);
  add_drag(model, forces);
  const double max_force = forces.cols() ? forces.colwise().norm().maxCoeff() : 0.0;
  if (!options.forces_file.empty()) write_forces(options.forces_file, model, forces);

  const auto finite = [](double v) { return std::isfinite(v) ? nlohmann::ordered_json(v) : nlohmann::ordered_json(nullptr); };
  if (options.json) {
    nlohmann::ordered_json out;
    out["energy"] = {{"total", finite(terms.total())}, {"bond", finite(terms.bond)}, {"angle", finite(terms.angle)},
                     {"contact", finite(terms.contact)}, {"wall", finite(terms.wall)}, {"cohesion", finite(terms.cohesion)},
                     {"external", finite(terms.external)}};
    out["max_force"] = finite(max_force);
    out["particles"] = model.particles(), out["bodies"] = 0, out["dofs"] = energy.dofs();
    fmt::print("{}\n", out.dump());
    return;
  }
  fmt::print("load factor {:.17g}\n", state.load_factor);
  fmt::print("energy      {:24.17g}\n", terms.total());
  const std::pair<const char*, double> all[]{{"bond", terms.bond}, {"angle", terms.angle}, {"contact", terms.contact},
                                             {"wall", terms.wall}, {"cohesion", terms.cohesion}, {"external", terms.external}};
  for (const auto& [name, value] : all) fmt::print("  {:<10}{:24.17g}\n", name, value);
  fmt::print("largest force on a particle {:.17g}\n{} particles, {} free dofs\n", max_force, model.particles(), energy.dofs());
}

}  // namespace elamin
