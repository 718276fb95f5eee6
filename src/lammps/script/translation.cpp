#include "lammps/script/translation.hpp"

#include "core/suggest.hpp"
#include "laws/section.hpp"
#include "lammps/script/particles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>

namespace elamin::script {
namespace {

using Members = std::vector<int>;               // indices of World::atoms, ascending

std::string vec(const Vec3& v) { return fmt::format("[{}, {}, {}]", v[0] + 0.0, v[1] + 0.0, v[2] + 0.0); }
std::string quoted(const std::string& s) { return '"' + s + '"'; }

/// A list over several lines where it is long.
std::string list_of(const std::vector<std::string>& items) {
  std::string text = "[";
  std::size_t line = 7;
  for (std::size_t k = 0; k < items.size(); ++k) {
    if (line + items[k].size() > 130) text += "\n  ", line = 2;
    text += items[k] + (k + 1 < items.size() ? ", " : "");
    line += items[k].size() + 2;
  }
  return text + "]";
}

/// A table of the file that may be in force in some of the runs.
struct Table {
  std::string kind, name, body;                 // "wall"; the keys behind its name
  Where where;
  std::string comment;
  int serial = 0;
  std::vector<bool> in_run;
  bool staged = true;
};

class Translation {
 public:
  Translation(const Reading& reading, const Pass& pass, const TranslationOptions& options, const std::string& data_name)
      : reading_(reading), pass_(pass), world_(pass.world), options_(options), data_name_(data_name), particles_(world_) {}

  Translated problem() {
    collect();
    result_.data = particles_.particles() > 0 ? data_text() : "";
    result_.toml = text();
    return std::move(result_);
  }

  std::string start_from;                       // a state that a motion goes on from

 private:
  int runs() const { return std::max(1, world_.run_number()); }
  bool staged() const { return runs() > 1; }
  const Atom& atom(int i) const { return world_.atoms[static_cast<std::size_t>(i)]; }
  static std::string stage(int k) { return "run" + std::to_string(k + 1); }
  void note(const Where& w, const std::string& text) {
    for (const Note& n : result_.notes)
      if (n.text == text && n.where == w) return;
    result_.notes.push_back({w, text});
  }
  [[noreturn]] void refuse(const Where& w, const std::string& key, const std::string& what) const {
    throw InputError({Mistake{reading_.files[static_cast<std::size_t>(w.file)], w.line, 1, key, what}});
  }

  std::string unique(std::string name) {
    for (char& c : name)
      if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-') c = '_';
    if (name.empty()) name = "some";
    const auto reserved = [](const std::string& w) {
      return w == "all" || w == "lammps" || (w.starts_with("type") && w.find_first_not_of("0123456789", 4) == std::string::npos);
    };
    if (name.size() > 58) name.resize(58);
    if (!std::isalpha(static_cast<unsigned char>(name[0])) && name[0] != '_') name = "_" + name;
    if (reserved(name)) name += "_";
    std::string n = name;
    for (int k = 2; !names_.insert(n).second; ++k) n = fmt::format("{}_{}", name, k);
    return n;
  }

  // Groups -------------------------------------------------------------------------------------------------------------------

  /// The name of the group of these atoms, as they are in a run.
  std::string group_of(const Members& members, const std::string& wanted, int run) {
    if (wanted == "all") return "all";
    if (const auto found = groups_.find(members); found != groups_.end()) return found->second;
    const std::string name = unique(wanted);
    group_text_ += fmt::format("\n[[group]]\nname = \"{}\"\n{}", name, selection(members, run));
    return groups_[members] = name;
  }

  /// The keys of a group that choose these: types where they are all that there are of them, else ids.
  std::string selection(const Members& members, int run) const {
    std::set<int> types;
    for (const int i : members) types.insert(atom(i).type);
    const bool whole = std::all_of(alive(run).begin(), alive(run).end(), [&](int i) {
      return !types.count(atom(i).type) || std::binary_search(members.begin(), members.end(), i);
    });
    std::vector<std::string> items;
    if (whole) {
      for (const int t : types) items.push_back(fmt::format("\"type{}\"", t));
      return fmt::format("of = {}\n", list_of(items));
    }
    std::vector<int> ids;
    for (const int i : members) ids.push_back(particles_.id(i));
    std::sort(ids.begin(), ids.end());
    for (const int id : ids) items.push_back(std::to_string(id));
    return fmt::format("ids = {}\n", list_of(items));
  }

  std::string group_of_types(const std::vector<int>& types) {
    if (types == particles_.types()) return "all";
    if (types.size() == 1) return "type" + std::to_string(types[0]);
    if (const auto found = type_groups_.find(types); found != type_groups_.end()) return found->second;
    std::vector<std::string> items, parts;
    for (const int t : types) items.push_back(fmt::format("\"type{}\"", t)), parts.push_back(std::to_string(t));
    const std::string name = unique(types.size() < 5 ? fmt::format("types_{}", fmt::join(parts, "_"))
                                                     : fmt::format("types_{}_to_{}", types.front(), types.back()));
    group_text_ += fmt::format("\n[[group]]\nname = \"{}\"\nof = {}\n", name, list_of(items));
    return type_groups_[types] = name;
  }

  const Members& alive(int run) const {
    return world_.runs.empty() ? particles_.atoms() : world_.runs[static_cast<std::size_t>(run)].atoms;
  }

  // Tables -------------------------------------------------------------------------------------------------------------------

