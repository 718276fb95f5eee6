#pragma once
// What LAMMPS's files say of a body of style rounded/polyhedron.
#include "laws/rounded/shape.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace elamin {

/// The core about the centre of mass, its rounding and its inertia, all along the axes of the file.
struct BodyForm {
  CoreMesh core;
  double diameter = 0;                   // of the ball that rounds the core [length]
  Mat3 inertia = Mat3::Zero();           // about the centre of mass [mass·length²]
};

/// The form that the integers N E F (vertices, edges, faces) and these finite numbers give: ixx iyy izz ixy ixz iyz; three
/// coordinates a vertex; two vertices an edge and four a face, from 0, of a triangle −1 as the fourth; the rounding
/// diameter. Of spheres (N = 1) and rods (N = 2) edges and faces may be announced and left out; if they are there they say
/// nothing. Everything that is wrong is told, a sentence each; then there is no form.
/// Source: LAMMPS manual, Howto body; LAMMPS 29 Sep 2021.
[[nodiscard]] std::optional<BodyForm> body_form(const std::array<int, 3>& counts, const std::vector<double>& numbers,
                                  std::vector<std::string>& wrong);

/// What is wrong with a tensor of inertia, or "": its principal moments are not negative, and none exceeds the sum of the
/// others. Tolerance: 1e-6 of the largest, as files have few digits.
std::string wrong_inertia(const Mat3& inertia);

}  // namespace elamin
