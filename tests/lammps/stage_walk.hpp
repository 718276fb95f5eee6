#pragma once
// The stages of a problem, with energies and forces along each of them.
#include "energy/energy.hpp"
#include "input/build.hpp"
#include "input/stages.hpp"
#include "study/imperfection.hpp"
#include "study/trace.hpp"

#include <optional>

namespace elamin {

/// Stage after stage of a problem, without the tails of positions that no data file has.
class StageWalk {
 public:
  explicit StageWalk(const Problem& problem) : problem_(problem), stages_(problem), all_(model_of(problem)) {
    Energy whole(all_);
    now_ = State(starting_state(problem, whole).position);
    path_ = problem.follows_path();
  }
  int count() const { return path_ ? stages_.count() : 1; }
  void enter() {
    if (stages_.next() > 0) {
      energy_->kinematics().prescribe(now_, to_);
      stages_.leave(to_);
    }
    std::string unclear;
    const bool first = stages_.next() == 0;
    const Stage stage = stages_.enter(unclear);
    from_ = !path_ || first ? starting_load_factor(problem_) : stage.path.from;
    to_ = path_ ? stage.path.to : from_;
    energy_.reset();
    model_ = model_in(problem_, stage, all_, now_);
    energy_.emplace(model_);
  }
  struct There { Field position, forces; EnergyTerms terms; };
  /// That part of the way into the stage.
  There at(double part) {
    State state = now_;
    energy_->kinematics().prescribe(state, from_ + part * (to_ - from_));
    const EnergyTerms terms = energy_->terms(state);
    return {state.position, energy_->forces(state).leftCols(energy_->model().particles()), terms};
  }
  const Model& model() const { return model_; }

 private:
  const Problem& problem_;
  Stages stages_;
  Model all_, model_;
  State now_;                              // driven ends where the stages before have left them, all else at the start
  std::optional<Energy> energy_;
  bool path_ = false;
  double from_ = 0, to_ = 0;
};

}  // namespace elamin
