#include "lammps/script/translation.hpp"

#include "core/suggest.hpp"
#include "lammps/script/differences.hpp"
#include "lammps/script/flat.hpp"
#include "lammps/script/protocol.hpp"
#include "lammps/script/table_list.hpp"
#include "lammps/script/table_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

namespace elamin::script {
namespace {

using Members = std::vector<int>;               // indices of World::atoms, ascending

class Translation : private TableList {
 public:
  Translation(const Reading& script, const Pass& pass, const TranslationOptions& chosen, const std::string& data_name)
      : TableList(script, pass, chosen), pass_(pass), data_name_(data_name), flat_(flat(world, particles)) {}

  Translated problem() {
    collect();
    const std::string data = particles.particles() > 0 ? data_text() : "";
    return {text(), data, std::move(notes)};
  }

  void start_from(const std::string& state) { protocol_.start_from = state; }

 private:
  bool staged() const { return runs() > 1; }
  const Atom& atom(int i) const { return world.atoms[i]; }

  // Tables -------------------------------------------------------------------------------------------------------------------

  void collect() {
    if (options.dynamics && !world.not_in_motion.empty())
      refuse(world.not_in_motion[0].where, world.not_in_motion[0].command,
             world.not_in_motion[0].what + "is not followed in motion (--dynamics); equilibria do not need it");
    for (int k = 0; k < world.run_number(); ++k) {
      const Run& run = world.runs[k];
      supports(k, run);
      for (const Run::Active& a : run.fixes) {
        if (a.fix.kind == Fix::Kind::gravity || a.fix.kind == Fix::Kind::force) load(k, a);
        if (a.fix.kind == Fix::Kind::wall) wall(k, a);
        if (a.fix.kind == Fix::Kind::viscous && options.dynamics)
          put(k, {"viscosity", "", fmt::format("group = \"{}\"\ncoefficient = {}\n", groups.of(a.members, a.fix.group, k), a.fix.coefficient),
                  a.fix.where, a.fix.text, a.fix.serial, {}, false});
      }
      if (options.dynamics) friction_rotates(run), frozen_are_heavy(run);
      put_contacts(*this, k, run);
      if (k < flat_.runs && !flat_.always && !options.dynamics) in_plane(k, run);
    }
    for (Table& t : tables) t.name = t.kind == "contact" || t.kind == "viscosity" ? "" : groups.unique(t.name);
    presence();
    sheets();
  }

  /// Friction rotates what it acts on; in LAMMPS only what is integrated as a sphere.
  void friction_rotates(const Run& run) const {
    const auto rubs = [](const auto& what) { return what.damping.find("friction = ") != std::string::npos; };
    const auto& said = run.pairs.coefficients;
    if (std::none_of(said.begin(), said.end(), rubs) &&
        std::none_of(run.fixes.begin(), run.fixes.end(), [&](const Run::Active& a) { return rubs(a.fix); }))
      return;
    for (const Run::Active& a : run.fixes)
      if (a.fix.style == "nve")
        refuse(a.fix.where, "fix", "nve rotates no particle, and friction does so here; nve/sphere is followed in motion (--dynamics)");
  }

  /// The damping of LAMMPS's contacts takes what is frozen for infinitely heavy.
  void frozen_are_heavy(const Run& run) const {
    const auto& said = run.pairs.coefficients;
    const auto knows_no_mass = [](const PairCoefficient& c) { return c.damping.empty() || c.damping.starts_with("damping = \"velocity\""); };
    if (std::all_of(said.begin(), said.end(), knows_no_mass)) return;
    for (const Run::Active& a : run.fixes)
      if (a.fix.style == "freeze")
        refuse(a.fix.where, "fix", "contacts of frozen atoms are damped as if these were infinitely heavy, which a motion (--dynamics) does "
                                   "not follow; `setforce 0 0 0` holds them with the masses that they have");
  }

