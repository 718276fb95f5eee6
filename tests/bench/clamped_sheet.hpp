#pragma once
// The sheet of the benchmarks about large ones.
#include "model/sheet.hpp"

#include <cmath>

/// A rectangle with spacing, thickness and modulus 1, clamped along two rows of each edge.
inline elamin::Model clamped_sheet(double width, double height) {
  elamin::Model model;
  elamin::Sheet sheet;
  sheet.name = "sheet";
  sheet.size = {width, height};
  sheet.spacing = sheet.diameter = 1;
  sheet.bond_stiffness = std::sqrt(3) / 4, sheet.angle_stiffness = 1 / (8 * std::sqrt(3));
  add_sheets(model, {sheet});
  elamin::Support edge;
  for (int p = 0; p < model.particles(); ++p) {
    const elamin::Vec3 x = model.start.position.col(p).cwiseAbs();
    if (x[0] > width / 2 - 0.9 || x[1] > height / 2 - 0.9) edge.particles.push_back(p);
  }
  model.supports = {edge};
  return model;
}
