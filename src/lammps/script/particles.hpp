#pragma once
// The particles of a problem with what glues them, as a LAMMPS data file.
#include "lammps/script/world.hpp"

#include <map>
#include <string>
#include <vector>

namespace elamin::script {

class Particles {
 public:
  /// Those that are in any run; where two have had one id in their time, the later one gets a new one.
  explicit Particles(const World& world);

  const std::vector<int>& atoms() const { return atoms_; }       // indices, ascending
  const std::vector<int>& types(bool of_bodies = false) const { return of_bodies ? body_types_ : types_; }   // that there are, ascending
  int particles() const { return static_cast<int>(atoms_.size()) - bodies_; }
  int bodies() const { return bodies_; }
  int id(int index) const { return id_[index]; }

  /// The data file, with 17 digits; types of bonds and angles that nothing uses are left out. `stiffer`: factors of angle types.
  /// Throws Wrong if a type in use has no coefficients.
  std::string data(const std::string& title, const std::map<int, double>& stiffer, bool velocities) const;

 private:
  const World& world_;
  std::vector<int> atoms_, id_, types_, body_types_;
  int bodies_ = 0;
};

}  // namespace elamin::script
