#include "figures/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

namespace elamin {
namespace {

constexpr double caption_type = 6.5;
const std::string ground = "#e4e4e4", edge = "#444444", wall_colour = "#777777";

// Where things are on the page, before scale and shift: u to the right, v up, w towards the eye.
struct View {
  Vec3 u, v, w;
  Vec2 of(const Vec3& x) const { return {u.dot(x), v.dot(x)}; }
};

void extend(Eigen::AlignedBox3d& box, const Scene& scene) {
  for (const Scene::Particle& p : scene.particles) box.extend(Vec3(p.at.array() - p.radius)), box.extend(Vec3(p.at.array() + p.radius));
  for (const Scene::Body& b : scene.bodies)
    for (const Vec3& x : b.points) box.extend(x);
}

View view_of(const std::vector<Scene>& scenes) {
  Eigen::AlignedBox3d centers;
  bool solid = false;
  for (const Scene& s : scenes) {
    for (const Scene::Particle& p : s.particles) centers.extend(p.at);
    solid = solid || !s.bodies.empty();
  }
  if (!solid && !centers.isEmpty()) {
    const Vec3 sides = centers.sizes();
    for (const int c : {1, 0, 2})                           // along y, x, z
      if (sides[c] <= 1e-6 * sides.maxCoeff()) {
        if (c == 1) return {Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitY()};
        if (c == 0) return {Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX()};
        return {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
      }
  }
  const double beside = pi / 6, above = pi / 9;
  const Vec3 u(std::cos(beside), std::sin(beside), 0), back(-std::sin(beside), std::cos(beside), 0);
  return {u, std::sin(above) * back + std::cos(above) * Vec3::UnitZ(), -std::cos(above) * back + std::sin(above) * Vec3::UnitZ()};
}

// From compression over none to tension: blue, grey, vermillion.
constexpr int shades = 9;
std::string shade(int k) {
  static const std::array<Vec3, 3> colours{Vec3(0, 0x72, 0xb2), Vec3(0xb4, 0xb4, 0xb4), Vec3(0xd5, 0x5e, 0x00)};
  const double at = 2.0 * k / (shades - 1);
  const int part = at < 1 ? 0 : 1;
  const Vec3 c = colours[part] + (at - part) * (colours[part + 1] - colours[part]);
  return fmt::format("#{:02x}{:02x}{:02x}", std::lround(c[0]), std::lround(c[1]), std::lround(c[2]));
}

double largest_tension(const std::vector<Scene>& scenes) {
  double most = 0;
  for (const Scene& s : scenes)
    for (const Scene::Bond& b : s.bonds)
      if (std::isfinite(b.tension)) most = std::max(most, std::abs(b.tension));
  return most;
}

// Corners of the convex hull, counterclockwise (Andrew 1979).
Polyline hull_of(Polyline points) {
  const auto before = [](const Vec2& a, const Vec2& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); };
  std::sort(points.begin(), points.end(), before);
  const auto turns_left = [](const Vec2& a, const Vec2& b, const Vec2& c) { return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x() > 0; };
  Polyline hull;
  for (const bool upper : {false, true}) {
    const std::size_t begin = hull.size();
    for (const Vec2& p : points) {
      while (hull.size() >= begin + 2 && !turns_left(hull[hull.size() - 2], hull.back(), p)) hull.pop_back();
      hull.push_back(p);
    }
    hull.pop_back();
    if (!upper) std::reverse(points.begin(), points.end());
  }
  return hull;
}

class Panel {
 public:
  Panel(Drawing& drawing, const View& view, const Vec2& middle, const Vec2& on_page, double scale, double largest)
      : drawing_(drawing), view_(view), middle_(middle), on_page_(on_page), scale_(scale), largest_(largest) {}

  void draw(const Scene& scene, const Eigen::AlignedBox3d& box) const {
    std::vector<Polyline> walls;
    for (const Region& wall : scene.walls)
      for (const std::vector<Vec3>& line : outlines(wall, box)) {
        walls.emplace_back();
        for (const Vec3& x : line) walls.back().push_back(at(x));
        walls.back() = thinned(walls.back(), 0.02);
      }
    drawing_.lines(walls, {wall_colour, 0.6});
    particles(scene), bonds(scene), bodies(scene);
  }

