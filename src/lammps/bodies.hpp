#pragma once
// What LAMMPS's files say of a body of style rounded/polyhedron.
#include "lammps/lines.hpp"
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

// What a LAMMPS data file says of bodies: the section Bodies line by line, and the columns of Atoms.

struct BodyRow { int line, id; BodyForm form; };

/// Of each body a line `id 3 M`, then the integers N E F and M numbers, over any line breaks (see body_form).
class LammpsBodiesSection {
 public:
  explicit LammpsBodiesSection(LammpsLines& lines) : lines_(lines) {}

  /// Takes a line. False: where the next body begins cannot be known; this was told, and no more lines are to be given.
  bool take(const DataLine& line);
  /// Behind the last line: a body that is not complete is told.
  void end();

  int begun() const { return begun_; }           // bodies
  bool sound() const { return sound_; }          // all of them could be read
  std::vector<BodyRow> rows;

 private:
  bool begin(const DataLine& line);
  void finish();

  LammpsLines& lines_;
  int begun_ = 0, line_ = 0, id_ = 0, expected_ = 0;
  bool open_ = false, good_ = true, sound_ = true;   // in the middle of a body; which is good so far
  std::vector<int> counts_;                          // N E F
  std::vector<double> numbers_;
};

/// The columns of atom style body, word i of a line: the flag must be 1, the mass positive. Else that is noted.
[[nodiscard]] std::optional<bool> body_flag(LammpsLines& lines, const DataLine& line, std::size_t i);
[[nodiscard]] std::optional<double> body_mass(LammpsLines& lines, const DataLine& line, std::size_t i);

// LAMMPS's molecule files, of one body.

struct LammpsMolecule {
  BodyForm form;                         // about the centre of mass
  double mass = 0;                       // 0: not given
};

/// Reads a molecule file (the file of LAMMPS's command `molecule`) that holds one body of style rounded/polyhedron: header
/// lines `1 atoms`, `3 M body` and perhaps `m mass`, `x y z com`, the sections Body Integers (N E F) and Body Doubles (M
/// numbers: see body_form), over any line breaks, and perhaps Coords, Types, Molecules, Diameters and Masses (id, mass). The
/// places of the atom and of the centre of mass, the type and the diameter of the atom are read and say nothing. An inertia
/// in the header must be the body's own. Throws InputError with file, line and column of all mistakes.
LammpsMolecule read_molecule(const std::string& file);

}  // namespace elamin
