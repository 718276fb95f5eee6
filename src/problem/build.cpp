#include "problem/build.hpp"

#include "model/beam.hpp"
#include "problem/build_checks.hpp"
#include "problem/build_conditions.hpp"
#include "problem/build_groups.hpp"
#include "problem/lammps_data.hpp"
#include "problem/schema.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <cmath>

namespace elamin {
namespace {

/// Room that a particle takes in the model and the checks [bytes].
constexpr double room = 500;

double memory() { return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE)); }

class Builder {
 public:
  Builder(const Problem& problem, bool whole, Mistakes& mistakes) : p_(problem), mistakes_(mistakes), whole_(whole) {}

  Model build() {
    if (p_.plane == "yz") model_.plane_normal = 0;
    if (p_.plane == "xz") model_.plane_normal = 1;
    if (p_.plane == "xy") model_.plane_normal = 2;
    if (p_.lammps) lammps();
    if (!beams()) return {};
    whole_ = whole_ && model_.particles() > 0;
    model_.start.load_factor = p_.path.from;
    if (whole_) check_distinct(p_, model_, mistakes_);
    if (whole_) check_plane(p_, model_, model_.start.position, first_place(), mistakes_);

    Groups groups(model_, whole_, mistakes_);
    for (const std::string& name : unknown_) groups.add_unknown(name);
    for (const GroupTable& g : p_.groups) groups.add(g);
    const bool supports = add_supports(p_, groups, model_, mistakes_);
    if (supports && whole_) check_held(p_, model_, mistakes_);
    add_loads(p_, groups, model_, mistakes_);
    model_.groups = groups.groups();
    if (whole_ && !p_.path.start.empty() && !p_.path.place.broken) restart();
    return std::move(model_);
  }

 private:
  /// What cannot be built; what depends on it is left out of the checks.
  void unknown(const std::string& name) {
    whole_ = false;
    unknown_.push_back(name);
  }
  const TablePlace& first_place() const { return p_.lammps ? p_.lammps->place : p_.beams.front().place; }

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
    if (!data) return unknown("lammps");
    const int n = static_cast<int>(data->id.size());
    if (n == 0) {
      mistakes_.add(p_.lammps->place, "data", "holds no particle");
      return unknown("lammps");
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
    if (data->velocity.cols() == n) model_.velocity = std::move(data->velocity);
    model_.bond_types = std::move(data->bond_types);
    model_.angle_types = std::move(data->angle_types);
    model_.bonds = std::move(data->bonds);
    model_.angles = std::move(data->angles);
    model_.structures.push_back({"lammps", "lammps", 0, n, 0, -1, -1});
  }

  /// False if there are too many particles to build anything.
  bool beams() {
    double total = model_.particles();
    for (const BeamTable& b : p_.beams) total += b.particles;
    if (total > most_particles) {
      if (total - model_.particles() <= most_particles)   // else said when the file was read
        mistakes_.add(fmt::format("the structures have {:.0f} particles together; at most {} can be handled", total,
                                  most_particles));
      return false;
    }
    if (total * room > memory()) {
      mistakes_.add(fmt::format("{:.0f} particles need more memory than this machine has", total));
      return false;
    }
    std::vector<StraightBeam> beams;
    for (const BeamTable& table : p_.beams) {
      if (auto b = table.place.broken ? std::nullopt : beam(table))
        beams.push_back(std::move(*b));
      else
        unknown(table.name);
    }
    add_beams(model_, beams);
    return true;
  }

  std::optional<StraightBeam> beam(const BeamTable& table) {
    const int intervals = table.particles - 1;
    const double thickness = table.thickness.value_or(table.diameter), E = table.youngs_modulus.value_or(0);
    StraightBeam b{table.name, {}, {}, table.particles, table.diameter, table.density.value_or(0), E, {}, {}};
    if (table.from)
      b.from.hi = *table.from, b.to.hi = *table.to;
    else
      std::tie(b.from, b.to) =
          std::tuple_cat(ends_of_row(*table.center, *table.axis, table.spacing.value_or(table.diameter), intervals));
    const double spacing = (distance(b.from, b.to) / Exact{static_cast<double>(intervals), 0}).value();
    if (!std::isfinite(spacing)) {
      mistakes_.add(table.place, "its length is beyond what numbers can hold");
      return std::nullopt;
    }
    // Neighbours must be told apart by doubles, or every length is rounding.
    const double farthest = std::max(b.from.hi.cwiseAbs().maxCoeff(), b.to.hi.cwiseAbs().maxCoeff());
    if (spacing <= 1e-12 * farthest) {
      mistakes_.add(table.place,
                    fmt::format("its spacing, {}, is lost beside its coordinates, {}; place it nearer to the origin",
                                spacing, farthest));
      return std::nullopt;
    }
    b.bond.rest_length = table.rest_length.value_or(spacing);
    b.bond.stiffness = table.bond_stiffness.value_or(bond_stiffness(table.section, E, thickness, b.bond.rest_length));
    b.angle.stiffness =
        table.angle_stiffness.value_or(angle_stiffness(table.section, E, thickness, b.bond.rest_length));
    for (const auto& [name, value] : {std::pair("bond", b.bond.stiffness), {"angle", b.angle.stiffness}})
      if (!std::isnormal(value)) {
        mistakes_.add(table.place, fmt::format("its {} stiffness, {}, is beyond what numbers can hold", name, value));
        return std::nullopt;
      }
    return b;
  }

  void restart() {
    const auto data = read(p_.path.start, "");
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
    model_.restart->load_factor = p_.path.start_lambda.value_or(p_.path.from);
  }

  const Problem& p_;
  Mistakes& mistakes_;
  Model model_;
  bool whole_;                         // no structure was left out
  std::vector<std::string> unknown_;   // names of those that were
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
