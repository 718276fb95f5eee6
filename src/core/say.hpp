#pragma once
// What is said must not end the work: where it goes may be full or closed. Whether all of standard output was written the program asks at its end.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <utility>

namespace elamin {

/// What an exception says, in words.
inline std::string told(const std::exception& error) { return dynamic_cast<const std::bad_alloc*>(&error) ? "there is not enough memory" : error.what(); }

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
