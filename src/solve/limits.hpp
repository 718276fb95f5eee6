#pragma once
// The constants of this folder that decide something, each with its reason. [1] unless told otherwise.
#include "core/types.hpp"

namespace elamin::limits {

/// σ = rounding · ε ‖H‖₁: what a factor of the assembled Hessian may be wrong by. Its entries are sums of a few rounded terms (a dozen ε),
/// and the backward error of a sparse factorisation stays below ε ‖H‖₁ in practice (Higham 2002, §10.1 bounds it by the height of the
/// elimination tree times that).
constexpr double rounding = 16;
/// Eigenvalues up to so many σ are looked at one by one: beyond, a factor cannot be wrong about a sign.
constexpr double doubtful = 4;
/// As many of them at most; a heap of loose grains has more, and all are zero.
constexpr int most_doubtful = 40;
/// Error of a form Σ_e u_eᵀ H_e v_e, in ε · Σ_e |u_e|ᵀ |H_e| |v_e|: three roundings in an entry of an element's Hessian, two in a
/// difference of the vector on either side, one in each product.
constexpr double form_rounding = 8;
/// Error of a slope Σ_e g_e·v_e, in ε · (Σ_e |g_e·v_e|²)^½: two roundings in a force, one each in a difference and a product, of either sign.
constexpr double slope_rounding = 4;

/// Rounds of inverse iteration after which eigenvalues that do not settle below σ/64 are taken for zero.
constexpr int patience = 12;

/// Every so many of these rounds so many blocks of a Krylov space, a block a round, find at once what rounds alone take the square of their number
/// for (Chebyshev; Saad 2011, §6.6); of so many numbers at most, 400 MB.
constexpr int krylov_rounds = 6;
constexpr std::ptrdiff_t krylov_blocks = 12, krylov_entries = 50'000'000;

/// Rigid rotations of free parts that are told from other zero modes by their curvature: of more parts than that all are loose, and each is zero to
/// the forces that are left.
constexpr std::size_t most_rotations = 60;

/// Unknowns up to which an indefinite matrix that `block_ldl` has no factor of is factorised as a dense one. For a band of 11 and two solutions a factor, n³/3 operations take
/// as long as MUMPS's calls between 150 and 200 unknowns, a fifth of that for 50.
constexpr int dense = 160;

/// Of a solution that is refined: predictors need no more.
constexpr double refined = 1e-8;
/// The part of a solution that a shifted factor may have wrong: predictors need no more.
constexpr double shifted = 0.1;

/// A zero mode, whose stiffness is rounding, is held by so many σ while Newton steps are taken: the steps' rounding along it, ‖g‖ε/σ,
/// stays below theirs elsewhere, and the modes that decide the convergence are stiffer by far.
constexpr double hold_zero_modes = 100;

/// The least part of what compression takes from the Hessian that is left out to make it definite: below, a shift is as good.
constexpr double least_pressed = 1e-6;

/// Newton's steps. Bonds turn by so much at most in one [rad]: the series of cos and sin are good to one part in a hundred there.
constexpr double largest_rotation = 0.3;
/// Part of the predicted decrease that must come true (Nocedal & Wright 2006, §3.1, with room for what contacts add).
constexpr double armijo = 0.1;
/// Simplified Newton corrections that bend one step back; each must shrink to this part of the last one, or of the last but one (take_downhill), or
/// the step is too long.
constexpr int most_corrections = 6;
constexpr double contraction = 0.7;
/// … and where they are this part of the step there is nothing left to bend back.
constexpr double relaxed = 0.01;
/// Newton steps in one run that are taken unseen, where rounding hides the change of energy: as many as quadratic convergence from 1e-8
/// and a few sets of contacts need.
constexpr int most_unseen = 12;
/// Iterations of a descent that Newton's method alone does not take, where bonds are many times stiffer than they bend.
constexpr int slow = 8;
/// Of a step of rigid bodies, before a shorter one is computed anew: five halvings.
constexpr double shortest_part = 1.0 / 32;
/// Of any step: beyond, positions do not change.
constexpr double least_part = 1e-12;
/// Simplified steps that take a small residual down to rounding; each halves it at least, the second is mostly the last.
constexpr int most_polishing = 4;
/// A residual that is as small as the sum of a particle's forces lets it be; what is soft may move by more than that tells.
constexpr double finest = 16 * epsilon;
/// A residual, by ε, that no rounding has made: of a symmetric state, which a correction would leave.
constexpr double exact = 1.0 / 16;
/// A residual that is rounding: a few hundred ε. And a rotation of bonds that is, of a chain of 10³ links [rad]: what is left of the forces makes
/// 10⁻¹² there, and 10⁻² or more where it is all that tells one branch of an unfolded pitchfork from the other.
constexpr double sharp = 1e-13, unbent = 1e-10;
/// What a correction that converges leaves of a residual at most, where contacts bear forces.
constexpr double contracting = 0.25;
/// A saddle is left along its lowest mode where no force acts along it or along those up to so many more whose eigenvalues are at least
/// such a part of the lowest: two that buckle alike, in space, of which one has been left already.
constexpr int modes_looked_at = 3;
constexpr double alike = 0.1;
constexpr double no_push = 1e-6;                 // of the whole gradient
/// Iterations in a row without half the residual, of a search that is to stay on its branch: an overlap shrinks to a third in each.
constexpr int patience_on_branch = 6;
/// Steps in a row where the Hessian is indefinite (they are taken without compression) that each make the residual larger: then the search has gone beyond a limit
/// point and slides down.
constexpr int most_rises = 3;
/// Saddles that a search may end at and leave before it is given up; Newton steps that take a residual at the tolerance down to rounding, and those from a
/// saddle before it is asked whether a hard contact is on the way.
constexpr int most_saddles = 20, most_sharpening = 20, most_downhill = 3;
/// Packings. Loose grains that are so many are one; beside fewer Newton's method is given so many iterations first: where nothing is as rough as a
/// packing it takes ten to thirty.
constexpr int packing = 20, newton_alone = 50;
/// Loose bodies fall and roll on as long as Newton's iterations take off such a part of the energy that they have taken off by then.
constexpr double still_falls = 1e-6;
/// Grains of softened contacts overlap by such a part of their size; then contacts get stiffer by this factor: overlaps shrink to a fifth.
constexpr double wanted_overlap = 0.01, stiffer = 10;
/// The residual that is enough of softened contacts: where their overlaps are off by a thousandth, stiffer ones are found as well.
constexpr double softened_tolerance = 1e-3;
/// Steps of a descent within which the energy must fall (Grippo, Lampariello, Lucidi 1986, SIAM J. Numer. Anal. 23): an overlap shrinks by two
/// decades in as many.
constexpr std::size_t falls_within = 6;
/// The longest step, of the smallest diameter: less than takes a grain past another one.
constexpr double settling_step = 0.3;
/// The least shift that is tried, of the one that keeps a step within bounds where nothing else resists.
constexpr double least_shift = 1e-3;
/// Steps that are refused in a row, each a quarter of the one before, until a descent is given up; and steps of one descent.
constexpr int most_refused = 40, most_settling = 5000;
/// Extents of the structure: what is that far away comes back no more.
constexpr double lost = 100;

/// Inverse iteration: at least so many rounds, since Ritz values settle to rounding before their vectors do, and so many at most.
constexpr int least_rounds = 4, most_rounds = 12;
/// Refinements of eigenvectors: each leaves 1e-3 or less of what a factor's rounding has put there.
constexpr int eigenvector_refinements = 3;
/// Refinements of a solution beside resolved modes, each of which halves the correction at least.
constexpr int most_refinements = 8;
/// Attempts of a search for a shift that grows by 1.5 or more: 1.5¹⁰⁰ = 4·10¹⁷, from the rounding of any matrix to beyond its norm.
constexpr int most_attempts = 100;
/// Bodies that nothing holds are held while a minimum is sought as by a spring that the largest force stretches by such a part of their size.
constexpr double spring_of_size = 0.2;

/// Equilibria with hard contacts (contact_equilibrium).
namespace hard {
/// −δ on the diagonal of a contact's force, of the stiffness scale: contacts that hold one thing twice keep a factor, and gaps move by δ f.
constexpr double give = 1e-10;
/// Rounding of a gap, of a diameter: three orders above ε for gaps between sites at coordinates of many diameters.
constexpr double gap_rounding = 1e-13;
/// Newton steps with one set of contacts; those that may leave the residual as it is at the end; sets that are tried.
constexpr int most_steps = 30, most_polishing = 4, most_changes = 40;
/// Changes of all contacts at once that need not lead on (Júdice & Pires 1994, block pivoting, p ≤ 10).
constexpr int block_chances = 3;
/// Single pivots: so many, and so many more for each contact without force.
constexpr int pivots_at_least = 20, pivots_each = 4;
/// Of so many contacts all choices are tried, 64 factorisations.
constexpr std::size_t most_tried = 6;
/// Rounding of rates along a path, of the largest: those of a solution with a condition number of 10⁷.
constexpr double rounding_of_rates = 1e-9;
}  // namespace hard

namespace ipopt {
/// Runs in a row that do not get anywhere; saddles that may be left; steps in a row that are lost in rounding; steps that Ipopt may take back.
constexpr int most_rounds_without_gain = 5, most_saddles = 10, most_lost = 50;
constexpr std::size_t most_watched = 10;
/// What Ipopt takes for no bound.
constexpr double unbounded = 2e19;
/// Iterations below the tolerance in which contacts are not decided.
constexpr int patience = 10;
/// Of the length scale: what Newton's method may move in the end; what one run may move where there are hard walls.
constexpr double near_by = 0.1, wide = 8;
/// A saddle is left so far that this is not its rounding: by such a rotation of bonds [rad], by such a part of a diameter.
constexpr double rotation = 1e-2, way = 1e-2;
/// What Newton's method may move from a state that may be the equilibrium already, of the smallest diameter.
constexpr double in_place = 1e-3;
}  // namespace ipopt

namespace nlopt {
/// MLSL compares each sample with all others; entries of the history that are kept.
constexpr int most_samples = 10'000;
constexpr std::size_t most_entries = 4000;
/// A change of energy is worth looking at where it is so many times its rounding: its derivative has five digits then.
constexpr double seen = 1e5;
/// Rounds in a row without gain.
constexpr int most_rounds_without_gain = 3;
/// Dofs up to which a limited memory has as many pairs as there are dofs, at least so many; beyond NLopt's own number is about as many, or less.
constexpr int small = 1000, fewest_pairs = 100;
/// Dofs up to which a column beyond buckling was found within a minute: dense matrices, simplices, models of the energy, boxes.
constexpr int dense = 500, simplex = 10, quadratic = 60, global = 12;
}  // namespace nlopt

}  // namespace elamin::limits
