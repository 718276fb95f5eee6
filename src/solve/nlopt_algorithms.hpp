#pragma once
// NLopt's algorithms that can minimise an energy, and how large a problem each is fit for.
#include <nlopt.h>

#include <limits>
#include <span>
#include <string>

namespace elamin {

struct NloptAlgorithm {
  enum class Kind { gradient, derivative_free, global };
  const char* name;                // NLopt's without NLOPT_
  nlopt_algorithm code;
  Kind kind;
  int least = 1;                   // dofs
  int most = std::numeric_limits<int>::max();

  bool local() const { return kind != Kind::global; }
  bool random_starts() const { return code == NLOPT_G_MLSL || code == NLOPT_G_MLSL_LDS; }   // of local searches
};

std::span<const NloptAlgorithm> nlopt_algorithms();
/// Null if there is none of that name.
const NloptAlgorithm* nlopt_algorithm_of(const std::string& name);

}  // namespace elamin
