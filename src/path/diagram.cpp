#include "core/interrupt.hpp"
#include "path/continuation.hpp"
#include "path/deflation.hpp"
#include "path/hard_contact_steps.hpp"
#include "path/limits.hpp"
#include "path/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <set>

namespace elamin {

using namespace limits;

namespace {

/// The first branch, then those that leave its branch points, then those that leave theirs, until so many branch points as
/// asked for have been switched at; then the equilibria that deflation finds.
class Diagram final : public Path {
 public:
  Diagram(Newton& newton, const State& start, const PathOptions& options) : newton_(newton), options_(options) {
    if (options.deflate > 0) options_.stops.insert(options_.stops.end(), options.deflate_at.begin(), options.deflate_at.end());
    std::set<double> compared(options_.deflate_at.begin(), options_.deflate_at.end());
    compared.insert(options.to);
    for (const double load_factor : compared) rivals_.push_back({load_factor});
    if (any_hard(newton.energy().model())) {
      now_ = std::make_unique<HardContactSteps>(newton, start, options_, &numbering());
      if (options.branches > 0 || options.deflate > 0 || options.method == PathMethod::arc_length)
        note("with hard contacts a path goes by load steps, without switching branches and without deflation");
      options_.branches = options_.deflate = 0;
    } else {
      now_ = std::make_unique<Continuation>(newton, start, options_, &numbering());
    }
  }

  void carry(Archive& archive) override {
    Path::carry(archive);
    archive(metric_, side_, done_, deflated_, known_, switched_, waiting_, arrivals_, points_, rivals_, worst_, why_);
    if (archive.reads() && side_) begin_side({}, "");
    archive(*now_);
  }

 protected:
  void advance() override {
    if (std::optional<PathPoint> point = now_->next()) {
      if (options_.deflate > 0) points_.push_back(point->state);
      compare(*point, side_);
      pass_notes();
      return take(std::move(*point));
    }
    pass_notes();
    if (interrupted()) return end(now_->status(), now_->why());
    finish_branch();
    if (waiting_.empty()) switch_branches();
    if (interrupted()) return end(Status::interrupted, "interrupted while side branches were looked for");
    if (waiting_.empty()) return look_for_others();
    next_branch();
  }

 private:
  struct Waiting {
    std::size_t point;                   // which branch point
    SideBranch side;
    void carry(Archive& archive) { archive(point, side.at, side.direction, side.leaving, side.step); }
  };
  /// The minimum that the first branch has at a load factor, and the lowest of the other equilibria that are known there.
  struct Rivals {
    double load_factor = 0;
    double energy = std::numeric_limits<double>::infinity(), other = energy;
    double size = 0;                     // of the terms that they are sums of
    std::string label = "";                   // of the other one
  };

  void compare(const PathPoint& point, bool is_other) {
    const double same = continuation::same_load * std::abs(options_.to - options_.from), energy = point.energy.total();
    for (Rivals& r : rivals_) {
      if (std::abs(point.state.load_factor - r.load_factor) > same || !point.report.converged()) continue;
      if (is_other ? !(energy < r.other) : !(point.stability.stable && energy < r.energy)) continue;
      r.size = std::max(r.size, point.energy.size());
      if (!is_other) r.energy = energy;
      else r.other = energy, r.label = point.label.empty() ? fmt::format("branch {}", point.branch) : point.label;
    }
  }

  // How the path ends, and where its minimum is not the lowest equilibrium known. Energies of springs at rest are those of rounded places.
  void end_all() {
    const Energy& energy = newton_.energy();
    const double at_rest = 16 * epsilon * energy.force_floor() * energy.kinematics().mean_size() * energy.dofs();
    for (const Rivals& r : rivals_)
      if (std::isfinite(r.energy) && r.other < r.energy - equilibrium::energy_rounding * r.size - at_rest)
        why_ += fmt::format("; at load factor {:.10g} its minimum is not the lowest: {} has the energy {:.7g}, the path {:.7g}", r.load_factor,
                            r.label, r.other, r.energy);
    end(worst_, why_);
  }

  void pass_notes() {
    for (std::string& sentence : now_->notes()) note(std::move(sentence));
  }

  // How the branch that has just ended bears on the whole.
  void finish_branch() {
    if (done_) return;
    if (why_.empty()) why_ = now_->why();
    else note(fmt::format("branch {}: {}", numbering().branches, now_->why()));
    if (now_->status() != Status::converged && worst_ == Status::converged) worst_ = now_->status(), why_ = now_->why();
    if (const auto* branch = dynamic_cast<const Continuation*>(now_.get()); branch && branch->arrived_at() >= 0)
      arrivals_.push_back({static_cast<std::size_t>(branch->arrived_at()), branch->arrival()});
    for (const Event& e : now_->branch_points()) known_.push_back(e);
    done_ = true;
  }

  // The side branches of the next branch point in order.
  void switch_branches() {
    while (waiting_.empty() && switched_ < known_.size() && static_cast<int>(switched_) < options_.branches) {
      const Event& event = known_[switched_];
      newton_.energy().evaluate(event.at.point.state);
      metric_ = metric_for(newton_.energy(), event.at, options_.to - options_.from);
      const ArcOptions a = arc_options(options_);
      const std::vector<SideBranch> sides = side_branches(newton_, event, metric_, a.load_step, a.rotation);
      if (interrupted()) return;
      if (sides.empty()) note(fmt::format("{}: no side branch was found", event.at.point.label));
      for (const SideBranch& side : sides) waiting_.push_back({switched_, side});
      ++switched_;
    }
  }

  void next_branch() {
    Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    const std::string& label = known_[next.point].at.point.label;
    for (const auto& [point, along] : arrivals_)
      if (point == next.point && along.size() > 0 && along.dot(next.side.leaving.normalized()) > 0.9)
        return note(fmt::format("{}: one of its side branches has arrived there already", label));
    begin_side(std::move(next.side), label);
    side_ = true, done_ = false;
  }

  void begin_side(SideBranch side, const std::string& label) {
    PathOptions side_options = options_;
    side_options.when_unstable = WhenUnstable::follow;
    now_ = std::make_unique<Continuation>(newton_, std::move(side), label, known_, metric_, side_options, &numbering());
  }

  void look_for_others() {
    if (options_.deflate == 0 || deflated_) return end_all();
    deflated_ = true;
    std::vector<std::string> sentences;
    parent_.clear();
    std::vector<PathPoint> others = deflate(newton_, points_, options_, sentences);
    if (interrupted()) return end(Status::interrupted, "interrupted while other equilibria were looked for");
    for (PathPoint& point : others) {
      branch_ = ++numbering().branches;
      compare(point, true);
      emit(std::move(point));
    }
    for (std::string& sentence : sentences) note(std::move(sentence));
  }

  Newton& newton_;
  PathOptions options_;
  Metric metric_;
  std::unique_ptr<Path> now_;
  bool side_ = false, done_ = false, deflated_ = false;       // now_ is a side branch; it has ended; …
  std::vector<Event> known_;             // branch points of all branches so far, in order
  std::size_t switched_ = 0;             // of these have been switched at
  std::deque<Waiting> waiting_;
  std::vector<std::pair<std::size_t, Vector>> arrivals_;
  std::vector<State> points_;
  std::vector<Rivals> rivals_;
  Status worst_ = Status::converged;
  std::string why_;
};

}  // namespace

std::unique_ptr<Path> make_path(Newton& newton, const State& start, const PathOptions& options) {
  return std::make_unique<Diagram>(newton, start, options);
}

}  // namespace elamin