  /// The table is in force in a run; the same one as in the run before if nothing of it differs.
  void put(int run, Table t) {
    const auto same = std::find_if(tables_.begin(), tables_.end(), [&](const Table& o) {
      return o.kind == t.kind && o.serial == t.serial && o.body == t.body && o.where == t.where && o.comment == t.comment;
    });
    Table& table = same == tables_.end() ? tables_.emplace_back(std::move(t)) : *same;
    table.in_run.resize(static_cast<std::size_t>(runs()));
    table.in_run[static_cast<std::size_t>(run)] = true;
  }

  void collect() {
    for (int k = 0; k < world_.run_number(); ++k) {
      const Run& run = world_.runs[static_cast<std::size_t>(k)];
      supports(k, run);
      for (const Run::Active& a : run.fixes) {
        if (a.fix.kind == Fix::Kind::gravity || a.fix.kind == Fix::Kind::force) load(k, a);
        if (a.fix.kind == Fix::Kind::wall) wall(k, a);
        if (a.fix.kind == Fix::Kind::viscous && options_.dynamics)
          put(k, {"viscosity",
                  "",
                  fmt::format("group = \"{}\"\ncoefficient = {}\n", group_of(a.members, a.fix.group, k), a.fix.coefficient),
                  a.fix.where,
                  a.fix.text,
                  a.fix.serial,
                  {},
                  false});
      }
      contacts(k, run);
    }
    for (Table& t : tables_) t.name = t.kind == "contact" || t.kind == "viscosity" ? "" : unique(t.name);
    presence();
    sheets();
  }

  static Vec3 only(const Vec3& v, const std::array<bool, 3>& directions) {
    Vec3 r = Vec3::Zero();
    for (std::size_t c = 0; c < 3; ++c)
      if (directions[c]) r[static_cast<Eigen::Index>(c)] = v[static_cast<Eigen::Index>(c)];
    return r;
  }

  /// What holds a particle along its coordinates, and how fast.
  struct Held {
    std::array<bool, 3> directions{};
    Vec3 velocity = Vec3::Zero();
    int fix = -1;                               // of Run::fixes; −1: nothing integrates it
    auto key() const { return std::tuple(fix, directions, velocity[0], velocity[1], velocity[2]); }
    bool operator<(const Held& o) const { return key() < o.key(); }
  };

  void supports(int k, const Run& run) {
    const std::size_t n = world_.atoms.size();
    std::vector<char> integrated(n, run.minimize);
    for (const Run::Active& a : run.fixes)
      if (a.fix.kind == Fix::Kind::integrate || a.fix.kind == Fix::Kind::move)
        for (const int i : a.members) integrated[static_cast<std::size_t>(i)] = 1;
    std::vector<std::vector<Held>> held(n);
    const std::array<bool, 3> whole{true, true, true};
    for (const int i : run.atoms)
      if (!integrated[static_cast<std::size_t>(i)]) held[static_cast<std::size_t>(i)].push_back({whole, Vec3::Zero(), -1});
    for (std::size_t f = 0; f < run.fixes.size(); ++f) {
      const Run::Active& a = run.fixes[f];
      const bool moves = a.fix.kind == Fix::Kind::move;
      if (a.fix.kind != Fix::Kind::hold && !(moves && !run.minimize)) continue;
      for (const int i : a.members) {
        auto& list = held[static_cast<std::size_t>(i)];
        if (!list.empty() && list[0].fix < 0 && !moves) continue;
        const bool stands = run.still() || run.minimize || (!moves && a.fix.style == "freeze");
        const Vec3 v = stands ? Vec3(Vec3::Zero()) : moves ? a.fix.vector : atom(i).v;
        for (Held& h : list)                    // the later fix has the last word
          for (std::size_t c = 0; c < 3; ++c)
            if (a.fix.directions[c]) h.directions[c] = false, h.velocity[static_cast<Eigen::Index>(c)] = 0;
        std::erase_if(list, [](const Held& h) { return h.directions == std::array<bool, 3>{}; });
        if (a.fix.directions != std::array<bool, 3>{}) list.push_back({a.fix.directions, only(v, a.fix.directions), static_cast<int>(f)});
      }
      if (moves && a.fix.directions != whole && options_.dynamics)
        for (const Run::Active& other : run.fixes)
          if (other.fix.kind == Fix::Kind::integrate && std::any_of(a.members.begin(), a.members.end(), [&](int i) {
                return std::binary_search(other.members.begin(), other.members.end(), i);
              }))
            note(a.fix.where,
                 fmt::format("the free coordinates of these atoms are integrated twice by LAMMPS, by this fix and by {}; here once",
                             other.fix.id));
    }
    std::map<Held, Members> by;
    for (const int i : run.atoms)
      for (const Held& h : held[static_cast<std::size_t>(i)]) by[h].push_back(i);
    bool drives = false;
    for (const auto& [h, members] : by) drives = drives || !h.velocity.isZero(0);
    for (const Run::Active& a : run.fixes) drives = drives || varies(a);
    driven_.push_back(drives);
    if (drives && unit_time_ == 0) unit_time_ = run.time();
    const double begin = at_, end = drives ? begin + run.time() / unit_time_ : begin;
    along_.push_back(drives ? std::array{begin, end} : std::array{0.0, 1.0});
    at_ = end;
    for (const auto& [h, members] : by) {
      const Fix* fix = h.fix < 0 ? nullptr : &run.fixes[static_cast<std::size_t>(h.fix)].fix;
      const std::string group = group_of(members, fix ? fix->group : "still", k);
      std::string body = fmt::format("group = \"{}\"\n", group), letters;
      for (std::size_t c = 0; c < 3; ++c)
        if (h.directions[c]) letters += "xyz"[c];
      if (letters != "xyz") body += fmt::format("directions = \"{}\"\n", letters);
      if (!h.velocity.isZero(0))
        body += options_.dynamics ? fmt::format("velocity = {}\n", vec(h.velocity))
                                  : fmt::format("displacement = {}\n", vec(h.velocity * unit_time_));
      put(k, {"support", fix ? fix->id : "still", body, fix ? fix->where : run.where,
              fix ? fix->text : "no fix integrates these, so that they stay where they are", fix ? fix->serial : 0, {}});
      if (!h.velocity.isZero(0)) {
        Eigen::Index c = 0;
        h.velocity.cwiseAbs().maxCoeff(&c);
        observed_.insert({group, "xyz"[c]});
      }
    }
    clamps(run, by);
  }

