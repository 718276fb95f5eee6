#pragma once
// A granular law as pair_coeff and fix wall/gran/region have it.
#include "lammps/script/interpreter.hpp"

#include <string>

namespace elamin::script {

struct GranularLaw {
  bool material = false, history = false, rolls = false, limited = false;   // remembers, …; of limit_damping
  double youngs_modulus = 0, poissons_ratio = 0;          // of hertz/material
  double effective_modulus = 0;                           // of hertz: 3/4 k_n
  double gamma = 0, tangential = 0, friction = 0;
  std::string model = "viscoelastic";                     // of damping

  /// Reads the words from i on, up to one that is none of the law; returns where that is.
  std::size_t read(const Interpreter& in, std::size_t i, bool wall);
  /// The same of `Kn Kt gamma_n gamma_t xmu dampflag [limit_damping]`, as gran/hertz/history and walls of hertz/history have them.
  std::size_t read_older(Interpreter& in, std::size_t i);
  /// Tells what is left out of it; it is no law of a motion where its damping is limited, or its friction damps what has no damping along the normal.
  void tell(Interpreter& in) const;
  /// As keys of [[contact]] and [[wall]], a line each.
  std::string damping() const;
};

}  // namespace elamin::script
