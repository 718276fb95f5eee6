#include "core/find.hpp"
#include "core/suggest.hpp"
#include "input/key_tree.hpp"
#include "input/read.hpp"
#include "python/module.hpp"
#include "results/surfaces.hpp"
#include "study/commands.hpp"
#include "study/imperfection.hpp"
#include "study/modes.hpp"
#include "study/trace.hpp"

#include <fmt/format.h>

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

double finite_load_factor(double load_factor) {
  if (!std::isfinite(load_factor)) throw InputError(fmt::format("load_factor: must be a finite number, is {}", load_factor));
  return load_factor;
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
      .def("at_load_factor", [](State s, double load_factor) { return s.load_factor = finite_load_factor(load_factor), s; },
           py::arg("load_factor"), "The same positions with another load factor.")
      .def(py::pickle(&parts, &from_parts));
}

System::System(Problem problem_read, Model model_built) : problem(std::move(problem_read)), model(std::move(model_built)), energy(model) {}

Energy& System::whole() {
  if (!whole_) {
    free_ = model;
    free_->supports.clear();
    whole_ = std::make_unique<Energy>(*free_);
  }
  return *whole_;
}

State System::start() { return starting_state(problem, energy); }

namespace {

using Array = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::shared_ptr<System> build(const Document& document, const std::vector<PythonLaw>& laws) {
  return without_lock([&] {
    std::vector<OwnLaw> own;
    for (const PythonLaw& law : laws) own.push_back(own_law(law));
    Problem problem = read_problem(complete(document));
    Model model = model_of(problem, own);
    return std::make_shared<System>(std::move(problem), std::move(model));
  });
}

// The state with these positions; bodies where `bodies` (b, 7) says, else where they start.
State state_at(System& s, const Array& x, std::optional<Array> bodies, double load_factor) {
  State state(field_of(x, s.model.particles(), "x"));
  state.bodies = s.start().bodies;
  state.load_factor = finite_load_factor(load_factor);
  if (!bodies) return state;
  if (bodies->ndim() != 2 || bodies->shape(0) != static_cast<py::ssize_t>(state.bodies.size()) || bodies->shape(1) != 7)
    throw InputError(fmt::format("bodies: must have the shape ({}, 7), a position and a quaternion w, x, y, z each", state.bodies.size()));
  const auto at = bodies->unchecked<2>();
  for (std::size_t b = 0; b < state.bodies.size(); ++b) {
    const auto i = static_cast<py::ssize_t>(b);
    const Eigen::Quaterniond turned(at(i, 3), at(i, 4), at(i, 5), at(i, 6));
    const Vec3 centre(at(i, 0), at(i, 1), at(i, 2));
    if (!centre.allFinite() || !std::isfinite(turned.norm()) || turned.norm() == 0)
      throw InputError(fmt::format("bodies: body {} has numbers that are not finite, or a quaternion of length 0; give finite ones", b));
    state.bodies[b] = {{centre, Vec3::Zero()}, turned.normalized()};
  }
  return state;
}

// Whether the state is one of this model; else a sentence.
void check_state(const System& s, const State& state) {
  if (state.particles() != s.model.particles() || state.bodies.size() != s.model.bodies.size())
    throw InputError(fmt::format("the state has {} particles and {} bodies, the problem {} and {}", state.particles(), state.bodies.size(),
                                 s.model.particles(), s.model.bodies.size()));
}

template <class Work> auto evaluated(System& s, const State& state, const Work& work) {
  check_state(s, state);
  return without_lock([&] {
    const std::lock_guard lock(s.mutex);
    return work();
  });
}

EnergyTerms terms(System& s, const State& state) {
  return evaluated(s, state, [&] { return s.energy.terms(state); });
}

py::object gradient(System& s, const State& state, bool free) {
  if (free) {
    const Vector g = evaluated(s, state, [&] { return s.energy.evaluate(state, false), s.energy.gradient(); });
    return py::array_t<double>(g.size(), g.data());
  }
  return copied(evaluated(s, state, [&] { return Field(-s.energy.forces(state).leftCols(s.model.particles())); }));
}

py::object forces(System& s, const State& state) {
  return copied(evaluated(s, state, [&] { return Field(s.energy.forces(state).leftCols(s.model.particles())); }));
}

// Force and torque on each body (b, 6).
py::array_t<double> body_forces(System& s, const State& state) {
  const Field all = evaluated(s, state, [&] { return s.energy.forces(state); });
  const Kinematics& k = s.energy.kinematics();
  py::array_t<double> array({static_cast<py::ssize_t>(s.model.bodies.size()), py::ssize_t(6)});
  auto out = array.mutable_unchecked<2>();
  for (int b = 0; b < static_cast<int>(s.model.bodies.size()); ++b)
    for (int c = 0; c < 3; ++c) out(b, c) = all(c, k.place_of(b)), out(b, 3 + c) = k.characteristic_length(b) * all(c, k.rotation_of(b));
  return array;
}

// A symmetric matrix as scipy's csr_matrix takes it: data, indices, indptr, and how many rows.
using Rows = std::tuple<std::vector<double>, std::vector<int>, std::vector<int>, int>;

// Of a Hessian in its lower triangle both triangles, in rows of all coordinates, three a site, or of the free ones.
Rows both_triangles(const Energy& energy, bool free) {
  const Kinematics& k = energy.kinematics();
  const SparseMatrix full = energy.hessian().selfadjointView<Eigen::Lower>();
  const int rows = free ? energy.dofs() : 3 * k.sites();
  std::vector<int> at(energy.dofs());                  // the row of each dof
  for (int d = 0; d < energy.dofs(); ++d) at[d] = free ? d : 3 * k.site_of(d) + k.coordinate_of(d);
  Rows out{{}, {}, std::vector<int>(static_cast<std::size_t>(rows) + 1), rows};
  auto& [data, indices, indptr, n] = out;
  std::vector<bool> null(energy.dofs());
  for (const int d : energy.null_dofs()) null[d] = true;    // what stands there keeps grains that fly from flying far; it is no stiffness
  int row = 0;
  for (int d = 0; d < energy.dofs(); ++d) {
    for (; row <= at[d]; ++row) indptr[row] = static_cast<int>(data.size());
    for (SparseMatrix::InnerIterator it(full, d); it; ++it)
      data.push_back(null[d] && it.row() == d ? 0.0 : it.value()), indices.push_back(at[it.row()]);
  }
  for (; row <= rows; ++row) indptr[row] = static_cast<int>(data.size());
  return out;
}

py::tuple hessian(System& s, const State& state, bool free) {
  const auto [data, indices, indptr, rows] = evaluated(s, state, [&] {
    Energy& energy = free ? s.energy : s.whole();
    energy.evaluate(state);
    return both_triangles(energy, free);
  });
  return py::make_tuple(py::array_t<double>(data.size(), data.data()), py::array_t<int>(indices.size(), indices.data()),
                        py::array_t<int>(indptr.size(), indptr.data()), rows);
}

// Of each free coordinate its place among all, three a site.
py::array_t<int> free_coordinates(System& s) {
  const Kinematics& k = s.energy.kinematics();
  std::vector<int> at(k.dofs());
  for (int d = 0; d < k.dofs(); ++d) at[d] = 3 * k.site_of(d) + k.coordinate_of(d);
  return py::array_t<int>(at.size(), at.data());
}

struct Minimum {
  PathPoint point;
};

// What [solver] asks for, but for what is given here.
Problem with_solver(const System& s, const std::optional<std::string>& method, const std::optional<double>& tolerance,
                    const std::optional<int>& most) {
  Problem p = s.problem;
  const auto wrong = [](const char* key, const std::string& what) { return InputError({Mistake{{}, 0, 0, key, what}}); };
  const std::vector<std::string>& known = key_tree().find("solver")->find("method")->words;
  if (method && !contains(known, *method))
    throw wrong("method", "must be " + quoted_choice(known) + ", is " + in_quotes(*method) + did_you_mean(*method, known));
  if (tolerance && !(*tolerance > 0 && *tolerance <= 1e-2))
    throw wrong("tolerance", fmt::format("must be a number above 0 and at most 0.01, is {}", *tolerance));
  if (most && *most < 1) throw wrong("max_iterations", fmt::format("must be an integer of at least 1, is {}", *most));
  if (tolerance) p.solver.tolerance = *tolerance;
  if (method && *method != p.solver.method) p.solver.method = *method, p.solver.max_iterations = standard_iterations(p.solver);
  if (most) p.solver.max_iterations = *most;
  return p;
}

Minimum minimum(System& s, const std::optional<State>& from, double load_factor, const std::optional<std::string>& method,
                const std::optional<double>& tolerance, const std::optional<int>& most) {
  if (from) check_state(s, *from);
  Problem p = with_solver(s, method, tolerance, most);
  p.study = StudyType::equilibrium, p.path.start_lambda = finite_load_factor(load_factor);
  return without_lock([&] {
    Minimum found;
    if (from) {
      Energy energy(s.model);
      Newton newton(energy, solver_options(p));
      State state = *from;
      energy.kinematics().prescribe(state, load_factor);
      const Report report = minimiser_of(p, newton)(state);
      energy.evaluate(state, false);
      found.point = assess(newton, state, report).point;
    } else {                                           // supports and walls go there in steps
      Model model = s.model;
      const Sink sink{.stage = [](const Stage&, Energy&) {}, .point = [&](const PathPoint& point, bool) { found.point = point; },
                      .modes = {}, .note = [](const std::string&) {}};
      const Outcome outcome = trace(p, model, std::nullopt, sink);
      found.point.report.why = outcome.why;
    }
    if (!found.point.report.converged()) found.point.stability.stable = false;
    return found;
  });
}

std::vector<Mode> modes(System& s, const State& state, int count) {
  check_state(s, state);
  if (count < 1 || count > s.energy.dofs())
    throw InputError(fmt::format("k: must be an integer from 1 to {}, the number of free coordinates, is {}", s.energy.dofs(), count));
  return without_lock([&] {
    Energy energy(s.model);
    Newton newton(energy, solver_options(s.problem));
    energy.evaluate(state);
    return lowest_modes(newton, assess(newton, state, {}), count);
  });
}

Stability stability(System& s, const State& state) {
  check_state(s, state);
  return without_lock([&] {
    Energy energy(s.model);
    Newton newton(energy, solver_options(s.problem));
    energy.evaluate(state);
    return assess(newton, state, {}).point.stability;
  });
}

py::dict groups(const System& s) {
  py::dict all;
  for (const Group& g : s.model.groups) all[py::str(g.name)] = py::array_t<int>(g.particles.size(), g.particles.data());
  return all;
}

py::array_t<int> bonds(const System& s) {
  py::array_t<int> array({static_cast<py::ssize_t>(s.model.bonds.size()), py::ssize_t(2)});
  auto out = array.mutable_unchecked<2>();
  for (std::size_t k = 0; k < s.model.bonds.size(); ++k)
    for (int c = 0; c < 2; ++c) out(static_cast<py::ssize_t>(k), c) = s.model.bonds[k].particles[c];
  return array;
}

}  // namespace

