#pragma once
// The plates of data/exact/plate_*.json.
#include "model/sheet.hpp"

#include <cmath>
#include <functional>
#include <string>

namespace elamin {

/// n rows along x, particle i of row j at ((i + (j mod 2)/2) a, j a √3/2, 0), numbered row by row.
struct Plate {
  Model model;
  std::vector<std::vector<int>> rows;

  double spacing() const { return model.bond_types[0].rest_length; }
  /// The coordinates that an edge of this type holds of each particle.
  std::vector<std::array<bool, 3>> edge(const std::string& type) const {
    std::vector<std::array<bool, 3>> held(model.particles());
    const std::size_t layers = type == "two_layers_fixed" ? 2 : 1;
    for (std::size_t j = 0; j < rows.size(); ++j)
      for (std::size_t i = 0; i < rows[j].size(); ++i) {
        const bool row = j < layers || j >= rows.size() - layers, end = i < layers || i >= rows[j].size() - layers;
        const bool hinge =
            type == "straight_simply_supported" && j % 2 == 1 && !row;  // rests on nothing between the rows
        if (row || end) held[rows[j][i]] = {true, true, !hinge};
      }
    return held;
  }
  /// Holds these coordinates; at load factor 1 they are moved by `displacement` of the place.
  void hold(const std::vector<std::array<bool, 3>>& held, const std::function<Vec3(const Vec3&)>& displacement) {
    for (int p = 0; p < model.particles(); ++p)
      if (held[p] != std::array<bool, 3>{})
        model.supports.push_back({"", {p}, held[p], displacement(model.start.position.col(p)), Scaling()});
  }
};

/// Every row has m particles, or with `straight` ends the odd ones one less.
inline Plate plate(int m, int n, bool straight, double spacing, double K, double B) {
  Sheet s;
  s.name = "plate", s.spacing = s.diameter = spacing, s.density = 1;
  s.bond_stiffness = K, s.angle_stiffness = B;
  s.size = {(m - (straight ? 1 : 0.5)) * spacing, (n - 1) * spacing * std::sqrt(3) / 2};
  s.center = Vec3(s.size[0] / 2, s.size[1] / 2, 0);
  Plate p;
  add_sheets(p.model, {s});
  p.rows.resize(n);
  for (int i = 0; i < p.model.particles(); ++i)
    p.rows.at(std::lround(p.model.start.position(1, i) / (spacing * std::sqrt(3) / 2))).push_back(i);
  return p;
}

}  // namespace elamin
