#include "study/describe.hpp"

#include "core/dense.hpp"
#include "core/near_pairs.hpp"
#include "laws/rounded/closest.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

namespace elamin {

namespace {

std::string counted(std::size_t n, const char* one, const char* many) { return fmt::format("{} {}", n, n == 1 ? one : many); }

std::string corners_of(const RoundedShape& s) {
  const std::string rounding = fmt::format(", rounding radius {:.10g}", s.radius);
  if (s.vertices.size() == 1) return "a sphere" + rounding;
  if (s.vertices.size() == 2) return fmt::format("a rod of length {:.10g}", s.shortest_edge) + rounding;
  return fmt::format("{}, {}, {}", counted(s.vertices.size(), "vertex", "vertices"), counted(s.edges.size(), "edge", "edges"),
                     counted(s.faces.size(), "face", "faces")) + rounding;
}

// The body's shape and size; extents are along the axes of its frame, the rounding included.
std::string shape_lines(const RoundedShape& s) {
  Vec3 lo = s.vertices.front(), hi = lo;
  for (const Vec3& v : s.vertices) lo = lo.cwiseMin(v), hi = hi.cwiseMax(v);
  const Vec3 size = hi - lo + Vec3::Constant(2 * s.radius);
  return fmt::format("  {}; extents [{:.10g}, {:.10g}, {:.10g}], reach {:.10g} from the centre of mass, volume {:.10g}\n", corners_of(s), size[0],
                     size[1], size[2], s.bounding_radius(), mass_properties(s).volume);
}

std::string mass_line(const Body& b) {
  if (!(b.mass > 0)) return "  no mass\n";
  const Vec3 moments = symmetric_eigen(b.inertia).values;
  return fmt::format("  mass {:.10g}, principal moments of inertia {:.10g}, {:.10g}, {:.10g}\n", b.mass, moments[0], moments[1], moments[2]);
}

std::string place_line(const Pose& pose) {
  const Vec3 x = pose.position.hi;
  return fmt::format("  centre of mass at [{:.10g}, {:.10g}, {:.10g}]\n", x[0], x[1], x[2]);
}

}  // namespace

std::string describe_bodies(const Model& model, const Structure& s) {
  if (s.bodies == 1) {
    const Body& b = model.bodies[s.first_body];
    return shape_lines(model.shapes[b.shape]) + mass_line(b) + place_line(model.start.bodies[s.first_body]);
  }
  std::string text;
  for (std::size_t shape = 0; shape < model.shapes.size(); ++shape) {
    int count = 0;
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (int b = s.first_body; b < s.first_body + s.bodies; ++b)
      if (model.bodies[b].shape == static_cast<int>(shape))
        ++count, least = std::min(least, model.bodies[b].mass), most = std::max(most, model.bodies[b].mass);
    if (count == 0) continue;
    const std::string mass = most == 0       ? "no mass"
                             : least == most ? fmt::format("mass {:.10g}", most)
                                             : fmt::format("masses {:.10g} to {:.10g}", least, most);
    text += fmt::format("  {} of one shape, {}:\n  {}", counted(count, "body", "bodies"), mass, shape_lines(model.shapes[shape]));
  }
  return text;
}

std::vector<std::string> deep_overlaps(const Model& model, Energy& energy, const State& state) {
  constexpr std::size_t most = 10;
  constexpr double deep = 0.25;                               // of the smaller diameter: far beyond what a law of contact means
  std::set<IndexPair> particles;
  const auto overlap = [&](int i, int j) { return (model.diameter[i] + model.diameter[j]) / 2 - (state.at(j) - state.at(i)).hi.norm(); };
  const auto take = [&](int i, int j) {
    if (overlap(i, j) > deep * std::min(model.diameter[i], model.diameter[j])) particles.insert({std::min(i, j), std::max(i, j)});
  };
  for (const Touch& t : energy.touches(state))
    if (t.other >= 0 && std::max(t.particle, t.other) < model.particles()) take(t.particle, t.other);
  std::vector<double> radii(model.diameter.begin(), model.diameter.end());
  for (double& r : radii) r /= 2;
  for (const Bond& b : model.bonds) radii[b.particles[0]] = radii[b.particles[1]] = 0;
  for (const Glued& g : model.glued) radii[g.particle] = 0;
  for (const auto& [i, j] : near_pairs(state.position, radii, [](int, int) { return true; })) take(i, j);
  std::vector<std::string> lines;
  for (const auto& [i, j] : particles)
    if (lines.size() < most)
      lines.push_back(fmt::format("{} and {} overlap by {:.3g} of a diameter at the start; no law of contact means much there", called(model, i), called(model, j),
                                  overlap(i, j) / std::min(model.diameter[i], model.diameter[j])));
  std::size_t count = particles.size();
  const BodyRules& rules = energy.body_rules();
  for (const auto& [i, j] : energy.body_neighbours().pairs())
    if (cores_overlap(rules.body(i, state), rules.body(j, state)) && ++count <= most)
      lines.push_back(fmt::format("the cores of {} and {} overlap, deeper than their rounding; no law of rounded bodies means much there",
                                  called(model, i), called(model, j)));
  if (count > most) lines.push_back(fmt::format("and {} more pairs overlap", count - most));
  return lines;
}

}  // namespace elamin