void add_systems(py::module_& module) {
  py::class_<System, std::shared_ptr<System>>(module, "System", "A problem that has been read and built.")
      .def(py::init(&build), py::arg("document"), py::arg("laws"))
      .def_property_readonly("particles", [](const System& s) { return s.model.particles(); })
      .def_property_readonly("body_count", [](const System& s) { return s.model.bodies.size(); })
      .def_property_readonly("dofs", [](const System& s) { return s.energy.dofs(); })
      .def_property_readonly("title", [](const System& s) { return s.problem.title; })
      .def_property_readonly("in_time", [](const System& s) { return s.problem.in_time(); })
      .def_property_readonly("load_factor", [](const System& s) { return starting_load_factor(s.problem); })
      .def_property_readonly("diameters", [](const System& s) {
        return py::array_t<double>(s.model.diameter.size(), s.model.diameter.data());
      })
      .def_property_readonly("ids", [](const System& s) { return py::array_t<int>(s.model.id.size(), s.model.id.data()); })
      .def_property_readonly("groups", &groups)
      .def_property_readonly("bonds", &bonds)
      .def_property_readonly("free", &free_coordinates)
      .def("start", [](System& s, std::optional<double> load_factor) {
        State state = s.start();
        if (load_factor) s.energy.kinematics().prescribe(state, finite_load_factor(*load_factor));
        return state;
      }, py::arg("load_factor"))
      .def("state", &state_at, py::arg("x"), py::arg("bodies"), py::arg("load_factor"))
      .def("energy", [](System& s, const State& state) { return terms(s, state).total(); }, py::arg("state"))
      .def("terms", [](System& s, const State& state) { return dict_of(terms(s, state)); }, py::arg("state"))
      .def("gradient", &gradient, py::arg("state"), py::arg("free"))
      .def("forces", &forces, py::arg("state"))
      .def("body_forces", &body_forces, py::arg("state"))
      .def("hessian", &hessian, py::arg("state"), py::arg("free"))
      .def("minimise", &minimum, py::arg("x0"), py::arg("load_factor"), py::arg("method"), py::arg("tolerance"), py::arg("max_iterations"))
      .def("modes", &modes, py::arg("state"), py::arg("k"))
      .def("stability", &stability, py::arg("state"))
      .def("describe", [](const System& s) { return without_lock([&] { return describe(s.problem, s.model); }); });

  py::class_<Mode>(module, "Mode", "An eigenmode of the Hessian over the free coordinates.")
      .def_readonly("eigenvalue", &Mode::eigenvalue, "[force/length]")
      .def_readonly("zero_mode", &Mode::zero_mode, "Which rigid motion it is; \"\": none.")
      .def_property_readonly("shape", [](const py::object& self) { return view(self.cast<const Mode&>().shape, self); },
                             "(sites, 3): particles, then place and turn of each body; of Euclidean norm 1.");

  py::class_<Stability>(module, "Stability", "What the Hessian over the free coordinates says of a state.")
      .def_readonly("stable", &Stability::stable, "No negative eigenvalue, and every zero one is a named motion.")
      .def_readonly("negative", &Stability::negative, "Morse index: eigenvalues below zero by more than rounding.")
      .def_readonly("negative_rigid", &Stability::negative_rigid, "The same under a rigid machine.")
      .def_readonly("zero", &Stability::zero, "Eigenvalues that are zero to rounding.")
      .def_readonly("zero_modes", &Stability::zero_modes, "Names of the motions that they are.");

  py::class_<Minimum>(module, "Minimum", "What minimise has found.")
      .def_property_readonly("x", [](const py::object& self) { return view(self.cast<const Minimum&>().point.state.position, self); },
                             "Positions (n, 3) [length]: a view, read-only.")
      .def_property_readonly("state", [](const Minimum& m) { return m.point.state; })
      .def_property_readonly("load_factor", [](const Minimum& m) { return m.point.state.load_factor; })
      .def_property_readonly("energy", [](const Minimum& m) { return m.point.energy.total(); })
      .def_property_readonly("terms", [](const Minimum& m) { return dict_of(m.point.energy); })
      .def_property_readonly("converged", [](const Minimum& m) { return m.point.report.converged(); })
      .def_property_readonly("message", [](const Minimum& m) { return m.point.report.why; })
      .def_property_readonly("iterations", [](const Minimum& m) { return m.point.report.iterations; })
      .def_property_readonly("residual", [](const Minimum& m) { return m.point.report.residual; })
      .def_property_readonly("stable", [](const Minimum& m) { return m.point.stability.stable; })
      .def_property_readonly("negative", [](const Minimum& m) { return m.point.stability.negative; })
      .def_property_readonly("stability", [](const Minimum& m) { return m.point.stability; });
}

}  // namespace elamin::python
