#include "path/event.hpp"

namespace elamin {

Eigen::MatrixXd without_modes(const Eigen::MatrixXd& zero, const Eigen::MatrixXd& modes) {
  if (zero.cols() == 0 || modes.cols() == 0) return zero;
  const Singular svd = singular_values(zero - modes * (modes.transpose() * zero));
  Eigen::Index rank = 0;
  while (rank < svd.values.size() && svd.values[rank] > 0.5) ++rank;
  return svd.u.leftCols(rank);
}

void store(const ContactSet& closed, Resume& resume) {
  for (const ContactKey& key : closed)
    if (key.feature < 0) resume.closed.push_back({key.particle, key.other, key.wall});
    else resume.closed_bodies.push_back({key.particle, key.other, key.wall, key.feature, key.within_cutoff});
}

Resume resume_of(const Event& event, const ContactSet& closed) {
  Resume resume;
  resume.label = event.at.point.label;
  resume.before = event.before, resume.after = event.after;
  resume.modes = event.modes;
  resume.tangent = event.at.tangent;
  store(closed, resume);
  return resume;
}

std::optional<Event> resumed_event(const Resume& resume, const Equilibrium& at) {
  const bool limit = resume.label.starts_with("limit:");
  if (!(limit || resume.label.starts_with("branch:")) || resume.modes.cols() == 0) return {};
  Event event;
  event.kind = limit ? EventKind::limit : EventKind::branch;
  event.at = at;
  event.at.point.label = resume.label;
  event.at.point.multiplicity = static_cast<int>(resume.modes.cols());
  event.at.zero_modes = without_modes(at.zero_modes, resume.modes);
  event.at.tangent = resume.tangent;
  if (at.soft.cols() > 0) event.at.soft = resume.modes;
  event.modes = resume.modes;
  event.before = resume.before, event.after = resume.after;
  return event;
}

ContactSet resumed_contacts(const Resume& resume) {
  ContactSet set;
  for (const auto& [particle, other, wall] : resume.closed) set.insert({particle, other, wall});
  for (const auto& [particle, other, wall, feature, within_cutoff] : resume.closed_bodies) set.insert({particle, other, wall, feature, within_cutoff != 0});
  return set;
}

}  // namespace elamin
