#include "input/grains.hpp"

#include "core/error.hpp"
#include "core/text.hpp"
#include "input/csv.hpp"
#include "input/keys.hpp"
#include "input/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

namespace elamin {

namespace {

constexpr const char* const columns[]{"x", "y", "z", "diameter"};

class GrainReader {
 public:
  explicit GrainReader(const std::string& file)
      : file_(file), text_(read_data(file, "table x,y,z or x,y,z,diameter")) {}

  GrainRows read() {
    for (std::size_t at = 0; at < text_.size() && mistakes_.size() < most_mistakes;) {
      const std::size_t end = std::min(text_.find('\n', at), text_.size());
      ++line_;
      if (const auto cells = csv_cells(std::string_view(text_).substr(at, end - at)); !cells.empty()) row(cells);
      at = end + 1;
    }
    if (rows_.position.empty() && mistakes_.empty())
      mistakes_.push_back({file_, std::max(line_, 1), 1, {}, "holds no grain; a line x,y,z or x,y,z,diameter is one"});
    if (!mistakes_.empty()) throw InputError(mistakes_);
    return std::move(rows_);
  }

 private:
  void mistake(int column, const std::string& key, const std::string& what) {
    mistakes_.push_back({file_, line_, column, key, what});
  }

  void row(const std::vector<CsvCell>& cells) {
    if (first_) {
      first_ = false;
      if (names(cells)) return;
    }
    const std::size_t n = cells.size();
    if (n != 3 && n != 4)
      return mistake(1, "", fmt::format("{} columns, expected x,y,z or x,y,z,diameter", n));
    if (width_ == 0) width_ = n;
    if (n != width_)
      return mistake(1, "", fmt::format("{} columns, but the lines before have {}", n, width_));
    Vec3 x = Vec3::Zero();
    bool good = true;
    for (int c = 0; c < 3; ++c) {
      const auto value = number(cells[c], columns[c]);
      good = good && value;
      x[c] = value.value_or(0);
    }
    if (n == 4) {
      const auto d = number(cells[3], columns[3]);
      if (d && !(*d > 0))
        mistake(cells[3].column, columns[3], fmt::format("must be a positive number, is {}", *d));
      rows_.diameter.push_back(d.value_or(0));
    }
    if (good) rows_.position.push_back(x);
  }

  /// Whether these are the names of the columns rather than a grain.
  bool names(const std::vector<CsvCell>& cells) {
    if (cells.size() > 4) return false;
    for (std::size_t i = 0; i < cells.size(); ++i)
      if (cells[i].text != columns[i]) return false;
    return cells.size() >= 3;
  }

  std::optional<double> number(const CsvCell& cell, const char* key) {
    std::string why;
    const std::optional<double> value = finite_number(cell.text, why);
    if (!value) mistake(cell.column, key, why);
    return value;
  }

  const std::string& file_;
  std::string text_;
  int line_ = 0;
  bool first_ = true;
  std::size_t width_ = 0;
  GrainRows rows_;
  std::vector<Mistake> mistakes_;
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
