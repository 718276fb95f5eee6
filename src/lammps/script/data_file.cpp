// Particles and what glues them from data files.
#include "lammps/script/building.hpp"

#include "core/suggest.hpp"
#include "core/text.hpp"
#include "lammps/data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace elamin::script {
namespace command {
namespace {

bool six_digits(double v) { return std::strtod(fmt::format("{:.6g}", v).c_str(), nullptr) == v; }

/// The rows of coefficients in a data file, as the commands that say the same of the script's styles: a row `1 …` of Pair Coeffs is
/// `pair_coeff 1 1 …`. Returns whether bonds or angles have some, of six digits all of them.
bool take_coefficients(Interpreter& in, const std::string& file, const std::array<int, 3>& offset) {
  struct Section { const char* name; const char* command; Handler handler; int types; std::size_t offset; };
  static constexpr Section sections[]{{"Pair Coeffs", "pair_coeff", pair_coeff, 1, 0},
                                      {"PairIJ Coeffs", "pair_coeff", pair_coeff, 2, 0},
                                      {"Bond Coeffs", "bond_coeff", bond_coeff, 1, 1},
                                      {"Angle Coeffs", "angle_coeff", angle_coeff, 1, 2}};
  struct Back {
    Interpreter& in;
    std::vector<Word> outer;
    ~Back() { in.words = std::move(outer); }
  } back{in, in.words};
  const std::string text = elamin::read_data(file, "LAMMPS data file");
  const Section* section = nullptr;
  std::vector<Mistake> mistakes;
  bool any = false, six = true;
  int line = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::string row(std::string_view(text).substr(begin, end - begin));
    begin = end + 1, ++line;
    const std::size_t first = row.find_first_not_of(" \t\r");
    if (first == std::string::npos || line == 1) continue;
    const auto is_name = [](const Word& w) { return std::isalpha(static_cast<unsigned char>(w.text[0])) != 0; };
    if (!section && std::isalpha(static_cast<unsigned char>(row[first])) == 0) continue;
    try {
      in.words = split(without_comment(row));
      const bool names = !in.words.empty() && std::all_of(in.words.begin(), in.words.end(), is_name);
      if (names) {
        const auto found = std::find_if(std::begin(sections), std::end(sections), [&](const Section& s) { return in.text() == s.name; });
        section = found == std::end(sections) ? nullptr : found;
      }
      if (names || in.words.empty() || !section) continue;
      for (int t = 0; t < section->types; ++t)
        in.words[t].text = std::to_string(in.integer(t, 1, most_atoms) + offset[section->offset]);
      if (section->command == sections[0].command && section->types == 1) in.words.insert(in.words.begin(), in.words[0]);
      in.words.insert(in.words.begin(), Word{section->command, first});
      if (section->offset > 0)
        for (std::size_t i = 2; i < in.size(); ++i) any = true, six = six && six_digits(std::strtod(in.word(i).c_str(), nullptr));
      section->handler(in);
    } catch (const Wrong& wrong) {
      if (mistakes.size() < 20) mistakes.push_back({file, line, 1, section ? section->name : "", wrong.what()});
    }
  }
  if (!mistakes.empty()) throw InputError(std::move(mistakes));
  return any && six;
}

}  // namespace

