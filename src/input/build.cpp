#include "input/build.hpp"

#include "core/find.hpp"
#include "input/check.hpp"
#include "input/parts.hpp"
#include "input/group.hpp"
#include "input/lammps.hpp"
#include "input/staged_structure.hpp"
#include "input/stages.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace elamin {
namespace {

class Builder {
 public:
  Builder(const Problem& problem, bool whole, Mistakes& mistakes) : p_(problem), mistakes_(mistakes), whole_(whole) {}

  Model build(const std::vector<OwnLaw>& own) {
    if (p_.plane == "yz") model_.plane_normal = 0;
    if (p_.plane == "xz") model_.plane_normal = 1;
    if (p_.plane == "xy") model_.plane_normal = 2;
    if (p_.lammps && !add_lammps(p_, model_, mistakes_)) unknown_.push_back("lammps");
    if (!add_structures(p_, model_, unknown_, mistakes_)) return {};
    add_bodies(p_, model_, unknown_, mistakes_);
    whole_ = whole_ && unknown_.empty() && model_.particles() + model_.bodies.size() > 0;
    model_.start.load_factor = p_.path.from;
    if (whole_) check_distinct(p_, model_, mistakes_);
    if (whole_) check_plane(p_, model_, model_.start, place_of(p_, model_.structures.front()), mistakes_);

    if (whole_) add_own(own);

    Groups groups(model_, whole_, mistakes_);
    if (p_.lammps) groups.add_labels(p_.lammps->labels);
    for (const std::string& name : unknown_) groups.add_unknown(name);
    for (const GroupTable& g : p_.groups) groups.add(g);
    bool holding = add_connections(p_, groups, model_, mistakes_);
    holding = add_glue(p_, groups, model_, mistakes_) && holding;
    if (p_.in_time()) need_masses(p_, model_, mistakes_);
    holding = add_supports(p_, groups, model_, mistakes_) && holding;
    add_loads(p_, groups, model_, mistakes_);
    add_motion(p_, groups, model_, mistakes_);
    bool contacts = add_contacts(p_, groups, model_, mistakes_);
    contacts = add_walls(p_, groups, model_, mistakes_) && contacts;
    if (contacts) check_observed(p_, groups, model_, mistakes_);
    holding = contacts && holding;
    model_.groups = groups.groups();
    if (holding && whole_) check_bodies_built(p_, model_, mistakes_);
    if (holding && whole_) check_all_held();
    if (holding && whole_) check_modes(p_, model_, mistakes_);
    if (whole_ && !p_.path.start.empty() && !p_.path.place.broken) add_restart(p_, model_, mistakes_);
    if (holding && whole_) check_sides(p_, model_, mistakes_);
    if (holding && whole_ && p_.in_time() && !mistakes_.any()) check_timestep(p_, model_, mistakes_);
    return std::move(model_);
  }

 private:
  void add_own(const std::vector<OwnLaw>& own) {
    const std::vector<std::string> taken = taken_columns(p_);
    for (const OwnLaw& law : own) {
      if (contains(taken, law.term))
        mistakes_.add(fmt::format("the law \"{}\": there is a column of this name already; give it another one", law.term));
      std::optional<int> wrong;
      for (const std::vector<int>& element : law.elements)
        for (const int p : element)
          if (p < 0 || p >= model_.particles()) wrong = p;
      for (const ObserveTable& o : p_.observe)
        if (o.name == law.term)
          mistakes_.add(o.place, "name", fmt::format("\"{}\" is the name of a law that the program brings along", o.name));
      if (wrong)
        mistakes_.add(fmt::format("the law \"{}\" is of a particle number {}; the problem has {}, which count from 0", law.term, *wrong,
                                  model_.particles()));
      else
        model_.own.push_back(law);
    }
  }

  /// Held in every stage.
  void check_all_held() {
    if (p_.stages.empty()) return check_held(p_, model_, mistakes_);
    Stages stages(p_);
    Model all = model_;
    for (const StageTable& table : p_.stages) {
      std::string unclear;
      const Stage stage = stages.enter(unclear);
      if (connects_before(p_, stage.number)) return;           // where to is not known yet
      Mistakes of_stage(p_.file);
      check_held(p_, model_in(p_, stage, all, model_.start), of_stage);
      for (const Mistake& m : of_stage.list()) mistakes_.add(table.place, m.key + ": " + m.what);
      stages.leave(stage.path.to);
    }
  }

  const Problem& p_;
  Mistakes& mistakes_;
  Model model_;
  bool whole_;                         // no structure was left out
  std::vector<std::string> unknown_;   // names of those that were; what depends on them is left out of the checks
};

}  // namespace

Model build_model(const Problem& problem, const std::vector<OwnLaw>& own) {
  Mistakes mistakes(problem.file);
  Model model = Builder(problem, true, mistakes).build(own);
  mistakes.raise();
  return model;
}

void check_model(const Problem& problem, bool whole, Mistakes& mistakes) { Builder(problem, whole, mistakes).build({}); }

}  // namespace elamin
