#include "core/find.hpp"
#include "report/run_data.hpp"

#include "core/error.hpp"
#include "report/base64.hpp"
#include "results/surfaces.hpp"
#include "results/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <utility>

namespace elamin {
namespace {

Json numbers(const Vec3& v) { return {v[0], v[1], v[2]}; }

std::string floats(const Eigen::Ref<const Eigen::MatrixXd>& m) {
  std::vector<float> all;
  for (Eigen::Index c = 0; c < m.cols(); ++c)
    for (Eigen::Index r = 0; r < m.rows(); ++r) all.push_back(static_cast<float>(m(r, c)));
  return base64(all);
}

Json surface_data(const RoundedShape& shape) {
  const Surface s = surface_of(shape);
  Field points(3, static_cast<Eigen::Index>(s.points.size()));
  for (std::size_t k = 0; k < s.points.size(); ++k) points.col(static_cast<Eigen::Index>(k)) = s.points[k];
  std::vector<std::int32_t> triangles;
  for (const std::vector<int>& p : s.polygons)
    for (std::size_t k = 2; k < p.size(); ++k) triangles.insert(triangles.end(), {p[0], p[k - 1], p[k]});
  return {{"points", floats(points)}, {"triangles", base64(triangles)}};
}

Json wall_data(const Wall& wall) {
  const Region& r = wall.region;
  Json j{{"name", wall.name}};
  switch (r.shape) {
    case Shape::plane: j.update({{"shape", "plane"}, {"center", numbers(r.center)}, {"normal", numbers(r.normal)}}); break;
    case Shape::block: j.update({{"shape", "block"}, {"lo", numbers(r.lo)}, {"hi", numbers(r.hi)}}); break;
    case Shape::sphere: j.update({{"shape", "sphere"}, {"center", numbers(r.center)}, {"radius", r.radius}}); break;
    case Shape::cylinder:
    case Shape::cone: {
      const bool cone = r.shape == Shape::cone;
      j.update({{"shape", "cone"}, {"center", numbers(r.center)}, {"axis", r.axis}, {"lo", json_of(r.axial_lo)}, {"hi", json_of(r.axial_hi)},
                {"radius_lo", cone ? r.radius_lo : r.radius}, {"radius_hi", cone ? r.radius_hi : r.radius}});
    }
  }
  return j;
}

Json names(const std::array<bool, 3>& held) {
  std::string all;
  for (int c = 0; c < 3; ++c)
    if (held[c]) all += "xyz"[c];
  return all;
}

float finite_float(double v) { return std::isfinite(v) ? static_cast<float>(v) : 0; }

bool is_sheet(const Structure& s) { return s.kind == "sheet"; }

constexpr std::array<const char*, 6> resultants{"N11", "N22", "N12", "M11", "M22", "M12"};

// Bonds are those of all stages. Of a particle the largest moment and curvature of the angles whose middle it is.
Json fields_data(Energy& energy, const State& state, const std::vector<int>& bonds, const Model& all) {
  const Model& model = energy.model();
  const Fields fields = fields_at(energy, state, {});
  std::vector<float> tension(all.bonds.size()), moment(model.particles()), curvature(moment), energies;
  for (std::size_t b = 0; b < bonds.size(); ++b) tension[bonds[b]] = finite_float(fields.bonds[b].tension);
  for (std::size_t k = 0; k < fields.angles.size(); ++k) {
    const AngleField& angle = fields.angles[k];
    for (const auto& [of, here] : {std::pair(&moment, angle.moment), {&curvature, angle.curvature}})
      if (float& most = (*of)[model.angles[k].particles[1]]; std::abs(here) > std::abs(most)) most = finite_float(here);
  }
  for (int i = 0; i < model.particles(); ++i) energies.push_back(finite_float(fields.energy[i]));
  Json j = Json::object();
  if (!all.bonds.empty()) j["tension"] = base64(tension);
  if (!all.angles.empty()) j["moment"] = base64(moment), j["curvature"] = base64(curvature);
  if (model.particles() > 0) j["energy"] = base64(energies);
  for (std::size_t c = 0; c < resultants.size() && !fields.sheets.empty(); ++c) {
    std::vector<float> of;
    for (const StressResultants& r : fields.sheets) of.push_back(finite_float((c < 3 ? r.N : r.M)[static_cast<int>(c % 3)]));
    j[resultants[c]] = base64(of);
  }
  return j;
}

/// The rows of contacts.csv by the label of their state.
using Contacts = std::map<std::string, std::vector<const Row*>>;

Contacts by_label(const Table& table) {
  Contacts all;
  for (const Row& row : table.rows) all[csv_text(row[0])].push_back(&row);
  return all;
}

// Closed contacts of a frame have a table of their own.
Table contacts_of_frame(const StoredState& stored) {
  const std::string file = std::filesystem::path(stored.file).replace_extension(".contacts.csv").string();
  return stored.label.empty() && std::filesystem::exists(file) ? read_table(file) : Table{};
}

// Columns: see RunDirectory::add_state.
Json contacts_data(const std::vector<const Row*>& rows, const Model& model) {
  std::vector<std::int32_t> pairs;
  std::vector<float> numbers;
  for (const Row* row : rows) {
    const auto number = [&](std::size_t c) { return as_number((*row)[c]).value_or(0); };
    int second = static_cast<int>(number(3));
    if (const std::string* name = std::get_if<std::string>(&(*row)[3]))
      second = -1 - static_cast<int>(find_named(model.walls, *name) - model.walls.data());
    pairs.insert(pairs.end(), {static_cast<int>(number(2)), second});
    for (const std::size_t c : {4, 6, 7, 8, 9, 10, 11}) numbers.push_back(static_cast<float>(number(c)));
  }
  return {{"pairs", base64(pairs)}, {"numbers", base64(numbers)}};
}

Json displacement_data(const std::string& name, const Field& field, const Model& model) {
  const int n = model.particles(), m = static_cast<int>(model.bodies.size());
  return {{"name", name}, {"u", floats(field.leftCols(n))}, {"v", floats(field.rightCols(2 * m))}};
}

Json modes_data(const StoredRun& run, const StoredState& stored, const Model& model) {
  Json all = Json::array();
  const std::vector<Field> vectors = read_displacements(null_vectors_file(stored.file), model);
  for (std::size_t k = 0; k < vectors.size(); ++k)
    all.push_back(displacement_data(vectors.size() > 1 ? fmt::format("null vector {}", k + 1) : "null vector", vectors[k], model));
  const int eigenvalue = run.modes.column("eigenvalue");
  for (std::size_t k = 0; k < run.modes.rows.size() && eigenvalue >= 0; ++k)
    for (const Field& f : read_displacements(fmt::format("{}/modes/mode-{}.csv", run.directory, k + 1), model))
      all.push_back(displacement_data(fmt::format("mode {}, eigenvalue {:.6g}", k + 1, as_number(run.modes.rows[k][eigenvalue]).value_or(NAN)),
                                      f, model));
  return all;
}

Json state_data(const StoredRun& run, const StoredState& stored, const std::vector<const Row*>& contacts, const RunStage& in,
                Energy& energy, const Model& all) {
  const Model& model = in.model;
  State state = read_state(stored, model);
  if (!stored.file.ends_with(".data")) state.load_factor = model.start.load_factor;
  const double load_factor = state.load_factor;
  Json j{{"label", stored.label}, {"row", stored.row}, {"lambda", load_factor}, {"x", floats(state.position)}};
  Eigen::MatrixXd poses(7, static_cast<Eigen::Index>(state.bodies.size()));
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    poses.col(static_cast<Eigen::Index>(b)) << state.bodies[b].position.hi, state.bodies[b].rotation.coeffs();   // x, y, z, w
  j["poses"] = floats(poses);
  j["fields"] = fields_data(energy, state, in.bonds, all);
  j["contacts"] = contacts_data(contacts, model);
  const std::size_t first_wall = in.stage.scaling.size() - all.walls.size(), first_load = all.supports.size();
  const auto acts = [&](std::size_t k) { return in.stage.in_force[k] ? in.stage.scaling[k].at(load_factor) : 0; };
  j["loads"] = Json::array(), j["walls"] = Json::array();
  for (std::size_t k = 0; k < all.loads.size(); ++k) j["loads"].push_back(acts(first_load + k));
  for (std::size_t k = 0; k < all.walls.size(); ++k) {
    const Wall& wall = all.walls[k];
    const Vec3 moved = acts(first_wall + k) * wall.displacement;
    j["walls"].push_back({moved[0], moved[1], moved[2], acts(first_wall + k) * wall.radius_change});
  }
  j["modes"] = modes_data(run, stored, model);
  return j;
}

/// Which of the states are taken: as many as fit, evenly, labelled ones before others.
std::vector<StoredState> thinned(const std::vector<StoredState>& all, std::size_t fit) {
  if (all.size() <= fit) return all;
  std::vector<std::size_t> named, others, taken;
  for (std::size_t k = 0; k < all.size(); ++k) (all[k].label.empty() ? others : named).push_back(k);
  const auto take = [&](const std::vector<std::size_t>& from, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) taken.push_back(from[count > 1 ? k * (from.size() - 1) / (count - 1) : 0]);
  };
  const std::size_t most_named = std::min(named.size(), fit);
  take(named, most_named);
  take(others, std::min(others.size(), fit - most_named));
  std::sort(taken.begin(), taken.end());
  std::vector<StoredState> states;
  for (const std::size_t k : taken) states.push_back(all[k]);
  return states;
}

// What is not there, and what of supports and walls is in force.
Json stage_data(const RunStage& in, const Model& all) {
  std::vector<std::int32_t> absent, unbound;
  for (std::size_t p = 0; p < in.absent.size(); ++p)
    if (in.absent[p]) absent.push_back(static_cast<int>(p));
  for (int b = 0; b < static_cast<int>(all.bonds.size()); ++b)
    if (!std::binary_search(in.bonds.begin(), in.bonds.end(), b)) unbound.push_back(b);
  const auto in_force = [&](std::size_t first, std::size_t count) {
    const auto begin = in.stage.in_force.begin() + static_cast<std::ptrdiff_t>(first);
    return std::vector<bool>(begin, begin + static_cast<std::ptrdiff_t>(count));
  };
  return {{"name", in.stage.name}, {"absent", base64(absent)}, {"unbound", base64(unbound)}, {"supports", in_force(0, all.supports.size())},
          {"walls", in_force(in.stage.scaling.size() - all.walls.size(), all.walls.size())}};
}

}  // namespace