  void supports(int k, const Run& run) {
    const std::array<bool, 3> whole{true, true, true};
    for (const Run::Active& a : run.fixes)
      if (a.fix.kind == Fix::Kind::move && a.fix.directions != whole && options.dynamics && !run.minimize)
        for (const Run::Active& other : run.fixes)
          if (other.fix.kind == Fix::Kind::integrate && std::any_of(a.members.begin(), a.members.end(), [&](int i) {
                return std::binary_search(other.members.begin(), other.members.end(), i);
              }))
            note(a.fix.where,
                 fmt::format("the free coordinates of these atoms are integrated twice by LAMMPS, by this fix and by {}; here once",
                             other.fix.id));
    bool drives = false;
    for (const auto& [h, members] : run.held) drives = drives || !h.velocity.isZero(0);
    for (const Run::Active& a : run.fixes) drives = drives || varies(a);
    protocol_.driven.push_back(drives);
    if (drives && protocol_.unit_time == 0) protocol_.unit_time = run.time();
    const double begin = at_, end = drives ? begin + run.time() / protocol_.unit_time : begin;
    protocol_.along.push_back(drives ? std::array{begin, end} : std::array{0.0, 1.0});
    at_ = end;
    for (const auto& [h, members] : run.held) {
      const Fix* fix = h.fix < 0 ? nullptr : &run.fixes[h.fix].fix;
      const std::string group = groups.of(members, fix ? fix->group : "still", k);
      std::string body = fmt::format("group = \"{}\"\n", group), letters;
      for (std::size_t c = 0; c < 3; ++c)
        if (h.directions[c]) letters += "xyz"[c];
      if (letters != "xyz") body += fmt::format("directions = \"{}\"\n", letters);
      if (!h.velocity.isZero(0))
        body += options.dynamics ? fmt::format("velocity = {}\n", vec(h.velocity))
                                  : fmt::format("displacement = {}\n", vec(h.velocity * protocol_.unit_time));
      put(k, {"support", fix ? fix->id : "still", body, fix ? fix->where : run.where,
              fix ? fix->text : "no fix integrates these, so that they stay where they are", fix ? fix->serial : 0, {}});
      if (!h.velocity.isZero(0)) {
        Eigen::Index c = 0;
        h.velocity.cwiseAbs().maxCoeff(&c);
        protocol_.observed.insert({group, "xyz"[c]});
      }
    }
    for (const Difference& d : differences(world, run))
      if (d.refused.empty()) note(d.where, d.what);
      else refuse(d.where, d.refused, d.what);
    if (const auto clamped = clamp_told_ ? std::nullopt : clamp(world, run)) note(clamped->where, clamped->what), clamp_told_ = true;
  }

  /// What lies in a plane at first, with nothing that pushes it out, stays there until the run in which something does.
  void in_plane(int k, const Run& run) {
    const auto c = static_cast<std::size_t>(flat_.direction);
    std::vector<bool> held(world.atoms.size());
    for (const auto& [h, members] : run.held)
      for (const int i : members) held[i] = held[i] || h.directions[c];
    Members free;
    for (const int i : run.atoms)
      if (!held[i]) free.push_back(i);
    if (free.empty()) return;
    put(k, {"support", "plane", fmt::format("group = \"{}\"\ndirections = \"{}\"\n", groups.of(free, "in_plane", k), "xyz"[c]), run.where,
            "these lie in a plane, and nothing pushes them out", 0, {}});
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
    const auto [from, to] = protocol_.along[k];
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
    if (options.dynamics && varies(a))
      refuse(a.fix.where, "fix", fmt::format("{} changes in time, which a motion (--dynamics) does not follow", a.fix.id));
    if (a.own.empty()) return load_on(k, a, a.members, a.fix.vector, a.fix.end, a.fix.group);
    constexpr std::size_t most_loads = 5000;
    std::map<std::array<double, 6>, Members> by;
    for (std::size_t i = 0; i < a.own.size(); ++i) {
      std::array<double, 6> key{};
      for (int c = 0; c < 6; ++c) {
        const Vec3 whole = (c < 3 ? a.fix.vector : a.fix.end) + a.own[i][c < 3 ? 0 : 1];
        key[c] = whole[c % 3];
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
              fmt::format("group = \"{}\"\n{} = {}\n{}", groups.of(members, wanted, k), gravity ? "acceleration" : "force", vec(v), key),
              a.fix.where, a.fix.text, a.fix.serial, {}});
    }
  }

