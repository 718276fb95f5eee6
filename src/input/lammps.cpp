#include "input/lammps.hpp"

#include "core/dense.hpp"
#include "core/error.hpp"
#include "core/suggest.hpp"
#include "input/document.hpp"
#include "input/parts.hpp"
#include "input/stages.hpp"
#include "input/state_supplement.hpp"
#include "lammps/data.hpp"
#include "lammps/script/report.hpp"
#include "lammps/script/translation.hpp"
#include "lammps/state.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

namespace elamin {

void describe(Keys& keys, LammpsTable& t) {
  keys.about("Particles, bonds, angles (with their coefficients) and bodies from LAMMPS data files, or all that a LAMMPS input script makes. "
             "Atom type 2 is the group \"type2\", and its label one too; ids are LAMMPS's own.");
  keys.may_file("data", t.data, "the data file");
  keys.may_file("bodies", t.bodies, "a data file of bodies beside it");
  keys.may_file("input", t.input, "a LAMMPS input script instead: its particles, and as tables before those of this file what is in force in it");
  keys.may("particles_only", t.particles_only, "of the script only the particles, bonds, angles and bodies");
  keys.may("atom_style", t.atom_style, "LAMMPS's, where the comment behind \"Atoms\" does not say it");
  keys.one_or_more("ignore", t.ignore, "sections that are passed over, as [\"Dihedrals\", \"Impropers\"], with their coefficients");
  keys.may("bond_coefficients", t.bond_coefficients, "[[K, r0], …] of the bond types from 1, instead of those in the file");
  keys.may("angle_coefficients", t.angle_coefficients,
           "[[B], …] of the angle types, U = B (1 + cos θ), or [B, θ₀] with U = B (1 − cos(θ − θ₀)), θ₀ in degrees");
  keys.one_at_least({"data", "bodies", "input"}, "give data = \"case.data\"");
}

bool has_particles(const LammpsTable& t) { return !t.data.empty() || (t.script && !t.script->particles.empty()); }

LammpsReading reading_of(const LammpsTable& t) {
  using Rows = std::vector<std::vector<double>>;
  LammpsReading how{t.atom_style, t.ignore.value_or(std::vector<std::string>()), t.bond_coefficients.value_or(Rows()),
                    t.angle_coefficients.value_or(Rows())};
  if (t.script) how.text = &t.script->particles;
  return how;
}

void check_lammps(LammpsTable& t, Mistakes& mistakes) {
  if (!t.input.empty() && (!t.script || t.script->files.front() != t.input) && !t.place.broken)
    mistakes.add(t.place, "input", "is read with the file, before settings and sweeps change it; they cannot change the script");
  if (t.particles_only && t.input.empty()) mistakes.add(t.place, "particles_only", "is of a script; give input = \"in.lmp\"");
  const auto row = [&](const char* key, const std::vector<double>& c, std::size_t least, const char* wanted) {
    const bool good = c.size() >= least && c.size() <= 2 && std::all_of(c.begin(), c.end(), [](double x) { return x >= 0; }) &&
                      (least == 2 || c.size() < 2 || c[1] <= 180);
    if (!good) mistakes.add(t.place, key, fmt::format("of a type must be {}, is [{}]", wanted, fmt::join(c, ", ")));
    return good;
  };
  for (const auto& c : reading_of(t).bond_coefficients)
    if (!row("bond_coefficients", c, 2, "two numbers that are not negative, [K, r0]")) break;
  for (const auto& c : reading_of(t).angle_coefficients)
    if (!row("angle_coefficients", c, 1, "[B], or [B, θ₀] with θ₀ from 0 to 180 degrees, B not negative")) break;
  for (const std::string& section : reading_of(t).ignore)
    if (section == "Atoms" || section == "Bodies")
      mistakes.add(t.place, "ignore", in_quotes(section) + " cannot be passed over; without it there is nothing");
  if (!t.place.broken) t.labels = atom_type_labels(t.data);
}

namespace {

/// A LAMMPS data file, or nothing if it holds mistakes.
std::optional<LammpsData> read(const std::string& file, const LammpsReading& how, Mistakes& mistakes) {
  return mistakes.unless_wrong([&] { return read_lammps_data(file, how); });
}

void move_bodies(LammpsData& from, LammpsData& to) {
  to.shapes = std::move(from.shapes), to.bodies = std::move(from.bodies), to.body_position = std::move(from.body_position);
  to.body_velocity = std::move(from.body_velocity), to.angular_momentum = std::move(from.angular_momentum);
}

/// The files of [lammps] as one; nothing after a mistake.
std::optional<LammpsData> read(const LammpsTable& table, Mistakes& mistakes) {
  if (table.place.broken) return std::nullopt;
  std::optional<LammpsData> data, bodies;
  const bool particles = has_particles(table);
  if (particles) data = read(table.script ? table.input : table.data, reading_of(table), mistakes);
  LammpsReading of_bodies = reading_of(table);
  of_bodies.text = nullptr;
  if (particles) of_bodies.atom_style.clear();
  if (!table.bodies.empty()) bodies = read(table.bodies, of_bodies, mistakes);
  if ((particles && !data) || (!table.bodies.empty() && !bodies)) return std::nullopt;
  if (bodies && !bodies->id.empty()) {
    mistakes.add(table.place, "bodies", fmt::format("holds {} particles; these belong into the file of `data`", bodies->id.size()));
    return std::nullopt;
  }
  if (data && bodies && !data->bodies.empty()) {
    mistakes.add(table.place, "bodies", "and `data` both hold bodies; all of them belong into one file");
    return std::nullopt;
  }
  if (!data) data.emplace();
  if (bodies) move_bodies(*bodies, *data);
  for (const Body& b : data->bodies)
    if (std::binary_search(data->id.begin(), data->id.end(), b.id)) {
      mistakes.add(table.place, "bodies", fmt::format("the id {} is that of a body and of a particle; one id names one of them", b.id));
      return std::nullopt;
    }
  return data;
}

/// At rest where the file tells no velocities.
void take_velocities(LammpsData& data, Model& model) {
  model.velocity = std::move(data.velocity);
  model.angular_velocity = data.angular_velocity.isZero(0) ? Field() : std::move(data.angular_velocity);
  model.body_velocity = std::move(data.body_velocity), model.angular_momentum = std::move(data.angular_momentum);
}

/// The rotation R with R r = v for all vertices, in the sense of least squares.
Eigen::Quaterniond rotation_between(const std::vector<Vec3>& r, const std::vector<Vec3>& v) {
  if (r.size() < 2) return Eigen::Quaterniond::Identity();
  if (r.size() == 2) return shortest_rotation(Vec3(r[1] - r[0]), Vec3(v[1] - v[0]));   // a rod: without a turn about itself
  Mat3 m = Mat3::Zero();
  for (std::size_t k = 0; k < r.size(); ++k) m += v[k] * r[k].transpose();
  const Singular svd = singular_values(m);
  const Mat3 flip = Vec3(1, 1, Mat3(svd.u * svd.v.transpose()).determinant() < 0 ? -1 : 1).asDiagonal();
  return Eigen::Quaterniond(Mat3(svd.u * flip * svd.v.transpose())).normalized();
}

/// How far a shape turned by q is from another one, relative to its size; infinity if they do not compare.
double off(const RoundedShape& shape, const Eigen::Quaterniond& q, const RoundedShape& other) {
  if (shape.vertices.size() != other.vertices.size()) return infinity;
  double most = std::abs(shape.radius - other.radius);
  for (std::size_t k = 0; k < shape.vertices.size(); ++k)
    most = std::max(most, (q * shape.vertices[k] - other.vertices[k]).norm());
  return most / shape.bounding_radius();
}

class Restart {
 public:
  Restart(const Problem& problem, Model& model, Mistakes& mistakes) : p_(problem), model_(model), mistakes_(mistakes) {}

