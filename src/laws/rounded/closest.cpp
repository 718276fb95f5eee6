#include "laws/rounded/closest.hpp"

#include <limits>

namespace elamin {

namespace {


/// The face of `by` that has all vertices of `seen` farthest outside of it: the separation along its normal, and its
/// lowest vertex.
struct FaceAxis {
  double separation = -infinity;
  int face = 0, vertex = 0;
};

FaceAxis face_axis(const CoreView& view) {
  FaceAxis best;
  for (int f = 0; f < static_cast<int>(view.by->faces.size()); ++f) {
    int lowest = 0;
    for (int k = 1; k < static_cast<int>(view.vertices.size()); ++k)
      if (view.heights_of(k)[f] < view.heights_of(lowest)[f]) lowest = k;
    if (view.heights_of(lowest)[f] > best.separation) best = {view.heights_of(lowest)[f], f, lowest};
  }
  return best;
}

/// min over A of n·x − max over B of n·x, in the frame of B.
double separation_along(const PairView& view, const Vec3& n) {
  double a = infinity, b = -infinity;
  for (const Vec3& x : view.seen(true).vertices) a = std::min(a, n.dot(x));
  for (const Vec3& x : view.shape(false).vertices) b = std::max(b, n.dot(x));
  return a - b;
}

/// The cross product of edges with the largest separation, of edges that bear on each other along it.
ClosestFeatures edge_axis(const PairView& view) {
  ClosestFeatures best;
  best.distance = -infinity, best.edges = true;
  const double rounding = 1e-12 * (view.shape(true).extent + view.shape(false).extent);
  for (int ea = 0; ea < static_cast<int>(view.shape(true).edges.size()); ++ea)
    for (int eb = 0; eb < static_cast<int>(view.shape(false).edges.size()); ++eb) {
      if (view.shape(true).edges[ea].flat || view.shape(false).edges[eb].flat) continue;
      LinePair lines = view.lines(ea, eb);
      if (!lines.crossing) continue;
      for (int side = 0; side < 2; ++side, lines.flip()) {
        const double separation = separation_along(view, lines.normal);
        if (separation > best.distance && lines.distance - separation <= rounding)
          best.distance = separation, best.edge_a = ea, best.edge_b = eb, best.lines = lines;
      }
    }
  best.distance = best.lines.crossing ? best.lines.distance : -infinity;
  return best;
}

ClosestFeatures at_vertex(bool first, int vertex, const CoreDistance& d) {
  ClosestFeatures f;
  f.distance = d.value, f.first = first, f.vertex = vertex, f.at = d;
  return f;
}

ClosestFeatures at_face(const CoreView& view, bool first, const FaceAxis& axis) {
  const Vec3& n = view.by->faces[axis.face].normal;
  const Vec3 foot = view.vertices[axis.vertex] - axis.separation * n;
  return at_vertex(first, axis.vertex, {axis.separation, n, foot, {FeatureKind::face, axis.face}, Vec3::Zero()});
}

/// Of disjoint cores.
ClosestFeatures nearest(const PairView& view, double range) {
  ClosestFeatures best;
  best.distance = infinity;
  const auto beyond = [&](double bound) { return bound > std::min(best.distance, range); };
  for (const bool first : {true, false}) {
    const CoreView& side = view.seen(first);
    for (int k = 0; k < static_cast<int>(side.vertices.size()); ++k) {
      if (beyond(side.bounds[k])) continue;
      const CoreDistance d = side.distance(k);
      if (d.value < best.distance) best = at_vertex(first, k, d);
    }
  }
  for (int ea = 0; ea < static_cast<int>(view.shape(true).edges.size()); ++ea) {
    const RoundedShape::Edge& a = view.shape(true).edges[ea];
    if (a.flat || beyond(view.seen(true).edge_bound(a))) continue;
    for (int eb = 0; eb < static_cast<int>(view.shape(false).edges.size()); ++eb) {
      const RoundedShape::Edge& b = view.shape(false).edges[eb];
      if (b.flat || beyond(view.seen(false).edge_bound(b))) continue;
      const LinePair lines = view.lines(ea, eb);
      if (!lines.within() || !(lines.distance < best.distance)) continue;
      best.distance = lines.distance, best.edges = true, best.edge_a = ea, best.edge_b = eb, best.lines = lines;
    }
  }
  return best;
}

std::optional<ClosestFeatures> find(PairView& view, const RoundedBody& a, const RoundedBody& b, double cutoff) {
  if (!view.set(a, b, cutoff)) return {};
  return closest_features(view, view.radii() + cutoff);
}

RoundedContact contact_at(const PairView& view, const ClosestFeatures& f) {
  return f.edges ? view.edge_contact(f.edge_a, f.edge_b, f.lines, 1) : view.vertex_contact(f.first, f.vertex, f.at, 1);
}

}  // namespace

std::optional<ClosestFeatures> closest_features(const PairView& view, double range) {
  const FaceAxis onto_b = face_axis(view.seen(true)), onto_a = face_axis(view.seen(false));
  const double separation = std::max(onto_b.separation, onto_a.separation);
  if (separation > range) return {};
  const bool solid = !view.shape(true).faces.empty() || !view.shape(false).faces.empty();
  if (solid && separation <= 0) {                                      // no face separates them: perhaps two edges do
    const ClosestFeatures crossed = edge_axis(view);
    if (crossed.distance <= 0) {
      if (crossed.distance > separation) return crossed;
      return onto_b.separation >= onto_a.separation ? at_face(view.seen(true), true, onto_b)
          : at_face(view.seen(false), false, onto_a);
    }
  }
  const ClosestFeatures best = nearest(view, range);
  if (best.distance > range) return {};
  return best;
}

double RoundedClosest::value(const RoundedBody& a, const RoundedBody& b) const {
  PairView& view = PairView::scratch();
  const std::optional<ClosestFeatures> f = find(view, a, b, kernel.cutoff);
  return f ? kernel.value(f->distance - view.radii()) : 0.0;
}

PairLocal RoundedClosest::derivatives(const RoundedBody& a, const RoundedBody& b) const {
  PairView& view = PairView::scratch();
  PairLocal u;
  const std::optional<ClosestFeatures> f = find(view, a, b, kernel.cutoff);
  if (!f) return u;
  const double gap = f->distance - view.radii(), slope = kernel.slope(gap), curvature = kernel.curvature(gap);
  u.value = kernel.value(gap);
  if (f->edges) {
    const LineFunction d = LineDerivatives(f->lines, view.edge_a(f->edge_a), view.edge_b(f->edge_b)).distance;
    view.add_lines(u, f->edge_a, f->lines, slope * d.gradient, slope * d.hessian + curvature * d.gradient * d.gradient.transpose());
  } else {
    const Vec3& n = f->at.normal;
    view.add_vertex(u, f->first, f->vertex, slope * n, curvature * n * n.transpose() + slope * f->at.curvature());
  }
  mirror(u);
  return u;
}

std::array<Wrench, 2> RoundedClosest::forces(const RoundedBody& a, const RoundedBody& b, std::vector<RoundedContact>* contacts) const {
  PairView& view = PairView::scratch();
  std::array<Wrench, 2> on;
  const std::optional<ClosestFeatures> f = find(view, a, b, kernel.cutoff);
  if (!f) return on;
  const double slope = kernel.slope(f->distance - view.radii());
  if (f->edges) view.push_lines(on, f->edge_a, f->lines, (Vec6() << slope * f->lines.normal, Vec3::Zero()).finished());
  else view.push_vertex(on, f->first, f->vertex, slope * f->at.normal);
  if (contacts) contacts->push_back(contact_at(view, *f));
  return on;
}

void RoundedClosest::contacts(const RoundedBody& a, const RoundedBody& b, std::vector<RoundedContact>& out) const {
  PairView& view = PairView::scratch();
  if (const std::optional<ClosestFeatures> f = find(view, a, b, kernel.cutoff)) out.push_back(contact_at(view, *f));
}

double core_separation(const RoundedBody& a, const RoundedBody& b) {
  PairView& view = PairView::scratch();
  const std::optional<ClosestFeatures> f = find(view, a, b, infinity);
  return f ? f->distance : std::numeric_limits<double>::quiet_NaN();
}

bool cores_overlap(const RoundedBody& a, const RoundedBody& b) {
  PairView& view = PairView::scratch();
  const std::optional<ClosestFeatures> f = find(view, a, b, 0);
  return f && f->distance <= 0;
}

}  // namespace elamin
