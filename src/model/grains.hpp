#pragma once
// Free spheres.
#include "model/model.hpp"

#include <string>
#include <vector>

namespace elamin {

struct Grains {
  std::string name;
  Field position;                                  // 3 × grains [length]
  std::vector<double> diameter;                    // of each
  double density = 0;                              // 0: not given
};

/// Appends the grains: of each set the next ids, one new type, a molecule for each grain, no bonds, and its Structure.
void add_grains(Model& model, const std::vector<Grains>& sets);

}  // namespace elamin
