#pragma once
// What a stored state looks like: particles, bonds, bodies and walls, from the files that a run leaves beside it.
#include "figures/drawing.hpp"
#include "laws/region.hpp"

#include <string>
#include <vector>

namespace elamin {

struct Scene {
  struct Particle { Vec3 at; double radius; };
  struct Bond { int first, second; double tension; };      // particles by their place in the list
  struct Body { std::vector<Vec3> points; std::vector<std::vector<int>> polygons; };   // see Surface
  std::string label;
  std::vector<Particle> particles;
  std::vector<Bond> bonds;
  std::vector<Body> bodies;
  std::vector<Region> walls;
};

/// Reads DIR/states/LABEL.particles.csv and what stands beside it. LABEL: as in events.csv, "initial" or "final"; "step=K", a frame of a
/// path, DIR/frames/K.particles.csv, or the state that this step's label names; with "+mode" behind it
/// moved along its first null vector; or mode:K, the last state moved along a mode of modes/. Moved: by a tenth of its size. Throws
/// InputError if there is no such state or a file cannot be understood.
Scene read_scene(const std::string& directory, const std::string& label);

/// Edges and outlines of a wall's surface in space, as far as it goes through a box: lines.
std::vector<std::vector<Vec3>> outlines(const Region& wall, const Eigen::AlignedBox3d& box);

// States side by side, in one scale.

/// Draws the scenes in rows of equal panels between two sides of the page: particles as discs, bonds coloured by tension with a scale below,
/// bodies, walls. What lies in a plane of two axes is seen along the third, all else from a fixed direction, 30° beside −y and 20° above.
/// Returns the lower end of all that.
double draw_shapes(Drawing& drawing, const std::vector<Scene>& scenes, const Vec2& corner, double width);

}  // namespace elamin
