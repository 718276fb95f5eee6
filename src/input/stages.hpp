#pragma once
// A path in stages: which tables are in force in each of them, and how much of each acts.
#include "input/conditions.hpp"
#include "input/keys.hpp"
#include "input/state_supplement.hpp"

#include <string>
#include <vector>

namespace elamin {

/// One stage as it holds. Of conditions_of(problem), and for in_force and entering the contacts behind them, those of rounded
/// bodies last:
struct Stage {
  std::string name;                     // "": the path has no stages
  int number = 0;                       // from 0
  PathTable path;                       // the keys of [path] in this stage, its `from` and `to` among them
  std::vector<bool> in_force, entering; // entering: in force, and not in the stage before; never in the first one
                                        // (resumed: in force, and not so from the start on)
  std::vector<Scaling> scaling;         // of the conditions; of what is not in force: as it will be when it is again
};

/// Goes through the stages of a path; a path without any is one stage. How much of a condition acts is kept from stage to
/// stage: a stage's load factor λ moves those that it varies, all others stay where they are. What is constant acts in full
/// from the start, what was never varied not at all.
class Stages {
 public:
  explicit Stages(const Problem& problem);

  int count() const;
  int next() const { return next_; }
  /// The next stage. `from` is by default the load factor that what it varies has by now; if that is not one and the same,
  /// `unclear` says so.
  Stage enter(std::string& unclear);
  /// Instead of the first one the stage that a stored state is of, begun already. False if it is not of these stages.
  bool resume(const StoredStage& stored);
  /// Ends the stage where its path has ended.
  void leave(double load_factor);

 private:
  const Problem& problem_;
  std::vector<Condition> tables_;       // conditions, then contacts
  std::size_t conditions_;
  std::vector<std::vector<bool>> in_force_;   // tables by stage
  std::vector<double> amount_;          // of a condition that acts now …
  std::vector<double> offset_;          // … = offset + λ while it is varied
  std::vector<bool> was_in_force_;
  std::vector<bool> varied_;            // in this stage
  int next_ = 0;
  std::optional<StoredStage> resumed_;
};

/// The model in a stage: what is not in force, or not there, is left out (walls stay, without particles, so that they keep their
/// numbers), and supports that enter hold their particles where they are `now`. `all` has everything in force; the
/// places of such supports are kept in it for the stages to come. A support that entered before a state was stored holds
/// its particles where they are less its displacement so far, bodies less its rotation too.
Model model_in(const Problem& problem, const Stage& stage, Model& all, const State& now);

/// Of what stands on the wrong side of a wall where a stage begins, "wall.floor.side: particle 7 is outside of it, …"; else "".
std::string on_wrong_side(const Model& in_stage, State start, double load_factor);

/// Labels of the conditions that the load factor of a stage scales.
std::vector<std::string> varied(const Problem& problem, const Stage& stage);

/// Whether the load factor makes a difference to a condition: a support or a wall may stand still.
bool moves(const Problem& problem, const Condition& condition);

/// Names, references and load factors of stages.
void check_stages(Problem& problem, Mistakes& mistakes);

/// Of each stage which tables are in force in it, as in Stage::in_force; without stages one in which all are.
std::vector<std::vector<bool>> in_force_by_stage(const Problem& problem);

}  // namespace elamin
