#include "model/centerline.hpp"

#include "model/geometry.hpp"

#include <algorithm>
#include <cmath>

namespace elamin {
namespace {

constexpr double near_corner = 1e-12;              // of the whole length

/// Places along a row in bonds: its ends at 0 and `length`, particle i at i − first.
struct Places {
  int first, length;
  Places(int particles, Clamped clamped)
      : first(clamped.from), length(particles - 1 - clamped.from - clamped.to) {}
  int of(int i) const { return i - first; }
};

/// Lengths from the first corner to each.
std::vector<double> lengths(const std::vector<Vec3>& corners) {
  std::vector<double> along{0};
  Exact sum;
  for (std::size_t s = 1; s < corners.size(); ++s) {
    sum = sum + distance(exact(corners[s - 1]), exact(corners[s]));
    along.push_back(sum.value());
  }
  return along;
}

/// The places of the corners; empty if one that is not an end has no particle.
std::vector<int> corner_places(const std::vector<double>& along, const Places& row) {
  if (row.length < 1) return {};
  std::vector<int> place{0};
  for (std::size_t s = 1; s < along.size(); ++s) {
    const double exactly = row.length * (along[s] / along.back());
    place.push_back(static_cast<int>(std::lround(exactly)));
    if (std::abs(place[s] - exactly) > near_corner * row.length || place[s] <= place[s - 1]) return {};
  }
  return place;
}

/// What an arch is described in: unit vectors along and across, the half chord, the middle of the ends.
struct Base {
  ExactVector along, across, middle;
  Exact chord;
  explicit Base(const Arch& arch) {
    const ExactVector line = exact(arch.to) - exact(arch.from), sum = exact(arch.to) + exact(arch.from);
    chord = norm(line);
    for (int c = 0; c < 3; ++c) {
      along.set(c, line[c] / chord);
      middle.set(c, sum[c] * exact(0.5));
    }
    const ExactVector aside = exact(scaled(arch.toward));
    const Exact part = dot(aside, along);
    for (int c = 0; c < 3; ++c) across.set(c, aside[c] - along[c] * part);
    const Exact size = norm(across);
    for (int c = 0; c < 3; ++c) across.set(c, across[c] / size);
  }
  /// middle + u along + v across.
  ExactVector point(Exact u, Exact v) const {
    ExactVector x;
    for (int c = 0; c < 3; ++c) x.set(c, middle[c] + u * along[c] + v * across[c]);
    return x;
  }
};

/// Points on y = h sin(πx/c) with equal chords between neighbours. The unknowns are x₁ … x_(n−1) and the chord q; Newton
/// on |p_i − p_(i−1)| = q with residuals in Exact, so that the last step leaves about 30 digits.
class SinePoints {
 public:
  SinePoints(Exact chord, double rise, int bonds) : c_(chord), h_(exact(rise)), x_(bonds + 1) {
    start();
    y_.resize(x_.size()), slope_.resize(x_.size());
  }

  bool solve() {
    double before = infinity;
    for (int i = 0; i < 100; ++i) {
      const double moved = step() / c_.hi;
      if (!(moved < 1e3)) return false;
      if (moved < 1e-29 || (moved < 1e-20 && moved >= before)) return ordered();
      before = moved;
    }
    return false;
  }
  const std::vector<Exact>& x() const { return x_; }
  const std::vector<Exact>& y() const { return y_; }
  double spacing() const { return q_.value(); }

 private:
  /// Evenly along the curve, by a table of its length.
  void start() {
    const int n = static_cast<int>(x_.size()) - 1, fine = 16 * n + 256;
    const double c = c_.hi, slope = h_.hi * exact_pi.hi / c;
    std::vector<double> length(fine + 1);
    const auto rate = [&](double t) { return c * std::hypot(1.0, slope * std::cos(exact_pi.hi * t)); };
    for (int k = 1; k <= fine; ++k) length[k] = length[k - 1] + rate((k - 0.5) / fine) / fine;
    for (int i = 1, k = 1; i < n; ++i) {
      const double wanted = length[fine] * i / n;
      while (length[k] < wanted) ++k;
      x_[i] = exact(c * (k - 1 + (wanted - length[k - 1]) / (length[k] - length[k - 1])) / fine);
    }
    x_[n] = c_;
    q_ = exact(length[fine] / n);
  }

