#include "energy/kinematics.hpp"

#include "laws/rounded/rotation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace elamin {

Kinematics::Kinematics(const Model& model)
    : dof_(Eigen::Matrix3Xi::Zero(3, model.particles() + 2 * static_cast<int>(model.bodies.size()))), reference_(model.start),
      glued_(model.glued), size_(model.diameter), drive_(Field::Zero(3, dof_.cols())) {
  for (const Body& b : model.bodies) {
    characteristic_length_.push_back(model.shapes[b.shape].bounding_radius());
    size_.insert(size_.end(), 2, 2 * characteristic_length_.back());
  }
  if (model.plane_normal)
    for (int s = 0; s < sites(); ++s)
      for (int c = 0; c < 3; ++c)
        if ((c == *model.plane_normal) != is_rotation(s)) dof_(c, s) = -1;
  hold(model);
  for (const Glued& g : glued_) dof_.col(g.particle).setConstant(-1), drive_.col(g.particle).setZero();
  driven_ = !drive_.isZero(0);
  for (int s = 0; s < sites(); ++s)
    for (int c = 0; c < 3; ++c)
      if (dof_(c, s) >= 0) {
        dof_(c, s) = static_cast<int>(site_of_.size());
        site_of_.push_back(s);
      }
  carry(reference_);
}

double Kinematics::mean_size() const {
  const double sum = std::accumulate(size_.begin(), size_.end(), 0.0);
  return sum > 0 ? sum / sites() : 1.0;
}

double Kinematics::smallest_size() const {
  return size_.empty() ? 1.0 : *std::min_element(size_.begin(), size_.end());
}

void Kinematics::hold(const Model& model) {
  for (const Support& s : model.supports) {
    const auto place = [&](int site, ExactVector at) {
      for (int c = 0; c < 3; ++c) {
        if (!s.held[c]) continue;
        dof_(c, site) = -1;
        at.set(c, at[c] + two_product(s.scaling.fixed, s.displacement[c]));
        drive_(c, site) = s.scaling.rate * s.displacement[c];
      }
      return at;
    };
    const auto keep = [&](ExactVector& x, const ExactVector& at) {
      for (int c = 0; c < 3; ++c)
        if (s.held[c]) x.set(c, at[c]);
    };
    for (std::size_t k = 0; k < s.particles.size(); ++k) {
      const int p = s.particles[k];
      ExactVector x = reference_.at(p);
      keep(x, place(p, s.reference.empty() ? model.start.at(p) : s.reference[k]));
      reference_.set(p, x);
    }
    for (std::size_t k = 0; k < s.bodies.size(); ++k) {
      const int b = s.bodies[k];
      const Pose& from = s.body_reference.empty() ? model.start.bodies[b] : s.body_reference[k];
      keep(reference_.bodies[b].position, place(place_of(b), from.position));
      if (!s.constrained_rotations[0] && !s.constrained_rotations[1] && !s.constrained_rotations[2]) continue;
      for (int c = 0; c < 3; ++c)
        if (s.constrained_rotations[c]) dof_(c, rotation_of(b)) = -1;
      if (s.constrained_rotations != std::array{true, true, true}) continue;
      reference_.bodies[b].rotation = from.rotation;
      std::erase_if(driven_rotations_, [&](const DrivenRotation& t) { return t.body == b; });
      driven_rotations_.push_back({b, s.scaling.fixed, s.scaling.rate, s.rotation});
      drive_.col(rotation_of(b)) = characteristic_length_[b] * s.scaling.rate * s.rotation;
    }
  }
}

void Kinematics::carry(State& state) const {
  for (const Glued& g : glued_) {
    const Pose& pose = state.bodies[g.body];
    state.set(g.particle, pose.position + ExactVector{pose.rotation * g.arm, Vec3::Zero()});
  }
}

void Kinematics::prescribe(State& state, double load_factor) const {
  state.load_factor = load_factor;
  const auto put = [&](int s, ExactVector x, const ExactVector& reference) {
    for (int c = 0; c < 3; ++c)
      if (dof_(c, s) < 0) x.set(c, reference[c] + two_product(load_factor, drive_(c, s)));
    return x;
  };
  for (int p = 0; p < particles(); ++p) state.set(p, put(p, state.at(p), reference_.at(p)));
  for (std::size_t b = 0; b < characteristic_length_.size(); ++b)
    state.bodies[b].position = put(place_of(static_cast<int>(b)), state.bodies[b].position, reference_.bodies[b].position);
  for (const DrivenRotation& t : driven_rotations_)
    state.bodies[t.body].rotation = (quaternion((t.fixed + load_factor * t.rate) * t.rotation) * reference_.bodies[t.body].rotation).normalized();
  carry(state);
}

void Kinematics::retract(State& state, const Vector& step, double scale) const {
  assert(step.size() == dofs() && state.position.cols() == particles());
  const auto go = [&](int s, ExactVector x) {
    for (int c = 0; c < 3; ++c)
      if (dof_(c, s) >= 0) x.set(c, x[c] + scale * step[dof_(c, s)]);
    return x;
  };
  for (int p = 0; p < particles(); ++p) state.set(p, go(p, state.at(p)));
  for (std::size_t k = 0; k < characteristic_length_.size(); ++k) {
    const int b = static_cast<int>(k);
    Pose& pose = state.bodies[b];
    pose.position = go(place_of(b), pose.position);
    const Vec3 theta = scale * rotation_by(step, b);
    if (theta != Vec3::Zero()) pose.rotation = (quaternion(theta) * pose.rotation).normalized();
  }
  carry(state);
}

