#pragma once
#include <string>

namespace elamin {

/// Keeps other processes, and other locks of this one, from a directory while it lives; nothing is left of it when the process dies, however it does.
/// Where the file system knows no locks it keeps nobody.
class DirectoryLock {
 public:
  /// Throws InputError where another run is at work in the directory, and for so many seconds.
  explicit DirectoryLock(const std::string& directory, double patience = 0);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace elamin
