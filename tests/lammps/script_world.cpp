// What scripts build.
#include "catch.hpp"
#include "energy/energy.hpp"
#include "input/stages.hpp"
#include "lammps/script_reading.hpp"
#include "lammps/stage_walk.hpp"

#include <fstream>
#include <map>

using namespace elamin;
using script::Reading;

TEST_CASE("forces are LAMMPS's while variables change loads and walls", "[script]") {
  const Reading reading = script::read_script(lammps_scripts + "formulas.lmp", {});
  const ScratchDirectory scratch;
  const script::Translated made = script::translated(reading, reading.passes.at(0), {}, "p.data");
  INFO(made.toml);
  scratch.file("p.data", made.data);
  const Problem problem = read_problem(scratch.file("p.toml", made.toml));
  std::map<int, std::map<int, Vec3>> expected;                  // by step and id
  std::ifstream in(lammps_scripts + "formulas.forces");
  for (int step, id; in >> step >> id;) {
    Vec3& f = expected[step][id];
    in >> f[0] >> f[1] >> f[2];
  }
  StageWalk walk(problem);
  REQUIRE(walk.count() == 2);
  for (int run = 0; run < 2; ++run) {
    walk.enter();
    for (const int half : {0, 1, 2}) {
      const int step = 20 * run + 10 * half;
      INFO("step " << step);
      const Field f = walk.at(half / 2.0).forces;
      REQUIRE(f.cols() == 3);
      for (int i = 0; i < 3; ++i) CHECK((f.col(i) - expected.at(step).at(walk.model().id[i])).norm() < 1e-12 * 20);   // the largest is 20
    }
  }
}

TEST_CASE("groups are LAMMPS's", "[script]") {
  std::string text = small_script_head;
  for (int k = 1; k <= 9; ++k) text += "create_atoms " + std::to_string(1 + k % 3) + " single " + std::to_string(0.1 * k - 0.5) + " 0 0\n";
  text += "set atom 4*6 mol 2\nset atom 9 mol 5\nregion left block -1 0.001 -1 1 -1 1\nregion not_left block -1 0.001 -1 1 -1 1 side out\n"
          "region ball sphere 0 0 0 0.15\nregion both intersect 2 left ball\nregion any union 2 left ball\nvariable v atom \"x > 0.2 || id == 1\"\n";
  const std::pair<const char*, std::vector<int>> groups[]{
      {"id 1 3:7:2 9", {1, 3, 5, 7, 9}}, {"type 1", {3, 6, 9}}, {"type <= 2", {1, 3, 4, 6, 7, 9}}, {"id <> 3 5", {3, 4, 5}}, {"molecule 2 5", {4, 5, 6, 9}},
      {"region left", {1, 2, 3, 4, 5}}, {"region not_left", {6, 7, 8, 9}}, {"region both", {4, 5}}, {"region any", {1, 2, 3, 4, 5, 6}},
      {"variable v", {1, 8, 9}}, {"union a b", {1, 2, 3, 4, 5, 9}}, {"subtract all a b", {6, 7, 8}}, {"intersect a b", {1, 3}}, {"empty", {}}};
  text += "group a id 1 3 9\ngroup b id 1:5\n";
  std::size_t k = 0;
  for (const auto& [words, ids] : groups) text += "group g" + std::to_string(k++) + " " + words + "\n";
  text += "group a clear\ngroup b delete\ngroup c id 2\ngroup c id 3\ngroup c include molecule\n";
  const script::World w = reading_of(text).passes.at(0).world;
  const auto members = [&](const std::string& name) {
    std::vector<int> ids;
    for (const script::Atom& a : w.atoms)
      if (w.in(a, w.group(name, 0))) ids.push_back(a.id);
    return ids;
  };
  k = 0;
  for (const auto& [words, ids] : groups) {
    INFO(words);
    CHECK(members("g" + std::to_string(k++)) == ids);
  }
  CHECK(members("a").empty());
  CHECK_FALSE(w.find_group("b"));
  CHECK(members("c") == std::vector<int>{1, 2, 3, 7, 8});       // of molecule 0
}

