#include "lammps/state.hpp"

#include "core/text_file.hpp"
#include "laws/section.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <type_traits>

namespace elamin {

namespace {

/// LAMMPS reads lines of at most 255 bytes; there must be room for a remark behind it.
std::string one_line(std::string title) {
  if (title.size() > 180) {
    std::size_t end = 180;
    while (end > 0 && (static_cast<unsigned char>(title[end]) & 0xC0) == 0x80) --end;   // not within a UTF-8 character
    title.resize(end);
  }
  for (char& c : title)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
  return title;
}

/// What a file is to hold.
class Text {
 public:
  template <class... Values> void operator()(fmt::string_view format, const Values&... values) {
    fmt::vformat_to(std::back_inserter(text_), format, fmt::make_format_args(values...));
  }
  void write(const std::string& file) const { write_text(file, {text_.data(), text_.size()}); }

 private:
  fmt::memory_buffer text_;
};

void put_box(Text& put, const Box& box) {
  for (int c = 0; c < 3; ++c) put("{:.17g} {:.17g} {}lo {}hi\n", box.lo[c], box.hi[c], "xyz"[c], "xyz"[c]);
}

/// Types from 0 that some bond or angle has, and the numbers that they are written with, from 1.
struct InUse {
  std::vector<int> types, number;
  std::size_t left_out() const { return number.size() - types.size(); }
};

template <class Element> InUse in_use(const std::vector<Element>& elements, std::size_t types) {
  InUse use{{}, std::vector<int>(types, 0)};
  for (const Element& e : elements) use.number[e.type] = 1;
  for (std::size_t t = 0; t < types; ++t)
    if (use.number[t]) use.types.push_back(static_cast<int>(t)), use.number[t] = static_cast<int>(use.types.size());
  return use;
}

int largest(const std::vector<int>& values) { return *std::max_element(values.begin(), values.end()); }

/// Numbers in lines of at most so many, as LAMMPS reads no long ones.
template <class Number> void put_list(Text& put, const std::vector<Number>& numbers, std::size_t most) {
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const char* end = k + 1 == numbers.size() || (k + 1) % most == 0 ? "\n" : " ";
    if constexpr (std::is_same_v<Number, int>) put("{}{}", numbers[k], end);
    else put("{:.17g}{}", numbers[k], end);
  }
}

/// Edges and faces as LAMMPS has them, faces of three or four corners: larger ones are cut at diagonals from their first corner.
struct Mesh { std::vector<int> edges, faces; };

Mesh mesh_of(const RoundedShape& shape) {
  Mesh mesh;
  for (const RoundedShape::Edge& e : shape.edges) mesh.edges.insert(mesh.edges.end(), {e.from, e.to});
  for (const RoundedShape::Face& f : shape.faces) {
    const std::vector<int>& c = f.corners;
    for (std::size_t k = 1; k + 1 < c.size(); k += 2) {
      const bool last = k + 2 == c.size();
      mesh.faces.insert(mesh.faces.end(), {c[0], c[k], c[k + 1], last ? -1 : c[k + 2]});
      if (k + 3 < c.size()) mesh.edges.insert(mesh.edges.end(), {c[0], c[k + 2]});
    }
  }
  return mesh;
}

/// The form in the axes of space; of a uniform solid of mass 1 where no mass is given.
void put_form(Text& put, const Body& body, const RoundedShape& shape, const Eigen::Quaterniond& rotation) {
  const Mesh mesh = mesh_of(shape);
  const Mat3 R = rotation.toRotationMatrix();
  Mat3 inertia = body.inertia;
  if (!(body.mass > 0)) {
    const MassProperties uniform = mass_properties(shape);
    inertia = uniform.inertia / uniform.volume;
  }
  const Mat3 I = R * inertia * R.transpose();
  std::vector<double> vertices;
  for (const Vec3& r : shape.vertices) {
    const Vec3 v = rotation * r;
    vertices.insert(vertices.end(), v.begin(), v.end());
  }
  put("{} 3 {}\n{} {} {}\n", body.id, 7 + vertices.size() + (shape.faces.empty() ? 0 : mesh.edges.size() + mesh.faces.size()),
      shape.vertices.size(), mesh.edges.size() / 2, mesh.faces.size() / 4);
  put_list(put, std::vector<double>{I(0, 0), I(1, 1), I(2, 2), (I(0, 1) + I(1, 0)) / 2, (I(0, 2) + I(2, 0)) / 2, (I(1, 2) + I(2, 1)) / 2}, 9);
  put_list(put, vertices, 9);
  if (!shape.faces.empty()) put_list(put, mesh.edges, 40), put_list(put, mesh.faces, 40);
  put("{:.17g}\n", 2 * shape.radius);
}

void write_bodies(const std::string& file, const Model& model, const State& state, const std::string& title) {
  const std::size_t n = model.bodies.size();
  Field x(3, static_cast<Eigen::Index>(n));
  std::vector<double> size;
  std::vector<int> types;
  bool some_mass = true;
  for (std::size_t b = 0; b < n; ++b) {
    x.col(static_cast<Eigen::Index>(b)) = state.bodies[b].position.hi;
    size.push_back(2 * model.shapes[model.bodies[b].shape].bounding_radius()), types.push_back(model.bodies[b].type);
    some_mass = some_mass && model.bodies[b].mass > 0;
  }
  Text put;
  put("{}{}\n\n", one_line(title), some_mass ? "" : "; a mass that is not given is written as 1");
  put("{} atoms\n{} bodies\n{} atom types\n\n", n, n, largest(types));
  put_box(put, box_around(x, size));
  put("\nAtoms # body\n\n");
  for (std::size_t b = 0; b < n; ++b) {
    const Body& body = model.bodies[b];
    const Vec3 at = state.bodies[b].position.hi;
    put("{} {} 1 {:.17g} {:.17g} {:.17g} {:.17g}\n", body.id, body.type, body.mass > 0 ? body.mass : 1.0, at[0], at[1], at[2]);
  }
  if (model.body_velocity.cols() > 0) {
    put("\nVelocities # body\n\n");
    const Field L = model.angular_momentum.cols() > 0 ? model.angular_momentum : Field(Field::Zero(3, x.cols()));
    for (Eigen::Index b = 0; b < x.cols(); ++b)
      put("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", model.bodies[b].id, model.body_velocity(0, b), model.body_velocity(1, b),
          model.body_velocity(2, b), L(0, b), L(1, b), L(2, b));
  }
  put("\nBodies\n\n");
  for (std::size_t b = 0; b < n; ++b)
    put_form(put, model.bodies[b], model.shapes[model.bodies[b].shape], state.bodies[b].rotation);
  put.write(file);
}

/// Of each type the mass of its first particle, or 1 where there is none.
void put_masses(Text& put, const Model& model, bool known) {
  put("\nMasses\n\n");
  for (int type = 1; type <= largest(model.type); ++type) {
    const auto first = std::find(model.type.begin(), model.type.end(), type);
    const double mass = known && first != model.type.end() ? model.mass(static_cast<int>(first - model.type.begin())) : 0;
    put("{} {:.17g}\n", type, mass > 0 ? mass : 1.0);
  }
}

enum class Written { sphere, full };

void write_particles(const std::string& file, const Model& model, const State& state, const std::string& title, Written style) {
  const int n = model.particles();
  const Field& x = state.position;
  const bool some_density = std::all_of(model.density.begin(), model.density.end(), [](double d) { return d > 0; });
  const InUse bonds = in_use(model.bonds, model.bond_types.size()), angles = in_use(model.angles, model.angle_types.size());
  const bool counted_anew = bonds.left_out() + angles.left_out() > 0;
  Text put;
  put("{}{}{}\n\n", one_line(title),
      some_density ? "" : style == Written::full ? "; a mass that is not known is written as 1" : "; a density that is not given is written as 1",
      counted_anew ? "; types that no bond or angle has are left out" : "");
  put("{} atoms\n{} bonds\n{} angles\n", n, model.bonds.size(), model.angles.size());
  put("{} atom types\n{} bond types\n{} angle types\n\n", largest(model.type), bonds.types.size(), angles.types.size());
  put_box(put, box_around(x, model.diameter));
  if (!bonds.types.empty()) put("\nBond Coeffs # harmonic\n\n");
  for (const int t : bonds.types) put("{} {:.17g} {:.17g}\n", bonds.number[t], model.bond_types[t].stiffness, model.bond_types[t].rest_length);
  if (!angles.types.empty()) {
    const bool straight = straight_at_rest(model);
    put("\nAngle Coeffs # {}\n\n", straight ? "cosine" : "cosine/shift");
    for (const int t : angles.types) {
      const AngleType& a = model.angle_types[t];
      if (straight) put("{} {:.17g}\n", angles.number[t], a.stiffness);
      else put("{} {:.17g} {:.17g}\n", angles.number[t], 2 * a.stiffness, degrees(a.rest));   // U_min = 2B, θ₀
    }
  }
  if (style == Written::full) {
    put_masses(put, model, some_density);
    put("\nAtoms # full\n\n");
    for (int i = 0; i < n; ++i) put("{} {} {} 0 {:.17g} {:.17g} {:.17g}\n", model.id[i], model.molecule[i], model.type[i], x(0, i), x(1, i), x(2, i));
  } else {
    put("\nAtoms # hybrid sphere angle\n\n");
    for (int i = 0; i < n; ++i)
      put("{} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {}\n", model.id[i], model.type[i], x(0, i), x(1, i), x(2, i),
          model.diameter[i], model.density[i] > 0 ? model.density[i] : 1.0, model.molecule[i]);
  }
  if (model.velocity.cols() > 0 && style == Written::sphere) {
    put("\nVelocities # hybrid sphere angle\n\n");
    const Field omega = model.angular_velocity.cols() > 0 ? model.angular_velocity : Field(Field::Zero(3, n));
    for (int i = 0; i < n; ++i)
      put("{} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}\n", model.id[i], model.velocity(0, i), model.velocity(1, i),
          model.velocity(2, i), omega(0, i), omega(1, i), omega(2, i));
  }
  if (!model.bonds.empty()) put("\nBonds\n\n");
  for (std::size_t k = 0; k < model.bonds.size(); ++k) {
    const Bond& b = model.bonds[k];
    put("{} {} {} {}\n", k + 1, bonds.number[b.type], model.id[b.particles[0]], model.id[b.particles[1]]);
  }
  if (!model.angles.empty()) put("\nAngles\n\n");
  for (std::size_t k = 0; k < model.angles.size(); ++k) {
    const Angle& a = model.angles[k];
    put("{} {} {} {} {}\n", k + 1, angles.number[a.type], model.id[a.particles[0]], model.id[a.particles[1]], model.id[a.particles[2]]);
  }
  put.write(file);
}

}  // namespace

