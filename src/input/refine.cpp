#include "input/refine.hpp"

#include "core/suggest.hpp"
#include "input/parts.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {

void describe(Keys& keys, RefineTable& t) {
  keys.about("The same structures with the spacing divided again and again: what the results are where there are no particles, with an error.");
  keys.may("by", t.by, "by how much the spacing is divided from one level to the next", Range{2, 10});
  keys.may("levels", t.levels, "how many, with the spacing of the file", Range{3, 10});
  keys.one_or_more("divide", t.divide, "numbers of the file that are divided, too, such as \"constants.h\", by which regions of a lattice are given");
}

void check_refine(Problem& p, Mistakes& mistakes) {
  if (!p.refine) return;
  RefineTable& t = *p.refine;
  if (p.study != StudyType::path && p.study != StudyType::equilibrium)
    mistakes.add(t.place, "is of a path or an equilibrium; other studies have no value without particles");
  if (p.lammps) mistakes.add(t.place, "cannot put other particles into a LAMMPS data file");
  if (p.beams.empty() && p.loops.empty() && p.sheets.empty() && !p.lammps)
    mistakes.add(t.place, "finds nothing with a spacing: no [[beam]], [[loop]] or [[sheet]]");
  const NamedNumbers none, &numbers = p.constants ? p.constants->numbers : none;
  for (const std::string& key : t.divide)
    if (std::none_of(numbers.begin(), numbers.end(), [&](const auto& c) { return key == "constants." + c.first; }))
      mistakes.add(t.place, "divide", in_quotes(key) + " is none of [constants]; name one, such as \"constants.h\"");
  if (!p.path.start.empty()) mistakes.add(t.place, "does not go with path.start, a state of as many particles as there are");
  if (p.curve) mistakes.add(t.place, "does not go with [curve]; refine one threshold of it");
  if (p.imperfection && !p.imperfection->modes) mistakes.add(t.place, "does not go with an imperfection that a state or chance gives to each particle; give modes");
  const auto refuse = [&](const TablePlace& place, const char* what) { mistakes.add(t.place, fmt::format("cannot refine {}, {}", place.key, what)); };
  for_structures(p, [&](const char*, const auto& tables) {
    for (const auto& s : tables)
      if constexpr (requires { s.values; s.rest; })
        if (!s.values.empty()) refuse(s.place, "whose `values` are a row a particle");
  });
  const auto all = [&](const auto& tables, const char* what) {
    for (const auto& s : tables) refuse(s.place, what);
  };
  all(p.connections, "which bonds particles by their distance"), all(p.bonds, "bonds between single particles"), all(p.angles, "angles between single particles");
  all(p.removals, "which takes single particles"), all(p.glue, "which glues single particles to a body");
  for (const ContactTable& c : p.contacts)
    if (c.law == "lj") refuse(c.place, "whose energy is of pairs of particles, more of which there would be");
}

}  // namespace elamin
