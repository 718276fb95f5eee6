#pragma once
// Numbers with names, [constants], and what is computed of them: an expression such as "t/2" stands where a number does.
#include "input/keys.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace elamin {

struct ConstantsTable {
  TablePlace place;
  NamedNumbers numbers;                          // in the order of the file
  bool operator==(const ConstantsTable&) const = default;
};

void describe(Keys& keys, ConstantsTable& t);

/// The names that expressions know.
class Constants {
 public:
  /// A value, or why there is none, as the end of a sentence: `which divides by zero`. Neither where a name's own mistake was told.
  struct Result {
    std::optional<double> value;
    std::string why;
  };

  /// Numbers, names, + − * / ^ and parentheses, sqrt, sin, cos, tan (of radians), asin, acos, atan, exp, log, abs, min, max, pi.
  /// ^ binds to the right and before a sign: -2^2 is −4. The result is finite.
  Result value(const std::string& expression) const;

  /// Names that stand further down, which a constant may not use.
  void announce(const std::string& name) { later_.push_back(name); }
  /// A name from here on; without a value if its own was wrong and that was told.
  void set(const std::string& name, std::optional<double> value);
  bool empty() const { return values_.empty(); }

  const std::optional<double>* find(const std::string& name) const;
  bool is_later(const std::string& name) const;
  std::vector<std::string> names() const;

 private:
  std::vector<std::pair<std::string, std::optional<double>>> values_;
  std::vector<std::string> later_;
};

/// Whether a word may be the name of a constant: letters, digits and '_', a letter first, and no function.
bool is_constant_name(const std::string& word);

/// The integer that a number is to rounding (1e-12 of it: quotients of decimal fractions), if it is one.
std::optional<double> nearly_integer(double x);

}  // namespace elamin
