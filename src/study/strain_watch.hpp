#pragma once
// Whether bonds and angles stay where the model means something: a beam or a sheet of glued particles is one of small strains.
#include "core/archive.hpp"
#include "model/model.hpp"

#include <string>
#include <vector>

namespace elamin {

/// The largest strain |r − r₀|/r₀ of a bond and the largest rotation |φ − φ₀| of an angle from rest over the states that it looks at; what has
/// no stiffness does not count.
class StrainWatch {
 public:
  /// model: that in force; `where`: "load factor 0.3".
  void look(const Model& model, const State& state, const std::string& where);

  /// A sentence each if a strain has been above 0.1, a rotation above 60°: how large, between whom, where, and from where on.
  std::vector<std::string> warnings() const;
  void carry(Archive& archive) { archive(strain_, bend_); }

 private:
  struct Largest {
    double value = 0;
    std::string whose, where, since;            // since: where the limit was passed first; "" it was not
    bool grows(double v, double limit, const std::string& where);
  };
  Largest strain_, bend_;
};

}  // namespace elamin
