#pragma once
// The directory that a run leaves behind.
#include "results/fields.hpp"
#include "results/film.hpp"
#include "results/frame_choice.hpp"
#include "results/json.hpp"
#include "results/mode.hpp"
#include "results/record.hpp"
#include "results/results_directory.hpp"
#include "results/summary.hpp"

#include <string>

namespace elamin {

/// The files that the problem reads; those of them that lie in the directory.
std::vector<std::string> inputs_of(const Problem& problem);
ResultsDirectory::Files inputs_in(const std::string& directory, const Problem& problem);

/// path.csv, events.csv, contacts.csv, states/, log.txt, resolved.toml and summary.json of one run, modes.csv and modes/ of
/// a study of modes; of dynamics trajectory.csv instead of the first two, and frames/; the films and the frames that are asked for. Every row, state and line is on the disk
/// as soon as it is added, so that an interrupted run keeps what it has.
class RunDirectory {
 public:
  /// Creates the directory and writes resolved.toml. Results of an earlier run in it are removed (see ResultsDirectory), but
  /// for files that the problem reads: these stay as they are, and a state of the same label is written to states/LABEL-again.data.
  /// problem and model must outlive this. Throws OutputError if something cannot be written, InputError if without `force` the directory has something
  /// in it and is not results of elamin.
  RunDirectory(std::string directory, const Problem& problem, const Model& model, const std::string& resolved_toml, bool force = false);

  /// The directory of a run that was stopped, as the archive tells of it: rows and files that came later go. `dropping`: it was stopped while frames
  /// were dropped; settle() comes next.
  RunDirectory(std::string directory, const Problem& problem, const Model& model, Archive& stopped, bool dropping);
  void carry(Archive& archive);
  /// Writes the summary of a run that has not ended.
  void begin(const std::string& title) { write_running(results_.file("summary.json"), title); }
  /// The same of one that has to end because a file cannot be written.
  void break_off(const std::string& title, const std::string& why) { write_broken_off(results_.file("summary.json"), title, why); }
  /// From here on frames that are no longer wanted stay until settle(): where a checkpoint knows of them they must not go before it is told.
  void keep_dropped_frames() { keeps_ = true; }
  bool settled() const { return dropped_.empty(); }
  void settle();

  /// See Record::enter.
  void enter(const Stage& stage, const Model& model);

  /// A row of path.csv, of events.csv if it is an event, a state if it has a label; forces, touches, eigenvalues: see
  /// Record::add.
  void add(const PathPoint& point, const Field& forces, const std::vector<Touch>& touches, const std::vector<double>& eigenvalues = {});

  /// A row of trajectory.csv, and a state with velocities if it has a label.
  void add(const Moment& moment, const std::vector<Touch>& touches);

  /// frames/STEP.csv.
  void add_frame(const Motion& motion);

  /// Whether the state of the next point of a path is one of the frames, for now. Frames that are no longer wanted are removed.
  bool is_frame(const PathPoint& point);

  /// A frame of a path, if it has no label: what states/LABEL.* are, as frames/STEP.*, and its closed contacts, frames/STEP.contacts.csv.
  /// model: that in force.
  void add_frame(const PathPoint& point, const Model& model, const Fields& fields, const std::vector<Touch>& touches);

  /// Whether there is a film; a state of it.
  bool has_film() const { return static_cast<bool>(film_); }
  void add_to_film(const Shot& shot) { film_.add(shot); }

  /// states/LABEL.data with LABEL.json (see input/state_supplement.hpp), of bodies a picture LABEL.vtk, and every closed contact
  /// (gap < 0, or it attracts; at an event also what just touches) as a row of contacts.csv: label, lambda, first (id of the
  /// particle or body), second (id of the other one, or the wall's name), gap, force (its magnitude), fx, fy, fz (on the first), x, y, z (of contact). The label stands for the
  /// point's own.
  void add_state(const std::string& label, const PathPoint& point, const std::vector<Touch>& touches);

