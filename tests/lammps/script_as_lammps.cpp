// Commands that do something else in LAMMPS than they seem to say. The numbers are LAMMPS's (29 Sep 2021), of a dump with %.17g.
#include "catch.hpp"
#include "energy/energy.hpp"
#include "lammps/script_reading.hpp"

namespace elamin::as_lammps {                    // names of its own: tests of a folder are compiled together

using script::Reading;

namespace {

const std::string box = "units lj\natom_style sphere\nboundary f f f\nregion box block -5 5 -5 5 -5 5\ncreate_box 2 box\n";
const std::string atoms = "create_atoms 1 single 0 0 0\ncreate_atoms 2 single 0.8 0 0\n";
const std::string spheres = "set group all diameter 1.0\nset group all density 2\n";
const std::string stiff = "pair_style granular\npair_coeff * * hertz 1000 0 tangential linear_nohistory 0 0\n";
const std::string soft = "pair_style granular\npair_coeff * * hertz 0 0 tangential linear_nohistory 0 0\n";
const std::string two = box + atoms + spheres;  // 0.2 within each other
constexpr double touching = -44.721359549995775;          // the force on the first
const std::string end = "fix 1 all nve/sphere\nrun 0\n";

double first_force(const ImportedProblem& p) { return Energy(p.model).forces(p.model.start)(0, 0); }
double first_force(const std::string& text) { return first_force(imported(text)); }
bool near(double value, double expected) { return std::abs(value - expected) <= 1e-14 * std::abs(expected); }

std::string report_of(const std::string& text, const script::TranslationOptions& options = {}) {
  const Reading r = reading_of(text);
  return script::report(r, script::translated(r, r.passes.at(0), options, "p.data").notes);
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::string refused_motion(const std::string& text) {
  try {
    report_of(text, {true, false, false});
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a mistake about the name that a command makes is told", "[script]") {
  const auto told = [](const std::string& line) { return script_mistakes(two + stiff + line + end); };    // the line is the 12th
  CHECK(told("fix grav grav gravity 1 vector 0 0 -1\n") == "12:10: fix: \"grav\" is no group; there are: all");
  CHECK(told("group clamp region clamp\n") == "12:20: group: \"clamp\" is no region; there are: box");
  CHECK(holds(told("region tube tube z 0 0 1 INF INF\n"), "12:13: region: \"tube\" is no style of a region"));
  CHECK(holds(told("fix setforse all setforse 0 0 0\n"), "12:18: fix: \"setforse\" is no fix that is known here"));
  CHECK(script_mistakes("units lj\nregion box box 0 1\ncreate_box 1 box\n").starts_with("2:12: region: \"box\" is no style of a region"));
  script::ReadingOptions skip;                   // what follows from what is left out is left out, and told
  skip.skip = true;
  const Reading r = reading_of(two + stiff + "region r ellipsoid 0 0 0 1 1 1\ngroup g region r\nvariable a python f\n"
                               "create_atoms 1 single ${a} 0 0\n" + end, skip);
  const std::string left_out = script::report(r, {});
  for (const char* line : {"in.lmp:12: region", "in.lmp:13: group", "in.lmp:14: variable", "in.lmp:15: create_atoms"}) CHECK(holds(left_out, line));
}

TEST_CASE("`none` between types of one sub-style does not end their contact in LAMMPS", "[script]") {
  const std::string hybrid = two + "pair_style hybrid/overlay granular lj/cut 1\n"
                                   "pair_coeff * * granular hertz 1000 0 tangential linear_nohistory 0 0\n";
  CHECK(holds(script_mistakes(hybrid + "pair_coeff 1 2 none\n" + end), "14:1: pair_coeff: `none` between types 1 and 2"));
  CHECK(first_force(hybrid + "pair_coeff 1 1 lj/cut 0 1\npair_coeff 1 2 none\n" + end) == 0);   // 1 1 has two styles: none it is
  CHECK(first_force(hybrid + "pair_coeff 1 2 granular hertz 0 0 tangential linear_nohistory 0 0\n" + end) == 0);
  const std::string older = "pair_style hybrid/overlay granular gran/hertz/history 700 NULL 0 NULL 0 0\n"
                            "pair_coeff * * granular hertz 1000 0 tangential linear_nohistory 0 0\n";
  CHECK(holds(script_mistakes(two + older + "pair_coeff * * gran/hertz/history\n" + end), "LAMMPS adds the contacts"));
}

TEST_CASE("pairs that neigh_modify leaves out do not touch", "[script]") {
  const std::string groups = "group a id 1\ngroup b id 2\n";
  CHECK(near(first_force(two + stiff + end), touching));
  CHECK(near(first_force(two + stiff + "neigh_modify every 1 delay 0 check yes exclude type 1 1\n" + end), touching));
  for (const std::string what : {"type 1 2", "type 2 1", "group a b", "group b all"}) {
    INFO(what);
    CHECK(first_force(two + stiff + groups + "neigh_modify delay 0 exclude " + what + "\n" + end) == 0);
    CHECK(near(first_force(two + stiff + groups + "neigh_modify exclude " + what + "\nneigh_modify exclude none\n" + end), touching));
  }
  const std::string molecules = "units lj\natom_style hybrid sphere angle\nboundary f f f\nregion box block -5 5 -5 5 -5 5\ncreate_box 2 box\n" +
                                atoms + spheres + stiff;
  CHECK(first_force(molecules + "neigh_modify exclude molecule/intra all\n" + end) == 0);
  CHECK(near(first_force(molecules + "set atom 2 mol 1\nneigh_modify exclude molecule/intra all\n" + end), touching));
  CHECK(first_force(two + "pair_style lj/cut 2\npair_coeff * * 1 .7\nneigh_modify exclude type 1 2\n" + end) == 0);
  CHECK(holds(script_mistakes(two + stiff + "neigh_modify exclude molecule/inter all\n" + end), "12:22: neigh_modify: \"molecule/inter\" says of no pairs"));
  // Coefficients that change later do not bring them back.
  const ImportedProblem p = imported(two + stiff + "neigh_modify exclude type 1 2\nfix 1 all nve/sphere\nrun 1\n"
                                     "pair_coeff 1 2 hertz 500 0 tangential linear_nohistory 0 0\nrun 1\n");
  REQUIRE(p.problem.stages.size() == 2);
  REQUIRE(p.problem.contacts.size() == 4);
  CHECK(p.problem.contacts.back().effective_modulus == 0);
  CHECK(p.problem.contacts.back().from_stage == "run2");
}

TEST_CASE("atoms that are moved before a run of no steps, or before none, are where they are then", "[script]") {
  const std::string apart = box + "create_atoms 1 single 0 0 0\ncreate_atoms 2 single 2 0 0\n" + spheres + stiff + "group g id 2\nfix 1 all nve/sphere\n";
  for (const std::string run : {"run 0\n", "run 1\n"}) {
    INFO(run);
    CHECK(near(first_force(apart + "displace_atoms g move -1.2 0 0\n" + run), touching));
    CHECK(near(first_force(apart + "set atom 2 x 0.8\n" + run), touching));
  }
  CHECK(first_force(apart + "run 0\nset atom 2 x 0.8\n") == 0);
  CHECK(imported(apart + "set atom 2 x 0.8\n").model.start.position(0, 1) == 0.8);
}

TEST_CASE("behind a clear a run of no steps is a problem, too", "[script]") {
  const Reading r = reading_of(two + soft + "clear\n" + two + stiff + end);       // nothing was run before
  REQUIRE(r.passes.size() == 1);
  CHECK(near(first_force(imported(r)), touching));
  CHECK(reading_of(two + stiff + "fix 1 all nve\nrun 10\nclear\n" + two + stiff + end).passes.size() == 2);
  CHECK(reading_of(two + stiff + end + "clear\n" + two + stiff + end).passes.size() == 2);
}

TEST_CASE("group subtract takes members out of a group that is there, regions with open faces are everywhere", "[script]") {
  const auto members = [](const std::string& lines) {
    const script::World w = reading_of(two + stiff + lines).passes.at(0).world;
    std::string ids;
    for (const script::Atom& a : w.atoms)
      if (w.in(a, w.group("g", 0))) ids += std::to_string(a.id);
    return ids;
  };
  CHECK(members("group g id 1 2\ngroup one id 1\ngroup g subtract g one\n") == "2");
  CHECK(members("group g id 2\ngroup one id 1\ngroup g subtract one g\n").empty());
  CHECK(members("region R cylinder z 0 0 0.5 -1 1\ngroup g region R\n") == "1");
  CHECK(members("region R cylinder z 0 0 0.5 -1 1 open 1\ngroup g region R\n") == "12");
}

TEST_CASE("pair_style said again keeps the coefficients of the same style", "[script]") {
  CHECK(near(first_force(two + stiff + "pair_style granular\n" + end), touching));
  CHECK(near(first_force(two + "pair_style lj/cut 2\npair_coeff * * 1 .7\npair_style lj/cut 1.5\n" + end), 1.3788252780796117));
  CHECK(first_force(two + "pair_style lj/cut 2\npair_coeff * * 1 .7\npair_style lj/cut 0.75\n" + end) == 0);      // the new cutoff
  CHECK(first_force(two + stiff + "pair_style lj/cut 2\npair_coeff * * 0 1\npair_style granular\n" + end) == 0);
}

TEST_CASE("units have LAMMPS's timesteps, halves are rounded up, gravity in two dimensions has no z", "[script]") {
  for (const auto& [units, dt] : {std::pair("lj", 0.005), {"si", 1e-8}, {"cgs", 1e-8}, {"micro", 2.0}, {"nano", 0.00045}})
    CHECK(reading_of("timestep 7\nunits " + std::string(units) + "\n" + two.substr(9) + stiff + end).passes.at(0).world.timestep == dt);
  CHECK(first_force(two + soft + "fix a all addforce $(round(-2.5)+10*round(2.5)) 0 0\n" + end) == 28);
  const ImportedProblem p = imported("dimension 2\n" + two + stiff + "fix g all gravity 1 chute 20\nfix e all enforce2d\n" + end);
  const Field f = Energy(p.model).forces(p.model.start);
  CHECK(near(f(0, 0), -44.363196893445227));
  CHECK(near(f(1, 1), -0.98404381136451624));
}

TEST_CASE("atoms of a union are drawn within the box around its parts", "[script]") {
  const script::World w = reading_of(box + "region A sphere 0 0 0 1\nregion B sphere 1 0 0 1\nregion U union 2 A B\nregion I intersect 2 A B\n"
                                           "create_atoms 1 random 3 4711 U\ncreate_atoms 1 random 1 4711 I\n").passes.at(0).world;
  const Vec3 expected[]{
        Vec3(0.56429731033942532, 0.42992991648145473, -0.16789369618887717),
        Vec3(0.81597223031147026, 0.36351656325325199, -0.37712140259198912),
        Vec3(0.080879954658858333, -0.10040136571060931, 0.55424650178954304),
        Vec3(0.52143243677980844, 0.42992991648145473, -0.16789369618887717)};
  REQUIRE(w.atoms.size() == 4);
  for (std::size_t k = 0; k < 4; ++k) CHECK((w.atoms[k].x - expected[k]).norm() < 1e-15);
}

TEST_CASE("atoms of a prism are drawn within the box around it", "[script]") {
  const std::string prism = " prism -0.8 0.4 -0.5 0.5 -0.6 0.5 0.3 -0.2 0.4";
  const script::World w = reading_of("units lj\natom_style sphere\nregion box block -1 1 -1 1 -1 1\nregion p" + prism + "\nregion q" + prism +
                                     " side out\ncreate_box 1 box\nchange_box all boundary f f f\ncreate_atoms 1 random 40 4711 p\n"
                                     "create_atoms 1 random 3 11 q\n").passes.at(0).world;
  REQUIRE(w.atoms.size() == 43);
  CHECK((w.atoms[0].x - Vec3(-0.11356485747432565, 0.50095094153701836, -0.14234153290388241)).norm() < 1e-15);
  CHECK((w.atoms[39].x - Vec3(-0.39035034165268312, -0.10321707017869552, -0.18302024476370776)).norm() < 1e-15);
  CHECK((w.atoms[42].x - Vec3(0.91804849352596718, -0.35896930906873625, 0.80282248174903104)).norm() < 1e-15);
}

TEST_CASE("forces along a line or in a plane hold what is across it", "[script]") {
  const std::string head = small_script_head + "create_atoms 1 single 0 0 0\nset type 1 diameter 0.1\nset type 1 density 1\nfix i all nve/sphere\n";
  const auto tables = [&](const std::string& fix) {
    const Reading r = reading_of(head + "fix h all " + fix + "\nrun 10\n");
    const std::string toml = script::translated(r, r.passes.at(0), {}, "p.data").toml;
    return toml.substr(toml.find("[[support]]"));
  };
  CHECK(tables("lineforce 0 2 0") == tables("setforce 0 NULL 0"));
  CHECK(tables("planeforce 0 2 0") == tables("setforce NULL 0 NULL"));
  CHECK(holds(script_mistakes(head + "fix h all planeforce 1 1 0\n"), "planeforce along x, y or z is taken"));
}

TEST_CASE("what LAMMPS does otherwise is told or refused", "[script]") {
  CHECK(holds(report_of(two + soft + "fix w all wall/gran granular hertz 1000 0 tangential linear_nohistory 0 0 zplane -0.45 0.4\n" + end),
              "the nearer one alone"));
  CHECK_FALSE(holds(report_of(two + soft + "fix w all wall/gran granular hertz 1000 0 tangential linear_nohistory 0 0 zplane -0.5 0.5\n" + end),
                    "the nearer one alone"));
  const std::string held = two + soft + "fix 1 all nve/sphere\ngroup a id 1\n";
  CHECK(holds(report_of(held + "fix s a setforce 0 0 0\nfix f a addforce 1 0 0\nrun 1\n"), "LAMMPS lets the fix f, which comes behind the fix s, move"));
  CHECK(holds(report_of(held + "fix s a freeze\nfix g all gravity 1 vector 0 0 -1\nrun 1\n"), "LAMMPS lets the fix g, which comes behind the fix s, move"));
  CHECK_FALSE(holds(report_of(held + "fix f a addforce 1 0 0\nfix s a setforce 0 0 0\nrun 1\n"), "which comes behind"));
  CHECK_FALSE(holds(report_of(held + "fix s a setforce 0 0 0\nfix v all viscous 1\nrun 1\n"), "which comes behind"));
  CHECK(holds(report_of(held + "velocity all set 1 0 0\nfix s a setforce 0 0 0\nfix v all viscous 1\nrun 1\n"), "LAMMPS lets the fix v, which comes behind the fix s, move"));
  CHECK(holds(refused_motion(held + "run 1\nfix s a setforce 0 0 0\nrun 1\n"),
              "in.lmp:15:1: fix: s, which lets what moved freely go on at the velocity that it has by then, is not followed in motion"));
  CHECK_FALSE(holds(report_of(held + "fix s a setforce NULL 0 0\nfix f a addforce 1 0 0\nrun 1\n"), "which comes behind"));
  CHECK(holds(report_of(held + "fix g all gravity 1 vector 0 0 -1\nminimize 0 1e-8 9 9\n"), "LAMMPS's minimize leaves out fixes of style gravity"));
  CHECK(holds(report_of(held + "reset_atom_ids\nrun 1\n"), "LAMMPS numbers the atoms anew"));
  const std::string cone = "region c cone y 0 0 1 2 -2 2", wall = "\nfix w all wall/gran/region granular hertz 9 0 tangential linear_nohistory 0 0 region c\nrun 1\n";
  CHECK(holds(report_of(held + cone + wall), "at the ends of a cone along y LAMMPS (29 Sep 2021) pushes along z"));
  CHECK_FALSE(holds(report_of(held + cone + " open 1 open 2" + wall), "pushes along z"));
  const std::string tube = "region c cylinder z 0 0 0.5 -1 1";
  CHECK(holds(report_of(held + tube + " open 3" + wall), "1 of 2 particles are outside of this wall's region, which has open faces"));
  CHECK_FALSE(holds(report_of(held + "region c cylinder z 0 0 1 -1 1 open 1" + wall), "which has open faces"));
  const std::string own = "pair_coeff 1 1 hertz 9 1 tangential linear_nohistory 0.5 0.1\npair_coeff 2 2 hertz 9 ";
  const std::string like = own + "1 tangential linear_nohistory 0.5 0.1\nrun 1\n", unlike = own + "2 tangential linear_nohistory 0.5 0.1\nrun 1\n";
  const std::string mixing = box + atoms + spheres + "fix 1 all nve/sphere\npair_style granular\n";
  CHECK(holds(report_of(mixing + like), "Hooke's force k delta with Hertz's k"));
  CHECK_FALSE(holds(report_of(held + "run 1\n"), "Hooke"));
  CHECK(holds(refused_motion(mixing + unlike), "damping and friction of types 1 and 2 differ"));
  CHECK(refused_motion(mixing + like).empty());
  CHECK(script_mistakes(mixing + unlike).empty());
  for (const auto& [fix, refused] : {std::pair("nve", true), {"nve/sphere", false}})    // that friction turns
    CHECK(holds(refused_motion(two + "fix 1 all " + fix + "\npair_style granular\npair_coeff * * hertz 9 1 tangential linear_nohistory 0.5 0.1\nrun 1\n"),
                "nve rotates no particle") == refused);
  const auto older = [&](const std::string& numbers) {
    return imported(two + "fix 1 all nve/sphere\npair_style gran/hertz/history " + numbers + "\npair_coeff * *\nrun 1\n", {true, false, false}).files.toml;
  };
  CHECK(holds(older("9 0 4 NULL 0.3 1"), "damping_coefficient = 4\nfriction = 0.3\nfriction_damping = 0.5\n"));
  CHECK(holds(older("9 0 4 1 0.3 1"), "friction_damping = 0.25\n"));
  CHECK(holds(older("9 0 4 1 0.3 0"), "friction_damping = 0\n"));
  CHECK_FALSE(holds(older("9 0 0 0 0.3 1"), "friction"));       // without damping along the normal there is none
  CHECK(holds(report_of(two + "fix 1 all nve/sphere\npair_style gran/hertz/history 9 NULL 4 1 0.3 0\npair_coeff * *\nrun 1\n"), "friction that remembers"));
  for (const std::string line : {"velocity all create 1 4711", "velocity all zero linear", "fix l all langevin 1 1 1 4711", "fix m all momentum 1 linear 1 1 1",
                                 "fix n all nve/limit 0.1", "pair_coeff 1 1 hertz 9 1 tangential linear_nohistory 0 0 limit_damping"}) {
    INFO(line);
    CHECK(holds(refused_motion(held + line + "\nrun 1\n"), "in.lmp:14:1: " + line.substr(0, line.find(' ')) + ": "));
    CHECK(script_mistakes(held + line + "\nrun 1\n").empty());
  }
  const Reading bouncing = reading_of(held + "fix w all wall/gran granular hertz 9 0.5 damping tsuji tangential linear_nohistory 0 0 zplane -2 NULL\nrun 1\nrun 1\n");
  const auto motions = script::in_time(bouncing, bouncing.passes.at(0), {true, false, false}, {"a.data", "b.data"}, {"a"});
  CHECK_FALSE(holds(script::report(bouncing, motions.at(0).notes), "tsuji"));
  CHECK(holds(script::report(bouncing, motions.at(1).notes), "the damping of a tsuji wall anew from itself in each run"));
  for (const auto& [line, what] : {std::pair("fix a-b all nve", "\"a-b\" is no name of a fix"), {"fix n all nve/sphere foo", "\"foo\" is no keyword"},
                                   {"pair_style granular abc", "\"abc\" is not a number"}, {"bond_style zero zero", "\"zero\" is no word"},
                                   {"include nope.in", "there is no such file"}})
    CHECK(holds(script_mistakes(held + line + "\n"), what));
}

TEST_CASE("what particles are and how fast they are is that of the run", "[script]") {
  const std::string free = two + soft + "group a id 1\nfix 1 all nve/sphere\ntimestep 0.5\n", run = "run 10\n";
  for (const std::string what : {"density 4", "diameter 2", "mass 7", "type 2"}) {
    INFO(what);
    const std::string text = free + run + "set group a " + what + "\n" + run;
    CHECK(holds(report_of(text), "in.lmp:16: set changes what was there in the run of"));
    const ImportedProblem p = imported(text);
    CHECK(p.problem.stages.empty());
    CHECK((p.model.density[0] == 2 && p.model.diameter[0] == 1 && p.model.type[0] == 1));
  }
  CHECK(imported(free + run + "set group all density 2\n" + run).problem.stages.size() == 2);
  CHECK(near(first_force(two + stiff + end + "set group all diameter 3\n"), touching));
  CHECK(holds(report_of("units lj\nboundary f f f\nregion b block 0 1 0 1 0 1\ncreate_box 1 b\ncreate_atoms 1 single 0 0 0\nmass 1 2\npair_style zero 1\n"
                        "fix 1 all nve\nrun 1\nmass 1 3\nrun 1\n"), "in.lmp:10: mass changes what was there"));
  const auto moved = [&](const std::string& lines) {           // displacements at load factor 1, support by support
    std::vector<double> all;
    for (const Support& s : imported(free + lines).model.supports) all.push_back(s.displacement[0]);
    return all;
  };
  CHECK(moved("velocity a set 0.1 0 0\nfix s a setforce 0 0 0\nrun 10\nvelocity a set 0 0 0\nrun 10\n") == std::vector{0.5, 0.0});
  CHECK(moved("velocity a set 0.1 0 0\nfix s a freeze\nrun 10\n") == std::vector{0.5});      // LAMMPS lets them go on
  const std::string stop = "fix m a move linear 0.1 0 0\nrun 10\nunfix m\nfix s a setforce 0 0 0\nrun 10\n";
  CHECK(moved(stop) == std::vector{0.5, 0.5});                 // here, too
  CHECK(holds(report_of(free + stop), "fix s lets what it holds go on at the velocity that it had, as LAMMPS does; `velocity a set 0 0 0`"));
  CHECK(moved("velocity a set 0.1 0 0\nrun 10\nfix s a setforce 0 0 0\nrun 10\n") == std::vector{0.0});   // at rest behind an equilibrium
  CHECK(holds(refused_motion(free + run + "velocity a set 0.1 0 0\n" + run), "in.lmp:16:1: velocity: "));
  CHECK(holds(refused_motion(free + run + "fix s a setforce 0 0 0\n" + run), "in.lmp:16:1: fix: "));
  CHECK(holds(imported(free + "set group a omega 0 0 3 vx 1\n" + run, {true, false, false}).files.data, "Velocities # hybrid sphere angle\n\n1 1 0 0 0 0 3\n"));
  // What fix move has moved is where the whole time at the new timestep would have brought it.
  const std::string move = "fix m a move linear 1 0 0\n", step = free + move + run + "timestep 0.1\n";
  CHECK(holds(script_mistakes(step + run), "18:1: run: the timestep has changed since fix m began"));
  CHECK(script_mistakes(step + move + run).empty());
}

TEST_CASE("bonds and angles without a style, and of atoms that are deleted", "[script]") {
  const std::string glued = small_script_head + "create_atoms 1 single 0 0 0\ncreate_atoms 1 single 0.11 0 0\ncreate_atoms 1 single 0.2 0.05 0\ncreate_atoms 1 single 0.9 0 0\n"
                            "set group all diameter 0.05\ncreate_bonds single/bond 1 1 2\ncreate_bonds single/bond 1 2 3\ncreate_bonds single/angle 1 1 2 3\ngroup g id 3\n";
  const auto energies = [&](const std::string& lines) {
    ImportedProblem p = imported(glued + lines + end);
    return Energy(p.model).terms(p.model.start);
  };
  const EnergyTerms all = energies(""), no_angles = energies("angle_style none\n"), no_bonds = energies("bond_style none\n");
  CHECK((all.bond > 0 && all.angle > 0));
  CHECK((no_angles.bond == all.bond && no_angles.angle == 0));
  CHECK((no_bonds.bond == 0 && no_bonds.angle == all.angle));
  CHECK(holds(script_mistakes(glued + "bond_style harmonic\n" + end), "bonds of type 1 have no coefficients"));
  CHECK(holds(script_mistakes(glued + "delete_atoms group g\n" + end), "22:1: delete_atoms: leaves bonds or angles of atoms that are gone"));
  CHECK(script_mistakes(glued + "delete_atoms group g bond yes\n" + end).empty());
  CHECK(imported(glued + "set atom 1*3 mol 2\ndelete_atoms group g mol yes\n" + end).model.particles() == 1);
  CHECK(imported(glued + "fix 1 all nve\nrun 10\ndelete_bonds all angle 1\nrun 10\n").problem.stages.size() == 2);
}

TEST_CASE("fixes of all atoms hold those alone that no later fix holds", "[script]") {
  const ImportedProblem p = imported(two + stiff + "fix 1 all nve/sphere\ngroup a id 1\nfix h all setforce 0 0 0\nfix m a move linear 0.1 0 0\nrun 10\n");
  REQUIRE(p.model.supports.size() == 2);
  CHECK(p.model.supports[0].particles == std::vector<int>{1});
  CHECK(p.model.supports[1].particles == std::vector<int>{0});
}

TEST_CASE("a style that is not known within a hybrid one is told, or left out", "[script]") {
  const std::string text = two + "pair_style hybrid/overlay lj/cut 2.5 soft 2.5\npair_coeff * * lj/cut 1 0.7\npair_coeff * * soft 0\n" + end;
  const std::string told = script_mistakes(text);
  CHECK(holds(told, "10:38: pair_style: \"soft\" is no pair style that is known here"));
  CHECK_FALSE(holds(told, "\n"));
  script::ReadingOptions skip;
  skip.skip = true;
  const Reading r = reading_of(text, skip);
  CHECK(near(first_force(imported(r)), 1.3788252780796117));
  CHECK(holds(script::report(r, {}), "in.lmp:10: pair_style: \"soft\""));
}

TEST_CASE("nve/noforce moves atoms at their velocities, whatever touches them", "[script]") {
  const std::string text = two + stiff + "group a id 1\ngroup b id 2\nfix 1 a nve/sphere\nfix 2 b nve/noforce\ntimestep 0.5\n";
  const ImportedProblem still = imported(text + "run 10\n"), drawn = imported(text + "velocity b set 0.1 0 0\nrun 10\n");
  REQUIRE(still.model.supports.size() == 1);
  CHECK(still.model.supports[0].particles == std::vector<int>{1});
  CHECK(still.model.supports[0].displacement == Vec3::Zero());
  CHECK(drawn.model.supports.at(0).displacement == Vec3(0.5, 0, 0));
  CHECK(imported(text + "minimize 0 1e-8 9 9\n").model.supports.empty());
}

TEST_CASE("a wall has the surface that its region has when a run begins, velocities are added where that is said", "[script]") {
  const std::string text = two + soft + "fix 1 all nve/sphere\nregion R plane 0 0 -0.3 0 0 1\n"
                           "fix w all wall/gran/region granular hertz 1000 0 tangential linear_nohistory 0 0 region R\nregion R delete\n";
  CHECK(imported(text + "region R plane 0 0 -0.1 0 0 1\nrun 0\n").model.walls.at(0).region.center[2] == -0.1);
  CHECK(holds(script_mistakes(text + "run 0\n"), "the region \"R\" of the fix w is there no more"));
  const script::World w = reading_of(two + "velocity all set 1 2 3\nvelocity all set 0.5 NULL 1 sum yes\n").passes.at(0).world;
  CHECK(w.atoms.at(0).v == Vec3(1.5, 2, 4));
}

TEST_CASE("sides of the box shrink around what is there where LAMMPS lets them", "[script]") {
  const std::string made = "units lj\natom_style hybrid sphere bond\nboundary s m f\nregion box block -3 3 -2 2 -1 1\n"
      "create_box 1 box bond/types 1\ncreate_atoms 1 random 2 4711 NULL\ncreate_atoms 1 single 1 0.5 0\ncreate_atoms 1 single 3.0004 0 0\n"
      "create_atoms 1 single 3.0007 0 0\n";           // the last one is outside
  const std::string displaced = made + "displace_atoms all ramp z 0 0.1 x -3 3\ndisplace_atoms all rotate 0.1 0.2 0 0 0 1 30\n";
  const std::string changed = displaced + "change_box all boundary s s f y delta -1 2 z scale 3\n";
  const auto after = [](const std::string& text) { return reading_of(text).passes.at(0).world; };
  const auto close = [](double value, double expected) { return std::abs(value - expected) <= 1e-14; };
  const script::World a = after(made);
  REQUIRE(a.atoms.size() == 4);
  CHECK(close(a.atoms[0].x[0], 0.128620339602986));
  CHECK(close(a.atoms[1].x[0], 0.632070849515065));
  CHECK(close(a.side(0, 1) - a.side(0, 0), 6.0012));
  const script::World b = after(displaced);
  CHECK(close(b.atoms[0].x[0], -0.205143975320331));
  CHECK(close(b.atoms[1].x[1], 0.922459500948103));
  CHECK(close(b.atoms[2].x[2], 0.0666666666666667));
  CHECK(close(b.atoms[2].x[0], 0.729422863405995));
  CHECK(close(b.side(0, 0), -0.205743975320331));
  CHECK(close(b.side(0, 1), 2.71242008113639));
  CHECK(b.side(1, 0) == -2);
  const script::World c = after(changed);
  CHECK(close(c.side(0, 0), -0.205435908464211));
  CHECK(close(c.side(0, 1), 2.71211201428027));
  CHECK(close(c.side(1, 0), 0.785065328068329));
  CHECK(close(c.side(1, 1), 1.47769513925911));
  CHECK(c.side(2, 1) == 3);
  const script::World d = after(changed + "change_box all boundary f f f x final -4 5 y final -4 4 set x final -8 10 remap units box\n");
  CHECK(d.side(0, 0) == -8);
  CHECK(close(d.atoms[0].x[0], -0.410287950640662));
  CHECK(close(d.atoms[2].x[0], 1.45884572681199));
  CHECK(close(d.atoms[0].x[1], 0.78576554808433));
  // Behind a run where the sides are is not known.
  const Reading moved = reading_of(made + "set group all diameter 0.1\npair_style zero 1\npair_coeff * *\nfix 1 all nve/sphere\nrun 10\n"
                                   "create_atoms 1 single 0 0 0\ncreate_atoms 1 single $(xhi) 0 0\nrun 10\n");
  REQUIRE(moved.notes.size() == 2);
  CHECK(holds(moved.notes[1].text, "needs to know where particles are behind the run"));
  CHECK(moved.passes.at(0).world.atoms.size() == 5);
}

TEST_CASE("lengths are in the lattice's constant unless they are said to be in the box's", "[script]") {
  const auto x = [](const std::string& lines) {
    return reading_of("lattice none 2\n" + box + "create_atoms 1 single 0 0 0\n" + lines).passes.at(0).world.atoms.at(0).x[0];
  };
  CHECK(x("displace_atoms all move 0.5 0 0\n") == 1);
  CHECK(x("displace_atoms all move 0.5 0 0 units box\n") == 0.5);
  const std::string pushed = "lattice none 2\n" + two + soft + "timestep 0.5\nfix m all move linear 1 0 0";
  CHECK(imported(pushed + "\nrun 2\n").model.supports.at(0).displacement == Vec3(2, 0, 0));
  CHECK(imported(pushed + " units box\nrun 2\n").model.supports.at(0).displacement == Vec3(1, 0, 0));
}

TEST_CASE("variables of a file have the first word of each line, those of a universe count on", "[script]") {
  const ScratchDirectory scratch;
  scratch.file("places", "# x\n\n  0.5 and more # the first\n-1.5e0\n");
  const Reading r = script::read_script(scratch.file("in.lmp", box + "variable x file places\nvariable x file other\nvariable i uloop 5\nlabel next\n"
      "create_atoms 1 single $x $i 0\nnext i\nnext x\njump SELF next\nif $(is_defined(variable,x)+is_defined(group,all)==1) then 'create_atoms 1 single 4 4 4'\n"), {});
  const auto& made = r.passes.at(0).world.atoms;
  REQUIRE(made.size() == 3);
  CHECK(made[0].x == Vec3(0.5, 1, 0));
  CHECK(made[1].x == Vec3(-1.5, 2, 0));
  CHECK(made[2].x == Vec3(4, 4, 4));
}

TEST_CASE("what is frozen is infinitely heavy to LAMMPS's damping, which no motion here follows", "[script]") {
  const auto told = [](const std::string& damping) {
    return refused_motion(two + "pair_style granular\npair_coeff * * hertz 1000 " + damping + " tangential linear_nohistory 0 0\ngroup g id 1\nfix 1 all nve/sphere\n"
                          "fix h g freeze\nrun 5\n");
  };
  CHECK(told("1 damping velocity") == "");
  CHECK(told("0") == "");
  CHECK(holds(told("1 damping mass_velocity"), ":14:1: fix: contacts of frozen atoms are damped as if these were infinitely heavy"));
}

TEST_CASE("bonds are made as far as LAMMPS's neighbour lists reach, where it makes some", "[script]") {
  const std::string four = "units lj\natom_style hybrid sphere bond\nboundary f f f\nregion box block -5 5 -5 5 -5 5\ncreate_box 2 box bond/types 1\n"
                           "create_atoms 1 single 0 0 0\ncreate_atoms 1 single 0.75 0 0\ncreate_atoms 2 single 0 0.75 0\ncreate_atoms 2 single 0 1.5 0\n"
                           "set type 1 diameter 0.4\nset type 2 diameter 0.8\nbond_style harmonic\nbond_coeff 1 1 1\n" + stiff;
  const auto bonds = [&](const std::string& lines) { return reading_of(four + lines).passes.at(0).world.bonds.size(); };
  CHECK(bonds("create_bonds many all all 1 0 0.8\n") == 2);                 // not between those of type 1: 0.4 + 0.3 apart at most
  CHECK(bonds("neighbor 0.4 bin\ncreate_bonds many all all 1 0 0.8\n") == 3);
  CHECK(bonds("create_bonds many all all 1 0 1.2\n") == 4);                 // farther than any list reaches, where LAMMPS stops
  CHECK(holds(report_of(four + "create_bonds many all all 1 0 0.8\n"), "makes no bond between 1 pairs that are farther apart"));
}

}  // namespace elamin::as_lammps
