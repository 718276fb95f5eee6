#include "lammps/export.hpp"

#include "dynamics/contact_damping.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace elamin {

std::string lammps_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

std::string lammps_number(double value) { return fmt::format("{}", value == 0 ? 0.0 : value); }

namespace {

std::string numbers(const Vec3& v) { return lammps_number(v[0]) + " " + lammps_number(v[1]) + " " + lammps_number(v[2]); }

/// A number, or the name of a variable that goes from one to another during the run.
std::string value(const std::string& name, double from, double to, std::vector<std::string>& variables) {
  if (from == to) return lammps_number(from);
  variables.push_back(fmt::format("variable {} equal ramp({},{})", name, lammps_number(from), lammps_number(to)));
  return "v_" + name;
}

std::string values(const std::string& name, const Vec3& from, const Vec3& to, std::vector<std::string>& variables) {
  std::string text;
  for (int c = 0; c < 3; ++c) text += (c ? " " : "") + value(fmt::format("{}_{}", name, "xyz"[c]), from[c], to[c], variables);
  return text;
}

std::string axial(double end) { return std::isfinite(end) ? lammps_number(end) : "INF"; }

/// The restitution whose coefficient this is: LAMMPS's tsuji is given by it.
double restitution(double coefficient) {
  double lo = 0, hi = 1;                                   // the coefficient falls with it
  for (int k = 0; k < 200 && lo < hi; ++k) {
    const double e = lo + (hi - lo) / 2;
    (tsuji_coefficient(e) > coefficient ? lo : hi) = e;
  }
  const auto off = [&](double e) { return std::abs(tsuji_coefficient(e) - coefficient); };
  return off(hi) < off(lo) ? hi : lo;
}

class FixMaker {
 public:
  FixMaker(const Model& model, double from, double to, const std::string& stem, std::vector<std::string>& refused)
      : m_(model), from_(from), to_(to), stem_(stem), refused_(refused) {}

  std::vector<ExportFix> make() {
    for (const Load& l : m_.loads) load(l);
    for (const Gravity& g : m_.gravity) gravity(g);
    for (const Wall& w : m_.walls)
      if (!w.particles.empty() || !w.bodies.empty()) wall(w);
    for (const Viscosity& v : m_.viscosity)
      if (!v.particles.empty() && v.coefficient != 0)
        fixes_.push_back({"drag", v.particles, "viscous " + lammps_number(v.coefficient), {}, {},
                          "drag, a force of minus this times the velocity"});
    for (const Pressure& p : m_.pressures) refused_.push_back(fmt::format("pressure on '{}': LAMMPS has no force that stays normal to a "
                                                                           "row or a sheet", p.of));
    for (const Change& c : m_.changes) refused_.push_back(fmt::format("change of '{}': coefficients that vary with the load factor",
                                                                      c.group));
    return std::move(fixes_);
  }

 private:
  Vec3 at_start(const Scaling& s, const Vec3& v) const { return s.at(from_) * v; }
  Vec3 at_end(const Scaling& s, const Vec3& v) const { return s.at(to_) * v; }

  void load(const Load& l) {
    if (l.particles.empty()) return;
    if (l.own.size()) return load_of_each(l);
    const Vec3 from = at_start(l.scaling, l.force), to = at_end(l.scaling, l.force);
    if (from.isZero(0) && to.isZero(0)) return;
    ExportFix fix{"load_" + lammps_name(l.group), l.particles, "", {}, {}, "load on every particle of '" + l.group + "'"};
    fix.text = "addforce " + values(unique(fix.name), from, to, fix.variables);
    fixes_.push_back(std::move(fix));
  }

