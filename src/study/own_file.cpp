#include "study/own_file.hpp"

#include "core/error.hpp"

#include <filesystem>
#include <fstream>

namespace elamin {

void must_be_own(const std::string& file, const std::string& command, bool force) {
  if (force || !std::filesystem::exists(file)) return;
  std::ifstream in(file);
  std::string line;
  for (int k = 0; k < 2 && std::getline(in, line); ++k)
    if (line.find("by elamin " + command) != std::string::npos) return;
  throw InputError(file + ": is there already and was not written by elamin " + command + "; choose another name with -o, or --force");
}

}  // namespace elamin
