#include "catch.hpp"

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>

namespace {

// The stages in the order of the flow; a file includes from its own stage and from lower ones.
const std::vector<std::string> stages{"core", "laws", "model", "energy", "solve", "proof", "dynamics", "path", "lammps", "input", "results", "figures", "study", "report", "python", "petsc"};

std::size_t stage(const std::string& folder) {
  return static_cast<std::size_t>(std::find(stages.begin(), stages.end(), folder) - stages.begin());
}

struct Include { std::string from, to; };

std::vector<Include> includes() {
  std::vector<Include> all;
  const std::filesystem::path src = std::string(ELAMIN_ROOT) + "/src";
  const std::regex pattern("^#include \"([^\"]+)\"");
  for (const auto& entry : std::filesystem::recursive_directory_iterator(src)) {
    if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
    std::ifstream in(entry.path());
    std::smatch match;
    for (std::string line; std::getline(in, line);)
      if (std::regex_search(line, match, pattern)) all.push_back({std::filesystem::relative(entry.path(), src).string(), match[1]});
  }
  return all;
}

std::string folder(const std::string& file) { return file.substr(0, file.find('/')); }

}  // namespace

TEST_CASE("no include runs upward", "[structure]") {
  const std::vector<Include> all = includes();
  REQUIRE(all.size() > 100);
  for (const Include& i : all) {
    INFO(i.from << " includes " << i.to);
    if (folder(i.from) == i.from) continue;          // main, command_line, elamin.hpp
    CHECK(stage(folder(i.from)) < stages.size());
    CHECK(stage(folder(i.to)) <= stage(folder(i.from)));
  }
}

TEST_CASE("no files include each other in a circle", "[structure]") {
  std::map<std::string, std::set<std::string>> reach;
  for (const Include& i : includes())
    if (i.from.ends_with(".hpp")) reach[i.from].insert(i.to);
  for (bool grown = true; grown;) {
    grown = false;
    for (auto& [file, seen] : reach)
      for (const std::string& other : std::set<std::string>(seen))
        for (const std::string& further : reach[other]) grown = seen.insert(further).second || grown;
  }
  for (const auto& [file, seen] : reach) CHECK(seen.count(file) == 0);
}
