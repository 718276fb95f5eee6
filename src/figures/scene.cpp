#include "figures/scene.hpp"

#include "core/error.hpp"
#include "core/suggest.hpp"
#include "results/stored_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>

namespace elamin {
namespace {

namespace fs = std::filesystem;

// A table with these columns, whose entries are numbers; what is empty is not finite.
class NumberTable {
 public:
  explicit NumberTable(std::string file) : file_(std::move(file)), table_(read_table(file_)) {}
  std::size_t rows() const { return table_.rows.size(); }
  double operator()(std::size_t row, const char* column) const {
    return as_number(cell(row, column)).value_or(std::numeric_limits<double>::quiet_NaN());
  }
  std::string text(std::size_t row, const char* column) const { return csv_text(cell(row, column)); }
  Vec3 vector(std::size_t row, std::array<const char*, 3> columns) const {
    return {(*this)(row, columns[0]), (*this)(row, columns[1]), (*this)(row, columns[2])};
  }

 private:
  const Cell& cell(std::size_t row, const char* column) const {
    const int c = table_.column(column);
    if (c < 0) throw InputError(fmt::format("{}: has no column {}", file_, in_quotes(column)));
    return table_.rows[row][c];
  }
  std::string file_;
  Table table_;
};

std::vector<std::string> states_in(const fs::path& directory) {
  const std::string extension = ".particles.csv";
  std::vector<std::string> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error))
    if (const std::string name = entry.path().filename().string(); name.ends_with(extension)) all.push_back(name.substr(0, name.size() - extension.size()));
  std::sort(all.begin(), all.end());
  return all;
}

// The state of a step of the path, without the end of its name.
std::string stem_of_step(const std::string& directory, const std::string& step) {
  const StoredRun run = read_run(directory);
  const int column = run.path.column("step");
  std::vector<std::string> known;
  for (const StoredState& s : run.states) {
    if (column < 0 || s.row < 0 || !s.file.ends_with(".data")) continue;
    known.push_back(csv_text(run.path.rows[s.row][column]));
    if (known.back() == step) return s.file.substr(0, s.file.size() - 5);
  }
  throw InputError(fmt::format("{}: no state of step {} was kept; there are those of the steps {} ([path] frames or every keep more)", directory, step, listed(known)));
}

Region wall_in(const NumberTable& walls, std::size_t row) {
  const auto shape = std::find(shape_names.begin(), shape_names.end(), walls.text(row, "shape"));
  Region r;
  if (shape != shape_names.end()) r.shape = static_cast<Shape>(shape - shape_names.begin());
  if (r.shape == Shape::block) {
    r.lo = walls.vector(row, {"xlo", "ylo", "zlo"}), r.hi = walls.vector(row, {"xhi", "yhi", "zhi"});
    return r;
  }
  r.center = walls.vector(row, {"x", "y", "z"});
  if (r.shape == Shape::sphere) r.radius = walls(row, "radius_lo");
  if (r.shape == Shape::plane) r.normal = walls.vector(row, {"nx", "ny", "nz"});
  if (r.shape != Shape::cylinder && r.shape != Shape::cone) return r;
  walls.vector(row, {"nx", "ny", "nz"}).maxCoeff(&r.axis);
  if (const double lo = walls(row, "lo"); std::isfinite(lo)) r.axial_lo = lo;
  if (const double hi = walls(row, "hi"); std::isfinite(hi)) r.axial_hi = hi;
  r.radius = r.radius_lo = walls(row, "radius_lo"), r.radius_hi = walls(row, "radius_hi");
  return r;
}

