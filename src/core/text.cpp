#include "core/text.hpp"

#include "core/error.hpp"
#include "core/suggest.hpp"

#include <openssl/evp.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>
#include <string_view>

namespace elamin {
namespace {

constexpr std::size_t largest_text = std::size_t{64} << 20;

/// Number of bytes up to the first one that is no text in UTF-8 (RFC 3629), or all of them.
std::size_t length_of_text(const std::string& bytes) {
  const auto at = [&](std::size_t i) { return i < bytes.size() ? static_cast<unsigned char>(bytes[i]) : 0u; };
  std::size_t i = 0;
  while (i < bytes.size()) {
    const unsigned b = at(i);
    if (b == 0 || (b >= 0x80 && b < 0xC2) || b > 0xF4) return i;
    const int more = b < 0x80 ? 0 : b < 0xE0 ? 1 : b < 0xF0 ? 2 : 3;
    for (int k = 1; k <= more; ++k)
      if ((at(i + k) & 0xC0) != 0x80) return i;
    const unsigned next = at(i + 1);
    // Overlong forms, surrogates, and what lies beyond U+10FFFF.
    if ((b == 0xE0 && next < 0xA0) || (b == 0xED && next > 0x9F) || (b == 0xF0 && next < 0x90) || (b == 0xF4 && next > 0x8F))
      return i;
    i += 1 + more;
  }
  return i;
}

constexpr std::string_view mark_of_utf8 = "\xEF\xBB\xBF";

[[noreturn]] void refuse(const std::string& file, const std::string& what, int line = 0, int column = 0) {
  throw InputError({Mistake{file, line, column, {}, what}});
}

}  // namespace

std::string_view without_mark(std::string_view text) { return text.substr(text.starts_with(mark_of_utf8) ? mark_of_utf8.size() : 0); }

bool is_text(const std::string& bytes) { return length_of_text(bytes) == bytes.size(); }

std::string read_text(const std::string& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (file.empty() || !std::filesystem::exists(status)) refuse(file, "there is no such file");
  if (std::filesystem::is_directory(status)) refuse(file, "is a folder, not a file");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse(file, std::string("cannot be opened: ") + std::strerror(errno));

  std::string bytes;
  char block[1 << 16];
  while (in.read(block, sizeof block) || in.gcount() > 0) {
    bytes.append(block, static_cast<std::size_t>(in.gcount()));
    if (std::memchr(block, 0, static_cast<std::size_t>(in.gcount()))) break;   // no text; said below
    if (bytes.size() > largest_text) refuse(file, "is larger than 64 MB; a problem file is a short text");
  }
  if (in.bad()) refuse(file, std::string("cannot be read: ") + std::strerror(errno));

  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) refuse(file, "is a text in UTF-16; save it in UTF-8", 1, 1);
  const std::size_t good = length_of_text(bytes);
  if (good < bytes.size()) {
    const Place at = place_in(bytes, good);
    refuse(file, "is not a text in UTF-8 from here on", at.line, at.column);
  }
  return bytes;
}

std::string read_data(const std::string& file, const std::string& kind, const std::string& hint) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) refuse(file, "no such file; a " + kind + " is needed");
  if (!std::filesystem::is_regular_file(status)) refuse(file, "is not a file of text; a " + kind + " is needed");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse(file, std::string("cannot be opened: ") + std::strerror(errno));
  const auto control = [](unsigned char c) { return c < 32 && (c < '\t' || c > '\r'); };
  std::string text;
  std::string block(1 << 20, '\0');
  try {
    while (in.read(block.data(), static_cast<std::streamsize>(block.size())), in.gcount() > 0) {
      const std::string_view piece(block.data(), static_cast<std::size_t>(in.gcount()));
      if (std::any_of(piece.begin(), piece.end(), control))
        refuse(file, "is a binary file; a " + kind + " is text" + hint);
      text.append(piece);
    }
  } catch (const std::bad_alloc&) {
    refuse(file, "does not fit into the memory");
  }
  if (in.bad()) refuse(file, "cannot be read to its end");
  return text.starts_with(mark_of_utf8) ? text.substr(mark_of_utf8.size()) : text;
}

Place place_in(const std::string& text, std::size_t offset) {
  Place at{1, 1};
  for (std::size_t i = 0; i < offset; ++i) {
    if (text[i] == '\n')
      ++at.line, at.column = 1;
    else if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80)   // bytes 10xxxxxx continue a character
      ++at.column;
  }
  return at;
}

std::string as_markup(const std::string& text) {
  std::string all;
  for (const char c : text)
    switch (c) {
      case '&': all += "&amp;"; break;
      case '<': all += "&lt;"; break;
      case '>': all += "&gt;"; break;
      case '"': all += "&quot;"; break;
      default: all += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
    }
  return all;
}

std::string sha256(const std::string& bytes) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest, &length, EVP_sha256(), nullptr) != 1)
    throw std::bad_alloc();                                              // the only way in which it can fail
  std::string text;
  for (unsigned i = 0; i < length; ++i)
    for (const int digit : {digest[i] >> 4, digest[i] & 15}) text += "0123456789abcdef"[digit];
  return text;
}

std::optional<double> finite_number(std::string_view word, std::string& why) {
  const std::string shown = in_quotes(std::string(word));
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::result_out_of_range) why = shown + " is too large or too small for a floating-point number";
  else if (error != std::errc{} || end != word.data() + word.size()) why = shown + " is not a number";
  else if (!std::isfinite(value)) why = shown + " is not finite";
  else return value;
  return std::nullopt;
}

}  // namespace elamin