Json structure_data(const Model& model, const std::vector<RunStage>& stages) {
  Json j;
  j["id"] = base64(std::vector<std::int32_t>(model.id.begin(), model.id.end()));
  std::vector<float> radius;
  for (const double d : model.diameter) radius.push_back(static_cast<float>(d / 2));
  j["radius"] = base64(radius);
  std::vector<std::int32_t> bonds;
  for (const Bond& b : model.bonds) bonds.insert(bonds.end(), {b.particles[0], b.particles[1]});
  j["bonds"] = base64(bonds);
  j["structures"] = Json::array();
  for (const Structure& s : model.structures)
    j["structures"].push_back({{"name", s.name}, {"kind", s.kind}, {"first", s.first}, {"count", s.count}, {"first_body", s.first_body},
                               {"bodies", s.bodies}});
  j["surfaces"] = Json::array(), j["bodies"] = Json::array();
  for (const RoundedShape& s : model.shapes) j["surfaces"].push_back(surface_data(s));
  for (const Body& b : model.bodies) j["bodies"].push_back({{"shape", b.shape}, {"id", b.id}});
  j["walls"] = Json::array();
  for (const Wall& w : model.walls) j["walls"].push_back(wall_data(w));
  j["supports"] = Json::array(), j["loads"] = Json::array();
  for (const Support& s : model.supports)
    j["supports"].push_back({{"group", s.group}, {"particles", s.particles}, {"held", names(s.held)}, {"bodies", s.bodies},
                             {"turns", names(s.constrained_rotations)}});
  for (const Load& l : model.loads) {
    Field force(3, static_cast<Eigen::Index>(l.particles.size()));
    for (std::size_t k = 0; k < l.particles.size(); ++k) force.col(static_cast<Eigen::Index>(k)) = l.on(k);
    j["loads"].push_back({{"group", l.group}, {"particles", l.particles}, {"force", floats(force)}, {"bodies", l.bodies},
                          {"on_body", numbers(l.force)}, {"point", numbers(l.point)}, {"torque", numbers(l.torque)}});
  }
  j["fields"] = Json::array();
  const auto field = [&](const std::string& key, const std::string& name, const char* of) {
    j["fields"].push_back({{"key", key}, {"name", name}, {"of", of}});
  };
  if (!model.bonds.empty()) field("tension", "tension of bonds", "bond");
  if (!model.angles.empty()) field("moment", "bending moment", "particle"), field("curvature", "curvature", "particle");
  if (model.particles() > 0) field("energy", "energy", "particle");
  const bool touch = !model.contacts.empty() || !model.rounded.empty() || !model.walls.empty();
  if (model.particles() > 0 && touch) field("force", "contact force", "particle");
  if (std::any_of(model.structures.begin(), model.structures.end(), is_sheet))
    for (const char* r : resultants) field(r, std::string(r) + " of sheets", "sheet");
  j["stages"] = Json::array();
  for (const RunStage& s : stages) j["stages"].push_back(stage_data(s, model));
  j["flat"] = model.plane_normal ? Json(*model.plane_normal) : Json(nullptr);
  return j;
}

