#include "input/listed.hpp"

#include "core/text.hpp"
#include "input/csv.hpp"
#include "input/stiffness.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace elamin {
namespace {

/// Numbers of particles and what else stands in a row, with its place for messages.
struct ListedRow {
  std::vector<double> numbers;
  double stiffness, rest;              // NaN: not given
  Mistake at;                          // without what is wrong
};

/// The rows of a list, or of a file.
std::vector<ListedRow> rows_of(const TablePlace& place, const char* key, const std::optional<std::vector<std::vector<int>>>& list,
                               const std::string& file, const std::vector<std::string>& needed, const std::vector<std::string>& others,
                               Mistakes& mistakes) {
  std::vector<ListedRow> rows;
  const double none = std::nan("");
  if (list) {
    const auto written = place.keys.find(key);
    const Place at = written == place.keys.end() ? Place{place} : written->second;
    for (const std::vector<int>& numbers : *list)
      rows.push_back({{numbers.begin(), numbers.end()}, none, none,
                      {at.line > 0 ? mistakes.file() : "--set", at.line, at.column, place.key + "." + key, {}}});
    return rows;
  }
  try {
    const NumberTable table = read_numbers(file, needed, others);
    const int stiffness = table.column(others[0]), rest = table.column(others[1]);
    for (std::size_t k = 0; k < table.rows.size(); ++k) {
      ListedRow row{{}, stiffness < 0 ? none : table.rows[k][stiffness], rest < 0 ? none : table.rows[k][rest], {file, table.lines[k], 1, {}, {}}};
      for (const std::string& name : needed) row.numbers.push_back(table.rows[k][table.column(name)]);
      rows.push_back(std::move(row));
    }
  } catch (const InputError& e) {
    mistakes.add(e.mistakes());
  }
  return rows;
}

/// Looks up particles and tells of what is wrong with a row, of so many rows at most.
class Finder {
 public:
  Finder(const Model& model, const std::array<std::vector<int>, 2>* sides, Mistakes& mistakes)
      : model_(model), sides_(sides), mistakes_(mistakes) {
    for (int i = 0; i < model.particles(); ++i) index_[model.id[i]] = i;
  }

  /// Whether all of them are there and no two the same; then `particles` has them.
  template <std::size_t n> bool find(const ListedRow& row, std::array<int, n>& particles) {
    for (std::size_t k = 0; k < n; ++k) {
      const double number = row.numbers[k];
      if (sides_) {
        const std::vector<int>& side = (*sides_)[k];
        if (!(number >= 1 && number <= static_cast<double>(side.size())) || number != std::trunc(number))
          return wrong(row, fmt::format("{} is no place in the group, which has {} particles", number, side.size()));
        particles[k] = side[static_cast<std::size_t>(number) - 1];
        continue;
      }
      const auto found = number == std::trunc(number) && std::abs(number) < 2e9 ? index_.find(static_cast<int>(number)) : index_.end();
      if (found == index_.end())
        return wrong(row, fmt::format("{} is no id of a particle; there are {}", number,
                                      index_.empty() ? "none" : fmt::format("{} to {}", index_.begin()->first, index_.rbegin()->first)));
      particles[k] = found->second;
    }
    for (std::size_t k = 1; k < n; ++k)
      for (std::size_t l = 0; l < k; ++l)
        if (particles[k] == particles[l]) return wrong(row, fmt::format("{} is there twice", called(model_, particles[k])));
    return true;
  }
  bool wrong(const ListedRow& row, const std::string& what) {
    if (++told_ > most_mistakes) return false;
    Mistake m = row.at;
    m.what = what;
    mistakes_.add(std::vector<Mistake>{m});
    return false;
  }

 private:
  const Model& model_;
  const std::array<std::vector<int>, 2>* sides_;
  Mistakes& mistakes_;
  std::map<int, int> index_;
  std::size_t told_ = 0;
};

double given(double of_row, std::optional<double> of_table) { return std::isnan(of_row) ? of_table.value_or(0) : of_row; }

std::string listed_names(const Model& model, std::initializer_list<int> particles) {
  std::vector<std::string> names;
  for (const int p : particles) names.push_back(called(model, p));
  return fmt::format("{}", fmt::join(names, " and "));
}

void check_sizes(TablePlace& place, const char* key, const std::optional<std::vector<std::vector<int>>>& list, std::size_t size, Mistakes& mistakes) {
  if (!list || place.broken) return;
  for (std::size_t k = 0; k < list->size(); ++k)
    if ((*list)[k].size() != size)
      return mistakes.add(place, key, fmt::format("has {} numbers in its list {}; they must be {} particles", (*list)[k].size(), k + 1, size));
}

}  // namespace

