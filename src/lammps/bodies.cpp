#include "lammps/bodies.hpp"

#include "core/dense.hpp"
#include "core/suggest.hpp"
#include "lammps/lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

namespace elamin {

namespace {

/// Takes the numbers one by one; the caller has counted them.
class Numbers {
 public:
  Numbers(const std::vector<double>& numbers, int vertices, std::vector<std::string>& wrong)
      : numbers_(numbers), vertices_(vertices), wrong_(wrong) {}

  double next() { return numbers_[at_++]; }
  Vec3 vector() {
    const double x = next(), y = next();
    return {x, y, next()};
  }
  /// A vertex, or −1 where that is allowed and stands there. What is neither is told, and −2.
  int vertex(const char* kind, int number, bool may_be_absent) {
    const double value = next();
    if (may_be_absent && value == -1) return -1;
    if (value >= 0 && value < vertices_ && value == std::floor(value)) return static_cast<int>(value);
    wrong_.push_back(fmt::format("{} {} names vertex {}; allowed: 0 to {}{}", kind, number, value, vertices_ - 1,
                                 may_be_absent ? ", or -1 as the fourth of a triangle" : ""));
    return -2;
  }

 private:
  const std::vector<double>& numbers_;
  int vertices_;
  std::vector<std::string>& wrong_;
  std::size_t at_ = 0;
};

/// How many numbers there are to be; of spheres and rods lists may be left out. −1: none of these.
int announced_in(const std::array<int, 3>& counts, std::size_t numbers) {
  const auto [n, e, f] = std::array<std::int64_t, 3>{counts[0], counts[1], counts[2]};
  const std::int64_t least = 7 + 3 * n, given = static_cast<std::int64_t>(numbers);
  if (given == least + 2 * e + 4 * f) return 2;                  // edges and faces
  if (n > 2) return -1;
  return given == least + 2 * e ? 1 : given == least ? 0 : -1;
}

void take_mesh(Numbers& numbers, const std::array<int, 3>& counts, int lists, CoreMesh& core) {
  for (int k = 0; k < counts[0]; ++k) core.vertices.push_back(numbers.vector());
  for (int k = 0; lists >= 1 && k < counts[1]; ++k) {
    const int a = numbers.vertex("edge", k, false);
    core.edges.push_back({a, numbers.vertex("edge", k, false)});
  }
  for (int k = 0; lists == 2 && k < counts[2]; ++k) {
    std::vector<int> face;
    for (int i = 0; i < 4; ++i)
      if (const int v = numbers.vertex("face", k, i == 3 || counts[0] <= 2); v != -1) face.push_back(v);
    core.faces.push_back(face);
  }
  if (counts[0] <= 2) core.edges.clear(), core.faces.clear();    // of a sphere or rod they say nothing
}

/// LAMMPS takes the vertices of a face in either sense: those are turned over that look towards the middle.
void turn_outward(CoreMesh& core) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& x : core.vertices) middle += x / static_cast<double>(core.vertices.size());
  for (std::vector<int>& face : core.faces) {
    Vec3 area = Vec3::Zero();
    for (std::size_t k = 0; k < face.size(); ++k)
      area += (core.vertices[face[k]] - middle).cross(core.vertices[face[(k + 1) % face.size()]] - middle);
    if (area.dot(core.vertices[face.front()] - middle) < 0) std::reverse(face.begin(), face.end());
  }
}

}  // namespace

std::string wrong_inertia(const Mat3& inertia) {
  const Vec3 moments = symmetric_eigen(inertia).values;   // ascending
  const double allowed = 1e-6 * moments.cwiseAbs().maxCoeff();
  if (moments[0] < -allowed)
    return fmt::format("the inertia has the principal moment {:.6g}; none may be negative", moments[0]);
  if (moments[2] > moments[0] + moments[1] + allowed)
    return fmt::format("the inertia has the principal moments {:.6g}, {:.6g} and {:.6g}; none may exceed the sum of the others",
                       moments[0], moments[1], moments[2]);
  return "";
}

