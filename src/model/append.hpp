#pragma once
// What every builder does: room for its particles, and the next ids, types and molecules.
#include "core/error.hpp"
#include "model/model.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

namespace elamin {

/// Appends structures to a model whose arrays grow once.
class Appender {
 public:
  /// Room for `more` particles. Throws InputError if the numbers of ids, types or molecules end before that.
  Appender(Model& model, int more)
      : model_(model), first_(model.particles()), type_(next(model.type, more)), molecule_(next(model.molecule, more)) {
    const int id = next(model.id, more), total = first_ + more;
    model.start.position.conservativeResize(3, total);
    model.start.tail.conservativeResize(3, total);
    model.start.position.rightCols(more).setZero();
    model.start.tail.rightCols(more).setZero();
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
  static int next(const std::vector<int>& numbers, int more) {
    const int largest = numbers.empty() ? 0 : *std::max_element(numbers.begin(), numbers.end());
    if (largest >= std::numeric_limits<int>::max() - more)
      throw InputError("the ids, types or molecules of the particles reach " + std::to_string(largest) +
                       "; there must be room above them for " + std::to_string(more) + " more");
    return largest + 1;
  }
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