 private:
  Vec2 at(const Vec3& x) const {
    const Vec2 p = scale_ * (view_.of(x) - middle_);
    return on_page_ + Vec2(p.x(), -p.y());
  }

  // From the back to the front; many, but for far larger ones among them, and small ones as plain dots.
  void particles(const Scene& scene) const {
    constexpr std::size_t many = 400;
    constexpr double visible = 0.5;                         // [pt]
    std::vector<std::size_t> order(scene.particles.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return view_.w.dot(scene.particles[a].at) < view_.w.dot(scene.particles[b].at);
    });
    std::vector<double> radii;
    for (const Scene::Particle& p : scene.particles) radii.push_back(p.radius);
    std::sort(radii.begin(), radii.end());
    const double middling = radii.empty() ? 0 : radii[radii.size() / 2];
    std::vector<std::size_t> circles;
    std::map<long, std::vector<Vec2>> by_radius;            // dots, in hundredths
    const bool in_bonds = scene.bonds.size() > many;        // a sheet: its bonds show it
    for (const std::size_t k : order) {
      const double radius = scale_ * scene.particles[k].radius;
      if (radius >= visible && (order.size() <= many || scene.particles[k].radius > 2 * middling)) circles.push_back(k);
      else if (!in_bonds && (radius >= visible || scene.bonds.empty()))
        by_radius[std::lround(100 * std::max(radius, 0.2))].push_back(at(scene.particles[k].at));
    }
    for (const auto& [radius, centers] : by_radius) drawing_.discs(centers, 0.01 * static_cast<double>(radius), "#999999");
    for (const std::size_t k : circles) {
      const double radius = scale_ * scene.particles[k].radius;
      drawing_.circle(at(scene.particles[k].at), radius, ground, {edge, std::min(0.4, radius / 5)});
    }
  }

  void bonds(const Scene& scene) const {
    const bool many = scene.bonds.size() > 1000;
    std::array<std::vector<Polyline>, shades> lines;
    for (const Scene::Bond& b : scene.bonds) {
      const double part = largest_ > 0 && std::isfinite(b.tension) ? b.tension / largest_ : 0;
      const int k = static_cast<int>(std::lround((part + 1) / 2 * (shades - 1)));
      const auto end = [&](int particle) {                  // of many to a tenth of a point: half the text
        const Vec2 place = at(scene.particles[particle].at);
        return many ? Vec2((10 * place).array().round() / 10) : place;
      };
      const Vec2 from = end(b.first), to = end(b.second);
      std::vector<Polyline>& same = lines[k];
      if (!same.empty() && same.back().back() == from) same.back().push_back(to);      // a chain
      else same.push_back({from, to});
    }
    for (std::vector<Polyline>& same : lines)
      for (Polyline& line : same) line = thinned(line, 0.02);
    for (int k = 0; k < shades; ++k) drawing_.lines(lines[k], {shade(k), many ? 0.35 : 1.0});
  }

  void bodies(const Scene& scene) const {
    std::vector<const Scene::Body*> order;
    for (const Scene::Body& b : scene.bodies) order.push_back(&b);
    const auto depth = [&](const Scene::Body* b) {
      Vec3 sum = Vec3::Zero();
      for (const Vec3& x : b->points) sum += x;
      return view_.w.dot(sum) / static_cast<double>(std::max<std::size_t>(b->points.size(), 1));
    };
    std::stable_sort(order.begin(), order.end(), [&](const auto* a, const auto* b) { return depth(a) < depth(b); });
    for (const Scene::Body* b : order) {
      Polyline all;
      for (const Vec3& x : b->points) all.push_back(at(x));
      if (all.size() > 2) drawing_.area(thinned(hull_of(all), 0.02), ground, {edge, 0.5});
      for (const Polyline& face : large_faces(*b)) drawing_.area(face, "", {edge, 0.3});
    }
  }

