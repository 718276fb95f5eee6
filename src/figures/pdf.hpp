#pragma once
#include <string>

namespace elamin {

/// Writes a figure as a PDF, lines as lines and words as text, by the program rsvg-convert. Throws InputError, which names its
/// package, if that is not there, or if the file cannot be written.
void write_pdf(const std::string& svg, const std::string& file);

}  // namespace elamin
