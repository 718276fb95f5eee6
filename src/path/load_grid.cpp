#include "path/load_grid.hpp"

#include "path/limits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace elamin {

using namespace limits::load_grid;

LoadGrid::LoadGrid(std::vector<double> targets, double start) : targets_(std::move(targets)), start_(start) {}

double LoadGrid::next() const {
  const std::int64_t arrived = done_ + (whole >> halvings_);
  return arrived == whole ? target() : start_ + (target() - start_) * (static_cast<double>(arrived) / whole);
}

bool LoadGrid::halve() { return halvings_ < finest && ++halvings_; }

void LoadGrid::arrive() {
  const std::int64_t part = whole >> halvings_;
  done_ += part;
  if (done_ == whole) start_ = target(), done_ = 0, ++next_target_;
  if (halvings_ > 0 && done_ % (2 * part) == 0) --halvings_;
}

void LoadGrid::restart(double load_factor, int halvings) {
  const double sign = targets_.empty() || targets_.back() > start_ ? 1 : -1;
  while (!done() && sign * (target() - load_factor) <= 0) ++next_target_;
  start_ = load_factor, done_ = 0, halvings_ = std::clamp(halvings, 0, finest);
}

}  // namespace elamin
