#include "lammps/export.hpp"

#include "core/find.hpp"
#include "lammps/state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

namespace elamin {
namespace {

/// How the coordinates of some particles are prescribed: which, and how fast they move.
struct Held {
  std::array<bool, 3> held{};
  Vec3 velocity = Vec3::Zero();
  bool all() const { return held[0] && held[1] && held[2]; }
  bool driven() const { return !velocity.isZero(0); }
  std::array<double, 6> key() const {
    return {double(held[0]), double(held[1]), double(held[2]), velocity[0], velocity[1], velocity[2]};
  }
};

/// What is in a comment ends with it.
std::string in_one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = ' ';
  return text;
}

class ScriptMaker {
 public:
  ScriptMaker(const ExportedStudy& study, const std::string& data_file)
      : study_(study), data_file_(data_file), m_(study.stages.front().model) {}

  LammpsExport make() {
    refused_ = study_.refused;
    if (!m_.bodies.empty()) refuse(fmt::format("rigid bodies ({}), and what is glued to them: their potentials are not those of LAMMPS",
                                               m_.bodies.size()));
    for (const ExportStage& s : study_.stages) models_.push_back(&s.model);
    types_ = export_types(models_);
    for (const std::string& what : types_.refused) refuse(what);
    LammpsExport out;
    out.written = m_;
    out.written.type = types_.type;
    out.written.bodies.clear(), out.written.shapes.clear();      // refused, or left out
    // The body of the script first: it tells which pair styles and groups there are, and what is refused.
    head();
    const std::string top = std::move(text_);
    text_.clear();
    for (std::size_t s = 0; s < study_.stages.size(); ++s) stage(s);
    std::string about = fmt::format("# {}\n# Written by elamin export of {}; run it in its folder, beside {}: lmp -in FILE\n"
                                    "# Numbers are in the units of the problem, whatever these are; \"si\" changes none of them.\n",
                                    in_one_line(study_.title.empty() ? "(no title)" : study_.title), in_one_line(study_.source), data_file_);
    for (const std::string& note : study_.notes) about += "# " + note + "\n";
    for (const std::string& what : refused_) about += "# Left out: " + what + "\n";
    out.script = about + "\n" + top + text_;
    out.refused = refused_, out.files.assign(files_.begin(), files_.end());
    return out;
  }

 private:
  template <class... Values> void put(fmt::format_string<Values...> format, Values&&... values) {
    text_ += fmt::format(format, std::forward<Values>(values)...) + "\n";
  }
  void refuse(const std::string& what) {
    if (!contains(refused_, what)) refused_.push_back(what);
  }

  double longest_bond() const {
    double most = 0;
    const Field& x = study_.start.position;
    for (const Bond& b : m_.bonds) most = std::max(most, (x.col(b.particles[1]) - x.col(b.particles[0])).norm());
    return most;
  }

  void head() {
    const double diameter = m_.diameter.empty() ? 0 : *std::max_element(m_.diameter.begin(), m_.diameter.end());
    const double size = diameter > 0 ? diameter : std::max(longest_bond(), 1e-300);
    put("units si\natom_style hybrid sphere angle\nboundary m m m");
    const bool straight = straight_at_rest(m_);
    if (!m_.bonds.empty()) put("bond_style harmonic                  # U = K (r - r0)^2");
    if (!m_.angles.empty())
      put("{}", straight ? "angle_style cosine                   # U = B (1 + cos(theta))"
                         : "angle_style cosine/shift             # U = -Umin/2 (1 + cos(theta - theta0)), Umin = 2B: elamin's energy is "
                           "larger by 2B an angle; package EXTRA-MOLECULE");
    int special = 0;
    for (const auto& s : types_.stages) special = std::max(special, s.special);
    put("special_bonds lj {} {} {} coul 1 1 1   # cohesion of pairs 1, 2 and 3 bonds apart; granular contact does not know it: see "
        "pair_coeff", special >= 1 ? 0 : 1,
        special >= 2 ? 0 : 1, special >= 3 ? 0 : 1);
    put("comm_modify vel yes cutoff {}", lammps_number(std::max(3 * longest_bond(), 2 * size)));
    put("neighbor {} bin\nneigh_modify every 1 delay 0 check yes\nread_data {}", lammps_number(0.3 * size), data_file_);
    put("mass * 1.0                           # has no effect: spheres have masses of their own");
    put("");
  }

  // --- groups

