#include "input/connect.hpp"

#include "core/text.hpp"
#include "input/csv.hpp"
#include "input/parts.hpp"
#include "input/staged_structure.hpp"
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

constexpr Word<RemoveTable::What> remove_words[]{
    {"particles", RemoveTable::What::particles}, {"bonds", RemoveTable::What::bonds}, {"angles", RemoveTable::What::angles}};
constexpr Word<BondRule> rule_words[]{{"nearest", BondRule::nearest}, {"within", BondRule::within}};

void describe_new_bonds(Keys& keys, NewBondKeys& t) {
  keys.may("bond_stiffness", t.bond_stiffness, "K of the bonds [force/length]", range::positive);
  keys.may("axial_stiffness", t.axial_stiffness, "EA [force] instead of it: K = EA/(2 r₀) of each", range::positive);
  keys.may("rest_length", t.rest_length, "r₀ of the bonds [length]; by default the distance as built", range::positive);
  keys.at_most_one({"bond_stiffness", "axial_stiffness"});
}

}  // namespace

void describe(Keys& keys, ConnectTable& t) {
  keys.about("Bonds between the particles of two groups that are near each other, and angles over these bonds.");
  keys.must("between", t.between, "the two groups");
  keys.may("from_stage", t.from_stage, "made as that stage begins, where things are by then; by default as built");
  keys.must("within", t.within, "the longest distance that is bonded [length]", range::positive);
  keys.may("bonds_per_particle", t.bonds_per_particle, "of the first group: to its nearest ones only; by default to all", range::count);
  describe_new_bonds(keys, t);
  keys.one_at_least({"bond_stiffness", "axial_stiffness"}, "it must be a positive number");
  keys.may("angle_stiffness", t.angle_stiffness, "B of the angles [energy]; by default there are none", range::positive);
  keys.may("rest", t.rest, "θ₀ of the angles", range::degrees);
}

void describe(Keys& keys, BondsTable& t) {
  keys.about("Bonds besides those of the structures: one by one, or by a rule. (With angles over them: `[[connect]]`.)");
  keys.may("from_stage", t.from_stage, "made as that stage begins, where things are by then; by default as built");
  keys.may("pairs", t.pairs, "the two particles of each, by their ids, or with `between` by their places in the two groups, from 1");
  keys.may_file("file", t.file, "the same from a table of commas: i,j; its first line may name columns bond_stiffness and rest_length too, an empty "
                                "cell: as by the keys");
  keys.word("rule", t.rule, rule_words, "each particle of the first group with its nearest ones in the second, or with all within a distance");
  keys.may("between", t.between, "the two groups; by default all");
  keys.may("within", t.within, "the longest distance that is bonded by the rule [length]", range::positive);
  keys.may("bonds_per_particle", t.bonds_per_particle, "of the first group, by the rule: to so many nearest ones", range::count);
  describe_new_bonds(keys, t);
  keys.at_most_one({"pairs", "file", "rule"});
  keys.one_at_least({"pairs", "file", "rule"}, "give pairs = [[i, j], …], file = \"bonds.csv\" or rule = \"nearest\"");
  keys.with({"within", "bonds_per_particle"}, {"rule"}, "which looks for neighbours");
}

void describe(Keys& keys, AnglesTable& t) {
  keys.about("Angles besides those of the structures: one by one, or over bonds that meet.");
  keys.may("from_stage", t.from_stage, "made as that stage begins, where things are by then; by default as built");
  keys.may("triples", t.triples, "the three particles of each by their ids, the middle one second");
  keys.may_file("file", t.file, "the same from a table of commas: i,j,k; its first line may name columns angle_stiffness and rest (degrees) too, an "
                                "empty cell: as by the keys");
  keys.may("over", t.over, "a group: over every two bonds that meet in a particle, all three of the group");
  keys.may("least", t.least, "… at this angle or more [degrees]: 120 leaves out those that do not go on", range::degrees);
  keys.may("angle_stiffness", t.angle_stiffness, "B of the angles [energy]; needed unless the file has it", range::positive);
  keys.may("rest", t.rest, "θ₀ of the angles", range::degrees);
  keys.at_most_one({"triples", "file", "over"});
  keys.one_at_least({"triples", "file", "over"}, "give triples = [[i, j, k], …], file = \"angles.csv\" or over = \"group\"");
  keys.with({"least"}, {"over"}, "the bonds that meet");
}

ConnectTable by_rule(const BondsTable& t) {
  ConnectTable c;
  static_cast<NewBondKeys&>(c) = t;
  c.place = t.place, c.from_stage = t.from_stage;
  c.between = t.between.value_or(std::array<std::string, 2>{"all", "all"});
  c.within = t.within, c.bonds_per_particle = t.bonds_per_particle;
  return c;
}

void describe(Keys& keys, RemoveTable& t) {
  keys.about("What is gone from a stage on.");
  keys.must("group", t.group, "where");
  keys.must("from_stage", t.from_stage, "the stage from which it is gone");
  keys.word("what", t.what, remove_words, "the particles with all that is on them; the bonds between them with the angles over these; the angles");
}

