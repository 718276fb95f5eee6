#pragma once
// What Python is given of a state and of what has been found there.
#include "python/module.hpp"
#include "energy/terms.hpp"
#include "path/point.hpp"

namespace elamin::python {

py::dict dict_of(const EnergyTerms& terms);
/// (b, 7): position, then the quaternion w, x, y, z.
py::array_t<double> poses(const State& state);

}  // namespace elamin::python