// The picture of bodies that write_picture has written: one body after the other, told apart by what the polygons share.
std::vector<Scene::Body> bodies_in(const std::string& file) {
  std::ifstream in(file);
  if (!in) return {};
  std::string word;
  std::vector<Vec3> points;
  std::vector<std::vector<int>> polygons;
  std::vector<int> id;
  while (in >> word) {
    std::size_t n = 0, all = 0;
    if (word == "POINTS" && in >> n >> word) {
      points.resize(n);
      for (Vec3& p : points) in >> p[0] >> p[1] >> p[2];
    } else if (word == "POLYGONS" && in >> n >> all) {
      polygons.resize(n);
      for (std::vector<int>& p : polygons) {
        in >> all, p.resize(in ? all : 0);
        for (int& i : p) in >> i;
      }
    } else if (word == "SCALARS" && in >> word && word == "id") {
      id.resize(polygons.size());
      in >> word >> word >> word >> word;                          // int 1 LOOKUP_TABLE default
      for (int& i : id) in >> i;
    }
  }
  const auto known = [&](int i) { return i >= 0 && i < static_cast<int>(points.size()); };
  std::map<int, std::pair<Scene::Body, std::map<int, int>>> bodies;       // with the numbers of the points in each
  for (std::size_t k = 0; k < id.size(); ++k) {
    auto& [body, number] = bodies[id[k]];
    if (!std::all_of(polygons[k].begin(), polygons[k].end(), known)) throw InputError(file + ": is no picture that elamin has written");
    for (int& i : polygons[k]) {
      const auto [at, is_new] = number.try_emplace(i, static_cast<int>(body.points.size()));
      if (is_new) body.points.push_back(points[i]);
      i = at->second;
    }
    body.polygons.push_back(polygons[k]);
  }
  std::vector<Scene::Body> all;
  for (auto& [key, body] : bodies) all.push_back(std::move(body.first));
  return all;
}

std::string no_mode(const std::string& directory, const std::string& label) {
  int there = 0;
  while (fs::exists(fs::path(directory) / "modes" / fmt::format("mode-{}.csv", there + 1))) ++there;
  return fmt::format("{}: has no {}; {}", directory, in_quotes(label), there == 0 ? "it has no modes" : fmt::format("there are mode:1 to mode:{}", there));
}

}  // namespace

Scene read_scene(const std::string& directory, const std::string& label) {
  Scene scene;
  scene.label = label;
  const fs::path states = fs::path(directory) / "states";
  std::string name = label, vectors;                       // vectors: file and first column of what it is moved along
  const char* first = "ux1";
  bool moved = false;
  std::replace(name.begin(), name.end(), ':', '-');
  if (name.ends_with("+mode")) name.resize(name.size() - 5), moved = true;
  if (label.starts_with("mode:")) vectors = (fs::path(directory) / "modes" / (name + ".csv")).string(), name = "final", first = "ux";
  const std::string stem = name.starts_with("step=") ? stem_of_step(directory, name.substr(5)) : (states / name).string();
  if (!fs::exists(stem + ".particles.csv")) {
    const std::vector<std::string> known = states_in(states);
    throw InputError(fmt::format("{}.particles.csv: is not there; {}", stem,
                                 known.empty() ? "this run has left no such states: run it again" : "there are the states " + listed(known) + did_you_mean(name, known)));
  }
  if (moved) vectors = stem + ".modes.csv";
  if (moved && !fs::exists(vectors))
    throw InputError(fmt::format("{}: the state {} has no null vectors to be moved along, {}.modes.csv; events have them", directory,
                                 in_quotes(name), name));
  if (!moved && !vectors.empty() && !fs::exists(vectors)) throw InputError(no_mode(directory, label));
  const NumberTable particles(stem + ".particles.csv");
  std::map<int, int> number;                               // of a particle, by its id
  for (std::size_t k = 0; k < particles.rows(); ++k) {
    if (particles.text(k, "kind") == "body") continue;
    number[static_cast<int>(particles(k, "id"))] = static_cast<int>(scene.particles.size());
    scene.particles.push_back({particles.vector(k, {"x", "y", "z"}), particles(k, "radius")});
  }
  if (fs::exists(stem + ".bonds.csv")) {
    const NumberTable bonds(stem + ".bonds.csv");
    for (std::size_t k = 0; k < bonds.rows(); ++k) {
      const auto i = number.find(static_cast<int>(bonds(k, "first"))), j = number.find(static_cast<int>(bonds(k, "second")));
      if (i == number.end() || j == number.end()) throw InputError(fmt::format("{}.bonds.csv: a bond of a particle that is not in {}.particles.csv", stem, name));
      scene.bonds.push_back({i->second, j->second, bonds(k, "tension")});
    }
  }
  if (fs::exists(stem + ".walls.csv")) {
    const NumberTable walls(stem + ".walls.csv");
    for (std::size_t k = 0; k < walls.rows(); ++k) scene.walls.push_back(wall_in(walls, k));
  }
  scene.bodies = bodies_in(stem + ".vtk");
  if (vectors.empty()) return scene;
  const NumberTable moves(vectors);
  const std::string axis(first);
  const auto component = [&](char c) { return axis.substr(0, 1) + c + axis.substr(2); };
  const std::string y = component('y'), z = component('z');
  double most = 0;
  Eigen::AlignedBox3d box;
  for (const Scene::Particle& p : scene.particles) box.extend(p.at);
  const auto along = [&](std::size_t k) { return moves.vector(k, {first, y.c_str(), z.c_str()}); };
  for (std::size_t k = 0; k < moves.rows(); ++k) most = std::max(most, along(k).norm());
  for (std::size_t k = 0; k < moves.rows() && most > 0; ++k) {
    const auto i = number.find(static_cast<int>(moves(k, "id")));
    if (i != number.end()) scene.particles[i->second].at += 0.1 * box.sizes().norm() / most * along(k);
  }
  return scene;
}

