#pragma once
// The constants of this folder that decide something, by the file that they are of, each with its reason. [1] unless told otherwise.
// Where no other reason is told they were chosen by trial on the random problems of tests/bench/path_stress, and decide how long steps are rather than
// what is found.
#include "core/types.hpp"

#include <array>
#include <cstddef>
#include <cstdint>

namespace elamin::limits {

/// One equilibrium from its neighbour, and what its zero modes are.
namespace equilibrium {
constexpr int most_iterations = 12;  // of a corrector that stays on its branch
constexpr int most_in_contact = 40;  // an overlap that the tangent runs into shrinks to a third a step: 21 for ten decades of stiffness
constexpr std::size_t most_held = 6;  // rigid motions that are held while an equilibrium is sought: of one part
constexpr std::size_t most_motions = 600;  // of parts against each other, among which zero modes are looked for: a dense matrix
constexpr int most_unstable = 40;  // negative eigenvalues up to which zero modes are looked for, in one block with them; only where a solver has given up there are more
constexpr std::size_t most_names = 20;  // of loose particles that are told
constexpr double just_touching = 1e-9;  // of the smallest size
/// Of the way between two equilibria, what their tangents do not tell of it; a parabola from its vertex has 0.5. And the cosine between the tangents.
constexpr double largest_part = 0.45, least_cosine = 0.5;
/// A side branch x ∝ √(λ* − λ) ends at λ* on another branch, whose tangent tells nothing of the way to there: the least part of the way that the tangent at a step's end
/// tells (a square root that goes on: 1/2), unless the mean of the tangents at both ends tells all of it but so much (a parabola that ends at its vertex).
constexpr double least_rest = 0.15, parabola = 0.1;
constexpr double same_end = 1e-3;  // of the way: a step and its parts meet
constexpr double energy_rounding = 1e-13;  // of the sum of its terms' sizes
constexpr int softest = 3;  // eigenpairs that are followed from step to step, …
constexpr int softest_rounds = 3;  // … and rounds of inverse iteration that find them from nothing
constexpr double rigid = 1e-6;  // of what a mode moves: by how much it may change angles
constexpr int most_shifts = 6;  // along a neutral mode, until its phase is kept
constexpr double no_force = 1e-13;  // of the scale: along a family, hardly more than rounding, and well below a residual
constexpr int most_along = 32;  // steps along a family of about a quarter of the way from one place of rest to the next
constexpr double at_rest = 1e-9;  // of such a step
constexpr double near = 1, apart = 1e-6;  // smallest sizes: what an equilibrium of a family is moved away from, and at least by how much
constexpr double farthest = 32;  // smallest sizes: what is so far away is not looked for
constexpr int most_apart = 64;  // steps along a family, of half the smallest size at first, away from that, …
constexpr double least_along = 1e-5;  // … and the shortest of them
constexpr double oblique = 1e-3;  // of what a mode moves most: by how much a gap changes that is not where the family touches as a whole
constexpr double drifted = 1e-13;  // of the phase: rounding [rad]
constexpr double next_to_nothing = 1e-6;  // of the next stiffness
constexpr double same_mode = 0.9;  // cosine between a neutral mode and what it has become a step further
constexpr double alike_angles = 1e-6;  // changes that a symmetry makes equal
constexpr double close_values = 1e-6;  // lengths that a symmetry makes equal
}

/// What lies between two equilibria.
namespace segment {
constexpr double rounding = 1e-13;  // of a segment: what its parameter tells
constexpr double least_movement = 1e-12;  // of Kinematics::norm: less is rounding, and tells neither a bend nor another branch
constexpr double widest = 0.5;  // of the chord, to the side and beyond its ends: a branch that is resolved bends less
}

/// Correctors across a branch.
namespace arc {
constexpr int most_iterations = 16;  // of a corrector; …
constexpr int few_iterations = 4, most_rounds = 4;  // … where load factors do not resolve forces, and how often
constexpr double off_plane = 1e-9;  // of the step: rounding
constexpr double resolved = 1e6;  // spacings of the load factors: a step that rounding does not turn
constexpr double least_cosine = 0.1;  // between the directions at two samples of a segment
}

/// A step and what happens on it.
namespace branch {
constexpr double coincide = 1e-10;  // of a segment: events that are at one place
constexpr double slowed = 0.3;  // of the rates of the load factor at both ends of a step: less between, as far as a cubic tells, may be none
constexpr int most_looks = 4;  // … how often that is looked at
constexpr double softened = 1.4;  // factor by which |μ| falls on a step before one on which it may vanish twice: 1.5, but for how roughly it is known
constexpr double vanished = 1e-6;  // of the largest of the softest eigenvalues: at a limit point or branch point one that has vanished
constexpr int samples = 32;  // of cubics between two equilibria
constexpr double same_mode = 0.7;  // cosine between eigenvectors at both ends of a step: more than with all others
constexpr double little = 1e-4;  // of the step: over which the change of eigenvalues is taken
constexpr double load_rounding = 1e-10;  // of the load factor: where hardly anything changes it
constexpr double most_told = 10;  // times what tangents at both ends tell: between them they may be more
constexpr double before_contact = 0.9;  // of the way to a contact that is lost: there the contact still has its stiffness, and the Morse index is the branch's
constexpr double to_see_turn = 0.1;  // of the way along the critical mode to a limit point: over which the change of its stiffness is taken
constexpr double same_overlap = 0.1;  // by which an overlap may change there: its stiffness by half of that, as its rate tells
constexpr double first_past = 1e-5, least_past = 1e-7, last_past = 16;  // of the way over which the other side of a contact is looked for
}

/// Steps of arc length.
namespace arc_steps {
constexpr double largest_angle = 0.7;  // between the directions at both ends of a step [rad]
constexpr double wanted_angle = 0.25;  // … that is aimed at [rad]
constexpr double most_growth = 2;  // of a step over the one before
constexpr int wanted_iterations = 4;  // of the corrector: quadratic convergence from a tenth to rounding
constexpr double largest_departure = 0.5;  // of the corrector, in parts of the step
constexpr double largest_defect = 0.2;  // of the chord from the sum of the tangents, in parts of the chord
constexpr double told_by_load = 0.1;  // of a load step: what is less may be rounding, where hardly anything changes the load factor
constexpr double least_part = 1e-12;  // of the first step: shorter ones are given up
constexpr double least_order = 0.5, largest_order = 5;  // of the load factor over the arc length from a branch point, as far as rates and changes tell one order
constexpr double just_beyond = 0.125;  // of a first step from a branch point: where the Morse index is looked at, too
constexpr double same_end = 1e-3;  // of the way: an event leads there
constexpr double first_natural = 0.01, least_natural = 1e-10;  // of a load step: the longest, if no longer than the step of arc length, and the shortest that is tried over a contact, a tenth of contact_event::together_in_step …
constexpr int refused_first = 6;  // … where so many of arc length have been refused, or right behind a contact
constexpr double least_bent = 1e-6;  // … and the shortest that bends are a reason to shorten
constexpr int most_shifts = 5;  // of a step that ends on an event by chance
constexpr int halvings_at_first = 8;  // then steps are quartered
constexpr double least_length = 1e-6;  // of the extent: L where nothing moves
constexpr double same_stop = 1e-9;  // of the load factor, as exactly as events are located: a limit point or branch point so near to a stop tells more than that
constexpr double standing = 1e-6;  // of the step: a kink may be where the branch stands
constexpr double load_rounding = 16 * epsilon;  // of load factors that were summed up
constexpr int cubic_halvings = 20;  // that find where Hermite's cubic passes a load factor
constexpr double as_foreseen = 0.05;  // of the step: how far the equilibrium there may be from the cubic
}

/// Halving of load steps.
namespace load_grid {
constexpr int finest = 20;  // halvings
constexpr std::int64_t whole = std::int64_t(1) << finest;
constexpr double all_but_hit = 1e-12;  // of the range: a target so near to an event, but for the last one
}

/// Steps of the load factor.
namespace load_steps {
constexpr int first_detour = 3, next_detour = 6;  // halvings after which the branch is explored in arc length, and every so many more
constexpr int coarse = 2;  // halvings where nothing is located, then the path snaps
constexpr int longest_detour = 400;  // its steps
constexpr double past_contact = 0.01;  // of a step: where the tangent behind a contact is taken
constexpr int patience = 32;  // steps that are refused, of a path that may snap and whose contacts nobody asks for, on less than …
constexpr double creep = 1.0 / 64;  // … this part of a step
constexpr int caught = patience;  // what counts for as many: one step, refused where what floats is caught, as shorter ones would be, too
constexpr double longer = 1.13;  // of a step that ends on an event by chance: it is looked for within a step so much longer, …
constexpr double on_target = 1e-6;  // … and is that event if it is so near, in parts of the step
constexpr double vanished = 1e-6;  // of the softest eigenvalue where a step begins, or of the next ones where it ends: one that vanishes there
constexpr int fine = 6;  // halvings after which bends are no reason to halve again
constexpr double most_bend = 0.3;  // of a step, from the mean of the tangents at both ends
constexpr int most_iterations = 6;  // of the corrector, of a step that is not halved for that: quadratic convergence from the size of a bond's rotation to rounding
}

/// Bracketed root finding.
namespace root_search {
constexpr double leap = 0.125, narrow = 1.0 / 256;  // of a bracket that gets narrower by 1/256 the values' difference falls to 1/256, of √t to 1/16; where more than 1/8 is left the branch leaps to another one
constexpr double rounding = 16 * epsilon;  // of a segment: a user's value may be much smaller than the observable's change on the segment
constexpr int most_evaluations = 80;  // bisection alone, every fourth, gives 2⁻²⁰; the rest converge superlinearly
}

/// Eigenvalues that vanish.
namespace locate {
constexpr int most_iterations = 16;  // of a corrector between two equilibria
constexpr double next_to_nothing = 1e-9;  // of the eigenvalues at both ends: zero
constexpr double vanished = 1e-2;  // of the eigenvalues at both ends: where rounding hides which is zero
constexpr double steepest = 4;  // times the mean rate of a segment: more is a leap
constexpr double vanishing_together = 10;  // times the eigenvalue that vanishes: those of other modes that vanish with it, in other coordinates
constexpr double orthogonal = 1e-5;  // of a load to a critical mode, where nothing else tells limit from branch points
constexpr double work_rounding = 1e-10;  // of a load: its work along a critical mode as far as that is known; and …
constexpr double of_limit = 0.01;  // … of the eigenvalue times the way to it: the work of the load at a limit point, a parabola having 0.5, and branch points 1e-3 at most (the same seeds as `unfolding`)
constexpr double unfolding = 100;  // times its rounding: the force along a critical mode that breaks a branch point; at most 0.5 of it at 433 of them (path_stress, seeds 43000000 to 43000499), 2e3 and more at unfolded ones
constexpr double little_before = 1e-4;  // of the eigenvalue where a segment begins: where it tells how a branch comes to a limit point
constexpr double load_rounding = 1e-13;  // of the load factor: where an eigenvalue vanishes
constexpr double settled = 1e-14;  // of a load: its work along the mode of a branch point that is known to rounding; …
constexpr int most_settling = 4;  // … how often it is made smaller, …
constexpr double farthest_settling = 100;  // … and how far it may lie, in steps of those differences
constexpr int more_modes = 2;  // partners of a multiple one, so that a neighbour knows them
constexpr int most_multiple = 6;  // eigenvalues that vanish together
constexpr int most_narrowings = 6;  // of the segment on which a side branch arrives, …
constexpr double narrow = 1e-3;  // … until it is this part of the first
}

/// Contacts that change.
namespace event_error {
constexpr double step = 1e-4;       // of the step on which the event was found: a difference whose error is ε/1e-4 of the eigenvalue's own rounding
}
namespace contact_event {
constexpr double together = 1e-10;  // of the size: gaps that vanish at one load factor
constexpr double rounding = 1e-13;  // of the size: of a gap …
constexpr double exact_rounding = 1e-18;  // … where nothing rounds it: what is as stiff as a contact bears a force at 1e-13 already
constexpr double same_load = 1e-12;  // of the load factor: where a contact that has just changed cannot change back
constexpr double just_open = 2e-13;  // of the size: a gap that is as good as none, and bears no force
constexpr double unloaded = 1e-10;  // of the largest force: what a stiff contact bears at most where its gap vanishes
constexpr double faded = 1e-3;  // of the overlap at the beginning of a step: what is left of it where a contact is lost
constexpr double together_in_step = 1e-9;  // … or of its change over the step; and of the step, by how much rounding sets an event behind its beginning
constexpr double beside = 1e-9;  // of the size: where one side of a kink is looked at, …
constexpr double most_beside = 0.05;  // … but no farther than this part of the step …
constexpr double least_beside = 1e-12;  // … where that is more than rounding, of the size
inline constexpr std::array onward{0.1, 1e-3};  // of the way to contacts that are made and lost together, or of the step behind one: where it may be closed
constexpr double along_chord = 0.1;  // of the step: beyond its end, where a branch that turns at a kink may reach to
constexpr std::size_t most_told = 4;  // names in one event
constexpr int most_closing = 12;  // iterations that close a gap
constexpr double next_to_none = 1e-14;  // of the size: a gap at which what floats just touches, above rounding
constexpr double little = 1e-4;  // of the way: over which a gap's rate is taken
}

/// What comes after events.
namespace continuation {
constexpr std::array<double, 2> snap_beyond{1e-4, 1e-3};  // of the range of load factors: where a snap begins, x ∝ √(λ − λ*) there being known to 1e-12; farther where it cannot begin so near
/// Of the range: a snap from a branch point begins no nearer to it. The minimum beside an unstable equilibrium so far behind it is lower by the square of that, in parts
/// of the energy: 1e-12, which rounding still tells.
constexpr double least_snap = 1e-6;
constexpr double along_mode = 0.9;  // of the way from a limit point to a minimum that is on its branch: along the critical mode
constexpr double all_of_path = 1e-12;  // of the range: a load factor so near to the end is the end
constexpr int most_nearer = 10;  // times another branch is looked for nearer to where it is met, by a factor of four each: down to 1e-9 of the range, as exactly as events are located
constexpr double same_load = 1e-9;  // of the range: load factors that are one, as exactly as events are located
constexpr double same_point = 1e-6;  // of the structure's displacement scale: one branch point met twice
constexpr double collapsed_bond = 1e-6;  // of the rest length: there its energy has a kink, and a branch its end
}

/// What floats.
namespace push {
constexpr double borne = 0.1;  // of what a residual may leave, by the ground
constexpr double left = 1e-6;  // of what the ground bears: the place is as exact, in parts of the way …
constexpr double stands = 1e-12;  // … or where a step is no longer
constexpr double shortest = 1e-3;  // part of a step that is tried
constexpr double freely = 0.9;  // of the way to where something would go through something
constexpr int most_iterations = 100, patience = 3;  // an overlap shrinks to a third a step; so many without half the force: something is caught, …
constexpr int most_in_row = 50;  // … or parts in a row move one after the other
}

/// Falls.
namespace jump {
constexpr int most_nearer = 4;  // times the snap begins nearer to its event, by a factor of four each
constexpr double most_freed = 0.1;  // of the way to the unstable equilibrium that it begins at, what the critical modes add: a branch aside is farther, by the root of the way
constexpr int most_downhill = 50;  // iterations before long steps are allowed
constexpr int most_descents = 5;  // of solver.max_iterations each: what has many unstable modes comes by a saddle of each, and grows away from it slowly
}

/// Branches that leave a branch point.
namespace switching {
constexpr double least_part = 1e-4;  // of the first amplitude: shorter ones are given up
constexpr double same = 1e-6;  // images by symmetry: load factors and energies, beside their changes
constexpr int rays = 32;  // on half a circle
constexpr double no_force = 1e-12;  // of the scale of internal forces
}

/// Walks to saddles and minima. Radii are rotations of a bond in one step [rad]; of what is not glued movements [diameters].
namespace saddle {
constexpr int modes = 4;  // soft ones, in which steps are taken: those that cross on the way are among them
constexpr double accuracy = 1e-6;  // of their stiffnesses: they give the way, not its end
constexpr double first_radius = 0.02, largest_radius = 0.1, least_radius = 1e-9;
constexpr double most_off = 0.25, little_off = 0.1;  // of the slopes or their change: of a parabola to a saddle at s a step of s/4 has the first
constexpr double same_mode = 0.7;  // cosine between the mode that is climbed along and what it was a step before
constexpr double relaxed = 3;  // times the step: how far a state may be from where it was, when the rest has relaxed
constexpr double arrived = 1e-4, settled = 1e-2;  // a step to the end; how far Newton's method may go then: quadratically that is 1e-8
constexpr double before_collision = 0.9;  // of the way to where something would go through something
constexpr double pressed = 0.1;  // of its rest length: a bond that a walk up presses together, not what it looks for
constexpr int most_steps = 400;  // of a walk: a bond turns by 2π in 63 of the largest
constexpr int images = 15, most_rounds = 60;  // of a line between two states
constexpr double even = 1e-2;  // the largest step of a line that is at rest: walks begin there
}

/// Equilibria at one load factor.
namespace landscape {
constexpr double same_place = 1e-8;  // of the span, for each dof, beside what rounding leaves: states that are one
constexpr double same_rest = 1e-9;  // of the span: places at rest that a reflection takes to each other
constexpr double same_load = 1e-12;  // of the load factor: the path's and the landscape's, as far as sums round
constexpr double same_energy = 1e-10;  // of the sum of its terms' sizes: images by symmetry, to which reflections come by rounding; …
constexpr double same_stiffness = 1e-6, same_distance = 1e-7;  // … of the stiffest of the soft modes, of the span
constexpr int spectrum = 4;  // soft modes that are compared
constexpr double nudge = 1.0;  // largest turn of a bond where a random start is [rad; diameters]
constexpr int most_leaves = 4;  // saddles that one descent may run into
constexpr int most_strings = 20;  // pairs of minima that are joined by a line
constexpr double first_part = 0.125, least_part = 1e-7;  // of the way to the next load factor: steps of an equilibrium that is followed
constexpr double together = 1e-3;  // of that way: changes that are one, and the event of a path that explains them
}

/// Equilibria that no branch leads to.
namespace deflation {
constexpr int most_iterations = 60, most_modes = 4;  // of one search; along which searches begin
constexpr double largest_rotation = 0.3;  // of a bond in one step [rad]
constexpr double same = 1e-6;  // of ρ: states that are one
constexpr std::size_t most_near = 12;  // states that stand for the branches
}

/// Paths with hard contacts.
namespace hard_contact_steps {
constexpr int finest = 24;  // halvings of a step
constexpr int most_changes = 20;  // of contacts at one load factor
constexpr double aside = 1e-3;  // turn of what is glued, and way in diameters, to where a snap begins
constexpr double nearest = 1e-7;  // the barrier where a snap begins: of a column that stays with its contacts 1e-5 led over to mirror images by 3 of 4 numbers of steps, 1e-6 and less never
constexpr double alike = 1e-6;  // of the energy that is lost
constexpr int look_for_limit = 3;  // after so many halvings, and again
constexpr int most_crossings = 20;  // of modes in one step, before the first one is found
constexpr double just_before = 1e-6;  // of the way to a branch point
constexpr int most_along = 30;  // equilibria on the way to a limit point
constexpr double turns_little = 1.2;  // 1/cos of the angle between the tangent and the way
constexpr double most_bend = 0.2;  // of the way, over which tangents tell it; √λ from its vertex has 0.5
constexpr double at_the_limit = 1e-6;  // of the way ahead: a load factor that does not grow further
constexpr double vanished = 1e-9;  // of its size where the step begins: a slope
constexpr double rounding = 1e-12;  // of a diameter, of the largest force
constexpr double near_by = 1e-3;  // of the smallest size: gaps that are looked at
constexpr double together = 1e-10;  // of the path: changes of contacts that are so near are one
constexpr int short_enough = 6;  // halvings after which what has opened has not closed again on the way
constexpr int most_first = 100;  // contacts that are tried before the first one is found
constexpr double vanishing = 1e-6;  // of the scale: eigenvalues that vanish with the first one
constexpr std::size_t most_told = 4;  // names in one event
}

/// Thresholds as curves. Lengths are those of the curve's metric, in which all that is asked for is about 1.
namespace curve {
constexpr std::size_t kept_variants = 8;  // of the structure, at values of μ that were just looked at
constexpr int most_iterations = 12, most_settling = 12;  // of the extended system; of the equilibrium with its modes held
constexpr double longest_correction = 1;  // of one iteration
constexpr double rounding = 1e-13;  // of a correction; where the conditions' own is larger, …
constexpr double at_rest = 1e-8;  // … corrections that do not shrink any more: difference quotients leave 1e-5 of one to the next
constexpr double largest_angle = 0.3, wanted_angle = 0.1;  // between the tangents at both ends of a step [rad]
constexpr double longest_step = 2, least_step = 1e-6;  // times 1/steps
constexpr double asymmetric = 1e-4;  // of ∇³E v v v to ∇³E v v: less is the rounding of differences
constexpr double located = 1e-12, about = 1e-9;  // of a step: where what vanishes is exact, and where it is a difference quotient
constexpr double as_near = 1e-6;  // … at least, where one cannot be found nearer
constexpr double least_within = 1e-4;  // of the step of a difference: as little as an overlap may leave of it; less is rounding
constexpr double no_row = 1e-6;  // of the sizes of its terms: a condition that does not depend on what it is to tell
constexpr int most_points = 20;  // times `steps`
constexpr int more_modes = 3;  // beside the critical ones, among which the next one is looked for
constexpr double orthogonal = 1e-5;  // of the load to a mode
constexpr double least_length = 1e-6;  // of the extent: L where nothing moves
}

/// What is said of an end.
namespace cause {
constexpr double flat = 1e-3;  // rad: an angle that passes π
constexpr double bent = 1e-9;  // rad: a rest angle that is not straight
constexpr double touching = 1e-6;  // of a diameter: a gap that is about to open or to close
constexpr double soft = 1e-6;  // of the largest stiffness: an eigenvalue about to vanish
}

}  // namespace elamin::limits
