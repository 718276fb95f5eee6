#include "study/eigenvalues.hpp"

#include <algorithm>

namespace elamin {

std::vector<double> LowestEigenvalues::at(const State& state) {
  constexpr int more = 4;
  constexpr double accuracy = 1e-14;
  energy_.evaluate(state);
  const double guess = before_.values.size() > 0 ? std::max(0.0, -2 * before_.values[0]) : 0.0;
  before_ = factors_.lowest(count_ + more, guess, accuracy, before_.vectors);
  const Eigen::Index count = std::min<Eigen::Index>(count_, before_.values.size());
  return {before_.values.data(), before_.values.data() + count};
}

}  // namespace elamin
