#include "core/text_file.hpp"

#include "core/error.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include <fcntl.h>
#include <unistd.h>

namespace elamin {
namespace {

namespace fs = std::filesystem;

constexpr mode_t everybody = 0666;                              // but for whom the user's mask leaves out

std::string unfinished(const std::string& file) { return file + ".new"; }

bool write_all(int descriptor, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(descriptor, text.data(), text.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

void synchronise(const std::string& place, int flags, int (*how)(int)) {
  if (const int descriptor = open(place.c_str(), flags | O_CLOEXEC); descriptor >= 0) how(descriptor), close(descriptor);
}

}  // namespace

void cannot_write(const std::string& file) { throw OutputError(file + ": cannot be written: " + std::strerror(errno)); }

void must_be_own(const std::string& file, const std::string& command, bool force) {
  if (force || !fs::exists(file)) return;
  std::ifstream in(file);
  std::string line;
  for (int k = 0; k < 2 && std::getline(in, line); ++k)
    if (line.find("by elamin " + command) != std::string::npos) return;
  throw InputError(file + ": is there already and was not written by elamin " + command + "; choose another name with -o, or --force");
}

void write_text(const std::string& file, std::string_view text) {
  WholeFile whole(file);
  whole.add(text), whole.keep();
}

void write_to_disk(const std::string& file, std::string_view text) {
  WholeFile whole(file);
  whole.add(text), whole.keep(true);
}

bool write_over(const std::string& file, std::string_view text) {
  const int descriptor = open(file.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool whole = write_all(descriptor, text) && ftruncate(descriptor, static_cast<off_t>(text.size())) == 0;
  close(descriptor);
  return whole;
}

GrowingFile::GrowingFile(std::string file, std::uintmax_t bytes) : file_(std::move(file)) {
  std::error_code error;
  const std::uintmax_t there = bytes == 0 ? 0 : fs::file_size(file_, error);
  if (error || (bytes != all && there < bytes)) throw InputError(file_ + ": is not as the run has left it");
  size_ = std::min(bytes, there);
  descriptor_ = open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | (bytes == 0 ? O_TRUNC : 0), everybody);
  if (descriptor_ < 0 || (size_ < there && ftruncate(descriptor_, static_cast<off_t>(size_)) != 0)) cannot_write(file_);
}

GrowingFile::~GrowingFile() {
  if (descriptor_ >= 0) close(descriptor_);
}

GrowingFile::GrowingFile(GrowingFile&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)), size_(other.size_) {}

GrowingFile& GrowingFile::operator=(GrowingFile&& other) noexcept {
  std::swap(file_, other.file_), std::swap(descriptor_, other.descriptor_), std::swap(size_, other.size_);
  return *this;
}

void GrowingFile::replace(std::uintmax_t bytes, std::string_view text) {
  if (lseek(descriptor_, static_cast<off_t>(bytes), SEEK_SET) < 0 && errno != ESPIPE) cannot_write(file_);      // a pipe is only added to
  const std::uintmax_t before = std::exchange(size_, bytes + text.size());
  if (write_all(descriptor_, text) && (size_ >= before || ftruncate(descriptor_, static_cast<off_t>(size_)) == 0)) return;
  const int reason = errno;
  if (ftruncate(descriptor_, static_cast<off_t>(bytes)) == 0) size_ = bytes;
  errno = reason;
  cannot_write(file_);
}

WholeFile::WholeFile(std::string file) : file_(std::move(file)) {
  std::error_code error;
  const fs::file_type type = fs::symlink_status(file_, error).type();
  if (type == fs::file_type::regular || type == fs::file_type::not_found)
    descriptor_ = open(unfinished(file_).c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, everybody);
  if (descriptor_ < 0) as_it_is_.emplace(file_);
}

WholeFile::~WholeFile() {
  if (descriptor_ < 0) return;
  close(descriptor_);
  remove_unfinished(file_);
}

void WholeFile::add(std::string_view text) {
  if (as_it_is_) as_it_is_->add(text);
  else if (!write_all(descriptor_, text)) cannot_write(file_);
}

void WholeFile::keep(bool to_disk) {
  if (as_it_is_) return;
  if (to_disk) fsync(descriptor_);
  const bool closed = close(std::exchange(descriptor_, -1)) == 0;
  if (!closed || std::rename(unfinished(file_).c_str(), file_.c_str()) != 0) {
    const int reason = errno;
    remove_unfinished(file_);
    errno = reason;
    cannot_write(file_);
  }
  const std::string folder = fs::path(file_).parent_path().string();
  if (to_disk) synchronise(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY, fsync);
}

void remove_unfinished(const std::string& file) {
  std::error_code error;
  fs::remove(unfinished(file), error);
}

void flush_to_disk(const std::string& directory) { synchronise(directory, O_RDONLY | O_DIRECTORY, syncfs); }

}  // namespace elamin
