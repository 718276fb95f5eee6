#include "results/film.hpp"

#include "catch.hpp"
#include "core/error.hpp"
#include "lammps/data.hpp"
#include "results/files.hpp"
#include "results/run_directory.hpp"
#include "results/sample.hpp"
#include "results/stored_run.hpp"
#include "scratch_directory.hpp"

#include <cmath>
#include <map>
#include <sstream>

using namespace elamin;

namespace {

/// Frames of a custom dump, read by its rules: step, box, the columns of ITEM: ATOMS, a row for each id.
struct DumpFrame {
  long step = -1;
  std::array<double, 6> box;
  std::vector<std::string> columns;
  std::map<int, std::map<std::string, double>> atoms;
};

std::vector<DumpFrame> frames_in(const std::string& file) {
  std::ifstream in(file);
  std::vector<DumpFrame> frames;
  std::string line;
  const auto next = [&] { return std::getline(in, line) ? line : "the end"; };
  while (std::getline(in, line)) {
    REQUIRE(line == "ITEM: TIMESTEP");
    DumpFrame f;
    f.step = std::stol(next());
    REQUIRE(next() == "ITEM: NUMBER OF ATOMS");
    const int n = std::stoi(next());
    REQUIRE(next() == "ITEM: BOX BOUNDS ff ff ff");
    for (int c = 0; c < 3; ++c) std::istringstream(next()) >> f.box[2 * c] >> f.box[2 * c + 1];
    REQUIRE(next().starts_with("ITEM: ATOMS "));
    std::istringstream names(line.substr(12));
    for (std::string name; names >> name;) f.columns.push_back(name);
    for (int i = 0; i < n; ++i) {
      std::istringstream numbers(next());
      std::map<std::string, double> atom;
      for (const std::string& c : f.columns) {
        std::string text;
        REQUIRE(numbers >> text);
        atom[c] = std::strtod(text.c_str(), nullptr);
      }
      REQUIRE(!(numbers >> line));
      f.atoms[static_cast<int>(atom["id"])] = atom;
    }
    REQUIRE(f.atoms.size() == static_cast<std::size_t>(n));
    frames.push_back(f);
  }
  return frames;
}

Fields some_fields(const Model& m) {
  Fields f;
  f.bonds.resize(m.bonds.size()), f.angles.resize(m.angles.size());
  f.energy = Vector::LinSpaced(m.particles() + static_cast<int>(m.bodies.size()), 0.1, 0.7);
  f.energy[1] = std::nan("");
  f.contact_force = Field::Random(3, f.energy.size());
  return f;
}

}  // namespace

TEST_CASE("a reel is whole after every call", "[film]") {
  ScratchDirectory scratch;
  const std::string file = scratch / "reel";
  Reel reel(file, "<", ">");
  CHECK(text_of(file) == "<>");
  reel.add(1, "one");
  CHECK(text_of(file) == "<one>");
  reel.add(5, "five"), reel.add(7, "seven");
  CHECK(text_of(file) == "<onefiveseven>");
  reel.drop({5, 6});
  CHECK(text_of(file) == "<oneseven>");
  reel.add(8, "eight");
  CHECK(text_of(file) == "<oneseveneight>");
  reel.drop({1, 8}, [](const std::string& text) { return text + "!"; });
  CHECK(text_of(file) == "<seven!>");
  reel.drop({});
  reel.add(9, "9"), reel.drop({7});
  CHECK(text_of(file) == "<9>");
  CHECK(files_in(scratch / "").size() == 1);
  CHECK_THROWS_AS(Reel(scratch / "none/reel"), OutputError);
}

