// Scripts as problem files.
#include "catch.hpp"
#include "energy/energy.hpp"
#include "input/stages.hpp"
#include "lammps/script_reading.hpp"
#include "lammps/small_data_file.hpp"
#include "processor_time.hpp"
#include "results/run_directory.hpp"
#include "study/commands.hpp"
#include "study/program.hpp"
#include "study/run.hpp"

#include <cmath>

using namespace elamin;
using script::Reading;

namespace {


bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string three_in_a_row = small_script_head +
    "create_atoms 1 single 0 0 0\ncreate_atoms 2 single 0.1 0 0\ncreate_atoms 2 single 0.2 0 0\nset group all diameter 0.05\n"
    "set group all density 2\n"
    "create_bonds single/bond 1 1 2\ncreate_bonds single/bond 3 2 3\ncreate_bonds single/angle 2 1 2 3\ntimestep 0.5\n";

double last(const std::string& directory, const std::string& column) {
  const auto rows = csv_rows(directory + "/path.csv");
  for (std::size_t c = 0; c < rows[0].size(); ++c)
    if (rows[0][c] == column) return std::stod(rows.back()[c]);
  throw std::runtime_error("no column " + column);
}

}  // namespace

TEST_CASE("what is in force at a run becomes tables", "[script]") {
  const ImportedProblem p = imported(three_in_a_row +
      "group one id 1\ngroup three id 3\nfix 1 all nve\nfix m one move linear 0.01 NULL -0.02\n"
      "fix g all gravity 2 vector 0 0 -3\n"
      "fix f three addforce 1 2 3\nfix h three setforce NULL 0 0\nfix v all viscous 0.1\nregion tube cylinder x 0 0 1.5 INF 4 side in open 2\n"
      "fix w one wall/gran/region granular hertz/material 100 0 0.25 tangential linear_nohistory 0 0 region tube\nrun 20\n");
  INFO(p.files.toml);
  CHECK(p.model.bonds.size() == 2);
  CHECK(p.model.bond_types.size() == 2);                        // types 1 and 3; the second is not in use
  CHECK(p.model.bond_types[1].stiffness == 5);
  CHECK(p.model.angle_types.size() == 1);
  REQUIRE(p.model.supports.size() == 2);
  CHECK(p.model.supports[0].displacement == Vec3(0.1, 0, -0.2));
  CHECK(p.model.supports[0].held == std::array{true, false, true});
  CHECK(p.model.supports[1].held == std::array{false, true, true});
  CHECK(p.model.gravity.at(0).acceleration == Vec3(0, 0, -2));
  CHECK(p.model.loads.at(0).force == Vec3(1, 2, 3));
  CHECK(p.model.loads.at(0).scaling == Scaling::constant());
  REQUIRE(p.model.walls.size() == 1);
  CHECK(p.model.walls[0].effective_modulus == 100 / (2 * 0.75));
  CHECK(p.model.walls[0].curved);
  CHECK(p.model.walls[0].region.open == std::array{false, true, false, false, false, false});
  CHECK(p.model.walls[0].region.axial_hi == 4);
  CHECK(p.model.viscosity.empty());
  CHECK(p.model.contacts.at(0).effective_modulus == 1000 / (2 * (1 - 0.09)));
  CHECK(p.model.contacts.at(0).exclude_bonds == 1);
  CHECK(holds(p.files.toml, "# in.lmp:25 fix m one move linear 0.01 NULL -0.02\n[[support]]\nname = \"m\"\n"));
  CHECK(holds(p.files.toml, "[path]"));
}

TEST_CASE("particles that nothing integrates stay, and later fixes hold over earlier ones", "[script]") {
  const ImportedProblem p = imported(three_in_a_row +
      "group a id 1 2\ngroup b id 2\nfix 1 a nve\nfix 2 a setforce 0 0 0\nfix 3 b move linear 0 0 1\nrun 1\n");
  INFO(p.files.toml);
  REQUIRE(p.model.supports.size() == 3);
  std::map<int, Vec3> of;
  for (const Support& s : p.model.supports)
    for (const int i : s.particles) of[i] = s.displacement;
  CHECK(of == std::map<int, Vec3>{{0, Vec3::Zero()}, {1, Vec3(0, 0, 0.5)}, {2, Vec3::Zero()}});
}

