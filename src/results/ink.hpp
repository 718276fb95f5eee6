#pragma once
// Words that a terminal shows in colour.
#include <fmt/color.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <sys/ioctl.h>
#include <unistd.h>

namespace elamin {

/// Whether lines can be overwritten there: a terminal that is not dumb.
inline bool is_terminal(std::FILE* out) {
  const char* kind = std::getenv("TERM");
  return isatty(fileno(out)) && kind && *kind && std::string(kind) != "dumb";
}

/// Characters of a line that does not reach the last column; 79 where there is no terminal.
inline int terminal_width(std::FILE* out) {
  winsize size{};
  return ioctl(fileno(out), TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col - 1 : 79;
}

/// Marks words on a terminal, unless the environment has NO_COLOR with something in it (no-color.org); elsewhere they stay as they are.
class Ink {
 public:
  Ink() = default;
  explicit Ink(std::FILE* out) {
    const char* none = std::getenv("NO_COLOR");
    on_ = is_terminal(out) && !(none && *none);
  }
  std::string good(const std::string& words) const { return marked(fg(fmt::terminal_color::green), words); }
  std::string bad(const std::string& words) const { return marked(fg(fmt::terminal_color::red), words); }
  std::string warning(const std::string& words) const { return marked(fg(fmt::terminal_color::yellow), words); }
  std::string strong(const std::string& words) const { return marked(fmt::emphasis::bold, words); }

 private:
  std::string marked(const fmt::text_style& style, const std::string& words) const { return on_ ? fmt::format(style, "{}", words) : words; }
  bool on_ = false;
};

}  // namespace elamin
