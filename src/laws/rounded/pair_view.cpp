#include "laws/rounded/pair_view.hpp"


namespace elamin {

void CoreView::set(const RoundedShape& s, const RoundedShape& b, const Vec3& shift, const Mat3& rotation) {
  seen = &s, by = &b;
  const std::size_t n = s.vertices.size(), faces = b.faces.size();
  vertices.resize(n), heights.resize(n * faces), bounds.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    vertices[k] = shift + rotation * s.vertices[k];
    bounds[k] = std::max(vertices[k].norm() - b.extent, face_heights(b, vertices[k], heights.data() + k * faces));
  }
}

double CoreView::edge_bound(const RoundedShape::Edge& edge) const {
  double largest = -infinity;
  const double *p = heights_of(edge.from), *q = heights_of(edge.to);
  for (std::size_t f = 0; f < by->faces.size(); ++f) largest = std::max(largest, std::min(p[f], q[f]));
  return largest;
}

PairView& PairView::scratch() {
  thread_local PairView view;
  return view;
}

bool PairView::set(const RoundedBody& a, const RoundedBody& b, double cutoff) {
  a_from_b_ = (a.pose.position - b.pose.position).hi;
  const double far = a.shape->bounding_radius() + b.shape->bounding_radius() + cutoff;
  if (!(a_from_b_.squaredNorm() <= (1 + 64 * epsilon) * far * far)) return false;
  position_b_ = b.pose.position.hi;
  rotation_a_ = a.pose.rotation.toRotationMatrix(), rotation_b_ = b.pose.rotation.toRotationMatrix();
  const Mat3 rotation = rotation_b_.transpose() * rotation_a_;
  a_by_b_.set(*a.shape, *b.shape, rotation_b_.transpose() * a_from_b_, rotation);
  b_by_a_.set(*b.shape, *a.shape, -(rotation_a_.transpose() * a_from_b_), rotation.transpose());
  return true;
}

void PairView::add_vertex(PairLocal& u, bool first, int vertex, const Vec3& gradient, const Mat3& hessian) const {
  const CoreView& view = seen(first);
  const Mat3 &own = first ? rotation_a_ : rotation_b_, &other = first ? rotation_b_ : rotation_a_;
  const Carried point{own * view.seen->vertices[vertex], other * view.vertices[vertex], true};
  add_carried<1>(u, first, {point}, Vec3(other * gradient), Mat3(other * hessian * other.transpose()));
}

void PairView::add_lines(PairLocal& u, int ea, const LinePair& lines, const Vec6& gradient, const Mat6& hessian) const {
  const Vec3 offset = rotation_b_ * lines.foot_a, along = rotation_b_ * edge_a(ea);
  Mat6 rotation = Mat6::Zero();
  rotation.topLeftCorner<3, 3>() = rotation.bottomRightCorner<3, 3>() = rotation_b_;
  const Carried point{offset - a_from_b_, offset, true}, direction{along, along, false};
  add_carried<2>(u, true, {point, direction}, Vec6(rotation * gradient), Mat6(rotation * hessian * rotation.transpose()));
}

void PairView::push_vertex(std::array<Wrench, 2>& on, bool first, int vertex, const Vec3& gradient) const {
  const CoreView& view = seen(first);
  const Mat3 &own = first ? rotation_a_ : rotation_b_, &other = first ? rotation_b_ : rotation_a_;
  const Vec3 g = other * gradient;
  on[!first].add(-g, own * view.seen->vertices[vertex]);
  on[first].add(g, other * view.vertices[vertex]);
}

void PairView::push_lines(std::array<Wrench, 2>& on, int ea, const LinePair& lines, const Vec6& gradient) const {
  const Vec3 offset = rotation_b_ * lines.foot_a, along = rotation_b_ * edge_a(ea);
  const Vec3 g = rotation_b_ * gradient.head<3>(), turning = along.cross(Vec3(rotation_b_ * gradient.tail<3>()));
  on[0].add(-g, offset - a_from_b_), on[1].add(g, offset);
  on[0].torque -= turning, on[1].torque += turning;
}

RoundedContact PairView::contact(Feature fa, Feature fb, const Vec3& foot_b, const Vec3& normal, double distance, double weight) const {
  const double gap = distance - radii();
  return {fa, fb, gap, weight, position_b_ + foot_b + (shape(false).radius + gap / 2) * normal, normal};
}

RoundedContact PairView::vertex_contact(bool first, int vertex, const CoreDistance& d, double weight) const {
  const Feature own{FeatureKind::vertex, vertex};
  if (first) return contact(own, d.feature, rotation_b_ * d.nearest, rotation_b_ * d.normal, d.value, weight);
  const Vec3 foot = rotation_b_ * shape(false).vertices[vertex];       // the vertex is B's, the feature A's
  return contact(d.feature, own, foot, -(rotation_a_ * d.normal), d.value, weight);
}

RoundedContact PairView::edge_contact(int ea, int eb, const LinePair& lines, double weight) const {
  return contact({FeatureKind::edge, ea}, {FeatureKind::edge, eb}, rotation_b_ * lines.foot_b,
      rotation_b_ * lines.normal, lines.distance, weight);
}

}  // namespace elamin