  void wall(int k, const Run::Active& a) {
    if (options.dynamics && varies(a))
      refuse(a.fix.where, "fix", fmt::format("the region of {} moves, which a motion (--dynamics) does not follow", a.fix.id));
    for (Fix::Wall w : a.fix.walls) {
      if (w.effective_modulus == 0 && a.fix.body.empty()) continue;
      const Region defined = w.region;
      w.region = defined.moved(w.moved[0], w.grown[0]);
      // Of regions LAMMPS lets those feel nothing that are on the other side; those of wall/gran push them away, there too.
      Members members, beyond;
      for (const int i : a.members) {
        const bool known = k == 0 || atom(i).born == k;
        (!known || w.region.any_open() || atom(i).is_body || w.region.contains(atom(i).start) == w.inside ? members : beyond).push_back(i);
      }
      Region closed = w.region;
      closed.open = {};
      const auto outside = [&](int i) { return !atom(i).is_body && closed.contains(atom(i).start) != w.inside; };
      if (const auto n = std::count_if(members.begin(), members.end(), outside); w.region.any_open() && k == 0 && n > 0)
        note(a.fix.where, fmt::format("{} of {} particles are outside of this wall's region, which has open faces: LAMMPS lets them feel nothing there, here "
                                      "they feel the faces that are closed",
                                      n, a.members.size()));
      const bool either = a.fix.style == "wall/gran";
      if (!beyond.empty() && !either)
        note(a.fix.where, fmt::format("{} of {} particles are on the other side of this wall, where LAMMPS lets them feel nothing: they "
                                      "are left out of its group",
                                      beyond.size(), a.members.size()));
      if (!members.empty())
        one_wall(k, a, w, defined, w.inside, a.fix.id + w.suffix,
                 beyond.empty() ? groups.of(members, a.fix.group, k) : groups.of(members, a.fix.id + w.suffix + "_before", k));
      if (!beyond.empty() && either)
        one_wall(k, a, w, defined, !w.inside, a.fix.id + w.suffix + "_back", groups.of(beyond, a.fix.id + w.suffix + "_behind", k));
      if (w.region.shape == Shape::cone && w.region.radius_lo != w.region.radius_hi)
        note(a.fix.where, "LAMMPS leaves out of the force at a cone that its curvature changes along it; here it is the force of the energy");
      const std::size_t ends = w.region.shape == Shape::cone && w.region.axis == 1 ? 2 : 0;      // that LAMMPS pushes along z at
      if (ends > 0 && !(w.region.open[0] && w.region.open[1]) && (w.region.axial_lo > -1e20 || w.region.axial_hi < 1e20))
        note(a.fix.where, "at the ends of a cone along y LAMMPS (29 Sep 2021) pushes along z; here it is along y");
      if (!protocol_.start_from.empty() && a.fix.damping.find("\"tsuji\"") != std::string::npos)
        note(a.fix.where, "LAMMPS (29 Sep 2021) makes the damping of a tsuji wall anew from itself in each run; here it stays that of its "
                          "restitution");
      if (a.fix.trap_modulus)
        note(a.fix.where, "LAMMPS gives walls of hertz/material the modulus E/(2(1 - nu)), and contacts between particles E/(2(1 - nu^2)); that "
                          "is kept");
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
    else body += a.fix.body + (options.dynamics ? "formulation = \"lammps\"\n" : "");
    body += travel;
    if (options.dynamics) body += a.fix.damping;
    put(k, {"wall", name, body, a.fix.where, a.fix.text, a.fix.serial, {}});
  }

  // What comes and goes --------------------------------------------------------------------------------------------------------

  void presence() {
    std::map<int, Members> born, gone;
    for (const int i : particles.atoms()) {
      if (atom(i).born > 0) born[atom(i).born].push_back(i);
      if (atom(i).gone < runs()) gone[atom(i).gone].push_back(i);
    }
    for (const auto& [k, members] : born) {
      presence_text_ += fmt::format("\n[[group]]                       # made before the {} run\nname = \"{}\"\n{}from_stage = \"{}\"\n",
                                    ordinal(k + 1), groups.unique("from_" + stage(k)), groups.selection(members, k), stage(k));
    }
    for (const auto& [k, members] : gone)
      presence_text_ += fmt::format("\n[[remove]]                      # deleted before the {} run\ngroup = \"{}\"\nfrom_stage = \"{}\"\n",
                                    ordinal(k + 1), groups.of(members, "gone", k - 1), stage(k));
    for (const Removal& r : world.removals)
      if (r.run < runs())
        presence_text_ += fmt::format("\n[[remove]]                      # {} {}\ngroup = \"{}\"\nfrom_stage = \"{}\"\nwhat = \"{}\"\n",
                                      reading.short_place(r.where), r.text, groups.of(r.members, r.group, r.run), stage(r.run),
                                      r.angles ? "angles" : "bonds");
  }

  // Sheets of LAMMPSStructures ---------------------------------------------------------------------------------------------------

  /// Its sheets have B = (4/27) D where 4/(3√3) D is meant: 3√3 too little.
  void sheets() {
    for (const auto& [file, members] : world.sheets) {
      std::vector<bool> in(world.atoms.size());
      for (const int i : members) in[i] = true;
      std::set<int> types;
      for (const auto& a : world.angles)
        if (std::all_of(a.atoms.begin(), a.atoms.end(), [&](int i) { return in[i]; })) types.insert(a.type);
      if (types.empty()) continue;
      const double factor = 3 * std::sqrt(3.0);
      if (options.correct)
        for (const int t : types) stiffer_[t] = factor;
      if (!options.compat)
        notes.push_back({{0, 0}, fmt::format("{}: the bending stiffness of such sheets of LAMMPSStructures is 3 sqrt(3) = 5.2 times smaller than "
                                             "its derivation has it; {}", file,
                                             options.correct ? "it is mended here (--correct)"
                                                             : "it is kept as it is (--compat lwp keeps it without this note, --correct mends it)")});
    }
  }

  std::string data_text() {
    const std::string title = "particles of " + script_name() + ", by elamin import";
    try {
      return particles.data(title, stiffer_, options.dynamics);
    } catch (const Wrong& w) {
      refuse(world.runs.empty() ? Where{0, 1} : world.runs.front().where, "bonds", w.what());
    }
  }

  // The file -------------------------------------------------------------------------------------------------------------------

  std::string text() {
    std::string t = fmt::format("# Written by elamin import from {}", script_name());
    for (const auto& [name, value] : pass_.loops) t += fmt::format(", {} = {}", name, value);
    t += fmt::format(". Units: {}.\ntitle = \"{}\"\n", world.units, title());
    int plane = flat_.always ? flat_.direction : -1;
    for (const Run& run : world.runs)
      for (const Run::Active& a : run.fixes)
        if (a.fix.kind == Fix::Kind::plane) plane = 2;
    if (plane >= 0)
      t += fmt::format("plane = \"{}\"                       # all of it lies in this plane, and nothing pushes it out\n",
                       std::array{"yz", "xz", "xy"}[plane]);
    t += "\n[lammps]\n";
    if (particles.particles() > 0) t += fmt::format("data = \"{}\"\n", data_name_);
    if (!world.body_file.empty()) t += fmt::format("bodies = \"{}\"\n", escaped(std::filesystem::absolute(world.body_file).string()));
    t += groups.tables() + presence_text_;
    for (const char* kind : {"support", "load", "gravity", "contact", "wall", "viscosity"}) {
      int number = 0;
      for (Table& table : tables) {
        if (table.kind != kind) continue;
        ++number;
        t += "\n" + table_text(table, number);
      }
    }
    const auto meets = [](const Table& table) { return table.kind == "wall" || table.kind == "contact"; };
    protocol_.touches = std::any_of(tables.begin(), tables.end(), meets);
    return t + protocol_text(protocol_, reading, world, options);
  }

  std::string script_name() const {
    const std::string name = reading.short_place({0, 1});
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
    std::string text = fmt::format("# {} {}\n[[{}]]\n", reading.short_place(t.where), comment, t.kind);
    if (!t.name.empty()) text += fmt::format("name = \"{}\"\n", t.name);
    text += t.body;
    if (!staged() || !t.staged) return text;
    const auto first = static_cast<int>(std::find(t.in_run.begin(), t.in_run.end(), true) - t.in_run.begin());
    if (first > 0) text += fmt::format("from_stage = \"{}\"\n", stage(first));
    for (int k = first + 1; k < runs(); ++k)
      if (!t.in_run[k])
        protocol_.off[k].push_back(quoted(t.name.empty() ? fmt::format("{}.{}", t.kind, number) : fmt::format("{}.{}", t.kind, t.name)));
    return text;
  }

  const Pass& pass_;
  std::string data_name_;
  Flat flat_;
  std::string presence_text_;
  double at_ = 0;                               // the load factor behind the last driven run
  std::map<int, std::vector<Parts>> lines_;     // by the fix's serial
  Protocol protocol_;
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
          throw InputError({Mistake{reading.files[runs[k].where.file], runs[k].where.line, 1, "run",
                                    "atoms have come or gone since the run before, and a motion goes on with the same; run the one before, "
                                    "then import with --after"}});
      one.world.runs = {runs[k]};
    }
    Translation t(reading, one, options, data_names[k]);
    if (k > 0) t.start_from(folders[k - 1] + "/states/final.data");
    all.push_back(t.problem());
  }
  return all;
}

}  // namespace elamin::script