  void add() {
    const LammpsReading as_written;
    auto data = read(p_.path.start, as_written, mistakes_);
    if (!data) return;
    if (!model_.bodies.empty() && model_.particles() > 0 && data->bodies.empty()) {
      auto bodies = read(bodies_file(p_.path.start), as_written, mistakes_);
      if (!bodies) return;
      move_bodies(*bodies, *data);
    }
    std::vector<int> own, ids;
    for (const Body& b : model_.bodies) own.push_back(b.id);
    for (const Body& b : data->bodies) ids.push_back(b.id);
    const bool particles = same(data->id, model_.id, "particles");
    if (!same(ids, own, "bodies") || !particles) return;
    model_.restart = State(data->position);
    if (!take_poses(*data)) return;
    check_plane(p_, model_, *model_.restart, p_.path.place, mistakes_);
    if (p_.in_time()) take_velocities(*data, model_);
    model_.restart->load_factor = p_.path.start_lambda.value_or(p_.path.from);
    try {
      if (const auto stored = read_supplement(p_.path.start)) {
        take_low_words(*stored, *data);
        if (stored->stage && !p_.stages.empty() && !Stages(p_).resume(*stored->stage))
          mistakes_.add(p_.path.place, "start", fmt::format("is a state of the stage {}, and the problem has no such stage or "
                                                            "other tables", in_quotes(stored->stage->name)));
      }
    } catch (const InputError& e) {
      mistakes_.add(e.mistakes());
    }
    if (p_.in_time()) drive_on();
  }

