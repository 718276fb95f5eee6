#pragma once
// Atom types that let pair_coeff say which pairs feel each other.
#include "model/model.hpp"

#include <string>
#include <vector>

namespace elamin {

/// Types from 1 of all particles, such that within every stage all pairs of two types follow the same contact tables; a type of
/// the model is kept whole where that is possible. LAMMPS's granular style (of 2021) knows nothing of special_bonds: pairs
/// that are glued too closely to touch need types of their own, at worst one a particle.
struct ExportTypes {
  /// Tables of Model::contacts between two types, −1: none. Of cohesion whatever the bonds between them, see `special`.
  struct Rule {
    int hertz = -1, lj = -1;
    bool operator==(const Rule&) const = default;
  };
  struct Stage {
    std::vector<Rule> rules;                // types × types
    int special = 0;                        // cohesion: pairs this many bonds apart or nearer feel none
  };
  int count = 0;
  std::vector<int> type;
  std::vector<Stage> stages;
  std::vector<std::string> refused;         // what types cannot say, in sentences

  const Rule& rule(std::size_t stage, int a, int b) const { return stages[stage].rules[static_cast<std::size_t>((a - 1) * count + b - 1)]; }
};

/// Of models that differ in their contacts alone, one a stage. At most `most` types.
ExportTypes export_types(const std::vector<const Model*>& stages, int most = 400);

}  // namespace elamin
