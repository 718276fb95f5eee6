#pragma once
#include "core/archive.hpp"

#include <cstdint>
#include <vector>

namespace elamin {

/// Load factors to hit, one after the other, and the halving of the way to the next one: steps that fail are halved, down to 2⁻²⁰ of the way; halved
/// steps double again so that every multiple of the step is hit.
class LoadGrid {
 public:
  /// targets: in order, all ahead of `start` or at it.
  LoadGrid(std::vector<double> targets, double start);

  bool done() const { return next_target_ == targets_.size(); }
  double target() const { return targets_[next_target_]; }
  /// Where the next step leads.
  double next() const;
  int halvings() const { return halvings_; }
  /// False where it is as fine as it may be.
  [[nodiscard]] bool halve();
  /// The step led there.
  void arrive();
  /// Something happened at a load factor: the way to the next target counts from there.
  void restart(double load_factor, int halvings = 0);
  void carry(Archive& archive) { archive(next_target_, start_, done_, halvings_); }

 private:
  std::vector<double> targets_;
  std::size_t next_target_ = 0;
  double start_;                         // of the way to there
  std::int64_t done_ = 0;                // parts of it
  int halvings_ = 0;
};

}  // namespace elamin