  /// One Newton step; returns the largest movement. Forward along the row every dx_i is a_i + b_i dq; dx_n = 0 gives dq.
  double step() {
    const std::size_t n = x_.size() - 1;
    for (std::size_t i = 0; i <= n; ++i) {
      const auto [cosine, sine] = cosine_sine(x_[i] / (c_ * exact(2)));
      y_[i] = i == n ? Exact{} : h_ * sine;
      slope_[i] = h_.hi * exact_pi.hi / c_.hi * (i == n ? -1 : cosine.hi);
    }
    std::vector<double> a(n + 1), b(n + 1);
    for (std::size_t i = 1; i <= n; ++i) {
      const Exact dx = x_[i] - x_[i - 1], dy = y_[i] - y_[i - 1];
      const Exact length = square_root(dx * dx + dy * dy);
      const double left = -(dx.hi + dy.hi * slope_[i - 1]) / length.hi;
      const double right = (dx.hi + dy.hi * slope_[i]) / length.hi;
      a[i] = ((q_ - length).value() - left * a[i - 1]) / right;
      b[i] = (1 - left * b[i - 1]) / right;
    }
    const double dq = -a[n] / b[n];
    double most = std::abs(dq);
    q_ = q_ + dq;
    for (std::size_t i = 1; i < n; ++i) {
      const double move = a[i] + b[i] * dq;
      x_[i] = x_[i] + move;
      most = std::max(most, std::abs(move));
    }
    return most;
  }
  bool ordered() const {
    return std::is_sorted(x_.begin(), x_.end(), [](Exact a, Exact b) { return a.value() < b.value(); });
  }

