#pragma once
// The bytes of a file, before anything is known of them.
#include "core/error.hpp"

#include <charconv>
#include <optional>
#include <string>
#include <string_view>

namespace elamin {

/// Mistakes of one data file; then reading it ends.
constexpr std::size_t most_mistakes = 20;

/// The contents of a file that is to be a text in UTF-8. Throws InputError if it is not there, is a folder, cannot be
/// read, is larger than 64 MB, or holds bytes that are no text (with the line and column of the first).
std::string read_text(const std::string& file);

/// The contents of a file of numbers, of any size. Throws InputError, which names the `kind` of file that is wanted, if
/// it is not there, is no regular file, cannot be read, or holds control characters, as binary files do (and then the
/// `hint` follows).
std::string read_data(const std::string& file, const std::string& kind, const std::string& hint = "");

/// The text without the byte-order mark that some editors put before it.
std::string_view without_mark(std::string_view text);

/// Whether the bytes are well-formed UTF-8 without the character 0.
bool is_text(const std::string& bytes);

/// Line and column, in characters from 1, of the byte at an offset.
Place place_in(const std::string& text, std::size_t offset);

/// Whether the whole word is a number that the type can hold, which is then in `number`; a sign + is none of it.
template <class Number> bool reads_as(std::string_view word, Number& number) {
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  return error == std::errc{} && end == word.data() + word.size();
}

/// The finite number that a word of a file is, perhaps with a sign +; else `why` says what is wrong with it.
std::optional<double> finite_number(std::string_view word, std::string& why);

/// The text as it stands in HTML and SVG: & < > " by their names, control characters as blanks.
std::string as_markup(const std::string& text);

/// SHA-256, as 64 hexadecimal digits.
std::string sha256(const std::string& bytes);

}  // namespace elamin
