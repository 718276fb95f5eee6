#pragma once
// Contacts and cohesion, between particles and between bodies.
#include "input/keys.hpp"
#include "model/model.hpp"

namespace elamin {

/// What a contact does in dynamics beside its elastic force; see ContactDamping.
struct DampingKeys {
  ContactDamping::Model model = ContactDamping::Model::none;
  std::optional<double> coefficient, restitution;
  double friction = 0, friction_damping = 1;
  bool operator==(const DampingKeys&) const = default;
};

/// Of the law "rounded"; its cutoff is that of the table.
struct RoundedKeys {
  double k_n = 0, k_na = 0;
  RoundedFormulation formulation = RoundedFormulation::multi;
  RoundedKernel::Form kernel = RoundedKernel::Form::coded;
  std::optional<double> delta_ua;
  double mu = 0, c_n = 0, c_t = 0, slip = 0;
  bool apart = false;
  bool operator==(const RoundedKeys&) const = default;
};

struct ContactTable {
  TablePlace place;
  std::array<std::string, 2> between;
  std::string law = "hertz";
  std::vector<double> youngs_modulus, poissons_ratio;   // one number, or of unlike materials two
  std::optional<double> effective_modulus;
  std::optional<int> exclude_bonds;
  std::optional<double> epsilon, sigma, cutoff, inner_cutoff;
  CutoffStyle cutoff_style = CutoffStyle::cut;
  bool hard = false;
  DampingKeys damping;
  RoundedKeys rounded;
  std::string from_stage;
  bool operator==(const ContactTable&) const = default;
};

void describe(Keys& keys, ContactTable& t);

// Of contacts and walls alike.

/// Damping and friction stand among the keys of a contact or a wall.
void describe_damping(Keys& keys, DampingKeys& d);
void check_damping(TablePlace& place, const DampingKeys& d, Mistakes& mistakes);
/// What the keys say, tsuji's restitution as a coefficient.
ContactDamping damping_of(const DampingKeys& keys);

/// What is impenetrable has no modulus, and only some methods know it.
void check_hard(const Problem& problem, TablePlace& place, Mistakes& mistakes);
/// Whether the effective modulus is given; then the others must not be.
bool has_effective_modulus(TablePlace& place, Mistakes& mistakes);
/// A mistake in a study of energies: LAMMPS's rules are forces without one.
void check_potential(const Problem& problem, TablePlace& place, const char* why, Mistakes& mistakes);

/// Whether it is a number to compute with; whether all of these have a diameter. Else that is told.
bool is_finite_modulus(const TablePlace& place, double modulus, Mistakes& mistakes);
bool are_spheres(const TablePlace& place, const char* key, const std::vector<int>& particles, const Model& model, Mistakes& mistakes);

}  // namespace elamin
