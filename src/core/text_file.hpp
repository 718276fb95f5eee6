#pragma once
#include <string>
#include <string_view>

namespace elamin {

/// Writes a whole file. Throws InputError with the system's reason if that fails.
void write_text(const std::string& file, std::string_view text);

}  // namespace elamin