namespace {

void check_sizes(TablePlace& place, const char* key, const std::optional<std::vector<std::vector<int>>>& list, std::size_t size, Mistakes& mistakes) {
  if (!list || place.broken) return;
  for (std::size_t k = 0; k < list->size(); ++k)
    if ((*list)[k].size() != size)
      return mistakes.add(place, key, fmt::format("has {} numbers in its list {}; they must be {} particles", (*list)[k].size(), k + 1, size));
}

void check(BondsTable& t, Mistakes& mistakes) {
  check_sizes(t.place, "pairs", t.pairs, 2, mistakes);
  const bool stiff = t.place.written("bond_stiffness") || t.place.written("axial_stiffness");
  if (!stiff && !t.place.written("file")) mistakes.add(t.place, "bond_stiffness", "is missing; it must be a positive number, or give axial_stiffness");
  if (t.rule == BondRule::nearest && !t.place.written("bonds_per_particle"))
    mistakes.add(t.place, "bonds_per_particle", "is missing; to how many nearest ones");
  if (t.rule == BondRule::within && !t.place.written("within")) mistakes.add(t.place, "within", "is missing; it must be a positive number");
}

void check(AnglesTable& t, Mistakes& mistakes) {
  check_sizes(t.place, "triples", t.triples, 3, mistakes);
  if (!t.place.written("angle_stiffness") && !t.place.written("file"))
    mistakes.add(t.place, "angle_stiffness", "is missing; it must be a positive number");
}

}  // namespace

void check_connections(Problem& problem, Names& names, Mistakes& mistakes) {
  for (ConnectTable& c : problem.connections) {
    names.refer(c.place, "between", c.between);
    if (!c.rest.as_built && !c.place.written("angle_stiffness"))
      mistakes.add(c.place, "rest", "is of no use without angle_stiffness; without it there are no angles");
  }
  for (BondsTable& t : problem.bonds) {
    if (t.between) names.refer(t.place, "between", *t.between);
    check(t, mistakes);
  }
  for (AnglesTable& t : problem.angles) {
    if (t.over) names.refer(t.place, "over", *t.over);
    check(t, mistakes);
  }
  for (RemoveTable& r : problem.removals) names.refer(r.place, "group", r.group);
}

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

Connection connection_of(const ConnectTable& t) {
  Connection c;
  c.within = t.within.value_or(0), c.bonds_per_particle = t.bonds_per_particle.value_or(0);
  c.bond_stiffness = t.bond_stiffness.value_or(0), c.axial_stiffness = t.axial_stiffness.value_or(0), c.rest_length = t.rest_length.value_or(0);
  c.angle_stiffness = t.angle_stiffness.value_or(0);
  c.as_built = t.rest.as_built, c.rest = rest_angle(t.rest, pi);
  return c;
}

namespace {

/// The particles of both groups, which there must be.
std::optional<std::array<std::vector<int>, 2>> sides_of(const TablePlace& place, const std::array<std::string, 2>& between, Groups& groups,
                                                        Mistakes& mistakes) {
  const auto members = groups.find(place, between);
  if (!members) return std::nullopt;
  for (int side = 0; side < 2; ++side)
    if ((*members)[side].particles.empty())
      return mistakes.add(place, "between", fmt::format("\"{}\" has no particle; bodies are not connected", between[side])), std::nullopt;
  return std::array{(*members)[0].particles, (*members)[1].particles};
}

bool add(const ConnectTable& t, Groups& groups, Model& model, Mistakes& mistakes) {
  auto sides = sides_of(t.place, t.between, groups, mistakes);
  if (!sides) return false;
  Connection c = connection_of(t);
  c.first = std::move((*sides)[0]), c.second = std::move((*sides)[1]);
  const int bonds = connect(model, c);
  if (bonds > 0) return true;
  if (!t.within)
    mistakes.add(t.place, "rule", bonds < 0 ? "has more pairs to look at than can be; give within" : "makes no bond: there is none to bond");
  else if (bonds < 0)
    mistakes.add(t.place, "within", fmt::format("makes more bonds than can be handled, {}; make it smaller", *t.within));
  else
    mistakes.add(t.place, "within", fmt::format("makes no bond: no particle of \"{}\" is within {} of one of \"{}\" that it is not bonded to already",
                                                t.between[1], *t.within, t.between[0]));
  return false;
}

/// `now`: else it is only looked whether it can be made.
bool add(const BondsTable& t, bool now, Groups& groups, Model& model, Mistakes& mistakes) {
  if (t.place.broken) return false;
  if (t.rule) return !now || add(by_rule(t), groups, model, mistakes);
  std::optional<std::array<std::vector<int>, 2>> sides;
  if (t.between && !(sides = sides_of(t.place, *t.between, groups, mistakes))) return false;
  const std::size_t before = mistakes.list().size();
  const std::vector<NewBond> bonds = listed_bonds(t, sides ? &*sides : nullptr, model, mistakes);
  if (now) add_bonds(model, bonds);
  return mistakes.list().size() == before;
}

bool add(const AnglesTable& t, bool now, Groups& groups, Model& model, Mistakes& mistakes) {
  if (t.place.broken) return false;
  const Members* over = t.over ? groups.find(t.place, "over", *t.over) : nullptr;
  if (t.over && (!over || !now)) return over != nullptr;   // of bonds that may not be there yet
  const std::size_t before = mistakes.list().size();
  const std::vector<NewAngle> angles = listed_angles(t, over ? over->particles : std::vector<int>{}, model, mistakes);
  if (now) add_angles(model, angles);
  return mistakes.list().size() == before;
}

}  // namespace

bool add_connections(const Problem& problem, Groups& groups, Model& model, Mistakes& mistakes) {
  bool whole = true;
  const auto now = [&](const auto& t) { return stage_number(problem, t.from_stage) == 0; };
  for (const ConnectTable& t : problem.connections)
    if (now(t)) whole = add(t, groups, model, mistakes) && whole;
  for (const BondsTable& t : problem.bonds) whole = add(t, now(t), groups, model, mistakes) && whole;
  for (const AnglesTable& t : problem.angles) whole = add(t, now(t), groups, model, mistakes) && whole;
  return whole;
}

}  // namespace elamin
