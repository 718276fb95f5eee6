#pragma once

namespace elamin {

/// How two rounded surfaces press and attract, as a function of their gap δ = (distance of the cores) − (sum of the
/// radii):
///   coded    U = k_n δ²/2 + s δ − k_na r_c²/2 for δ ≤ 0,   −k_na (r_c − δ)²/2 for 0 < δ ≤ r_c,   s = k_na r_c
///   printed  U = k_n δ²/2 − k_na r_c²/2       for δ ≤ 0,   −k_na (r_c² − δ²)/2 for 0 < δ ≤ r_c
/// and U = 0 beyond r_c. k_n, k_na [force/length], r_c [length]. Force −U′, repulsive if positive.
/// coded: C¹; U″ jumps at 0 and r_c. The attraction is largest at touching; force zero at δ = −s/k_n.
/// printed: U′ jumps by k_na r_c at r_c; force zero at touching.
/// Source: LAMMPS 29 Sep 2021, pair_style body/rounded/polyhedron: what it computes, with an energy shifted by the
/// constant that makes it 0 beyond r_c; and what its manual prints, read as magnitudes (attraction apart, repulsion on
/// overlap).
struct RoundedKernel {
  enum class Form { coded, printed };

  double normal = 0;                           // k_n
  double attraction = 0;                       // k_na
  double cutoff = 0;                           // r_c
  Form form = Form::coded;

  double value(double gap) const {
    if (gap > cutoff) return 0;
    if (gap > 0) return form == Form::coded ? -attraction * (cutoff - gap) * (cutoff - gap) / 2
                                            : -attraction * (cutoff - gap) * (cutoff + gap) / 2;
    return (normal * gap / 2 + offset()) * gap - attraction * cutoff * cutoff / 2;
  }

  /// U′ [force].
  double slope(double gap) const {
    if (gap > cutoff) return 0;
    if (gap <= 0) return normal * gap + offset();
    return form == Form::coded ? attraction * (cutoff - gap) : attraction * gap;
  }

  /// U″ [force/length]; at its jumps that of the smaller gap.
  double curvature(double gap) const {
    if (gap > cutoff) return 0;
    if (gap <= 0) return normal;
    return form == Form::coded ? -attraction : attraction;
  }

  /// The energy that LAMMPS reports: coded, without the shift, so k_na r_c²/2 too large within r_c and with a jump
  /// there.
  double reported(double gap) const {
    if (gap > cutoff) return 0;
    return ((gap > 0 ? -attraction : normal) * gap / 2 + attraction * cutoff) * gap;
  }

 private:
  double offset() const { return form == Form::coded ? attraction * cutoff : 0; }
};

}  // namespace elamin
