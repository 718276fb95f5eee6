#include "core/text_file.hpp"

#include "core/error.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>

namespace elamin {

void write_text(const std::string& file, std::string_view text) {
  errno = 0;
  std::ofstream out(file, std::ios::binary);
  out << text << std::flush;
  if (!out) throw InputError(file + ": cannot be written: " + std::strerror(errno));
}

}  // namespace elamin
