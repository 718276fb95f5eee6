#pragma once
// A problem file as plain numbers: every table a struct, every default in it. What the file says, not what it means.
#include "input/beam.hpp"
#include "input/body.hpp"
#include "input/connect.hpp"
#include "input/constants.hpp"
#include "input/contact.hpp"
#include "input/curve.hpp"
#include "input/grains.hpp"
#include "input/group.hpp"
#include "input/imperfection.hpp"
#include "input/lammps.hpp"
#include "input/landscape.hpp"
#include "input/loads.hpp"
#include "input/loop.hpp"
#include "input/motion.hpp"
#include "input/observe.hpp"
#include "input/path_table.hpp"
#include "input/refine.hpp"
#include "input/sheet.hpp"
#include "input/solver.hpp"
#include "input/support.hpp"
#include "input/sweep_table.hpp"
#include "input/wall.hpp"

namespace elamin {

/// Everything one run needs. Sweeps are expanded before this is read (see study/prepare.hpp).
struct Problem {
  std::string file;                             // path of the problem file, as given
  std::string sha256;                           // of its bytes, 64 hexadecimal digits
  std::vector<std::string> notes;               // on how the file was read
  std::string title;
  std::string plane;                            // "", "xy", "xz", "yz"
  std::optional<ConstantsTable> constants;
  std::optional<LammpsTable> lammps;
  std::vector<BeamTable> beams;
  std::vector<LoopTable> loops;
  std::vector<SheetTable> sheets;
  std::vector<GrainsTable> grains;
  std::vector<BodyTable> bodies;
  std::vector<GlueTable> glue;
  std::vector<ConnectTable> connections;
  std::vector<BondsTable> bonds;
  std::vector<AnglesTable> angles;
  std::vector<RemoveTable> removals;
  std::optional<ImperfectionTable> imperfection;
  std::vector<GroupTable> groups;
  std::vector<SupportTable> supports;
  std::vector<LoadTable> loads;
  std::vector<GravityTable> gravity;
  std::vector<PressureTable> pressures;
  std::vector<ChangeTable> changes;
  std::vector<ContactTable> contacts;
  std::vector<WallTable> walls;
  std::vector<ViscosityTable> viscosity;
  std::vector<VelocityTable> velocities;
  StudyType study = StudyType::path;
  TablePlace study_place;                       // of [study], where it is written
  PathTable path;
  std::optional<CurveTable> curve;
  std::optional<RefineTable> refine;
  std::optional<LandscapeTable> landscape;
  ModesTable modes;
  SolverTable solver;
  DynamicsTable dynamics;
  std::vector<ObserveTable> observe;
  std::vector<EventTable> events;
  std::vector<StageTable> stages;
  std::vector<ExpectTable> expect;
  /// A path is followed, for itself or for a landscape.
  bool follows_path() const { return study == StudyType::path || study == StudyType::landscape; }
  /// A motion in time is asked for; damped dynamics ends in an equilibrium.
  bool in_time() const { return study == StudyType::dynamics && !dynamics.relax; }
  /// Events have a column lambda_error.
  bool event_errors() const { return follows_path() && (path.event_errors || refine); }
  bool operator==(const Problem&) const = default;
};

/// Calls with the name and the list of the tables of each kind of structure; P: Problem, const or not.
template <class P, class Call> void for_structures(P& p, const Call& call) {
  call("beam", p.beams), call("loop", p.loops), call("sheet", p.sheets), call("grains", p.grains), call("body", p.bodies);
}

/// What a file holds: the problem, and the sweeps over its keys.
struct ProblemFile {
  Problem problem;
  std::vector<Sweep> sweeps;
};

void describe(Keys& keys, ProblemFile& file);

}  // namespace elamin
