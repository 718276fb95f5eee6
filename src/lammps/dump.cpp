#include "lammps/dump.hpp"

#include "model/entities.hpp"

#include <fmt/format.h>

#include <iterator>

namespace elamin {
namespace {

const std::string bounds = "ITEM: BOX BOUNDS ff ff ff\n", atoms = "ITEM: ATOMS";

struct Atoms {
  Atoms(const Model& model, const State& state, bool of_bodies)
      : first(of_bodies ? model.particles() : 0), last(of_bodies ? entities(model) : model.particles()), x(3, last - first) {
    for (int e = first; e < last; ++e) {
      x.col(e - first) = of_bodies ? state.bodies[e - first].position.hi : Vec3(state.position.col(e));
      size.push_back(size_of(model, e));
    }
  }
  int first, last;                         // entities
  Field x;
  std::vector<double> size;
};

std::string text_of(const Box& box) {
  std::string text;
  for (int c = 0; c < 3; ++c) text += fmt::format("{} {}\n", box.lo[c], box.hi[c]);
  return text;
}

}  // namespace

Box dump_box(const Model& model, const State& state, bool of_bodies) {
  const Atoms a(model, state, of_bodies);
  return box_around(a.x, a.size);
}

std::string in_box(const std::string& frame, const Box& box) {
  const std::size_t begin = frame.find(bounds) + bounds.size();
  return frame.substr(0, begin) + text_of(box) + frame.substr(frame.find(atoms, begin));
}

std::string dump_frame(std::int64_t step, const Model& model, const State& state, const EntityColumns& columns, bool of_bodies, const Box& box) {
  const auto [first, last, x, size] = Atoms(model, state, of_bodies);
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "ITEM: TIMESTEP\n{}\nITEM: NUMBER OF ATOMS\n{}\n{}{}", step, last - first, bounds, text_of(box));
  fmt::format_to(out, "{} id type mol x y z radius{}", atoms, of_bodies ? " quati quatj quatk quatw" : "");
  for (const EntityColumn& c : columns) fmt::format_to(out, " {}", fmt::join(c.components, " "));
  fmt::format_to(out, "\n");
  for (int e = first; e < last; ++e) {
    const int k = e - first;
    fmt::format_to(out, "{} {} {} {} {} {} {}", id_of(model, e), of_bodies ? model.bodies[k].type : model.type[e], of_bodies ? 0 : model.molecule[e],
                   x(0, k), x(1, k), x(2, k), size[k] / 2);
    if (of_bodies)
      for (const double q : state.bodies[k].rotation.coeffs()) fmt::format_to(out, " {}", q);      // x, y, z, w
    for (const EntityColumn& c : columns)
      for (const double v : c.values.col(e)) fmt::format_to(out, " {}", v + 0.0);                  // no negative zeros
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

}  // namespace elamin