  /// A note on the length of what is clamped by two particles or more.
  void clamps(const Run& run, const std::map<Held, Members>& by) {
    if (clamp_told_) return;
    for (const auto& [h, members] : by) {
      if (h.directions != std::array{true, true, true} || members.size() == run.atoms.size()) continue;
      for (const auto& b : world_.bonds) {
        const auto holds = [&](int i) { return std::binary_search(members.begin(), members.end(), i); };
        if (!holds(b.atoms[0]) || !holds(b.atoms[1])) continue;
        clamp_told_ = true;
        return note(h.fix < 0 ? run.where : run.fixes[static_cast<std::size_t>(h.fix)].fix.where,
                    "bonded particles are held beside each other: a clamp. It sits in the middle of the innermost held bond, so that a "
                    "beam of N free "
                    "particles bends over N + 2 spacings (docs/column.md)");
      }
    }
  }

  /// Whether the run changes what the fix does.
  static bool varies(const Run::Active& a) {
    return (a.fix.vector != a.fix.end && a.fix.kind != Fix::Kind::move) ||
           std::any_of(a.own.begin(), a.own.end(), [](const auto& f) { return f[0] != f[1]; }) ||
           std::any_of(a.fix.walls.begin(), a.fix.walls.end(),
                       [](const Fix::Wall& w) { return w.moved[0] != w.moved[1] || w.grown[0] != w.grown[1]; });
  }

  /// What goes from one value to another during a run, as a constant part and what the load factor scales.
  struct Parts { Vec3 fixed, rate; };
  /// Of a fix that goes on along the line of an earlier run, the same parts, so that its table goes on, too.
  Parts parts(int k, const Fix& fix, const Vec3& begin, const Vec3& end) {
    const auto [from, to] = along_[static_cast<std::size_t>(k)];
    const auto ends_at = [&](const Parts& p, double at, const Vec3& value) {
      const double size = (p.fixed.cwiseAbs() + at * p.rate.cwiseAbs()).maxCoeff();
      return (p.fixed + at * p.rate - value).cwiseAbs().maxCoeff() <= 8e-15 * size;   // rounding of a formula and of this
    };
    for (const Parts& p : lines_[fix.serial])
      if (ends_at(p, from, begin) && ends_at(p, to, end)) return p;
    return lines_[fix.serial].emplace_back(line(from, to, begin, end));
  }
  static Parts line(double from, double to, const Vec3& begin, const Vec3& end) {
    Parts p{begin, (end - begin) / (to - from)};
    if (from == 0) return p;
    p.fixed -= from * p.rate;
    for (int c = 0; c < 3; ++c)                   // the difference is rounding alone: three operations
      if (std::abs(p.fixed[c]) <= 2e-15 * std::max(std::abs(begin[c]), std::abs(end[c]))) p.fixed[c] = 0;
    return p;
  }

  void load(int k, const Run::Active& a) {
    if (options_.dynamics && varies(a))
      refuse(a.fix.where, "fix", fmt::format("{} changes in time, which a motion (--dynamics) does not follow", a.fix.id));
    if (a.own.empty()) return load_on(k, a, a.members, a.fix.vector, a.fix.end, a.fix.group);
    constexpr std::size_t most_loads = 5000;
    std::map<std::array<double, 6>, Members> by;
    for (std::size_t i = 0; i < a.own.size(); ++i) {
      std::array<double, 6> key{};
      for (int c = 0; c < 6; ++c) {
        const Vec3 whole = (c < 3 ? a.fix.vector : a.fix.end) + a.own[i][c < 3 ? 0 : 1];
        key[static_cast<std::size_t>(c)] = whole[c % 3];
      }
      by[key].push_back(a.members[i]);
    }
    if (by.size() > most_loads)
      refuse(a.fix.where, "fix", fmt::format("{} has {} different forces; at most {} become loads", a.fix.id, by.size(), most_loads));
    for (const auto& [f, members] : by)
      load_on(k, a, members, Vec3(f[0], f[1], f[2]), Vec3(f[3], f[4], f[5]), by.size() == 1 ? a.fix.group : a.fix.id + "_part");
  }

  void load_on(int k, const Run::Active& a, const Members& members, const Vec3& begin, const Vec3& end, const std::string& wanted) {
    const bool gravity = a.fix.kind == Fix::Kind::gravity;
    const Parts p = begin == end ? Parts{begin, Vec3::Zero()} : parts(k, a.fix, begin, end);
    for (const bool constant : {true, false}) {
      const Vec3& v = constant ? p.fixed : p.rate;
      if (v.isZero(0)) continue;
      const char* key = gravity == constant ? "" : constant ? "constant = true\n" : "constant = false\n";
      put(k, {gravity ? "gravity" : "load", a.fix.id,
              fmt::format("group = \"{}\"\n{} = {}\n{}", group_of(members, wanted, k), gravity ? "acceleration" : "force", vec(v), key),
              a.fix.where, a.fix.text, a.fix.serial, {}});
    }
  }

