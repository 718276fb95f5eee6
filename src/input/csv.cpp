#include "input/csv.hpp"

#include "core/find.hpp"
#include "core/suggest.hpp"
#include "core/text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

namespace elamin {
namespace {

class NumberReader {
 public:
  NumberReader(const std::string& file, const std::vector<std::string>& needed, const std::vector<std::string>& others)
      : needed_(needed), others_(others), rows_(file, fmt::format("table {}", fmt::join(needed.empty() ? others : needed, ","))) {}

  NumberTable read() {
    rows_.each([&](const auto& cells) { row(cells); });
    if (table_.rows.empty() && rows_.sound()) rows_.mistake(1, "", fmt::format("holds no row of numbers; the columns are {}", listed(all())));
    rows_.finish();
    return std::move(table_);
  }

 private:
  std::vector<std::string> all() const {
    std::vector<std::string> names = needed_;
    names.insert(names.end(), others_.begin(), others_.end());
    return names;
  }

  void row(const std::vector<CsvCell>& cells) {
    if (table_.columns.empty()) {
      std::string why;
      const bool numbers = std::all_of(cells.begin(), cells.end(), [&](const CsvCell& c) { return finite_number(c.text, why).has_value(); });
      if (!numbers || needed_.empty()) return names(cells);
      table_.columns = needed_;
    }
    if (cells.size() != table_.columns.size())
      return rows_.mistake(1, "", fmt::format("{} columns, expected {}: {}", cells.size(), table_.columns.size(), fmt::join(table_.columns, ",")));
    std::vector<double> values;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const bool empty = cells[c].text.empty() && contains(others_, table_.columns[c]);
      values.push_back(empty ? std::numeric_limits<double>::quiet_NaN() : rows_.number(cells[c], table_.columns[c]).value_or(0));
    }
    table_.rows.push_back(std::move(values)), table_.lines.push_back(rows_.line());
  }

  void names(const std::vector<CsvCell>& cells) {
    const std::vector<std::string> known = all();
    for (const CsvCell& cell : cells) {
      const std::string name(cell.text);
      if (!contains(known, name))
        rows_.mistake(cell.column, "", in_quotes(name) + " is no column of this table; there are: " + listed(known) + did_you_mean(name, known));
      else if (table_.column(name) >= 0)
        rows_.mistake(cell.column, "", in_quotes(name) + " is there twice; once is enough");
      table_.columns.push_back(name);
    }
    for (const std::string& name : needed_)
      if (table_.column(name) < 0 && rows_.sound()) rows_.mistake(1, "", fmt::format("the column {} is missing", in_quotes(name)));
    if (!rows_.sound()) rows_.stop();                   // the columns are not known
  }

  const std::vector<std::string>&needed_, &others_;
  CsvRows rows_;
  NumberTable table_;
};

}  // namespace

CsvRows::CsvRows(const std::string& file, const std::string& kind) : file_(file), text_(read_data(file, kind)) {}

void CsvRows::each(const std::function<void(const std::vector<CsvCell>&)>& row) {
  for (std::size_t at = 0; at < text_.size() && mistakes_.size() < most_mistakes;) {
    const std::size_t end = std::min(text_.find('\n', at), text_.size());
    ++line_;
    if (const auto cells = csv_cells(std::string_view(text_).substr(at, end - at)); !cells.empty()) row(cells);
    at = end + 1;
  }
}

void CsvRows::mistake(int column, const std::string& key, const std::string& what) { mistakes_.push_back({file_, std::max(line_, 1), column, key, what}); }

std::optional<double> CsvRows::number(const CsvCell& cell, const std::string& key) {
  std::string why;
  const std::optional<double> value = finite_number(cell.text, why);
  if (!value) mistake(cell.column, key, why);
  return value;
}

void CsvRows::finish() const {
  if (!sound()) throw InputError(mistakes_);
}

std::vector<CsvCell> csv_cells(std::string_view line) {
  line = line.substr(0, line.find('#'));
  const char* const blanks = " \t\r\f\v";
  std::vector<CsvCell> cells;
  if (line.find_first_not_of(blanks) == std::string_view::npos) return cells;
  for (std::size_t at = 0;;) {
    const std::size_t end = std::min(line.find(',', at), line.size());
    const std::string_view cell = line.substr(at, end - at);
    const std::size_t first = std::min(cell.find_first_not_of(blanks), cell.size());
    const std::size_t last = cell.find_last_not_of(blanks);
    cells.push_back({first < cell.size() ? cell.substr(first, last + 1 - first) : std::string_view{},
                     static_cast<int>(at + (first < cell.size() ? first : 0)) + 1});
    if (end == line.size()) return cells;
    at = end + 1;
  }
}

int NumberTable::column(const std::string& name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  return found == columns.end() ? -1 : static_cast<int>(found - columns.begin());
}

NumberTable read_numbers(const std::string& file, const std::vector<std::string>& needed, const std::vector<std::string>& others) {
  return NumberReader(file, needed, others).read();
}

}  // namespace elamin
