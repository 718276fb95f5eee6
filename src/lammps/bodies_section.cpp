#include "lammps/bodies_section.hpp"

#include <fmt/format.h>

#include <limits>

namespace elamin {
namespace {
}

bool LammpsBodiesSection::begin(const DataLine& line) {
  ++begun_;
  line_ = line.number;
  if (!lines_.has_size(line, {3}, "Bodies", "id, how many integers (3) and how many numbers follow")) return false;
  const auto id = lines_.integer(line, 0, "Bodies: id", 1, largest_integer);
  const auto integers = lines_.integer(line, 1, "Bodies: integers of a body rounded/polyhedron", 3, 3);
  const auto expected = lines_.integer(line, 2, "Bodies: numbers of a body", 10, largest_integer);
  if (!integers || !expected) return false;
  open_ = true, good_ = id.has_value(), id_ = id.value_or(0), expected_ = *expected;
  counts_.clear(), numbers_.clear();
  return true;
}

bool LammpsBodiesSection::take(const DataLine& line) {
  if (!open_) {
    sound_ = begin(line) && sound_;
    return open_;
  }
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (counts_.size() < 3) {
      const char* const names[]{"Bodies: vertices", "Bodies: edges", "Bodies: faces"};
      const auto count = lines_.integer(line, i, names[counts_.size()], counts_.empty() ? 1 : 0, largest_integer);
      good_ = good_ && count;
      counts_.push_back(count.value_or(0));
    } else if (numbers_.size() == static_cast<std::size_t>(expected_)) {
      lines_.mistake(line, i, "Bodies",
                     fmt::format("more than the {} numbers that line {} announces; a body begins on a line of its own", expected_, line_));
      return sound_ = open_ = false;
    } else {
      const auto number = lines_.number(line, i, "Bodies: number");
      good_ = good_ && number;
      numbers_.push_back(number.value_or(0));
    }
  }
  if (numbers_.size() == static_cast<std::size_t>(expected_)) finish();
  return true;
}

void LammpsBodiesSection::finish() {
  open_ = false;
  std::vector<std::string> wrong;
  if (good_) {
    if (auto form = body_form({counts_[0], counts_[1], counts_[2]}, numbers_, wrong))
      return rows.push_back({line_, id_, std::move(*form)});
    for (const std::string& sentence : wrong) lines_.mistake(line_, 1, fmt::format("Bodies: body {}", id_), sentence);
  }
  sound_ = false;
}

void LammpsBodiesSection::end() {
  if (!open_) return;
  open_ = sound_ = false;
  lines_.mistake(line_, 1, "Bodies",
                 fmt::format("the body ends after {} integers and {} numbers; announced are 3 and {}", counts_.size(),
                             numbers_.size(), expected_));
}

std::optional<bool> body_flag(LammpsLines& lines, const DataLine& line, std::size_t i) {
  const auto flag = lines.integer(line, i, "Atoms: bodyflag", 0, 1);
  if (!flag) return std::nullopt;
  if (*flag == 1) return true;
  lines.mistake(line, i, "Atoms: bodyflag",
                "0 makes it a point without size, which is not available; put particles into a file of their own, with diameters");
  return std::nullopt;
}

std::optional<double> body_mass(LammpsLines& lines, const DataLine& line, std::size_t i) {
  const auto mass = lines.number(line, i, "Atoms: mass");
  if (!mass || *mass > 0) return mass;
  lines.mistake(line, i, "Atoms: mass", fmt::format("is {}; it must be positive", line[i]));
  return std::nullopt;
}

}  // namespace elamin