  void wall(int k, const Run::Active& a) {
    if (options_.dynamics && varies(a))
      refuse(a.fix.where, "fix", fmt::format("the region of {} moves, which a motion (--dynamics) does not follow", a.fix.id));
    for (Fix::Wall w : a.fix.walls) {
      if (w.effective_modulus == 0 && a.fix.body.empty()) continue;
      const Region defined = w.region;
      w.region = defined.moved(w.moved[0], w.grown[0]);
      // Of regions LAMMPS lets those feel nothing that are on the other side; planes of wall/gran push them away, there too.
      Members members, beyond;
      for (const int i : a.members) {
        const bool known = k == 0 || atom(i).born == k;
        (!known || w.region.any_open() || atom(i).is_body || w.region.contains(atom(i).start) == w.inside ? members : beyond).push_back(i);
      }
      const bool either = a.fix.style == "wall/gran" && w.region.shape == Shape::plane;
      if (!beyond.empty() && !either)
        note(a.fix.where, fmt::format("{} of {} particles are on the other side of this wall, where LAMMPS lets them feel nothing: they "
                                      "are left out of its group",
                                      beyond.size(), a.members.size()));
      if (!members.empty())
        one_wall(k, a, w, defined, w.inside, a.fix.id + w.suffix,
                 beyond.empty() ? group_of(members, a.fix.group, k) : group_of(members, a.fix.id + w.suffix + "_before", k));
      if (!beyond.empty() && either)
        one_wall(k, a, w, defined, !w.inside, a.fix.id + w.suffix + "_back", group_of(beyond, a.fix.id + w.suffix + "_behind", k));
      if (w.region.shape == Shape::cone && w.region.radius_lo != w.region.radius_hi)
        note(a.fix.where,
             "LAMMPS leaves out of the force at a cone that its curvature changes along it; here it is the force of the energy");
      if (a.fix.trap_modulus)
        note(
            a.fix.where,
            "LAMMPS gives walls of hertz/material the modulus E/(2(1 - nu)), and contacts between particles E/(2(1 - nu^2)); that is kept");
    }
  }

  void one_wall(int k, const Run::Active& a, const Fix::Wall& w, const Region& defined, bool inside, const std::string& name,
                const std::string& group) {
    std::string body = fmt::format("group = \"{}\"\n", group), travel;
    if (w.moved[0] == w.moved[1] && w.grown[0] == w.grown[1]) body += region_text(w.region, inside);
    else {
      const Parts way = parts(k, a.fix, w.moved[0], w.moved[1]), growth = parts(k, a.fix, Vec3(w.grown[0], 0, 0), Vec3(w.grown[1], 0, 0));
      body += region_text(defined.moved(way.fixed, growth.fixed[0]), inside);
      if (!way.rate.isZero(0)) travel += fmt::format("displacement = {}\n", vec(way.rate));
      if (growth.rate[0] != 0) travel += fmt::format("radius_change = {}\n", growth.rate[0]);
    }
    const bool round = w.region.shape != Shape::plane && w.region.shape != Shape::block;
    if (a.fix.body.empty())
      body += fmt::format("effective_modulus = {}\n", w.effective_modulus) + (round ? "effective_radius = \"curved\"\n" : "");
    else body += a.fix.body + (options_.dynamics ? "formulation = \"lammps\"\n" : "");
    body += travel;
    if (options_.dynamics) body += a.fix.damping;
    put(k, {"wall", name, body, a.fix.where, a.fix.text, a.fix.serial, {}});
  }

  static std::string region_text(const Region& r, bool inside) {
    static constexpr const char* shapes[]{"plane", "block", "cylinder", "sphere", "cone"};
    std::string t = fmt::format("shape = \"{}\"\n", shapes[static_cast<int>(r.shape)]);
    if (!inside) t += "side = \"outside\"\n";
    std::vector<std::string> open;
    static constexpr const char *of_block[]{"xlo", "xhi", "ylo", "yhi", "zlo", "zhi"}, *of_tube[]{"lo", "hi", "side"};
    for (std::size_t f = 0; f < 6; ++f)
      if (r.open[f]) open.push_back(quoted(r.shape == Shape::block ? of_block[f] : of_tube[std::min<std::size_t>(f, 2)]));
    switch (r.shape) {
      case Shape::plane: t += fmt::format("point = {}\nnormal = {}\n", vec(r.center), vec(r.normal)); break;
      case Shape::block: t += fmt::format("lo = {}\nhi = {}\n", vec(r.lo), vec(r.hi)); break;
      case Shape::sphere: t += fmt::format("center = {}\nradius = {}\n", vec(r.center), r.radius); break;
      case Shape::cylinder:
      case Shape::cone:
        t += fmt::format("axis = \"{}\"\ncenter = {}\n", "xyz"[r.axis], vec(r.center));
        t += r.shape == Shape::cylinder ? fmt::format("radius = {}\n", r.radius)
                                        : fmt::format("radius_lo = {}\nradius_hi = {}\n", r.radius_lo, r.radius_hi);
        if (r.axial_lo > -1e20) t += fmt::format("lo = {}\n", r.axial_lo);
        if (r.axial_hi < 1e20) t += fmt::format("hi = {}\n", r.axial_hi);
        break;
    }
    if (!open.empty()) t += fmt::format("open = {}\n", list_of(open));
    return t;
  }

  // Contacts -----------------------------------------------------------------------------------------------------------------

  /// How many bonds the pairs are apart, at most, that feel nothing; `why` is the sentence if no number says it.
  static int excluded(const std::array<double, 3>& lj, const std::array<double, 3>& coul, bool granular, bool& partial) {
    int deepest = 0;
    bool gap = false;
    for (std::size_t c = 0; c < 3; ++c) {
      const bool out = lj[c] == 0 && (!granular || coul[c] == 0);
      if (out && deepest == static_cast<int>(c)) deepest = static_cast<int>(c) + 1;
      else if (out) gap = true;
      if (!out && lj[c] != 1) partial = true;
    }
    return gap ? -1 : deepest;
  }

