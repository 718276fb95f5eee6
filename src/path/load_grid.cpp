#include "path/load_grid.hpp"

#include "path/limits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace elamin {

using namespace limits;

LoadGrid::LoadGrid(std::vector<double> targets, double start) : targets_(std::move(targets)), start_(start) {}

double LoadGrid::next() const {
  const std::int64_t arrived = done_ + (load_grid::whole >> halvings_);
  return arrived == load_grid::whole ? target() : start_ + (target() - start_) * (static_cast<double>(arrived) / load_grid::whole);
}

bool LoadGrid::halve() { return halvings_ < load_grid::finest && ++halvings_; }

void LoadGrid::arrive() {
  const std::int64_t part = load_grid::whole >> halvings_;
  done_ += part;
  if (done_ == load_grid::whole) start_ = target(), done_ = 0, ++next_target_;
  if (halvings_ > 0 && done_ % (2 * part) == 0) --halvings_;
}

void LoadGrid::restart(double load_factor, int halvings) {
  const double sign = targets_.empty() || targets_.back() > start_ ? 1 : -1;
  const double all_but = targets_.empty() ? 0.0 : load_grid::all_but_hit * std::abs(targets_.back() - targets_.front());
  while (!done() && sign * (target() - load_factor) <= (next_target_ + 1 < targets_.size() ? all_but : 0.0)) ++next_target_;
  start_ = load_factor, done_ = 0, halvings_ = std::clamp(halvings, 0, load_grid::finest);
}

}  // namespace elamin