  /// The LAMMPS group of these particles; made if there is none yet.
  std::string group(const std::vector<int>& particles, const std::string& wanted) {
    if (static_cast<int>(particles.size()) == m_.particles()) return "all";
    if (const auto known = groups_.find(particles); known != groups_.end()) return known->second;
    std::string name = lammps_name(wanted);
    for (const Group& g : m_.groups)
      if (g.particles == particles && g.name != "all") { name = lammps_name(g.name); break; }
    const std::string stem = name;
    for (int k = 2; name == "all" || names_.count(name); ++k) name = fmt::format("{}_{}", stem, k);
    names_.insert(name), groups_.emplace(particles, name);
    if (groups_.size() == 32) refuse("more than 31 groups of particles, as many as LAMMPS has");
    std::string line = "group " + name + " id";
    std::size_t width = line.size();
    for (std::size_t k = 0; k < particles.size();) {
      std::size_t end = k + 1;
      while (end < particles.size() && m_.id[particles[end]] == m_.id[particles[end - 1]] + 1) ++end;
      const int first = m_.id[particles[k]], last = m_.id[particles[end - 1]];
      const std::string word = last == first ? fmt::format(" {}", first) : last == first + 1 ? fmt::format(" {} {}", first, last)
          : fmt::format(" {}:{}", first, last);
      if (width + word.size() > 100) line += " &\n   ", width = 4;
      line += word, width += word.size(), k = end;
    }
    put("{}", line);
    return name;
  }

  // --- pairs

  void pairs(std::size_t s) {
    const auto& contacts = study_.stages[s].model.contacts;
    bool hertz = false, lj = false;
    for (const auto& rule : types_.stages[s].rules) hertz = hertz || rule.hertz >= 0, lj = lj || rule.lj >= 0;
    for (const PairContact& c : contacts)
      if (c.hard) refuse(fmt::format("contact between '{}' and '{}': it is hard; LAMMPS has elastic ones", c.between[0], c.between[1]));
    std::set<CutoffStyle> cutoffs;
    double longest = 0;
    for (const auto& rule : types_.stages[s].rules)
      if (rule.lj >= 0) cutoffs.insert(contacts[rule.lj].cutoff_style), longest = std::max(longest, contacts[rule.lj].cutoff);
    if (cutoffs.size() > 1) {
      refuse("cohesion that ends at its cutoff in different ways");
      lj = false;
    }
    const bool smooth = !cutoffs.empty() && *cutoffs.begin() == CutoffStyle::smooth;
    const std::string lj_style = smooth ? "lj/smooth" : "lj/cut";
    const bool hybrid = hertz && lj;
    std::string lj_cutoffs = lammps_number(longest);
    if (smooth) lj_cutoffs = lammps_number(longest / 2) + " " + lj_cutoffs;
    std::vector<std::string> lines;
    if (!hertz && !lj) {
      lines.push_back("pair_style none");
    } else {
      lines.push_back(fmt::format("pair_style {}{}{}{}", hybrid ? "hybrid/overlay" : "", hertz ? (hybrid ? " granular" : "granular") : "",
                                  lj ? (hybrid ? " " : "") + lj_style : "", lj ? " " + lj_cutoffs : ""));
      // Not `none`: between types that have one and the same sub-style alone, LAMMPS's hybrid styles take it as to be mixed.
      if (hertz) law_lines(s, true, hybrid ? " granular " : " ", "hertz 0 0 tangential linear_nohistory 0 0", lines);
      if (lj) law_lines(s, false, hybrid ? " " + lj_style + " " : " ", hybrid ? "" : "0 1 " + lj_cutoffs, lines);
      if (lj && *cutoffs.begin() != CutoffStyle::cut)
        lines.push_back(fmt::format("pair_modify {}shift yes", hybrid ? "pair " + lj_style + " " : ""));
    }
    if (lines == pair_lines_) return;
    put("# contact: E = 2 E_eff and nu = 0, whatever E and nu the problem has; \"hertz 0\": no contact, or left out by exclude_bonds");
    for (const std::string& line : lines) put("{}", line);
    put("");
    pair_lines_ = lines;
  }

  std::string law(const PairContact& c) const {
    if (c.law == PairContact::Law::hertz) return granular_law(c.effective_modulus, c.damping);
    std::string text = lammps_number(c.epsilon) + " " + lammps_number(c.sigma) + " ";
    if (c.cutoff_style == CutoffStyle::smooth) text += lammps_number(c.inner_cutoff) + " ";
    return text + lammps_number(c.cutoff);
  }