double degrees(double angle) {
  if (angle == pi) return 180;
  const double near = angle * (180 / pi);
  for (const double d : {near, std::nextafter(near, 0.0), std::nextafter(near, 360.0)})
    if (d * (pi / 180) == angle) return d;
  return near;
}

bool straight_at_rest(const Model& model) {
  return std::all_of(model.angles.begin(), model.angles.end(), [&](const Angle& a) { return model.angle_types[a.type].rest == pi; });
}

Box box_around(const Field& x, const std::vector<double>& diameter) {
  Box box{x.col(0), x.col(0)};
  for (Eigen::Index i = 1; i < x.cols(); ++i)
    for (int c = 0; c < 3; ++c) box.lo[c] = std::min(box.lo[c], x(c, i)), box.hi[c] = std::max(box.hi[c], x(c, i));
  double room = *std::max_element(diameter.begin(), diameter.end());
  for (int c = 0; c < 3; ++c)
    room = std::max({room, 0.1 * (box.hi[c] - box.lo[c]), 1e-6 * std::abs(box.lo[c]), 1e-6 * std::abs(box.hi[c])});
  if (room == 0) room = 1;
  for (int c = 0; c < 3; ++c) box.lo[c] -= room, box.hi[c] += room;
  return box;
}

std::string bodies_file(const std::string& data_file) {
  return std::filesystem::path(data_file).replace_extension(".bodies.data").string();
}

void write_state(const std::string& file, const Model& model, const State& state, const std::string& title) {
  if (model.particles() > 0) write_particles(file, model, state, title, Written::sphere);
  if (!model.bodies.empty()) write_bodies(model.particles() > 0 ? bodies_file(file) : file, model, state, title);
}

void write_topology(const std::string& file, const Model& model, const State& state, const std::string& title) {
  write_particles(file, model, state, title, Written::full);
}

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