TEST_CASE("a film holds the states that are stored, to the last bit", "[film]") {
  ScratchDirectory scratch;
  Model m = sample_model();
  m.id = {2, 3, 5, 7, 11};
  Problem problem;
  problem.title = "a film";
  problem.study = StudyType::path;
  problem.path.frames = 3, problem.path.film = {"lammpstrj", "pvd", "xyz"};
  RunDirectory run(scratch / "run", problem, m, "");
  Stage stage;
  stage.path = problem.path;
  run.enter(stage, m);
  const Fields fields = some_fields(m);
  std::map<int, State> states;
  const auto add = [&](int step, const std::string& label) {
    PathPoint p = sample_point(m, step, step / 30.0, label);
    p.state.position(0, 2) = 1.0 / (step + 3);
    states[step] = p.state;
    const bool frame = run.is_frame(p);
    run.add(p, Field::Zero(3, 5), sample_touches());
    if (frame) run.add_frame(p, m, fields, sample_touches());
    if (frame || !label.empty()) run.add_to_film({p.step, label, p.state.load_factor, m, p.state, fields, sample_touches()});
  };
  const auto check = [&](std::size_t count) {
    const std::vector<DumpFrame> dump = frames_in(scratch / "run/path.lammpstrj");
    CHECK(dump.size() == count);
    for (const DumpFrame& f : dump) {
      INFO(f.step);
      CHECK(f.columns == std::vector<std::string>{"id", "type", "mol", "x", "y", "z", "radius", "energy", "fx", "fy", "fz"});
      const State& s = states.at(static_cast<int>(f.step));
      for (int i = 0; i < 5; ++i) {
        auto atom = f.atoms.at(m.id[i]);
        for (int c = 0; c < 3; ++c) {
          CHECK(atom[std::string(1, "xyz"[c])] == s.position(c, i));
          CHECK(atom[std::string("f") + "xyz"[c]] == fields.contact_force(c, i));
          CHECK((f.box[2 * c] < s.position(c, i) && s.position(c, i) < f.box[2 * c + 1]));
        }
        CHECK(atom["type"] == m.type[i]);
        CHECK(atom["radius"] == m.diameter[i] / 2);
        CHECK(atom["energy"] == (i == 1 ? 0 : fields.energy[i]));
      }
      CHECK(std::filesystem::exists(scratch / ("run/frames/" + std::to_string(f.step) + ".vtu")));
    }
    const StoredRun stored = read_run(scratch / "run");
    REQUIRE(stored.states.size() == count);
    for (std::size_t k = 0; k < count; ++k) {
      CHECK(stored.states[k].row == dump[k].step);
      CHECK(read_state(stored.states[k], m).position == states.at(static_cast<int>(dump[k].step)).position);
      CHECK(stored.states[k].label.empty() == (stored.states[k].file.find("/frames/") != std::string::npos));
    }
    std::istringstream xyz(text_of(scratch / "run/path.xyz"));
    std::size_t frames = 0;
    for (std::string line; std::getline(xyz, line); ++frames) {
      CHECK(line == "5");
      REQUIRE(std::getline(xyz, line));
      CHECK(line.starts_with("Properties=species:S:1:pos:R:3:id:I:1:kind:I:1:molecule:I:1:radius:R:1:energy:R:1:contact_force:R:3 step="));
      CHECK(line.ends_with(" pbc=\"F F F\""));
      CHECK(line.find("step=" + std::to_string(dump[frames].step) + " load_factor=") != std::string::npos);
      CHECK((line.find(" label=\"say a:1\"") != std::string::npos) == (dump[frames].step == 4));
      for (int i = 0; i < 5; ++i) std::getline(xyz, line);
    }
    CHECK(frames == count);
    const std::string pvd = text_of(scratch / "run/path.pvd");
    CHECK(pvd.ends_with("</Collection>\n</VTKFile>\n"));
    for (const DumpFrame& f : dump) CHECK(pvd.find("<DataSet timestep=\"" + std::to_string(f.step) + "\" file=\"frames/" + std::to_string(f.step) + ".vtu\"/>\n") != std::string::npos);
    std::set<long> shown;
    for (const DumpFrame& f : dump) shown.insert(f.step);
    for (const std::string& file : files_in(scratch / "run/frames")) CHECK(shown.count(std::stol(file)) == 1);
    for (const std::string& file : files_in(scratch / "run")) CHECK((file == ".gitignore" || listed_in(scratch / "run").count(file) == 1));
    return dump;
  };
  for (int step = 0; step < 30; ++step) {
    add(step, step == 0 ? "initial" : step == 4 ? "say \"a\":1" : "");
    if (step > 10) check(frames_in(scratch / "run/path.lammpstrj").size());
  }
  const auto so_far = frames_in(scratch / "run/path.lammpstrj").size();
  CHECK((so_far > 5 && so_far <= 14));
  check(so_far);                                                 // of a run that is killed, all that it has
  add(30, "final");
  run.finish({});
  const std::vector<DumpFrame> all = check(4);                    // three even ones and what has a label besides
  CHECK((all[0].step == 0 && all[1].step == 4 && all[2].step == 15 && all[3].step == 30));
  for (const DumpFrame& f : all) CHECK(f.box == all[0].box);
  const LammpsData topology = read_lammps_data(scratch / "run/path.data");
  CHECK(text_of(scratch / "run/path.data").find("\nAtoms # full\n") != std::string::npos);
  CHECK(topology.position == states.at(0).position);
  CHECK((topology.id == m.id && topology.type == m.type && topology.bonds.size() == 4 && topology.angles.size() == 3));
  CHECK(read_table(scratch / "run/frames/15.contacts.csv").rows.size() == 5);
}

