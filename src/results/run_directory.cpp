#include "results/run_directory.hpp"

#include "model/entities.hpp"
#include "input/state_supplement.hpp"
#include "path/arc.hpp"
#include "results/surfaces.hpp"
#include "results/columns.hpp"
#include "results/stored_run.hpp"
#include "lammps/state.hpp"
#include "core/text_file.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

namespace elamin {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> contact_columns{"label", "lambda", "first", "second", "gap", "force", "fx", "fy", "fz", "x", "y", "z"};

/// Of a path without frames none.
std::vector<std::string> films_of(const Problem& problem) {
  if (problem.in_time()) return problem.dynamics.film;
  if (!problem.follows_path() || !problem.path.has_frames()) return {};
  return problem.path.film.value_or(std::vector<std::string>{"lammpstrj", "pvd"});
}

void append(Row& row, const Eigen::Ref<const Eigen::VectorXd>& numbers) {
  for (const double x : numbers) row.emplace_back(x);
}

}  // namespace

std::vector<std::string> inputs_of(const Problem& problem) {
  std::vector<std::string> all;
  const auto add = [&](const std::string& data) {
    if (data.empty()) return;
    for (const std::string& file : {data, supplement_file(data), bodies_file(data)}) all.push_back(file);
  };
  add(problem.path.start);
  if (problem.landscape && !problem.landscape->run.empty())
    for (const StoredState& s : read_run(problem.landscape->run).states) add(s.file);
  if (problem.lammps) add(problem.lammps->data), add(problem.lammps->bodies);
  if (problem.lammps && problem.lammps->script)
    for (const std::string& file : problem.lammps->script->files) all.push_back(file);
  for (const GrainsTable& t : problem.grains) all.push_back(t.file);
  for (const BodyTable& t : problem.bodies) all.push_back(t.molecule);
  std::erase_if(all, [](const std::string& file) { return file.empty() || !fs::exists(file); });
  return all;
}

ResultsDirectory::Files inputs_in(const std::string& directory, const Problem& problem) {
  ResultsDirectory::Files inside;
  const fs::path top = located(directory);
  for (const std::string& file : inputs_of(problem)) {
    const fs::path path = located(file);
    if (std::mismatch(top.begin(), top.end(), path.begin(), path.end()).first == top.end()) inside.insert(path);
  }
  return inside;
}

RunDirectory::RunDirectory(std::string directory, const Problem& problem, const Model& model, const std::string& resolved_toml, bool force)
    : inputs_(inputs_in(directory, problem)),
      record_(problem, model),
      model_(model),
      results_(std::move(directory), force, inputs_),
      title_(problem.title.empty() ? "elamin" : problem.title),
      log_(results_.file("log.txt")),
      path_(results_.file(problem.in_time() ? "trajectory.csv" : "path.csv"), record_.path().columns),
      contacts_(results_.file("contacts.csv"), contact_columns),
      frames_(problem.path, span(model), std::max(1, static_cast<int>(problem.stages.size()))),
      film_(results_, problem.in_time() ? "trajectory" : "path", films_of(problem), title_) {
  write_text(results_.file("resolved.toml"), resolved_toml);
  if (!problem.in_time()) events_.emplace(results_.file("events.csv"), record_.events().columns);
  for (const fs::path& file : inputs_) log(file.string() + " is read by this run and stays as it is");
}

RunDirectory::RunDirectory(std::string directory, const Problem& problem, const Model& model, Archive& stopped, bool dropping)
    : RunDirectory(std::move(directory), problem, model, stopped, dropping, Sizes(stopped)) {}

RunDirectory::RunDirectory(std::string directory, const Problem& problem, const Model& model, Archive& stopped, bool dropping, const Sizes& sizes)
    : inputs_(inputs_in(directory, problem)),
      record_(problem, model),
      model_(model),
      results_(std::move(directory), inputs_, sizes.listed),
      title_(problem.title.empty() ? "elamin" : problem.title),
      log_(results_.file("log.txt"), GrowingFile::all),
      path_(results_.file(problem.in_time() ? "trajectory.csv" : "path.csv"), record_.path().columns, sizes.path),
      contacts_(results_.file("contacts.csv"), contact_columns, sizes.contacts),
      frames_(problem.path, span(model), std::max(1, static_cast<int>(problem.stages.size()))),
      film_(results_, problem.in_time() ? "trajectory" : "path", films_of(problem), title_) {
  if (!problem.in_time()) events_.emplace(results_.file("events.csv"), record_.events().columns, sizes.events);
  record_.take_up(read_table(results_.file(problem.in_time() ? "trajectory.csv" : "path.csv")), events_ ? read_table(results_.file("events.csv")) : Table{});
  stopped(frames_, dropped_, keeps_);
  film_.carry(stopped, dropping);
  goes_on_ = true;
}