TEST_CASE("atoms are set, deleted and numbered as LAMMPS does", "[script]") {
  const script::World w = reading_of(small_script_head +
      "create_atoms 1 single 0 0 0\ncreate_atoms 2 single 0.3 0 0\ncreate_atoms 3 single 2 0 0\ncreate_atoms 3 single 1 0 0\n"
      "create_atoms 3 single 0.6 0 0\n"
      "set type 1 density 2\nset type 1 diameter 2\nset type 2 diameter 2\nset type 2 density 2\nset group all vx 0.5\n"
      "create_bonds single/bond 1 1 2\ncreate_bonds single/bond 2 2 3\ncreate_bonds single/angle 1 1 2 3\n"
      "group last id 3\ndelete_atoms group last bond yes\ncreate_atoms 2 single 0.7 0 0\n").passes.at(0).world;
  REQUIRE(w.atoms.size() == 4);                                 // two lay outside of the box, at its upper end among them
  CHECK(w.atoms[0].density == 0.25);                            // LAMMPS keeps the mass where the diameter is set
  CHECK(w.atoms[1].density == 2);
  CHECK(w.atoms[3].id == 3);                                    // behind the largest one that is there
  CHECK(w.atoms[3].diameter == 1);
  CHECK(w.bonds.at(0).gone == script::always);
  CHECK(w.bonds.at(1).gone != script::always);
  CHECK(w.angles.at(0).gone != script::always);
  CHECK(w.with_id(3, 0) == 3);
  CHECK_THROWS_AS(w.with_id(4, 0), script::Wrong);
}

TEST_CASE("of no atoms there are none to set", "[script]") {
  const Reading r = reading_of(small_script_head + "set atom * density 2\nset group all type 2\ncreate_atoms 1 single 0 0 0\nset atom *9 type 3\n"
                               "set atom 2*9 type 2\n");
  CHECK(r.passes.at(0).world.atoms.at(0).type == 3);
}

TEST_CASE("bonds are made between all that are near, but for those that are neighbours already", "[script]") {
  std::string text = small_script_head;
  for (int k = 0; k < 6; ++k) text += "create_atoms 1 single " + std::to_string(0.1 * k) + " 0 0\n";
  text += "group g type 1\ngroup h id 1:3\ncreate_bonds many g g 1 0.05 0.11\n";
  CHECK(reading_of(text).passes.at(0).world.bonds.size() == 5);
  CHECK(reading_of(text + "create_bonds many g g 2 0.05 0.11\n").passes.at(0).world.bonds.size() == 5);
  CHECK(reading_of(text + "create_bonds many g g 2 0.05 0.21\n").passes.at(0).world.bonds.size() == 9);
  CHECK(reading_of(text + "create_bonds many h g 2 0.15 0.21\n").passes.at(0).world.bonds.size() == 8);
  CHECK(reading_of(text + "special_bonds lj/coul 0 0 1\ncreate_bonds many g g 2 0.05 0.21\n").passes.at(0).world.bonds.size() == 5);
  CHECK(reading_of(text + "special_bonds dreiding\ncreate_bonds many g g 2 0.05 0.21\n").passes.at(0).world.bonds.size() == 5);
  CHECK(reading_of(text + "special_bonds fene\n").passes.at(0).world.special_lj == std::array<double, 3>{0, 1, 1});
  CHECK(reading_of(text + "special_bonds lj/coul 1 1 1\ncreate_bonds many g g 2 0.05 0.11\n").passes.at(0).world.bonds.size() == 10);
}

TEST_CASE("loops, jumps, conditions and included files are followed", "[script]") {
  const ScratchDirectory scratch;
  scratch.file("row.txt", "variable x equal 0.1*$i\nif \"$i == 3\" then \"jump SELF out\"\ncreate_atoms 1 single $x 0 0\nlabel out\n");
  const std::string text = small_script_head +
      "variable i loop 5\nlabel again\ninclude row.txt\nnext i\njump SELF again\nvariable w index one two\n"
      "if \"${w} == one && 2 > 1\" then \"create_atoms 2 single 0 0.5 0\" \"create_atoms 2 single 0 0.6 0\" elif \"1\" \"create_atoms 3 single 0 0 0\" else "
      "\"create_atoms 3 single 0 0 0.1\"\nif \"0\" then \"foo\" elif \"${w} == one\" \"create_atoms 3 single 0 0.7 0\" else \"foo\"\n"
      "jump SELF end\ncreate_atoms 3 single 0 0 0.2\nlabel end\nquit\nthis is not read\n";
  const Reading r = script::read_script(scratch.file("in.lmp", text), {});
  const script::World& w = r.passes.at(0).world;
  std::string types;
  for (const script::Atom& a : w.atoms) types += std::to_string(a.type);
  CHECK(types == "1111223");
  CHECK(r.files.size() == 2);
  CHECK(r.told.size() > 5);
}

