#pragma once
// Random numbers as LAMMPS 29 Sep 2021 draws them.
#include "core/types.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace elamin::script {

/// x ← 16807 x mod (2³¹ − 1), from 0 to 1. Source: Park & Miller 1988, Comm. ACM 31, 1192.
class ParkMiller {
 public:
  explicit ParkMiller(long long seed) : seed_(seed) {}
  /// Of a seed and a place: the bits of both are hashed (Jenkins's one-at-a-time), so that what is drawn does not depend on the order of atoms.
  ParkMiller(int seed, const Vec3& x) {
    std::uint32_t hash = 0;
    const auto take = [&hash](const auto& value) {
      std::array<signed char, sizeof value> bytes;
      std::memcpy(bytes.data(), &value, sizeof value);
      for (const signed char byte : bytes) hash += static_cast<std::uint32_t>(byte), hash += hash << 10, hash ^= hash >> 6;
    };
    take(seed);
    for (const double c : x) take(c);
    hash += hash << 3, hash ^= hash >> 11, hash += hash << 15;
    seed_ = hash & 0x7ffffff;
    if (seed_ == 0) seed_ = 1;
    throw_away(5);
  }
  void throw_away(int n) {
    while (n-- > 0) next();
  }
  double next() {
    seed_ = 16807 * seed_ % 2147483647;
    return static_cast<double>(seed_) * (1.0 / 2147483647);
  }

 private:
  long long seed_;
};

/// Marsaglia's generator of 24 bits, u_n = u_{n−97} − u_{n−33} less an arithmetic sequence, mod 1.
/// Source: Marsaglia, Zaman & Tsang 1990, Statistics & Probability Letters 9, 35.
class Marsaglia {
 public:
  explicit Marsaglia(int seed) {               // 1 to 900000000
    const int ij = (seed - 1) / 30082, kl = (seed - 1) % 30082;
    int i = ij / 177 % 177 + 2, j = ij % 177 + 2, k = kl / 169 % 178 + 1, l = kl % 169;
    for (double& u : u_) {
      u = 0;
      double bit = 0.5;
      for (int n = 0; n < 24; ++n, bit *= 0.5) {
        const int m = i * j % 179 * k % 179;
        i = j, j = k, k = m, l = (53 * l + 1) % 169;
        if (l * m % 64 >= 32) u += bit;
      }
    }
    next();
  }
  /// From 0 to 1.
  double next() {
    double u = wrapped(u_[at_] - u_[other_]);
    u_[at_] = u;
    at_ = (at_ + 96) % 97, other_ = (other_ + 96) % 97;
    carry_ -= 7654321.0 / 16777216;
    if (carry_ < 0) carry_ += 16777213.0 / 16777216;
    return wrapped(u - carry_);
  }
  /// Normal, of mean 0 and deviation 1: two at a time, by the polar method.
  double normal() {
    if (kept_) return kept_ = false, second_;
    double a, b, square;
    do a = 2 * next() - 1, b = 2 * next() - 1, square = a * a + b * b;
    while (square >= 1 || square == 0);
    const double factor = std::sqrt(-2 * std::log(square) / square);
    kept_ = true, second_ = a * factor;
    return b * factor;
  }

 private:
  static double wrapped(double u) { return u < 0 ? u + 1 : u; }

  std::array<double, 97> u_{};
  double carry_ = 362436.0 / 16777216, second_ = 0;
  int at_ = 96, other_ = 32;
  bool kept_ = false;
};

}  // namespace elamin::script
