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

// Atom types that let pair_coeff say which pairs feel each other.

/// Types from 1 of all particles, such that within every stage all pairs of two types follow the same contact tables; a type of
/// the model is kept whole where that is possible. LAMMPS's granular style (of 2021) knows nothing of special_bonds: pairs
/// that are glued too closely to touch need types of their own, at worst one a particle.
struct ExportTypes {
  /// Tables of Model::contacts between two types, −1: none. Of cohesion whatever the bonds between them, see `special`.
  struct Rule {
    int hertz = -1, lj = -1;
    bool operator==(const Rule&) const = default;
  };
  struct Stage {
    std::vector<Rule> rules;                // types × types
    int special = 0;                        // cohesion: pairs this many bonds apart or nearer feel none
  };
  int count = 0;
  std::vector<int> type;
  std::vector<Stage> stages;
  std::vector<std::string> refused;         // what types cannot say, in sentences

  const Rule& rule(std::size_t stage, int a, int b) const { return stages[stage].rules[(a - 1) * count + b - 1]; }
};

/// Of models that differ in their contacts alone, one a stage. At most `most` types.
ExportTypes export_types(const std::vector<const Model*>& stages, int most = 400);

// What acts in a stage as lines of a LAMMPS script: loads, weight, walls, drag.

/// A `fix`: its id without a number, the particles it is for, and what stands behind the group. Lines before it define its variables,
/// and of a wall its region.
struct ExportFix {
  std::string name;
  std::vector<int> particles;
  std::string text;
  std::vector<std::string> variables, regions;
  std::string means;                        // a comment
  std::vector<std::pair<std::string, std::string>> files = {};   // that the variables read: names and texts
};

/// A name with letters, digits and _ alone, as LAMMPS wants them.
std::string lammps_name(std::string name);

/// The shortest number that reads back to the same double.
std::string lammps_number(double value);

/// "hertz/material 2E_eff γ 0 tangential linear_nohistory x μ damping …" of pair_coeff, and of wall/gran/region: with ν = 0 their
/// moduli are E_eff = E/2 in every version; others, of 2021, have E/(2(1 − ν)) at walls.
std::string granular_law(double effective_modulus, const ContactDamping& damping);

/// Everything but supports that acts while the load factor goes from one value to another; what LAMMPS cannot say is told in `refused`.
/// stem: of the names of files.
std::vector<ExportFix> export_fixes(const Model& model, double from, double to, const std::string& stem, std::vector<std::string>& refused);

}  // namespace elamin