  /// The fields of a labelled state as states/LABEL.particles.csv, .bonds.csv, .angles.csv and .walls.csv, see write_fields; model: that
  /// in force.
  void add_fields(const std::string& label, const Model& model, const State& state, const Fields& fields);

  /// states/LABEL.modes.csv of an event: id, then ux1, uy1, uz1, ux2, … of every null vector (3 × sites each); of bodies
  /// LABEL.bodies.modes.csv, behind these tx1, …: turns [rad].
  void add_null_vectors(const std::string& label, const std::vector<Field>& vectors);

  /// A row of modes.csv (mode, eigenvalue, zero_mode), modes/mode-K.csv (id, ux, uy, uz), of bodies modes/mode-K.bodies.csv
  /// (besides tx, ty, tz: turns [rad]) and states/mode-K.data, the state
  /// moved along the mode so that its largest displacement is a tenth of the smallest diameter. Modes count from 1.
  void add_mode(const Mode& mode, const State& state);

  /// A row of curve.csv, see curve_columns, which the first one makes.
  void add_curve(const Row& row);
  const Table& curve() const { return curve_; }

  /// landscape.csv and landscape.json, see results/landscape.hpp.
  void set_landscape(Table table, const Json& json);
  const Table& landscape() const { return landscape_; }

  /// A line of log.txt, with the time.
  void log(const std::string& line);

  /// Writes summary.json; the frames are chosen for good, unless the run is one that may go on. No: it was interrupted before, and
  /// is to be finished as one that may.
  bool finish(const Summary& summary);

  const Record& record() const { return record_; }
  const std::string& directory() const { return results_.path(); }

  /// The file of a label's state: "branch:1" → DIR/states/branch-1.data, unless that is an input or not of elamin.
  std::string state_file(const std::string& label) const;

 private:
  struct Sizes {                                      // of what grows, in bytes
    std::uintmax_t listed = 0, path = 0, contacts = 0, events = 0;
    explicit Sizes(Archive& archive) { archive(listed, path, contacts, events); }
    Sizes(std::uintmax_t l, std::uintmax_t p, std::uintmax_t c, std::uintmax_t e) : listed(l), path(p), contacts(c), events(e) {}
  };
  RunDirectory(std::string directory, const Problem& problem, const Model& model, Archive& stopped, bool dropping, const Sizes& sizes);
  std::string state_name(const std::string& label) const;                                 // "states/branch-1"
  std::string frame_name(int step) const;                                                 // "frames/12"
  void add_state_file(const std::string& name, const Model& model, const State& state, const std::string& called);
  void add_picture(const std::string& name, const State& state, const std::string& called);
  void add_point(const std::string& name, const std::string& called, const PathPoint& point);
  void add_fields_as(const std::string& name, const Model& model, const State& state, const Fields& fields);
  std::vector<Row> contact_rows(const std::string& label, const State& state, const std::vector<Touch>& touches) const;
  /// STEM+END of the particles, STEM.bodies+END of the bodies: id, ux, uy, uz, and of bodies tx, ty, tz, of several numbered.
  void add_displacements(const std::string& stem, const std::string& end, const std::vector<Field>& all, bool numbered);
  void drop_files(const std::set<std::int64_t>& steps);

  ResultsDirectory::Files inputs_;                    // that lie in the directory
  Record record_;
  const Model& model_;
  std::optional<StoredStage> stage_;                  // of a path in stages
  std::vector<std::string> varied_;                   // what the load factor scales …
  bool rising_ = true;                                // … upwards
  ResultsDirectory results_;
  std::string title_;
  GrowingFile log_;
  CsvFile path_, contacts_;
  std::optional<CsvFile> events_;                     // of equilibria
  std::optional<CsvFile> modes_, curve_file_;         // made with the first mode, with the first point of a curve
  Table curve_, landscape_;
  FrameChoice frames_;
  Film film_;
  std::set<std::int64_t> dropped_;                    // frames that are no longer wanted and still there
  bool keeps_ = false, goes_on_ = false;              // … until settle(); the stage that is entered next is the one that it was stopped in
  int mode_ = 0;
};

}  // namespace elamin