TEST_CASE("pair coefficients act in LAMMPS's order", "[script]") {
  const std::string three = small_script_head + "create_atoms 1 single 0 0 0\ncreate_atoms 2 single 0.3 0 0\ncreate_atoms 3 single 0.6 0 0\n"
                                                "set group all diameter 0.1\n";
  // Of E for the pairs 11 12 13 22 23 33, the later line holds; 2* 1*2 means 22 alone.
  const auto moduli = [&](const std::string& lines) {
    const ImportedProblem p = imported(three + lines + "fix 1 all nve\nrun 1\n");
    std::map<std::pair<int, int>, double> E;
    for (const PairContact& c : p.model.contacts)
      for (const int i : c.particles[0])
        for (const int j : c.particles[1])
          if (c.law == PairContact::Law::hertz) E[{std::min(i, j), std::max(i, j)}] = c.effective_modulus;
    std::string text;
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j) text += std::to_string(std::lround(E[{i, j}])) + " ";
    return text;
  };
  const std::string tail = " 0 tangential linear_nohistory 0 0\n", hertz = " hertz ";
  const auto line = [&](const std::string& types, int modulus) { return "pair_coeff " + types + hertz + std::to_string(4 * modulus / 3) + ".0" + tail; };
  CHECK(moduli("pair_style granular\n" + line("* *", 30) + line("1 2", 60) + line("2* 1*2", 90)) == "30 60 30 90 30 30 ");
  CHECK(moduli("pair_style granular\n" + line("* *", 30) + line("2 2", 0) + line("1* 3", 60)) == "30 30 60 0 60 60 ");
  CHECK(moduli("pair_style none\npair_style granular\n" + line("1 1", 30) + line("2 2", 120) + line("3 3", 0)) == "30 60 0 120 0 0 ");       // mixed
  CHECK(moduli("pair_style granular\n" + line("* *", 30) + "pair_style granular\n" + line("1 1", 60) + line("1* 2*", 90)) == "60 90 90 90 90 90 ");
}

TEST_CASE("traps are told", "[script]") {
  const auto notes = [](const std::string& text) {
    const Reading r = reading_of(text);
    return script::report(r, script::translated(r, r.passes.at(0), {}, "p.data").notes);
  };
  const std::string all = notes(three_in_a_row +
      "pair_style hybrid/overlay granular lj/cut 1\npair_coeff * * granular hertz/material 1e3 0 0.3 tangential mindlin NULL 1 0.5\n"
      "pair_coeff 1 2 lj/cut 1 0.1\n"
      "special_bonds lj 0 1 1 coul 0 0.5 1\nfix 1 all nve\ngroup two id 1 2\nfix s two setforce 0 0 0\n"
      "fix w all wall/gran granular hertz/material 100 0 0.25 tangential linear_nohistory 0 0 zplane -0.5 0.5\nrun 10\n");
  for (const char* part : {"E/(2(1 - nu))", "do not know special_bonds", "the energy of this cohesion jumps", "friction that remembers", "a clamp. It sits in the middle"}) CHECK(holds(all, part));
  CHECK(holds(notes(three_in_a_row + "special_bonds lj/coul 0 0.5 1\nfix 1 all nve\n"
                                     "run 10\n"), "weights of special_bonds between 0 and 1 are ignored by granular"));
  CHECK(holds(notes(three_in_a_row + "create_atoms 1 single 5 0 0\nfix 1 all nve\nrun 10\n"), "lies outside of the box"));
  CHECK(holds(notes(three_in_a_row + "region b block 0.05 1 -1 1 -1 1\nfix 1 all nve\n"
                                     "fix w all wall/gran/region granular hertz 9 0 tangential linear_nohistory 0 0 region b\nrun 10\n"),
              "1 of 3 particles are on the other side of this wall"));
}

TEST_CASE("sheets of LAMMPSStructures are kept or mended", "[script]") {
  const ScratchDirectory scratch;
  scratch.file("sheet_1.txt", "create_atoms 1 single 0 0 0\ncreate_atoms 1 single 0.1 0 0\ncreate_atoms 1 single 0.2 0 0\n");
  const Reading r = script::read_script(scratch.file("in.lmp", small_script_head + "include sheet_1.txt\ncreate_bonds single/bond 1 1 2\n"
      "create_bonds single/bond 1 2 3\n"
                                                     "create_bonds single/angle 1 1 2 3\nset type 1 diameter 0.1\nfix 1 all nve\nrun 1\n"), {});
  CHECK(imported(r).model.angle_types.at(0).stiffness == 0.25);
  const auto told = [](const script::Translated& t, const std::string& part) {
    return std::any_of(t.notes.begin(), t.notes.end(), [&](const script::Note& n) { return holds(n.text, part); });
  };
  CHECK(told(imported(r).files, "it is kept as it is"));
  CHECK_FALSE(told(imported(r, 0, {false, false, true}).files, "LAMMPSStructures"));
  const ImportedProblem mended = imported(r, 0, {false, true, false});
  CHECK(mended.model.angle_types.at(0).stiffness == 0.25 * 3 * std::sqrt(3.0));
  CHECK(told(mended.files, "it is mended here"));
}

