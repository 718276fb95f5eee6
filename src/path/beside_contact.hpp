#pragma once
// What is true right beside an equilibrium at which contacts are made or lost, and how the branch goes on from there.
#include "path/contact_gap.hpp"
#include "path/equilibrium.hpp"

#include <optional>
#include <string>
#include <vector>

namespace elamin {

struct ContactChange {
  bool found = false;                  // else: something changes, but an equilibrium between could not be computed
  double at_parameter = 0;
  Equilibrium at;
  ContactSet after;                    // what is closed beyond
  std::string what;                    // who touches or leaves whom
  // Of bodies, whose stiffness jumps there: `at` has tangent, zero modes and stability of just before, `beyond` those behind;
  // and the sign of dλ with which the branch goes on, 0: it could not be told.
  std::optional<Equilibrium> beyond = {};
  int onward = 0;
};

/// How the branch goes on behind these contacts; negative: the Morse index where the way begins. What particles do to each other begins from nothing. Where
/// they are so stiff that it takes, or gives, stability all the same, the eigenvalue crosses zero nearer to the event than rounding lets it be seen: it is
/// taken where they are lost, given where they are made.
void find_beyond(Newton& newton, ContactChange& change, const std::vector<ContactKey>& changed, const Vector& way, double load_change, int negative);

/// Where several contacts are made, are lost or bear nothing at one place only an equilibrium beyond tells which of them are closed there, others than before:
/// it is sought a little further along the load factor, with the Morse index that was before, and no farther away than tangents reach. What begins from nothing
/// yields without end, so these are the tangents there and with contacts as if they were stiff. ahead: the change of the load factor on the way to them.
[[nodiscard]] std::optional<Equilibrium> onward_from(Newton& newton, const Equilibrium& at, const std::vector<ContactKey>& here, const ContactSet& before, double ahead,
                                       int negative);

/// How a branch goes on behind an equilibrium at which these contacts have just been made, as if they were rigid: the rates of what is free (dofs) and of the
/// load factor, ±1, at which the gaps n_i stay closed and the contact forces F grow from nothing,
///   H x' + ∂g/∂λ λ' = Σ n_i F_i',   n_i·x' + ∂gap_i/∂λ λ' = 0,   F_i' > 0.
/// Where nᵀH⁻¹n < 0, as on an unstable branch, the load factor turns. Nothing where some contacts would open again.
/// `load`: the scale of the load factor. Behind contacts much stiffer than what they press on the branch takes this direction after an overlap that is next to nothing.
struct Rates { Vector x; double load; };
[[nodiscard]] std::optional<Rates> along_contacts(Newton& newton, const Equilibrium& at, const std::vector<ContactKey>& made, double load);

}  // namespace elamin
