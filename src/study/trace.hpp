#pragma once
// From a problem and its model to equilibria: which solver calls a study is made of.
#include "core/archive.hpp"
#include "input/problem.hpp"
#include "input/stages.hpp"
#include "path/options.hpp"
#include "path/point.hpp"
#include "results/mode.hpp"
#include "results/observables.hpp"
#include "results/columns.hpp"
#include "study/solving.hpp"

#include <functional>

namespace elamin {

/// How a study ended.
struct [[nodiscard]] Outcome {
  Status status = Status::converged;
  std::string why;
};

/// Where the points of a study go, one by one, the last with `last` set; the one point of a study of modes, with them; the
/// moments of a motion, those to be recorded with `frame` set, and how far it has come; and sentences for the log. Before the first point, and where a path has stages before the first of each: the stage and the
/// energy in force until the next one.
struct Sink {
  std::function<void(const Stage& stage, Energy& energy)> stage;
  std::function<void(const PathPoint& point, bool last)> point;
  std::function<void(const PathPoint& point, const std::vector<Mode>& modes)> modes;
  std::function<void(const std::string& note)> note;
  std::function<void(const Moment& moment, bool frame)> moment = {};
  std::function<void(const std::string& line, double step)> progress = {};
  /// At every place that the study can go on from, with what it carries there; in time also within a stop.
  std::function<void(const std::function<void(Archive&)>& carry)> checkpoint = {};
  /// Of a path: it has come to this point, which is told when it is known whether that is the last one.
  std::function<void(const PathPoint& point)> reached = {};
  /// Of a path: whether it ends with this point.
  std::function<bool(const PathPoint& point)> enough = {};
};

/// The load factor that a problem starts at: path.start_lambda if that is given, else path.from of a path, and 1 (loads
/// and displacements in full) of every other study.
double starting_load_factor(const Problem& problem);

/// The state that a problem starts from: the model's (or the one it restarts from), with the prescribed coordinates where
/// the load factor puts them.
State starting_state(const Problem& problem, const Energy& energy);

/// A sentence: the energy is not finite at the state, and why.
std::string not_finite(const Energy& energy, const State& state);

/// Yields a state of which, since the study is to stop, nothing but its energies is told.
Outcome tell_interrupted(Newton& newton, const State& state, const Sink& sink);

/// Runs the study and yields its points as they are found; stored: what stands beside the state that a path starts from; stopped: where the same study
/// of this problem was when it was stopped, from which it goes on with the same bits, beginning with the stage that it is in.
Outcome trace(const Problem& problem, const Model& model, const std::optional<StateSupplement>& stored, const Sink& sink, Archive* stopped = nullptr);

// A motion in time, from its starting state to its last step.

/// Velocity Verlet over the steps of [dynamics]; yields a moment at every step that has a row or a frame. Ends where a
/// position is not finite any more, with the last moment that was.
Outcome trace_dynamics(const Problem& problem, const Model& model, const Sink& sink, Archive* stopped = nullptr);

/// The study "path": the path that [path] asks for, or one after the other those of its stages. Watches the [[event]]s.
/// stored: what stands beside the state to start from; if it is of this very path, that goes on as if it had never stopped.
Outcome trace_path(const Problem& problem, const Model& model, const std::optional<StateSupplement>& stored, const Sink& sink, Archive* stopped = nullptr);

// Observables whose values are looked for.

/// The [[event]]s of a problem as functions of a state; problem and model must outlive them.
std::vector<UserEvent> user_events(const Problem& problem, const Model& model);

}  // namespace elamin
