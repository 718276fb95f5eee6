#include "input/constants.hpp"

#include "core/find.hpp"
#include "core/suggest.hpp"
#include "core/types.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

namespace elamin {
namespace {

struct Function {
  const char* name;
  double (*of)(double);
};
constexpr Function functions[]{
    {"sqrt", [](double x) { return std::sqrt(x); }}, {"sin", [](double x) { return std::sin(x); }},   {"cos", [](double x) { return std::cos(x); }},
    {"tan", [](double x) { return std::tan(x); }},   {"asin", [](double x) { return std::asin(x); }}, {"acos", [](double x) { return std::acos(x); }},
    {"atan", [](double x) { return std::atan(x); }}, {"exp", [](double x) { return std::exp(x); }},   {"log", [](double x) { return std::log(x); }},
    {"abs", [](double x) { return std::abs(x); }}};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

const Function* function_named(std::string_view name) {
  for (const Function& f : functions)
    if (name == f.name) return &f;
  return nullptr;
}

/// Reads and computes in one go, from left to right; what is wrong is thrown as the end of a sentence.
class Calculation {
 public:
  Calculation(const std::string& text, const Constants& constants) : text_(text), constants_(constants) {}

  double value() {
    const double x = sum();
    blanks();
    if (at_ < text_.size()) wanted("+, -, *, / or ^");
    return x;
  }

  struct Wrong { std::string why; };   // empty: it was told where the name is from

 private:
  static constexpr int deepest = 100;

  double sum() {
    double x = product();
    while (true) {
      if (take('+')) x = finite(x + product());
      else if (take('-')) x = finite(x - product());
      else return x;
    }
  }
  double product() {
    double x = signed_power();
    while (true) {
      if (take('*')) {
        x = finite(x * signed_power());
      } else if (take('/')) {
        const double y = signed_power();
        if (y == 0) throw Wrong{"which divides by zero"};
        x = finite(x / y);
      } else {
        return x;
      }
    }
  }
  double signed_power() {
    const Level level(*this);
    if (take('-')) return -signed_power();
    if (take('+')) return signed_power();
    const double x = primary();
    if (!take('^')) return x;
    const double y = signed_power();
    if (x == 0 && y < 0) throw Wrong{"which divides by zero"};
    return number(std::pow(x, y), fmt::format("{}^{}", x, y));
  }
  double primary() {
    blanks();
    if (take('(')) return closed(sum());
    if (at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.')) return literal();
    if (at_ < text_.size() && is_letter(text_[at_])) return named();
    wanted("a number, a name or (");
  }
  double literal() {
    double x = 0;
    const char* const first = text_.data() + at_;
    const auto [end, error] = std::from_chars(first, text_.data() + text_.size(), x);
    if (error == std::errc::invalid_argument) wanted("a number, a name or (");
    at_ += static_cast<std::size_t>(end - first);
    if (error != std::errc()) throw Wrong{in_quotes(std::string(first, end)).insert(0, "where ") + " is beyond what numbers can hold"};
    return x;
  }
  double named() {
    const std::size_t first = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    const std::string name = text_.substr(first, at_ - first);
    if (const Function* f = function_named(name)) {
      open(name);
      const double x = closed(sum());
      return number(f->of(x), fmt::format("{}({})", name, x));
    }
    if (name == "min" || name == "max") {
      open(name);
      double x = sum();
      while (take(',')) {
        const double y = sum();
        x = name == "min" ? std::min(x, y) : std::max(x, y);
      }
      return closed(x);
    }
    if (name == "pi") return pi;
    if (const auto* constant = constants_.find(name)) {
      if (!*constant) throw Wrong{};
      return **constant;
    }
    if (constants_.is_later(name)) throw Wrong{"where " + in_quotes(name) + " stands further down; a constant uses those above it"};
    throw Wrong{"where " + in_quotes(name) + " is no constant; " + there_are(constants_.names(), name)};
  }
  void open(const std::string& name) {
    if (!take('(')) throw Wrong{fmt::format("where {} is a function: {}(…)", name, name)};
  }
  double closed(double x) {
    if (!take(')')) wanted("+, -, *, /, ^ or )");
    return x;
  }
  /// Where parentheses and signs are nested, the stack grows.
  struct Level {
    explicit Level(Calculation& c) : depth(c.depth_) {
      if (++depth > deepest) throw Wrong{"which is nested too deeply"};
    }
    ~Level() { --depth; }
    int& depth;
  };

  static double finite(double x) {
    if (!std::isfinite(x)) throw Wrong{"which is beyond what numbers can hold"};
    return x;
  }
  static double number(double x, const std::string& what) {
    if (std::isnan(x) || (std::isinf(x) && what.compare(0, 3, "log") == 0)) throw Wrong{"where " + what + " is no number"};
    return finite(x);
  }
  void blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  bool take(char c) {
    blanks();
    const bool there = at_ < text_.size() && text_[at_] == c;
    at_ += there;
    return there;
  }
  [[noreturn]] void wanted(const char* what) {
    const std::string before = text_.substr(0, at_), where = at_ == 0 ? "at the beginning" : "behind " + in_quotes(before);
    throw Wrong{fmt::format("which is no expression: {} there must be {}", where, what)};
  }

  const std::string& text_;
  const Constants& constants_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

void describe(Keys& keys, ConstantsTable& t) {
  keys.about("Numbers with names of your own, each a number or an expression of those above it. Wherever a number stands in the file, an expression "
             "in quotes may stand: `\"t/2\"`, with + - * / ^ and parentheses, sqrt, sin, cos, tan (of radians), asin, acos, atan, exp, log, abs, "
             "min, max and pi. `--set constants.t=2e-3` and sweeps over `constants.t` move all that follows from it.");
  keys.numbers(t.numbers);
}

Constants::Result Constants::value(const std::string& expression) const {
  try {
    return {Calculation(expression, *this).value(), ""};
  } catch (const Calculation::Wrong& wrong) {
    return {std::nullopt, wrong.why};
  }
}

void Constants::set(const std::string& name, std::optional<double> value) {
  std::erase(later_, name);
  values_.emplace_back(name, value);
}

const std::optional<double>* Constants::find(const std::string& name) const {
  const auto found = std::find_if(values_.begin(), values_.end(), [&](const auto& v) { return v.first == name; });
  return found == values_.end() ? nullptr : &found->second;
}

bool Constants::is_later(const std::string& name) const { return contains(later_, name); }

std::vector<std::string> Constants::names() const {
  std::vector<std::string> names;
  for (const auto& [name, value] : values_) names.push_back(name);
  return names;
}

bool is_constant_name(const std::string& word) {
  if (word.empty() || word.size() > 64 || !is_letter(word[0])) return false;
  if (word == "pi" || word == "min" || word == "max" || function_named(word)) return false;
  return std::all_of(word.begin(), word.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

std::optional<double> nearly_integer(double x) {
  const double integer = std::round(x);
  return std::abs(x - integer) <= 1e-12 * std::abs(x) ? std::optional(integer) : std::nullopt;
}

}  // namespace elamin
