#include "lammps/coefficients.hpp"

#include "laws/section.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {
namespace {

/// A style: its columns behind the type, what they mean, and the law's numbers that they make.
struct Style {
  const char *name, *first, *second, *formula;   // second "": it has one column
};

constexpr Style harmonic{"harmonic", "K", "r0", "U = K (r - r0)^2"};
constexpr Style cosine{"cosine", "K", "", "U = K (1 + cos theta)"};
constexpr Style cosine_shift{"cosine/shift", "Umin", "theta0", "U = -Umin/2 (1 + cos(theta - theta0))"};

/// The style of that name, "": the usual one; null if there is none.
const Style* style_of(const std::string& kind, const std::string& name) {
  if (kind == "bond") return name.empty() || name == harmonic.name ? &harmonic : nullptr;
  if (name == cosine_shift.name) return &cosine_shift;
  return name.empty() || name == cosine.name ? &cosine : nullptr;
}

const char* available(const std::string& kind) {
  return kind == "bond" ? "harmonic is" : "cosine and cosine/shift are";
}

/// Of a number as it is written, without zeros at its ends.
int significant_digits(std::string_view word) {
  int digits = 0, zeros = 0;
  for (const char c : word.substr(0, word.find_first_of("eE"))) {
    if (c < '0' || c > '9') continue;
    if (c == '0') zeros += digits > 0;
    else digits += zeros + 1, zeros = 0;
  }
  return digits;
}

}  // namespace

std::string refused_style(const std::string& kind, const std::string& comment) {
  if (comment == "hybrid" || style_of(kind, comment)) return "";
  return fmt::format("{} style {} is not available; {}", kind, in_quotes(comment), available(kind));
}

std::optional<CoefficientRow> coefficient_row(LammpsLines& lines, const DataLine& line, const std::string& kind,
                                              const std::string& comment, int most_types,
                                              const TypeLabels& labels) {
  const std::string section = kind == "bond" ? "Bond Coeffs" : "Angle Coeffs";
  const std::size_t first = line.size() > 1 && is_word(line[1]) ? 2 : 1;
  const std::string name = first == 2 ? std::string(line[1]) : comment == "hybrid" ? "" : comment;
  const Style* style = style_of(kind, name);
  if (!style) {
    lines.mistake(line, 1, section, fmt::format("style {} is not available; {}, or {}_coefficients in [lammps]", in_quotes(name),
                                                available(kind), kind));
    return std::nullopt;
  }
  const bool two = style->second[0] != 0;
  if (!lines.has_size(line, {first + (two ? 2 : 1)}, section,
                      fmt::format("type{} {}{} of style {}{}, {}", two ? "," : " and", style->first,
                                  two ? std::string(" and ") + style->second : "", style->name,
                                  name.empty() ? ", which is meant where none is named" : "", style->formula)))
    return std::nullopt;
  const auto type = type_in(lines, line, 0, section + ": type", most_types, labels);
  const auto K = lines.amount(line, first, section + ": " + style->first);
  const auto rest = two ? lines.amount(line, first + 1, section + ": " + style->second) : std::optional<double>(180);
  if (!type || !K || !rest) return std::nullopt;
  const int digits = std::max(significant_digits(line[first]), two ? significant_digits(line[first + 1]) : 0);
  if (kind == "bond") return CoefficientRow{line.number, *type, *K, *rest, digits};
  if (*rest > 180) {
    lines.mistake(line, first + 1, section + ": " + style->second,
                  fmt::format("{} is out of range; 0 to 180 degrees are allowed", line[first + 1]));
    return std::nullopt;
  }
  // −Umin/2 (1 + cos x) = Umin/2 (1 − cos x) − Umin
  return CoefficientRow{line.number, *type, two ? *K / 2 : *K, *rest == 180 ? pi : *rest * pi / 180, digits};
}

}  // namespace elamin
