#include "core/error.hpp"
#include "core/say.hpp"
#include "core/suggest.hpp"
#include "core/text_file.hpp"
#include "energy/energy.hpp"
#include "input/read.hpp"
#include "input/state_supplement.hpp"
#include "model/entities.hpp"
#include "proof/theorem.hpp"
#include "results/json.hpp"
#include "results/results_directory.hpp"
#include "results/run_stages.hpp"
#include "results/summary.hpp"
#include "study/commands.hpp"
#include "study/imperfection.hpp"
#include "study/solving.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <map>

namespace elamin {

namespace {

// "final", "branch:1" or "step=12", of a frame.
const StoredState& stored_at(const StoredRun& run, const std::string& at) {
  const int column = run.path.column("step");
  std::vector<std::string> known;
  for (const StoredState& s : run.states) {
    if (!s.file.ends_with(".data")) continue;
    known.push_back(s.label);
    if (s.label.empty() && column >= 0 && s.row >= 0)
      known.back() = "step=" + csv_text(run.path.rows[s.row][column]);
    if (known.back() == at) return s;
  }
  const std::string meant = did_you_mean(at, known);
  throw InputError(fmt::format("{}: has no state {}; there are: {}{}", run.directory, in_quotes(at), listed(known), meant));
}

State with_tails(const StoredState& stored, const Model& model) {
  State state = read_state(stored, model);
  const auto supplement = read_supplement(stored.file);
  if (supplement && supplement->low.cols() == state.position.cols()) state.low = supplement->low;
  return state;
}

// Laws once, elements with the number of theirs.
template <class L, int n, class Numbers>
Json elements_json(const std::vector<proof::Element<L, n>>& elements, const Numbers& numbers_of) {
  Json laws = Json::array(), all = Json::array();
  std::map<std::vector<double>, std::size_t> known;
  for (const auto& e : elements) {
    const std::vector<double> numbers = numbers_of(e.law);
    const auto [law, is_new] = known.try_emplace(numbers, known.size());
    if (is_new) laws.push_back(numbers);
    Json row = e.particles;
    row.insert(row.begin(), law->second);
    all.push_back(std::move(row));
  }
  return {{"laws", std::move(laws)}, {"elements", std::move(all)}};
}

Json places_json(const State& state) {
  Json all = Json::array();
  for (Eigen::Index p = 0; p < state.particles(); ++p) {
    const Vec3 x = state.position.col(p), low = state.low.col(p);
    all.push_back({x[0], x[1], x[2], low[0], low[1], low[2]});
  }
  return all;
}

Json gaps_json(const std::vector<proof::GapBound>& gaps) {
  Json all = Json::array();
  for (const proof::GapBound& g : gaps) all.push_back({g.particles[0], g.particles[1], json_of(g.gap.lo), json_of(g.gap.hi)});
  return all;
}

// See docs/proofs.md.
Json json_of(const proof::Structure& s, const proof::Theorem& t, const State& state) {
  Json loads = Json::array();
  for (const auto& [p, force, part] : s.loads) loads.push_back({p, force[0], force[1], force[2], part.fixed, part.rate});
  return {
      {"theorem", {{"negative", t.negative}, {"radius", t.radius}, {"error", t.error}, {"moved", t.moved}}},
      {"bounds", {{"shift", t.shift}, {"inverse", t.inverse}, {"residual", t.residual}, {"change", t.change}}},
      {"gaps", {{"closed", gaps_json(t.closed)}, {"open", gaps_json(t.open)}, {"undecided", gaps_json(t.undecided)}}},
      {"structure",
       {{"load_factor", s.load_factor},
        {"bonds", elements_json(s.bonds, [](const proof::Bond& l) { return std::vector{l.K, l.r0, l.r0_tail}; })},
        {"angles", elements_json(s.angles, [](const proof::Angle& l) { return std::vector{l.B, l.cosine, l.sine, double(l.kept)}; })},
        {"contacts", elements_json(s.contacts, [](const proof::Contact& l) { return std::vector{l.k, l.distance}; })},
        {"planes", elements_json(s.planes, [](const proof::Plane& l) {
           return std::vector{l.k, l.radius, l.normal[0], l.normal[1], l.normal[2], l.point[0], l.point[1], l.point[2]};
         })},
        {"rounds", elements_json(s.rounds, [](const proof::Round& l) {
           return std::vector{l.k, l.radius, l.wall_radius, l.center[0], l.center[1], l.center[2], double(l.axis), double(l.inside)};
         })},
        {"loads", std::move(loads)},
        {"dofs", s.dof}}},
      {"state", places_json(state)},
      {"centre", places_json(t.centre)}};
}

// Two digits are rounded by less than 5 %.
void tell(const Model& model, const proof::Theorem& t) {
  const std::string signs =
      t.negative == 0 ? "is positive definite: a minimum"
                      : fmt::format("has exactly {} negative eigenvalue{}: a saddle, unstable", t.negative, t.negative > 1 ? "s" : "");
  say("proven: within {:.2g} of the state there is exactly one equilibrium; it is at most {:.2g} away, and its Hessian {}\n",
      0.95 * (t.radius - t.moved), 1.06 * (t.moved + t.error), signs);
  say("bounds: of the inverse of the Hessian {:.2g}, of its change in a ball of radius {:.2g} {:.2g}, of the residual {:.2g}\n",
      1.06 * t.inverse, 0.95 * t.radius, 1.06 * t.change, 1.06 * t.residual);
  if (t.closed.empty() && t.open.empty() && t.undecided.empty()) return;
  say("contacts that are near: {} closed, {} open, {} not decided\n", t.closed.size(), t.open.size(), t.undecided.size());
  for (const auto& [particles, gap] : t.undecided) {
    const std::string other = particles[1] < 0 ? "a wall" : called(model, particles[1]);
    say("  {} and {}: gap between {:.2g} and {:.2g}\n", called(model, particles[0]), other, gap.lo, gap.hi);
  }
}

}  // namespace

int prove_command(const ProveOptions& options) {
  const StoredRun run = read_run(options.directory);
  const StoredState& stored = stored_at(run, options.at);
  const Problem problem = read_problem((std::filesystem::path(options.directory) / "resolved.toml").string(), {});
  Model all = model_of(problem);
  const std::vector<RunStage> stages = stages_of(run, problem, all);
  const Model& model = stage_of(stages, run, stored).model;
  const auto refuse = [&](const std::string& why) { return complain("not proven: {}\n", why), exit_not_converged; };
  State state = with_tails(stored, model);
  Energy energy(model);
  energy.kinematics().prescribe(state, state.load_factor);
  std::string not_covered;
  const proof::Structure structure = proof::structure_of(model, state, not_covered);
  if (!not_covered.empty()) return refuse(not_covered + " are not covered");
  energy.evaluate(state, false);
  const double residual = energy.relative(energy.gradient()), tolerance = solver_options(problem).tolerance;
  if (!(residual <= tolerance))
    return refuse(fmt::format("the state is no equilibrium to the tolerance of its run: its residual is {:.2g} of the largest internal "
                              "force, the tolerance {:.2g}", residual, tolerance));
  say("{}, {}: load factor {:.10g}, {} particles, {} free coordinates\n", options.directory, options.at, state.load_factor,
      model.particles(), structure.dofs);
  const proof::Theorem t = proof::prove(structure, state);
  if (!t.holds) {
    const bool known = options.at == "final" && run.summary && !run.summary->zero_modes.empty();
    return refuse(t.why_not + (known ? " (free is, as the run has found: " + listed(run.summary->zero_modes) + ")" : ""));
  }
  tell(model, t);
  Json json{{"program", "elamin " + version()}, {"run", options.directory}, {"at", options.at}};
  json.update(json_of(structure, t, state));
  const bool own = options.file.empty();
  const std::string file = own ? (std::filesystem::path(options.directory) / "proof.json").string() : options.file;
  if (own) list_also(options.directory, "proof.json");
  write_text(file, json.dump() + "\n");
  say("written: {}\n", file);
  return exit_done;
}

}  // namespace elamin