TEST_CASE("a data file has the columns of the atom style that the script names", "[script]") {
  const ScratchDirectory scratch;
  const std::string head = "one\n\n1 atoms\n1 atom types\n\n-1 1 xlo xhi\n-1 1 ylo yhi\n-1 1 zlo zhi\n\nAtoms";
  const auto read = [&](const std::string& style, const std::string& row) {
    scratch.file("one.data", head + "\n\n" + row + "\n");
    return script::read_script(scratch.file("in.lmp", "atom_style " + style + "\nread_data one.data\n"), {}).passes.at(0).world.atoms.at(0);
  };
  for (const auto& [style, row] : {std::pair("hybrid sphere angle", "7 1 0.1 0.2 0.3 0.5 2 4"), std::pair("hybrid angle sphere", "7 1 0.1 0.2 0.3 4 0.5 2"),
                                   std::pair("sphere", "7 1 0.5 2 0.1 0.2 0.3"), std::pair("hybrid sphere", "7 1 0.1 0.2 0.3 0.5 2")}) {
    INFO(style);
    const script::Atom atom = read(style, row);
    CHECK((atom.id == 7 && atom.x == Vec3(0.1, 0.2, 0.3) && atom.diameter == 0.5 && atom.density == 2));
  }
  // Rows of coefficients are the script's styles'.
  const auto coefficients = [&](const std::string& styles, const std::string& rows, const std::string& how = "") {
    scratch.file("two.data", "two\n\n2 atoms\n1 bonds\n0 angles\n2 atom types\n2 bond types\n1 angle types\n-1 1 xlo xhi\n-1 1 ylo yhi\n-1 1 zlo zhi\n\n" + rows +
                             "\nAtoms\n\n1 0 1 0 0 0\n2 0 2 0.8 0 0\n\nBonds\n\n1 2 1 2\n");
    return script::read_script(scratch.file("in.lmp", "boundary f f f\natom_style angle\n" + styles + "read_data two.data " + how + "\nmass * 1\nfix 1 all nve\nrun 0\n"), {});
  };
  const std::string styles = "pair_style lj/cut 1.5\nspecial_bonds lj 1 1 1\nbond_style hybrid harmonic zero\nangle_style cosine/shift\n",
                    rows = "Bond Coeffs # hybrid\n\n1 harmonic 5 0.1\n2 zero\n\nAngle Coeffs\n\n1 2 150\n";
  const ImportedProblem p = imported(coefficients(styles, rows + "\nPairIJ Coeffs # lj/cut\n\n1 1 3 0.1\n1 2 1 0.7\n2 2 3 0.1\n"));
  CHECK(std::abs(Energy(p.model).forces(p.model.start)(0, 0) / 1.3788252780796117 - 1) < 1e-14);      // of LAMMPS (29 Sep 2021)
  const script::World w = coefficients(styles, rows + "\nPair Coeffs\n\n1 3 0.1\n2 2 0.7 0.9\n").passes.at(0).world;
  CHECK(w.bond_coefficients.at(0).stiffness == 5);
  CHECK((w.bond_coefficients.at(1).set && w.bond_coefficients.at(1).stiffness == 0));
  CHECK((w.angle_coefficients.at(0).stiffness == 1 && w.angle_coefficients.at(0).rest == 150 * (pi / 180)));
  CHECK((w.pairs.coefficients.at(1).epsilon == 2 && w.pairs.coefficients.at(1).first[0] == 2 && w.pairs.coefficients.at(1).cutoff == 0.9));
  CHECK_THROWS_AS(coefficients("pair_style zero 1\nbond_style zero\n", rows, "nocoeff"), InputError);
  try {
    coefficients(styles, rows + "\nPair Coeffs\n\n1 foo 0.1\n");
    FAIL("is no number");
  } catch (const InputError& e) {
    CHECK(std::string(e.what()).find("two.data:24:1: Pair Coeffs: \"foo\" is not a number") != std::string::npos);
  }
}

TEST_CASE("what lies outside of the script's folder is not read", "[script]") {
  const ScratchDirectory scratch;
  std::filesystem::create_directories(scratch / "inner");
  scratch.file("secret.txt", "create_atoms 1 single 0 0 0\n");
  std::filesystem::create_symlink(scratch / "secret.txt", scratch / "inner/link.txt");
  for (const std::string& name : {std::string("../secret.txt"), scratch / "secret.txt", std::string("link.txt"), std::string("./a/../../secret.txt")}) {
    const std::string file = scratch.file("inner/in.lmp", small_script_head + "include " + name + "\n");
    CHECK_THROWS_WITH(script::read_script(file, {}), Catch::Matchers::Contains("lies outside of the script's folder"));
  }
  script::ReadingOptions anywhere;
  anywhere.include_anywhere = true;
  CHECK(script::read_script(scratch.file("inner/in.lmp", small_script_head + "include ../secret.txt\n"), anywhere).passes.at(0).world.atoms.size() == 1);
}

