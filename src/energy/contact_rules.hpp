#pragma once
// Which pairs of particles feel each other at all, and by which table: a matter of the topology alone.
#include "model/model.hpp"

#include <cstdint>

namespace elamin {

/// For every pair of particles the last [Hertz, Lennard-Jones] table that speaks of it, unless the pair is glued so
/// closely that the table leaves it out. Particles that belong to the same sides of the same tables are of one class;
/// tables are looked up by pairs of classes.
class ContactRules {
 public:
  explicit ContactRules(const Model& model);

  /// Whether any particle is in a table.
  bool any() const { return any_; }
  /// Index into Model::contacts of the table in force between i and j, −1: none.
  int hertz(int i, int j) const { return in_force(hertz_, i, j); }
  int lj(int i, int j) const { return in_force(lj_, i, j); }
  /// Half of the largest distance at which particle i may feel another of its own cutoff: a pair feels each other only
  /// within cutoff_radius(i) + cutoff_radius(j); 0: it is in no table. [length]
  double cutoff_radius(int i) const { return cutoff_radius_[i]; }
  /// How many bonds a table leaves out: what it says; by default, for Hertz as many as overlap at their rest lengths (or,
  /// in a structure that was built at rest, as built), and at least 1; for Lennard-Jones 1.
  int excluded_bonds(int table) const { return excluded_[table]; }

 private:
  int in_force(const std::vector<int>& tables, int i, int j) const {
    const int t = tables[class_[i] * classes_ + class_[j]];
    return t >= 0 && bonds_apart(i, j) > excluded_[t] ? t : -1;
  }
  /// Number of bonds from i to j, or a large number beyond the farthest that matters.
  int bonds_apart(int i, int j) const;
  void classify(const Model& model);
  void exclude(const Model& model);

  bool any_ = false;
  std::vector<int> class_;             // of each particle
  std::size_t classes_ = 0;
  std::vector<int> hertz_, lj_;        // classes × classes: the table, −1: none
  std::vector<double> cutoff_radius_;
  std::vector<int> excluded_;          // of each table
  std::vector<std::int64_t> start_;    // of each particle in near_
  struct Near { int particle, bonds; };
  std::vector<Near> near_;             // by particle, ascending: glued to it through few bonds
};

}  // namespace elamin
