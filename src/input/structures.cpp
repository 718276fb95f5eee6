#include "input/parts.hpp"

#include "core/memory.hpp"
#include "core/text.hpp"
#include "input/csv.hpp"
#include "model/beam.hpp"
#include "model/grains.hpp"
#include "model/loop.hpp"
#include "model/row_values.hpp"
#include "model/sheet.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace elamin {

void add_own_values(const TablePlace& place, const std::string& file, const Structure& structure, Model& model, Mistakes& mistakes) {
  const bool row = structure.kind == "beam" || structure.kind == "loop";
  std::vector<std::string> names{"diameter", "density"};
  if (row) names.insert(names.end(), {"bond_stiffness", "rest_length", "angle_stiffness"});
  const std::optional<NumberTable> read = mistakes.unless_wrong([&] { return read_numbers(file, {}, names); });
  if (!read) return;
  const NumberTable& table = *read;
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

namespace {

/// Room that a particle takes in the model and its energy, as measured (`elamin check` of 10⁶ in a row, 7·10⁴ in a sheet, 10⁵ grains in a heap) [bytes].
constexpr double room_in_row = 1700, room_in_sheet = 4000, room_of_grain = 4300;

/// Everything that can be built of a list of tables; the names of the others go to left_out.
template <class Table, class Build>
auto all_built(const std::vector<Table>& tables, std::vector<std::string>& left_out, const Build& build) {
  std::vector<typename decltype(build(tables.front()))::value_type> all;
  for (const Table& table : tables) {
    decltype(build(table)) one;
    if (!table.place.broken) one = build(table);
    if (one)
      all.push_back(std::move(*one));
    else
      left_out.push_back(table.name);
  }
  return all;
}

}  // namespace

void check_structures(Problem& problem, Names& names, Mistakes& mistakes) {
  double particles = 0;
  const auto all = [&](auto& tables) {
    for (auto& table : tables) {
      names.add(table.place, table.name);
      if constexpr (requires { check(table, true, mistakes); }) check(table, !problem.plane.empty(), mistakes);
      else check(table, mistakes);
    }
  };
  all(problem.beams);
  all(problem.loops);
  all(problem.sheets);
  all(problem.grains);
  for (const BeamTable& b : problem.beams) particles += b.particles;
  for (const LoopTable& l : problem.loops) particles += l.particles;
  if (particles > most_particles)
    mistakes.add(fmt::format("the structures have {:.0f} particles together; at most {} can be handled", particles, most_particles));
}

bool add_structures(const Problem& problem, Model& model, std::vector<std::string>& left_out, Mistakes& mistakes) {
  const auto build = [&](const auto& table) { return built(table, mistakes); };
  const auto sheets = all_built(problem.sheets, left_out, build);
  const auto grains = all_built(problem.grains, left_out, build);
  double rows = 0, total = model.particles(), room = room_of_grain * total;
  for (const BeamTable& b : problem.beams) rows += b.particles;
  for (const LoopTable& l : problem.loops) rows += l.particles;
  for (const Sheet& s : sheets) total += sheet_particles(s), room += room_in_sheet * sheet_particles(s);
  for (const Grains& g : grains) total += static_cast<double>(g.position.cols()), room += room_of_grain * static_cast<double>(g.position.cols());
  total += rows, room += room_in_row * rows;
  if (total > most_particles) {
    if (rows <= most_particles)   // else said when the file was read
      mistakes.add(fmt::format("the structures have {:.0f} particles together; at most {} can be handled", total, most_particles));
    return false;
  }
  if (room > all_memory()) {
    mistakes.add(fmt::format("{:.0f} particles need {:.1f} GB before anything is solved; there are {:.1f} GB", total, room / 1e9, all_memory() / 1e9));
    return false;
  }
  for (const auto* numbers : {&model.id, &model.type, &model.molecule}) {
    const int most = numbers->empty() ? 0 : *std::max_element(numbers->begin(), numbers->end());
    if (most > std::numeric_limits<int>::max() - total && total > model.particles()) {
      mistakes.add(problem.lammps->place, "data",
                   fmt::format("its numbers of particles, types or molecules reach {}; there is no room above for those of the other structures", most));
      return false;
    }
  }
  const auto beams = all_built(problem.beams, left_out, [&](const BeamTable& table) { return built(table, problem.plane, mistakes); });
  const auto loops = all_built(problem.loops, left_out, build);
  if (!beams.empty()) add_beams(model, beams);
  if (!loops.empty()) add_loops(model, loops);
  if (!sheets.empty()) add_sheets(model, sheets);
  if (!grains.empty()) add_grains(model, grains);
  const auto own = [&](const char* kind, const auto& tables) {
    for (const auto& table : tables)
      for (const Structure& s : model.structures)
        if (!table.values.empty() && s.kind == kind && s.name == table.name) add_own_values(table.place, table.values, s, model, mistakes);
  };
  own("beam", problem.beams), own("loop", problem.loops), own("sheet", problem.sheets), own("grains", problem.grains);
  return true;
}

const TablePlace& place_of(const Problem& problem, const Structure& s) {
  const TablePlace* place = problem.lammps ? &problem.lammps->place : nullptr;
  for_structures(problem, [&](std::string_view kind, const auto& tables) {
    for (const auto& table : tables)
      if (s.kind == kind && table.name == s.name) place = &table.place;
  });
  return *place;
}

}  // namespace elamin