  std::string contact_keys(const PairCoefficient& c, const PairStyle& style, const Run& run) {
    using Law = PairCoefficient::Law;
    std::string keys;
    if (c.law == Law::hertz) {
      keys = c.effective_modulus || c.youngs_modulus == 0
                 ? fmt::format("effective_modulus = {}\n", c.effective_modulus.value_or(0))
                 : fmt::format("youngs_modulus = {}\npoissons_ratio = {}\n", c.youngs_modulus, c.poissons_ratio);
      if (options_.dynamics) keys += c.damping;
    } else if (c.law == Law::lj) {
      keys = fmt::format("law = \"lj\"\nepsilon = {}\nsigma = {}\ncutoff = {}\n", c.epsilon, c.sigma, c.cutoff);
      if (c.inner_cutoff > 0) keys += fmt::format("cutoff_style = \"smooth\"\ninner_cutoff = {}\n", c.inner_cutoff);
      else if (style.shift) keys += "cutoff_style = \"shifted\"\n";
    } else {
      keys = fmt::format("law = \"rounded\"\nk_n = {}\nk_na = {}\ncutoff = {}\n", c.k_n, c.k_na, style.cut_inner);
      if (options_.dynamics)
        keys += fmt::format("formulation = \"lammps\"\ndelta_ua = {}\nmu = {}\nc_n = {}\nc_t = {}\n", style.delta_ua, style.mu, style.c_n,
                            style.c_t);
      else
        note(
            c.where,
            "LAMMPS's forces of rounded bodies have no potential; equilibria are those of the sum over features (formulation = \"multi\")");
      return keys;
    }
    if (world_.bonds.empty()) return keys;
    bool partial = false;
    const int bonds = excluded(run.special_lj, run.special_coul, c.law == Law::hertz, partial);
    if (bonds < 0 || (partial && c.law == Law::lj))
      refuse(
          run.where, "special_bonds",
          fmt::format("the weights {} {} {} cannot be said of such contacts; 0 for the first neighbours along bonds and 1 for the rest can",
                      run.special_lj[0], run.special_lj[1], run.special_lj[2]));
    if (partial)
      note(c.where,
           "weights of special_bonds between 0 and 1 are ignored by granular contacts: LAMMPS takes them in full, and so does this");
    return keys + fmt::format("exclude_bonds = {}\n", bonds);
  }

  static bool nothing(const PairCoefficient& c) {
    if (c.law == PairCoefficient::Law::hertz) return c.effective_modulus.value_or(c.youngs_modulus) == 0;
    return c.law == PairCoefficient::Law::lj ? c.epsilon == 0 || c.cutoff == 0 || c.sigma == 0 : false;
  }

  void contacts(int k, const Run& run) {
    using Law = PairCoefficient::Law;
    std::vector<PairCoefficient> list = run.pairs.coefficients;
    for (PairCoefficient& m : mixed(run)) list.push_back(std::move(m));
    std::vector<const PairCoefficient*> acting;
    for (const PairCoefficient& c : list) {
      if (c.law == Law::none) continue;
      const auto within = [&](const std::array<int, 2>& r) {
        std::vector<int> types;
        for (const int t : particles_.types(c.law == Law::rounded))
          if (r[0] <= t && t <= r[1]) types.push_back(t);
        return types;
      };
      const std::vector<int> I = within(c.first), J = within(c.second);
      if (I.empty() || J.empty()) continue;
      if (nothing(c)) {                         // tells only where something acts already
        bool over = false;
        for (const PairCoefficient* a : acting)
          for (const int i : I)
            for (const int j : J) over = over || (a->law == c.law && i <= j && a->covers(i, j));
        if (!over) continue;
      } else acting.push_back(&c);
      PairCoefficient shown = c;
      if (nothing(c) && c.law == Law::lj)
        shown.epsilon = 0, shown.sigma = c.sigma > 0 ? c.sigma : 1, shown.cutoff = c.cutoff > 0 ? c.cutoff : 1;
      const PairStyle* style = style_of(run, c.law);
      const std::string keys = contact_keys(shown, *style, run);
      if (c.law == Law::lj && !nothing(c) && !style->shift)
        note(c.where, c.inner_cutoff > 0
                          ? "the energy of this cohesion is 0 at the cutoff; LAMMPS's is that with `pair_modify shift yes`, else it differs by a "
                            "constant of each pair. Forces are the same"
                          : "the energy of this cohesion jumps where it is cut off, as LAMMPS's does (cutoff_style = \"cut\"); \"shifted\" "
                            "and \"smooth\" do not");
      const auto add = [&](const std::vector<int>& a, const std::vector<int>& b) {
        put(k, {"contact",
                "",
                fmt::format("between = [\"{}\", \"{}\"]\n", group_of_types(a), group_of_types(b)) + keys,
                c.where,
                c.text,
                0,
                {}});
      };
      // LAMMPS sets pairs I ≤ J; a table of two groups means both ways.
      bool symmetric = true;
      for (const int i : I)
        for (const int j : J) symmetric = symmetric && (i <= j || c.covers(j, i));
      if (symmetric) add(I, J);
      else
        for (const int i : I) {
          std::vector<int> up;
          std::copy_if(J.begin(), J.end(), std::back_inserter(up), [&](int j) { return j >= i; });
          if (!up.empty()) add({i}, up);
        }
    }
  }

  static const PairStyle* style_of(const Run& run, PairCoefficient::Law law) {
    using Law = PairCoefficient::Law;
    for (const PairStyle& s : run.pairs.styles)
      if ((law == Law::lj) == s.name.starts_with("lj/") && (law == Law::rounded) == s.name.starts_with("body")) return &s;
    return &run.pairs.styles.front();
  }

