#pragma once
// What the commands share that make, choose and remove particles.
#include "lammps/script/interpreter.hpp"

namespace elamin::script {

constexpr std::size_t most_atoms = 10000000;
constexpr int largest_id = 1000000000;

/// Throws Wrong where there is no box yet.
void needs_box(const Interpreter& in);

/// Throws unless it may be put elsewhere.
void newborn(const World& w, const Atom& a);

/// A range of atoms as `set` and `delete_atoms` have them: the word `style`, and word i. Throws Wrong.
std::vector<int> chosen(Interpreter& in, const std::string& style, std::size_t i);

}  // namespace elamin::script
