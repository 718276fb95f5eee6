#pragma once
// What an import says of itself.
#include "lammps/script/interpreter.hpp"

#include <string>

namespace elamin::script {

/// A line for each name of a command: taken, ignored and why, not understood; then the notes, each with its place.
std::string report(const Reading& reading, const std::vector<Note>& notes);

/// What was ignored and why, a sentence a reason, and the notes, each once with the first of its places.
std::vector<std::string> notes_of(const Reading& reading, const std::vector<Note>& notes);

}  // namespace elamin::script
