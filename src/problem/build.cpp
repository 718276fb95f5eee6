#include "problem/build.hpp"

#include "problem/build_checks.hpp"
#include "problem/build_conditions.hpp"
#include "problem/build_contacts.hpp"
#include "problem/build_groups.hpp"
#include "problem/build_structures.hpp"
#include "problem/lammps_data.hpp"
#include "problem/stages.hpp"
#include "problem/state_tail.hpp"
#include "problem/suggest.hpp"

#include <fmt/format.h>

namespace elamin {
namespace {

class Builder {
 public:
  Builder(const Problem& problem, bool whole, Mistakes& mistakes) : p_(problem), mistakes_(mistakes), whole_(whole) {}

  Model build() {
    if (p_.plane == "yz") model_.plane_normal = 0;
    if (p_.plane == "xz") model_.plane_normal = 1;
    if (p_.plane == "xy") model_.plane_normal = 2;
    if (p_.lammps) lammps();
    if (!add_structures(p_, model_, unknown_, mistakes_)) return {};
    whole_ = whole_ && unknown_.empty() && model_.particles() > 0;
    model_.start.load_factor = p_.path.from;
    if (whole_) check_distinct(p_, model_, mistakes_);
    if (whole_) check_plane(p_, model_, model_.start.position, place_of(p_, model_.structures.front()), mistakes_);

    Groups groups(model_, whole_, mistakes_);
    for (const std::string& name : unknown_) groups.add_unknown(name);
    for (const GroupTable& g : p_.groups) groups.add(g);
    bool holding = add_connections(p_, groups, model_, mistakes_);
    if (p_.in_time()) need_masses(p_, model_, mistakes_);
    holding = add_supports(p_, groups, model_, mistakes_) && holding;
    add_loads(p_, groups, model_, mistakes_);
    holding = add_contacts(p_, groups, model_, mistakes_) && holding;
    if (holding && whole_) check_all_held();
    if (holding && whole_) check_modes(p_, model_, mistakes_);
    model_.groups = groups.groups();
    if (whole_ && !p_.path.start.empty() && !p_.path.place.broken) restart();
    if (holding && whole_) check_sides(p_, model_, mistakes_);
    if (holding && whole_ && p_.in_time() && !mistakes_.any()) check_timestep(p_, model_, mistakes_);
    return std::move(model_);
  }

 private:
  /// A LAMMPS data file, or nothing if it holds mistakes.
  std::optional<LammpsData> read(const std::string& file, const std::string& atom_style) {
    try {
      return read_lammps_data(file, atom_style);
    } catch (const InputError& e) {
      mistakes_.add(e.mistakes());
      return std::nullopt;
    }
  }

  void lammps() {
    auto data = p_.lammps->place.broken ? std::nullopt : read(p_.lammps->data, p_.lammps->atom_style);
    if (!data) return unknown_.push_back("lammps");
    const int n = static_cast<int>(data->id.size());
    if (n == 0) {
      mistakes_.add(p_.lammps->place, "data", "holds no particle");
      return unknown_.push_back("lammps");
    }
    model_.start = State(std::move(data->position));
    model_.id = std::move(data->id);
    model_.type = std::move(data->type);
    model_.molecule = std::move(data->molecule);
    model_.diameter = std::move(data->diameter);
    model_.density = std::move(data->density);
    // Mass given by type instead: the density that a sphere of that mass has.
    for (int i = 0; i < n; ++i)
      if (const double d = model_.diameter[i]; model_.density[i] == 0 && d > 0 && !data->mass.empty())
        model_.density[i] = data->mass[i] / (pi / 6 * d * d * d);
    take_velocities(*data);
    model_.bond_types = std::move(data->bond_types);
    model_.angle_types = std::move(data->angle_types);
    model_.bonds = std::move(data->bonds);
    model_.angles = std::move(data->angles);
    model_.structures.push_back({"lammps", "lammps", 0, n, 0, -1, -1});
  }

  /// Held in every stage.
  void check_all_held() {
    if (p_.stages.empty()) return check_held(p_, model_, mistakes_);
    Stages stages(p_);
    Model all = model_;
    for (const StageTable& table : p_.stages) {
      std::string unclear;
      const Stage stage = stages.enter(unclear);
      Mistakes of_stage(p_.file);
      check_held(p_, model_in(stage, all, model_.start), of_stage);
      for (const Mistake& m : of_stage.list()) mistakes_.add(table.place, m.key + ": " + m.what);
      stages.leave(stage.path.to);
    }
  }

  /// At rest where the file tells no velocities.
  void take_velocities(LammpsData& data) {
    model_.velocity = std::move(data.velocity);
    model_.spin = data.spin.isZero(0) ? Field() : std::move(data.spin);
  }

  void restart() {
    auto data = read(p_.path.start, "");
    if (!data) return;
    if (data->id != model_.id) {
      mistakes_.add(p_.path.place, "start",
                    data->id.size() != model_.id.size()
                        ? fmt::format("holds {} particles, the problem {}; it must be a state of this problem",
                                      data->id.size(), model_.id.size())
                        : "holds particles with other ids; it must be a state of this problem");
      return;
    }
    check_plane(p_, model_, data->position, p_.path.place, mistakes_);
    model_.restart = State(data->position);
    if (p_.in_time()) take_velocities(*data);
    model_.restart->load_factor = p_.path.start_lambda.value_or(p_.path.from);
    try {
      if (const auto stored = read_tail(p_.path.start)) {
        take_tail(stored->tail);
        if (stored->stage && !p_.stages.empty() && !Stages(p_).resume(*stored->stage))
          mistakes_.add(p_.path.place, "start", fmt::format("is a state of the stage {}, and the problem has no such stage or "
                                                            "other tables", quoted(stored->stage->name)));
      }
    } catch (const InputError& e) {
      mistakes_.add(e.mistakes());
    }
  }

  /// The tails of the restart's positions, each of them less than half a unit in the last place.
  void take_tail(const Field& tail) {
    State& state = *model_.restart;
    if (tail.cols() != state.position.cols() || state.position + tail != state.position)
      mistakes_.add(p_.path.place, "start",
                    fmt::format("and {} beside it are not of one state; take the latter away, or both from one run",
                                quoted(tail_file(p_.path.start))));
    else
      state.tail = tail;
  }

  const Problem& p_;
  Mistakes& mistakes_;
  Model model_;
  bool whole_;                         // no structure was left out
  std::vector<std::string> unknown_;   // names of those that were; what depends on them is left out of the checks
};

}  // namespace

Model build_model(const Problem& problem) {
  Mistakes mistakes(problem.file);
  Model model = Builder(problem, true, mistakes).build();
  mistakes.raise();
  return model;
}

void check_model(const Problem& problem, bool whole, Mistakes& mistakes) { Builder(problem, whole, mistakes).build(); }

}  // namespace elamin
