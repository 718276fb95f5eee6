#pragma once
// States side by side, in one scale.
#include "figures/drawing.hpp"
#include "figures/scene.hpp"

namespace elamin {

/// Draws the scenes in rows of equal panels between two sides of the page: particles as discs, bonds coloured by tension with a scale below,
/// bodies, walls. What lies in a plane of two axes is seen along the third, all else from a fixed direction, 30° beside −y and 20° above.
/// Returns the lower end of all that.
double draw_shapes(Drawing& drawing, const std::vector<Scene>& scenes, const Vec2& corner, double width);

}  // namespace elamin
