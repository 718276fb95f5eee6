#include "results/table.hpp"

#include "core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace elamin {

namespace {

std::string csv_quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string all = "\"";
  for (const char c : text) all += c == '"' ? std::string("\"\"") : std::string(1, c);
  return all + "\"";
}

constexpr std::size_t piece = 1 << 20;                          // bytes that are written at once

std::string csv_line(const Row& row, std::size_t columns, Digits digits = Digits::shortest) {
  if (row.size() != columns) throw std::logic_error(fmt::format("a row of {} entries for {} columns", row.size(), columns));
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) (line += i > 0 ? "," : "") += csv_text(row[i], digits);
  return line += '\n';
}

}  // namespace

int Table::column(const std::string& name) const {
  const auto it = std::find(columns.begin(), columns.end(), name);
  return it == columns.end() ? -1 : static_cast<int>(it - columns.begin());
}

std::optional<double> as_number(const Cell& cell) {
  if (const bool* b = std::get_if<bool>(&cell)) return *b ? 1.0 : 0.0;
  if (const int* i = std::get_if<int>(&cell)) return *i;
  if (const double* d = std::get_if<double>(&cell); d && std::isfinite(*d)) return *d;
  return std::nullopt;
}

std::string csv_text(const Cell& cell, Digits digits) {
  if (const bool* b = std::get_if<bool>(&cell)) return *b ? "true" : "false";
  if (const int* i = std::get_if<int>(&cell)) return std::to_string(*i);
  if (const double* d = std::get_if<double>(&cell)) {
    if (!std::isfinite(*d)) return "";
    return digits == Digits::all ? fmt::format("{:.17g}", *d) : fmt::format("{}", *d);
  }
  if (const std::string* s = std::get_if<std::string>(&cell)) return csv_quoted(*s);
  return "";
}

void write_csv(const std::string& file, const Table& table) {
  WholeCsv csv(file, table.columns);
  for (const Row& row : table.rows) csv.add(row);
  csv.keep();
}

WholeCsv::WholeCsv(std::string file, const std::vector<std::string>& columns, Digits digits)
    : out_(std::move(file)), columns_(columns.size()), digits_(digits) {
  add(Row(columns.begin(), columns.end()));
}

void WholeCsv::add(const Row& row) {
  text_ += csv_line(row, columns_, digits_);
  if (text_.size() < piece) return;
  out_.add(text_);
  text_.clear();
}

void WholeCsv::keep() {
  out_.add(text_);
  out_.keep();
}

CsvFile::CsvFile(std::string file, const std::vector<std::string>& columns) : out_(std::move(file)), columns_(columns.size()) {
  add(Row(columns.begin(), columns.end()));
}

CsvFile::CsvFile(std::string file, const std::vector<std::string>& columns, std::uintmax_t bytes)
    : out_(std::move(file), bytes), columns_(columns.size()) {}

void CsvFile::add(const Row& row) {
  out_.add(csv_line(row, columns_));
}

SweepTable::~SweepTable() {
  try {
    for (const auto& [run, row] : waiting_) csv_.add(row);
  } catch (const OutputError&) {
    // a destructor has nobody to tell; the rows before were written
  }
}

void SweepTable::add(int run, Row row) {
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_[run] = std::move(row);
  for (auto it = waiting_.find(next_); it != waiting_.end(); it = waiting_.find(++next_)) {
    csv_.add(it->second);
    waiting_.erase(it);
  }
}

}  // namespace elamin
