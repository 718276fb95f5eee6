#include "python/module.hpp"

#include "energy/carried_group.hpp"
#include "core/suggest.hpp"
#include "energy/energy.hpp"
#include "input/reader.hpp"
#include "results/columns.hpp"

#include <fmt/format.h>

namespace elamin::python {

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

class PythonGroup final : public ElementGroup {
 public:
  explicit PythonGroup(const PythonLaw& law) : law_(law) {
    for (const std::vector<int>& element : law_.elements) stencils_.insert(stencils_.end(), element.begin(), element.end());
  }

  int elements() const override { return static_cast<int>(law_.elements.size()); }
  int sites() const override { return law_.sites; }
  std::span<const int> stencils() const override { return stencils_; }
  bool anchored() const override { return law_.anchored; }
  bool residual_energy(const State&, const State&, double*) const override { return false; }

  void values(const State& state, double* value) const override {
    const py::gil_scoped_acquire acquire;
    take((*law_.value)(positions(state)), "value", 1, value);
  }

  void derivatives(const State& state, const Tangent&, double* value, double* gradient, double* hessian) const override {
    const py::gil_scoped_acquire acquire;
    const py::tuple all = (*law_.derivatives)(positions(state), hessian != nullptr);
    if (all.size() != 3) throw std::invalid_argument(fmt::format("the law \"{}\": its derivatives must be three arrays", law_.term));
    take(all[0], "value", 1, value);
    take(all[1], "gradient", 3 * sites(), gradient);
    if (!hessian) return;
    const py::ssize_t n = 3 * sites();
    const Array full = checked(all[2], "Hessian", n * n);
    const double* h = full.data();
    for (int e = 0; e < elements(); ++e, h += n * n)
      for (py::ssize_t r = hessian_first(); r < n; ++r)
        for (py::ssize_t c = hessian_first(); c <= r; ++c) *hessian++ = (h[r * n + c] + h[c * n + r]) / 2;
  }

 private:
  Array positions(const State& state) const {
    Array x({static_cast<py::ssize_t>(elements()), static_cast<py::ssize_t>(sites()), py::ssize_t(3)});
    double* out = x.mutable_data();
    for (const std::vector<int>& element : law_.elements)
      for (const int p : element) {
        const Vec3 at = law_.anchored ? Vec3(state.position.col(p) + state.low.col(p)) : Vec3((state.at(p) - state.at(element[0])).hi);
        for (int c = 0; c < 3; ++c) *out++ = at[c];
      }
    return x;
  }

  Array checked(const py::handle& what, const char* name, py::ssize_t each) const {
    const Array array = py::cast<Array>(what);
    if (array.size() != each * elements())
      throw std::invalid_argument(fmt::format("the law \"{}\": its {} has {} numbers for {} elements of {} sites; {} are wanted",
                                              law_.term, name, array.size(), elements(), sites(), each * elements()));
    return array;
  }
  void take(const py::handle& what, const char* name, py::ssize_t each, double* out) const {
    const Array array = checked(what, name, each);
    std::copy_n(array.data(), array.size(), out);
  }

  PythonLaw law_;
  std::vector<int> stencils_;
};

std::shared_ptr<py::object> held(py::object object) {
  return {new py::object(std::move(object)), [](const py::object* o) {
            const py::gil_scoped_acquire acquire;
            delete o;
          }};
}

PythonLaw law_of(std::string term, const py::array_t<int, py::array::c_style | py::array::forcecast>& elements, bool anchored,
                 py::object value, py::object derivatives) {
  PythonLaw law{std::move(term), 0, {}, anchored, held(std::move(value)), held(std::move(derivatives))};
  static const std::vector<std::string> columns = event_columns({}, true), more = path_columns({}, true);
  if (!is_name(law.term))
    throw InputError(fmt::format("the law {}: its name must be of letters, digits, _ and -, a letter first", in_quotes(law.term)));
  for (const auto* taken : {&columns, &more})
    if (std::count(taken->begin(), taken->end(), law.term))
      throw InputError(fmt::format("the law \"{}\": there is a column of this name already; give it another one", law.term));
  if (elements.ndim() != 2 || elements.shape(1) < 1 || elements.shape(1) > 12)
    throw InputError(fmt::format("the law \"{}\": its elements must be an array (m, sites) of particles, with 1 to 12 sites", law.term));
  law.sites = static_cast<int>(elements.shape(1));
  const auto at = elements.unchecked<2>();
  for (py::ssize_t e = 0; e < at.shape(0); ++e) {
    law.elements.emplace_back();
    for (int i = 0; i < law.sites; ++i) law.elements.back().push_back(at(e, i));
    std::vector<int> sorted = law.elements.back();
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end())
      throw InputError(fmt::format("the law \"{}\": element {} has one particle twice", law.term, e));
  }
  return law;
}

}  // namespace

OwnLaw own_law(const PythonLaw& law) {
  return {law.term, law.elements, law.anchored, [law](const Energy& energy) -> std::unique_ptr<ElementGroup> {
            const Model& model = energy.model();
            auto group = std::make_unique<PythonGroup>(law);
            std::vector<bool> glued(model.particles());
            for (const Glued& g : model.glued) glued[g.particle] = true;
            for (const std::vector<int>& element : law.elements)
              for (const int p : element)
                if (glued[p]) return std::make_unique<CarriedGroup>(model, energy.kinematics(), std::move(group));
            return group;
          }};
}

void add_laws(py::module_& module) {
  py::class_<PythonLaw>(module, "Law", "A law of a program's own: elements and functions over all of them.")
      .def(py::init(&law_of), py::arg("term"), py::arg("elements"), py::arg("anchored"), py::arg("value"), py::arg("derivatives"))
      .def_readonly("term", &PythonLaw::term);
}

}  // namespace elamin::python