TEST_CASE("formulas that are linear in a run's steps become loads and walls with a load factor", "[script]") {
  const auto all_of = [](const std::string& lines) { return imported(three_in_a_row + "group ends id 1 3\nfix 1 ends nve\n" + lines); };
  // What acts on a particle at a load factor.
  const auto force = [](const Model& m, int particle, double lambda) {
    Vec3 f = Vec3::Zero();
    for (const Load& l : m.loads)
      if (std::count(l.particles.begin(), l.particles.end(), particle)) f += l.scaling.at(lambda) * l.force;
    return f;
  };
  ImportedProblem p = all_of("variable f equal ramp(1,3)\nvariable g equal 2*elapsed*dt\nfix a ends addforce v_f 0 v_g\nrun 20\n");
  INFO(p.files.toml);
  for (const double lambda : {0.0, 0.25, 1.0}) {
    CHECK((force(p.model, 0, lambda) - Vec3(1 + 2 * lambda, 0, 20 * lambda)).norm() < 1e-14);
    CHECK(force(p.model, 1, lambda).isZero(0));
  }
  p = all_of("variable g equal ramp(0,9.8)\nfix a all gravity v_g vector 0 0 -2\nrun 20\n");
  REQUIRE(p.model.gravity.size() == 1);
  CHECK(p.model.gravity[0].scaling.at(0.5) * p.model.gravity[0].acceleration == Vec3(0, 0, -4.9));

  const ScratchDirectory scratch;                               // each particle its own
  scratch.file("own.txt", "# forces\n\n2\n3 0.5\n1 -2e-1 # the first\n");
  const std::string own = three_in_a_row + "group ends id 1 3\nfix 1 ends nve\nvariable own atomfile own.txt\nvariable f atom v_own*ramp(1,2)\n";
  const ImportedProblem each =
      imported(script::read_script(scratch.file("own.lmp", own + "variable third equal v_own[3]\nfix all all addforce v_f 0 ${third}\n"
          "run 10\n"), {}));
  INFO(each.files.toml);
  for (const double lambda : {0.0, 0.5, 1.0})
    for (const auto& [particle, x] : {std::pair(0, -0.2), {1, 0.0}, {2, 0.5}})
      CHECK((force(each.model, particle, lambda) - Vec3(x * (1 + lambda), 0, 0.5)).norm() < 1e-15);

  p = all_of("variable d equal vdisplace(0,0.01)\nvariable r equal 0.5-elaplong*0.01\n"
             "region tube cylinder x 0 0 v_r INF INF side in move NULL v_d NULL\n"
             "fix w all wall/gran/region granular hertz/material 100 0 0 tangential linear_nohistory 0 0 region tube\nrun 20\n"
             "run 10 start 0 stop 40\n");
  INFO(p.files.toml);
  REQUIRE(p.problem.stages.size() == 2);
  for (const Wall& w : p.model.walls) {                         // both stages: on one line, as the load factor counts time
    CHECK((w.displacement - Vec3(0, 0.1, 0)).norm() < 1e-15);
    CHECK(std::abs(w.radius_change + 0.2) < 1e-15);
    CHECK(std::abs(w.region.radius - 0.5) < 1e-15);
    CHECK(w.region.center.norm() < 1e-15);
  }

  const auto wrong = [](const std::string& lines) { return script_mistakes(three_in_a_row + "fix 1 all nve\n" + lines); };
  for (const auto& [lines, what] : std::vector<std::pair<std::string, std::string>>{
           {"variable f equal swiggle(0,1,0.5)\nfix a all addforce v_f 0 0\nrun 64\n", "is not linear in the step of this run"},
           {"variable f equal step%8==4\nfix a all addforce v_f 0 0\nrun 64\n", "is not linear in the step of this run"},
           {"variable f equal step^2\nfix a all addforce v_f 0 0\nrun 64\n", "is not linear in the step of this run"},
           {"variable f atom x*2\nfix a all addforce v_f 0 0\nrun 64\n", "depends on where particles are"},
           {"variable f equal ramp(0,1)\nfix a all addforce v_f 0 0\nminimize 0 0 9 9\n", "which a minimisation does not have"},
           {"variable r equal ramp(1,-1)\nregion b sphere 0 0 0 v_r\n"
            "fix w all wall/gran/region granular hertz 9 0 tangential linear_nohistory 0 0 region b\nrun 9\n",
            "it must be above 0"},
           {"variable r equal 1+step\nregion b sphere 0 0 0 v_r\ngroup g region b\nrun 9\n", "moves; where it is is not followed"},
           {"variable r equal step\nregion b sphere v_r 0 0 1\nrun 9\n", "changes in time"},
           {"run 10 start 5\n", "5 is out of range"}, {"run 10 stop 5\n", "stops its ramps before it ends"},
           {"variable own atomfile ../own.txt\n", "lies outside of the script's folder"}}) {
    INFO(lines);
    const std::string said = wrong(lines);
    INFO(said);
    CHECK(holds(said, what));
  }
}