std::vector<std::vector<Vec3>> outlines(const Region& wall, const Eigen::AlignedBox3d& box) {
  std::vector<std::vector<Vec3>> lines;
  constexpr int pieces = 72;
  const auto ring = [&](const Vec3& center, const Vec3& u, const Vec3& v, double radius) {
    std::vector<Vec3> line;
    for (int k = 0; k <= pieces; ++k) line.push_back(center + radius * (std::cos(2 * pi * k / pieces) * u + std::sin(2 * pi * k / pieces) * v));
    lines.push_back(line);
  };
  switch (wall.shape) {
    case Shape::plane: {                                   // a square around the foot of the box's centre
      const Vec3 n = wall.normal, foot = box.center() - n.dot(box.center() - wall.center) * n;
      Vec3::Index least = 0;
      n.cwiseAbs().minCoeff(&least);
      const Vec3 u = n.cross(Vec3(Vec3::Unit(least))).normalized() * box.diagonal().norm() / 2, v = n.cross(u);
      lines.push_back({foot + u + v, foot - u + v, foot - u - v, foot + u - v, foot + u + v});
      break;
    }
    case Shape::block:
      for (int c = 0; c < 3; ++c)
        for (int k = 0; k < 4; ++k) {
          Vec3 from = wall.lo, to;
          if (k & 1) from[(c + 1) % 3] = wall.hi[(c + 1) % 3];
          if (k & 2) from[(c + 2) % 3] = wall.hi[(c + 2) % 3];
          to = from, to[c] = wall.hi[c];
          lines.push_back({from, to});
        }
      break;
    case Shape::sphere:
      for (int c = 0; c < 3; ++c) ring(wall.center, Vec3::Unit(c), Vec3::Unit((c + 1) % 3), wall.radius);
      break;
    case Shape::cylinder:
    case Shape::cone: {
      const Vec3 axis = Vec3::Unit(wall.axis), u = Vec3::Unit((wall.axis + 1) % 3), v = Vec3::Unit((wall.axis + 2) % 3);
      const double lo = std::max(wall.axial_lo, box.min()[wall.axis]), hi = std::min(wall.axial_hi, box.max()[wall.axis]);
      const auto radius = [&](double along) {
        if (wall.shape == Shape::cylinder) return wall.radius;
        return wall.radius_lo + (along - wall.axial_lo) / (wall.axial_hi - wall.axial_lo) * (wall.radius_hi - wall.radius_lo);
      };
      const Vec3 foot = wall.center - wall.center[wall.axis] * axis;
      for (const double end : {lo, hi}) ring(foot + end * axis, u, v, radius(end));
      for (const Vec3& side : {u, v, Vec3(-u), Vec3(-v)}) lines.push_back({foot + lo * axis + radius(lo) * side, foot + hi * axis + radius(hi) * side});
      break;
    }
  }
  return lines;
}

}  // namespace elamin
