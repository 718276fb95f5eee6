#pragma once
#include <cmath>
#include <string>

/// A shallow truss of two bonds in the plane, half span 1, rise ½, stiffness 1 (U = (r − r₀)²), its apex led along z and
/// pressed down by 1 at load factor 1: the beginning of problem files. With r₀² = 5/4 and λ = −4 z (1 − r₀/r), the limit
/// points are at r = r₀^⅓, z = ±√(r₀^⅔ − 1), λ = ±4 (r₀^⅔ − 1)^{3/2}.
inline const std::string truss = R"(
plane = "xz"
[[grains]]
name = "feet"
positions = [[-1, 0, 0], [1, 0, 0]]
diameter = 0.1
[[grains]]
name = "apex"
positions = [[0, 0, 0.5]]
diameter = 0.1
[[connect]]
between = ["apex", "feet"]
within = 2
bond_stiffness = 1
[[support]]
group = "feet"
[[support]]
name = "guide"
group = "apex"
directions = "x"
[[load]]
name = "weight"
group = "apex"
force = [0, 0, -1]
[[observe]]
name = "z"
group = "apex"
quantity = "position.z"
)";
inline const double truss_limit_z = std::sqrt(std::cbrt(1.25) - 1), truss_limit = 4 * std::pow(truss_limit_z, 3);
inline double truss_load(double z) { return -4 * z * (1 - std::sqrt(1.25) / std::sqrt(1 + z * z)); }
