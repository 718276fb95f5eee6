#pragma once
// A model and the stages of its study as a LAMMPS input script and data file.
#include "model/model.hpp"

#include <string>
#include <vector>

namespace elamin {

/// A stage: what is in force, and from where to where the load factor goes.
struct ExportStage {
  std::string name;                        // "": the study has no stages
  Model model;
  double from = 0, to = 0;
};

/// What is to be exported. Particles, bonds and angles are those of every stage's model.
struct ExportedStudy {
  enum class Kind { energy, equilibria, motion };
  Kind kind = Kind::equilibria;
  std::string title, source;               // of the problem; the name of its file
  State start;
  std::vector<ExportStage> stages;         // at least one
  double timestep = 0, drag = 0;           // time; of equilibria the drag that lets the motion die down [force·time/length]
  long steps = 0;                          // of each stage
  std::vector<std::string> refused;        // what cannot be exported, as far as it is known already
  std::vector<std::string> notes;          // comments for the script's beginning
};

struct LammpsExport {
  std::string script;
  Model written;                           // as the data file has it: with the types that pair_coeff speaks of
  std::vector<std::pair<std::string, std::string>> files;   // that the script reads besides: names and texts
  std::vector<std::string> refused;        // all that LAMMPS cannot say, each a sentence; the script has it not
};

/// Script and model. data_file: the name by which the script reads the data file. Units are "si": numbers as in the problem. Of
/// equilibria each stage is a run in which driven ends and walls travel, loads rise with the load factor, and drag takes the motion out.
LammpsExport export_to_lammps(const ExportedStudy& study, const std::string& data_file);

}  // namespace elamin
