#pragma once
// A directory of results, and what in it was written by elamin.
#include "core/directory_lock.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>

namespace elamin {

/// The path of a file, absolute and without links.
std::filesystem::path located(const std::filesystem::path& file);

/// Throws InputError where something lies at this place that is neither an empty directory nor results of elamin. A directory
/// is such results if it holds a .elamin, see below.
void require_results(const std::string& directory);

/// Throws InputError, ending with `why`, where anything but what begin_results or a killed process leaves is in the directory.
void require_empty(const std::string& directory, const std::string& why);

/// Makes an empty directory one of results, of which there are none yet.
void begin_results(const std::string& directory);

/// Adds a file that is written into results afterwards to their list, so that the next run removes it. Where there is no list nothing happens.
void list_also(const std::string& directory, const std::string& name);

/// What a run that is stopped goes on from (see study/checkpoint.hpp).
std::string checkpoint_file(const std::string& directory);

/// The files that runs have written into a directory stand in its .elamin, a line each, before they are made. Nothing else in it
/// is ever removed. The files are kept from git by a .gitignore of the directory's own.
class ResultsDirectory {
 public:
  using Files = std::set<std::filesystem::path>;

  /// Creates the directory, or removes from it what .elamin lists, but for the files `kept` (see located) and folders that are not empty
  /// then. Throws OutputError if something cannot be written, and what require_results throws unless `force` is given.
  ResultsDirectory(std::string directory, bool force, const Files& kept = {});
  /// The directory of a run that was stopped, as it was when its list had so many bytes: files that came later are removed; none: as it is.
  ResultsDirectory(std::string directory, const Files& kept, std::optional<std::uintmax_t> listed = {});

  /// The path of a file that is going to be written, and its folder made: "states/final.data" → DIR/states/final.data. Throws OutputError where one of them is a
  /// symbolic link: nothing is written through it.
  std::string file(const std::string& name);

  /// Removes what has been written under names that begin so, but for the files kept.
  void remove(const std::string& beginning);

  /// The name, or with "-again" behind it, so that NAME.data is neither a file kept nor one that was not written by elamin.
  std::string free_name(std::string name) const;

  const std::string& path() const { return directory_; }
  /// Bytes of the list.
  std::uintmax_t listed() const;

 private:
  void list(const std::string& name);

  std::string directory_;
  Files kept_;
  std::optional<DirectoryLock> lock_;
  std::set<std::string> listed_;
};

}  // namespace elamin
