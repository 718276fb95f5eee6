#pragma once
// What a LAMMPS data file says of bodies: the section Bodies line by line, and the columns of Atoms.
#include "lammps/body.hpp"
#include "lammps/lines.hpp"

namespace elamin {

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

}  // namespace elamin
