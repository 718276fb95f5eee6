#include "input/stages.hpp"

#include "core/find.hpp"
#include "input/check.hpp"
#include "input/staged_structure.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <set>

namespace elamin {
namespace {

/// Everything that a stage may switch: the conditions, then the contacts of particles, then those of rounded bodies.
std::vector<Condition> tables_of(const Problem& problem) {
  std::vector<Condition> all = conditions_of(problem);
  for (const bool rounded : {false, true})
    for (std::size_t i = 0; i < problem.contacts.size(); ++i)
      if ((problem.contacts[i].law == "rounded") == rounded)
        all.push_back({problem.contacts[i].place, "contact", "", static_cast<int>(i) + 1, false});
  return all;
}

/// Calls with every table, in the same order.
template <class P, class Call> void for_tables(P& p, const Call& call) {
  const auto all = [&](auto& tables) {
    for (auto& t : tables) call(t.place, t.from_stage);
  };
  all(p.supports), all(p.loads), all(p.gravity), all(p.pressures), all(p.changes), all(p.walls);
  for (const bool rounded : {false, true})
    for (auto& c : p.contacts)
      if ((c.law == "rounded") == rounded) call(c.place, c.from_stage);
}

bool named(const Condition& table, const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) { return table.answers_to(word); });
}

}  // namespace

bool moves(const Problem& p, const Condition& c) {
  const std::size_t i = c.number - 1;
  if (c.kind == "support") return p.supports[i].displacement != Vec3::Zero() || (p.supports[i].rotation && p.supports[i].rotation->angle != 0);
  if (c.kind == "wall") return p.walls[i].displacement != Vec3::Zero() || p.walls[i].radius_change != 0;
  return true;
}

std::vector<std::string> varied(const Problem& problem, const Stage& stage) {
  const std::vector<Condition> conditions = conditions_of(problem);
  std::vector<std::string> labels;
  for (std::size_t i = 0; i < std::min(conditions.size(), stage.scaling.size()); ++i)
    if (stage.scaling[i].rate != 0) labels.push_back(conditions[i].label());
  return labels;
}

Stages::Stages(const Problem& problem)
    : problem_(problem), tables_(tables_of(problem)), conditions_(conditions_of(problem).size()), in_force_(in_force_by_stage(problem)),
      offset_(conditions_), was_in_force_(tables_.size(), true), varied_(conditions_) {
  for (std::size_t i = 0; i < conditions_; ++i)
    amount_.push_back(scaling_of(problem, tables_[i]).rate == 0 ? 1 : 0);
}

int Stages::count() const { return std::max(1, static_cast<int>(problem_.stages.size())); }

bool Stages::resume(const StoredStage& stored) {
  if (stored.scaling.size() != conditions_) return false;
  for (int k = 0; k < static_cast<int>(problem_.stages.size()); ++k) {
    if (problem_.stages[k].name != stored.name) continue;
    next_ = k, resumed_ = stored;
    for (std::size_t i = 0; i < tables_.size(); ++i)
      for (int before = 0; before < k; ++before)
        was_in_force_[i] = was_in_force_[i] && in_force_[before][i];
    return true;
  }
  return false;
}

Stage Stages::enter(std::string& unclear) {
  const bool first = next_ == 0;
  const StageTable* t = !problem_.stages.empty() ? &problem_.stages[next_] : nullptr;
  Stage stage{t ? t->name : "", next_, problem_.path, {}, {}, {}};
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    stage.in_force.push_back(in_force_[next_][i]);
    stage.entering.push_back(!first && stage.in_force[i] && !was_in_force_[i]);
  }
  was_in_force_ = stage.in_force;

  // Where the load factor begins: where what it moves has been left.
  std::vector<std::size_t> moved;
  for (std::size_t i = 0; i < conditions_; ++i) {
    const bool chosen = t && t->vary ? named(tables_[i], *t->vary) : scaling_of(problem_, tables_[i]).rate != 0;
    varied_[i] = chosen && stage.in_force[i];
    if (stage.entering[i] && tables_[i].kind == "support") offset_[i] = 0, amount_[i] = 0;
    else if (varied_[i] && moves(problem_, tables_[i])) moved.push_back(i);
  }
  PathTable& path = stage.path;
  if (!first) path.from = moved.empty() ? 0 : amount_[moved[0]] - offset_[moved[0]];
  if (!first && !(t && t->from))
    for (const std::size_t i : moved)
      if (amount_[i] - offset_[i] != path.from) {
        unclear = fmt::format("is not clear: {} is at load factor {}, {} at {}; give from, or vary fewer of them",
                              tables_[moved[0]].label(), path.from, tables_[i].label(), amount_[i] - offset_[i]);
        break;
      }
  if (t) {
    path.from = t->from.value_or(path.from), path.to = t->to.value_or(path.to), path.steps = t->steps.value_or(path.steps);
    path.method = t->method.value_or(path.method);
    if (t->when_unstable) path.when_unstable = t->when_unstable;
  }
  if (!first) path.start_lambda.reset();

  for (std::size_t i = 0; i < conditions_; ++i) {
    if (stage.entering[i] && tables_[i].kind == "support") offset_[i] = -path.from;     // counts from where it enters
    stage.scaling.push_back(varied_[i] ? Scaling(offset_[i], 1) : Scaling(amount_[i], 0));
  }
  if (resumed_) {
    path.from = resumed_->from, path.start_lambda = problem_.path.start_lambda;
    stage.scaling = resumed_->scaling;
    for (std::size_t i = 0; i < conditions_; ++i) {
      amount_[i] = stage.scaling[i].at(path.start_lambda.value_or(path.from));
      if (varied_[i]) offset_[i] = stage.scaling[i].fixed;
    }
    resumed_.reset(), unclear.clear();
  }
  ++next_;
  return stage;
}