std::optional<BodyForm> body_form(const std::array<int, 3>& counts, const std::vector<double>& numbers, std::vector<std::string>& wrong) {
  const std::size_t before = wrong.size();
  const auto [n, e, f] = std::array<std::int64_t, 3>{counts[0], counts[1], counts[2]};
  const int lists = announced_in(counts, numbers.size());
  if (lists < 0) {
    wrong.push_back(fmt::format("{} numbers are announced, but {} vertices, {} edges and {} faces take {}{}", numbers.size(), n, e, f,
                                7 + 3 * n + 2 * e + 4 * f,
                                n <= 2 ? fmt::format(", or {} without edges and faces", 7 + 3 * n) : ""));
    return std::nullopt;
  }
  Numbers rest(numbers, counts[0], wrong);
  BodyForm form;
  const Vec3 diagonal = rest.vector(), off = rest.vector();
  form.inertia << diagonal[0], off[0], off[1], off[0], diagonal[1], off[2], off[1], off[2], diagonal[2];
  take_mesh(rest, counts, lists, form.core);
  form.diameter = rest.next();
  if (!(form.diameter > 0)) wrong.push_back(fmt::format("the rounding diameter is {}; it must be positive", form.diameter));
  if (wrong.size() == before) {                                  // else what stands for the wrong numbers is wrong besides
    turn_outward(form.core);
    for (std::string& sentence : mistakes(form.core, form.diameter / 2)) wrong.push_back(std::move(sentence));
  }
  if (std::string sentence = wrong_inertia(form.inertia); !sentence.empty()) wrong.push_back(std::move(sentence));
  return wrong.size() == before ? std::optional(std::move(form)) : std::nullopt;
}

