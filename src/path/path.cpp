#include "path/path.hpp"

#include "core/interrupt.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {

std::optional<PathPoint> Path::next() {
  while (ready_.empty() && !ended_) advance();
  if (ready_.empty()) return {};
  PathPoint point = std::move(ready_.front());
  ready_.pop_front();
  return point;
}

void Path::carry(Archive& archive) {
  archive(numbering_, branch_, parent_, ended_, ready_, branch_points_, status_, why_, notes_);
}

// A search that was cut short finds nothing, too: a path that ends while it is to stop has not come to its end.
void Path::end(Status status, std::string why) {
  const bool cut_short = status != Status::interrupted && interrupted();
  ended_ = true, status_ = cut_short ? Status::interrupted : status, why_ = cut_short ? "interrupted" : std::move(why);
}

void Path::emit(PathPoint point) {
  point.step = numbering_.steps++;
  point.branch = branch_;
  point.parent = parent_;
  ready_.push_back(std::move(point));
}

void Path::emit(Event& event) {
  PathPoint& point = event.at.point;
  switch (event.kind) {
    case EventKind::limit: point.label = fmt::format("limit:{}", ++numbering_.limits); break;
    case EventKind::branch: point.label = fmt::format("branch:{}", ++numbering_.branch_points); break;
    case EventKind::contact: point.label = fmt::format("contact:{}", ++numbering_.contacts); break;
    case EventKind::user: point.label = fmt::format("{}:{}", event.what, ++numbering_.user_events[event.what]); break;
  }
  point.multiplicity = static_cast<int>(event.modes.cols());
  point.negative_before = event.before, point.negative_after = event.after;
  point.modes = event.modes;
  if (event.kind == EventKind::limit || event.kind == EventKind::branch) {
    // What rounding made of a zero eigenvalue is not told.
    const int lost = point.stability.negative - point.stability.negative_rigid;
    point.stability.negative = std::min(event.before, event.after);
    point.stability.negative_rigid = point.stability.negative - (event.kind == EventKind::limit ? 0 : std::min(lost, point.stability.negative));
  }
  if (event.kind == EventKind::contact || event.kind == EventKind::limit) point.what = event.what;
  if (event.arrival) point.what = "reached along a side branch";
  if (!point.resume) point.resume = resume_of(event, event.closed);
  point.resume->label = point.label;
  if (event.kind == EventKind::branch) branch_points_.push_back(event);
  emit(point);
}

void Path::emit_landing(PathPoint point, std::string what, int before, std::string parent) {
  branch_ = ++numbering_.branches, parent_ = std::move(parent);
  point.label = fmt::format("jump:{}", ++numbering_.jumps);
  point.what = std::move(what);
  point.negative_before = before, point.negative_after = point.stability.negative;
  emit(std::move(point));
}

}  // namespace elamin
