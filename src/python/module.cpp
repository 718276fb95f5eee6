// The module elamin._elamin: what Python calls of the library. What is nicer to say in Python is in elamin/.
#include "python/module.hpp"

#include "core/error.hpp"
#include "core/memory.hpp"
#include "core/parallel.hpp"
#include "input/key_tree.hpp"
#include "results/summary.hpp"

#include <fmt/format.h>

namespace elamin::python {

namespace {

std::atomic<int> default_threads{0};

}  // namespace

void raise_input_error(const InputError& error) {
  py::list mistakes;
  std::string all;
  for (Mistake m : error.mistakes()) {
    if (m.file == "--set") m.file.clear();
    all += (all.empty() ? "" : "\n") + m.sentence();
    mistakes.append(py::make_tuple(m.file, m.line, m.column, m.key, m.what));
  }
  const py::object kind = py::module_::import("elamin._errors").attr("InputError");
  PyErr_SetObject(kind.ptr(), kind(all, mistakes).ptr());
}

py::array_t<double> view(const Eigen::Ref<const Field>& field, const py::handle& owner) {
  py::array_t<double> array({field.cols(), Eigen::Index(3)}, {3 * sizeof(double), sizeof(double)}, field.data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::array_t<double> copied(const Field& field) {
  return py::array_t<double>({field.cols(), Eigen::Index(3)}, {3 * sizeof(double), sizeof(double)}, field.data());
}

Field field_of(const py::array_t<double, py::array::c_style | py::array::forcecast>& array, Eigen::Index n, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3 || (n >= 0 && array.shape(0) != n))
    throw InputError(fmt::format("{}: must have the shape ({}, 3), has ({})", name, n >= 0 ? std::to_string(n) : "n",
                                 fmt::join(array.shape(), array.shape() + array.ndim(), ", ")));
  Field field = Eigen::Map<const Field>(array.data(), 3, array.shape(0));
  if (!field.allFinite()) throw InputError(fmt::format("{}: must be finite", name));
  return field;
}

void set_default_threads(int n) {
  if (n < 1) throw InputError(fmt::format("set_threads: must be an integer of at least 1, is {}", n));
  default_threads = n;
}
void take_default_threads() {
  if (const int n = default_threads; n > 0) set_threads(n);
}

int threads_here() {
  take_default_threads();
  return omp_get_max_threads();
}

}  // namespace elamin::python

PYBIND11_MODULE(_elamin, module) {
  using namespace elamin::python;
  elamin::keep_freed_memory();
  module.doc() = "elamin's library; import elamin instead.";
  py::register_exception_translator([](std::exception_ptr p) {
    try {
      if (p) std::rethrow_exception(p);
    } catch (const elamin::InputError& error) {
      raise_input_error(error);
    } catch (const elamin::OutputError& error) {
      PyErr_SetString(PyExc_OSError, error.what());
    }
  });
  module.attr("version") = elamin::version();
  module.def("json_schema", &elamin::json_schema, "The JSON schema of a problem file.");
  module.def("set_threads", &set_default_threads, py::arg("count"),
             "Threads that each call uses; by default as many as OpenMP has (OMP_NUM_THREADS, all cores).");
  module.def("rest_threads", [] { omp_pause_resource_all(omp_pause_soft); },
             "Ends OpenMP's idle threads, so that the process can be forked.");
  add_documents(module);
  add_states(module);
  add_laws(module);
  add_systems(module);
  add_paths(module);
  add_runs(module);
}
