#pragma once
// One equilibrium of a path and what is known of it.
#include "energy/terms.hpp"
#include "model/state.hpp"
#include "solve/report.hpp"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// What the Hessian over the free dofs says of an equilibrium.
struct Stability {
  int negative = 0;                       // Morse index: eigenvalues below zero by more than rounding
  int negative_rigid = 0;                 // … among the motions on which the scaled loads do no work: under a rigid machine
  int zero = 0;                           // eigenvalues that are zero to rounding
  int critical = 0;                       // of these, where they are not all explained by zero_modes
  std::vector<std::string> zero_modes;    // names of the rigid motions or symmetries that they are
  bool stable = false;                    // no negative one, and every zero one is named
};

enum class EventKind { limit, branch, contact, user };

/// What a path must know beside the state to go on from a point as if it had never stopped.
struct Resume {
  std::string label;                      // of the event, if the point is one …
  int before = -1, after = -1;            // … the Morse index on both sides of it
  Eigen::MatrixXd modes;                  // … and its null vectors (dofs × multiplicity)
  Vector tangent;                         // dx/dλ (dofs); empty: as the state itself tells
  Vector direction;                       // arc length: the branch's direction (dofs), empty for load steps …
  double load = 0;                        // … and its load factor
  double length = 0, step = 0, shortest = 0;   // the metric's L, the next step, the shortest one
  std::vector<std::array<int, 3>> closed; // contacts from here on: particle, other or −1, wall or −1
  std::vector<std::array<int, 5>> closed_bodies = {};   // of bodies besides: feature, 1: within the cutoff (see ContactKey)
};

/// One equilibrium on a path; label "" unless it is an event, "initial" or "final".
struct PathPoint {
  int step = 0;
  std::string label;
  int branch = 0;                         // 0: where the path started; one more after every jump or switch
  std::string parent;                     // label of the event that the branch comes from; "" where the path started
  State state;                            // with its load factor
  EnergyTerms energy;
  Report report;
  Stability stability;
  // Of an event besides:
  int multiplicity = 0;                   // of the zero eigenvalue
  int negative_before = -1, negative_after = -1;   // Morse index on both sides of it, along the path; -1: not an event
  Eigen::MatrixXd modes;                  // null vectors, orthonormal (dofs × multiplicity)
  double load_error = std::numeric_limits<double>::quiet_NaN();   // of its load factor by rounding, see path/event_error.hpp
  std::string what;                       // one phrase: who touches whom, where a jump lands
  std::optional<Resume> resume;           // where the state alone does not tell how the path goes on
};

}  // namespace elamin