Json states_data(const StoredRun& run, const std::vector<RunStage>& stages, const Model& model, std::size_t most) {
  Contacts contacts = by_label(run.contacts);
  std::size_t vectors = run.modes.rows.size(), longest = 0;
  for (const StoredState& s : run.states) vectors += std::filesystem::exists(null_vectors_file(s.file));
  for (const auto& [label, rows] : contacts) longest = std::max(longest, rows.size());
  const std::size_t sites = model.start.position.cols() + 2 * model.bodies.size(), states = std::max<std::size_t>(1, run.states.size());
  const bool sheets = std::any_of(model.structures.begin(), model.structures.end(), is_sheet);
  const std::size_t of_bodies = 7 * model.bodies.size(), of_particles = (3 + (sheets ? resultants.size() : 0)) * model.particles();
  const std::size_t numbers = 3 * sites + of_bodies + of_particles + model.bonds.size() + 9 * longest + 3 * sites * vectors / states;
  const std::size_t bytes = 300 + 40 * model.walls.size() + 16 * numbers / 3;
  const std::vector<StoredState> taken = thinned(run.states, std::max<std::size_t>(1, most / bytes));
  const RunStage* in = nullptr;
  std::optional<Energy> energy;                                            // of its model
  Json j{{"stored", run.states.size()}, {"kept", taken.size()}, {"missing", Json::array()}, {"list", Json::array()}};
  for (const StoredState& s : taken) {
    try {
      const Table of_frame = contacts_of_frame(s);
      std::vector<const Row*> rows = contacts[s.label];
      for (const Row& row : of_frame.rows) rows.push_back(&row);
      const RunStage& stage = stage_of(stages, run, s);
      if (&stage != std::exchange(in, &stage)) energy.emplace(stage.model);
      j["list"].push_back(state_data(run, s, rows, stage, *energy, model));
      j["list"].back()["stage"] = &stage - stages.data();
    } catch (const InputError& error) {
      j["missing"].push_back(error.what());
    }
  }
  return j;
}

}  // namespace elamin
