#pragma once
// Structures that come and go with the stages of a path.
#include "model/model.hpp"
#include "input/keys.hpp"
#include "input/problem.hpp"

#include <string>
#include <vector>

namespace elamin {

/// Number of a stage by its name, from 0; "" is the first one, and so is a name that there is not.
int stage_number(const Problem& problem, const std::string& name);

/// Makes the connections that a stage begins with, between particles where they are `now`: their bonds are `all`'s from then on.
/// Returns "" or, of a connection that makes no bond, a sentence that says so.
std::string connect_in(const Problem& problem, int stage, Model& all, const State& now);

/// Whether a connection is made as a stage behind the first begins, up to this one.
bool connects_before(const Problem& problem, int stage);

/// Of every particle, then of every body, whether it is not there in a stage: not yet, or not any more. What a body carries is there as long as it.
std::vector<bool> absent_in(const Problem& problem, int stage, const Model& model);

/// Leaves out of a stage's model what is not there in it. Particles and bodies that have not come yet, or are gone, keep their numbers; they are
/// held where they are `now`, and nothing acts on them.
void leave_out(const Problem& problem, int stage, Model& model, const State& now);

/// A mistake if a table's from_stage names no stage.
void check_from_stage(const Problem& problem, TablePlace& place, const std::string& from, Mistakes& mistakes);

/// The stages that structures, groups, connections and removals name, and the groups of removals.
void check_staged_structure(Problem& problem, Mistakes& mistakes);

}  // namespace elamin
