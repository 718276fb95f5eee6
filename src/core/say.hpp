#pragma once
// What is said must not end the work: where it goes may be full or closed. Whether all of standard output was written the program asks at its end.
#include "core/memory.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <utility>

namespace elamin {

/// What an exception says, in words. Where that is a lack of memory what was held back for this is given free.
inline std::string told(const std::exception& error) {
  const auto* system = dynamic_cast<const std::system_error*>(&error);           // of a thread that cannot be made
  const bool no_room = dynamic_cast<const std::bad_alloc*>(&error) || (system && system->code() == std::errc::resource_unavailable_try_again);
  if (!no_room) return error.what() + std::string(memory_was_short() ? "; before it there was not enough memory" : "");
  give_held_memory();
  return "there is not enough memory";
}

/// Prints on standard output, as fmt::print, but for what it does where that is full: nothing.
template <typename... T>
void say(fmt::format_string<T...> format, T&&... values) {
  std::fputs(fmt::format(format, std::forward<T>(values)...).c_str(), stdout);
}

/// The same on standard error.
template <typename... T>
void complain(fmt::format_string<T...> format, T&&... values) {
  std::fputs(fmt::format(format, std::forward<T>(values)...).c_str(), stderr);
}

}  // namespace elamin
