#pragma once
// Tables of results: kept in memory, and written row by row to a CSV file.
#include "core/text_file.hpp"

#include <cstdint>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace elamin {

/// What an empty cell holds. It is not trivial to copy: of a variant of strings and such alone libstdc++ 12 believes that it always has a value, and destroys
/// one that is not there when the copy of a string throws.
struct Nothing {
  Nothing() = default;
  Nothing(const Nothing&) {}
  Nothing& operator=(const Nothing&) { return *this; }
  friend bool operator==(const Nothing&, const Nothing&) { return true; }
};

/// One entry; empty where nothing is known. A number that is not finite counts as empty wherever it is written.
using Cell = std::variant<Nothing, bool, int, double, std::string>;
using Row = std::vector<Cell>;

struct Table {
  std::vector<std::string> columns;
  std::vector<Row> rows;

  /// Index of a column, or −1.
  int column(const std::string& name) const;
};

inline Cell cell_of(const std::optional<double>& number) { return number ? Cell(*number) : Cell{}; }

/// A cell as a number (true 1, false 0); nothing for text, empty cells and what is not finite.
std::optional<double> as_number(const Cell& cell);

/// How a number is written: with as few digits as read back to the same double, or with all 17.
enum class Digits { shortest, all };

/// A cell as it stands in a CSV file (RFC 4180): a number, true/false, text in quotes where it needs them; empty if empty.
std::string csv_text(const Cell& cell, Digits digits = Digits::shortest);

/// A CSV file that is written row by row, whole or not at all: as long as `keep` was not called, nothing is there. The rows need no memory. Throws OutputError
/// if it cannot be written.
class WholeCsv {
 public:
  WholeCsv(std::string file, const std::vector<std::string>& columns, Digits digits = Digits::shortest);
  void add(const Row& row);
  void keep();

 private:
  WholeFile out_;
  std::string text_;                    // what has not been written yet
  std::size_t columns_;
  Digits digits_;
};

/// Writes a table as such a file.
void write_csv(const std::string& file, const Table& table);

/// A CSV file with a header; every row is on the disk before add returns.
class CsvFile {
 public:
  /// Creates the file and writes the header. Throws OutputError if it cannot be written, as add does.
  CsvFile(std::string file, const std::vector<std::string>& columns);
  /// The same of a file that is there, cut to its first bytes: rows come behind them. Throws InputError if it has fewer.
  CsvFile(std::string file, const std::vector<std::string>& columns, std::uintmax_t bytes);
  void add(const Row& row);
  /// Bytes so far.
  std::uintmax_t size() const { return out_.size(); }

 private:
  GrowingFile out_;
  std::size_t columns_;
};

// sweep.csv, written while the runs of a sweep end in any order.

/// Rows stand in the order of the runs: one that comes early waits in memory for those before it. Safe for several
/// threads.
class SweepTable {
 public:
  /// columns: see sweep_columns. Throws OutputError if the file cannot be written, as add does.
  SweepTable(std::string file, const std::vector<std::string>& columns) : csv_(std::move(file), columns) {}
  /// Writes what still waits, for an interrupted sweep.
  ~SweepTable();

  /// The row of run 0, 1, 2 …; every run once.
  void add(int run, Row row);

 private:
  std::mutex mutex_;
  CsvFile csv_;
  std::map<int, Row> waiting_;
  int next_ = 0;
};

}  // namespace elamin
