#include "results/frame_choice.hpp"

#include "core/archive.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace elamin {

// The pieces are parts of the distance of the frames, if the path gets as long as its load factors tell: then its frames are exactly even.
FrameChoice::FrameChoice(const PathTable& path, double size, int stages)
    : frames_(path.frames.value_or(0)), every_(path.every.value_or(0)), size_(size), piece_(std::ldexp(stages / std::max(1.0, frames_ - 1.0), -30)), stage_(path) {}

double FrameChoice::way_to(const PathPoint& point) const {
  if (point.branch != branch_) return 0;
  const double span = std::abs(stage_.to - stage_.from), load = span > 0 ? (point.state.load_factor - last_.load_factor) / span : 0;
  if (stage_.method == PathMethod::load_steps) return std::abs(load);
  double moved = displacement(last_, point.state).squaredNorm();
  for (std::size_t b = 0; b < point.state.bodies.size(); ++b) {
    const Pose &from = last_.bodies[b], &to = point.state.bodies[b];
    const ExactVector way = to.position - from.position;
    moved += (way.hi + way.lo).squaredNorm() + std::pow(size_ * from.rotation.angularDistance(to.rotation), 2);
  }
  const double sites = static_cast<double>(point.state.particles()) + 2.0 * static_cast<double>(point.state.bodies.size());
  return std::hypot(load, size_ > 0 ? std::sqrt(moved / sites) / size_ : 0);
}

// Its ends belong to the next one, up to the rounding of a sum.
double FrameChoice::piece(double at) const { return std::floor(at / piece_ * (1 + 1e-12) + 1e-9); }

template <class Keep> void FrameChoice::keep(const Keep& wanted) {
  std::vector<Candidate> left;
  for (std::size_t k = 0; k < candidates_.size(); ++k) {
    const Candidate& c = candidates_[k];
    const bool kept = wanted(k);
    if (kept || c.labelled) left.push_back(c);
    if (!kept && !c.labelled) dropped_.push_back(c.step), --spares_;
  }
  candidates_ = std::move(left);
}

bool FrameChoice::take(const PathPoint& point) {
  if (every_ > 0) return point.step % every_ == 0;
  if (frames_ == 0) return false;
  at_ += way_to(point);
  const bool labelled = !point.label.empty(), first = candidates_.empty() || piece(at_) != piece(candidates_.back().at);
  last_ = point.state, branch_ = point.branch;
  if (!labelled && !first) return false;
  candidates_.push_back({point.step, at_, labelled});
  if (!labelled) ++spares_;
  while (spares_ > spare * static_cast<double>(frames_)) {
    piece_ *= 2;
    keep([&](std::size_t k) { return k == 0 || piece(candidates_[k].at) != piece(candidates_[k - 1].at); });
  }
  return std::erase(dropped_, point.step) == 0;               // it may have gone at once
}

void FrameChoice::carry(Archive& archive) { archive(piece_, last_, branch_, at_, spares_, candidates_, dropped_); }

std::vector<int> FrameChoice::dropped() { return std::exchange(dropped_, {}); }

std::vector<int> FrameChoice::dropped_at_end() {
  std::vector<bool> chosen(candidates_.size());
  for (int k = 0; k < frames_ && !candidates_.empty(); ++k) {
    const double at = at_ * k / (frames_ - 1);
    auto nearest = std::lower_bound(candidates_.begin(), candidates_.end() - 1, at, [](const Candidate& c, double x) { return c.at < x; });
    if (nearest != candidates_.begin() && at - std::prev(nearest)->at < nearest->at - at) --nearest;
    chosen[nearest - candidates_.begin()] = true;
  }
  keep([&](std::size_t k) { return chosen[k]; });
  return dropped();
}

}  // namespace elamin
