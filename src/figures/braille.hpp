#pragma once
// A diagram in characters, for a terminal.
#include "figures/diagram.hpp"

namespace elamin {

/// Lines of `width` characters at most and height + 3 of them: the curves in dots of braille, 2 × 4 a character (unstable ones
/// with gaps, snaps dotted), events as letters, the ends of both axes, and below what the letters mean.
std::string braille(const Diagram& diagram, int width, int height);

}  // namespace elamin
