#pragma once
// The Python module, a part a file: each adds its classes and functions.
#include "core/error.hpp"
#include "core/interrupt.hpp"
#include "energy/energy.hpp"
#include "energy/terms.hpp"
#include "input/document.hpp"
#include "input/problem.hpp"
#include "model/model.hpp"
#include "path/point.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>

namespace elamin::python {

// Ctrl-C in Python: signals are looked at while a solver works.

namespace py = pybind11;

/// Whether a signal's handler has raised something in Python. Only the main thread runs handlers.
class Signals {
 public:
  /// Looks at most every 50 ms; takes Python's lock. True from the first time on that a handler has raised.
  bool arrived() {
    if (arrived_) return true;
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    auto last = looked_.load();
    constexpr auto pause = std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::milliseconds(50)).count();
    if (now - last < pause || !looked_.compare_exchange_strong(last, now)) return false;
    const py::gil_scoped_acquire acquire;
    return look();
  }
  /// The same at once, where the lock is held.
  bool look() {
    if (!arrived_ && PyErr_CheckSignals() != 0) raised_.emplace(), arrived_ = true;
    return arrived_;
  }
  /// What the handler raised, if it did. The lock is held.
  void raise() {
    if (raised_) throw py::error_already_set(std::move(*raised_));
  }
  const std::function<bool()>& question() const { return question_; }

 private:
  std::atomic<bool> arrived_{false};
  std::atomic<std::chrono::steady_clock::rep> looked_{std::chrono::steady_clock::now().time_since_epoch().count()};
  std::optional<py::error_already_set> raised_;
  std::function<bool()> question_ = [this] { return arrived(); };
};

void add_documents(py::module_& module);
void add_states(py::module_& module);
void add_laws(py::module_& module);
void add_systems(py::module_& module);
void add_paths(py::module_& module);
void add_runs(py::module_& module);

/// Raises elamin.InputError in Python. What no file says is of no file there.
void raise_input_error(const InputError& error);

/// A field as an array (sites, 3) of the same memory, read-only; `owner` keeps it.
py::array_t<double> view(const Eigen::Ref<const Field>& field, const py::handle& owner);
/// The same as an array of its own.
py::array_t<double> copied(const Field& field);
/// An array (n, 3) as 3 × n. Throws InputError, which calls it `name`, if it has another shape or is not finite.
Field field_of(const py::array_t<double, py::array::c_style | py::array::forcecast>& array, Eigen::Index n, const char* name);

/// Threads that each call of this module uses; 0: as many as OpenMP says.
void set_default_threads(int n);
void take_default_threads();
/// What they come to on this thread.
int threads_here();

/// Solver's work without Python's lock, so that other threads run. Ctrl-C ends it, and is raised behind it.
template <class Work> auto without_lock(const Work& work) {
  Signals signals;
  auto result = [&] {
    const py::gil_scoped_release release;
    const StopAsked stopping(signals.question());
    take_default_threads();
    return work();
  }();
  signals.raise();
  return result;
}

// What Python is given of a state and of what has been found there.

py::dict dict_of(const EnergyTerms& terms);
/// (b, 7): position, then the quaternion w, x, y, z.
py::array_t<double> poses(const State& state);

// Laws that are Python's functions over all elements at once.

/// Its functions: value(x) → (m,) and derivatives(x, with_hessian) → value (m,), gradient (m, sites, 3), Hessian (m, 3·sites, 3·sites) or
/// None; x (m, sites, 3) [length]. Of a law that is not anchored x is relative to each element's first site, to the last digit.
struct PythonLaw {
  std::string term;
  int sites = 0;
  std::vector<std::vector<int>> elements;
  bool anchored = false;
  std::shared_ptr<py::object> value, derivatives;      // let go with Python's lock held
};

/// The same for a model.
OwnLaw own_law(const PythonLaw& law);

// A problem that has been read and built: what energies, solvers and paths are asked of.

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

/// With the sha256 of its text, where it has been put together or changed.
Document complete(Document document);

}  // namespace elamin::python
