#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace elamin {

/// Throws OutputError with the reason that errno has.
[[noreturn]] void cannot_write(const std::string& file);

/// Throws InputError where `file` is there and `elamin COMMAND` has not written it, as one of its first two lines says; not with `force`.
void must_be_own(const std::string& file, const std::string& command, bool force);

/// Writes a file whole or not at all, see WholeFile. Throws OutputError if that fails.
void write_text(const std::string& file, std::string_view text);

/// The same, and the bytes are on the disk before the file has its name.
void write_to_disk(const std::string& file, std::string_view text);

/// Writes where no new file may find room: into the bytes that the file has, and what is too much behind them. False if not all of it could be written.
bool write_over(const std::string& file, std::string_view text);

/// A file that grows; what was added is there when the call returns, whole or, where OutputError is thrown, not at all.
class GrowingFile {
 public:
  static constexpr std::uintmax_t all = UINTMAX_MAX;
  /// Keeps the first bytes of the file, `all` of them or none. Throws InputError if it has fewer, OutputError if it cannot be written.
  explicit GrowingFile(std::string file, std::uintmax_t bytes = 0);
  ~GrowingFile();
  GrowingFile(GrowingFile&& other) noexcept;
  GrowingFile& operator=(GrowingFile&& other) noexcept;

  void add(std::string_view text) { replace(size_, text); }
  /// Puts the text in the place of all behind these bytes; where that fails, nothing is left behind them.
  void replace(std::uintmax_t bytes, std::string_view text);
  std::uintmax_t size() const { return size_; }

 private:
  std::string file_;
  int descriptor_ = -1;
  std::uintmax_t size_ = 0;
};

/// A file that is written piece by piece, whole or not at all: into NAME.new beside it, which takes its place by `keep`, and which goes where that was not
/// called; over links, devices and where no other file can be made it is written as it is. Throws OutputError if it cannot be written.
class WholeFile {
 public:
  explicit WholeFile(std::string file);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void add(std::string_view text);
  /// to_disk: the bytes are on the disk before the file has its name.
  void keep(bool to_disk = false);

 private:
  std::string file_;
  int descriptor_ = -1;                 // of the file beside it
  std::optional<GrowingFile> as_it_is_;
};

/// Removes what a process that was killed while it wrote such a file has left beside it.
void remove_unfinished(const std::string& file);

/// Waits until everything that has been written to this file system is on the disk.
void flush_to_disk(const std::string& directory);

}  // namespace elamin