TEST_CASE("a script that runs no steps is a study of energies, with all that is in force", "[script]") {
  const std::string fixes = "fix m all move linear 1 0 0\n"
                            "fix w all wall/gran granular hertz/material 100 0 0.25 tangential linear_nohistory 0 0 zplane 0 NULL\n"
                            "fix g all gravity 2 vector 0 0 -3\n";
  const ImportedProblem p = imported(three_in_a_row + fixes + "run 0\nunfix g\n");
  INFO(p.files.toml);
  CHECK(p.problem.study == StudyType::energy);
  CHECK(p.model.walls.size() == 1);
  CHECK(p.model.gravity.size() == 1);
  CHECK(p.model.contacts.size() == 1);
  CHECK(p.model.supports.at(0).displacement.isZero(0));
  // What is built behind it is no part of that run: a run to come makes the study.
  CHECK(imported(three_in_a_row + fixes + "run 0\ncreate_atoms 1 single 0 0.5 0\nunfix m\nfix 1 all nve\n"
                                          "run 5\n").problem.study == StudyType::equilibrium);
  CHECK(imported(three_in_a_row + fixes + "run 0\ncreate_atoms 1 single 0 0.5 0\n").model.walls.empty());
}

TEST_CASE("`none` takes back what was said of a pair, and cohesion may be smooth", "[script]") {
  const std::string three = small_script_head + "create_atoms 1 single 0 0 0\ncreate_atoms 2 single 0.3 0 0\ncreate_atoms 3 single 0.6 0 0\n"
                                                "set group all diameter 0.4\n";
  const std::string granular = "granular hertz/material 90.0 0 0 tangential linear_nohistory 0 0\n";
  const auto touches = [&](const std::string& lines) {
    ImportedProblem p = imported(three + "pair_style hybrid/overlay granular lj/smooth 0.3 0.5\n" + lines + "fix 1 all nve\nrun 1\n");
    Energy energy(p.model);
    const EnergyTerms terms = energy.terms(p.model.start);
    return std::pair(terms.contact, terms.cohesion);
  };
  const auto [one, no_cohesion] = touches("pair_coeff * * none\npair_coeff 1 2 " + granular);
  CHECK(one > 0);
  CHECK(no_cohesion == 0);
  CHECK(touches("pair_coeff * * " + granular).first == 2 * one);
  CHECK(touches("pair_coeff * * " + granular + "pair_coeff 2 2 lj/smooth 0 1\npair_coeff 2 3 none\n").first == one);
  CHECK(touches("pair_coeff * * " + granular + "pair_coeff 2* 2* none\n").first == one);
  CHECK(touches("pair_coeff * * " + granular + "pair_coeff * * none\n").first == 0);
  const auto [contact, cohesion] = touches("pair_coeff * * " + granular + "pair_coeff 1 2 lj/smooth 1 0.25\npair_coeff 2* 2* none\n");
  CHECK(contact == one);
  CHECK(cohesion < 0);
  CHECK(holds(script_mistakes(three + "pair_style lj/smooth 0.5 0.3\npair_coeff * * 1 0.1\nfix 1 all nve\n"
                                      "run 1\n"), "inner cutoff that is not between 0 and the cutoff"));
  CHECK(holds(script_mistakes(three + "pair_style lj/smooth 0.3 0.5\npair_coeff * * 1 0.1 0.2\nfix 1 all nve\nrun 1\n"), "pair_coeff"));
}

