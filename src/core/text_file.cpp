#include "core/text_file.hpp"

#include "core/error.hpp"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <unistd.h>

namespace elamin {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& file) { throw InputError(file + ": cannot be written: " + std::strerror(errno)); }

std::string unfinished(const std::string& file) { return file + ".new"; }

void write_in_place(const std::string& file, std::string_view text) {
  errno = 0;
  std::ofstream out(file, std::ios::binary);
  out << text << std::flush;
  if (!out) fail(file);
}

void synchronise(const std::string& place, int flags, int (*how)(int)) {
  if (const int descriptor = open(place.c_str(), flags | O_CLOEXEC); descriptor >= 0) how(descriptor), close(descriptor);
}

void write_whole(const std::string& file, std::string_view text, bool to_disk) {
  std::error_code error;
  const fs::file_type type = fs::symlink_status(file, error).type();
  const std::string beside = unfinished(file);
  if ((type != fs::file_type::regular && type != fs::file_type::not_found) || !std::ofstream(beside, std::ios::binary)) return write_in_place(file, text);
  try {
    write_in_place(beside, text);
  } catch (const InputError&) {
    const int reason = errno;
    fs::remove(beside, error);
    errno = reason;
    fail(file);
  }
  if (to_disk) synchronise(beside, O_RDONLY, fsync);
  fs::rename(beside, file, error);
  if (error) throw InputError(file + ": cannot be written: " + error.message());
  const std::string folder = fs::path(file).parent_path().string();
  if (to_disk) synchronise(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY, fsync);
}

}  // namespace

void write_text(const std::string& file, std::string_view text) { write_whole(file, text, false); }

void write_to_disk(const std::string& file, std::string_view text) { write_whole(file, text, true); }

void remove_unfinished(const std::string& file) {
  std::error_code error;
  fs::remove(unfinished(file), error);
}

void flush_to_disk(const std::string& directory) { synchronise(directory, O_RDONLY | O_DIRECTORY, syncfs); }

}  // namespace elamin
