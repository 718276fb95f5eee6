#include "lammps/lines.hpp"

#include "core/find.hpp"
#include "core/suggest.hpp"
#include "core/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace elamin {
namespace {

bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v'; }

}  // namespace

bool is_word(std::string_view word) { return !word.empty() && std::isalpha(static_cast<unsigned char>(word[0])) != 0; }

std::string joined(const DataLine& line, std::size_t first) {
  std::string all;
  for (std::size_t i = first; i < line.size(); ++i) (all += i > first ? " " : "") += line[i];
  return all;
}

LammpsLines::LammpsLines(std::string file, const std::string& kind, const std::string& hint)
    : LammpsLines(file, read_data(file, kind, hint)) {}

LammpsLines::LammpsLines(std::string file, std::string text) : file_(std::move(file)), text_(std::move(text)) {
  position_ = text_.find('\n');
  position_ = position_ == std::string::npos ? text_.size() : position_ + 1;
  number_ = 1;
}

bool LammpsLines::next(DataLine& line) {
  line.words.clear();
  line.comment = {};
  while (position_ < text_.size()) {
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    std::string_view content(text_.data() + position_, end - position_);
    position_ = end + 1;
    line.number = ++number_;
    if (const std::size_t hash = content.find('#'); hash != std::string_view::npos) {
      line.comment = content.substr(hash + 1);
      content = content.substr(0, hash);
      while (!line.comment.empty() && blank(line.comment.front())) line.comment.remove_prefix(1);
      while (!line.comment.empty() && blank(line.comment.back())) line.comment.remove_suffix(1);
    }
    for (std::size_t i = 0; i < content.size();) {
      std::size_t j = i;
      while (j < content.size() && !blank(content[j])) ++j;
      if (j > i) line.words.push_back({content.substr(i, j - i), static_cast<int>(i) + 1});
      i = j + 1;
    }
    if (!line.words.empty()) return true;
  }
  return false;
}

void LammpsLines::mistake(const DataLine& line, std::size_t word, std::string key, std::string what) {
  mistake(line.number, word < line.size() ? line.words[word].column : 1, std::move(key), std::move(what));
}

void LammpsLines::mistake(int line, int column, std::string key, std::string what) {
  mistakes_.push_back({file_, line, column, std::move(key), std::move(what)});
  if (mistakes_.size() == most_mistakes) {
    int end = 1;                                     // behind all of them
    for (const Mistake& m : mistakes_)
      if (m.line == number_) end = std::max(end, m.column);
    mistakes_.push_back({file_, number_, end, {}, fmt::format("{} mistakes; there may be more", most_mistakes)});
    finish();
  }
}

void LammpsLines::finish() const {
  if (!mistakes_.empty()) throw InputError(mistakes_);
}

std::optional<double> LammpsLines::number(const DataLine& line, std::size_t i, const std::string& key) {
  std::string why;
  const std::optional<double> value = finite_number(line[i], why);
  if (!value) mistake(line, i, key, why);
  return value;
}

std::optional<int> LammpsLines::integer(const DataLine& line, std::size_t i, const std::string& key, int lo, int hi) {
  std::string_view word = line[i];
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  long long value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size() || error == std::errc::invalid_argument)
    mistake(line, i, key, in_quotes(std::string(line[i])) + " is not an integer");
  else if (error != std::errc{} || value < lo || value > hi)
    mistake(line, i, key,
            hi < lo ? in_quotes(std::string(line[i])) + " is out of range; the header of the file announces none"
                    : fmt::format("{} is out of range; {} is allowed", in_quotes(std::string(line[i])),
                                  lo == hi ? std::to_string(lo) : fmt::format("{} to {}", lo, hi)));
  else
    return static_cast<int>(value);
  return std::nullopt;
}

std::optional<double> LammpsLines::amount(const DataLine& line, std::size_t i, const std::string& key) {
  const auto value = number(line, i, key);
  if (!value || *value >= 0) return value;
  mistake(line, i, key, fmt::format("{} is negative; 0 or more is allowed", line[i]));
  return std::nullopt;
}

bool LammpsLines::has_size(const DataLine& line, std::initializer_list<std::size_t> sizes, const std::string& section,
                           const std::string& meaning) {
  if (contains(sizes, line.size())) return true;
  std::string allowed;
  for (const std::size_t n : sizes) allowed += (allowed.empty() ? "" : " or ") + std::to_string(n);
  mistake(line, 0, section, fmt::format("{} columns, expected {}: {}", line.size(), allowed, meaning));
  return false;
}

}  // namespace elamin
