#include "lammps/script/table_list.hpp"

#include "lammps/script/mixing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace elamin::script {
namespace {

using Law = PairCoefficient::Law;

std::string between_keys(const std::string& a, const std::string& b) { return fmt::format("between = [\"{}\", \"{}\"]\n", a, b); }

std::string contact_keys(TableList& list, const PairCoefficient& c, const PairStyle& style, const Run& run) {
  std::string keys;
  if (c.law == Law::hertz) {
    keys = c.effective_modulus || c.youngs_modulus == 0
               ? fmt::format("effective_modulus = {}\n", c.effective_modulus.value_or(0))
               : fmt::format("youngs_modulus = {}\npoissons_ratio = {}\n", c.youngs_modulus, c.poissons_ratio);
    if (list.options.dynamics) keys += c.damping;
  } else if (c.law == Law::lj) {
    keys = fmt::format("law = \"lj\"\nepsilon = {}\nsigma = {}\ncutoff = {}\n", c.epsilon, c.sigma, c.cutoff);
    if (c.inner_cutoff > 0) keys += fmt::format("cutoff_style = \"smooth\"\ninner_cutoff = {}\n", c.inner_cutoff);
    else if (style.shift) keys += "cutoff_style = \"shifted\"\n";
  } else {
    keys = fmt::format("law = \"rounded\"\nk_n = {}\nk_na = {}\ncutoff = {}\n", c.k_n, c.k_na, style.cut_inner);
    if (list.options.dynamics)
      keys += fmt::format("formulation = \"lammps\"\ndelta_ua = {}\nmu = {}\nc_n = {}\nc_t = {}\n", style.delta_ua, style.mu, style.c_n,
                          style.c_t);
    else
      list.note(c.where, "LAMMPS's forces of rounded bodies have no potential; equilibria are those of the sum over features (formulation = "
                         "\"multi\")");
    return keys;
  }
  if (list.world.bonds.empty()) return keys;
  bool partial = false;
  const int bonds = excluded(run.special_lj, run.special_coul, c.law == Law::hertz, partial);
  if (bonds < 0 || (partial && c.law == Law::lj))
    list.refuse(run.where, "special_bonds", fmt::format("the weights {} {} {} cannot be said of such contacts; 0 for the first neighbours along "
                                                        "bonds and 1 for the rest can", run.special_lj[0], run.special_lj[1], run.special_lj[2]));
  if (partial)
    list.note(c.where, "weights of special_bonds between 0 and 1 are ignored by granular contacts: LAMMPS takes them in full, and so does this");
  if (c.law == Law::hertz && bonds > 0)
    list.note(run.where, "granular contacts of LAMMPS (29 Sep 2021) do not know special_bonds: bonded particles that overlap push each other there. "
                    "Here they are left out; exclude_bonds = 0 in [[contact]] takes them in");
  return keys + fmt::format("exclude_bonds = {}\n", bonds);
}

// Pairs that neigh_modify leaves out: tables without force behind those of the run.
void exclusions(TableList& list, int k, const Run& run, const std::vector<const PairCoefficient*>& acting) {
  int behind = 0;                               // the last table of this run; where it is another one, they come anew
  for (std::size_t t = 0; t < list.tables.size(); ++t)
    if (list.tables[t].kind == "contact" && list.tables[t].in_run[k]) behind = static_cast<int>(t) + 1;
  for (const Run::Excluded& e : run.excluded)
    for (const Law law : {Law::hertz, Law::lj, Law::rounded}) {
      if (std::none_of(acting.begin(), acting.end(), [&](const PairCoefficient* c) { return c->law == law; })) continue;
      if (law == Law::rounded) list.refuse(e.where, "neigh_modify", "pairs of rounded bodies are not left out here; exclude is of particles");
      PairCoefficient none;
      none.law = law, none.effective_modulus = 0, none.sigma = none.cutoff = 1, none.where = e.where;
      const std::string between = between_keys(list.groups.of(e.members[0], "excluded", k), list.groups.of(e.members[1], "excluded", k));
      list.put(k, {"contact", "", between + contact_keys(list, none, *style_of(run, law), run), e.where, e.text, behind, {}});
    }
}

}  // namespace

void put_contacts(TableList& list, int k, const Run& run) {
  std::vector<PairCoefficient> all = run.pairs.coefficients;
  for (PairCoefficient& m : mixed(run, list.particles.types())) all.push_back(std::move(m));
  std::vector<const PairCoefficient*> acting;
  for (const PairCoefficient& c : all) {
    if (c.law == Law::none) continue;
    const auto within = [&](const std::array<int, 2>& r) {
      std::vector<int> types;
      for (const int t : list.particles.types(c.law == Law::rounded))
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
    const std::string keys = contact_keys(list, shown, *style, run);
    if (list.options.dynamics && c.unlike && !nothing(c))
      list.refuse(c.where, "pair_coeff", fmt::format("damping and friction of types {} and {} differ and are not mixed here; give a pair_coeff {} {}", c.first[0],
                                                c.second[0], c.first[0], c.second[0]));
    if (c.mixed && !nothing(c) && style->name == "granular")
      list.note(c.where, "LAMMPS (29 Sep 2021) gives types that have no pair_coeff together Hooke's force k delta with Hertz's k, not Hertz's force of the mixed "
                    "coefficients that its documentation promises; here it is that");
    if (c.law == Law::lj && !nothing(c) && !style->shift)
      list.note(c.where, c.inner_cutoff > 0
                        ? "the energy of this cohesion is 0 at the cutoff; LAMMPS's is that with `pair_modify shift yes`, else it differs by a "
                          "constant of each pair. Forces are the same"
                        : "the energy of this cohesion jumps where it is cut off, as LAMMPS's does (cutoff_style = \"cut\"); \"shifted\" "
                          "and \"smooth\" do not");
    const auto add = [&](const std::vector<int>& a, const std::vector<int>& b) {
      list.put(k, {"contact", "", between_keys(list.groups.of_types(a), list.groups.of_types(b)) + keys, c.where, c.text, 0, {}});
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
  exclusions(list, k, run, acting);
}

}  // namespace elamin::script