 private:
  /// Supports that stand, or move in time, hold on to what they hold where the state has it.
  void drive_on() {
    for (Support& s : model_.supports) {
      if (s.velocity.isZero(0) && !(s.displacement.isZero(0) && s.rotation.isZero(0))) continue;
      s.displacement.setZero(), s.rotation.setZero();
      s.reference.clear(), s.body_reference.clear();
      for (const int p : s.particles) s.reference.push_back(model_.restart->at(p));
      for (const int b : s.bodies) s.body_reference.push_back(model_.restart->bodies[b]);
    }
  }

  bool same(const std::vector<int>& ids, const std::vector<int>& own, const char* what) {
    if (ids == own) return true;
    mistakes_.add(p_.path.place, "start",
                  ids.size() != own.size() ? fmt::format("holds {} {}, the problem {}; it must be a state of this problem",
                                                         ids.size(), what, own.size())
                                           : fmt::format("holds {} with other ids; it must be a state of this problem", what));
    return false;
  }

  bool take_poses(const LammpsData& data) {
    for (std::size_t b = 0; b < data.bodies.size(); ++b) {
      const RoundedShape &own = model_.shapes[model_.bodies[b].shape], &there = data.shapes[data.bodies[b].shape];
      const bool alike = own.vertices.size() == there.vertices.size();
      const Eigen::Quaterniond q = alike ? rotation_between(own.vertices, there.vertices) : Eigen::Quaterniond::Identity();
      if (!(off(own, q, there) <= 1e-6)) {
        mistakes_.add(p_.path.place, "start", fmt::format("holds {} in another shape; it must be a state of this problem",
                                                          called(model_, model_.particles() + static_cast<int>(b))));
        model_.restart.reset();
        return false;
      }
      model_.restart->bodies.push_back({{data.body_position.col(static_cast<Eigen::Index>(b)), Vec3::Zero()}, q});
    }
    return true;
  }

  /// The tails of the restart's positions, each of them less than half a unit in the last place, and the rotations.
  void take_low_words(const StateSupplement& stored, const LammpsData& data) {
    State& state = *model_.restart;
    bool one = stored.low.cols() == state.position.cols() && state.position + stored.low == state.position &&
               stored.bodies.size() == state.bodies.size();
    for (std::size_t b = 0; one && b < stored.bodies.size(); ++b) {
      const Vec3& x = state.bodies[b].position.hi;
      one = x + stored.bodies[b].position.lo == x &&
            off(model_.shapes[model_.bodies[b].shape], stored.bodies[b].rotation, data.shapes[data.bodies[b].shape]) <= 1e-12;
    }
    if (!one)
      return mistakes_.add(p_.path.place, "start",
                           fmt::format("and {} beside it are not of one state; take the latter away, or both from one run",
                                       in_quotes(supplement_file(p_.path.start))));
    state.low = stored.low;
    for (std::size_t b = 0; b < stored.bodies.size(); ++b) {
      state.bodies[b].position.lo = stored.bodies[b].position.lo;
      state.bodies[b].rotation = stored.bodies[b].rotation;
    }
  }