  /// What most pairs of types have first, with wildcards, then the others. `nothing`: the law of pairs without one; "": they get no line.
  void law_lines(std::size_t s, bool hertz, const std::string& style, const std::string& nothing, std::vector<std::string>& lines) const {
    const auto& contacts = study_.stages[s].model.contacts;
    const auto of = [&](int a, int b) { const auto& r = types_.rule(s, a, b); return hertz ? r.hertz : r.lj; };
    std::map<int, int> count;
    for (int a = 1; a <= types_.count; ++a)
      for (int b = a; b <= types_.count; ++b) ++count[of(a, b)];
    int most = -1, times = 0;
    for (const auto& [table, n] : count)
      if (n > times) most = table, times = n;
    if (nothing.empty() && count.count(-1)) most = -1;
    const auto line = [&](const std::string& types, int table) {
      lines.push_back(fmt::format("pair_coeff {}{}{}", types, style, table < 0 ? nothing : law(contacts[table])));
    };
    if (most >= 0 || !nothing.empty()) line("* *", most);
    for (int a = 1; a <= types_.count; ++a)
      for (int b = a; b <= types_.count;) {
        const int table = of(a, b);
        int end = b + 1;
        while (end <= types_.count && of(a, end) == table) ++end;
        if (table != most) line(end == b + 1 ? fmt::format("{} {}", a, b) : fmt::format("{} {}*{}", a, b, end - 1), table);
        b = end;
      }
  }

  // --- supports

  std::vector<Held> held(const ExportStage& stage) const {
    std::vector<Held> of(static_cast<std::size_t>(m_.particles()));
    const double time = study_.timestep * static_cast<double>(study_.steps);
    for (const Support& s : stage.model.supports)
      for (const int p : s.particles)
        for (int c = 0; c < 3; ++c) {
          if (!s.held[c]) continue;
          of[p].held[c] = true;
          if (study_.kind == ExportedStudy::Kind::motion) of[p].velocity[c] = s.velocity[c];
          else if (time > 0) of[p].velocity[c] = s.scaling.rate * (stage.to - stage.from) * s.displacement[c] / time;
        }
    return of;
  }

  void supports(std::size_t number) {
    const std::vector<Held> of = held(study_.stages[number]);
    std::map<std::array<double, 6>, std::vector<int>> classes;
    std::vector<int> free;                                   // integrated by nve
    for (int p = 0; p < m_.particles(); ++p) {
      const Held& h = of[p];
      const bool any = h.held[0] || h.held[1] || h.held[2];
      if (any) classes[h.key()].push_back(p);
      if (!h.driven() && !h.all()) free.push_back(p);
    }
    for (const auto& [key, particles] : classes) {
      const Held& h = of[particles[0]];
      std::string sides;
      for (int c = 0; c < 3; ++c)
        if (h.held[c]) sides += "xyz"[c];
      const std::string name = group(particles, h.driven() ? "driven" : "held");
      std::string text = h.driven() ? "move linear" : "setforce";
      for (int c = 0; c < 3; ++c) text += " " + (h.held[c] ? lammps_number(h.velocity[c]) : std::string("NULL"));
      std::string still;                                     // where there is motion already, it ends
      for (int c = 0; c < 3; ++c) still += h.held[c] && !h.driven() ? " 0" : " NULL";
      if (number > 0 && !h.driven()) settle_.push_back(fmt::format("velocity {} set{} units box", name, still));
      add({"support_" + name, {}, text, {}, {}, fmt::format("support: '{}' is {} in {}", name, h.driven() ? "driven" : "held", sides)},
          name, h.driven());
    }
    if (m_.plane_normal) {
      std::string text = "setforce";
      for (int c = 0; c < 3; ++c) text += c == *m_.plane_normal ? " 0" : " NULL";
      add({"plane", {}, text, {}, {}, "everything stays in its plane"}, "all", false);
    }
    if (!free.empty()) add({"motion", {}, "nve/sphere", {}, {}, "what moves freely"},
                           group(free, number ? fmt::format("free_{}", number + 1) : "free"), true);
  }

  // --- fixes: those of the stage, held against those that are there

  struct Line { std::string id, text, means; bool early = false; };
  void add(const ExportFix& fix, const std::string& group, bool early) { now_.push_back({fix.name, group + " " + fix.text, fix.means,
                                                                                         early}); }