void RunDirectory::carry(Archive& archive) {
  Sizes s{results_.listed(), path_.size(), contacts_.size(), events_ ? events_->size() : 0};
  archive(s.listed, s.path, s.contacts, s.events, frames_, dropped_, keeps_);
  film_.carry(archive);
}

void RunDirectory::settle() {
  drop_files(dropped_);
  film_.drop(dropped_);
  dropped_.clear();
}

void RunDirectory::enter(const Stage& stage, const Model& model) {
  record_.enter(stage, model);
  stage_.reset();
  if (!stage.name.empty()) stage_ = StoredStage{stage.name, stage.path.from, stage.scaling};
  frames_.enter(stage.path, std::exchange(goes_on_, false));
  varied_ = varied(record_.problem(), stage), rising_ = stage.path.to > stage.path.from;
}

void RunDirectory::add(const PathPoint& point, const Field& forces, const std::vector<Touch>& touches,
                       const std::vector<double>& eigenvalues) {
  record_.add(point, forces, touches, eigenvalues);
  path_.add(record_.path().rows.back());
  if (is_event(point.label)) events_->add(record_.events().rows.back());
  if (!point.label.empty()) add_state(point.label, point, touches);
}

void RunDirectory::add_state(const std::string& label, const PathPoint& point, const std::vector<Touch>& touches) {
  add_point(state_name(label), label, point);
  for (const Row& row : contact_rows(label, point.state, touches)) contacts_.add(row);
}

void RunDirectory::add_point(const std::string& name, const std::string& called, const PathPoint& point) {
  const State& state = point.state;
  add_state_file(name, model_, state, fmt::format("{}; load factor {:.17g}", called, state.load_factor));
  StateSupplement stored{state.load_factor, state.low, stage_, {}, stored_poses(state)};
  if (point.resume) stored.path = StoredPath{varied_, rising_, *point.resume};
  write_text(results_.file(name + ".json"), supplement_text(stored));
  add_picture(name, state, called);
}

bool RunDirectory::is_frame(const PathPoint& point) {
  if (!record_.problem().follows_path()) return false;
  const bool is = frames_.take(point);
  for (const int step : frames_.dropped()) dropped_.insert(step);
  if (!keeps_) settle();
  return is;
}

void RunDirectory::add_frame(const PathPoint& point, const Model& model, const Fields& fields, const std::vector<Touch>& touches) {
  if (!point.label.empty()) return;
  const std::string name = frame_name(point.step);
  add_point(name, fmt::format("step {}", point.step), point);
  add_fields_as(name, model, point.state, fields);
  write_csv(results_.file(name + ".contacts.csv"), {contact_columns, contact_rows("", point.state, touches)});
}

void RunDirectory::drop_files(const std::set<std::int64_t>& steps) {
  for (const std::int64_t step : steps) results_.remove(fmt::format("frames/{}.", step)), results_.remove(fmt::format("frames/{}-again.", step));
}

void RunDirectory::add(const Moment& moment, const std::vector<Touch>& touches) {
  record_.add(moment, touches);
  path_.add(record_.path().rows.back());
  if (moment.label.empty()) return;
  const State& state = moment.motion.state;
  Model moving = model_;
  moving.velocity = moment.motion.velocity, moving.angular_velocity = moment.motion.angular_velocity;
  moving.body_velocity = moment.motion.body_velocity, moving.angular_momentum = moment.motion.angular_momentum;
  const std::string name = state_name(moment.label);
  add_state_file(name, moving, state, fmt::format("{}; time {:.17g}", moment.label, moment.motion.time));
  write_text(results_.file(name + ".json"), supplement_text({state.load_factor, state.low, {}, {}, stored_poses(state)}));
  add_picture(name, state, moment.label);
  for (const Row& row : contact_rows(moment.label, state, touches)) contacts_.add(row);
}

void RunDirectory::add_frame(const Motion& motion) {
  if (!model_.bodies.empty()) results_.file(fmt::format("frames/{}.bodies.csv", motion.step));
  write_frame(results_.file(fmt::format("frames/{}.csv", motion.step)), model_, motion);
}

std::vector<Row> RunDirectory::contact_rows(const std::string& label, const State& state, const std::vector<Touch>& touches) const {
  std::vector<Row> rows;
  for (const Touch& t : closed_contacts(touches, model_, label)) {
    const Cell second = t.other >= 0 ? Cell(id_of(model_, t.other)) : Cell(model_.walls[t.wall].name);
    const Vec3 f = t.force.array() + 0.0, x = t.point.array() + 0.0;       // no negative zeros
    rows.push_back({label, state.load_factor, id_of(model_, t.particle), second, t.gap, f.norm(), f[0], f[1], f[2], x[0], x[1], x[2]});
  }
  return rows;
}

