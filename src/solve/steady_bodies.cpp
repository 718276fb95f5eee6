#include "solve/steady_bodies.hpp"

#include "solve/limits.hpp"

namespace elamin {

void steady_bodies(Energy& energy, const Vector& g) {
  if (energy.model().bodies.empty() || g.size() == 0) return;
  const Kinematics& kinematics = energy.kinematics();
  SparseMatrix& h = energy.changeable_hessian();
  const double force = g.cwiseAbs().maxCoeff();
  auto idle = energy.null_dofs().begin();
  for (int d = 0; d < energy.dofs(); ++d) {
    if (idle != energy.null_dofs().end() && *idle == d) {
      ++idle;
      continue;
    }
    const int site = kinematics.site_of(d);
    if (kinematics.body_of(site) >= 0) h.valuePtr()[h.outerIndexPtr()[d]] += force / (limits::spring_of_size * kinematics.size(site));
  }
}

}  // namespace elamin