  /// Pairs of unlike types that no line names: mixed of those of like types, as LAMMPS does.
  std::vector<PairCoefficient> mixed(const Run& run) const {
    using Law = PairCoefficient::Law;
    std::vector<PairCoefficient> all;
    const std::vector<int>& types = particles_.types();
    for (const Law law : {Law::hertz, Law::lj, Law::rounded}) {
      const auto last = [&](int i, int j) -> const PairCoefficient* {
        const PairCoefficient* found = nullptr;
        for (const PairCoefficient& c : run.pairs.coefficients)
          if (c.law == law && c.covers(i, j)) found = &c;
        return found;
      };
      const PairStyle& style = *style_of(run, law);
      for (std::size_t a = 0; a < types.size(); ++a)
        for (std::size_t b = a + 1; b < types.size(); ++b) {
          const auto named = [&](const PairCoefficient& c) { return c.covers(types[a], types[b]); };
          const auto& said = run.pairs.coefficients;
          if (last(types[a], types[b])) continue;
          if ((run.pairs.hybrid || run.pairs.overlay) && std::any_of(said.begin(), said.end(), named)) continue;   // of any style, or none
          const PairCoefficient *p = last(types[a], types[a]), *q = last(types[b], types[b]);
          if (!p || !q) continue;
          PairCoefficient m = *q;
          m.first = {types[a], types[a]}, m.second = {types[b], types[b]};
          m.text = "mixed of types " + std::to_string(types[a]) + " and " + std::to_string(types[b]);
          const auto mean = [&](double x, double y) { return style.mix == PairStyle::Mix::geometric ? std::sqrt(x * y) : (x + y) / 2; };
          if (law == Law::hertz) {
            if (p->effective_modulus && q->effective_modulus)
              m.effective_modulus = std::sqrt(*p->effective_modulus * *q->effective_modulus);
            else if (!p->effective_modulus && !q->effective_modulus && (p->youngs_modulus == 0 || q->youngs_modulus == 0))
              m.youngs_modulus = 0;
            else if (!p->effective_modulus && !q->effective_modulus) {
              const auto soft = [](const PairCoefficient& c) { return (1 - c.poissons_ratio * c.poissons_ratio) / c.youngs_modulus; };
              m.effective_modulus = 1 / (soft(*p) + soft(*q));
            } else continue;
            m.damping.clear();
          } else if (law == Law::lj) {
            if (style.mix == PairStyle::Mix::sixthpower) {
              const double s = std::pow(p->sigma, 6) + std::pow(q->sigma, 6);
              m.epsilon = s > 0 ? 2 * std::sqrt(p->epsilon * q->epsilon) * std::pow(p->sigma * q->sigma, 3) / s : 0;
              m.sigma = std::pow(s / 2, 1.0 / 6), m.cutoff = std::pow((std::pow(p->cutoff, 6) + std::pow(q->cutoff, 6)) / 2, 1.0 / 6);
              m.inner_cutoff = std::pow((std::pow(p->inner_cutoff, 6) + std::pow(q->inner_cutoff, 6)) / 2, 1.0 / 6);
            } else {
              m.epsilon = std::sqrt(p->epsilon * q->epsilon), m.sigma = mean(p->sigma, q->sigma), m.cutoff = mean(p->cutoff, q->cutoff);
              m.inner_cutoff = mean(p->inner_cutoff, q->inner_cutoff);
            }
          } else m.k_n = std::sqrt(p->k_n * q->k_n), m.k_na = std::sqrt(p->k_na * q->k_na);
          all.push_back(std::move(m));
        }
    }
    return all;
  }

  // What comes and goes --------------------------------------------------------------------------------------------------------

  void presence() {
    std::map<int, Members> born, gone;
    for (const int i : particles_.atoms()) {
      if (atom(i).born > 0) born[atom(i).born].push_back(i);
      if (atom(i).gone < runs()) gone[atom(i).gone].push_back(i);
    }
    for (const auto& [k, members] : born) {
      presence_text_ += fmt::format("\n[[group]]                       # made before the {} run\nname = \"{}\"\n{}from_stage = \"{}\"\n",
                                    ordinal(k + 1), unique("from_" + stage(k)), selection(members, k), stage(k));
    }
    for (const auto& [k, members] : gone)
      presence_text_ += fmt::format("\n[[remove]]                      # deleted before the {} run\ngroup = \"{}\"\nfrom_stage = \"{}\"\n",
                                    ordinal(k + 1), group_of(members, "gone", k - 1), stage(k));
    for (const Removal& r : world_.removals)
      if (r.run < runs())
        presence_text_ += fmt::format("\n[[remove]]                      # {} {}\ngroup = \"{}\"\nfrom_stage = \"{}\"\nwhat = \"{}\"\n",
                                      reading_.short_place(r.where), r.text, group_of(r.members, r.group, r.run), stage(r.run),
                                      r.angles ? "angles" : "bonds");
  }

  static std::string ordinal(int k) { return std::to_string(k) + (k == 1 ? "st" : k == 2 ? "nd" : k == 3 ? "rd" : "th"); }

  // Sheets of LAMMPSStructures ---------------------------------------------------------------------------------------------------

