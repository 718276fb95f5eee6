#include "energy/carried_group.hpp"

#include "laws/rounded/carried.hpp"

namespace elamin {

CarriedGroup::CarriedGroup(const Model& model, const Kinematics& kinematics, std::unique_ptr<ElementGroup> inner)
    : kinematics_(kinematics), inner_(std::move(inner)), glued_(model.glued), glue_(kinematics.sites(), -1) {
  for (std::size_t k = 0; k < glued_.size(); ++k) glue_[glued_[k].particle] = static_cast<int>(k);
  for (int e = 0; e < elements(); ++e) {
    const std::size_t begin = stencils_.size();
    for (const int p : inner_->stencil(e)) {
      int place = glue_[p] < 0 ? -1 : kinematics.place_of(glued_[glue_[p]].body);
      stencils_.push_back(p);
      for (std::size_t i = begin; i < stencils_.size(); ++i)      // a body that is there already holds all of its own
        if (stencils_[i] == place) place = -1;
      stencils_.insert(stencils_.end(), {place, place < 0 ? -1 : place + 1});
    }
  }
  gradient_.resize(std::size_t(elements()) * inner_->gradient_size());
  hessian_.resize(std::size_t(elements()) * inner_->hessian_size());
}

Vec3 CarriedGroup::arm(const State& state, int particle) const {
  const Glued& g = glued_[glue_[particle]];
  return state.bodies[g.body].rotation * g.arm;
}

// Rows: the coordinates of the inner element; columns: those of the bodies, and of sites that nothing carries.
Eigen::MatrixXd CarriedGroup::jacobian(const State& state, int e) const {
  const std::span<const int> outer = stencil(e), inner = inner_->stencil(e);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3 * inner_->sites(), 3 * sites());
  for (int i = 0; i < inner_->sites(); ++i) {
    if (glue_[inner[i]] < 0) {
      J.block<3, 3>(3 * i, 9 * i).setIdentity();
      continue;
    }
    const int body = glued_[glue_[inner[i]]].body;
    for (int k = 0; k < sites(); ++k)
      if (outer[k] == kinematics_.place_of(body)) {
        J.block<3, 3>(3 * i, 3 * k).setIdentity();
        J.block<3, 3>(3 * i, 3 * k + 3) = -cross_matrix(arm(state, inner[i])) / kinematics_.characteristic_length(body);
        break;
      }
  }
  return J;
}

Eigen::VectorXd CarriedGroup::spread(const State& state, int e, const double* inner_gradient) const {
  const int n = inner_->gradient_size();
  const Eigen::Map<const Eigen::VectorXd> g(inner_gradient, n);
  Eigen::VectorXd out = jacobian(state, e).transpose() * g;
  for (int i = 0; i < inner_->sites(); ++i)
    if (glue_[inner_->stencil(e)[i]] >= 0) out.segment<3>(9 * i) = g.segment<3>(3 * i);
  return out;
}

void CarriedGroup::derivatives(const State& state, const Tangent& tangent, double* value, double* gradient, double* hessian) const {
  const int n = inner_->gradient_size(), first = inner_->hessian_first();
  inner_->derivatives(state, tangent, value, gradient_.data(), hessian ? hessian_.data() : nullptr);
  parallel_for(elements(), 100, [&](std::int64_t at) {
    const int e = static_cast<int>(at);
    const double* const g = gradient_.data() + at * n;
    Eigen::Map<Eigen::VectorXd>(gradient + at * gradient_size(), gradient_size()) = spread(state, e, g);
    if (!hessian) return;
    Eigen::MatrixXd h(n - first, n - first), J = jacobian(state, e);
    const double* packed_entry = hessian_.data() + at * inner_->hessian_size();
    for (int r = 0; r < n - first; ++r)
      for (int c = 0; c <= r; ++c) h(r, c) = h(c, r) = *packed_entry++;
    if (first > 0) J = (J.bottomRows(n - 3) - J.topRows(3).replicate(n / 3 - 1, 1)).eval();
    Eigen::MatrixXd H = J.transpose() * h * J;
    const std::span<const int> outer = stencil(e), inner = inner_->stencil(e);
    for (int i = 0; i < inner_->sites(); ++i) {
      if (glue_[inner[i]] < 0) continue;
      const int body = glued_[glue_[inner[i]]].body;
      const Vec3 a = arm(state, inner[i]), force = Eigen::Map<const Vec3>(g + 3 * i);
      const Mat3 m = force * a.transpose();
      for (int k = 0; k < sites(); ++k)
        if (outer[k] == kinematics_.rotation_of(body))
          H.block<3, 3>(3 * k, 3 * k) += ((m + m.transpose()) / 2 - force.dot(a) * Mat3::Identity()) / std::pow(kinematics_.characteristic_length(body), 2);
    }
    double* out = hessian + at * hessian_size();
    for (int r = 0; r < gradient_size(); ++r)
      for (int c = 0; c <= r; ++c) *out++ = H(r, c);
  });
}

void CarriedGroup::explicit_load_derivative(const State& state, double* rate) const {
  std::vector<double> inner(gradient_.size());
  inner_->explicit_load_derivative(state, inner.data());
  for (int e = 0; e < elements(); ++e)
    Eigen::Map<Eigen::VectorXd>(rate + std::size_t(e) * gradient_size(), gradient_size()) =
        spread(state, e, inner.data() + std::size_t(e) * inner_->gradient_size());
}

}  // namespace elamin
