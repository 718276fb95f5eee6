#pragma once
// Two bodies as they see each other: what both potentials of rounded bodies are built on.
#include "laws/rounded/core_distance.hpp"
#include "laws/rounded/carried.hpp"
#include "laws/rounded/pose.hpp"

namespace elamin {

/// A place where two rounded bodies press or attract each other.
struct RoundedContact {
  Feature first, second;                       // of the bodies A and B
  double gap = 0;                              // distance of the surfaces there; negative: overlap [length]
  double weight = 1;                           // with which its energy counts
  Vec3 point = Vec3::Zero();                   // half way between the surfaces
  Vec3 normal = Vec3::Zero();                  // unit, from B to A: the direction of a repulsive force on A
  Vec3 gate = Vec3::Zero();                    // −∂w/∂x of A: the force on A is −w U′ n + U gate [1/length]
};

/// The vertices of one core in the frame of another. `bound` and `edge_bound` are never larger than the distance of a
/// vertex or an edge from that other core.
struct CoreView {
  const RoundedShape *seen = nullptr, *by = nullptr;
  std::vector<Vec3> vertices;                  // of `seen`, in the frame of `by`
  std::vector<double> heights;                 // above the faces of `by`, vertex after vertex
  std::vector<double> bounds;                  // a vertex

  /// Vertices at shift + rotation · r.
  void set(const RoundedShape& s, const RoundedShape& b, const Vec3& shift, const Mat3& rotation);
  const double* heights_of(int vertex) const {
    return heights.data() + static_cast<std::size_t>(vertex) * by->faces.size();
  }
  double edge_bound(const RoundedShape::Edge& edge) const;
  CoreDistance distance(int vertex) const { return core_distance(*by, vertices[vertex], heights_of(vertex)); }
};

/// Two bodies A and B, A seen in the frame of B and the other way round. The difference of the positions is formed
/// first.
class PairView {
 public:
  /// One of each thread, to be set anew by whoever uses it.
  static PairView& scratch();

  /// Whether the cores may be nearer than `cutoff` plus the radii; if not, nothing else may be asked. Keeps its memory.
  bool set(const RoundedBody& a, const RoundedBody& b, double cutoff);

  const CoreView& seen(bool first) const { return first ? a_by_b_ : b_by_a_; }
  const RoundedShape& shape(bool first) const { return *seen(first).seen; }
  /// ρ_A + ρ_B.
  double radii() const { return shape(true).radius + shape(false).radius; }
  /// Two edges, of A and B, in the frame of B.
  Vec3 edge_a(int e) const {
    return a_by_b_.vertices[shape(true).edges[e].to] - a_by_b_.vertices[shape(true).edges[e].from];
  }
  Vec3 edge_b(int e) const {
    return shape(false).vertices[shape(false).edges[e].to] - shape(false).vertices[shape(false).edges[e].from];
  }
  LinePair lines(int ea, int eb) const {
    return {a_by_b_.vertices[shape(true).edges[ea].from], edge_a(ea), shape(false).vertices[shape(false).edges[eb].from], edge_b(eb)};
  }

  /// Adds a function of the place of a vertex, of A if `first`, in the frame of the other body.
  void add_vertex(PairLocal& u, bool first, int vertex, const Vec3& gradient, const Mat3& hessian) const;
  /// Adds a function of (p, u), the foot and direction of an edge of A in the frame of B.
  void add_lines(PairLocal& u, int ea, const LinePair& lines, const Vec6& gradient, const Mat6& hessian) const;

  /// Adds minus the gradient of the same functions as wrenches on A and B.
  void push_vertex(std::array<Wrench, 2>& on, bool first, int vertex, const Vec3& gradient) const;
  void push_lines(std::array<Wrench, 2>& on, int ea, const LinePair& lines, const Vec6& gradient) const;

  RoundedContact vertex_contact(bool first, int vertex, const CoreDistance& d, double weight) const;
  RoundedContact edge_contact(int ea, int eb, const LinePair& lines, double weight) const;

 private:
  RoundedContact contact(Feature fa, Feature fb, const Vec3& foot_b, const Vec3& normal, double distance, double weight) const;

  Mat3 rotation_a_, rotation_b_;
  Vec3 a_from_b_, position_b_;
  CoreView a_by_b_, b_by_a_;
};

}  // namespace elamin