  // The flat faces that are seen, not those of the rounded edges.
  std::vector<Polyline> large_faces(const Scene::Body& body) const {
    std::vector<std::pair<double, Polyline>> seen;
    double most = 0;
    for (const std::vector<int>& polygon : body.polygons) {
      Vec3 area = Vec3::Zero();                             // twice
      const auto point = [&](std::size_t i) { return body.points[polygon[i]]; };
      for (std::size_t i = 2; i < polygon.size(); ++i) area += (point(i - 1) - point(0)).cross(point(i) - point(0));
      most = std::max(most, area.norm());
      if (view_.w.dot(area) <= 1e-9 * area.norm()) continue;
      seen.emplace_back(area.norm(), Polyline{});
      for (std::size_t i = 0; i < polygon.size(); ++i) seen.back().second.push_back(at(point(i)));
    }
    std::vector<Polyline> large;
    for (auto& [area, face] : seen)
      if (area > 0.1 * most && seen.size() < body.polygons.size() && most > 0 && body.polygons.size() > 6) large.push_back(std::move(face));
    return large.size() <= 6 ? large : std::vector<Polyline>{};            // balls and rods have no faces
  }

  Drawing& drawing_;
  const View& view_;
  Vec2 middle_, on_page_;                                   // where the view's middle is on the page
  double scale_, largest_;
};

// From −most to most; returns its lower end.
double draw_scale(Drawing& drawing, double most, const Vec2& corner, double width) {
  constexpr double box = 6.5, high = 4;
  const std::string end = fmt::format("{:.2g}", most);
  const double left = corner.x() + (width - shades * box) / 2;
  for (int k = 0; k < shades; ++k) {
    const Vec2 at(left + k * box, corner.y());
    drawing.area({at, at + Vec2(box, 0), at + Vec2(box, high), at + Vec2(0, high)}, shade(k), {"", 0});
  }
  drawing.words({left - 3, corner.y() + 4.3}, "compression  −" + end, Anchor::end, caption_type);
  drawing.words({left + shades * box + 3, corner.y() + 4.3}, end + "  tension", Anchor::start, caption_type);
  return corner.y() + high + 4;
}

}  // namespace

double draw_shapes(Drawing& drawing, const std::vector<Scene>& scenes, const Vec2& corner, double width) {
  constexpr double gap = 6, highest = 150, caption = 10;
  Eigen::AlignedBox3d box;
  for (const Scene& s : scenes) extend(box, s);
  if (box.isEmpty()) return corner.y();
  const Vec3 room = Vec3::Constant(0.04 * box.sizes().maxCoeff());
  box.extend(Vec3(box.min() - room)), box.extend(Vec3(box.max() + room));
  const View view = view_of(scenes);
  Eigen::AlignedBox2d seen;
  for (const Scene& s : scenes) {
    for (const Scene::Particle& p : s.particles)
      for (const double r : {-p.radius, p.radius}) seen.extend(Vec2(view.of(p.at).array() + r));
    for (const Scene::Body& b : s.bodies)
      for (const Vec3& x : b.points) seen.extend(view.of(x));
  }
  const double margin = 0.04 * seen.sizes().maxCoeff();
  const Vec2 size = seen.sizes().array() + 2 * margin;
  // As many columns as make the pictures largest.
  int columns = 1;
  double scale = 0;
  const int n = static_cast<int>(scenes.size());
  for (int c = 1; c <= n; ++c) {
    const double fits = std::min((width - (c - 1) * gap) / c / size.x(), highest / size.y());
    const int rows = (n + c - 1) / c;
    const double its = std::min(fits, 2 * highest / rows / size.y());
    if (its >= scale * (1 - 1e-9)) scale = its, columns = c;
  }
  const double across = (width - (columns - 1) * gap) / columns, high = scale * size.y();
  const double largest = largest_tension(scenes);
  double y = corner.y();
  for (int k = 0; k < n; ++k) {
    const int column = k % columns;
    if (k > 0 && column == 0) y += high + caption + 4;
    const int in_row = std::min(columns, n - (k - column));
    const double left = corner.x() + (width - in_row * across - (in_row - 1) * gap) / 2 + column * (across + gap);
    const Scene& scene = scenes[k];
    drawing.clip({left, y}, {left + across, y + high});
    Panel(drawing, view, seen.center(), {left + across / 2, y + high / 2}, scale, largest).draw(scene, box);
    drawing.end_clip();
    drawing.words({left + across / 2, y + high + 7.5}, scene.label, Anchor::middle, caption_type);
  }
  y += high + caption + 3;
  return largest > 0 ? draw_scale(drawing, largest, {corner.x(), y}, width) : y;
}

}  // namespace elamin
