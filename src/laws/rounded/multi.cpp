#include "laws/rounded/multi.hpp"

namespace elamin {

namespace {

/// A function of one variable with two derivatives.
struct Jet {
  double value = 1, slope = 0, curvature = 0;
};

/// S(x) = 6x⁵ − 15x⁴ + 10x³, 0 below 0, 1 above 1.
Jet step(double x) {
  if (!(x > 0)) return {0, 0, 0};
  if (x >= 1) return {1, 0, 0};
  return {x * x * x * (10 - x * (15 - 6 * x)), 30 * x * x * (1 - x) * (1 - x), 60 * x * (1 - x) * (1 - 2 * x)};
}

/// S(t/g) S((1 − t)/g).
Jet within(double t, double g) {
  const Jet a = step(t / g), b = step((1 - t) / g);
  return {a.value * b.value, (a.slope * b.value - a.value * b.slope) / g,
          (a.curvature * b.value - 2 * a.slope * b.slope + a.value * b.curvature) / (g * g)};
}

Jet kernel_jet(const RoundedKernel& U, double gap) { return {U.value(gap), U.slope(gap), U.curvature(gap)}; }

/// κ(b) with derivatives by b.
struct Share {
  double value = 1;
  Vec3 gradient = Vec3::Zero();
  Mat3 hessian = Mat3::Zero();
};

Share share(const RoundedShape& core, const Vec3& b, double corner) {
  Share k;
  const double h = corner * core.shortest_edge;
  for (const Vec3& c : core.vertices) {
    const Vec3 d = b - c;
    const double r = d.norm();
    if (r >= h) continue;
    const Jet s = step(r / h);
    k.value -= (1 - s.value) / 2;
    if (!(r > 0)) continue;                                            // S′ and S″ are 0
    const Vec3 n = d / r;
    const Mat3 nn = n * n.transpose();
    k.gradient += s.slope / (2 * h) * n;
    k.hessian += s.curvature / (2 * h * h) * nn + s.slope / (2 * h * r) * (Mat3::Identity() - nn);
  }
  return k;
}

/// One vertex near the other core.
struct VertexTerm {
  bool first;
  int vertex;
  CoreDistance distance;
  Share share;
  Jet energy;

  double weight() const { return share.value; }
  double value() const { return share.value * energy.value; }
  RoundedContact contact(const PairView& view) const { return view.vertex_contact(first, vertex, distance, weight()); }

  void push(std::array<Wrench, 2>& on, const PairView& view) const {
    view.push_vertex(on, first, vertex, share.value * energy.slope * distance.normal + energy.value * (distance.tangent() * share.gradient));
  }
  void push_gate(std::array<Wrench, 2>& on, const PairView& view) const { view.push_vertex(on, first, vertex, distance.tangent() * share.gradient); }

  /// φ = κ(b) U(s):  ∇φ = κ U′ n + U T ∇κ,  ∇²φ = κ (U″ n nᵀ + U′ ∇²s) + U′ (n (T∇κ)ᵀ + (T∇κ) nᵀ) + U T ∇²κ T;
  /// T = ∂b/∂y.
  void add(PairLocal& u, const PairView& view) const {
    const Vec3& n = distance.normal;
    const Mat3 T = distance.tangent();
    const Vec3 t = T * share.gradient;
    const Vec3 g = share.value * energy.slope * n + energy.value * t;
    const Mat3 nt = n * t.transpose();
    view.add_vertex(u, first, vertex, g,
                    share.value * (energy.curvature * n * n.transpose() + energy.slope * distance.curvature()) +
                        energy.slope * (nt + nt.transpose()) + energy.value * T * share.hessian * T);
  }
};

/// Two edges: E = U(d) w_a(t_a) w_b(t_b) w(sin²ϑ).
struct EdgeTerm {
  int ea, eb;
  LinePair lines;
  std::array<Jet, 4> factor;

  double weight() const { return factor[1].value * factor[2].value * factor[3].value; }
  double value() const { return weight() * factor[0].value; }
  RoundedContact contact(const PairView& view) const { return view.edge_contact(ea, eb, lines, weight()); }

  void push(std::array<Wrench, 2>& on, const PairView& view) const {
    const LineGradients d(lines, view.edge_a(ea), view.edge_b(eb));
    view.push_lines(on, ea, lines, factor[0].slope * weight() * d.distance + factor[0].value * by_place(d));
  }
  void push_gate(std::array<Wrench, 2>& on, const PairView& view) const {
    view.push_lines(on, ea, lines, by_place(LineGradients(lines, view.edge_a(ea), view.edge_b(eb))));
  }

  /// ∇w.
  Vec6 by_place(const LineGradients& d) const {
    return factor[1].slope * others(0, 1) * d.ta + factor[2].slope * others(0, 2) * d.tb + factor[3].slope * others(0, 3) * d.sine2;
  }

  /// The product of the values of all factors but i and j.
  double others(std::size_t i, std::size_t j) const {
    double p = 1;
    for (std::size_t k = 0; k < 4; ++k) if (k != i && k != j) p *= factor[k].value;
    return p;
  }