  /// Its sheets have B = (4/27) D where 4/(3√3) D is meant: 3√3 too little.
  void sheets() {
    for (const auto& [file, members] : world_.sheets) {
      std::vector<bool> in(world_.atoms.size());
      for (const int i : members) in[static_cast<std::size_t>(i)] = true;
      std::set<int> types;
      for (const auto& a : world_.angles)
        if (std::all_of(a.atoms.begin(), a.atoms.end(), [&](int i) { return in[static_cast<std::size_t>(i)]; })) types.insert(a.type);
      if (types.empty()) continue;
      const double factor = 3 * std::sqrt(3.0);
      if (options_.correct)
        for (const int t : types) stiffer_[t] = factor;
      if (!options_.compat)
        result_.notes.push_back(
            {{0, 0},
             fmt::format("{}: the bending stiffness of such sheets of LAMMPSStructures is 3 sqrt(3) = 5.2 times smaller than its "
                         "derivation has it; {}",
                         file,
                         options_.correct ? "it is mended here (--correct)"
                                          : "it is kept as it is (--compat lwp keeps it without this note, --correct mends it)")});
    }
  }

  std::string data_text() {
    const std::string title = "particles of " + script_name() + ", by elamin import";
    try {
      return particles_.data(title, stiffer_, options_.dynamics);
    } catch (const Wrong& w) {
      refuse(world_.runs.empty() ? Where{0, 1} : world_.runs.front().where, "bonds", w.what());
    }
  }

  // A plane --------------------------------------------------------------------------------------------------------------------

  /// The coordinate that nothing moves out of its plane, or −1.
  int flat() const {
    if (particles_.bodies() > 0 || particles_.particles() == 0) return -1;
    for (int c = 0; c < 3; ++c) {
      const double at = atom(particles_.atoms().front()).start[c];
      const auto keeps = [&](const Run::Active& a) {
        const Fix& f = a.fix;
        if (f.kind == Fix::Kind::gravity || f.kind == Fix::Kind::force || f.kind == Fix::Kind::move)
          return f.vector[c] == 0 && f.end[c] == 0 &&
                 std::all_of(a.own.begin(), a.own.end(), [&](const auto& own) { return own[0][c] == 0 && own[1][c] == 0; });
        return f.kind != Fix::Kind::wall ||
               std::all_of(f.walls.begin(), f.walls.end(), [&](const Fix::Wall& w) { return symmetric(w, c, at); });
      };
      bool flat = std::all_of(particles_.atoms().begin(), particles_.atoms().end(),
                              [&](int i) { return atom(i).start[c] == at && atom(i).v[c] == 0; });
      for (const Run& run : world_.runs)
        flat = flat && std::all_of(run.fixes.begin(), run.fixes.end(), [&](const Run::Active& a) { return keeps(a); });
      if (flat) return c;
    }
    return -1;
  }

  /// Whether a wall pushes nothing out of the plane x_c = at.
  bool symmetric(const Fix::Wall& w, int c, double at) const {
    if (w.moved[0][c] != 0 || w.moved[1][c] != 0) return false;
    const Region& r = w.region;
    double most = 0;
    for (const int i : particles_.atoms()) most = std::max(most, atom(i).diameter / 2);
    const auto faces = [&](double lo, double hi) { return hi - at == at - lo || (at - lo >= most && hi - at >= most); };
    switch (r.shape) {
      case Shape::plane: return r.normal[c] == 0 || (at - r.center[c]) * r.normal[c] >= most;
      case Shape::block: return w.inside && !r.any_open() && faces(r.lo[c], r.hi[c]);
      case Shape::sphere: return r.center[c] == at;
      case Shape::cylinder:
      case Shape::cone:
        return r.axis == c ? w.inside && !r.any_open() && r.shape == Shape::cylinder && faces(r.axial_lo, r.axial_hi) : r.center[c] == at;
    }
    return false;
  }

  // The file -------------------------------------------------------------------------------------------------------------------

  std::string text() {
    std::string t = fmt::format("# Written by elamin import from {}", script_name());
    for (const auto& [name, value] : pass_.loops) t += fmt::format(", {} = {}", name, value);
    t += fmt::format(". Units: {}.\ntitle = \"{}\"\n", world_.units, title());
    int plane = flat();
    for (const Run& run : world_.runs)
      for (const Run::Active& a : run.fixes)
        if (a.fix.kind == Fix::Kind::plane) plane = 2;
    if (plane >= 0)
      t += fmt::format("plane = \"{}\"                       # all of it lies in this plane, and nothing pushes it out\n", plane == 0 ? "yz"
                                                                                                                           : plane == 1
                                                                                                                               ? "xz"
                                                                                                                               : "xy");
    t += "\n[lammps]\n";
    if (particles_.particles() > 0) t += fmt::format("data = \"{}\"\n", data_name_);
    if (!world_.body_file.empty()) t += fmt::format("bodies = \"{}\"\n", escaped(std::filesystem::absolute(world_.body_file).string()));
    t += group_text_ + presence_text_;
    for (const char* kind : {"support", "load", "gravity", "contact", "wall", "viscosity"}) {
      int number = 0;
      for (Table& table : tables_) {
        if (table.kind != kind) continue;
        ++number;
        t += "\n" + table_text(table, number);
      }
    }
    return t + study();
  }

  static std::string escaped(const std::string& s) {
    std::string r;
    for (const char c : s) {
      if (c == '"' || c == '\\') r += '\\';
      r += static_cast<unsigned char>(c) < 32 ? ' ' : c;
    }
    return r;
  }

  std::string script_name() const {
    const std::string name = reading_.short_place({0, 1});
    return escaped(name.substr(0, name.rfind(':')));
  }

  std::string title() const {
    std::string name = script_name();
    for (const auto& [n, value] : pass_.loops) name += ", " + n + " = " + value;
    return name;
  }

