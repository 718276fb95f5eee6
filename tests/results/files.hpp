#pragma once
// The files of a directory, and those that elamin says it has written there.
#include <filesystem>
#include <fstream>
#include <set>
#include <string>

inline std::set<std::string> files_in(const std::string& directory) {
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(directory))
    if (entry.is_regular_file()) files.insert(std::filesystem::relative(entry.path(), directory).string());
  return files;
}

/// What .elamin lists, and itself.
inline std::set<std::string> listed_in(const std::string& directory) {
  std::ifstream in(directory + "/.elamin");
  std::set<std::string> files{".elamin"};
  std::string line;
  std::getline(in, line);
  while (std::getline(in, line)) files.insert(line);
  return files;
}
