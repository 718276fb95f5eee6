#pragma once
#include <string>
#include <string_view>

namespace elamin {

/// Writes a file whole or not at all: into NAME.new beside it, which then takes its place; over links, devices and where no other file can be made
/// it is written as it is. Throws InputError with the system's reason if that fails.
void write_text(const std::string& file, std::string_view text);

/// The same, and the bytes are on the disk before the file has its name.
void write_to_disk(const std::string& file, std::string_view text);

/// Removes what a process that was killed while it wrote such a file has left beside it.
void remove_unfinished(const std::string& file);

/// Waits until everything that has been written to this file system is on the disk.
void flush_to_disk(const std::string& directory);

}  // namespace elamin
