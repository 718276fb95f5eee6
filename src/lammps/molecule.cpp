#include "lammps/molecule.hpp"

#include "lammps/lines.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <map>

namespace elamin {
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
