#include "lammps/rows.hpp"

#include "core/find.hpp"
#include "core/suggest.hpp"
#include "laws/section.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <set>
#include <sstream>

namespace elamin {

namespace {

using Columns = std::vector<AtomColumn>;

const char* const styles_that_are = "available are atomic, charge, sphere, bond, angle, molecular, full, body and hybrids of them, "
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
    if (!own || words >> rest) return refuse("the atom style " + in_quotes(style) + " is not available; " + styles_that_are);
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
    if (!own) return refuse("the atom style " + in_quotes(word) + " in " + in_quotes(style) + " is not available; " + styles_that_are);
    for (const AtomColumn c : *own) {
      if (contains(columns, c))
        return refuse("two of the styles in " + in_quotes(style) + " have the same column; one of them is enough");
      columns.push_back(c);
    }
  }
  const auto has = [&](AtomColumn c) { return contains(columns, c); };
  if (has(bodyflag) && has(diameter))
    return refuse(in_quotes(style) + " is not available: one column would be a density here and a mass there; put the particles "
                                  "into one file and the bodies into another");
  if (!any)
    return refuse("\"hybrid\" alone does not say which columns there are; give the styles, such as \"hybrid sphere angle\"");
  return columns;
}

namespace {

/// The section whose number of lines is a count of the header.
const std::map<std::string, std::string> counted{
    {"Atoms", "atoms"},           {"Velocities", "atoms"},       {"Masses", "atom types"},        {"Bonds", "bonds"},
    {"Angles", "angles"},         {"Bond Coeffs", "bond types"}, {"Angle Coeffs", "angle types"}, {"Bodies", "bodies"},
    {"Atom Type Labels", "atom types"}, {"Bond Type Labels", "bond types"}, {"Angle Type Labels", "angle types"}};
/// What is not available, and its section.
const std::map<std::string, std::string> absent{
    {"dihedrals", "Dihedrals"}, {"impropers", "Impropers"}, {"ellipsoids", "Ellipsoids"}, {"lines", "Lines"}, {"triangles", "Triangles"}};
const std::set<std::string> unused{"dihedral types",        "improper types",           "extra bond per atom",
                                   "extra angle per atom",  "extra dihedral per atom",  "extra improper per atom",
                                   "extra special per atom"};

/// A section's name is made of words only; a row has numbers.
bool is_keyword(const DataLine& line) {
  return std::all_of(line.words.begin(), line.words.end(),
                     [](const auto& w) { return is_word(w.text) && w.text != "nan" && w.text != "inf"; });
}

class RowReader {
 public:
  RowReader(LammpsLines& lines, const LammpsReading& how) : lines_(lines), how_(how), style_(how.atom_style), bodies_(lines) {}

  LammpsRows read() {
    DataLine line;
    while (lines_.next(line)) {
      if (is_keyword(line)) begin_section(line);
      else if (section_.empty()) header(line);
      else row(line);
    }
    end_section();
    check_counts();
    tell_unavailable();
    return std::move(rows_);
  }

