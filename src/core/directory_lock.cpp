#include "core/directory_lock.hpp"

#include "core/error.hpp"
#include "core/interrupt.hpp"
#include "core/timing.hpp"

#include <cerrno>
#include <thread>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace elamin {

DirectoryLock::DirectoryLock(const std::string& directory, double patience) : descriptor_(open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  constexpr auto pause = std::chrono::milliseconds(20);
  for (const Stopwatch watch;; std::this_thread::sleep_for(pause)) {
    if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    if (watch.seconds() >= patience || interrupted()) break;
  }
  close(descriptor_);
  throw InputError(directory + ": another run is at work in this directory; wait for its end, stop it, or choose another directory by -o");
}

DirectoryLock::~DirectoryLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace elamin
