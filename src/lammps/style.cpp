#include "lammps/style.hpp"

#include "core/suggest.hpp"

#include <algorithm>
#include <sstream>

namespace elamin {
namespace {

using Columns = std::vector<AtomColumn>;

const char* const known = "available are atomic, charge, sphere, bond, angle, molecular, full, body and hybrids of them, "
                          "such as \"hybrid sphere angle\"";

/// What a style has between the type and the position, in the order of the file.
std::optional<Columns> own_columns(const std::string& style) {
  using enum AtomColumn;
  if (style == "atomic") return Columns{};
  if (style == "sphere") return Columns{diameter, density};
  if (style == "bond" || style == "angle" || style == "molecular") return Columns{molecule};
  if (style == "charge") return Columns{charge};
  if (style == "full") return Columns{molecule, charge};
  if (style == "body") return Columns{bodyflag, mass};
  return std::nullopt;
}

}  // namespace

std::optional<Columns> atom_columns(const std::string& style, std::string* why) {
  using enum AtomColumn;
  const auto refuse = [&](const std::string& what) {
    *why = what;
    return std::nullopt;
  };
  std::istringstream words(style);
  std::string word;
  words >> word;
  if (word != "hybrid") {
    const auto own = own_columns(word);
    std::string rest;
    if (!own || words >> rest) return refuse("the atom style " + in_quotes(style) + " is not available; " + known);
    Columns columns{id};                                    // the molecule stands before the type
    if (!own->empty() && own->front() == molecule) columns.push_back(molecule);
    columns.push_back(type);
    for (const AtomColumn c : *own)
      if (c != molecule) columns.push_back(c);
    columns.insert(columns.end(), {x, y, z});
    return columns;
  }
  Columns columns{id, type, x, y, z};
  bool any = false;
  while (words >> word) {
    any = true;
    const auto own = own_columns(word);
    if (!own) return refuse("the atom style " + in_quotes(word) + " in " + in_quotes(style) + " is not available; " + known);
    for (const AtomColumn c : *own) {
      if (std::find(columns.begin(), columns.end(), c) != columns.end())
        return refuse("two of the styles in " + in_quotes(style) + " have the same column; one of them is enough");
      columns.push_back(c);
    }
  }
  const auto has = [&](AtomColumn c) { return std::find(columns.begin(), columns.end(), c) != columns.end(); };
  if (has(bodyflag) && has(diameter))
    return refuse(in_quotes(style) + " is not available: one column would be a density here and a mass there; put the particles "
                                  "into one file and the bodies into another");
  if (!any)
    return refuse(
        "\"hybrid\" alone does not say which columns there are; give the styles, such as \"hybrid sphere angle\"");
  return columns;
}

}  // namespace elamin