void RunDirectory::add_picture(const std::string& name, const State& state, const std::string& called) {
  if (!model_.bodies.empty()) write_picture(results_.file(name + ".vtk"), model_, state, title_ + "; " + called);
}

void RunDirectory::add_state_file(const std::string& name, const Model& model, const State& state, const std::string& called) {
  const std::string file = results_.file(name + ".data");
  if (model.particles() > 0 && !model.bodies.empty()) results_.file(bodies_file(name + ".data"));
  write_state(file, model, state, title_ + "; " + called);
}

void RunDirectory::add_fields(const std::string& label, const Model& model, const State& state, const Fields& fields) {
  add_fields_as(state_name(label), model, state, fields);
}

void RunDirectory::add_fields_as(const std::string& name, const Model& model, const State& state, const Fields& fields) {
  write_fields([&](const char* end) { return results_.file(name + end); }, model, state, fields);
}

void RunDirectory::add_null_vectors(const std::string& label, const std::vector<Field>& vectors) {
  add_displacements(state_name(label), ".modes.csv", vectors, true);
}

void RunDirectory::add_displacements(const std::string& stem, const std::string& end, const std::vector<Field>& all, bool numbered) {
  std::vector<std::string> columns{"id"};
  const auto add_columns = [&](char of) {
    for (std::size_t k = 1; k <= all.size(); ++k)
      for (const char c : {'x', 'y', 'z'}) columns.push_back(fmt::format("{}{}{}", of, c, numbered ? std::to_string(k) : ""));
  };
  add_columns('u');
  WholeCsv particles(results_.file(stem + end), columns);
  for (int i = 0; i < model_.particles(); ++i) {
    Row row{model_.id[i]};
    for (const Field& v : all) append(row, v.col(i));
    particles.add(row);
  }
  particles.keep();
  if (model_.bodies.empty()) return;
  add_columns('t');
  WholeCsv bodies(results_.file(stem + ".bodies" + end), columns);
  for (int b = 0; b < static_cast<int>(model_.bodies.size()); ++b) {
    Row row{model_.bodies[b].id};
    for (const Field& v : all) append(row, body_motion(model_, v, b).head<3>());
    for (const Field& v : all) append(row, body_motion(model_, v, b).tail<3>());
    bodies.add(row);
  }
  bodies.keep();
}

void RunDirectory::add_mode(const Mode& mode, const State& state) {
  const std::string name = fmt::format("mode-{}", ++mode_);
  if (!modes_) modes_.emplace(results_.file("modes.csv"), std::vector<std::string>{"mode", "eigenvalue", "zero_mode"});
  modes_->add({mode_, mode.eigenvalue, mode.zero_mode.empty() ? Cell{} : Cell(mode.zero_mode)});
  add_displacements("modes/" + name, ".csv", {mode.shape}, false);
  const State moved = moved_along(mode, model_, state);
  add_picture(state_name(name), moved, name);
  add_state_file(state_name(name), model_, moved, fmt::format("{}, eigenvalue {:.17g}; load factor {:.17g}", name, mode.eigenvalue, state.load_factor));
}

void RunDirectory::log(const std::string& line) {
  log_.add(fmt::format("{:%Y-%m-%d %H:%M:%S} {}\n", fmt::localtime(std::time(nullptr)), line));
}

void RunDirectory::add_curve(const Row& row) {
  if (!curve_file_) {
    curve_.columns = curve_columns(record_.columns());
    curve_file_.emplace(results_.file("curve.csv"), curve_.columns);
  }
  curve_file_->add(row), curve_.rows.push_back(row);
}

void RunDirectory::set_landscape(Table table, const Json& json) {
  landscape_ = std::move(table);
  write_csv(results_.file("landscape.csv"), landscape_);
  write_text(results_.file("landscape.json"), json.dump(1) + "\n");
}

bool RunDirectory::finish(const Summary& summary) {
  if (summary.status != status_name(Status::interrupted)) {
    for (const int step : frames_.dropped_at_end()) dropped_.insert(step);
    drop_files(dropped_);
    if (!film_.finish(dropped_)) return false;
  }
  write_summary(results_.file("summary.json"), summary, record_.path(), record_.events(), curve_);
  return true;
}

std::string RunDirectory::state_name(const std::string& label) const { return results_.free_name("states/" + file_name_of(label)); }

std::string RunDirectory::frame_name(int step) const { return results_.free_name(fmt::format("frames/{}", step)); }

std::string RunDirectory::state_file(const std::string& label) const {
  return (fs::path(directory()) / (state_name(label) + ".data")).string();
}

}  // namespace elamin