 private:
  void header(const DataLine& line) {
    const std::string one = joined(line, 1), two = joined(line, 2), three = joined(line, 3);
    const auto is_count = [&](const auto& entry) { return entry.second == one; };
    if (std::any_of(counted.begin(), counted.end(), is_count)) {
      if (const auto n = lines_.integer(line, 0, one, 0, largest_integer)) {
        if (!rows_.counts.emplace(one, *n).second) lines_.mistake(line, 0, one, "stands twice in the header");
      } else {
        rows_.counts.emplace(one, -1);
      }
    } else if (const auto found = absent.find(one); found != absent.end()) {
      if (lines_.integer(line, 0, one, 0, largest_integer).value_or(0) > 0) announced_.emplace(found->second, Announced{line, one});
    } else if (unused.count(one)) {
      lines_.integer(line, 0, one, 0, largest_integer);
    } else if (two == "xlo xhi" || two == "ylo yhi" || two == "zlo zhi") {
      const auto lo = lines_.number(line, 0, two), hi = lines_.number(line, 1, two);
      if (lo && hi && !(*lo < *hi)) lines_.mistake(line, 0, two, "the lower bound is not below the upper one");
      rows_.lo[two[0] - 'x'] = lo.value_or(0), rows_.hi[two[0] - 'x'] = hi.value_or(0);
    } else if (three == "xy xz yz") {
      for (int i = 0; i < 3; ++i) rows_.tilt[i] = lines_.number(line, i, three).value_or(0);
    } else {
      lines_.mistake(
          line, 0, "header",
          in_quotes(joined(line)) +
              " is not known; known are counts such as \"12 atoms\" (of "
              "atoms, bodies, bonds, angles and their types), \"xlo xhi\", \"ylo yhi\", \"zlo zhi\" and \"xy xz yz\"");
      if (rows_.counts.empty()) lines_.finish();          // no data file at all
    }
  }

  void end_section() {
    if (section_ != "Bodies" || !known_) return;
    if (!skip_) bodies_.end();
    rows_.bodies = std::move(bodies_.rows);
    rows_.sections[section_].rows = skip_ ? rows_.count("bodies") : bodies_.begun();   // skipped: not known
    rows_.sections[section_].sound = bodies_.sound();
  }

  void begin_section(const DataLine& line) {
    end_section();
    section_ = joined(line);
    known_ = false, skip_ = false;
    if (how_.ignores(section_)) return;
    if (!counted.count(section_)) return begin_other(line);
    if ((section_ == "Bond Coeffs" && !how_.bond_coefficients.empty()) || (section_ == "Angle Coeffs" && !how_.angle_coefficients.empty()))
      return rows_.passed_over.push_back(section_);
    known_ = true;
    const auto [it, fresh] = rows_.sections.emplace(section_, LammpsRows::Section{line.number});
    if (!fresh) {
      lines_.mistake(line, 0, section_, fmt::format("stands twice; the first is on line {}", it->second.line));
      known_ = false;
    } else if (section_ == "Atoms") {
      begin_atoms(line);
    } else if (section_ == "Bond Coeffs") {
      begin_coefficients(line, "bond");
    } else if (section_ == "Angle Coeffs") {
      begin_coefficients(line, "angle");
    }
  }

  /// A section that is not read: passed over, or a mistake that is told with all others like it.
  void begin_other(const DataLine& line) {
    const bool pairs = section_ == "Pair Coeffs" || section_ == "PairIJ Coeffs", labels = section_.ends_with(" Type Labels");
    const std::string owner = owner_of(section_);
    const bool of_none = owner != section_ && !announced_.count(owner);
    if (pairs || labels || of_none) return rows_.passed_over.push_back(section_);
    if (unavailable_.empty()) first_unavailable_ = line.number;
    if (!contains(unavailable_, section_)) unavailable_.push_back(section_);
  }

  void tell_unavailable() {
    for (const auto& [section, what] : announced_)
      if (!contains(unavailable_, section) && !how_.ignores(section))
        lines_.mistake(what.line.number, what.line.words[0].column, what.kind,
                       fmt::format("{} are not available; 0 is allowed, or ignore = [\"{}\"] in [lammps]", what.kind, section));
    if (unavailable_.empty()) return;
    std::vector<std::string> owners;
    for (const std::string& section : unavailable_)
      if (const std::string owner = owner_of(section); !contains(owners, owner))
        owners.push_back(owner);
    const bool one = unavailable_.size() == 1;
    lines_.mistake(first_unavailable_, 1, fmt::format("\"{}\"", fmt::join(unavailable_, "\", \"")),
                   fmt::format("{} not available; available are Atoms, Velocities, Masses, Bodies, Bonds, Angles, Bond Coeffs and Angle "
                               "Coeffs; without {}: ignore = [\"{}\"] in [lammps]",
                               one ? "this section is" : "these sections are", one ? "it" : "them", fmt::join(owners, "\", \"")));
  }

