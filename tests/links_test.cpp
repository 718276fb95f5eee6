#include "catch.hpp"
#include "scratch_directory.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>

namespace {

namespace fs = std::filesystem;

const fs::path root = ELAMIN_ROOT;

/// Files of the repository, relative to its top: those that git knows; where it is no clone, those that are there.
std::set<std::string> tracked() {
  std::set<std::string> files;
  if (std::FILE* pipe = popen(("git -C '" + root.string() + "' ls-files -z 2>/dev/null").c_str(), "r")) {
    std::string name;
    for (int c; (c = std::fgetc(pipe)) != EOF;)
      if (c != 0) name += static_cast<char>(c);
      else files.insert(std::exchange(name, {}));
    pclose(pipe);
  }
  if (!files.empty()) return files;
  for (const auto& entry : fs::recursive_directory_iterator(root))
    if (entry.is_regular_file()) files.insert(fs::relative(entry.path(), root).string());
  return files;
}

bool is_there(const std::set<std::string>& files, const std::string& path) {
  const auto below = files.lower_bound(path + "/");
  return files.count(path) || (below != files.end() && below->starts_with(path + "/"));
}

/// What a Markdown text links to, code left out: [text](target), ![text](target), src="target", href="target".
std::vector<std::string> links(const std::string& text) {
  static const std::regex code("```[^]*?```|`[^`\n]*`"), link(R"re(\]\(\s*<?([^)\s>]+)|(?:src|href)="([^"]+)")re");
  const std::string prose = std::regex_replace(text, code, "");
  std::vector<std::string> all;
  for (std::sregex_iterator m(prose.begin(), prose.end(), link), end; m != end; ++m) all.push_back((*m)[1].matched ? (*m)[1] : (*m)[2]);
  return all;
}

/// The names by which GitHub links to the headings of a text: lower case, hyphens for spaces, no punctuation.
std::set<std::string> anchors(const std::string& text) {
  std::set<std::string> all;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with('#')) continue;
    std::string name;
    for (const char c : line.substr(std::min(line.size(), line.find_first_not_of("# "))))
      if (c == ' ' || c == '-') name += '-';
      else if (std::isalnum(static_cast<unsigned char>(c)) || c == '_' || (c & 0x80)) name += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    all.insert(name);
  }
  return all;
}

}  // namespace

TEST_CASE("every relative link of a document leads to a file of the repository", "[structure]") {
  const std::set<std::string> files = tracked();
  std::size_t followed = 0;
  for (const std::string& file : files) {
    if (!file.ends_with(".md") || !fs::exists(root / file)) continue;
    for (const std::string& target : links(text_of((root / file).string()))) {
      if (target.find(':') != std::string::npos) continue;                     // https:, mailto:
      INFO(file << " links to " << target);
      const std::size_t hash = target.find('#');
      const std::string path = hash == 0 ? file : (fs::path(file).parent_path() / target.substr(0, hash)).lexically_normal().string();
      CHECK(is_there(files, path.ends_with('/') ? path.substr(0, path.size() - 1) : path));
      if (hash != std::string::npos) CHECK(anchors(text_of((root / path).string())).count(target.substr(hash + 1)) == 1);
      ++followed;
    }
  }
  CHECK(followed > 20);
}
