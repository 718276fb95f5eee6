#include "dynamics/contact_damping.hpp"

namespace elamin {

double tsuji_coefficient(double e) {
  return 1.2728 + e * (-4.2783 + e * (11.087 + e * (-22.348 + e * (27.467 + e * (-18.022 + e * 4.8218)))));
}

DampedContact::DampedContact(const ContactDamping& damping, double mass, double stiffness, double effective_radius)
    : tangential(damping.tangential), friction(damping.friction) {
  using Way = ContactDamping::Model;
  const double gamma = damping.coefficient;
  switch (damping.model) {
    case Way::none: break;
    case Way::velocity: coefficient = gamma; break;
    case Way::mass_velocity: coefficient = gamma * mass; break;
    case Way::viscoelastic: coefficient = gamma * mass * std::sqrt(effective_radius), roots = 1; break;
    case Way::tsuji: coefficient = gamma * std::sqrt(mass * stiffness), roots = 2; break;
  }
}

}  // namespace elamin
