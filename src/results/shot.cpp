#include "results/shot.hpp"

#include "model/entities.hpp"
#include "results/columns.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iterator>

namespace elamin {
namespace {

constexpr double at_touch = 1e-9;   // of the size: a gap that an event has located, whichever sign rounding gave it

Eigen::MatrixXd finite(Eigen::MatrixXd values) {
  return values.unaryExpr([](double v) { return std::isfinite(v) ? v : 0.0; });
}

// Of particles, then of bodies.
Eigen::MatrixXd joined(const Field& particles, const Field& bodies) {
  Field all(3, particles.cols() + bodies.cols());
  all << particles, bodies;
  return finite(all);
}

// What would end the quotes or the line is left out.
std::string label_in_quotes(std::string label) {
  std::erase_if(label, [](char c) { return c == '"' || c == '\\' || static_cast<unsigned char>(c) < 32; });
  return label.empty() ? "" : " label=\"" + label + "\"";
}

}  // namespace

EntityColumns columns_of(const Shot& shot) {
  const EntityColumn energy{"energy", {"energy"}, finite(shot.fields.energy.transpose())};
  const std::vector<std::string> force{"fx", "fy", "fz"};
  EntityColumns all{energy, {"contact_force", force, finite(shot.fields.contact_force)}};
  if (const Motion* m = shot.motion)
    all = {{"velocity", {"vx", "vy", "vz"}, joined(m->velocity, m->body_velocity)}, {"force", force, joined(m->force, m->body_force)}, energy};
  if (!shot.fields.sheets.empty()) {
    Field N = Field::Zero(3, entities(shot.model)), M = N;
    for (int i = 0; i < shot.model.particles(); ++i)
      if (shot.fields.sheets[i].known) N.col(i) = shot.fields.sheets[i].N, M.col(i) = shot.fields.sheets[i].M;
    all.push_back({"N", {"N11", "N22", "N12"}, finite(N)}), all.push_back({"M", {"M11", "M22", "M12"}, finite(M)});
  }
  return all;
}

std::vector<Touch> closed_contacts(const std::vector<Touch>& touches, const Model& model, const std::string& label) {
  std::vector<Touch> closed;
  for (const Touch& t : touches)
    if (t.bears || t.attracts || t.gap < 0 || (is_event(label) && t.gap <= at_touch * size_of(model, t.particle))) closed.push_back(t);
  return closed;
}

std::string xyz_frame(const Shot& shot) {
  const Model& model = shot.model;
  const EntityColumns columns = columns_of(shot);
  fmt::memory_buffer text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out, "{}\nProperties=species:S:1:pos:R:3:id:I:1:kind:I:1:molecule:I:1:radius:R:1", entities(model));
  for (const EntityColumn& c : columns) fmt::format_to(out, ":{}:R:{}", c.name == "velocity" ? "velo" : c.name, c.components.size());   // as OVITO has it
  fmt::format_to(out, " step={} {}={}{} pbc=\"F F F\"\n", shot.step, shot.motion ? "time" : "load_factor", shot.parameter, label_in_quotes(shot.label));
  for (int e = 0; e < entities(model); ++e) {
    const bool body = is_body(model, e);
    const Vec3 x = body ? shot.state.bodies[e - model.particles()].position.hi : Vec3(shot.state.position.col(e));
    fmt::format_to(out, "X {} {} {} {} {} {} {}", x[0], x[1], x[2], id_of(model, e), body ? model.bodies[e - model.particles()].type : model.type[e],
                   body ? 0 : model.molecule[e], size_of(model, e) / 2);
    for (const EntityColumn& c : columns)
      for (const double v : c.values.col(e)) fmt::format_to(out, " {}", v + 0.0);
    fmt::format_to(out, "\n");
  }
  return fmt::to_string(text);
}

}  // namespace elamin
