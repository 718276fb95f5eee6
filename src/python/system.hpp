#pragma once
// A problem that has been read and built: what energies, solvers and paths are asked of.
#include "python/module.hpp"
#include "energy/energy.hpp"
#include "input/problem.hpp"
#include "python/law.hpp"

#include <memory>
#include <mutex>

namespace elamin::python {

struct System {
  System(Problem problem_read, Model model_built);

  Problem problem;
  Model model;
  std::mutex mutex;                    // of the energies: one thread at a time evaluates
  Energy energy;
  /// The energy of the same model without supports, whose dofs are all coordinates; made when it is asked for.
  Energy& whole();
  State start();                       // where the study starts

 private:
  std::optional<Model> free_;
  std::unique_ptr<Energy> whole_;
};

}  // namespace elamin::python