  /// Supports that set forces come last; where something new comes before them they are made again.
  void put_fixes() {
    (void)std::stable_partition(now_.begin(), now_.end(), [](const Line& l) { return l.early; });
    std::map<std::string, int> times;
    for (Line& l : now_)
      if (const int n = ++times[l.id]; n > 1) l.id += fmt::format("_{}", n);
    const auto same = [](const Line& a) { return [&](const Line& b) { return a.id == b.id && a.text == b.text; }; };
    bool fresh = false;                                      // from here on all are made anew
    std::vector<bool> kept;
    for (const Line& l : now_) {
      const bool there = std::any_of(fixes_.begin(), fixes_.end(), same(l));
      const bool last = l.text.find(" setforce ") != std::string::npos;
      kept.push_back(there && !(fresh && last));
      fresh = fresh || !there;
    }
    for (const Line& old : fixes_) {
      const auto at = std::find_if(now_.begin(), now_.end(), same(old));
      if (at == now_.end() || !kept[at - now_.begin()]) put("unfix {}", old.id);
    }
    for (std::size_t k = 0; k < now_.size(); ++k)
      if (!kept[k]) put("fix {} {}{}", now_[k].id, now_[k].text, now_[k].means.empty() ? "" : "   # " + now_[k].means);
    fixes_ = std::move(now_);
    now_.clear();
  }

  void stage(std::size_t number) {
    const ExportStage& s = study_.stages[number];
    const bool equilibria = study_.kind == ExportedStudy::Kind::equilibria;
    if (equilibria && study_.stages.size() > 1) put("# --- stage '{}'", s.name);
    if (equilibria && s.from != s.to)
      put("# Load factor {} to {}: during the run driven ends and walls travel, and loads rise, in proportion to it. The run is one of "
          "damped\n"
          "# motion: longer ones (more steps, slower travel) come nearer to equilibria.", lammps_number(s.from), lammps_number(s.to));
    else if (equilibria) put("# Everything acts in full; the motion dies down to an equilibrium.");
    pairs(number);
    // Walls may not be made of regions again: another stage has others.
    std::vector<ExportFix> acting = export_fixes(s.model, s.from, s.to, stem(), refused_told_);
    for (const std::string& what : refused_told_) refuse(what);
    refused_told_.clear();
    settle_.clear();
    for (ExportFix& fix : acting) {
      for (auto& file : fix.files) files_[file.first] = std::move(file.second);
      for (const std::string& line : fix.variables) put("{}", line);
      for (std::string line : fix.regions) {
        const auto there = regions_.find(fix.name);
        const bool first = there == regions_.end(), again = !first && there->second.line == line;
        RegionLine& region = regions_[fix.name];
        region.line = line;
        if (!again) region.name = first ? name_in(line) : fmt::format("{}_s{}", name_in(line), number + 1);
        fix.text.replace(fix.text.rfind("region ") + 7, name_in(line).size(), region.name);
        line.replace(7, name_in(line).size(), region.name);
        if (!again) put("{}", line);
      }
      add(fix, group(fix.particles, fix.name), false);
    }
    if (equilibria && study_.drag > 0) add({"damping", {}, "viscous " + lammps_number(study_.drag), {}, {}, "takes the motion out"}, "all",
                                           false);
    supports(number);
    put_fixes();
    for (const std::string& line : settle_) put("{}", line);
    if (number == 0) output();
    if (equilibria && s.from != s.to) put("variable lambda equal ramp({},{})", lammps_number(s.from), lammps_number(s.to));
    else put("variable lambda equal {}", lammps_number(s.to));
    put("run {}", study_.kind == ExportedStudy::Kind::energy ? 0 : study_.steps);
    put("");
  }

  /// A region as it would be called, and as it is called: another one under a name that is taken gets the stage's number.
  struct RegionLine { std::string line, name; };
  static std::string name_in(const std::string& line) { return line.substr(7, line.find(' ', 7) - 7); }

  std::string stem() const { return data_file_.substr(0, data_file_.rfind('.')); }

  void output() {
    const long every = std::max(1L, study_.steps / 20);
    put("variable lambda equal {}", lammps_number(study_.stages.front().from));
    put("timestep {}", lammps_number(study_.timestep > 0 ? study_.timestep : 1e-8));
    put("thermo {}\nthermo_style custom step time v_lambda ebond eangle evdwl ke\nthermo_modify format float %.10g", every);
    if (study_.kind != ExportedStudy::Kind::energy)
      put("dump frames all custom {} {} id type x y z fx fy fz\ndump_modify frames sort id format float %.17g", every,
          stem() + ".lammpstrj");
  }

  const ExportedStudy& study_;
  const std::string& data_file_;
  const Model& m_;
  std::vector<const Model*> models_;
  ExportTypes types_;
  std::string text_;
  std::map<std::vector<int>, std::string> groups_;
  std::set<std::string> names_;
  std::map<std::string, std::string> files_;
  std::map<std::string, RegionLine> regions_;               // by fix
  std::vector<std::string> pair_lines_, refused_, refused_told_, settle_;
  std::vector<Line> fixes_, now_;
};

}  // namespace

LammpsExport export_to_lammps(const ExportedStudy& study, const std::string& data_file) { return ScriptMaker(study, data_file).make(); }

}  // namespace elamin
