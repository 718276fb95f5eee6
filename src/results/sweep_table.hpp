#pragma once
// sweep.csv, written while the runs of a sweep end in any order.
#include "results/table.hpp"

#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace elamin {

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