TEST_CASE("runs become stages, with what comes and goes between them", "[script]") {
  const Reading reading = script::read_script(lammps_scripts + "stages.lmp", {});
  const ImportedProblem p = imported(reading);
  INFO(p.files.toml);
  REQUIRE(p.problem.stages.size() == 4);
  CHECK(p.problem.plane == "xz");
  Stages stages(p.problem);
  Model all = p.model;
  struct Expected { double from, to; std::size_t bonds, angles, supports, walls; };
  // Supports: low, high or stop, the grain's, and where something is absent one that holds it still.
  const Expected expected[]{{0, 1, 10, 9, 3, 1}, {1, 3, 10, 9, 3, 1}, {0, 1, 10, 9, 3, 0}, {0, 1, 10, 8, 3, 0}};
  for (const Expected& e : expected) {
    std::string unclear;
    const Stage stage = stages.enter(unclear);
    INFO(stage.name);
    CHECK(unclear.empty());
    CHECK(stage.path.from == e.from);
    CHECK(stage.path.to == e.to);
    const Model m = model_in(p.problem, stage, all, all.start);
    CHECK(m.bonds.size() == e.bonds);
    CHECK(m.angles.size() == e.angles);
    CHECK(m.supports.size() == e.supports);
    std::size_t walls = 0;
    for (const Wall& w : m.walls) walls += !w.particles.empty();
    CHECK(walls == e.walls);
    stages.leave(stage.path.to);
  }
}

TEST_CASE("what lies in a plane stays there as long as nothing pushes it out, as in LAMMPS", "[script]") {
  const std::string grains = small_script_head + "create_atoms 1 single 0 0 0\ncreate_atoms 1 single 0.1 0 0\ncreate_atoms 1 single 0 0.1 0\nset type 1 diameter 0.2\nset type 1 density 2\n"
                                                 "fix 1 all nve\n";
  const auto wall = [](const std::string& name, double lo, double hi) {
    return "region " + name + " block -1 1 -1 1 " + std::to_string(lo) + " " + std::to_string(hi) + "\nfix " + name +
           " all wall/gran/region granular hertz/material 30 0 0.25 tangential linear_nohistory 0 0 region " + name + "\n";
  };
  const std::string plane = "plane = \"xy\"";
  CHECK(holds(imported(grains + wall("a", -0.15, 0.9) + "run 10\n").files.toml, plane));
  CHECK_FALSE(holds(imported(grains + wall("a", -0.05, 0.9) + "run 10\n").files.toml, plane));
  CHECK(holds(imported(grains + wall("a", -0.05, 0.9) + wall("b", -0.9, 0.05) + "run 10\n").files.toml, plane));   // what pushes up pushes down as much
  CHECK_FALSE(holds(imported(grains + wall("a", -0.05, 0.9) + wall("b", -0.9, 0.04) + "run 10\n").files.toml, plane));
  CHECK(holds(imported(grains + wall("a", 0.05, 0.9) + "run 10\n").files.toml, plane));                            // they are on its other side
  const ImportedProblem p = imported(grains + wall("a", -0.05, 0.9) + wall("b", -0.9, 0.05) + "run 10\nunfix a\ncreate_atoms 2 single 0 0.5 0.03\n"
                                              "set type 2 diameter 0.1\nset type 2 density 2\nrun 10\n");
  CHECK_FALSE(holds(p.files.toml, plane));
  REQUIRE(p.problem.supports.size() == 1);
  CHECK(holds(p.files.toml, "name = \"plane\"\ngroup = \"in_plane\"\ndirections = \"z\"\n"));
  REQUIRE(p.problem.stages.size() == 2);
  CHECK(p.problem.stages[1].off == std::vector<std::string>{"support.plane", "wall.a"});
}

TEST_CASE("a script that begins anew gives a problem for each pass", "[script]") {
  std::string text = small_script_head + "group g empty\nvariable j loop 3\nlabel again\nvariable n equal 2+$j\nvariable i loop $n\nlabel row\n"
                     "create_atoms 1 single $(0.1*v_i) 0 0\nnext i\njump SELF row\nset type 1 diameter 0.1\ngroup g type 1\nfix 1 g nve\nrun 10\n"
                     "delete_atoms group all\nnext j\njump SELF again\n";
  const Reading r = reading_of(text);
  REQUIRE(r.passes.size() == 3);
  for (int k = 0; k < 3; ++k) {
    const ImportedProblem p = imported(r, static_cast<std::size_t>(k));
    CHECK(p.model.particles() == 3 + k);
    CHECK(p.model.id.front() == 1);
    CHECK(holds(p.files.toml, ", j = " + std::to_string(k + 1) + "."));
  }
}

