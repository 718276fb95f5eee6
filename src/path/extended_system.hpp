#pragma once
// The equations of a threshold, an equilibrium with one condition more, in the load factor λ and a second parameter μ of the structure.
#include "path/event.hpp"

#include <deque>
#include <memory>

namespace elamin {

/// The structure at one value of the second parameter.
struct Variant {
  Variant(Model m, const NewtonOptions& options) : model(std::move(m)), energy(model), newton(energy, options) {}
  Model model;
  Energy energy;
  Newton newton;
};

/// Why a curve does not lead on; what() is a phrase.
struct NotFollowed : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The structure at a value of μ. Throws NotFollowed where there is none with the same particles, bonds, angles and free coordinates.
using VariantAt = std::function<std::shared_ptr<Variant>(double second)>;

/// A direction (dx, dλ, dμ); x: dofs [length], beside the way that the structure's places at rest go with μ.
struct CurveDirection {
  Vector x;
  double load = 0, second = 0;
  CurveDirection operator*(double by) const { return {x * by, load * by, second * by}; }
  CurveDirection operator+(const CurveDirection& d) const { return {x + d.x, load + d.load, second + d.second}; }
};

/// |(x, λ, μ)|² = |x|²/L² + λ²/Λ² + μ²/M².
struct CurveMetric {
  double length = 1, load = 1, second = 1;
  double dot(const CurveDirection& a, const CurveDirection& b) const {
    return a.x.dot(b.x) / (length * length) + a.load * b.load / (load * load) + a.second * b.second / (second * second);
  }
  CurveDirection unit(const CurveDirection& d) const { return d * (1 / std::sqrt(dot(d, d))); }
};

/// One point of a curve of thresholds.
struct Threshold {
  EventKind kind = EventKind::limit;   // limit, branch or contact
  double second = 0;                   // μ
  Equilibrium at;                      // its zero modes: without the critical ones
  Eigen::MatrixXd modes;               // null vectors, orthonormal (dofs × multiplicity); of a contact none
  ContactKey contact = {};             // whose gap is zero
  CurveDirection direction = {};       // unit tangent of the curve
  CurveDirection way = {};             // unit: of the equilibrium with its null vectors held, at this μ
  double asymmetry = 0;                // ∇³E v v v/|∇³E v v| of the first null vector, ±1 at most
};

/// The extended system of a threshold. With Z the zero modes and Φ the null vectors held, one factorisation of
///   [ H   sΦ  sZ ]
///   [ sΦᵀ  0   0 ]
///   [ sZᵀ  0   0 ]
/// gives v = φ + y with H v = θ φ, φᵀv = 1, and for right sides b the p of H p = b, Φᵀp = 0 but for multiples of Φ. The unknowns are
///   (dx, dλ, dμ) = α (v, 0, 0) + σ (p_L, δ_L, 0) + τ (p_M, δ_M, 1) + (p₀, δ₀, 0),
/// (p_L, δ_L): H p + δ ∂g/∂λ = 0, of unit length: the way of the equilibrium with its mode held, which is regular at hill-tops, too;
/// (p_M, δ_M): H p + δ ∂g/∂λ = −∂g/∂μ, across it; (p₀, δ₀): H p + δ ∂g/∂λ = −g, across it. The conditions are
///   limit:    vᵀg = 0,        θ = vᵀH v = 0            (minimally augmented: Griewank & Reddien 1984; Govaerts 2000, §4.1)
///   branch:   vᵀ∂g/∂λ = 0,    θ = 0                    (Moore 1980, SIAM J. Numer. Anal. 17; the force vᵀg that he adds must vanish)
///   contact:  gap = 0          (without α)
/// and one of arc length, or that μ has a value. Derivatives of the conditions along these directions are central differences; g, H v,
/// ∂g/∂λ and gaps are exact, and so is where Newton's method comes to rest.
/// Where there is no structure, or no solution, all of it throws NotFollowed.
class ExtendedSystem {
 public:
  explicit ExtendedSystem(VariantAt variants) : variants_(std::move(variants)) {}

  /// Newton's method from a point near by: on the plane across a direction through it, or at its μ. What it finds has its tangent; its
  /// sense is that of the direction, or of growing μ. It ends with corrections of rounding and a residual below Newton's tolerance.
  void solve(Threshold& point, const CurveDirection* across);
  /// The point moved along a direction.
  void move(Threshold& point, const CurveDirection& by);
  /// The direction from one point to another.
  CurveDirection way(const Threshold& from, const Threshold& to);
  std::shared_ptr<Variant> variant(double second);
  /// The residual, Morse index, energies and zero modes of a point that was found.
  void assess_at(Threshold& point);

  CurveMetric metric;

 private:
  struct Linear;
  State moved(const Threshold& from, const CurveDirection& by);
  double step_of(const Threshold& at, const CurveDirection& along);
  auto beside(const Threshold& at, const CurveDirection& by, const auto& value);
  auto rate(const Threshold& at, const CurveDirection& along, const auto& value);
  double gap_rate(const Threshold& at, const CurveDirection& along);
  Vector second_derivative(const Threshold& at);
  Linear linearise(Threshold& point);
  void settle(Threshold& point);

  VariantAt variants_;
  std::deque<std::pair<double, std::shared_ptr<Variant>>> recent_;
};

}  // namespace elamin
