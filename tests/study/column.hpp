#pragma once
#include <string>

/// A column of 14 particles in the plane, with the groups of its two clamps: the beginning of problem files.
inline const std::string column_and_ends = R"(
plane = "xz"
[[beam]]
name = "column"
particles = 14
center = [0, 0, 0]
axis = [0, 0, 1]
diameter = 1e-3
youngs_modulus = 0.96e6
[[group]]
name = "bottom"
of = "column"
first = 2
[[group]]
name = "top"
of = "column"
last = 2
)";

/// Its clamps pushed together by twice the shortening at which it buckles.
inline const std::string pressed_column = column_and_ends + R"([[support]]
group = "bottom"
[[support]]
group = "top"
displacement = [0, 0, -0.4e-3]
)";

/// … with how far it goes sideways as z.
inline const std::string pressed_column_observed = pressed_column + R"([[observe]]
name = "z"
group = "column"
quantity = "displacement.x"
reduce = "max"
)";