  /// Of "hybrid" alone the order that its rows fit: diameter, density, molecule, or molecule, diameter, density; the first one
  /// where neither fits, so that its mistakes are told. A mistake where both do.
  void tell_order(const DataLine& section) {
    const auto begin = lines_.here();
    const auto integer = [](std::string_view word) {
      return !word.empty() && std::all_of(word.begin(), word.end(), [](char c) { return c >= '0' && c <= '9'; });
    };
    bool molecule_last = true, molecule_first = true;
    std::string example;
    DataLine line;
    for (bool first = true; lines_.next(line) && !is_keyword(line); first = false) {
      if (line.size() != 8 && line.size() != 11) {
        if (first)
          refuse_section(section, fmt::format("\"hybrid\" alone does not say what these {} columns are; write the styles behind "
                                              "it, as in \"Atoms # hybrid sphere angle\", or as atom_style", line.size()));
        break;
      }
      if (first) example = fmt::format("{} {} {}", line[5], line[6], line[7]);
      molecule_last = molecule_last && integer(line[7]), molecule_first = molecule_first && integer(line[5]);
    }
    lines_.back_to(begin);
    if (skip_) return;
    if (molecule_last && molecule_first && !example.empty())
      return refuse_section(section, fmt::format("\"hybrid\" alone fits two orders of columns here: {} is diameter, density and molecule "
                                                 "of \"hybrid sphere angle\", or molecule, diameter and density of \"hybrid angle "
                                                 "sphere\"; say which, as atom_style or behind \"Atoms #\"", example));
    style_ = molecule_first && !molecule_last ? "hybrid angle sphere" : "hybrid sphere angle";
  }

  void begin_atoms(const DataLine& line) {
    if (style_.empty()) style_ = line.comment;
    if (style_.empty() && rows_.count("bodies") > 0) style_ = "body";
    if (style_ == "hybrid") tell_order(line);
    if (skip_) return;
    std::string why = "the atom style is not given; write it behind the section's name, as in \"Atoms # hybrid sphere "
                      "angle\", or as atom_style";
    if (!style_.empty()) columns_ = atom_columns(style_, &why);
    if (!columns_) refuse_section(line, why);
  }

  void begin_coefficients(const DataLine& line, const std::string& kind) {
    coefficient_style_ = std::string(line.comment);
    if (const std::string why = refused_style(kind, coefficient_style_); !why.empty())
      refuse_section(line, fmt::format("{}, or {}_coefficients in [lammps]", why, kind));
  }

  /// One mistake for the whole section: its rows are counted only.
  void refuse_section(const DataLine& line, const std::string& why) {
    lines_.mistake(line, 0, section_, why);
    rows_.sections[section_].sound = false;
    skip_ = true;
  }

  void row(const DataLine& line) {
    if (!known_) return;
    LammpsRows::Section& section = rows_.sections[section_];
    ++section.rows;
    if (!skip_ && !good_row(line)) section.sound = false;
  }

  bool good_row(const DataLine& line) {
    if (section_ == "Atoms") return atom(line);
    if (section_ == "Velocities") return velocity(line);
    if (section_ == "Masses") return mass(line);
    if (section_ == "Bodies") return skip_ = !bodies_.take(line), true;   // whether it is sound is told at its end
    if (section_ == "Bonds") return topology(line, 2, "bond types", rows_.bonds);
    if (section_ == "Angles") return topology(line, 3, "angle types", rows_.angles);
    if (section_ == "Bond Coeffs") return coefficients(line, "bond", rows_.bond_coefficients);
    if (section_.ends_with(" Type Labels")) return label(line);
    return coefficients(line, "angle", rows_.angle_coefficients);
  }

