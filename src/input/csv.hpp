#pragma once
// Tables of commas: cells with their places, and numbers in named columns.
#include "core/error.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace elamin {

struct CsvCell {
  std::string_view text;
  int column;                          // in bytes from 1
};

/// The cells of a line without the blanks around them and what follows '#'; none if the line is blank.
std::vector<CsvCell> csv_cells(std::string_view line);

/// The rows of a file, and what is wrong with them.
class CsvRows {
 public:
  /// kind: the file that is wanted. Throws InputError as read_data does.
  CsvRows(const std::string& file, const std::string& kind);
  /// Calls with the cells of every line that is not blank, until there are 20 mistakes.
  void each(const std::function<void(const std::vector<CsvCell>&)>& row);
  void stop() { text_.clear(); }                   // nothing more is read
  int line() const { return line_; }               // from 1; 0: none has been read
  void mistake(int column, const std::string& key, const std::string& what);
  /// The finite number of a cell; else a mistake.
  std::optional<double> number(const CsvCell& cell, const std::string& key);
  bool sound() const { return mistakes_.empty(); }
  /// Throws InputError if there was a mistake.
  void finish() const;

 private:
  std::string file_, text_;
  int line_ = 0;
  std::vector<Mistake> mistakes_;
};

/// Numbers in columns.
struct NumberTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;           // NaN where a cell is empty
  std::vector<int> lines;                          // of the rows, from 1

  /// The number of a column, −1 if there is none of that name.
  int column(const std::string& name) const;
};

/// Reads a table of commas. Its columns are the `needed` ones in their order, or those that the first line names, the needed ones and
/// any of `others`; cells of others may be empty. Blank lines and what follows '#' are left out. Throws InputError with file, line and
/// column of up to 20 mistakes; holds at least one row.
NumberTable read_numbers(const std::string& file, const std::vector<std::string>& needed, const std::vector<std::string>& others = {});

}  // namespace elamin