void read_data(Interpreter& in) {
  in.wants(2, "read_data FILE …");
  World& w = in.world;
  const std::string file = in.path_of(in.word(1), 1);
  LammpsReading how{w.atom_style, {"Bond Coeffs", "Angle Coeffs"}, {}, {}};
  how.coefficients_may_lack = true;
  bool coefficients = true;
  bool add = false;
  std::optional<int> id_offset;                  // else behind those that are there
  int molecule_offset = 0;
  int group_bit = -1;
  Vec3 shift = Vec3::Zero();
  std::array<int, 3> offset{}, extra{};
  std::string group_name;
  for (std::size_t i = 2; i < in.size();) {
    const std::string& k = in.word(i);
    if (i + 1 >= in.size() && k != "nocoeff") throw Wrong(i, in_quotes(k) + " is followed by nothing");
    if (k == "add") {
      add = true, ++i;
      const auto count = [&] { return static_cast<int>(in.integer(i, 0, most_atoms)); };
      if (in.word(i) == "merge") id_offset = 0;
      else if (in.word(i) != "append") {
        id_offset = count();
        if (i + 1 < in.size() && std::isdigit(static_cast<unsigned char>(in.word(i + 1)[0]))) ++i, molecule_offset = count();
      }
      ++i;
    } else if (k == "offset" && i + 5 < in.size()) {
      for (std::size_t c = 0; c < 3; ++c) offset[c] = static_cast<int>(in.integer(i + 1 + c, 0, most_atoms));
      i += 6;
    } else if (k == "shift" && i + 3 < in.size()) shift = Vec3(in.number(i + 1), in.number(i + 2), in.number(i + 3)), i += 4;
    else if (k == "group") group_name = in.word(i + 1), i += 2;
    else if (k == "nocoeff") coefficients = false, ++i;
    else if (k.starts_with("extra/")) {
      const int n = static_cast<int>(in.integer(i + 1, 0, 1000000));
      if (k == "extra/atom/types") extra[0] = n;
      if (k == "extra/bond/types") extra[1] = n;
      if (k == "extra/angle/types") extra[2] = n;
      i += 2;
    } else
      throw Wrong(i, in_quotes(k) + " is no keyword of read_data that is taken; add append, offset, shift, group, nocoeff and extra/… are",
                  true);
  }
  if (w.has_box && !add) throw Wrong(0, "there is a box already; `add append` adds to it");
  const LammpsData data = read_lammps_data(file, how);
  const LammpsData::Header& header = data.header;
  in.reading.data_files.push_back(file);
  std::array<Vec3, 2> sides{header.lo + shift, header.hi + shift};
  for (int c = 0; c < 3 && w.has_box; ++c) sides[0][c] = std::min(sides[0][c], w.side(c, 0)), sides[1][c] = std::max(sides[1][c], w.side(c, 1));
  w.set_box(sides);
  int largest = 0;
  for (const int t : data.type) largest = std::max(largest, t);
  for (const Body& b : data.bodies) largest = std::max(largest, b.type);
  const auto grow = [](int& now, int by, int extra_types) { now = std::max(now, by) + extra_types; };
  grow(w.atom_types, std::max(largest, header.atom_types) + offset[0], extra[0]);
  grow(w.bond_types, header.bond_types + offset[1], extra[1]);
  grow(w.angle_types, header.angle_types + offset[2], extra[2]);
  w.mass.resize(w.atom_types);
  w.bond_coefficients.resize(w.bond_types), w.angle_coefficients.resize(w.angle_types);
  if (coefficients && take_coefficients(in, file, offset))
    in.note(
        "the coefficients in this data file have six digits, as write_data writes them: loads at which things buckle may be off by 0.3 %; "
        "bond_coeff and angle_coeff behind read_data give all digits");
  if (!group_name.empty()) {
    const auto found = w.find_group(group_name);
    group_bit = found ? *found : static_cast<int>(w.groups.size());
    if (group_bit >= 32) throw Wrong(0, "makes the 33rd group; LAMMPS has 32 at most");
    if (!found) w.groups.push_back(group_name);
  }
  if (add && !id_offset) {                       // append
    id_offset = 0;
    for (const Atom& a : w.atoms)
      if (World::there(a)) id_offset = std::max(*id_offset, a.id), molecule_offset = std::max(molecule_offset, a.molecule);
  }
  const auto put = [&](int id, int type, const Vec3& x) -> Atom& {
    Atom a;
    if (id + static_cast<long long>(id_offset.value_or(0)) > static_cast<long long>(most_atoms))
      throw Wrong(1, fmt::format("an id is above {}", most_atoms));
    a.id = id + id_offset.value_or(0), a.type = type + offset[0], a.x = a.start = x + shift, a.born = w.run_number();
    if (group_bit >= 0) a.groups |= 1u << group_bit;
    if (a.id >= static_cast<int>(w.of_id.size())) w.of_id.resize(a.id + 1, -1);
    if (w.of_id[a.id] >= 0) throw Wrong(1, fmt::format("holds an atom {}, which is there already", a.id));
    w.of_id[a.id] = static_cast<int>(w.atoms.size());
    return w.atoms.emplace_back(a);
  };
  const auto base = static_cast<int>(w.atoms.size());
  for (std::size_t k = 0; k < data.id.size(); ++k) {
    Atom& a = put(data.id[k], data.type[k], data.position.col(static_cast<Eigen::Index>(k)));
    a.molecule = data.molecule[k] + molecule_offset, a.diameter = data.diameter[k], a.density = data.density[k];
    if (data.velocity.cols() > 0) a.v = data.velocity.col(static_cast<Eigen::Index>(k));
    if (data.angular_velocity.cols() > 0) a.omega = data.angular_velocity.col(static_cast<Eigen::Index>(k));
    if (!w.sphere && data.mass.size() > k) w.mass[a.type - 1] = data.mass[k];
  }
  for (const Bond& b : data.bonds)
    w.bonds.push_back({b.type + 1 + offset[1], {b.particles[0] + base, b.particles[1] + base}, w.run_number()});
  for (const Angle& a : data.angles)
    w.angles.push_back({a.type + 1 + offset[2], {a.particles[0] + base, a.particles[1] + base, a.particles[2] + base}, w.run_number()});
  if (data.bodies.empty()) return w.shrink_box();
  if (!w.body_file.empty()) throw Wrong(1, "bodies come from one data file", true);
  w.body_file = file, w.bodies = true;
  for (std::size_t b = 0; b < data.bodies.size(); ++b)
    put(data.bodies[b].id, data.bodies[b].type, data.body_position.col(static_cast<Eigen::Index>(b))).is_body = true;
  w.shrink_box();
}

}  // namespace command

void take_positions(Interpreter& in, const std::string& file) {
  const LammpsData data = read_lammps_data(file, "");
  World& w = in.world;
  std::vector<bool> found(w.atoms.size());
  std::vector<int> later;                          // a state of several stages holds what a later one makes, too
  for (std::size_t k = 0; k < data.id.size(); ++k) {
    const int id = data.id[k];
    const int i = id < static_cast<int>(w.of_id.size()) ? w.of_id[id] : -1;
    if (i < 0) later.push_back(id);
    else w.atoms[i].x = data.position.col(static_cast<Eigen::Index>(k)), found[i] = true;
  }
  for (std::size_t i = 0; i < w.atoms.size(); ++i)
    if (World::there(w.atoms[i]) && !found[i] && !w.atoms[i].is_body)
      throw Wrong(0, fmt::format("{} does not hold the atom {}, which is there behind this run", in_quotes(file), w.atoms[i].id));
  if (data.velocity.cols() > 0 && !data.velocity.isZero(0))
    in.note(fmt::format("the velocities of {} are left out: what goes on from there begins at rest", in_quotes(file)));
  if (!later.empty())
    in.note(fmt::format("{} holds {} atoms, from {} on, that are not there behind this run: they are left out", in_quotes(file), later.size(), later.front()));
}

}  // namespace elamin::script