  bool has_size(const DataLine& line, std::initializer_list<std::size_t> sizes, const std::string& meaning) {
    return lines_.has_size(line, sizes, section_, meaning);
  }

  int most_types(const std::string& count) const {
    const bool known = rows_.counts.count(count) > 0 && rows_.count(count) >= 0;   // else that is the mistake to tell
    return known ? rows_.count(count) : largest_integer;
  }

  std::optional<int> type(const DataLine& line, std::size_t i, const std::string& count) {
    return type_in(lines_, line, i, section_ + ": type", most_types(count), rows_.labels[count.substr(0, count.find(' '))]);
  }

  std::optional<double> amount(const DataLine& line, std::size_t i, const std::string& what) {
    return lines_.amount(line, i, section_ + ": " + what);
  }

  bool atom(const DataLine& line) {
    const std::size_t n = columns_->size();
    if (!has_size(line, {n, n + 3}, fmt::format("atom style {}, with or without three image flags", style_))) {
      skip_ = rows_.sections[section_].rows == 1;         // the style is wrong rather than every row
      return false;
    }
    AtomRow a{line.number, 0, 0, 0, 0, 0, Vec3::Zero()};
    bool good = true;
    const auto take = [&](auto value, auto& target) { value ? void(target = *value) : void(good = false); };
    for (std::size_t i = 0; i < n; ++i) switch ((*columns_)[i]) {
      case AtomColumn::id: take(lines_.integer(line, i, "Atoms: id", 1, largest_integer), a.id); break;
      case AtomColumn::type: take(type(line, i, "atom types"), a.type); break;
      case AtomColumn::molecule: take(lines_.integer(line, i, "Atoms: molecule", 0, largest_integer), a.molecule); break;
      case AtomColumn::diameter: take(amount(line, i, "diameter"), a.diameter); break;
      case AtomColumn::density: take(amount(line, i, "density"), a.density); break;
      case AtomColumn::bodyflag: take(body_flag(lines_, line, i), a.is_body); break;
      case AtomColumn::mass: take(body_mass(lines_, line, i), a.mass); break;
      case AtomColumn::charge: {
        double charge = 0;                                // nothing here depends on it
        take(lines_.number(line, i, "Atoms: charge"), charge);
        rows_.charged = rows_.charged || charge != 0;
      } break;
      case AtomColumn::x: take(lines_.number(line, i, "Atoms: x"), a.position[0]); break;
      case AtomColumn::y: take(lines_.number(line, i, "Atoms: y"), a.position[1]); break;
      case AtomColumn::z: take(lines_.number(line, i, "Atoms: z"), a.position[2]); break;
    }
    std::array<int, 3> image{0, 0, 0};
    for (std::size_t c = 0; line.size() > n && c < 3; ++c)
      take(lines_.integer(line, n + c, "Atoms: image flag", -largest_integer, largest_integer), image[c]);
    if (good) rows_.atoms.push_back(a), rows_.images.push_back(image);
    return good;
  }

  bool velocity(const DataLine& line) {
    if (!has_size(line, {4, 7}, "id, velocity, and of spheres the angular velocity, of bodies the angular momentum")) return false;
    VelocityRow v{line.number, 0, Vec3::Zero(), Vec3::Zero(), line.size() == 7};
    const auto id = lines_.integer(line, 0, "Velocities: id", 1, largest_integer);
    bool good = id.has_value();
    for (std::size_t c = 1; c < line.size(); ++c) {
      const auto value = lines_.number(line, c, c < 4 ? "Velocities: velocity" : "Velocities: angular velocity");
      good = good && value;
      if (good) (c < 4 ? v.velocity : v.angular_velocity)[static_cast<int>(c - 1) % 3] = *value;
    }
    if (good) v.id = *id, rows_.velocities.push_back(v);
    return good;
  }

  bool mass(const DataLine& line) {
    if (!has_size(line, {2}, "type and mass")) return false;
    const auto t = type(line, 0, "atom types");
    const auto m = amount(line, 1, "mass");
    if (t && m) rows_.masses.push_back({line.number, *t, *m});
    return t && m;
  }