  const Problem& p_;
  Model& model_;
  Mistakes& mistakes_;
};

}  // namespace

bool add_lammps(const Problem& problem, Model& model, Mistakes& mistakes) {
  auto data = read(*problem.lammps, mistakes);
  if (!data) return false;
  const int n = static_cast<int>(data->id.size()), bodies = static_cast<int>(data->bodies.size());
  if (n + bodies == 0) {
    mistakes.add(problem.lammps->place, "data", "holds no particle and no body");
    return false;
  }
  if (n > 0) model.start = State(std::move(data->position));
  model.id = std::move(data->id);
  model.type = std::move(data->type);
  model.molecule = std::move(data->molecule);
  model.diameter = std::move(data->diameter);
  model.density = std::move(data->density);
  // Mass given by type instead: the density that a sphere of that mass has.
  for (int i = 0; i < n; ++i)
    if (const double d = model.diameter[i]; model.density[i] == 0 && !data->mass.empty())
      model.density[i] = data->mass[i] / (d > 0 ? pi / 6 * d * d * d : 1);
  take_velocities(*data, model);
  model.bond_types = std::move(data->bond_types);
  model.angle_types = std::move(data->angle_types);
  model.bonds = std::move(data->bonds);
  model.angles = std::move(data->angles);
  model.shapes = std::move(data->shapes);
  model.bodies = std::move(data->bodies);
  for (int b = 0; b < bodies; ++b)
    model.start.bodies.push_back({{data->body_position.col(b), Vec3::Zero()}, Eigen::Quaterniond::Identity()});
  model.structures.push_back({"lammps", "lammps", 0, n, 0, -1, -1, 0, bodies});
  return true;
}

LammpsRemarks lammps_remarks(const Problem& problem) {
  LammpsRemarks remarks;
  if (!problem.lammps) return remarks;
  Mistakes mistakes(problem.file);
  if (const auto data = read(*problem.lammps, mistakes)) {
    remarks.notes = data->notes;
    if (!data->doubt.empty()) remarks.warnings.push_back(data->doubt);
  }
  return remarks;
}

void add_restart(const Problem& problem, Model& model, Mistakes& mistakes) { Restart(problem, model, mistakes).add(); }

namespace {

namespace fs = std::filesystem;

void merge(Entries& own, Entries&& script) {
  for (Entry& e : script) {
    Node* const there = find(own, e.key);
    if (!there) {
      own.push_back(std::move(e));
    } else if (is_tables(*there) && is_tables(e.node)) {
      List& mine = std::get<List>(there->value);
      List& first = std::get<List>(e.node.value);
      mine.insert(mine.begin(), std::make_move_iterator(first.begin()), std::make_move_iterator(first.end()));
    } else if (std::holds_alternative<Entries>(there->value) && std::holds_alternative<Entries>(e.node.value)) {
      merge(std::get<Entries>(there->value), std::move(std::get<Entries>(e.node.value)));
    }
  }
}

}  // namespace

void take_lammps_input(Document& document) {
  Node* const table = find(document.root, "lammps");
  if (document.script || !table || !std::holds_alternative<Entries>(table->value)) return;
  Entries& lammps = std::get<Entries>(table->value);
  const Node* const input = find(lammps, "input");
  if (!input || !std::holds_alternative<std::string>(input->value)) return;
  const Place place = input->place;
  const std::string name = std::get<std::string>(input->value);
  const auto wrong = [&](const std::string& what) { throw InputError({Mistake{document.file, place.line, place.column, "lammps.input", what}}); };
  if (name.empty()) wrong("is empty; the name of a LAMMPS input script is wanted");
  Node* const only = find(lammps, "particles_only");
  const bool tables = !only || !std::holds_alternative<bool>(only->value) || !std::get<bool>(only->value);
  for (const char* key : {"data", "bodies"})
    if (find(lammps, key) && (tables || key[0] == 'd'))
      wrong(fmt::format("and {} are both given; the script says where its particles are from", in_quotes(key)));
  const script::Reading reading = script::read_script((fs::path(document.file).parent_path() / name).string(), {});
  if (reading.passes.size() != 1)
    wrong(reading.passes.empty() ? "makes no particle that is there at its end"
                                 : fmt::format("begins anew and gives {} problems; `elamin import` writes them all", reading.passes.size()));
  if (reading.passes[0].stopped)
    wrong(fmt::format("needs positions behind a run at {}; `elamin import` writes what comes before, and with --after what follows",
                      reading.place(*reading.passes[0].stopped)));
  script::Translated made = script::translated(reading, reading.passes[0], {}, "");
  document.script = {std::move(made.data), {}, script::notes_of(reading, made.notes)};
  for (const auto& files : {reading.files, reading.data_files})
    for (const std::string& f : files) document.script->files.push_back(fs::absolute(f).lexically_normal().string());
  Entries entries = parse_entries(made.toml, reading.files.front());
  for (Entry& e : entries) e.place = place, set_place(e.node, place);
  std::erase_if(std::get<Entries>(find(entries, "lammps")->value), [](const Entry& e) { return e.key == "data"; });
  if (!tables) std::erase_if(entries, [](const Entry& e) { return e.key != "lammps"; });
  else if (only) only->value = true;
  else lammps.push_back({"particles_only", place, {place, true}});
  merge(document.root, std::move(entries));
}

}  // namespace elamin