Vec3 Kinematics::rotation_by(const Vector& y, int body) const {
  Vec3 theta = Vec3::Zero();
  for (int c = 0; c < 3; ++c)
    if (const int d = dof_(c, rotation_of(body)); d >= 0) theta[c] = y[d] / characteristic_length_[body];
  return theta;
}

Field Kinematics::displacement(const State& a, const State& b) const {
  assert(a.position.cols() == particles() && b.position.cols() == particles() && a.bodies.size() == characteristic_length_.size() && b.bodies.size() == characteristic_length_.size());
  Field u(3, sites());
  u.leftCols(particles()) = elamin::displacement(a, b);
  for (std::size_t k = 0; k < characteristic_length_.size(); ++k) {
    const Pose &from = a.bodies[k], &to = b.bodies[k];
    const ExactVector x = to.position - from.position;
    u.col(place_of(static_cast<int>(k))) = x.hi + x.lo;
    u.col(rotation_of(static_cast<int>(k))) = characteristic_length_[k] * rotation_between(from.rotation, to.rotation);
  }
  return u;
}

double Kinematics::norm(const State& state) const {
  double squares = state.position.squaredNorm();
  for (std::size_t k = 0; k < characteristic_length_.size(); ++k) squares += state.bodies[k].position.hi.squaredNorm() + characteristic_length_[k] * characteristic_length_[k];
  return std::sqrt(squares);
}

void Kinematics::pull_back(Vector& gradient, const Vector& y) const {
  for (std::size_t k = 0; k < characteristic_length_.size(); ++k) {
    const int b = static_cast<int>(k), s = rotation_of(b);
    const Vec3 theta = rotation_by(y, b);
    if (theta == Vec3::Zero()) continue;
    Vec3 g = Vec3::Zero();
    for (int c = 0; c < 3; ++c)
      if (dof_(c, s) >= 0) g[c] = gradient[dof_(c, s)];
    g = RotationChart(theta).jacobian().transpose() * g;
    for (int c = 0; c < 3; ++c)
      if (dof_(c, s) >= 0) gradient[dof_(c, s)] = g[c];
  }
}

// Of a body with three free turns, dofs d, d + 1, d + 2: rows and columns through J, and the chart's curvature; with fewer the
// axis is fixed, J the identity and the curvature zero along it.
void Kinematics::pull_back(SparseMatrix& hessian, const Vector& gradient, const Vector& y) const {
  for (std::size_t k = 0; k < characteristic_length_.size(); ++k) {
    const int b = static_cast<int>(k), d = dof_(0, rotation_of(b));
    const Vec3 theta = rotation_by(y, b);
    if (theta == Vec3::Zero() || (dof_.col(rotation_of(b)).array() < 0).any()) continue;
    const RotationChart chart(theta);
    const Mat3 J = chart.jacobian(), JT = J.transpose();
    int* const start = hessian.outerIndexPtr();
    double* const value = hessian.valuePtr();
    const int* const row = hessian.innerIndexPtr();
    for (int j = 0; j < d; ++j)                                  // to its left: three rows, one after the other
      for (int i = start[j]; i < start[j + 1]; ++i)
        if (row[i] == d) {
          Eigen::Map<Vec3> column(value + i);
          column = (JT * column).eval();
          break;
        }
    // Its own columns: the block on the diagonal in three pieces, everything below with the same rows in each.
    Mat3 own;
    own << value[start[d]], 0, 0, value[start[d] + 1], value[start[d + 1]], 0, value[start[d] + 2], value[start[d + 1] + 1], value[start[d + 2]];
    own = Mat3(own.selfadjointView<Eigen::Lower>());
    own = (JT * own * J + chart.curvature(gradient.segment<3>(d)) / characteristic_length_[b]).eval();
    value[start[d]] = own(0, 0), value[start[d] + 1] = own(1, 0), value[start[d] + 2] = own(2, 0);
    value[start[d + 1]] = own(1, 1), value[start[d + 1] + 1] = own(2, 1), value[start[d + 2]] = own(2, 2);
    for (int i = 1; start[d + 2] + i < start[d + 3]; ++i) {
      double &x = value[start[d] + 2 + i], &z = value[start[d + 1] + 1 + i], &w = value[start[d + 2] + i];
      const Vec3 r = JT * Vec3(x, z, w);
      x = r[0], z = r[1], w = r[2];
    }
  }
}

void Kinematics::restrict(const Field& field, Vector& out) const {
  assert(field.cols() == sites());
  out.resize(dofs());
  for (int s = 0; s < sites(); ++s)
    for (int c = 0; c < 3; ++c)
      if (dof_(c, s) >= 0) out[dof_(c, s)] = field(c, s);
}

Vector Kinematics::restrict(const Field& field) const {
  Vector v;
  restrict(field, v);
  return v;
}

Field Kinematics::extend(const Vector& v) const {
  assert(v.size() == dofs());
  Field field = Field::Zero(3, sites());
  for (int s = 0; s < sites(); ++s)
    for (int c = 0; c < 3; ++c)
      if (dof_(c, s) >= 0) field(c, s) = v[dof_(c, s)];
  return field;
}

Field Kinematics::extend(const Vector& v, const State& state) const {
  Field field = extend(v);
  for (const Glued& g : glued_) {
    const Vec3 arm = state.bodies[g.body].rotation * g.arm, theta = field.col(rotation_of(g.body)) / characteristic_length_[g.body];
    field.col(g.particle) = field.col(place_of(g.body)) + theta.cross(arm);
  }
  return field;
}

}  // namespace elamin