  bool topology(const DataLine& line, std::size_t n, const std::string& count, std::vector<TopologyRow>& rows) {
    if (!has_size(line, {n + 2}, fmt::format("number, type and the ids of {} atoms", n))) return false;
    TopologyRow r{line.number, 0, {}, {}};
    const auto t = type(line, 1, count);
    bool good = lines_.integer(line, 0, section_ + ": number", 0, largest_integer) && t;
    for (std::size_t i = 0; i < n; ++i) {
      const auto id = lines_.integer(line, i + 2, section_ + ": id", 1, largest_integer);
      if (id) r.id[i] = *id, r.column[i] = line.words[i + 2].column;
      good = good && id;
    }
    if (good) r.type = *t, rows.push_back(r);
    return good;
  }

  bool coefficients(const DataLine& line, const std::string& kind, std::vector<CoefficientRow>& rows) {
    const auto row = coefficient_row(lines_, line, kind, coefficient_style_, most_types(kind + " types"), rows_.labels[kind]);
    if (row) rows.push_back(*row), rows_.most_digits = std::max(rows_.most_digits, row->digits);
    skip_ = !row && rows_.sections[section_].rows == 1;   // another style rather than every row wrong
    return row.has_value();
  }

  bool label(const DataLine& line) {
    if (!has_size(line, {2}, "type and label")) return false;
    std::string kind = section_.substr(0, section_.find(' '));
    kind[0] = static_cast<char>(kind[0] - 'A' + 'a');
    const auto t = lines_.integer(line, 0, section_ + ": type", 1, most_types(kind + " types"));
    if (!t) return false;
    if (rows_.labels[kind].emplace(line[1], *t).second) return true;
    lines_.mistake(line, 1, section_, in_quotes(std::string(line[1])) + " stands twice");
    return false;
  }

  void check_counts() {
    const int end = lines_.last_line();
    for (const char* needed : {"atoms", "atom types"})
      if (!rows_.counts.count(needed))
        lines_.mistake(end, 1, "header", fmt::format("does not say how many {} there are", needed));
    for (const auto& [name, what] : counted) {
      const auto it = rows_.sections.find(name);
      const int expected = rows_.count(what);
      if (it != rows_.sections.end() && it->second.rows != expected) {
        it->second.sound = false;
        if (expected >= 0)                                // else that count is a mistake already
          lines_.mistake(it->second.line, 1, name,
                         fmt::format("{} {}, but the header announces {} {}", it->second.rows, name == "Bodies" ? "bodies" : "lines",
                                     expected, what));
      } else if (it == rows_.sections.end() && expected > 0 && !how_.ignores(name) &&
                 (name == "Atoms" || name == "Bodies" || name == "Bonds" || name == "Angles")) {
        lines_.mistake(end, 1, name, fmt::format("the file ends without this section; its header announces {} {}", expected, what));
      }
    }
  }

  struct Announced { DataLine line; std::string kind; };
  LammpsLines& lines_;
  const LammpsReading& how_;
  std::string style_, section_, coefficient_style_;
  std::map<std::string, Announced> announced_;   // by section: what the header says there is, and is not available
  std::vector<std::string> unavailable_;         // sections
  int first_unavailable_ = 0;                    // the line of the first
  bool known_ = false, skip_ = false;   // a section that is read; whose rows are only counted
  std::optional<std::vector<AtomColumn>> columns_;
  LammpsBodiesSection bodies_;
  LammpsRows rows_;
};

}  // namespace

LammpsRows read_lammps_rows(LammpsLines& lines, const LammpsReading& how) { return RowReader(lines, how).read(); }

std::optional<int> type_in(LammpsLines& lines, const DataLine& line, std::size_t i, const std::string& key, int most,
                           const TypeLabels& labels) {
  if (const auto found = labels.find(line[i]); found != labels.end()) return found->second;
  return lines.integer(line, i, key, 1, most);
}