TEST_CASE("bodies have a dump of their own beside particles", "[film]") {
  ScratchDirectory scratch;
  Model m = sample_model();
  RoundedShape ball;
  ball.vertices = {Vec3::Zero()}, ball.radius = 0.25;
  m.shapes = {ball};
  Body body;
  body.id = 9, body.type = 3;
  m.bodies = {body};
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()));
  m.start.bodies = {{{Vec3(1, 2, 1.0 / 3), Vec3::Zero()}, turn}};
  const Fields fields = some_fields(m);
  ResultsDirectory directory(scratch / "run", false);
  Film film(directory, "trajectory", {"lammpstrj", "xyz"}, "");
  Motion motion;
  motion.state = m.start, motion.velocity = Field::Random(3, 5), motion.force = Field::Random(3, 5);
  motion.body_velocity = Field::Random(3, 1), motion.body_force = Field::Random(3, 1);
  const std::vector<Touch> none;
  scratch.file("run/trajectory.data", "somebody's");
  film.add({12, "", 0.5, m, motion.state, fields, none, {}, &motion});
  CHECK(text_of(scratch / "run/trajectory.data") == "somebody's");
  CHECK(read_lammps_data(scratch / "run/trajectory-again.data").position == m.start.position);
  const std::string xyz = text_of(scratch / "run/trajectory.xyz");
  CHECK(xyz.starts_with("6\nProperties=species:S:1:pos:R:3:id:I:1:kind:I:1:molecule:I:1:radius:R:1:velo:R:3:force:R:3:energy:R:1 step=12 time=0.5 pbc=\"F F F\"\n"));
  CHECK(std::count(xyz.begin(), xyz.end(), '\n') == 8);
  const auto particles = frames_in(scratch / "run/trajectory.lammpstrj"), bodies = frames_in(scratch / "run/trajectory.bodies.lammpstrj");
  REQUIRE((particles.size() == 1 && bodies.size() == 1));
  CHECK(particles[0].columns == std::vector<std::string>{"id", "type", "mol", "x", "y", "z", "radius", "vx", "vy", "vz", "fx", "fy", "fz", "energy"});
  auto third = particles[0].atoms.at(3), own = bodies[0].atoms.at(9);
  CHECK((third["vy"] == motion.velocity(1, 2) && third["fz"] == motion.force(2, 2)));
  CHECK((own["type"] == 3 && own["z"] == 1.0 / 3 && own["radius"] == 0.25 && own["vx"] == motion.body_velocity(0, 0) && own["fz"] == motion.body_force(2, 0)));
  CHECK((own["quati"] == turn.x() && own["quatj"] == turn.y() && own["quatk"] == turn.z() && own["quatw"] == turn.w()));
  CHECK(own["energy"] == fields.energy[5]);
}
