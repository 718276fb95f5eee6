#include "input/grains.hpp"

#include "core/error.hpp"
#include "input/csv.hpp"
#include "input/keys.hpp"
#include "input/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace elamin {

namespace {

constexpr const char* const columns[]{"x", "y", "z", "diameter"};

class GrainReader {
 public:
  explicit GrainReader(const std::string& file) : rows_(file, "table x,y,z or x,y,z,diameter") {}

  GrainRows read() {
    rows_.each([&](const auto& cells) { row(cells); });
    if (grains_.position.empty() && rows_.sound()) rows_.mistake(1, "", "holds no grain; a line x,y,z or x,y,z,diameter is one");
    rows_.finish();
    return std::move(grains_);
  }

 private:
  void row(const std::vector<CsvCell>& cells) {
    if (std::exchange(first_, false) && names(cells)) return;
    const std::size_t n = cells.size();
    if (n != 3 && n != 4) return rows_.mistake(1, "", fmt::format("{} columns, expected x,y,z or x,y,z,diameter", n));
    if (width_ == 0) width_ = n;
    if (n != width_) return rows_.mistake(1, "", fmt::format("{} columns, but the lines before have {}", n, width_));
    Vec3 x = Vec3::Zero();
    bool good = true;
    for (int c = 0; c < 3; ++c) {
      const auto value = rows_.number(cells[c], columns[c]);
      good = good && value;
      x[c] = value.value_or(0);
    }
    if (n == 4) {
      const auto d = rows_.number(cells[3], columns[3]);
      if (d && !(*d > 0)) rows_.mistake(cells[3].column, columns[3], fmt::format("must be a positive number, is {}", *d));
      grains_.diameter.push_back(d.value_or(0));
    }
    if (good) grains_.position.push_back(x);
  }

  /// Whether these are the names of the columns rather than a grain.
  bool names(const std::vector<CsvCell>& cells) {
    if (cells.size() > 4) return false;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells[i].text != columns[i]) return false;
    return cells.size() >= 3;
  }

  CsvRows rows_;
  bool first_ = true;
  std::size_t width_ = 0;
  GrainRows grains_;
};

}  // namespace

GrainRows read_grains(const std::string& file) { return GrainReader(file).read(); }

void describe(Keys& keys, GrainsTable& t) {
  keys.about("Free spheres.");
  keys.name("name", t.name, "their name, which is a group too");
  keys.may("from_stage", t.from_stage, "the stage they are there from; by default from the start");
  keys.may("positions", t.positions, "their centres");
  keys.may_file("file", t.file, "a table of commas: x,y,z, and a diameter if there is a fourth column");
  keys.may("diameter", t.diameter, "of all of them [length]; needed unless the file has it", range::positive);
  keys.may("density", t.density, "[mass/length³]; gravity and dynamics need it", range::positive);
  describe_own_values(keys, t.values, false);
  keys.at_most_one({"positions", "file"});
  keys.one_at_least({"positions", "file"}, "give positions = [[x, y, z], …] or file = \"grains.csv\"");
}

void check(GrainsTable& g, Mistakes& mistakes) {
  if (g.place.written("positions") && !g.place.written("file") && !g.place.written("diameter"))
    mistakes.add(g.place, "diameter", "is missing; it must be a positive number");
}

std::optional<Grains> built(const GrainsTable& table, Mistakes& mistakes) {
  const auto read = table.positions ? GrainRows{*table.positions, {}} : mistakes.unless_wrong([&] { return read_grains(table.file); });
  if (!read) return std::nullopt;
  GrainRows rows = *read;
  if (rows.diameter.empty() != table.diameter.has_value()) {
    mistakes.add(table.place, "diameter",
                  table.diameter ? "stands in the fourth column of the file; leave it out"
                                 : "is missing; give it here, or as a fourth column of the file");
    return std::nullopt;
  }
  if (rows.diameter.empty()) rows.diameter.assign(rows.position.size(), *table.diameter);
  Grains g{table.name, Field(3, rows.position.size()), std::move(rows.diameter), table.density.value_or(0)};
  double farthest = 0;
  for (std::size_t i = 0; i < rows.position.size(); ++i) {
    g.position.col(static_cast<Eigen::Index>(i)) = rows.position[i];
    farthest = std::max(farthest, rows.position[i].cwiseAbs().maxCoeff());
  }
  const double smallest = *std::min_element(g.diameter.begin(), g.diameter.end());
  if (lost(table.place, "diameter", smallest, farthest, mistakes)) return std::nullopt;
  return g;
}

}  // namespace elamin