  Exact c_, h_, q_;
  std::vector<Exact> x_, y_;
  std::vector<double> slope_;
};

}  // namespace

ExactVector point_between(const ExactVector& from, const ExactVector& to, int i, int n) {
  if (i == n) return to;
  const Exact part = exact(i) / exact(n);
  ExactVector x;
  for (int c = 0; c < 3; ++c) x.set(c, from[c] + (to[c] - from[c]) * part);
  return x;
}

Exact distance(const ExactVector& a, const ExactVector& b) { return norm(b - a); }

std::array<ExactVector, 2> ends_of_row(const Vec3& center, const Vec3& axis, double spacing, int n) {
  // Half the row along the unit axis: a/|a| · s n/2.
  const Vec3 direction = scaled(axis);
  const Exact size = norm(exact(direction)), half = two_product(spacing, n / 2.0);
  std::array<ExactVector, 2> ends;
  for (int c = 0; c < 3; ++c) {
    const Exact offset = exact(direction[c]) * half / size;
    ends[0].set(c, -offset + center[c]);
    ends[1].set(c, offset + center[c]);
  }
  return ends;
}

Centerline row(const ExactVector& from, const ExactVector& to, int particles, Clamped clamped) {
  const Places places(particles, clamped);
  Centerline line;
  line.centers.reserve(particles);
  for (int i = 0; i < particles; ++i) line.centers.push_back(point_between(from, to, places.of(i), places.length));
  line.spacing = (distance(from, to) / exact(places.length)).value();
  return line;
}

std::optional<Centerline> polyline(const std::vector<Vec3>& corners, int particles, Clamped clamped) {
  const Places places(particles, clamped);
  const std::vector<double> along = lengths(corners);
  const std::vector<int> place = corner_places(along, places);
  if (place.empty()) return std::nullopt;
  Centerline line;
  line.centers.reserve(particles);
  std::size_t s = 0;
  for (int i = 0; i < particles; ++i) {
    while (places.of(i) >= place[s + 1] && s + 2 < place.size()) ++s;
    line.centers.push_back(point_between(exact(corners[s]), exact(corners[s + 1]), places.of(i) - place[s], place[s + 1] - place[s]));
  }
  line.spacing = along.back() / places.length;
  return line;
}

Centerline along_curve(const std::vector<Vec3>& points, int particles, Clamped clamped) {
  const Places places(particles, clamped);
  std::vector<Exact> along{Exact{}};
  for (std::size_t s = 1; s < points.size(); ++s) along.push_back(along.back() + distance(exact(points[s - 1]), exact(points[s])));
  Centerline line;
  line.spacing = (along.back() / exact(places.length)).value();
  line.centers.reserve(particles);
  std::size_t s = 0;
  for (int i = 0; i < particles; ++i) {
    if (places.of(i) == places.length) {
      line.centers.push_back(exact(points.back()));
      continue;
    }
    // Beyond its ends the line goes on straight.
    const Exact at = along.back() * (exact(places.of(i)) / exact(places.length));
    while (s + 2 < points.size() && (at - along[s + 1]).value() >= 0) ++s;
    const Exact part = (at - along[s]) / (along[s + 1] - along[s]);
    const ExactVector from = exact(points[s]), whole = exact(points[s + 1]) - from;
    ExactVector x;
    for (int c = 0; c < 3; ++c) x.set(c, from[c] + whole[c] * part);
    line.centers.push_back(x);
  }
  return line;
}

std::array<int, 2> fitting(const std::vector<Vec3>& corners, int particles, Clamped clamped) {
  constexpr int farthest = 10'000;
  const std::vector<double> along = lengths(corners);
  const auto search = [&](int step) {
    for (int n = particles + step; n >= 2 && std::abs(n - particles) <= farthest; n += step)
      if (!corner_places(along, Places(n, clamped)).empty()) return n;
    return 0;
  };
  return {search(-1), search(1)};
}

bool rises(const Arch& arch) {
  if (arch.toward.isZero(0) || arch.from == arch.to) return false;
  const Vec3 along = scaled(arch.to - arch.from).normalized(), aside = scaled(arch.toward).normalized();
  return aside.cross(along).norm() > 1e-12;
}

Centerline arc(const Arch& arch, Exact turns, int particles, Clamped clamped) {
  const Places places(particles, clamped);
  const Base base(arch);
  const auto [cosine, sine] = cosine_sine(turns * exact(0.5));           // of α/2
  const Exact radius = base.chord / (sine * exact(2));
  Centerline line;
  line.centers.reserve(particles);
  for (int i = 0; i < particles; ++i) {
    const int place = places.of(i);
    if (place == 0 || place == places.length) {
      line.centers.push_back(exact(place == 0 ? arch.from : arch.to));
      continue;
    }
    // from the middle of the arc on, so that its two halves are alike
    const auto [c, s] = cosine_sine(turns * (exact(2.0 * place - places.length) / exact(2.0 * places.length)));
    line.centers.push_back(base.point(radius * s, radius * (c - cosine)));
  }
  line.spacing = (radius * exact(2) * cosine_sine(turns / exact(2.0 * places.length)).sine).value();
  return line;
}

Exact turns_of_rise(double chord, double rise) {
  const Exact tangent = two_product(2, rise) / exact(chord);
  const double angle = std::atan(tangent.value());
  // tan(a + d) = t: d = (t cos a − sin a)/(cos a + t sin a), up to d³
  const Exact quarter = exact(angle) / (exact_pi * exact(2));
  const auto [c, s] = cosine_sine(quarter);
  const Exact rest = (tangent * c - s) / (c + tangent * s) / (exact_pi * exact(2));
  return (quarter + rest) * exact(4);
}

std::optional<Centerline> half_sine(const Arch& arch, double rise, int particles) {
  const Base base(arch);
  SinePoints points(base.chord, rise, particles - 1);
  if (!points.solve()) return std::nullopt;
  Centerline line;
  line.centers.reserve(particles);
  line.centers.push_back(exact(arch.from));
  for (int i = 1; i + 1 < particles; ++i)
    line.centers.push_back(base.point(points.x()[i] - base.chord * exact(0.5), points.y()[i]));
  line.centers.push_back(exact(arch.to));
  line.spacing = points.spacing();
  return line;
}

}  // namespace elamin
