#pragma once
// The tables of a run, by the names of their columns.
#include "study/program.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

/// A row of path.csv or events.csv.
struct TableRow {
  std::map<std::string, std::string> cells;
  const std::string& text(const std::string& column) const { return cells.at(column); }
  double operator[](const std::string& column) const { return std::stod(cells.at(column)); }
};

inline std::vector<TableRow> table_of(const std::string& file) {
  const auto rows = csv_rows(file);
  std::vector<TableRow> all;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    all.emplace_back();
    for (std::size_t c = 0; c < rows[0].size(); ++c) all.back().cells[rows[0][c]] = c < rows[i].size() ? rows[i][c] : "";
  }
  return all;
}

/// The row of an event; throws if there is none.
inline TableRow row_of(const std::vector<TableRow>& table, const std::string& label) {
  for (const TableRow& row : table)
    if (row.text("label") == label) return row;
  throw std::out_of_range("no row " + label);
}
