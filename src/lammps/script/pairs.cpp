// Pair styles and their coefficients.
#include "core/find.hpp"
#include "lammps/script/interpreter.hpp"
#include "lammps/script/granular.hpp"

#include "core/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

namespace elamin::script {
namespace {

bool known_style(const std::string& s) {
  static constexpr const char* all[]{"granular",  "gran/hertz/history", "lj/cut", "lj/smooth", "body/rounded/polyhedron",
                                         "zero", "none"};
  return std::any_of(std::begin(all), std::end(all), [&](const char* a) { return s == a; });
}

PairStyle style_from(Interpreter& in, std::size_t from, std::size_t to) {
  PairStyle s;
  s.name = in.word(from);
  const std::size_t n = to - from - 1;
  const auto wants = [&](std::size_t least, std::size_t most, const char* form) {
    if (n < least || n > most) throw Wrong(from, fmt::format("{} is followed by: {}", s.name, form));
  };
  if (s.name == "granular") {
    wants(0, 1, "a cutoff, if anything");
    if (n == 1) s.cutoff = in.number(from + 1);
  } else if (s.name == "lj/cut") {
    wants(1, 1, "its cutoff");
    s.cutoff = in.number(from + 1);
  } else if (s.name == "lj/smooth") {
    wants(2, 2, "its inner cutoff, and its cutoff");
    s.inner_cutoff = in.number(from + 1), s.cutoff = in.number(from + 2);
  } else if (s.name == "gran/hertz/history") {
    wants(6, 7, "Kn Kt gamma_n gamma_t xmu dampflag");
    GranularLaw law;
    law.read_older(in, from + 1);
    law.tell(in);
    s.gran_modulus = law.effective_modulus, s.damping = law.damping();
  } else if (s.name == "body/rounded/polyhedron") {
    wants(5, 5, "c_n c_t mu delta_ua cut_inner");
    s.c_n = in.number(from + 1), s.c_t = in.number(from + 2), s.mu = in.number(from + 3), s.delta_ua = in.number(from + 4),
    s.cut_inner = in.number(from + 5);
  }
  return s;
}

}  // namespace

std::size_t GranularLaw::read(const Interpreter& in, std::size_t i, bool wall) {
  const auto word = [&](std::size_t k) -> const std::string& {
    if (k >= in.size()) throw Wrong(in.size() - 1, "is followed by too few words of a granular law");
    return in.word(k);
  };
  const std::string normal = word(i);
  if (normal == "hertz/material") {
    youngs_modulus = in.number(i + 1), gamma = in.number(i + 2), poissons_ratio = in.number(i + 3), material = true;
    if (youngs_modulus < 0) throw Wrong(i + 1, "is negative; 0 or more is taken");
    if (!(poissons_ratio > -1 && poissons_ratio <= 0.5)) throw Wrong(i + 3, fmt::format("is no Poisson's ratio, {}", word(i + 3)));
    i += 4;
  } else if (normal == "hertz") {
    const double kn = in.number(i + 1);
    if (kn < 0) throw Wrong(i + 1, "is negative; 0 or more is taken");
    effective_modulus = 0.75 * kn, gamma = in.number(i + 2);
    i += 3;
  } else if (normal == "hooke" || normal == "dmt" || normal == "jkr")
    throw Wrong(i, fmt::format("contacts of style {} are not known here; hertz and hertz/material are", normal), true);
  else throw Wrong(i, in_quotes(normal) + " is no normal model of granular that is known here; hertz and hertz/material are", true);
  while (i < in.size()) {
    const std::string& k = in.word(i);
    if (k == "damping") {
      model = word(i + 1);
      static constexpr const char* models[]{"velocity", "mass_velocity", "viscoelastic", "tsuji"};
      if (std::none_of(std::begin(models), std::end(models), [&](const char* m) { return model == m; }))
        throw Wrong(i + 1, in_quotes(model) + " is no damping model; velocity, mass_velocity, viscoelastic and tsuji are", true);
      i += 2;
    } else if (k == "tangential") {
      const std::string& t = word(i + 1);
      if (t == "linear_nohistory") tangential = in.number(i + 2), friction = in.number(i + 3), i += 4;
      else if (t == "linear_history" || t.starts_with("mindlin")) {
        if (word(i + 2) != "NULL") in.number(i + 2);
        tangential = in.number(i + 3), friction = in.number(i + 4), history = true, i += 5;
      } else throw Wrong(i + 1, in_quotes(t) + " is no tangential model that is known here", true);
    } else if (k == "rolling" || k == "twisting") {
      const std::string& t = word(i + 1);
      if (t == "none" || t == "marshall") i += 2;
      else if (t == "sds") in.number(i + 2), in.number(i + 3), in.number(i + 4), i += 5;
      else throw Wrong(i + 1, in_quotes(t) + fmt::format(" is no {} model that is known here", k), true);
      rolls = rolls || t != "none";
    } else if (k == "cutoff" && !wall) in.number(i + 1), i += 2;
    else if (k == "limit_damping") limited = gamma > 0, ++i;
    else break;
  }
  return i;
}

std::size_t GranularLaw::read_older(Interpreter& in, std::size_t i) {
  const double kn = in.number(i), kt = i + 1 < in.size() && in.word(i + 1) == "NULL" ? kn * 2 / 7 : in.number(i + 1);
  if (kn < 0) throw Wrong(i, "is negative; 0 or more is taken");
  gamma = in.number(i + 2);
  double along = i + 3 < in.size() && in.word(i + 3) == "NULL" ? gamma / 2 : in.number(i + 3);
  friction = in.number(i + 4);
  if (in.integer(i + 5, 0, 1) == 0) along = 0;
  effective_modulus = 0.75 * kn, tangential = gamma > 0 ? along / gamma : 0;
  history = kt > 0 && friction > 0;
  if (gamma == 0 && along > 0 && friction > 0) in.not_in_motion();
  if (i + 6 >= in.size() || in.word(i + 6) != "limit_damping") return i + 6;
  limited = gamma > 0;
  return i + 7;
}

void GranularLaw::tell(Interpreter& in) const {
  if (limited) in.not_in_motion();
  if (history || rolls)
    in.note(
        "friction that remembers, rolls and twists has no energy: it is left out (with --dynamics its sliding friction stays, without "
        "history)");
}

std::string GranularLaw::damping() const {
  std::string keys = model == "tsuji" ? fmt::format("damping = \"tsuji\"\nrestitution = {}\n", gamma)
                     : gamma > 0      ? fmt::format("damping = \"{}\"\ndamping_coefficient = {}\n", model, gamma)
                                      : "";
  if (keys.empty()) return keys;                 // without damping along the normal LAMMPS has none across it, and friction is at most that
  if (friction > 0) keys += fmt::format("friction = {}\n", friction);
  return keys + fmt::format("friction_damping = {}\n", tangential);
}

namespace command {

void pair_style(Interpreter& in) {
  in.wants(2, "pair_style STYLE …");
  Pairs p;
  const bool mixed = in.word(1) == "hybrid" || in.word(1) == "hybrid/overlay";
  p.hybrid = in.word(1) == "hybrid", p.overlay = in.word(1) == "hybrid/overlay";
  std::size_t i = mixed ? 2 : 1;
  const auto names = [&](const std::string& w) { return std::isalpha(static_cast<unsigned char>(w[0])) && w != "NULL" && w != "limit_damping"; };
  while (i < in.size()) {
    const std::string what = in_quotes(in.word(i)) +
                             " is no pair style that is known here; granular, gran/hertz/history, lj/cut, lj/smooth, body/rounded/polyhedron, "
                             "hybrid and hybrid/overlay of them are";
    const bool known = known_style(in.word(i));
    if (!known && !(mixed && in.options.skip)) throw Wrong(i, what, true);
    std::size_t end = i + 1;
    while (end < in.size() && !(mixed && names(in.word(end)))) ++end;
    if (known) p.styles.push_back(style_from(in, i, end));
    else in.reading.told.push_back({Told::Fate::not_understood, in.word(0), what, 1, in.where});
    i = end;
  }
  if (mixed && p.styles.empty()) throw Wrong(1, "is followed by no style");
  const auto cohesive = [](const PairStyle& s) { return s.name.starts_with("lj/"); };
  if (std::count_if(p.styles.begin(), p.styles.end(), cohesive) > 1) throw Wrong(1, "has cohesion of two styles; one is taken", true);
  Pairs& old = in.world.pairs;
  if (!mixed && !old.hybrid && !old.overlay && !old.styles.empty() && old.styles[0].name == p.styles[0].name) {
    PairStyle& style = p.styles[0];              // LAMMPS keeps the coefficients, and gives them the new numbers of the style
    style.shift = old.styles[0].shift, style.mix = old.styles[0].mix;
    p.coefficients = std::move(old.coefficients);
    for (PairCoefficient& c : p.coefficients)
      if (c.law == PairCoefficient::Law::lj) c.cutoff = style.cutoff, c.inner_cutoff = style.inner_cutoff;
      else if (style.name == "gran/hertz/history") c.effective_modulus = style.gran_modulus, c.damping = style.damping;
  }
  old = std::move(p);
}

void pair_modify(Interpreter& in) {
  in.wants(2, "pair_modify KEYWORD …");
  std::size_t first = 1;
  const std::string of = in.word(1) == "pair" && in.size() > 2 ? in.word(2) : "";
  if (!of.empty()) {                             // pair STYLE KEYWORD …
    if (!find_named(in.world.pairs.styles, of)) throw Wrong(2, in_quotes(of) + " is none of the styles of pair_style");
    first = 3;
  }
  for (std::size_t i = first; i < in.size();) {
    const std::string& k = in.word(i);
    if (i + 1 >= in.size()) throw Wrong(i, in_quotes(k) + " is followed by nothing");
    if (k == "shift") {
      for (PairStyle& s : in.world.pairs.styles)
        if (of.empty() || s.name == of) s.shift = in.yes(i + 1);
    } else if (k == "mix") {
      const std::string& m = in.word(i + 1);
      if (m != "geometric" && m != "arithmetic" && m != "sixthpower")
        throw Wrong(i + 1, in_quotes(m) + " is no way of mixing; geometric, arithmetic and sixthpower are");
      for (PairStyle& s : in.world.pairs.styles)
        if (of.empty() || s.name == of)
          s.mix = m == "geometric" ? PairStyle::Mix::geometric : m == "arithmetic" ? PairStyle::Mix::arithmetic : PairStyle::Mix::sixthpower;
    } else if (k != "tail" && k != "table" && k != "compute")
      throw Wrong(i, in_quotes(k) + " is no keyword of pair_modify that is taken; shift and mix are", true);
    else if (k == "tail" && in.yes(i + 1)) throw Wrong(i, "corrections for a cut tail are of periodic boxes", true);
    i += 2;
  }
}

void pair_coeff(Interpreter& in) {
  in.wants(3, "pair_coeff TYPES TYPES …");
  World& w = in.world;
  PairCoefficient c;
  c.first = in.range(1, w.atom_types), c.second = in.range(2, w.atom_types);
  c.where = in.where, c.text = in.text();
  bool any = false;
  for (int a = c.first[0]; a <= c.first[1] && !any; ++a) any = std::max(c.second[0], a) <= c.second[1];
  if (!any)
    throw Wrong(1, fmt::format("there is no pair I J with I up to J in {} {}; write the smaller type first", in.word(1), in.word(2)));
  if (w.pairs.styles.empty()) throw Wrong(0, "stands before pair_style");
  std::size_t i = 3;
  const PairStyle* style = &w.pairs.styles.front();
  if (w.pairs.hybrid || w.pairs.overlay || (in.size() > 3 && in.word(3) == style->name)) {
    in.wants(4, "pair_coeff TYPES TYPES STYLE …");
    if (in.word(3) == "none") style = nullptr;
    else {
      style = find_named(w.pairs.styles, in.word(3));
      if (!style) throw Wrong(3, in_quotes(in.word(3)) + " is none of the styles of pair_style", !known_style(in.word(3)));
    }
    ++i;
  }
  const std::string name = c.style = style ? style->name : "none";
  std::size_t end = in.size();
  if (name == "granular") {
    GranularLaw law;
    end = law.read(in, i, false);
    c.law = PairCoefficient::Law::hertz;
    if (law.material) c.youngs_modulus = law.youngs_modulus, c.poissons_ratio = law.poissons_ratio;
    if (!law.material) c.effective_modulus = law.effective_modulus;
    c.damping = law.damping();
    law.tell(in);
  } else if (name == "gran/hertz/history") {
    c.law = PairCoefficient::Law::hertz, c.effective_modulus = style->gran_modulus, c.damping = style->damping;
    end = i;
  } else if (name == "lj/cut") {
    c.law = PairCoefficient::Law::lj;
    c.epsilon = in.number(i), c.sigma = in.number(i + 1), c.cutoff = in.size() > i + 2 ? in.number(i + 2) : style->cutoff;
    if (c.epsilon < 0 || c.sigma < 0 || c.cutoff < 0) throw Wrong(i, "a number is negative; 0 or more is taken");
    end = std::min(in.size(), i + 3);
  } else if (name == "lj/smooth") {
    c.law = PairCoefficient::Law::lj;
    const bool own = in.size() > i + 2;
    c.epsilon = in.number(i), c.sigma = in.number(i + 1);
    c.inner_cutoff = own ? in.number(i + 2) : style->inner_cutoff, c.cutoff = own ? in.number(i + 3) : style->cutoff;
    if (c.epsilon < 0 || c.sigma < 0) throw Wrong(i, "a number is negative; 0 or more is taken");
    if (!(c.inner_cutoff > 0) || !(c.cutoff > c.inner_cutoff)) throw Wrong(i, "has an inner cutoff that is not between 0 and the cutoff");
    end = own ? i + 4 : i + 2;
  } else if (name == "body/rounded/polyhedron") {
    c.law = PairCoefficient::Law::rounded;
    c.k_n = in.number(i), c.k_na = in.number(i + 1);
    if (c.k_n < 0 || c.k_na < 0) throw Wrong(i, "a number is negative; 0 or more is taken");
    end = i + 2;
  } else end = i;                                // zero, none
  if (end != in.size() && name != "zero" && name != "none")
    throw Wrong(end, fmt::format("{} is no word of pair_coeff for {} that is known here", in_quotes(in.word(end)), name), true);
  if (name == "none" || w.pairs.hybrid) {        // of these pairs what was said before is taken back
    using Law = PairCoefficient::Law;
    for (const Law law : {Law::hertz, Law::lj, Law::rounded}) {
      if (law == c.law) continue;
      const auto meets = [&](const PairCoefficient& o) {         // both speak of a pair I ≤ J
        const int least = std::max(c.first[0], o.first[0]), most = std::min(c.second[1], o.second[1]);
        return least <= std::min(c.first[1], o.first[1]) && std::max(c.second[0], o.second[0]) <= most && least <= most;
      };
      auto& all = w.pairs.coefficients;
      std::erase_if(all, [&](const PairCoefficient& o) {
        return o.law == law && c.first[0] <= o.first[0] && o.first[1] <= c.first[1] && c.second[0] <= o.second[0] && o.second[1] <= c.second[1];
      });
      if (std::none_of(all.begin(), all.end(), [&](const PairCoefficient& o) { return o.law == law && meets(o); })) continue;
      PairCoefficient nothing;                   // a law without force over them
      nothing.law = law, nothing.style = name, nothing.first = c.first, nothing.second = c.second;
      nothing.where = c.where, nothing.text = c.text;
      if (law == Law::hertz) nothing.effective_modulus = 0;
      all.push_back(nothing);
    }
  }
  // A later line holds; what it covers altogether is forgotten.
  std::erase_if(w.pairs.coefficients, [&](const PairCoefficient& o) {
    return o.law == c.law && o.style == c.style && o.first == c.first && o.second == c.second;
  });
  w.pairs.coefficients.push_back(std::move(c));
}

void neighbor(Interpreter& in) {
  in.wants(3, "neighbor SKIN STYLE", 3);
  in.world.skin = in.number(1);
  in.ignore(because::neighbours);
}

void neigh_modify(Interpreter& in) {
  in.wants(3, "neigh_modify KEYWORD VALUE …");
  using Of = Exclusion::Of;
  World& w = in.world;
  static const std::vector<std::string> lists{"every", "delay", "check", "once", "cluster", "page", "one", "binsize", "custom"};
  bool excludes = false;
  for (std::size_t i = 1; i < in.size();) {
    const std::string& k = in.word(i);
    if (i + 1 >= in.size()) throw Wrong(i, in_quotes(k) + " is followed by nothing");
    const std::string& of = in.word(i + 1);
    if (k.starts_with("collection/")) break;
    if (k == "include" && of != "all") throw Wrong(i, "contacts within one group alone are not taken; exclude leaves pairs out", true);
    if (k == "include" || contains(lists, k)) {
      i += 2;
      continue;
    }
    if (k != "exclude") throw Wrong(i, in_quotes(k) + " is no keyword of neigh_modify that is taken; exclude is", true);
    excludes = true;
    const auto word = [&](std::size_t n) {
      if (i + n >= in.size())
        throw Wrong(in.size() - 1, "is followed by too few words; exclude type M N, group A B or molecule/intra A are");
      return i + n;
    };
    const auto type = [&](std::size_t n) { return static_cast<int>(in.integer(word(n), 1, w.atom_types)); };
    const auto group = [&](std::size_t n) { return w.group(in.word(word(n)), word(n)); };
    const auto add = [&](Of what, std::array<int, 2> which) { w.exclusions.push_back({what, which, in.where, in.text()}); };
    if (of == "type") add(Of::types, {type(2), type(3)}), i += 4;
    else if (of == "group") add(Of::groups, {group(2), group(3)}), i += 4;
    else if (of == "molecule/intra" || of == "molecule") add(Of::molecules, {group(2), group(2)}), i += 3;
    else if (of == "none") w.exclusions.clear(), i += 2;
    else
      throw Wrong(i + 1, in_quotes(of) + " says of no pairs that are left out here; type, group, molecule/intra and none do", true);
  }
  if (!excludes) in.ignore(because::neighbours);
}

}  // namespace command
}  // namespace elamin::script