  void add(PairLocal& u, const PairView& view) const {
    const LineDerivatives d(lines, view.edge_a(ea), view.edge_b(eb));
    const std::array<const LineFunction*, 4> z{&d.distance, &d.ta, &d.tb, &d.sine2};
    Vec6 g = Vec6::Zero();
    Mat6 H = Mat6::Zero();
    for (std::size_t i = 0; i < 4; ++i) {
      const double slope = factor[i].slope * others(i, i);
      g += slope * z[i]->gradient;
      H += slope * z[i]->hessian + factor[i].curvature * others(i, i) * z[i]->gradient * z[i]->gradient.transpose();
      for (std::size_t j = 0; j < i; ++j) {
        const Mat6 zz = factor[i].slope * factor[j].slope * others(i, j) * z[i]->gradient * z[j]->gradient.transpose();
        H += zz + zz.transpose();
      }
    }
    view.add_lines(u, ea, lines, g, H);
  }
};

template <class Term>
void append(std::vector<RoundedContact>& out, const Term& term, const PairView& view) {
  if (!(term.weight() > 0)) return;
  std::array<Wrench, 2> gate;
  term.push_gate(gate, view);
  out.push_back(term.contact(view)), out.back().gate = gate[0].force;
}

/// Calls `vertex` and `edge` with every term in range.
template <class OnVertex, class OnEdge>
void visit(const RoundedMulti& law, const PairView& view, const OnVertex& vertex, const OnEdge& edge) {
  const double rho = view.radii(), range = rho + law.kernel.cutoff;
  const bool lone[2] = {view.shape(false).vertices.size() == 1, view.shape(true).vertices.size() == 1};
  for (const bool first : {true, false}) {
    const CoreView& side = view.seen(first);
    if (lone[!first] && !(first && lone[first])) continue;             // its own vertex acts; of two spheres the first
    for (int k = 0; k < static_cast<int>(side.vertices.size()); ++k) {
      if (side.bounds[k] > range) continue;
      const CoreDistance d = side.distance(k);
      if (d.value > range) continue;
      const Share kappa = lone[first] ? Share{} : share(*side.by, d.nearest, law.corner);
      vertex(VertexTerm{first, k, d, kappa, kernel_jet(law.kernel, d.value - rho)});
    }
  }
  for (int ea = 0; ea < static_cast<int>(view.shape(true).edges.size()); ++ea) {
    const RoundedShape::Edge& a = view.shape(true).edges[ea];
    if (a.flat || view.seen(true).edge_bound(a) > range) continue;
    for (int eb = 0; eb < static_cast<int>(view.shape(false).edges.size()); ++eb) {
      const RoundedShape::Edge& b = view.shape(false).edges[eb];
      if (b.flat || view.seen(false).edge_bound(b) > range) continue;
      const LinePair lines = view.lines(ea, eb);
      if (!lines.within() || lines.distance > range) continue;
      Jet parallel = step(lines.sine2 / law.sine2);
      parallel.slope /= law.sine2, parallel.curvature /= law.sine2 * law.sine2;
      const Jet U = kernel_jet(law.kernel, lines.distance - rho);
      edge(EdgeTerm{ea, eb, lines, {U, within(lines.ta, law.ends), within(lines.tb, law.ends), parallel}});
    }
  }
}

}  // namespace

double RoundedMulti::value(const RoundedBody& a, const RoundedBody& b) const {
  PairView& view = PairView::scratch();
  double U = 0;
  if (!view.set(a, b, kernel.cutoff)) return U;
  const auto add = [&U](const auto& term) { U += term.value(); };
  visit(*this, view, add, add);
  return U;
}

PairLocal RoundedMulti::derivatives(const RoundedBody& a, const RoundedBody& b) const {
  PairView& view = PairView::scratch();
  PairLocal u;
  if (!view.set(a, b, kernel.cutoff)) return u;
  const auto add = [&](const auto& term) { u.value += term.value(), term.add(u, view); };
  visit(*this, view, add, add);
  mirror(u);
  return u;
}

std::array<Wrench, 2> RoundedMulti::forces(const RoundedBody& a, const RoundedBody& b, std::vector<RoundedContact>* contacts) const {
  PairView& view = PairView::scratch();
  std::array<Wrench, 2> on;
  if (!view.set(a, b, kernel.cutoff)) return on;
  const auto add = [&](const auto& term) {
    term.push(on, view);
    if (contacts) append(*contacts, term, view);
  };
  visit(*this, view, add, add);
  return on;
}

void RoundedMulti::contacts(const RoundedBody& a, const RoundedBody& b, std::vector<RoundedContact>& out) const {
  PairView& view = PairView::scratch();
  if (!view.set(a, b, kernel.cutoff)) return;
  const auto add = [&](const auto& term) { append(out, term, view); };
  visit(*this, view, add, add);
}

}  // namespace elamin