std::vector<NewBond> listed_bonds(const BondsTable& t, const std::array<std::vector<int>, 2>* sides, const Model& model, Mistakes& mistakes) {
  Finder finder(model, sides, mistakes);
  std::set<std::pair<int, int>> there;
  for (const Bond& b : model.bonds) there.insert(std::minmax(b.particles[0], b.particles[1]));
  std::set<std::pair<int, int>> mine;
  std::vector<NewBond> bonds;
  for (const ListedRow& row : rows_of(t.place, "pairs", t.pairs, t.file, {"i", "j"}, {"bond_stiffness", "rest_length"}, mistakes)) {
    NewBond b{{}, 0, 0, given(row.rest, t.rest_length)};
    if (!finder.find(row, b.particles)) continue;
    const auto [i, j] = b.particles;
    const std::string names = listed_names(model, {i, j});
    const bool own = !std::isnan(row.stiffness);
    if (own) b.stiffness = row.stiffness;
    else b.stiffness = t.bond_stiffness.value_or(0), b.axial_stiffness = t.axial_stiffness.value_or(0);
    const auto refuse = [&](const std::string& what) { finder.wrong(row, what); };
    const bool stiff = b.stiffness > 0 || b.axial_stiffness > 0, in_one_place = model.start.position.col(i) == model.start.position.col(j);
    if (there.count(std::minmax(i, j))) refuse(names + " are bonded already");
    else if (!mine.insert(std::minmax(i, j)).second) refuse(names + " are there twice; once is enough");
    else if (!stiff) refuse("its stiffness is missing or not positive; give bond_stiffness, here or in the table");
    else if (b.rest_length < 0 || row.rest == 0) refuse(fmt::format("rest_length must be a positive number, is {}", row.rest));
    else if (b.rest_length == 0 && in_one_place) refuse(names + " are in the same place; give rest_length");
    else bonds.push_back(b);
  }
  return bonds;
}

std::vector<NewAngle> listed_angles(const AnglesTable& t, const std::vector<int>& over, const Model& model, Mistakes& mistakes) {
  const double rest = t.rest.as_built ? -1 : rest_angle(t.rest, pi), stiffness = t.angle_stiffness.value_or(0);
  std::vector<NewAngle> angles;
  if (t.over) {
    for (const auto& triple : meeting_bonds(model, over, t.least.value_or(0) * pi / 180)) angles.push_back({triple, stiffness, rest});
    if (angles.empty())
      mistakes.add(t.place, "over", fmt::format("no two bonds meet in \"{}\"{}", *t.over,
                                                t.least ? fmt::format(" at {} degrees or more", *t.least) : ""));
    return angles;
  }
  Finder finder(model, nullptr, mistakes);
  for (const ListedRow& row : rows_of(t.place, "triples", t.triples, t.file, {"i", "j", "k"}, {"angle_stiffness", "rest"}, mistakes)) {
    NewAngle a{{}, given(row.stiffness, t.angle_stiffness), rest};
    if (!std::isnan(row.rest)) a.rest = row.rest == 180 ? pi : row.rest * pi / 180;
    if (!finder.find(row, a.particles)) continue;
    if (!(a.stiffness > 0))
      finder.wrong(row, "its stiffness is missing or not positive; give angle_stiffness, here or in the table");
    else if (row.rest < 0 || row.rest > 180)
      finder.wrong(row, fmt::format("rest must be an angle of 0 to 180 degrees, is {}", row.rest));
    else
      angles.push_back(a);
  }
  return angles;
}

void check_listed(BondsTable& t, Mistakes& mistakes) {
  check_sizes(t.place, "pairs", t.pairs, 2, mistakes);
  const bool stiff = t.place.written("bond_stiffness") || t.place.written("axial_stiffness");
  if (!stiff && !t.place.written("file")) mistakes.add(t.place, "bond_stiffness", "is missing; it must be a positive number, or give axial_stiffness");
  if (t.rule == BondRule::nearest && !t.place.written("bonds_per_particle"))
    mistakes.add(t.place, "bonds_per_particle", "is missing; to how many nearest ones");
  if (t.rule == BondRule::within && !t.place.written("within")) mistakes.add(t.place, "within", "is missing; it must be a positive number");
}

void check_listed(AnglesTable& t, Mistakes& mistakes) {
  check_sizes(t.place, "triples", t.triples, 3, mistakes);
  if (!t.place.written("angle_stiffness") && !t.place.written("file"))
    mistakes.add(t.place, "angle_stiffness", "is missing; it must be a positive number");
}

}  // namespace elamin
