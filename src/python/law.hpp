#pragma once
// Laws that are Python's functions over all elements at once.
#include "python/module.hpp"

namespace elamin::python {

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

}  // namespace elamin::python