TEST_CASE("what needs positions behind a run ends an import, and goes on with them", "[script]") {
  const ScratchDirectory scratch;
  const std::string text = three_in_a_row + "fix 1 all nve\nrun 10\ngroup right id 2 3\nvariable far equal xcm(right,x)*2\n"
                                            "create_atoms 3 single ${far} 0 0\nset type 3 diameter 0.02\ngroup all2 id 1:4\n"
                                            "create_bonds many all2 all2 2 0.2 0.5\nrun 5\n";
  const std::string file = scratch.file("in.lmp", text);
  const Reading first = script::read_script(file, {});
  REQUIRE(first.passes.size() == 1);
  CHECK(first.passes[0].world.runs.size() == 1);
  CHECK(holds(script::report(first, {}), "needs to know where particles are behind the run of"));
  CHECK(imported(first).model.particles() == 3);

  const ScratchDirectory other;
  const std::string state = other.file("final.data", "moved\n3 atoms\n2 bonds\n1 angles\n2 atom types\n2 bond types\n1 angle types\n0 1 xlo xhi\n"
                                                     "0 1 ylo yhi\n0 1 zlo zhi\n"
      "\nBond Coeffs # harmonic\n\n1 5 0.1\n2 5 0.1\n\nAngle Coeffs # cosine\n\n1 0.25\n\nAtoms # hybrid sphere angle\n\n"
      "1 1 0 0 0 0.05 2 0\n2 2 0.1 0.05 0 0.05 2 0\n3 2 0.3 0.1 0 0.05 2 0\n\nBonds\n\n1 1 1 2\n2 2 2 3\n\nAngles\n\n1 1 1 2 3\n");
  script::ReadingOptions options;
  options.after = {state};
  const ImportedProblem p = imported(script::read_script(file, options));
  CHECK(p.model.particles() == 4);
  CHECK(p.model.start.position.col(2) == Vec3(0.3, 0.1, 0));
  CHECK(p.model.start.position(0, 3) == 0.4);
  CHECK(p.model.bonds.size() == 5);                             // 1-3, 1-4 and 2-4 besides
  CHECK(p.problem.stages.empty());
  std::string staged = text_of(state);                          // of several stages: with what is made only later
  for (const auto& [from, to] : {std::pair("3 atoms", "4 atoms"), {"\n\nBonds\n", "\n9 2 7 7 7 0.05 2 0\n\nBonds\n"}})
    staged.replace(staged.find(from), std::string(from).size(), to);
  options.after = {other.file("staged.data", staged)};
  const Reading of_stages = script::read_script(file, options);
  CHECK(holds(script::report(of_stages, {}), "holds 1 atoms, from 9 on, that are not there behind this run"));
  CHECK(imported(of_stages).model.start.position == p.model.start.position);
  options.after = {scratch.file("other.data", "none\n1 atoms\n1 atom types\n\nAtoms # sphere\n\n9 1 0.1 1 0 0 0\n")};
  CHECK_THROWS_AS(script::read_script(file, options), InputError);
}

TEST_CASE("an imported column buckles as its twin in TOML", "[script]") {
  const ScratchDirectory scratch;
  // Straight: the perturbing gravity of the script starts the buckling, as in LAMMPS.
  std::string text = text_of(lammps_scripts + "column.lmp");
  const std::string bent = "2e-4*sin(PI*(${i}-1)/(${n}-1))";
  text.replace(text.find(bent), bent.size(), "0");
  const Reading reading = script::read_script(scratch.file("column.lmp", text), {});
  const script::Translated t = script::translated(reading, reading.passes.at(0), {}, "column.data");
  scratch.file("column.data", t.data);
  const std::string file = scratch.file("column.toml", t.toml);
  const std::string twin = scratch.file("twin.toml",
      "plane = \"xz\"\n[[beam]]\nname = \"b\"\nparticles = 24\ncenter = [0, 0, 0]\naxis = [0, 0, 1]\ndiameter = 1e-3\nyoungs_modulus = 0.96e6\n"
      "density = 800\n"
      "[[group]]\nname = \"low\"\nof = \"b\"\nfirst = 2\n[[group]]\nname = \"high\"\nof = \"b\"\nlast = 2\n"
      "[[support]]\ngroup = \"low\"\ndisplacement = [0, 0, 1e-4]\n[[support]]\ngroup = \"high\"\ndisplacement = [0, 0, -1e-4]\n"
      "[[gravity]]\ngroup = \"b\"\nacceleration = [1e-6, 0, 0]\n[path]\nsteps = 100\nwhen_unstable = \"jump\"\n"
      "[[observe]]\nname = \"force_bottom_z\"\ngroup = \"low\"\nquantity = \"reaction.z\"\n");
  for (const std::string& f : {file, twin}) {
    RunOptions run_options;
    run_options.file = f, run_options.directory = f + ".out", run_options.quiet = true, run_options.threads = 1;
    REQUIRE(run(run_options).exit_status == 0);
  }
  for (const char* column : {"energy", "force_bottom_z"}) {
    const double expected = last(twin + ".out", column);
    INFO(column << " " << expected);
    CHECK(std::abs(last(file + ".out", column) - expected) < 1e-9 * std::abs(expected));
  }
}

