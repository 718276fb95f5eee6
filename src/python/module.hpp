#pragma once
// The Python module, a part a file: each adds its classes and functions.
#include "core/error.hpp"
#include "model/model.hpp"
#include "python/stop.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

namespace elamin::python {

namespace py = pybind11;

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
    const Stopping stopping(signals.question());
    take_default_threads();
    return work();
  }();
  signals.raise();
  return result;
}

}  // namespace elamin::python
