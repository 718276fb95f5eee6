#pragma once
// From a section and a modulus to the stiffnesses of bonds and angles (LAMMPS's factors: U = K(q−q₀)², U = B(1+cos θ)).
// Source: Guerra 2021, equations (7), (12) for the cylinder, (13), (14) for the square; written for a thickness t ≠ q₀.
#include "core/types.hpp"

namespace elamin {

enum class Section { cylinder, square };

/// K = EA/(2q₀) [energy/length²]: cylinder πEt²/(8q₀), square Et²/(2q₀). E [energy/length³], t, q₀ [length].
constexpr double bond_stiffness(Section s, double E, double t, double q0) {
  return s == Section::cylinder ? pi * E * t * t / (8 * q0) : E * t * t / (2 * q0);
}

/// B = EI/q₀ [energy]: cylinder πEt⁴/(64q₀), square Et⁴/(12q₀).
constexpr double angle_stiffness(Section s, double E, double t, double q0) {
  return s == Section::cylinder ? pi * E * t * t * t * t / (64 * q0) : E * t * t * t * t / (12 * q0);
}

}  // namespace elamin
