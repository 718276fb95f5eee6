#include "report/shape_data.hpp"

#include "core/error.hpp"
#include "input/conditions.hpp"
#include "input/state_tail.hpp"
#include "report/base64.hpp"
#include "results/body_picture.hpp"
#include "results/fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>

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

// How much of each condition acts at a state; the stages of a path have amounts of their own.
std::vector<double> amounts(const Problem& problem, const Model& model, const StoredState& stored, double load_factor) {
  std::vector<Scaling> scaling = scalings_in(model);
  std::vector<std::string> off;
  if (stored.file.ends_with(".data"))
    if (const auto tail = read_tail(stored.file); tail && tail->stage) {
      if (tail->stage->scaling.size() == scaling.size()) scaling = tail->stage->scaling;
      for (const StageTable& s : problem.stages)
        if (s.name == tail->stage->name) off = s.off;
    }
  std::vector<double> all;
  for (const Scaling& s : scaling) all.push_back(s.at(load_factor));
  const std::vector<Condition> conditions = conditions_of(problem);
  for (const std::string& word : off)
    if (const int k = find_condition(conditions, word); k >= 0 && k < static_cast<int>(all.size())) all[k] = 0;
  return all;
}

float finite_float(double v) { return std::isfinite(v) ? static_cast<float>(v) : 0; }

// Of a particle the largest moment of the angles whose middle it is.
Json fields_data(Energy& energy, const State& state) {
  const Model& model = energy.model();
  const Fields fields = fields_at(energy, state, {});
  std::vector<float> tension, moment(model.particles()), energies;
  for (const BondField& b : fields.bonds) tension.push_back(finite_float(b.tension));
  for (std::size_t k = 0; k < fields.angles.size(); ++k) {
    float &most = moment[model.angles[k].particles[1]], here = finite_float(fields.angles[k].moment);
    if (std::abs(here) > std::abs(most)) most = here;
  }
  for (int i = 0; i < model.particles(); ++i) energies.push_back(finite_float(fields.energy[i]));
  Json j = Json::object();
  if (!model.bonds.empty()) j["tension"] = base64(tension);
  if (!model.angles.empty()) j["moment"] = base64(moment);
  if (model.particles() > 0) j["energy"] = base64(energies);
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
      second = -1 - static_cast<int>(std::find_if(model.walls.begin(), model.walls.end(), [&](const Wall& w) { return w.name == *name; }) - model.walls.begin());
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
  const int eigenvalue = column_index(run.modes.columns, "eigenvalue");
  for (std::size_t k = 0; k < run.modes.rows.size() && eigenvalue >= 0; ++k)
    for (const Field& f : read_displacements(fmt::format("{}/modes/mode-{}.csv", run.directory, k + 1), model))
      all.push_back(displacement_data(fmt::format("mode {}, eigenvalue {:.6g}", k + 1, as_number(run.modes.rows[k][eigenvalue]).value_or(NAN)),
                                      f, model));
  return all;
}

Json state_data(const StoredRun& run, const StoredState& stored, const std::vector<const Row*>& contacts, const Problem& problem,
                Energy& energy) {
  const Model& model = energy.model();
  State state = read_state(stored, model);
  if (!stored.file.ends_with(".data")) state.load_factor = model.start.load_factor;
  const double load_factor = state.load_factor;
  Json j{{"label", stored.label}, {"row", stored.row}, {"lambda", load_factor}, {"x", floats(state.position)}};
  Eigen::MatrixXd poses(7, static_cast<Eigen::Index>(state.bodies.size()));
  for (std::size_t b = 0; b < state.bodies.size(); ++b)
    poses.col(static_cast<Eigen::Index>(b)) << state.bodies[b].position.hi, state.bodies[b].rotation.coeffs();   // x, y, z, w
  j["poses"] = floats(poses);
  j["fields"] = fields_data(energy, state);
  j["contacts"] = contacts_data(contacts, model);
  const std::vector<double> acts = amounts(problem, model, stored, load_factor);
  j["loads"] = Json::array(), j["walls"] = Json::array();
  for (std::size_t k = 0; k < model.loads.size(); ++k) j["loads"].push_back(acts[model.supports.size() + k]);
  for (std::size_t k = 0; k < model.walls.size(); ++k) {
    const double s = acts[acts.size() - model.walls.size() + k];
    j["walls"].push_back({s * model.walls[k].displacement[0], s * model.walls[k].displacement[1], s * model.walls[k].displacement[2],
                          s * model.walls[k].radius_change});
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

}  // namespace

Json structure_data(const Model& model) {
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
  for (const Support& s : model.supports) j["supports"].push_back({{"group", s.group}, {"particles", s.particles}, {"held", names(s.held)}});
  for (const Load& l : model.loads) {
    Field force(3, static_cast<Eigen::Index>(l.particles.size()));
    for (std::size_t k = 0; k < l.particles.size(); ++k) force.col(static_cast<Eigen::Index>(k)) = l.on(k);
    j["loads"].push_back({{"group", l.group}, {"particles", l.particles}, {"force", floats(force)}, {"bodies", l.bodies},
                          {"on_body", numbers(l.force)}, {"point", numbers(l.point)}});
  }
  j["fields"] = Json::array();
  const auto field = [&](const char* key, const char* name, const char* of) { j["fields"].push_back({{"key", key}, {"name", name}, {"of", of}}); };
  if (!model.bonds.empty()) field("tension", "tension of bonds", "bond");
  if (!model.angles.empty()) field("moment", "bending moment", "particle");
  if (model.particles() > 0) field("energy", "energy", "particle");
  j["flat"] = model.plane_normal ? Json(*model.plane_normal) : Json(nullptr);
  return j;
}

Json states_data(const StoredRun& run, const Problem& problem, const Model& model, std::size_t most) {
  Contacts contacts = by_label(run.contacts);
  std::size_t vectors = run.modes.rows.size(), longest = 0;
  for (const StoredState& s : run.states) vectors += std::filesystem::exists(null_vectors_file(s.file));
  for (const auto& [label, rows] : contacts) longest = std::max(longest, rows.size());
  const std::size_t sites = model.start.position.cols() + 2 * model.bodies.size(), states = std::max<std::size_t>(1, run.states.size());
  const std::size_t numbers = 3 * sites + 7 * model.bodies.size() + model.bonds.size() + 2 * model.particles() + 9 * longest + 3 * sites * vectors / states;
  const std::size_t bytes = 300 + 40 * model.walls.size() + 16 * numbers / 3;
  const std::vector<StoredState> taken = thinned(run.states, std::max<std::size_t>(1, most / bytes));
  Energy energy(model);
  Json j{{"stored", run.states.size()}, {"kept", taken.size()}, {"missing", Json::array()}, {"list", Json::array()}};
  for (const StoredState& s : taken) {
    try {
      const Table of_frame = contacts_of_frame(s);
      std::vector<const Row*> rows = contacts[s.label];
      for (const Row& row : of_frame.rows) rows.push_back(&row);
      j["list"].push_back(state_data(run, s, rows, problem, energy));
    } catch (const InputError& error) {
      j["missing"].push_back(error.what());
    }
  }
  return j;
}

}  // namespace elamin