  /// A force of its own on every particle: a number of each from a file, times what the load factor makes of it.
  void load_of_each(const Load& l) {
    const double from = l.scaling.at(from_), to = l.scaling.at(to_);
    if (from == 0 && to == 0) return;
    ExportFix fix{"load_" + lammps_name(l.group), l.particles, "addforce", {}, {}, "load on '" + l.group + "', on every particle its own"};
    const std::string name = unique(fix.name), factor = from == to ? lammps_number(from)
        : fmt::format("ramp({},{})", lammps_number(from), lammps_number(to));
    for (int c = 0; c < 3; ++c) {
      std::string rows;
      bool any = false;
      for (std::size_t k = 0; k < l.particles.size(); ++k) {
        const double f = l.on(k)[c];
        rows += fmt::format("{} {}\n", m_.id[l.particles[k]], lammps_number(f)), any = any || f != 0;
      }
      if (!any) { fix.text += " 0"; continue; }
      const std::string variable = fmt::format("{}_{}", name, "xyz"[c]), file = stem_ + "." + variable;
      fix.files.emplace_back(file, fmt::format("# force {} of each particle, by elamin export\n{}\n{}", "xyz"[c], l.particles.size(), rows));
      fix.variables.push_back(fmt::format("variable {}_each atomfile {}", variable, file));
      fix.variables.push_back(fmt::format("variable {} atom v_{}_each*{}", variable, variable, factor));
      fix.text += " v_" + variable;
    }
    fixes_.push_back(std::move(fix));
  }

  void gravity(const Gravity& g) {
    const double size = g.acceleration.norm(), from = g.scaling.at(from_) * size, to = g.scaling.at(to_) * size;
    if (g.particles.empty() || (from == 0 && to == 0)) return;
    ExportFix fix{"weight_" + lammps_name(g.group), g.particles, "", {}, {}, "weight of '" + g.group + "'"};
    fix.text = fmt::format("gravity {} vector {}", value(unique(fix.name), from, to, fix.variables), numbers(g.acceleration));
    fixes_.push_back(std::move(fix));
  }

