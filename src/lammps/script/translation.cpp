#include "lammps/script/translation.hpp"

#include "core/suggest.hpp"
#include "lammps/script/differences.hpp"
#include "lammps/script/flat.hpp"
#include "lammps/script/group_names.hpp"
#include "lammps/script/mixing.hpp"
#include "lammps/script/particles.hpp"
#include "lammps/script/protocol.hpp"
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
      : reading_(reading), pass_(pass), world_(pass.world), options_(options), data_name_(data_name), particles_(world_),
        groups_(world_, particles_), flat_(flat(world_, particles_)) {}

  Translated problem() {
    collect();
    result_.data = particles_.particles() > 0 ? data_text() : "";
    result_.toml = text();
    return std::move(result_);
  }

  void start_from(const std::string& state) { protocol_.start_from = state; }

 private:
  int runs() const { return std::max(1, world_.run_number()); }
  bool staged() const { return runs() > 1; }
  const Atom& atom(int i) const { return world_.atoms[static_cast<std::size_t>(i)]; }
  void note(const Where& w, const std::string& text) {
    for (const Note& n : result_.notes)
      if (n.text == text && n.where == w) return;
    result_.notes.push_back({w, text});
  }
  [[noreturn]] void refuse(const Where& w, const std::string& key, const std::string& what) const {
    throw InputError({Mistake{reading_.files[static_cast<std::size_t>(w.file)], w.line, 1, key, what}});
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
    if (options_.dynamics && !world_.not_in_motion.empty())
      refuse(world_.not_in_motion[0].first, world_.not_in_motion[0].second,
             "is not followed in motion (--dynamics); equilibria do not need it");
    for (int k = 0; k < world_.run_number(); ++k) {
      const Run& run = world_.runs[static_cast<std::size_t>(k)];
      supports(k, run);
      for (const Run::Active& a : run.fixes) {
        if (a.fix.kind == Fix::Kind::gravity || a.fix.kind == Fix::Kind::force) load(k, a);
        if (a.fix.kind == Fix::Kind::wall) wall(k, a);
        if (a.fix.kind == Fix::Kind::viscous && options_.dynamics)
          put(k, {"viscosity",
                  "",
                  fmt::format("group = \"{}\"\ncoefficient = {}\n", groups_.of(a.members, a.fix.group, k), a.fix.coefficient),
                  a.fix.where,
                  a.fix.text,
                  a.fix.serial,
                  {},
                  false});
      }
      if (options_.dynamics) friction_rotates(run);
      contacts(k, run);
      if (k < flat_.runs && !flat_.always && !options_.dynamics) in_plane(k, run);
    }
    for (Table& t : tables_) t.name = t.kind == "contact" || t.kind == "viscosity" ? "" : groups_.unique(t.name);
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

  void supports(int k, const Run& run) {
    const std::array<bool, 3> whole{true, true, true};
    for (const Run::Active& a : run.fixes)
      if (a.fix.kind == Fix::Kind::move && a.fix.directions != whole && options_.dynamics && !run.minimize)
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
      const Fix* fix = h.fix < 0 ? nullptr : &run.fixes[static_cast<std::size_t>(h.fix)].fix;
      const std::string group = groups_.of(members, fix ? fix->group : "still", k);
      std::string body = fmt::format("group = \"{}\"\n", group), letters;
      for (std::size_t c = 0; c < 3; ++c)
        if (h.directions[c]) letters += "xyz"[c];
      if (letters != "xyz") body += fmt::format("directions = \"{}\"\n", letters);
      if (!h.velocity.isZero(0))
        body += options_.dynamics ? fmt::format("velocity = {}\n", vec(h.velocity))
                                  : fmt::format("displacement = {}\n", vec(h.velocity * protocol_.unit_time));
      put(k, {"support", fix ? fix->id : "still", body, fix ? fix->where : run.where,
              fix ? fix->text : "no fix integrates these, so that they stay where they are", fix ? fix->serial : 0, {}});
      if (!h.velocity.isZero(0)) {
        Eigen::Index c = 0;
        h.velocity.cwiseAbs().maxCoeff(&c);
        protocol_.observed.insert({group, "xyz"[c]});
      }
    }
    for (const Difference& d : differences(world_, run))
      if (d.refused.empty()) note(d.where, d.what);
      else refuse(d.where, d.refused, d.what);
    if (const auto clamped = clamp_told_ ? std::nullopt : clamp(world_, run)) note(clamped->where, clamped->what), clamp_told_ = true;
  }

  /// What lies in a plane at first, with nothing that pushes it out, stays there until the run in which something does.
  void in_plane(int k, const Run& run) {
    const auto c = static_cast<std::size_t>(flat_.direction);
    std::vector<bool> held(world_.atoms.size());
    for (const auto& [h, members] : run.held)
      for (const int i : members) held[static_cast<std::size_t>(i)] = held[static_cast<std::size_t>(i)] || h.directions[c];
    Members free;
    for (const int i : run.atoms)
      if (!held[static_cast<std::size_t>(i)]) free.push_back(i);
    if (free.empty()) return;
    put(k, {"support", "plane", fmt::format("group = \"{}\"\ndirections = \"{}\"\n", groups_.of(free, "in_plane", k), "xyz"[c]), run.where,
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
    const auto [from, to] = protocol_.along[static_cast<std::size_t>(k)];
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
              fmt::format("group = \"{}\"\n{} = {}\n{}", groups_.of(members, wanted, k), gravity ? "acceleration" : "force", vec(v), key),
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
                 beyond.empty() ? groups_.of(members, a.fix.group, k) : groups_.of(members, a.fix.id + w.suffix + "_before", k));
      if (!beyond.empty() && either)
        one_wall(k, a, w, defined, !w.inside, a.fix.id + w.suffix + "_back", groups_.of(beyond, a.fix.id + w.suffix + "_behind", k));
      if (w.region.shape == Shape::cone && w.region.radius_lo != w.region.radius_hi)
        note(a.fix.where,
             "LAMMPS leaves out of the force at a cone that its curvature changes along it; here it is the force of the energy");
      const std::size_t ends = w.region.shape == Shape::cone && w.region.axis == 1 ? 2 : 0;      // that LAMMPS pushes along z at
      if (ends > 0 && !(w.region.open[0] && w.region.open[1]) && (w.region.axial_lo > -1e20 || w.region.axial_hi < 1e20))
        note(a.fix.where, "at the ends of a cone along y LAMMPS (29 Sep 2021) pushes along z; here it is along y");
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

  // Contacts -----------------------------------------------------------------------------------------------------------------

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
    if (c.law == Law::hertz && bonds > 0)
      note(run.where, "granular contacts of LAMMPS (29 Sep 2021) do not know special_bonds: bonded particles that overlap push each other there. "
                      "Here they are left out; exclude_bonds = 0 in [[contact]] takes them in");
    return keys + fmt::format("exclude_bonds = {}\n", bonds);
  }

  /// Pairs that neigh_modify leaves out: tables without force behind those of the run.
  void exclusions(int k, const Run& run, const std::vector<const PairCoefficient*>& acting) {
    using Law = PairCoefficient::Law;
    int behind = 0;                               // the last table of this run; where it is another one, they come anew
    for (std::size_t t = 0; t < tables_.size(); ++t)
      if (tables_[t].kind == "contact" && tables_[t].in_run[static_cast<std::size_t>(k)]) behind = static_cast<int>(t) + 1;
    for (const Run::Excluded& e : run.excluded)
      for (const Law law : {Law::hertz, Law::lj, Law::rounded}) {
        if (std::none_of(acting.begin(), acting.end(), [&](const PairCoefficient* c) { return c->law == law; })) continue;
        if (law == Law::rounded) refuse(e.where, "neigh_modify", "pairs of rounded bodies are not left out here; exclude is of particles");
        PairCoefficient none;
        none.law = law, none.effective_modulus = 0, none.sigma = none.cutoff = 1, none.where = e.where;
        put(k, {"contact",
                "",
                fmt::format("between = [\"{}\", \"{}\"]\n", groups_.of(e.members[0], "excluded", k),
                            groups_.of(e.members[1], "excluded", k)) +
                    contact_keys(none, *style_of(run, law), run),
                e.where,
                e.text,
                behind,
                {}});
      }
  }

  void contacts(int k, const Run& run) {
    using Law = PairCoefficient::Law;
    std::vector<PairCoefficient> list = run.pairs.coefficients;
    for (PairCoefficient& m : mixed(run, particles_.types())) list.push_back(std::move(m));
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
      if (options_.dynamics && c.unlike && !nothing(c))
        refuse(c.where, "pair_coeff", fmt::format("damping and friction of types {} and {} differ and are not mixed here; give a pair_coeff {} {}", c.first[0],
                                                  c.second[0], c.first[0], c.second[0]));
      if (c.mixed && !nothing(c) && style->name == "granular")
        note(c.where, "LAMMPS (29 Sep 2021) gives types that have no pair_coeff together Hooke's force k delta with Hertz's k, not Hertz's force of the mixed "
                      "coefficients that its documentation promises; here it is that");
      if (c.law == Law::lj && !nothing(c) && !style->shift)
        note(c.where, c.inner_cutoff > 0
                          ? "the energy of this cohesion is 0 at the cutoff; LAMMPS's is that with `pair_modify shift yes`, else it differs by a "
                            "constant of each pair. Forces are the same"
                          : "the energy of this cohesion jumps where it is cut off, as LAMMPS's does (cutoff_style = \"cut\"); \"shifted\" "
                            "and \"smooth\" do not");
      const auto add = [&](const std::vector<int>& a, const std::vector<int>& b) {
        put(k, {"contact",
                "",
                fmt::format("between = [\"{}\", \"{}\"]\n", groups_.of_types(a), groups_.of_types(b)) + keys,
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
    exclusions(k, run, acting);
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
                                    ordinal(k + 1), groups_.unique("from_" + stage(k)), groups_.selection(members, k), stage(k));
    }
    for (const auto& [k, members] : gone)
      presence_text_ += fmt::format("\n[[remove]]                      # deleted before the {} run\ngroup = \"{}\"\nfrom_stage = \"{}\"\n",
                                    ordinal(k + 1), groups_.of(members, "gone", k - 1), stage(k));
    for (const Removal& r : world_.removals)
      if (r.run < runs())
        presence_text_ += fmt::format("\n[[remove]]                      # {} {}\ngroup = \"{}\"\nfrom_stage = \"{}\"\nwhat = \"{}\"\n",
                                      reading_.short_place(r.where), r.text, groups_.of(r.members, r.group, r.run), stage(r.run),
                                      r.angles ? "angles" : "bonds");
  }

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

  // The file -------------------------------------------------------------------------------------------------------------------

  std::string text() {
    std::string t = fmt::format("# Written by elamin import from {}", script_name());
    for (const auto& [name, value] : pass_.loops) t += fmt::format(", {} = {}", name, value);
    t += fmt::format(". Units: {}.\ntitle = \"{}\"\n", world_.units, title());
    int plane = flat_.always ? flat_.direction : -1;
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
    t += groups_.tables() + presence_text_;
    for (const char* kind : {"support", "load", "gravity", "contact", "wall", "viscosity"}) {
      int number = 0;
      for (Table& table : tables_) {
        if (table.kind != kind) continue;
        ++number;
        t += "\n" + table_text(table, number);
      }
    }
    const auto meets = [](const Table& table) { return table.kind == "wall" || table.kind == "contact"; };
    protocol_.touches = std::any_of(tables_.begin(), tables_.end(), meets);
    return t + protocol_text(protocol_, reading_, world_, options_);
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
        protocol_.off[k].push_back(quoted(t.name.empty() ? fmt::format("{}.{}", t.kind, number) : fmt::format("{}.{}", t.kind, t.name)));
    return text;
  }

  const Reading& reading_;
  const Pass& pass_;
  const World& world_;
  TranslationOptions options_;
  std::string data_name_;
  Particles particles_;
  GroupNames groups_;
  Flat flat_;
  Translated result_;
  std::vector<Table> tables_;
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
          throw InputError({Mistake{reading.files[static_cast<std::size_t>(runs[k].where.file)], runs[k].where.line, 1, "run",
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
