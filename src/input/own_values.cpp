#include "input/own_values.hpp"

#include "core/text.hpp"
#include "input/csv.hpp"
#include "model/row_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

void add_own_values(const TablePlace& place, const std::string& file, const Structure& structure, Model& model, Mistakes& mistakes) {
  const bool row = structure.kind == "beam" || structure.kind == "loop";
  std::vector<std::string> names{"diameter", "density"};
  if (row) names.insert(names.end(), {"bond_stiffness", "rest_length", "angle_stiffness"});
  NumberTable table;
  try {
    table = read_numbers(file, {}, names);
  } catch (const InputError& e) {
    return mistakes.add(e.mistakes());
  }
  const std::size_t count = table.rows.size();
  if (count != static_cast<std::size_t>(structure.count))
    return mistakes.add(place, "values", fmt::format("has {} rows, and \"{}\" has {} particles; give a row for each", count, structure.name,
                                                     structure.count));
  const std::vector<bool> all(count, true), bonds = has_bond_behind(model, structure), angles = has_angle_in_the_middle(model, structure);
  OwnValues values;
  std::vector<Mistake> wrong;
  const auto take = [&](const char* name, std::vector<double>& list, const std::vector<bool>& there, const char* what) {
    const int c = table.column(name);
    if (c < 0) return;
    for (std::size_t k = 0; k < count; ++k) {
      const double x = table.rows[k][c];
      list.push_back(x);
      if (std::isnan(x)) continue;
      const auto refuse = [&](const std::string& why) { wrong.push_back({file, table.lines[k], 1, name, why}); };
      if (!(x > 0)) refuse(fmt::format("must be a positive number, is {}", x));
      else if (!there[k]) refuse(fmt::format("particle {} of \"{}\" has no {}; leave the cell empty", k + 1, structure.name, what));
    }
  };
  take("diameter", values.diameter, all, ""), take("density", values.density, all, "");
  take("bond_stiffness", values.bond_stiffness, bonds, "bond behind it"), take("rest_length", values.rest_length, bonds, "bond behind it");
  take("angle_stiffness", values.angle_stiffness, angles, "angle over it");
  if (wrong.size() > most_mistakes) wrong.resize(most_mistakes);
  if (!wrong.empty()) return mistakes.add(wrong);
  set_own_values(model, structure, values);
}

}  // namespace elamin
