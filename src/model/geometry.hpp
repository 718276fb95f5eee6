#pragma once
// Lengths, angles and frames to about 30 digits, for builders: what is meant straight, even or round is so to the last
// bit.
#include "core/exact.hpp"

namespace elamin {

constexpr Exact exact_pi{3.14159265358979323846, 1.2246467991473532e-16};

inline Exact exact(double x) { return {x, 0}; }
inline ExactVector exact(const Vec3& x) { return {x, Vec3::Zero()}; }

/// |d|, for vectors of any size that doubles can hold.
Exact norm(const ExactVector& d);

/// v without its scale: divided by the power of 2 that brings its largest component into [1, 2); v ≠ 0.
Vec3 scaled(const Vec3& v);

struct CosineSine { Exact cosine, sine; };

/// Cosine and sine of 2π·turns, of at most 1e6 turns, to about 1e-31; exactly 0 and ±1 at quarter turns.
CosineSine cosine_sine(Exact turns);

/// angle/2π, angle in rad; a multiple of 30° that only went through the rounding of radians is taken as what it was, without whole turns.
Exact turns(double angle);

/// The angle at a point between the directions to two others [rad]; exactly π within 1e-9 of straight, and where two of
/// them are in one place.
double angle_at(const ExactVector& at, const ExactVector& a, const ExactVector& b);

/// An orthonormal frame.
struct Frame {
  ExactVector e1, e2, n;
  /// center + u e1 + v e2 + w n.
  ExactVector point(const Vec3& center, Exact u, Exact v, Exact w = {}) const;
};

/// The frame of a normal of any length but zero: n along it, e1 and e2 where the shortest rotation that takes z to n takes
/// x and y; for n = −z a half turn about x.
Frame frame_of(const Vec3& normal);

}  // namespace elamin
