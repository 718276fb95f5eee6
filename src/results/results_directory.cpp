#include "results/results_directory.hpp"

#include "core/error.hpp"
#include "core/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <vector>

namespace elamin {
namespace {

namespace fs = std::filesystem;

constexpr const char *list_name = ".elamin", *checkpoint_name = ".elamin.checkpoint";
constexpr const char* first_line = "# elamin has written these files. The next run into this directory removes them, and nothing else.";

std::string place(const std::string& directory, const std::string& name) { return (fs::path(directory) / name).string(); }

/// What the directory's list has in its first bytes; nothing where there is no list. Names that lead out of the directory count for nothing.
std::optional<std::vector<std::string>> listed_in(const std::string& directory, std::size_t bytes = std::string::npos) {
  std::error_code error;
  if (!fs::is_regular_file(place(directory, list_name), error)) return std::nullopt;
  std::ifstream file(place(directory, list_name), std::ios::binary);
  std::istringstream in(std::string(std::istreambuf_iterator<char>(file), {}).substr(0, bytes));
  std::string line;
  if (!std::getline(in, line) || line != first_line) return std::nullopt;
  std::vector<std::string> names;
  while (std::getline(in, line)) {
    const fs::path name = fs::path(line).lexically_normal();
    if (!line.empty() && name.is_relative() && *name.begin() != "..") names.push_back(line);
  }
  return names;
}

void create(const std::string& directory) {
  std::error_code error;
  fs::create_directories(directory, error);
  if (error) throw OutputError(fmt::format("{}: cannot be created: {}", directory, error.message()));
}

// The first names in a directory but for those given; "": there are none.
std::string holds(const std::string& directory, const std::vector<std::string>& but) {
  constexpr std::ptrdiff_t most_shown = 3;
  std::error_code error;
  std::vector<std::string> found;
  for (const auto& entry : fs::directory_iterator(directory, error))
    if (const std::string name = entry.path().filename().string(); !std::count(but.begin(), but.end(), name)) found.push_back(name);
  std::sort(found.begin(), found.end());
  const auto shown = std::min<std::ptrdiff_t>(most_shown, std::ssize(found));
  return fmt::format("{}{}", fmt::join(found.begin(), found.begin() + shown, ", "), std::ssize(found) > shown ? ", …" : "");
}

// Throws where a file would be written through a symbolic link; what a run that was killed had not finished of it goes.
void refuse_links(const std::string& directory, const std::string& name) {
  std::error_code error;
  fs::path part = directory;
  for (const fs::path& each : fs::path(name))
    if (part /= each; fs::is_symlink(part, error)) throw OutputError(part.string() + ": is a symbolic link, through which nothing is written; remove it, or choose another directory by -o");
  remove_unfinished(part.string());
}

const std::string unfinished_list = list_name + std::string(".new");      // of a run that was killed at once

}  // namespace

fs::path located(const fs::path& file) {
  std::error_code error;
  return fs::weakly_canonical(file, error);
}

std::string checkpoint_file(const std::string& directory) { return place(directory, checkpoint_name); }

void require_empty(const std::string& directory, const std::string& why) {
  const std::string found = holds(directory, {list_name, unfinished_list, checkpoint_name + std::string(".new"), ".gitignore"});
  if (!found.empty()) throw InputError(fmt::format("{}: is not empty: it holds {}; {}", directory, found, why));
}

void begin_results(const std::string& directory) {
  write_text(place(directory, list_name), std::string(first_line) + "\n.gitignore\n");
  write_text(place(directory, ".gitignore"), "*\n");
}

void require_results(const std::string& directory) {
  std::error_code error;
  if (!fs::is_directory(directory, error) || listed_in(directory)) return;
  const std::string found = holds(directory, {unfinished_list});
  if (found.empty()) return;
  throw InputError(fmt::format("{}: is not empty and not the results of a run: it holds {}; choose another directory by -o, "
                               "or --force to write there all the same, over files of the same names", directory, found));
}

void list_also(const std::string& directory, const std::string& name) {
  const auto listed = listed_in(directory);
  if (!listed || std::count(listed->begin(), listed->end(), name)) return;
  GrowingFile(place(directory, list_name), GrowingFile::all).add(name + "\n");
}

ResultsDirectory::ResultsDirectory(std::string directory, bool force, const Files& kept) : directory_(std::move(directory)), kept_(kept) {
  if (!force) require_results(directory_);
  create(directory_);
  lock_.emplace(directory_);
  for (const char* own : {list_name, checkpoint_name}) refuse_links(directory_, own);
  std::error_code error;
  fs::remove(checkpoint_file(directory_), error);
  Files folders;
  for (const std::string& name : listed_in(directory_).value_or(std::vector<std::string>{})) {
    const fs::path file = place(directory_, name);
    if (fs::is_directory(fs::symlink_status(file, error))) continue;
    remove_unfinished(file);
    if (kept.count(located(file)) && fs::exists(file, error)) listed_.insert(name);
    else fs::remove(file, error), folders.insert(file.parent_path());
  }
  for (const fs::path& folder : folders)
    if (fs::is_directory(fs::symlink_status(folder, error))) fs::remove(folder, error);      // where nothing else is in it
  std::string text = std::string(first_line) + "\n";
  for (const std::string& name : listed_) text += name + "\n";
  write_text(place(directory_, list_name), text);
  if (fs::exists(place(directory_, ".gitignore"), error)) return;
  write_text(file(".gitignore"), "*\n");
}

ResultsDirectory::ResultsDirectory(std::string directory, const Files& kept, std::optional<std::uintmax_t> bytes) : directory_(std::move(directory)), kept_(kept) {
  lock_.emplace(directory_);
  for (const char* own : {list_name, checkpoint_name}) refuse_links(directory_, own);
  const std::string list = place(directory_, list_name);
  std::error_code error;
  const std::uintmax_t listed = bytes.value_or(fs::file_size(list, error));
  if (listed < std::strlen(first_line) || fs::file_size(list, error) < listed || error) throw InputError(list + ": is not as the run has left it");
  for (const std::string& name : listed_in(directory_, listed).value_or(std::vector<std::string>{})) listed_.insert(name);
  for (const std::string& name : listed_in(directory_).value_or(std::vector<std::string>{})) {
    const fs::path file = place(directory_, name);
    remove_unfinished(file);
    if (!listed_.count(name) && !kept_.count(located(file)) && !fs::is_directory(fs::symlink_status(file, error))) fs::remove(file, error);
  }
  fs::resize_file(list, listed, error);                         // last: what is not on it any more is no longer there
}

std::uintmax_t ResultsDirectory::listed() const { return fs::file_size(place(directory_, list_name)); }

void ResultsDirectory::list(const std::string& name) {
  if (!listed_.insert(name).second) return;
  GrowingFile(place(directory_, list_name), GrowingFile::all).add(name + "\n");
}

std::string ResultsDirectory::file(const std::string& name) {
  refuse_links(directory_, name);
  list(name);
  const fs::path path = fs::path(directory_) / name;
  create(path.parent_path().string());
  return path.string();
}

void ResultsDirectory::remove(const std::string& beginning) {
  std::error_code error;
  for (auto it = listed_.lower_bound(beginning); it != listed_.end() && it->starts_with(beginning); ++it)
    if (const fs::path file = place(directory_, *it); !kept_.count(located(file))) fs::remove(file, error);
}

std::string ResultsDirectory::free_name(std::string name) const {
  std::error_code error;
  const auto taken = [&](const std::string& data) {
    const fs::path file = place(directory_, data);
    return kept_.count(located(file)) || (!listed_.count(data) && fs::exists(file, error));
  };
  while (taken(name + ".data")) name += "-again";
  return name;
}

}  // namespace elamin