void Stages::leave(double load_factor) {
  for (std::size_t i = 0; i < conditions_; ++i)
    if (varied_[i]) amount_[i] = offset_[i] + load_factor;
}

Model model_in(const Problem& problem, const Stage& stage, Model& all, const State& now) {
  const std::vector<Scaling*> scalings = scalings_in(all);
  for (std::size_t i = 0; i < scalings.size(); ++i) *scalings[i] = stage.in_force[i] ? stage.scaling[i] : Scaling(0, 0);
  for (std::size_t s = 0; s < all.supports.size(); ++s) {
    if (!stage.entering[s]) continue;
    const double factor = stage.scaling[s].at(stage.path.start_lambda.value_or(stage.path.from));
    Support& support = all.supports[s];
    support.reference.clear(), support.body_reference.clear();
    const auto before = [&](ExactVector at) {
      for (int c = 0; c < 3; ++c) {
        const Exact x = Exact{at.hi[c], at.lo[c]} + two_product(-factor, support.displacement[c]);
        at.hi[c] = x.hi, at.lo[c] = x.lo;
      }
      return at;
    };
    for (const int p : support.particles) support.reference.push_back(before(now.at(p)));
    for (const int b : support.bodies)
      support.body_reference.push_back({before(now.bodies[b].position), quaternion(-factor * support.rotation) * now.bodies[b].rotation});
  }
  Model model = all;
  const auto keep = [&](auto& list, std::size_t begin) {
    auto from = std::move(list);
    list.clear();
    for (std::size_t i = 0; i < from.size(); ++i)
      if (stage.in_force[begin + i]) list.push_back(std::move(from[i]));
  };
  const std::size_t conditions = stage.scaling.size(), walls = conditions - model.walls.size();
  const std::size_t contacts = conditions + model.contacts.size();
  keep(model.contacts, conditions), keep(model.rounded, contacts);
  for (std::size_t w = 0; w < model.walls.size(); ++w)
    if (!stage.in_force[walls + w]) model.walls[w].particles.clear(), model.walls[w].bodies.clear();
  keep(model.supports, 0);
  leave_out(problem, stage.number, model, now);
  return model;
}

std::vector<std::vector<bool>> in_force_by_stage(const Problem& problem) {
  const std::vector<Condition> tables = tables_of(problem);
  std::vector<std::size_t> from;
  for_tables(problem, [&](const TablePlace&, const std::string& stage) { from.push_back(static_cast<std::size_t>(stage_number(problem, stage))); });
  std::vector<std::array<std::string, 2>> called;
  for (const Condition& c : tables) called.push_back({c.label(), c.kind + "." + std::to_string(c.number)});
  std::vector<std::vector<bool>> all(std::max<std::size_t>(1, problem.stages.size()), std::vector<bool>(tables.size(), true));
  for (std::size_t k = 0; k < problem.stages.size(); ++k) {
    const std::set<std::string> off(problem.stages[k].off.begin(), problem.stages[k].off.end());
    for (std::size_t i = 0; i < tables.size(); ++i) all[k][i] = k >= from[i] && !off.count(called[i][0]) && !off.count(called[i][1]);
  }
  return all;
}

void check_stages(Problem& problem, Mistakes& mistakes) {
  std::vector<std::string> names;
  const std::set<std::string> taken{"initial", "final", at_sweep};
  for (StageTable& s : problem.stages) {
    if (taken.count(s.name)) mistakes.add(s.place, "name", in_quotes(s.name) + " is reserved for the ends of a path");
    else if (!s.name.empty() && contains(names, s.name))
      mistakes.add(s.place, "name", in_quotes(s.name) + " is the name of another [[stage]]; names are unique");
    names.push_back(s.name);
  }
  for_tables(problem, [&](TablePlace& place, const std::string& from) { check_from_stage(problem, place, from, mistakes); });
  if (problem.stages.empty()) return;

  const std::vector<Condition> tables = tables_of(problem), conditions = conditions_of(problem);
  const auto refer = [&](StageTable& s, const char* key, const std::vector<std::string>& words, const std::vector<Condition>& to) {
    for (const std::string& word : words)
      if (find_condition(to, word) < 0) mistakes.add(s.place, key, in_quotes(word) + " names no table; " + there_are(labels_of(to), word));
  };
  for (StageTable& s : problem.stages) {
    if (s.vary) refer(s, "vary", *s.vary, conditions);
    refer(s, "off", s.off, tables);
    if (!s.vary) continue;
    for (const std::string& word : *s.vary)
      if (const int i = find_condition(conditions, word); i >= 0 && named(conditions[i], s.off))
        mistakes.add(s.place, "vary", in_quotes(word) + " is off in this stage");
  }
  for (const char* key : {"branches", "deflate"})
    if (problem.path.place.keys.count(key) && (problem.path.branches > 0 || problem.path.deflate > 0))
      mistakes.add(problem.path.place, key, "is of paths without stages: a stage goes on from where the one before has ended");
  if (problem.path.place.broken) return;

  Stages stages(problem);
  for (StageTable& s : problem.stages) {
    std::string unclear;
    const Stage stage = stages.enter(unclear);
    if (!unclear.empty()) mistakes.add(s.place, "from", unclear);
    else if (stage.path.from == stage.path.to && !s.place.broken)
      mistakes.add(s.place, "to", fmt::format("is the same load factor as from, {}; a stage leads from one to another", stage.path.to));
    stages.leave(stage.path.to);
  }
}

}  // namespace elamin
