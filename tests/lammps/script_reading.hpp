#pragma once
// Short LAMMPS scripts, and what becomes of them.
#include "core/error.hpp"
#include "input/build.hpp"
#include "input/read.hpp"
#include "lammps/script/report.hpp"
#include "lammps/script/translation.hpp"
#include "scratch_directory.hpp"

namespace elamin {

/// The folder of scripts that are right.
inline const std::string lammps_scripts = ELAMIN_ROOT "/data/lammps/scripts/";

/// A box, and what glues.
inline const std::string small_script_head =
    "units si\natom_style hybrid sphere angle\nregion box block -1 1 -1 1 -1 1\n"
    "create_box 3 box bond/types 3 angle/types 2\nchange_box all boundary f f f\n"
    "pair_style granular\npair_coeff * * hertz/material 1000 0 0.3 tangential linear_nohistory 0 0\nspecial_bonds lj/coul 0 1 1\n"
    "bond_style harmonic\nbond_coeff * 5 0.1\nangle_style cosine\nangle_coeff * 0.25\n";

inline script::Reading reading_of(const std::string& text, const script::ReadingOptions& options = {}) {
  const ScratchDirectory scratch;
  return script::read_script(scratch.file("in.lmp", text), options);
}

/// The script's sentences, one a line, from the line's number on; "" if there is nothing wrong.
inline std::string script_mistakes(const std::string& text, const script::ReadingOptions& options = {}) {
  try {
    const script::Reading r = reading_of(text, options);
    for (const script::Pass& p : r.passes) script::translated(r, p, {}, "p.data");
  } catch (const InputError& e) {
    std::string all;
    for (const Mistake& m : e.mistakes()) all += (all.empty() ? "" : "\n") + m.sentence().substr(m.file.empty() ? 0 : m.file.size() + 1);
    return all;
  }
  return "";
}

/// The problem of a script's pass, written and read.
struct ImportedProblem {
  script::Translated files;
  Problem problem;
  Model model;
};

inline ImportedProblem imported(const script::Reading& reading, std::size_t pass = 0, const script::TranslationOptions& options = {}) {
  const ScratchDirectory scratch;
  ImportedProblem p{script::translated(reading, reading.passes.at(pass), options, "p.data"), {}, {}};
  scratch.file("p.data", p.files.data);
  p.problem = read_problem(scratch.file("p.toml", p.files.toml));
  p.model = build_model(p.problem);
  return p;
}

inline ImportedProblem imported(const std::string& text, const script::TranslationOptions& options = {}) {
  return imported(reading_of(text), 0, options);
}

}  // namespace elamin
