#pragma once
// A LAMMPS data file as lines of words, and the mistakes found in it.
#include "core/error.hpp"

#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace elamin {

constexpr int largest_integer = std::numeric_limits<int>::max();

/// A line that holds something: words up to '#', and what stands behind it.
struct DataLine {
  struct Word { std::string_view text; int column; };   // column in bytes from 1
  int number = 0;                                       // from 1
  std::vector<Word> words;
  std::string_view comment;                             // behind '#', without blanks at its ends
  std::size_t size() const { return words.size(); }
  std::string_view operator[](std::size_t i) const { return words[i].text; }
};

/// The words from `first` on with single blanks between them, as in "Bond Coeffs".
std::string joined(const DataLine& line, std::size_t first = 0);

/// Whether it begins with a letter, so that it is no number.
bool is_word(std::string_view word);

class LammpsLines {
 public:
  /// Reads the whole file. Throws InputError, which names the kind of file that is wanted, if it cannot be opened, is no
  /// regular file, or is not text.
  LammpsLines(std::string file, const std::string& kind, const std::string& hint);
  /// Goes through a text that is told of as `file`.
  LammpsLines(std::string file, std::string text);

  /// The next line that is not blank; the first line of the file is a title and is left out. False at the end.
  bool next(DataLine& line);
  int last_line() const { return number_; }             // of the file, as far as it has been read
  std::string_view title() const { return std::string_view(text_).substr(0, text_.find('\n')); }

  /// A place to come back to.
  struct Bookmark { std::size_t position; int number; };
  Bookmark here() const { return {position_, number_}; }
  void back_to(Bookmark place) { position_ = place.position, number_ = place.number; }

  /// Notes a mistake; word: which word of the line it is about. Throws all of them at the twentieth.
  void mistake(const DataLine& line, std::size_t word, std::string key, std::string what);
  void mistake(int line, int column, std::string key, std::string what);
  /// Throws InputError if there was a mistake.
  void finish() const;

  /// Word i as a finite number, or as an integer within [lo, hi]; else notes a mistake.
  std::optional<double> number(const DataLine& line, std::size_t i, const std::string& key);
  std::optional<int> integer(const DataLine& line, std::size_t i, const std::string& key, int lo, int hi);
  /// The same of a number that must not be negative.
  std::optional<double> amount(const DataLine& line, std::size_t i, const std::string& key);
  /// Whether a row of a section has one of these numbers of words; else notes a mistake, which tells what they mean.
  bool has_size(const DataLine& line, std::initializer_list<std::size_t> sizes, const std::string& section, const std::string& meaning);

 private:
  std::string file_, text_;
  std::size_t position_ = 0;
  int number_ = 0;
  std::vector<Mistake> mistakes_;
};

}  // namespace elamin
