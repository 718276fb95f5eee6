// Runs: what is in force in them, and what is known behind them.
#include "lammps/script/building.hpp"
#include "lammps/script/held.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin::script::command {
namespace {

constexpr std::size_t most_runs = 1000;

/// Where the steps of a run and those of its ramps begin and end.
struct Span { bool minimize = false; long long steps = 0, before = 0, total = 0; };

/// What v_NAME is (of style atom: of each atom) as a run begins and as it ends; in between it must be linear in the step.
std::array<std::vector<double>, 2> over_run(Interpreter& in, const std::string& formula, bool each, const Span& span, const std::string& what) {
  World& w = in.world;
  struct Leave { World& w; ~Leave() { w.moment = {}; } } leave{w};
  const auto wrong = [&](const std::string& why) { throw Wrong(0, fmt::format("{}: {} {}", what, in_quotes(formula), why)); };
  Dependence on;
  const auto at = [&](long long step) {
    w.moment = {step, span.before, span.total};
    const Value v = evaluate(formula, w, in.names, 0, each, &on);
    const std::vector<double> values = v.each.empty() ? std::vector(each ? w.atoms.size() : 1, v.number) : v.each;
    if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) wrong("is not finite");
    return values;
  };
  const std::vector<double> begin = at(0);
  if (on.places) wrong("depends on where particles are, which is not followed");
  if (on.time && span.minimize) wrong("changes in time, which a minimisation does not have");
  if (!on.time || span.steps == 0) return {begin, begin};
  const std::vector<double> end = at(span.steps);
  constexpr int samples = 32;                      // at multiples of the golden ratio: in step with no period of a formula
  for (int k = 0; k < samples + 2; ++k) {
    const double golden = 0.6180339887498949 * k;
    const long long step = k == samples       ? 1
                           : k == samples + 1 ? span.steps - 1
                                              : static_cast<long long>((golden - std::floor(golden)) * static_cast<double>(span.steps));
    const std::vector<double> now = at(step);
    const double part = static_cast<double>(step) / static_cast<double>(span.steps);
    for (std::size_t i = 0; i < now.size(); ++i) {
      const double line = begin[i] + part * (end[i] - begin[i]), size = std::max({std::abs(begin[i]), std::abs(end[i]), std::abs(now[i])});
      // Nothing but rounding may be off the line: formulas of a few operations round to some 1e-15 of what goes into them.
      if (!(std::abs(now[i] - line) <= 1e-10 * size))
        wrong(fmt::format("is not linear in the step of this run: {} as it begins, {} as it ends, {} at step {} of {}; a load factor takes what "
                          "is; write several runs, with ramp(A, B) in each",
                          begin[i], end[i], now[i], step, span.steps));
    }
  }
  return {begin, end};
}

/// What the formulas of a fix are in this run.
void evaluate_formulas(Interpreter& in, Run::Active& a, const Span& span) {
  Fix& f = a.fix;
  const std::string what = fmt::format("fix {} of line {}", f.id, f.where.line);
  if (f.kind == Fix::Kind::gravity && !f.formulas[0].empty()) {
    const auto g = over_run(in, f.formulas[0], false, span, what);
    f.vector = g[0][0] * f.direction, f.end = g[1][0] * f.direction;
  }
  for (std::size_t c = 0; c < 3 && f.kind == Fix::Kind::force; ++c) {
    if (f.formulas[c].empty()) continue;
    const bool each = in.names.of_atoms(f.formulas[c]);
    const auto values = over_run(in, f.formulas[c], each, span, what);
    if (!each) {
      f.vector[c] = values[0][0], f.end[c] = values[1][0];
      continue;
    }
    a.own.resize(a.members.size(), {Vec3::Zero(), Vec3::Zero()});
    for (std::size_t k = 0; k < a.members.size(); ++k)
      for (std::size_t end = 0; end < 2; ++end) a.own[k][end][c] = values[end][a.members[k]];
  }
  for (Fix::Wall& wall : f.walls)
    for (std::size_t c = 0; c < 4; ++c) {
      if (wall.formulas[c].empty()) continue;
      const auto values = over_run(in, wall.formulas[c], false, span, what + ", its region");
      for (std::size_t end = 0; end < 2; ++end) {
        if (c < 3) wall.moved[end][c] = values[end][0];
        else wall.grown[end] = values[end][0] - wall.region.radius;
        if (c == 3 && !(values[end][0] > 0))
          throw Wrong(0, fmt::format("{}: the radius of its region is {}; it must be above 0", what, values[end][0]));
      }
    }
}