TEST_CASE("with --dynamics a script is a motion, run after run", "[script]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("in.lmp", three_in_a_row + "velocity all set 0 0 0.1\nfix 1 all nve\nfix v all viscous 0.1\n"
      "group one id 1\nfix m one move linear 0.01 0 0\nrun 20\nrun 30\n");
  const Reading r = script::read_script(file, {});
  const auto all = script::in_time(r, r.passes.at(0), {true, false, false}, {"a.data", "b.data"}, {"a"});
  REQUIRE(all.size() == 2);
  CHECK(holds(all[0].toml, "type = \"dynamics\"\n\n[dynamics]\ntimestep = 0.5\nsteps = 20\n"));
  CHECK(holds(all[0].toml, "velocity = [0.01, 0, 0]\n"));
  CHECK(holds(all[0].toml, "[[viscosity]]\ngroup = \"all\"\ncoefficient = 0.1\n"));
  CHECK(holds(all[0].data, "\nVelocities # hybrid sphere angle\n\n1 0 0 0.1"));
  CHECK(holds(all[1].toml, "start = \"a/states/final.data\""));
  CHECK(holds(all[1].toml, "steps = 30\n"));
}

TEST_CASE("in motion what nothing drives any more stays where the run before has left it", "[script]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("in.lmp", three_in_a_row + "group one id 1\ngroup rest subtract all one\nfix 1 rest nve\ntimestep 0.01\n"
      "fix m one move linear 0.5 0 0\nrun 2\nunfix m\nrun 3\n");
  REQUIRE(elamin_says("import '" + file + "' -o '" + (scratch / "p.toml") + "' --dynamics").status == 0);
  for (const char* part : {"p-run1", "p-run2"}) REQUIRE(elamin_says("'" + (scratch / (std::string(part) + ".toml")) + "' --quiet").status == 0);
  const LammpsData end = read_lammps_data(scratch / "p-run2/states/final.data");
  CHECK(end.position.col(0) == Vec3(0.01, 0, 0));
}

TEST_CASE("elamin import writes files, and no other's", "[script]") {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("in.lmp", three_in_a_row + "fix 1 all nve\nthermo 10\nrun 10\n"), out = scratch / "p.toml";
  const Answer a = elamin_says("import '" + file + "' -o '" + out + "'");
  CHECK(a.status == 0);
  CHECK(holds(a.text, "taken:\n"));
  CHECK(holds(a.text, "output: a run of elamin writes its own"));
  CHECK(elamin_says("check '" + out + "'").status == 0);
  CHECK(elamin_says("import --quiet '" + file + "' -o '" + out + "'").text.empty());           // its own it writes anew
  scratch.file("p.toml", "title = \"mine\"\n");
  const Answer mine = elamin_says("import '" + file + "' -o '" + out + "'");
  CHECK(mine.status == 1);
  CHECK(holds(mine.text, "is there already and was not written by elamin import"));
  CHECK(text_of(out) == "title = \"mine\"\n");
  CHECK(elamin_says("import --force --quiet '" + file + "' -o '" + out + "'").status == 0);
  const Answer wrong = elamin_says("import '" + scratch.file("bad.lmp", "units si\nfoo\nbar\n") + "' -o '" + (scratch / "q.toml") + "'");
  CHECK(wrong.status == 1);
  CHECK(holds(wrong.text, "bad.lmp:2:1: foo: "));
  CHECK(holds(wrong.text, "bad.lmp:3:1: bar: "));
  CHECK_FALSE(std::filesystem::exists(scratch / "q.toml"));
}

TEST_CASE("elamin import never writes over what the script reads", "[script]") {
  const ScratchDirectory scratch;
  const std::string data = scratch.file("p.data", small_data_file), out = scratch / "p.toml";
  const std::string file = scratch.file("in.lmp", "units si\nboundary f f f\natom_style hybrid sphere angle\nbond_style harmonic\nangle_style cosine\n"
      "read_data '" + data + "'\nfix 1 all nve\nrun 10\n");
  for (const std::string how : {"", "--force "}) {
    const Answer a = elamin_says("import " + how + "'" + file + "' -o '" + out + "'");
    CHECK(a.status == 1);
    CHECK(holds(a.text, "p.data: is read by the script, and would be written over"));
    CHECK(text_of(data) == small_data_file);
    CHECK_FALSE(std::filesystem::exists(out));
  }
  CHECK(elamin_says("import --quiet '" + file + "' -o '" + (scratch / "q.toml") + "'").status == 0);
}

