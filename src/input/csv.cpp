#include "input/csv.hpp"

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
      : file_(file), needed_(needed), others_(others), text_(read_data(file, fmt::format("table {}", fmt::join(needed.empty() ? others : needed, ",")))) {}

  NumberTable read() {
    for (std::size_t at = 0; at < text_.size() && mistakes_.size() < most_mistakes;) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      ++line_;
      if (const auto cells = csv_cells(std::string_view(text_).substr(at, end - at)); !cells.empty()) row(cells);
      at = end + 1;
    }
    if (table_.rows.empty() && mistakes_.empty()) mistake(1, "", fmt::format("holds no row of numbers; the columns are {}", listed(all())));
    if (!mistakes_.empty()) throw InputError(mistakes_);
    return std::move(table_);
  }

 private:
  std::vector<std::string> all() const {
    std::vector<std::string> names = needed_;
    names.insert(names.end(), others_.begin(), others_.end());
    return names;
  }
  void mistake(int column, const std::string& key, const std::string& what) { mistakes_.push_back({file_, std::max(line_, 1), column, key, what}); }

  void row(const std::vector<CsvCell>& cells) {
    if (table_.columns.empty()) {
      std::string why;
      const bool numbers = std::all_of(cells.begin(), cells.end(), [&](const CsvCell& c) { return finite_number(c.text, why).has_value(); });
      if (!numbers || needed_.empty()) return names(cells);
      table_.columns = needed_;
    }
    if (cells.size() != table_.columns.size())
      return mistake(1, "", fmt::format("{} columns, expected {}: {}", cells.size(), table_.columns.size(), fmt::join(table_.columns, ",")));
    std::vector<double> values;
    for (std::size_t c = 0; c < cells.size(); ++c) {
      const std::string& name = table_.columns[c];
      std::string why;
      const bool may_be_empty = std::find(others_.begin(), others_.end(), name) != others_.end();
      const auto value = cells[c].text.empty() && may_be_empty ? std::numeric_limits<double>::quiet_NaN() : finite_number(cells[c].text, why);
      if (!value) mistake(cells[c].column, name, why);
      values.push_back(value.value_or(0));
    }
    table_.rows.push_back(std::move(values)), table_.lines.push_back(line_);
  }

  void names(const std::vector<CsvCell>& cells) {
    const std::vector<std::string> known = all();
    for (const CsvCell& cell : cells) {
      const std::string name(cell.text);
      if (std::find(known.begin(), known.end(), name) == known.end())
        mistake(cell.column, "", in_quotes(name) + " is no column of this table; there are: " + listed(known) + did_you_mean(name, known));
      else if (table_.column(name) >= 0)
        mistake(cell.column, "", in_quotes(name) + " is there twice; once is enough");
      table_.columns.push_back(name);
    }
    for (const std::string& name : needed_)
      if (table_.column(name) < 0 && mistakes_.empty()) mistake(1, "", fmt::format("the column {} is missing", in_quotes(name)));
    if (!mistakes_.empty()) line_ = 0, text_.clear();   // the columns are not known: nothing more can be read
  }

  const std::string& file_;
  const std::vector<std::string>&needed_, &others_;
  std::string text_;
  int line_ = 0;
  NumberTable table_;
  std::vector<Mistake> mistakes_;
};

}  // namespace

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
