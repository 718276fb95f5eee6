#include "python/states.hpp"

namespace elamin::python {

py::dict dict_of(const EnergyTerms& terms) {
  py::dict dict;
  terms.for_each([&](const auto& name, double value) { dict[py::str(std::string(name))] = value; });
  return dict;
}

py::array_t<double> poses(const State& state) {
  py::array_t<double> array({static_cast<py::ssize_t>(state.bodies.size()), py::ssize_t(7)});
  auto out = array.mutable_unchecked<2>();
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const Pose& p = state.bodies[b];
    const Vec3 x = p.position.hi + p.position.lo;
    const auto i = static_cast<py::ssize_t>(b);
    for (int c = 0; c < 3; ++c) out(i, c) = x[c];
    out(i, 3) = p.rotation.w(), out(i, 4) = p.rotation.x(), out(i, 5) = p.rotation.y(), out(i, 6) = p.rotation.z();
  }
  return array;
}

namespace {

// The parts of a state for pickle.
py::tuple parts(const State& s) {
  py::list bodies, hard;
  for (const Pose& p : s.bodies)
    bodies.append(py::make_tuple(p.position.hi[0], p.position.hi[1], p.position.hi[2], p.position.lo[0], p.position.lo[1], p.position.lo[2],
                                 p.rotation.w(), p.rotation.x(), p.rotation.y(), p.rotation.z()));
  for (const HardForce& h : s.hard) hard.append(py::make_tuple(h.particle, h.other, h.wall, h.face, h.force));
  return py::make_tuple(copied(s.position), copied(s.low), s.load_factor, bodies, hard);
}

State from_parts(const py::tuple& t) {
  State s(field_of(t[0].cast<py::array_t<double>>(), -1, "x"));
  s.low = field_of(t[1].cast<py::array_t<double>>(), s.particles(), "low");
  s.load_factor = t[2].cast<double>();
  for (const py::handle h : t[3]) {
    const auto n = h.cast<std::array<double, 10>>();
    s.bodies.push_back({{{n[0], n[1], n[2]}, {n[3], n[4], n[5]}}, {n[6], n[7], n[8], n[9]}});
  }
  for (const py::handle h : t[4]) {
    const auto f = h.cast<py::tuple>();
    s.hard.push_back({f[0].cast<int>(), f[1].cast<int>(), f[2].cast<int>(), f[3].cast<int>(), f[4].cast<double>()});
  }
  return s;
}

}  // namespace

void add_states(py::module_& module) {
  py::class_<State>(module, "State", "Where everything is, to about 32 digits, and the load factor.")
      .def_property_readonly("x", [](const py::object& self) { return view(self.cast<const State&>().position, self); },
                             "Positions of the particles (n, 3) [length]: a view of the state, read-only.")
      .def_property_readonly("low", [](const py::object& self) { return view(self.cast<const State&>().low, self); },
                             "What the rounding of x left out (n, 3) [length].")
      .def_property_readonly("bodies", &poses, "Of the rigid bodies position and quaternion w, x, y, z (b, 7).")
      .def_readonly("load_factor", &State::load_factor)
      .def("at_load_factor", [](State s, double load_factor) { return s.load_factor = load_factor, s; }, py::arg("load_factor"),
           "The same positions with another load factor.")
      .def(py::pickle(&parts, &from_parts));
}

}  // namespace elamin::python