TEST_CASE("a hundred thousand lines are read in a second or so", "[script]") {
  const ScratchDirectory scratch;
  std::string atoms, bonds;
  for (int k = 1; k <= 20000; ++k) atoms += "create_atoms 1 single " + std::to_string(k % 200 * 0.004 - 0.5) + " " + std::to_string(k / 200 * 0.004 - 0.5) + " 0\n";
  for (int k = 1; k < 20000; ++k)
    for (int t = 1; t <= 3; ++t) bonds += "create_bonds single/bond " + std::to_string(t) + " " + std::to_string(k) + " " + std::to_string(k + 1) + "\n";
  for (int k = 1; k < 19999; ++k) bonds += "create_bonds single/angle 1 " + std::to_string(k) + " " + std::to_string(k + 1) + " " + std::to_string(k + 2) + "\n";
  scratch.file("atoms.txt", atoms), scratch.file("bonds.txt", bonds);
  const std::string file = scratch.file("in.lmp", small_script_head + "include atoms.txt\nset type 1 diameter 0.004\ninclude bonds.txt\n"
      "fix 1 all nve\nrun 1\n");
  const std::clock_t begin = std::clock();
  const Reading r = script::read_script(file, {});
  const script::Translated t = script::translated(r, r.passes.at(0), {}, "p.data");
  CHECK(r.passes[0].world.bonds.size() == 59997);
  CHECK(t.data.size() > 1000000);
  CHECK(processor_seconds(begin) < 10);   // 0.3 s; far more only if it grows with the square
}

TEST_CASE("a problem file takes a script with its own tables besides", "[script]") {
  const std::string file = std::string(ELAMIN_ROOT) + "/tests/input/good/lammps_input.toml";
  const Problem p = read_problem(file);
  CHECK(p.title == "Three atoms in a row");                     // the file's own, and the script's
  CHECK(p.path.steps == 4);
  CHECK(p.path.when_unstable == WhenUnstable::jump);
  REQUIRE(p.supports.size() == 2);
  CHECK(p.supports[1].displacement == Vec3(0.1, 0, 0));
  CHECK(p.observe.size() == 2);
  const Model m = build_model(p);
  CHECK(m.particles() == 3);
  CHECK(m.bonds.size() == 2);
  const ScratchDirectory scratch;
  scratch.file("bad.lmp", "units si\nfoo\n");
  CHECK_THROWS_WITH(read_problem(scratch.file("p.toml", "[lammps]\ninput = \"bad.lmp\"\n")), Catch::Matchers::Contains("bad.lmp:2:1: foo: "));
}

TEST_CASE("a script in a problem file is read in memory, and what is to know of it is told", "[script]") {
  const ScratchDirectory scratch;
  const std::string script = three_in_a_row + "thermo 10\nfix 1 all nve\ngroup last id 3\nfix m last move linear 0.1 0 0\nrun 100\n";
  scratch.file("three.lmp", script);
  const std::string file = scratch.file("p.toml", "[lammps]\ninput = \"three.lmp\"\n");
  const auto files = [&] {
    std::vector<std::string> names;
    for (const auto& e : std::filesystem::directory_iterator(scratch / "")) names.push_back(e.path().filename().string());
    return names.size();
  };
  const Problem p = read_problem(file);
  const Model m = build_model(p);
  CHECK(files() == 2);
  CHECK(m.particles() == 3);
  CHECK(inputs_of(p) == std::vector<std::string>{scratch / "three.lmp"});
  const std::string told = describe(p, m);
  INFO(told);
  CHECK(holds(told, "note: " + (scratch / "three.lmp") + ": thermo ignored: "));
  // Only its particles: the tables are the file's own.
  const Problem alone = read_problem(scratch.file("q.toml", "[lammps]\ninput = \"three.lmp\"\nparticles_only = true\n[[support]]\n"
      "group = \"type1\"\n"));
  CHECK(alone.supports.size() == 1);
  CHECK(alone.path.place.key.empty());
  CHECK(build_model(alone).bonds.size() == m.bonds.size());
  CHECK_THROWS_WITH(read_problem(file, {{"lammps.input", "p.toml"}}), Catch::Matchers::Contains("they cannot change the script"));
}

TEST_CASE("a script of hundreds of runs is read in time", "[script]") {
  const std::clock_t begin = std::clock();
  const ImportedProblem p = imported(three_in_a_row + "fix 1 all nve\ngroup one id 1\nvariable i loop 300\nlabel again\nfix h one move linear 0 0 0\n"
                                                      "fix f all addforce 0 0 $i\n"
                                     "run 10\nunfix f\nnext i\njump SELF again\n");
  CHECK(p.problem.stages.size() == 300);
  CHECK(p.problem.loads.size() == 300);
  CHECK(processor_seconds(begin) < 5);     // 0.5 s; far more if it grows with the cube
}
