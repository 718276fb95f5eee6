#pragma once
// The tables that the runs of a script become, and what is told of them.
#include "lammps/script/group_names.hpp"
#include "lammps/script/translation.hpp"

namespace elamin::script {

/// A table of the file that may be in force in some of the runs.
struct Table {
  std::string kind, name, body;                 // "wall"; the keys behind its name
  Where where;
  std::string comment;
  int serial = 0;
  std::vector<bool> in_run;
  bool staged = true;
};

/// Of one pass of a script.
struct TableList {
  TableList(const Reading& script, const Pass& pass, const TranslationOptions& chosen)
      : reading(script), world(pass.world), options(chosen), particles(world), groups(world, particles) {}

  /// How many stages there are: at least one.
  int runs() const;
  /// The table is in force in a run; the same one as in the run before if nothing of it differs.
  void put(int run, Table t);
  /// Tells something of a line, once.
  void note(const Where& w, const std::string& text);
  /// Throws InputError.
  [[noreturn]] void refuse(const Where& w, const std::string& key, const std::string& what) const;

  const Reading& reading;
  const World& world;
  TranslationOptions options;
  Particles particles;
  GroupNames groups;
  std::vector<Table> tables;
  std::vector<Note> notes;
};

/// Puts the [[contact]] tables of run k: its pair coefficients, those that LAMMPS mixes, and pairs that neigh_modify leaves out.
/// Throws InputError for weights of special_bonds and damping that no table can say.
void put_contacts(TableList& list, int k, const Run& run);

}  // namespace elamin::script
