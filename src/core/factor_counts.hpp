#pragma once
// How many matrices a run has factorised, and what for.
#include "core/archive.hpp"

#include <array>
#include <cstdint>
#include <utility>

namespace elamin {

/// What a factorisation was for: the next point of a path, or all else; to find and locate events; a minimum to which it snaps.
enum class FactorsFor { points, events, snaps };

struct FactorCounts {
  std::array<std::int64_t, 3> of{};              // each of FactorsFor
  std::int64_t refused = 0;                      // of all those that were no factor: the matrix was not positive definite, or singular
};

namespace detail {
inline thread_local FactorCounts factor_counts;
inline thread_local FactorsFor factors_for = FactorsFor::points;
}  // namespace detail

/// Of this thread.
inline FactorCounts& factor_counts() { return detail::factor_counts; }

/// Counts one for what this thread is at.
inline bool counted(bool made) {
  ++detail::factor_counts.of[static_cast<std::size_t>(detail::factors_for)];
  detail::factor_counts.refused += !made;
  return made;
}

/// As long as it lives, this thread's factorisations are for that.
class CountFor {
 public:
  explicit CountFor(FactorsFor what) : before_(std::exchange(detail::factors_for, what)) {}
  ~CountFor() { detail::factors_for = before_; }
  CountFor(const CountFor&) = delete;
  CountFor& operator=(const CountFor&) = delete;

 private:
  FactorsFor before_;
};

}  // namespace elamin
