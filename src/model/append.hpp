#pragma once
// What every builder does: room for its particles, and the next ids, types and molecules.
#include "core/error.hpp"
#include "model/model.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace elamin {

/// One more than the largest of some numbers. Throws InputError if there is no room above it for `more`.
inline int next_number(const std::vector<int>& numbers, int largest, int more) {
  for (const int n : numbers) largest = std::max(largest, n);
  if (largest >= std::numeric_limits<int>::max() - more)
    throw InputError("the ids, types or molecules of the particles reach " + std::to_string(largest) +
                     "; there must be room above them for " + std::to_string(more) + " more");
  return largest + 1;
}
/// The next id and the next type of a particle or a body, which count together.
inline int next_id(const Model& model, int more) {
  int largest = 0;
  for (const Body& b : model.bodies) largest = std::max(largest, b.id);
  return next_number(model.id, largest, more);
}
inline int next_type(const Model& model, int more) {
  int largest = 0;
  for (const Body& b : model.bodies) largest = std::max(largest, b.type);
  return next_number(model.type, largest, more);
}

/// Appends structures to a model whose arrays grow once.
class Appender {
 public:
  /// Room for `more` particles. Throws InputError if the numbers of ids, types or molecules end before that.
  Appender(Model& model, int more)
      : model_(model), first_(model.particles()), type_(next_type(model, more)), molecule_(next_number(model.molecule, 0, more)) {
    const int id = next_id(model, more), total = first_ + more;
    model.start.position.conservativeResize(3, total);
    model.start.low.conservativeResize(3, total);
    model.start.position.rightCols(more).setZero();
    model.start.low.rightCols(more).setZero();
    if (model.velocity.cols() > 0) {
      model.velocity.conservativeResize(3, total);
      model.velocity.rightCols(more).setZero();
    }
    model.id.resize(total);
    std::iota(model.id.begin() + first_, model.id.end(), id);
  }

  /// The next n particles, of one new type and one new molecule; returns the index of the first one.
  int together(int n, double diameter, double density) {
    model_.molecule.resize(first_ + n, molecule_++);
    return of_one_type(n, diameter, density);
  }
  /// The same with a molecule for each.
  int apart(int n, double diameter, double density) {
    for (int i = 0; i < n; ++i) model_.molecule.push_back(molecule_++);
    return of_one_type(n, diameter, density);
  }

 private:
  int of_one_type(int n, double diameter, double density) {
    const int first = first_;
    first_ += n;
    model_.type.resize(first_, type_++);
    model_.diameter.resize(first_, diameter);
    model_.density.resize(first_, density);
    return first;
  }

  Model& model_;
  int first_, type_, molecule_;
};

/// Appends a bond type and returns its number; of angle types the same.
inline int add_type(Model& model, const BondType& type) {
  model.bond_types.push_back(type);
  return static_cast<int>(model.bond_types.size()) - 1;
}
inline int add_type(Model& model, const AngleType& type) {
  model.angle_types.push_back(type);
  return static_cast<int>(model.angle_types.size()) - 1;
}

}  // namespace elamin