/// Pairs that are left out in a run.
std::vector<Run::Excluded> excluded(const World& w, const std::vector<int>& atoms) {
  using Of = Exclusion::Of;
  constexpr std::size_t most_molecules = 1000;
  std::vector<Run::Excluded> all;
  const auto add = [&](const Exclusion& e, const std::vector<int>& I, const std::vector<int>& J) {
    if (!I.empty() && !J.empty() && (I != J || I.size() > 1)) all.push_back({{I, J}, e.where, e.text});
  };
  for (const Exclusion& e : w.exclusions) {
    std::array<std::vector<int>, 2> sides;
    std::map<int, std::vector<int>> molecules;
    for (const int k : atoms) {
      const Atom& a = w.atoms[k];
      for (std::size_t s = 0; s < 2; ++s)
        if (e.of == Of::types ? a.type == e.which[s] : w.in(a, e.which[s])) sides[s].push_back(k);
      if (e.of == Of::molecules && w.in(a, e.which[0])) molecules[a.molecule].push_back(k);
    }
    if (e.of != Of::molecules) add(e, sides[0], sides[1]);
    if (molecules.size() > most_molecules)
      throw Wrong(0, fmt::format("`{}` is of {} molecules; at most {} are taken", e.text, molecules.size(), most_molecules));
    for (const auto& [number, members] : molecules) add(e, members, members);
  }
  return all;
}

/// The checks of a run, and what is in force in it.
Run in_force(Interpreter& in, const Span& span) {
  World& w = in.world;
  needs_box(in);
  for (int c = 0; c < 3; ++c)
    if (w.boundary[c].find('p') != std::string::npos && !(c == 2 && w.dimension == 2))
      throw Wrong(0, fmt::format("the box is periodic along {}: elamin has no periodic boxes. Write `boundary f f f` (or s) before the box is "
                                 "made, or `change_box all boundary f f f` behind it, with walls or room around what there is", "xyz"[c]));
  Run r;
  r.where = in.where, r.minimize = span.minimize, r.steps = span.steps, r.timestep = w.timestep;
  r.text = in.text();
  for (std::size_t k = 0; k < w.atoms.size(); ++k)
    if (World::there(w.atoms[k])) r.atoms.push_back(static_cast<int>(k));
  if (r.atoms.empty() && !r.still()) throw Wrong(0, "there is no atom");
  if (w.runs.size() >= most_runs) throw Wrong(0, fmt::format("is one more than {} runs", most_runs));
  for (Fix& f : w.fixes) {
    if (f.kind == Fix::Kind::ignored) continue;
    Run::Active a{f, {}, {}};
    const int g = w.group(f.group, 0);
    for (const int k : r.atoms)
      if (w.in(w.atoms[k], g)) a.members.push_back(k);
    if (a.members.empty()) continue;
    if (f.kind == Fix::Kind::move && span.steps > 0) {
      if (f.timestep > 0 && f.timestep != w.timestep)
        throw Wrong(0, fmt::format("the timestep has changed since fix {} began to move its atoms: LAMMPS puts them where they "
                                   "would be if it had been the new one from then on; the fix said anew behind `timestep` moves them on from where they are", f.id));
      f.timestep = w.timestep;
    }
    if (!f.region.empty()) {                      // it may have been made anew
      const auto region = w.regions.find(f.region);
      if (region == w.regions.end() || region->second.kind != ScriptRegion::Kind::shape)
        throw Wrong(0, fmt::format("the region {} of the fix {} is there no more", in_quotes(f.region), f.id));
      Fix::Wall& wall = a.fix.walls[0];
      wall.region = region->second.shape, wall.inside = region->second.inside, wall.formulas = region->second.formulas;
    }
    evaluate_formulas(in, a, span);
    r.fixes.push_back(std::move(a));
  }
  for (const int k : r.atoms)
    for (std::size_t c = 0; c < 3; ++c)
      if (w.atoms[k].v[c] != 0) r.thrown[c] = true;
  r.held = held_in(w, r);
  for (const auto& [h, members] : r.held) {       // by fixes that let go on what moves
    if (h.fix < 0 || r.fixes[h.fix].fix.kind != Fix::Kind::hold || r.minimize) continue;
    const Fix& f = r.fixes[h.fix].fix;
    if (std::any_of(members.begin(), members.end(), [&](int k) { return w.atoms[k].drifts; }))
      w.not_in_motion.push_back({f.where, "fix", f.id + ", which lets what moved freely go on at the velocity that it has by then, "});
    if (!h.velocity.isZero(0) && !w.runs.empty() &&
        std::none_of(w.runs.back().fixes.begin(), w.runs.back().fixes.end(), [&](const Run::Active& a) { return a.fix.serial == f.serial; }))
      in.note(fmt::format("fix {} lets what it holds go on at the velocity that it had, as LAMMPS does; `velocity {} set 0 0 0` before stops it", f.id, f.group));
  }
  r.excluded = excluded(w, r.atoms);
  r.pairs = w.pairs, r.special_lj = w.special_lj, r.special_coul = w.special_coul;
  for (const auto& b : w.bonds)
    if (b.gone == always && !r.bonds.count(b.type)) r.bonds[b.type] = w.of_bonds(b.type);
  for (const auto& a : w.angles)
    if (a.gone == always && !r.angles.count(a.type)) r.angles[a.type] = w.of_angles(a.type);
  if (!w.runs.empty())                            // glue that was there keeps its stiffness within a problem
    for (const auto& [now, before] : {std::pair(&r.bonds, &w.runs.back().bonds), {&r.angles, &w.runs.back().angles}})
      for (const auto& [type, c] : *now)
        if (const auto old = before->find(type); old != before->end() && !(old->second == c)) w.change({}, true);
  if (w.unspecial)
    in.note(
        "bonds made with `special no` are not known to LAMMPS's contacts: it lets bonded pairs touch, here they do as special_bonds says");
  return r;
}