  std::string table_text(const Table& t, int number) {
    std::string comment = t.comment;
    if (comment.size() > 100) comment = comment.substr(0, 97) + "...";
    while (!comment.empty() && (static_cast<unsigned char>(comment.back()) & 0xC0) == 0x80) comment.pop_back();
    std::string text = fmt::format("# {} {}\n[[{}]]\n", reading_.short_place(t.where), comment, t.kind);
    if (!t.name.empty()) text += fmt::format("name = \"{}\"\n", t.name);
    text += t.body;
    if (!staged() || !t.staged) return text;
    const auto first = static_cast<int>(std::find(t.in_run.begin(), t.in_run.end(), true) - t.in_run.begin());
    if (first > 0) text += fmt::format("from_stage = \"{}\"\n", stage(first));
    for (int k = first + 1; k < runs(); ++k)
      if (!t.in_run[static_cast<std::size_t>(k)])
        off_[k].push_back(quoted(t.name.empty() ? fmt::format("{}.{}", t.kind, number) : fmt::format("{}.{}", t.kind, t.name)));
    return text;
  }

  std::string study() {
    std::string t;
    if (world_.runs.empty()) return "\n[study]                          # the script runs nothing\ntype = \"energy\"\n";
    if (world_.runs.front().still())
      return fmt::format("\n# {} {}\n[study]\ntype = \"energy\"\n", reading_.short_place(world_.runs.front().where), world_.runs.front().text);
    if (options_.dynamics) {
      const Run& run = world_.runs.front();
      if (!start_from.empty()) t += fmt::format("\n[path]\nstart = \"{}\"\n", escaped(start_from));
      t += fmt::format("\n# {} {}\n[study]\ntype = \"dynamics\"\n\n[dynamics]\n", reading_.short_place(run.where), run.text);
      if (run.minimize) return t + "relax = true\nsteps = 1000000\n" + observations();
      return t +
             fmt::format("timestep = {}\nsteps = {}\nevery = {}\nallow_unstable = true           # the script's timestep, whatever it is\n",
                         run.timestep, std::min(run.steps, 2000000000LL), std::max(1LL, run.steps / 100)) +
             observations();
    }
    if (!staged()) {
      const Run& run = world_.runs.front();
      t += fmt::format("\n# {} {}\n", reading_.short_place(run.where), run.text);
      if (driven_.front())
        t += fmt::format(
            "[path]                           # load factor 1: after {} of LAMMPS's time\nsteps = 100\nwhen_unstable = \"jump\"\n",
            run.time());
      else t += "[study]\ntype = \"equilibrium\"\n";
      return t + observations();
    }
    t += "\n[path]\nsteps = 100\nwhen_unstable = \"jump\"\n";
    for (int k = 0; k < runs(); ++k) {
      const Run& run = world_.runs[static_cast<std::size_t>(k)];
      t += fmt::format("\n# {} {}\n[[stage]]\nname = \"{}\"\n", reading_.short_place(run.where), run.text, stage(k));
      if (const auto off = off_.find(k); off != off_.end()) t += fmt::format("off = {}\n", list_of(off->second));
      if (!driven_[static_cast<std::size_t>(k)]) {
        t += "from = 0\nto = 1\nsteps = 1\n";
        continue;
      }
      const auto [from, to] = along_[static_cast<std::size_t>(k)];
      t += fmt::format("from = {}\nto = {}                            # 1: {} of LAMMPS's time\n", from, to, unit_time_);
    }
    return t + observations();
  }

  std::string observations() {
    std::string t;
    for (const auto& [group, axis] : observed_)
      t += fmt::format("\n[[observe]]\nname = \"force_{}_{}\"\ngroup = \"{}\"\nquantity = \"reaction.{}\"\n", group, axis, group, axis);
    return t;
  }

  const Reading& reading_;
  const Pass& pass_;
  const World& world_;
  TranslationOptions options_;
  std::string data_name_;
  Particles particles_;
  Translated result_;
  std::vector<Table> tables_;
  std::map<Members, std::string> groups_;
  std::map<std::vector<int>, std::string> type_groups_;
  std::set<std::string> names_;
  std::string group_text_, presence_text_;
  std::vector<bool> driven_;                    // of each run
  double unit_time_ = 0, at_ = 0;               // of load factor 1; the load factor behind the last driven run
  std::vector<std::array<double, 2>> along_;    // the load factor as each run begins and ends
  std::map<int, std::vector<Parts>> lines_;     // by the fix's serial
  std::map<int, std::vector<std::string>> off_;
  std::set<std::pair<std::string, char>> observed_;
  std::map<int, double> stiffer_;
  bool clamp_told_ = false;
};

}  // namespace

Translated translated(const Reading& reading, const Pass& pass, const TranslationOptions& options, const std::string& data_name) {
  return Translation(reading, pass, options, data_name).problem();
}

std::vector<Translated> in_time(const Reading& reading, const Pass& pass, const TranslationOptions& options,
                                const std::vector<std::string>& data_names, const std::vector<std::string>& folders) {
  std::vector<Translated> all;
  const std::vector<Run>& runs = pass.world.runs;
  for (std::size_t k = 0; k < std::max<std::size_t>(1, runs.size()); ++k) {
    Pass one = pass;
    if (!runs.empty()) {
      const auto number = static_cast<int>(k);
      for (const Atom& a : pass.world.atoms)
        if (number > 0 && (a.born == number || a.gone == number))
          throw InputError({Mistake{reading.files[static_cast<std::size_t>(runs[k].where.file)], runs[k].where.line, 1, "run",
                                    "atoms have come or gone since the run before, and a motion goes on with the same; run the one before, "
                                    "then import with --after"}});
      one.world.runs = {runs[k]};
    }
    Translation t(reading, one, options, data_names[k]);
    if (k > 0) t.start_from = folders[k - 1] + "/states/final.data";
    all.push_back(t.problem());
  }
  return all;
}

}  // namespace elamin::script
