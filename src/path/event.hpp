#pragma once
// Something that happens between two equilibria of a branch, located.
#include "path/contact_event.hpp"

namespace elamin {

/// limit, branch: the equilibrium at which the Hessian is singular, with its critical modes; a limit without a mode: a contact of
/// bodies at which the stiffness jumps and the load factor turns. contact: a gap that vanishes.
/// user: an observable at its value.
struct Event {
  EventKind kind = EventKind::branch;
  double at_parameter = 0;             // of the segment that it was found on
  Equilibrium at;                      // its tangent: along the branch, without the critical modes of a branch point
  Eigen::MatrixXd modes;               // dofs × multiplicity
  int before = 0, after = 0;           // Morse index on both sides
  bool arrival = false;                // a branch point reached along a side branch: an eigenvalue touches zero
  Vector passing;                      // how the branch passes it, or a limit point: along dx/ds (dofs) …
  double passing_load = 0;             // … and dλ/ds, all but zero
  ContactSet closed;                   // contact: what is closed beyond
  std::optional<Equilibrium> beyond = {};   // at a contact of bodies: see ContactChange
  int onward = 0;
  bool slides = false;                 // contact: one of a family of equilibria comes to it, others do not
  std::string what;
  int user_event = -1;                      // which of the options' user_events
};

/// The part of the span of some modes that is orthogonal to others, which are orthonormal; orthonormal (dofs × count).
Eigen::MatrixXd without_modes(const Eigen::MatrixXd& zero, const Eigen::MatrixXd& modes);

/// What a path needs to be taken up behind this event; closed: the contacts from there on.
Resume resume_of(const Event& event, const ContactSet& closed);

/// The contacts that a path goes on with.
void store(const ContactSet& closed, Resume& resume);

/// The limit point or branch point that a path is taken up at, with its equilibrium; nothing if it was none.
[[nodiscard]] std::optional<Event> resumed_event(const Resume& resume, const Equilibrium& at);

/// The contacts that a path was taken up with.
ContactSet resumed_contacts(const Resume& resume);

}  // namespace elamin
