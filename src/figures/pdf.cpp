#include "figures/pdf.hpp"

#include "core/error.hpp"

#include <cerrno>
#include <cstdio>
#include <memory>

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace elamin {

void write_pdf(const std::string& svg, const std::string& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> input(std::tmpfile(), std::fclose);
  if (!input || std::fwrite(svg.data(), 1, svg.size(), input.get()) != svg.size() || std::fflush(input.get()) != 0)
    throw OutputError(file + ": cannot be written: there is no room for a temporary file");
  std::rewind(input.get());
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, fileno(input.get()), STDIN_FILENO);
  std::string words[] = {"rsvg-convert", "--format=pdf", "--output=" + file};
  char* arguments[] = {words[0].data(), words[1].data(), words[2].data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed == ENOENT)
    throw InputError(file + ": a PDF is made by rsvg-convert, which is not installed; it is in the Debian package librsvg2-bin "
                            "(an .svg needs nothing)");
  int status = -1;
  if (failed || waitpid(child, &status, 0) < 0 || status != 0) throw InputError(file + ": cannot be written: rsvg-convert has failed");
}

}  // namespace elamin