  void wall(const Wall& w) {
    const auto refuse = [&](const std::string& why) { refused_.push_back(fmt::format("wall '{}': {}", w.name, why)); };
    if (w.hard) return refuse("it is hard; LAMMPS has elastic ones");
    if (w.particles.empty()) return;                         // of bodies, which are refused as such
    if (w.effective_modulus == 0) return;
    double modulus = w.effective_modulus;
    const Region& r = w.region;
    std::string means = fmt::format("wall '{}', E_eff = {}", w.name, lammps_number(w.effective_modulus));
    if (!w.curved && r.shape != Shape::plane && r.shape != Shape::block) {
      // LAMMPS takes the wall's curvature into the effective radius, which a modulus makes up for where it is one and the same.
      const double d = m_.diameter[w.particles[0]], radius = d / 2;
      const bool one = std::all_of(w.particles.begin(), w.particles.end(), [&](int p) { return m_.diameter[p] == d; });
      const bool flat = r.shape == Shape::cylinder && ((std::isfinite(r.axial_lo) && !r.open[0]) ||
                                                       (std::isfinite(r.axial_hi) && !r.open[1]));
      const bool rims = r.shape == Shape::cylinder && !w.inside && (std::isfinite(r.axial_lo) || std::isfinite(r.axial_hi));
      if (!one || flat || rims || r.shape == Shape::cone || w.radius_change != 0)
        return refuse("its effective radius is the particle's; LAMMPS's has the wall's curvature in it (effective_radius = \"curved\")");
      const double m = (w.inside ? -1 : 1) * (r.shape == Shape::cylinder ? 2 : 1) * r.radius;
      if (m < 0 && radius >= -m) return refuse("its particles do not fit into LAMMPS's curved wall");
      modulus *= std::sqrt((m + radius) / m);                // √(r/R_eff), R_eff = r m/(r + m)
      means += ", here over the root of R_eff/r, as LAMMPS takes the wall's curvature into R_eff";
    }
    if (r.shape == Shape::cone) {
      if (w.radius_change != 0) return refuse("a cone whose radii change");
      means += "; LAMMPS leaves out of the force that R_eff varies along a cone";
    }
    ExportFix fix{"wall_" + lammps_name(w.name), w.particles, "", {}, {}, means};
    const std::string region = unique(fix.name), tag = region;
    const Vec3 d0 = at_start(w.scaling, w.displacement), d1 = at_end(w.scaling, w.displacement);
    const double R0 = w.scaling.at(from_) * w.radius_change, R1 = w.scaling.at(to_) * w.radius_change;
    const bool travels = d0 != d1;
    const Region at = travels ? r : r.moved(d0, 0);
    std::string text = fmt::format("region {} ", region);
    const std::string radius = value(tag + "_radius", r.radius + R0, r.radius + R1, fix.variables);
    const int a = r.axis, u = a == 0 ? 1 : 0, v = a == 2 ? 1 : 2;
    switch (r.shape) {
      case Shape::plane: text += fmt::format("plane {} {}", numbers(at.center), numbers(at.normal)); break;
      case Shape::block:
        text += "block";
        for (int c = 0; c < 3; ++c) text += fmt::format(" {} {}", axial(at.lo[c]), axial(at.hi[c]));
        break;
      case Shape::sphere: text += fmt::format("sphere {} {}", numbers(at.center), radius); break;
      case Shape::cylinder:
        text += fmt::format("cylinder {} {} {} {} {} {}", "xyz"[a], lammps_number(at.center[u]), lammps_number(at.center[v]), radius,
                            axial(at.axial_lo),
                            axial(at.axial_hi));
        break;
      case Shape::cone:
        text += fmt::format("cone {} {} {} {} {} {} {}", "xyz"[a], lammps_number(at.center[u]), lammps_number(at.center[v]),
                            lammps_number(at.radius_lo),
                            lammps_number(at.radius_hi), axial(at.axial_lo), axial(at.axial_hi));
        break;
    }
    text += fmt::format(" side {} units box", w.inside ? "in" : "out");
    if (travels) {
      text += " move";
      for (int c = 0; c < 3; ++c) {
        const std::string name = fmt::format("{}_{}", tag, "xyz"[c]);
        if (d0[c] == 0 && d1[c] == 0) { text += " NULL"; continue; }
        fix.variables.push_back(fmt::format("variable {} equal ramp({},{})", name, lammps_number(d0[c]), lammps_number(d1[c])));
        text += " v_" + name;
      }
    }
    for (int f = 0; f < 6; ++f)
      if (r.open[f]) text += fmt::format(" open {}", f + 1);
    fix.regions.push_back(text);
    fix.text = fmt::format("wall/gran/region granular {} region {}", granular_law(modulus, w.damping), region);
    fixes_.push_back(std::move(fix));
  }

  /// A name that no fix before has.
  std::string unique(const std::string& name) {
    const auto n = std::count_if(fixes_.begin(), fixes_.end(), [&](const ExportFix& f) { return f.name == name; });
    return n == 0 ? name : fmt::format("{}_{}", name, n + 1);
  }

  const Model& m_;
  double from_, to_;
  const std::string& stem_;
  std::vector<std::string>& refused_;
  std::vector<ExportFix> fixes_;
};

}  // namespace

std::string granular_law(double effective_modulus, const ContactDamping& d) {
  using Way = ContactDamping::Model;
  const char* word = d.model == Way::mass_velocity ? "mass_velocity" : d.model == Way::viscoelastic ? "viscoelastic" : d.model == Way::tsuji
      ? "tsuji" : "velocity";
  const double gamma = d.model == Way::none ? 0 : d.model == Way::tsuji ? restitution(d.coefficient) : d.coefficient;
  const bool rubs = d.model != Way::none;
  return fmt::format("hertz/material {} {} 0 tangential linear_nohistory {} {} damping {}", lammps_number(2 * effective_modulus),
                     lammps_number(gamma),
                     lammps_number(rubs ? d.tangential : 0), lammps_number(rubs ? d.friction : 0), word);
}

std::vector<ExportFix> export_fixes(const Model& model, double from, double to, const std::string& stem,
                                    std::vector<std::string>& refused) {
  return FixMaker(model, from, to, stem, refused).make();
}

}  // namespace elamin
