#pragma once
// The text of a LAMMPS input script as lines of words, as LAMMPS's own parser takes them.
#include "core/error.hpp"

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace elamin::script {

/// What is wrong with a line: which of its words (from 0), and a sentence. `unknown`: a command, style or keyword that elamin does not
/// have, which --skip leaves out; all else stays a mistake.
struct Wrong : std::runtime_error {
  Wrong(std::size_t word_number, const std::string& what, bool is_unknown = false)
      : std::runtime_error(what), word(word_number), unknown(is_unknown) {}
  std::size_t word;
  bool unknown;
};

/// A line as LAMMPS sees it: pieces that end with & are joined, and such with an open """.
struct Line {
  std::string text;
  struct Piece { std::size_t offset; int line; };
  std::vector<Piece> pieces;                    // where in the text each line of the file begins
  /// Line and column of a byte of the text.
  Place place(std::size_t offset) const;
};

/// The lines of a script; empty ones are left out.
std::vector<Line> lines_of(const std::string& text);

struct Word {
  std::string text;
  std::size_t offset = 0;                       // of its first byte in the text of the line, before substitution
  bool quoted = false;
};

/// What $x and ${x} (`variable`) and $(formula) (`formula`, with its format) stand for; both throw Wrong if for nothing.
struct Substitution {
  std::function<std::string(const std::string&)> variable, formula;
};

/// A number without its sign +.
inline std::string_view unsigned_word(std::string_view word) { return word.substr(word.starts_with('+') ? 1 : 0); }

/// The text without its comment: from a # on that is in no quotes.
std::string_view without_comment(std::string_view text);

/// $x, ${x} and $(formula) outside of quotes replaced by what they stand for. `offsets`, if given: of each byte of the result
/// the one it came from.
std::string substituted(std::string_view text, const Substitution& by, std::vector<std::size_t>* offsets = nullptr);

/// The words of a text: what stands between blanks, or in '', "" or """""". Throws Wrong where quotes are not closed, or where no blank
/// follows.
std::vector<Word> split(std::string_view text);

/// The words of a line of a script: its comment left out, its variables put in, split.
std::vector<Word> words_of(const Line& line, const Substitution& by);

}  // namespace elamin::script