/// The record of a run; then what is known of where things are.
void record(Interpreter& in, const Span& span) {
  World& w = in.world;
  w.shrink_box();
  if (span.steps == 0 && !span.minimize && !w.runs.empty()) return in.ignore("a run of no steps moves nothing");
  Run r = in_force(in, span);
  for (const int k : r.atoms)
    if (Atom& a = w.atoms[k]; a.born == w.run_number()) a.start = a.x, a.start_v = a.v;
  if (r.still()) {                                 // a study only if nothing else is run
    w.still = std::move(r), w.atoms_of_still = w.atoms;
    return;
  }
  struct Motion { int held = 0; Vec3 held_at = Vec3::Zero(), after = Vec3::Zero(); };   // coordinates that are held, velocities
  std::vector<Motion> motions(w.atoms.size());
  for (const auto& [h, members] : r.held)
    for (const int k : members) {
      Motion& m = motions[k];
      m.held += static_cast<int>(std::count(h.directions.begin(), h.directions.end(), true));
      m.held_at += h.velocity, m.after += h.fix < 0 ? w.atoms[k].v : h.velocity;
    }
  for (const int k : r.atoms) {
    Atom& a = w.atoms[k];
    const Motion& m = motions[k];
    if (m.held == 3) a.x += m.held_at * r.time();
    else a.moved = true, a.drifts = a.drifts || !r.minimize;
    if (!r.minimize) a.v = m.after;
  }
  w.last_run = in.where;
  w.step += r.steps, w.time += r.minimize ? 0 : r.time();
  w.runs.push_back(std::move(r));
  w.shrink_box();
  if (in.after >= in.options.after.size()) return;
  take_positions(in, in.options.after[in.after++]);
  // From here on it is a problem by itself: what was run is behind it.
  for (Atom& a : w.atoms) a.moved = a.drifts = false, a.born = 0, a.v.setZero(), a.omega.setZero(), a.gone = a.gone == always ? always : -1;
  std::erase_if(w.bonds, [](const auto& b) { return b.gone != always; });
  std::erase_if(w.angles, [](const auto& b) { return b.gone != always; });
  for (auto& b : w.bonds) b.born = 0;
  for (auto& b : w.angles) b.born = 0;
  w.runs.clear(), w.still.reset(), w.removals.clear();
  w.shrink_box();
}

}  // namespace

void run(Interpreter& in) {
  in.wants(2, "run STEPS");
  constexpr long long most = 1000000000000000000;
  long long steps = in.integer(1, 0, most), start = in.world.step, stop = -1;
  for (std::size_t i = 2; i < in.size();) {
    const std::string& k = in.word(i);
    if (k == "upto") steps = std::max(0LL, steps - in.world.step), ++i;
    else if (k == "start") start = in.integer(i + 1, 0, in.world.step), i += 2;
    else if (k == "stop") stop = in.integer(i + 1, 0, most), i += 2;
    else if (k == "pre" || k == "post") i += 2;
    else if (k == "every") throw Wrong(i, "commands within a run are not followed; write several runs", true);
    else throw Wrong(i, in_quotes(k) + " is no keyword of run");
  }
  if (in.world.step > most - steps) throw Wrong(1, "is more steps than can be counted");
  if (stop < 0) stop = in.world.step + steps;
  if (stop < in.world.step + steps) throw Wrong(0, "stops its ramps before it ends; stop is a step that it ends at or before");
  record(in, {false, steps, in.world.step - start, stop - start});
}

void minimize(Interpreter& in) {
  in.wants(5, "minimize ETOL FTOL ITERATIONS EVALUATIONS", 5);
  record(in, {true, 0, 0, 0});
}

}  // namespace elamin::script::command
