#include "lammps/script/formula.hpp"

#include "core/suggest.hpp"
#include "core/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstring>

namespace elamin::script {
namespace {

/// Conditions of `if`: operands are numbers, or words that are compared as they stand.
class Condition {
 public:
  Condition(const std::string& text, std::size_t word) : text_(text), word_(word) {}

  bool whole() {
    const Operand o = operation(1);
    blanks();
    if (i_ < text_.size()) wrong(fmt::format("{} is left over", in_quotes(text_.substr(i_))));
    return truth(o);
  }

 private:
  struct Operand { double number = 0; std::string text; bool is_text = false; };
  [[noreturn]] void wrong(const std::string& what) const { throw Wrong(word_, "the condition " + in_quotes(text_) + ": " + what); }
  void blanks() {
    while (i_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[i_]))) ++i_;
  }
  bool truth(const Operand& o) const {
    if (o.is_text) wrong(in_quotes(o.text) + " is neither true nor false");
    return o.number != 0;
  }
  Operand operation(int least) {
    static constexpr std::pair<const char*, int> all[]{{"||", 1}, {"|^", 1}, {"&&", 2}, {"==", 3}, {"!=", 3},
                                                       {"<=", 4}, {">=", 4}, {"<", 4},  {">", 4}};
    Operand left = operand();
    while (true) {
      blanks();
      const auto* o = std::find_if(std::begin(all), std::end(all),
                                   [&](const auto& a) { return text_.compare(i_, std::strlen(a.first), a.first) == 0; });
      if (o == std::end(all) || o->second < least) return left;
      i_ += std::strlen(o->first);
      const Operand right = operation(o->second + 1);
      const std::string sign = o->first;
      if (left.is_text != right.is_text) wrong("compares a number with a word");
      Operand r;
      if (sign == "==") r.number = left.is_text ? left.text == right.text : left.number == right.number;
      else if (sign == "!=") r.number = left.is_text ? left.text != right.text : left.number != right.number;
      else if (left.is_text) wrong("words can be compared with == and != only");
      else if (sign == "||") r.number = truth(left) || truth(right);
      else if (sign == "|^") r.number = truth(left) != truth(right);
      else if (sign == "&&") r.number = truth(left) && truth(right);
      else if (sign == "<") r.number = left.number < right.number;
      else if (sign == "<=") r.number = left.number <= right.number;
      else if (sign == ">") r.number = left.number > right.number;
      else r.number = left.number >= right.number;
      left = r;
    }
  }
  Operand operand() {
    blanks();
    if (i_ >= text_.size()) wrong("ends where a number or a word is wanted");
    if (++nested_ > most_nested) wrong("has too many brackets or signs in each other");
    struct Leave { int& n; ~Leave() { --n; } } leave{nested_};
    if (text_[i_] == '!' && text_.compare(i_, 2, "!=") != 0) {
      ++i_;
      Operand o = operand();
      return {static_cast<double>(!truth(o)), "", false};
    }
    if (text_[i_] == '(') {
      ++i_;
      Operand o = operation(1);
      blanks();
      if (i_ >= text_.size() || text_[i_] != ')') wrong("')' is missing");
      ++i_;
      return o;
    }
    std::size_t j = i_;
    if (text_[i_] == '"' || text_[i_] == '\'') {
      j = text_.find(text_[i_], i_ + 1);
      if (j == std::string::npos) wrong("a quote is not closed");
      Operand o{0, text_.substr(i_ + 1, j - i_ - 1), true};
      i_ = j + 1;
      return o;
    }
    while (j < text_.size() && !std::isspace(static_cast<unsigned char>(text_[j])) && !std::strchr("()<>=!&|^", text_[j])) ++j;
    const std::string t = text_.substr(i_, j - i_);
    if (t.empty()) wrong(fmt::format("{} stands where a number or a word is wanted", in_quotes(std::string(1, text_[i_]))));
    i_ = j;
    Operand o;
    return reads_as(unsigned_word(t), o.number) ? o : Operand{0, t, true};
  }

  const std::string& text_;
  std::size_t word_, i_ = 0;
  int nested_ = 0;
};

}  // namespace

bool condition(const std::string& text, std::size_t word) { return Condition(text, word).whole(); }

}  // namespace elamin::script