TEST_CASE("a command that includes a file and is wrong otherwise, and a file that is not there, are mistakes like others", "[script]") {
  const ScratchDirectory scratch;
  scratch.file("row.txt", "this is wrong, too\n");
  const auto told = [&](const std::string& text) {
    try {
      script::read_script(scratch.file("in.lmp", small_script_head + text), {});
    } catch (const InputError& e) {
      return e.mistakes();
    }
    return std::vector<Mistake>();
  };
  const std::vector<Mistake> both = told("if \"1\" then \"include row.txt\" \"foo\"\n");
  REQUIRE(both.size() == 2);
  CHECK((both[0].line == 13 && both[0].file == scratch / "in.lmp"));
  CHECK((both[1].line == 1 && both[1].file == scratch / "row.txt"));
  std::string wrong;
  for (int k = 0; k < 19; ++k) wrong += "foo\n";
  const std::vector<Mistake> many = told(wrong + "include nothing.txt\nfoo\nfoo\n");
  REQUIRE(many.size() == 21);
  CHECK((many[19].line == 32 && many[19].key == "include"));
  CHECK(many[20].what == "20 mistakes; there may be more");
}

TEST_CASE("every mistake of a script is told at its place, all at once", "[script]") {
  const std::string head = small_script_head;           // 12 lines
  const auto lines = [&](const std::string& text) { return script_mistakes(head + text); };
  CHECK(lines("create_atom 1 single 0 0 0\n") == "13:1: create_atom: \"create_atom\" is no command that is known here; did you mean \"create_atoms\"?; --skip leaves it out");
  CHECK(lines("create_atoms 4 single 0 0 0\nset type 1 diameter x\nmass 1 -1\ngroup g foo 1\nfix 1 nobody nve\n") ==
        "13:14: create_atoms: 4 is out of range; 1 to 3 is allowed\n14:21: set: \"x\" is not a number\n15:8: mass: must be above 0, is -1\n"
        "16:9: group: \"foo\" is no style of a group; there are: type, id, molecule, region, variable, union, subtract, intersect, include, empty, clear, delete\n"
        "17:7: fix: \"nobody\" is no group; there are: all");
  CHECK(lines("region r ellipsoid 0 0 0 1 1 1\nfix w all wall/gran/region granular hertz 1 0 tangential linear_nohistory 0 0 region r\n") ==
        "13:10: region: \"ellipsoid\" is no style of a region that is known here; block, prism, cylinder, cone, sphere, plane, union and intersect are");   // and what follows is not told
  CHECK(lines("variable a equal 1+\ncreate_atoms 1 single ${a} 0 0\n").starts_with("14:1: create_atoms: the formula \"1+\""));
  CHECK(lines("create_atoms 1 single 0 0 &\n  z\n") == "14:3: create_atoms: \"z\" is not a number");
  CHECK(lines("jump SELF nowhere\n").find("there is no label \"nowhere\"") != std::string::npos);
  CHECK(lines("variable i loop 2\nlabel a\njump SELF a\n").find("a loop may have no end") != std::string::npos);
  CHECK(lines("read_restart x\n").find("write_data FILE") != std::string::npos);
  CHECK(lines("include nothing.txt\n").find("there is no such file") != std::string::npos);
  CHECK(lines("change_box all boundary p f f\ncreate_atoms 1 single 0 0 0\n"
              "run 10\n").find("15:1: run: the box is periodic along x: elamin has no periodic boxes. Write") == 0);
  CHECK(lines("create_atoms 1 single 0 0 0\nbond_style fene\nfix 1 all rigid single\nrun 10\n").find("14:12: bond_style: \"fene\" is no style") == 0);
  CHECK(lines("create_atoms 1 single 0 0 0\ncreate_atoms 1 single 0.5 0 0\nspecial_bonds lj 0.5 1 1\npair_style lj/cut 1\npair_coeff * * 1 1\n"
              "create_bonds single/bond 1 1 2\nfix 1 all nve\nrun 5\n")
            .find("20:1: special_bonds: the weights 0.5 1 1 cannot be said") == 0);
  script::ReadingOptions skip;
  skip.skip = true;
  const Reading r = reading_of(head + "create_atom 1\ncreate_atoms 1 single 0 0 0\nfix 1 all rigid single\n", skip);
  const std::string text = script::report(r, {});
  CHECK(text.find("not understood, left out:\n") != std::string::npos);
  CHECK(text.find("in.lmp:13: create_atom: ") != std::string::npos);
  CHECK(text.find("in.lmp:15: fix: ") != std::string::npos);
  CHECK(r.passes.at(0).world.atoms.size() == 1);
}
