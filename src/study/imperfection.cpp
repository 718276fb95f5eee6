#include "study/imperfection.hpp"

#include "core/find.hpp"
#include "core/suggest.hpp"
#include "input/build.hpp"
#include "model/imperfection.hpp"
#include "results/stored_run.hpp"
#include "study/modes.hpp"
#include "study/solving.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

namespace elamin {
namespace {

/// The lowest modes of the structure as built, at the load factor of its start.
std::vector<Field> own_modes(const Problem& problem, const Model& model, int count) {
  Energy energy(model);
  Newton newton(energy, solver_options(problem));
  State state = model.start;
  energy.evaluate(state);
  const Equilibrium e = assess(newton, state, {});
  std::vector<Field> shapes;
  for (const Mode& m : lowest_modes(newton, e, count)) shapes.push_back(m.shape.leftCols(model.particles()));
  return shapes;
}

/// The modes of a stored run, as many as there are up to `count`.
std::vector<Field> stored_modes(const ImperfectionTable& t, const Model& model, int count) {
  const std::filesystem::path run(t.run);
  std::vector<Field> shapes;
  if (t.at) {
    shapes = read_displacements((run / "states" / (file_name_of(*t.at) + ".modes.csv")).string(), model);
  } else {
    for (int k = 1; k <= count; ++k)
      for (Field& f : read_displacements((run / "modes" / fmt::format("mode-{}.csv", k)).string(), model)) shapes.push_back(std::move(f));
  }
  for (Field& f : shapes) f = f.leftCols(model.particles()).eval();
  return shapes;
}

/// Of length 1 where it is largest, and there its largest component positive.
Field unit_mode(const Field& shape) {
  Eigen::Index most = 0, component = 0;
  shape.colwise().norm().maxCoeff(&most);
  shape.col(most).cwiseAbs().maxCoeff(&component);
  // Of many that are as large the first one decides, whatever rounding does.
  for (Eigen::Index p = shape.cols() - 1; p >= 0; --p)
    if (shape.col(p).norm() >= (1 - 1e-6) * shape.col(most).norm()) most = p;
  return shape / std::copysign(shape.col(most).norm(), shape(component, most));
}

Field random_field(const ImperfectionTable& t, const Model& model) {
  std::mt19937_64 generator(static_cast<std::uint64_t>(t.seed.value_or(0)));
  const auto uniform = [&] { return (static_cast<double>(generator() >> 11) + 0.5) * 0x1p-53; };   // in (0, 1), the same on every machine
  Field by(3, model.particles());
  for (int p = 0; p < model.particles(); ++p)
    for (int c = 0; c < 3; ++c) {
      const double u = uniform();
      by(c, p) = *t.random * (t.distribution != Distribution::normal ? 2 * u - 1 : std::sqrt(-2 * std::log(u)) * std::cos(2 * pi * uniform()));
    }
  return by;
}

class Maker {
 public:
  Maker(const Problem& problem, Model& model) : p_(problem), t_(*problem.imperfection), model_(model), mistakes_(problem.file) {}

  void make() {
    Field by = Field::Zero(3, model_.particles());
    if (t_.modes) add_modes(by);
    else if (!t_.state.empty()) by = t_.scale.value_or(1) * (stored_state().position - model_.start.position);
    else by = random_field(t_, model_);
    mistakes_.raise();
    keep_still(by);
    if (t_.stress_free && !t_.place.written("stress_free") && !model_.plane_normal && bends_a_row(model_, by))
      mistakes_.add(t_.place, "stress_free",
                    "is to be said here: it bends a row of particles, and a rest angle in space has no direction, so that a bent row would turn about "
                    "itself without resistance. Give plane, or write stress_free = false (or true)");
    mistakes_.raise();
    displace(model_, by, t_.stress_free);
  }

 private:
  void add_modes(Field& by) {
    const int count = *std::max_element(t_.modes->begin(), t_.modes->end());
    const auto read = mistakes_.unless_wrong([&] { return t_.run.empty() ? own_modes(p_, model_, count) : stored_modes(t_, model_, count); });
    if (!read) return;
    const std::vector<Field>& shapes = *read;
    for (std::size_t k = 0; k < t_.modes->size(); ++k) {
      const std::size_t mode = static_cast<std::size_t>((*t_.modes)[k]);
      if (mode > shapes.size()) {
        const std::string where = t_.run.empty() ? "the structure" : !t_.at ? in_quotes(t_.run) : *t_.at + " of " + in_quotes(t_.run);
        return mistakes_.add(t_.place, "modes", fmt::format("there is no mode {}: {} has {}", mode, where, shapes.size()));
      }
      by += (*t_.amplitudes)[k] * unit_mode(shapes[mode - 1]);
    }
  }

  State stored_state() {
    try {
      return read_state({"", -1, t_.state}, model_);
    } catch (const InputError& e) {
      mistakes_.add(t_.place, "state", std::string("is no state of this structure: ") + e.what());
      return model_.start;
    }
  }

  /// What is not of the group, what leads out of the plane, what a body carries.
  void keep_still(Field& by) const {
    std::vector<bool> moved(model_.particles());
    if (const Group* group = find_named(model_.groups, t_.group))
      for (const int p : group->particles) moved[p] = true;
    for (const Glued& g : model_.glued) moved[g.particle] = false;
    for (int p = 0; p < model_.particles(); ++p)
      if (!moved[p]) by.col(p).setZero();
    if (model_.plane_normal) by.row(*model_.plane_normal).setZero();
  }

  const Problem& p_;
  const ImperfectionTable& t_;
  Model& model_;
  Mistakes mistakes_;
};

}  // namespace

Model model_of(const Problem& problem, const std::vector<OwnLaw>& own) {
  Model model = build_model(problem, own);
  if (problem.imperfection) Maker(problem, model).make();
  return model;
}

}  // namespace elamin