namespace {

/// A style: its columns behind the type, what they mean, and the law's numbers that they make.
struct Style {
  const char *name, *first, *second, *formula;   // second "": it has one column
};

constexpr Style harmonic{"harmonic", "K", "r0", "U = K (r - r0)^2"};
constexpr Style cosine{"cosine", "K", "", "U = K (1 + cos theta)"};
constexpr Style cosine_shift{"cosine/shift", "Umin", "theta0", "U = -Umin/2 (1 + cos(theta - theta0))"};

/// The style of that name, "": the usual one; null if there is none.
const Style* style_of(const std::string& kind, const std::string& name) {
  if (kind == "bond") return name.empty() || name == harmonic.name ? &harmonic : nullptr;
  if (name == cosine_shift.name) return &cosine_shift;
  return name.empty() || name == cosine.name ? &cosine : nullptr;
}

const char* available(const std::string& kind) {
  return kind == "bond" ? "harmonic is" : "cosine and cosine/shift are";
}

/// Of a number as it is written, without zeros at its ends.
int significant_digits(std::string_view word) {
  int digits = 0, zeros = 0;
  for (const char c : word.substr(0, word.find_first_of("eE"))) {
    if (c < '0' || c > '9') continue;
    if (c == '0') zeros += digits > 0;
    else digits += zeros + 1, zeros = 0;
  }
  return digits;
}

}  // namespace

std::string refused_style(const std::string& kind, const std::string& comment) {
  if (comment == "hybrid" || style_of(kind, comment)) return "";
  return fmt::format("{} style {} is not available; {}", kind, in_quotes(comment), available(kind));
}

std::optional<CoefficientRow> coefficient_row(LammpsLines& lines, const DataLine& line, const std::string& kind,
                                              const std::string& comment, int most_types,
                                              const TypeLabels& labels) {
  const std::string section = kind == "bond" ? "Bond Coeffs" : "Angle Coeffs";
  const std::size_t first = line.size() > 1 && is_word(line[1]) ? 2 : 1;
  const std::string name = first == 2 ? std::string(line[1]) : comment == "hybrid" ? "" : comment;
  const Style* style = style_of(kind, name);
  if (!style) {
    lines.mistake(line, 1, section, fmt::format("style {} is not available; {}, or {}_coefficients in [lammps]", in_quotes(name),
                                                available(kind), kind));
    return std::nullopt;
  }
  const bool two = style->second[0] != 0;
  if (!lines.has_size(line, {first + (two ? 2 : 1)}, section,
                      fmt::format("type{} {}{} of style {}{}, {}", two ? "," : " and", style->first,
                                  two ? std::string(" and ") + style->second : "", style->name,
                                  name.empty() ? ", which is meant where none is named" : "", style->formula)))
    return std::nullopt;
  const auto type = type_in(lines, line, 0, section + ": type", most_types, labels);
  const auto K = lines.amount(line, first, section + ": " + style->first);
  const auto rest = two ? lines.amount(line, first + 1, section + ": " + style->second) : std::optional<double>(180);
  if (!type || !K || !rest) return std::nullopt;
  const int digits = std::max(significant_digits(line[first]), two ? significant_digits(line[first + 1]) : 0);
  if (kind == "bond") return CoefficientRow{line.number, *type, *K, *rest, digits};
  if (*rest > 180) {
    lines.mistake(line, first + 1, section + ": " + style->second,
                  fmt::format("{} is out of range; 0 to 180 degrees are allowed", line[first + 1]));
    return std::nullopt;
  }
  // −Umin/2 (1 + cos x) = Umin/2 (1 − cos x) − Umin
  return CoefficientRow{line.number, *type, two ? *K / 2 : *K, *rest == 180 ? pi : *rest * pi / 180, digits};
}

}  // namespace elamin
