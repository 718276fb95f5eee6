#pragma once
// Short problem files, and what becomes of them.
#include "core/error.hpp"
#include "input/build.hpp"
#include "input/read.hpp"
#include "scratch_directory.hpp"

namespace elamin {

/// The folder of problem files that are right.
inline const std::string good = ELAMIN_ROOT "/tests/input/good/";

inline Model model_of(const std::string& text) {
  const ScratchDirectory scratch;
  return build_model(read_problem(scratch.file("p.toml", text)));
}

inline const Structure& structure(const Model& m, const std::string& name) {
  for (const Structure& s : m.structures)
    if (s.name == name) return s;
  throw std::runtime_error("no structure " + name);
}

/// What `attempt` throws as InputError, a sentence a line without the names of files; "" if it does not.
template <class Attempt> std::string sentences_of(const Attempt& attempt) {
  try {
    attempt();
  } catch (const InputError& e) {
    std::string all;
    for (const Mistake& m : e.mistakes()) all += (all.empty() ? "" : "\n") + m.sentence().substr(m.file.size() + 1);
    return all;
  }
  return "";
}

inline std::string said_of(const std::string& text) {
  return sentences_of([&] { model_of(text); });
}

/// Grains of diameter 1 at these positions.
inline std::string grains(const std::string& name, const std::string& positions, const std::string& more = "") {
  return "[[grains]]\nname = \"" + name + "\"\npositions = " + positions + "\ndiameter = 1\n" + more;
}

inline const std::string energy_study = "[study]\ntype = \"energy\"\n";

}  // namespace elamin