bool LammpsBodiesSection::begin(const DataLine& line) {
  ++begun_;
  line_ = line.number;
  if (!lines_.has_size(line, {3}, "Bodies", "id, how many integers (3) and how many numbers follow")) return false;
  const auto id = lines_.integer(line, 0, "Bodies: id", 1, largest_integer);
  if (line[1] == "1") {
    lines_.mistake(line, 1, "Bodies", "a body with one integer is of style nparticle or rounded/polygon, which are not available; rounded/polyhedron is");
    return false;
  }
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

namespace {

/// Sections of one row for the one atom: id and so many numbers.
const std::map<std::string, int> of_atom{{"Coords", 3}, {"Types", 1}, {"Molecules", 1}, {"Diameters", 1}, {"Masses", 1}, {"Charges", 1}};

class MoleculeReader {
 public:
  explicit MoleculeReader(const std::string& file) : lines_(file, "LAMMPS molecule file", "") {}

  LammpsMolecule read() {
    DataLine line;
    while (lines_.next(line)) {
      const bool keyword = is_word(line[0]) && line[0] != "nan" && line[0] != "inf";
      if (keyword) begin(line);
      else if (section_.empty()) header(line);
      else row(line);
    }
    check();
    lines_.finish();
    return molecule_;
  }

 private:
  void header(const DataLine& line) {
    const std::string name(line[line.size() - 1]);
    static const std::map<std::string, std::size_t> size{{"atoms", 2}, {"body", 3}, {"mass", 2}, {"com", 4}, {"inertia", 7}, {"fragments", 2}};
    const auto known = size.find(name);
    if (known == size.end() || line.size() != known->second)
      return lines_.mistake(line, 0, "header",
                            in_quotes(joined(line)) + " is not available; a molecule file of one body has \"1 atoms\", \"3 M body\" and "
                                                   "perhaps \"m mass\", \"x y z com\" and \"ixx iyy izz ixy ixz iyz inertia\"");
    if (!headers_.emplace(name, line.number).second) return lines_.mistake(line, 0, name, "stands twice in the header");
    if (name == "atoms") {
      lines_.integer(line, 0, name, 1, 1);
    } else if (name == "body") {
      lines_.integer(line, 0, "body: integers of a body rounded/polyhedron", 3, 3);
      announced_ = lines_.integer(line, 1, "body: numbers", 10, largest_integer);
    } else if (name == "mass") {
      mass(line, 0);
    } else if (name == "inertia") {
      for (int k = 0; k < 6; ++k) inertia_.push_back(lines_.number(line, k, name).value_or(0));
    } else {
      for (std::size_t k = 0; k + 1 < line.size(); ++k) lines_.number(line, k, name);
    }
  }

  void begin(const DataLine& line) {
    section_ = joined(line);
    if (section_ != "Body Integers" && section_ != "Body Doubles" && !of_atom.count(section_))
      lines_.mistake(line, 0, in_quotes(section_),
                     "this section is not available; a molecule file of one body has Body Integers and Body Doubles, and perhaps Coords, "
                     "Types, Molecules, Diameters, Charges and Masses");
    else if (!sections_.emplace(section_, line.number).second)
      lines_.mistake(line, 0, section_, fmt::format("stands twice; the first is on line {}", sections_[section_]));
    else
      return;
    section_ = "-";
  }

  void row(const DataLine& line) {
    if (section_ == "-") return;
    if (section_ == "Body Integers" || section_ == "Body Doubles") {
      for (std::size_t i = 0; i < line.size(); ++i) {
        if (section_ == "Body Integers") {
          const auto value = lines_.integer(line, i, section_, integers_.empty() ? 1 : 0, largest_integer);
          good_ = good_ && value;
          integers_.push_back(value.value_or(0));
        } else {
          const auto value = lines_.number(line, i, section_);
          good_ = good_ && value;
          numbers_.push_back(value.value_or(0));
        }
      }
      return;
    }
    const std::size_t n = 1 + static_cast<std::size_t>(of_atom.at(section_));
    if (!lines_.has_size(line, {n}, section_, n == 4 ? "id and position" : "id and number")) return;
    lines_.integer(line, 0, section_ + ": id", 1, 1);
    if (section_ == "Masses") return mass(line, 1);
    for (std::size_t i = 1; i < n; ++i) lines_.number(line, i, section_);
  }

  /// From the header or from Masses; both must be the same.
  void mass(const DataLine& line, std::size_t i) {
    const auto m = lines_.number(line, i, "mass");
    if (!m) return;
    if (!(*m > 0)) lines_.mistake(line, i, "mass", fmt::format("is {}; it must be positive", line[i]));
    else if (molecule_.mass > 0 && molecule_.mass != *m)
      lines_.mistake(line, i, "mass", fmt::format("is {} here and {} before; one body has one mass", *m, molecule_.mass));
    else molecule_.mass = *m;
  }

  void check() {
    const auto where = [&](const char* section) { return sections_.count(section) ? sections_[section] : lines_.last_line(); };
    for (const char* needed : {"atoms", "body"})
      if (!headers_.count(needed))
        lines_.mistake(lines_.last_line(), 1, "header",
                       fmt::format("does not say {}; a molecule file of one body has \"1 atoms\" and \"3 M body\"",
                                   needed == std::string("body") ? "how many integers and numbers the body has" : "how many atoms there are"));
    for (const char* needed : {"Body Integers", "Body Doubles"})
      if (!sections_.count(needed)) lines_.mistake(lines_.last_line(), 1, needed, "the file ends without this section"), good_ = false;
    if (!good_) return;
    if (integers_.size() != 3) {
      lines_.mistake(where("Body Integers"), 1, "Body Integers", fmt::format("{} integers, expected 3: vertices, edges, faces", integers_.size()));
      return;
    }
    if (announced_ && numbers_.size() != static_cast<std::size_t>(*announced_))
      lines_.mistake(where("Body Doubles"), 1, "Body Doubles",
                     fmt::format("{} numbers, but the header announces {}", numbers_.size(), *announced_));
    std::vector<std::string> wrong;
    if (auto form = body_form({integers_[0], integers_[1], integers_[2]}, numbers_, wrong)) molecule_.form = std::move(*form);
    for (const std::string& sentence : wrong) lines_.mistake(where("Body Doubles"), 1, "Body Doubles", sentence);
    if (!wrong.empty() || inertia_.empty()) return;
    const Mat3& I = molecule_.form.inertia;
    const double own[]{I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2)}, allowed = 1e-6 * I.cwiseAbs().maxCoeff();
    for (int k = 0; k < 6; ++k)
      if (std::abs(inertia_[k] - own[k]) > allowed)
        return lines_.mistake(headers_["inertia"], 1, "inertia", "differs from that of Body Doubles, which is the body's");
  }

  LammpsLines lines_;
  std::string section_;
  std::map<std::string, int> headers_, sections_;      // lines
  std::optional<int> announced_;
  std::vector<int> integers_;
  std::vector<double> numbers_, inertia_;
  bool good_ = true;
  LammpsMolecule molecule_;
};

}  // namespace

LammpsMolecule read_molecule(const std::string& file) { return MoleculeReader(file).read(); }

}  // namespace elamin
