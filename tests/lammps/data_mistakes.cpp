// Wrong LAMMPS data files: the place and the sentence of every mistake, and no crash whatever the file.
#include "catch.hpp"
#include "core/error.hpp"
#include "lammps/data.hpp"
#include "lammps/small_data_file.hpp"
#include "scratch_directory.hpp"

using namespace elamin;

namespace {

std::string replaced(const std::string& what, const std::string& by) {
  std::string text = small_data_file;
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

/// All sentences without the name of the file.
std::vector<std::string> sentences(const std::string& text, const std::string& style = "") {
  ScratchDirectory scratch;
  const std::string file = scratch.file("x.data", text);
  try {
    read_lammps_data(file, style);
  } catch (const InputError& e) {
    std::vector<std::string> all;
    for (const Mistake& m : e.mistakes()) {
      CHECK(m.file == file);
      all.push_back(m.sentence().substr(file.size() + 1));
    }
    return all;
  }
  return {};
}

}  // namespace

TEST_CASE("the file that the wrong ones are made of is right", "[lammps_data]") {
  CHECK(sentences(small_data_file).empty());
}

TEST_CASE("one mistake in a LAMMPS data file gives its place and its sentence", "[lammps_data]") {
  struct Wrong { const char *what, *by, *sentence; std::size_t mistakes = 1; };
  const Wrong wrong[]{
      {"3 atoms", "4 atoms", "22:1: Atoms: 3 lines, but the header announces 4 atoms", 2},
      {"3 atoms", "99999999999999 atoms", "3:1: atoms: \"99999999999999\" is out of range; 0 to 2147483647 is allowed"},
      {"3 atoms", "-3 atoms", "3:1: atoms: \"-3\" is out of range"},
      {"3 atoms", "3.5 atoms", "3:1: atoms: \"3.5\" is not an integer"},
      {"3 atoms", "3 atoms\n3 atoms", "4:1: atoms: stands twice in the header"},
      {"1 atom types\n", "", "header: does not say how many atom types there are"},
      {"1 bond types\n", "", "13:1: Bond Coeffs: 1 lines, but the header announces 0 bond types"},
      {"2 bonds", "2000000000 bonds", "34:1: Bonds: 2 lines, but the header announces 2000000000 bonds"},
      {"1 bond types", "2000000000 bond types",
       "14:1: Bond Coeffs: 1 lines, but the header announces 2000000000 bond types"},
      {"1 angle types\n", "1 angle types\n2 dihedrals\n",
       "9:1: dihedrals: dihedrals are not available; 0 is allowed, or ignore = [\"Dihedrals\"] in [lammps]"},
      {"1 angle types\n", "1 angle types\n1 bodies\n", "Bodies: the file ends without this section; its header announces 1 bodies"},
      {"1 angle types\n", "1 angle types\n1 wheels\n", "9:1: header: \"1 wheels\" is not known"},
      {"0 10 xlo", "10 10 xlo", "10:1: xlo xhi: the lower bound is not below the upper one"},
      {"0 10 xlo", "nan 10 xlo", "10:1: xlo xhi: \"nan\" is not finite"},
      {"# harmonic", "# fene", "14:1: Bond Coeffs: bond style \"fene\" is not available; harmonic is"},
      {"# cosine", "# harmonic",
       "18:1: Angle Coeffs: angle style \"harmonic\" is not available; cosine and cosine/shift are"},
      {"1 100 1\n", "1 100\n", "16:1: Bond Coeffs: 2 columns, expected 3: type, K and r0"},
      {"1 100 1\n", "1 morse 100 1 1\n", "16:3: Bond Coeffs: style \"morse\" is not available; harmonic is"},
      {"1 100 1\n", "1 -100 1\n", "16:3: Bond Coeffs: K: -100 is negative"},
      {"1 100 1\n", "1 1e999 1\n", "16:3: Bond Coeffs: K: \"1e999\" is too large or too small"},
      {"1 100 1\n", "1 100 inf\n", "16:7: Bond Coeffs: r0: \"inf\" is not finite"},
      {"1 100 1\n", "2 100 1\n", "16:1: Bond Coeffs: type: \"2\" is out of range; 1 is allowed"},
      {"Bond Coeffs # harmonic\n\n1 100 1\n", "",
       "33:1: Bonds: type: type 1 has no coefficients; the section Bond Coeffs gives them, or bond_coefficients in [lammps]"},
      {"Angle Coeffs # cosine\n\n1 5\n", "",
       "Angles: type: type 1 has no coefficients; the section Angle Coeffs gives them, or angle_coefficients in [lammps]"},
      {"# hybrid sphere angle", "# wheel",
       "22:1: Atoms: the atom style \"wheel\" is not available; available are atomic, charge, sphere, bond"},
      {"# hybrid sphere angle", "# hybrid sphere wheel",
       "22:1: Atoms: the atom style \"wheel\" in \"hybrid sphere wheel\" is not available"},
      {"# hybrid sphere angle", "# hybrid bond angle",
       "22:1: Atoms: two of the styles in \"hybrid bond angle\" have the same column"},
      {"# hybrid sphere angle", "", "22:1: Atoms: the atom style is not given"},
      {"# hybrid sphere angle", "# sphere", "24:1: Atoms: 8 columns, expected 7 or 10: atom style sphere"},
      {"1 1 0 0 1 1 800 1\n", "1 1 0 0 1 1 800 1 0\n", "24:1: Atoms: 9 columns, expected 8 or 11"},
      {"1 1 0 0 1 1 800 1\n", "1 1 0 zero 1 1 800 1\n", "24:7: Atoms: y: \"zero\" is not a number"},
      {"1 1 0 0 1 1 800 1\n", "1 1 0 0x1 1 1 800 1\n", "24:7: Atoms: y: \"0x1\" is not a number"},
      {"1 1 0 0 1 1 800 1\n", "1 1 0 -inf 1 1 800 1\n", "24:7: Atoms: y: \"-inf\" is not finite"},
      {"1 1 0 0 1 1 800 1\n", "1 1 0 0 1 -1 800 1\n", "24:11: Atoms: diameter: -1 is negative"},
      {"1 1 0 0 1 1 800 1\n", "1 1 0 0 1 1 800 1.5\n", "24:17: Atoms: molecule: \"1.5\" is not an integer"},
      {"1 1 0 0 1 1 800 1\n", "0 1 0 0 1 1 800 1\n",
       "24:1: Atoms: id: \"0\" is out of range; 1 to 2147483647 is allowed"},
      {"1 1 0 0 1 1 800 1\n", "1 2 0 0 1 1 800 1\n", "24:3: Atoms: type: \"2\" is out of range; 1 is allowed"},
      {"2 1 0 0 2 1 800 1\n", "4 1 0 0 2 1 800 1\n", "26:1: Atoms: id: 4 stands twice; the first is on line 25"},
      {"4 1 0 0 3 1 800 1\n", "", "22:1: Atoms: 2 lines, but the header announces 3 atoms"},
      {"4 0 0 1 0 0 0\n", "3 0 0 1 0 0 0\n", "32:1: Velocities: id: there is no atom 3"},
      {"4 0 0 1 0 0 0\n", "2 0 0 1 0 0 0\n", "32:1: Velocities: id: 2 stands twice; the first is on line 31"},
      {"4 0 0 1 0 0 0\n", "4 0 0 1 0\n", "32:1: Velocities: 5 columns, expected 4 or 7"},
      {"4 0 0 1 0 0 0\n", "4 0 0 1 0 0 x\n", "32:13: Velocities: angular velocity: \"x\" is not a number"},
      {"2 1 2 4\n", "2 1 2 3\n", "37:7: Bonds: id: there is no atom 3"},
      {"2 1 2 4\n", "2 1 2 2\n", "37:7: Bonds: id: atom 2 stands twice in it"},
      {"2 1 2 4\n", "2 2 2 4\n", "37:3: Bonds: type: \"2\" is out of range; 1 is allowed"},
      {"2 1 2 4\n", "2 1 2\n", "37:1: Bonds: 3 columns, expected 4"},
      {"1 1 1 2 4\n", "1 1 1 2 1\n", "41:9: Angles: id: atom 1 stands twice in it"},
      {"Angles\n\n1 1 1 2 4\n", "", "Angles: the file ends without this section; its header announces 1 angles"},
      {"# hybrid sphere angle", "# hybrid",
       "22:1: Atoms: \"hybrid\" alone fits two orders of columns here: 1 800 1 is diameter, density and molecule of \"hybrid sphere angle\", or "
       "molecule, diameter and density of \"hybrid angle sphere\"; say which, as atom_style or behind \"Atoms #\""},
      {"Angles\n", "Dihedrals\n\n1 1 1\n\nImpropers\n\n1 2 3\n\nBondBond Coeffs\n\n1 2 3\n\nAngles\n",
       "39:1: \"Dihedrals\", \"Impropers\", \"BondBond Coeffs\": these sections are not available; available are Atoms"},
      {"1 angle types\n", "1 angle types\n2 dihedrals\n\nDihedral Coeffs\n\n1 1\n\nDihedrals\n\n1 1\n2 1\n\n",
       "\"Dihedral Coeffs\", \"Dihedrals\": these sections are not available; available are Atoms, Velocities, Masses, Bodies, Bonds, Angles, "
       "Bond Coeffs and Angle Coeffs; without them: ignore = [\"Dihedrals\"] in [lammps]"},
      {"Bond Coeffs #", "Atom Type Labels\n\n2 C\n\nBond Coeffs #", "16:1: Atom Type Labels: type: \"2\" is out of range; 1 is allowed"},
      {"Angles\n", "Dihedrals\n\n1 1 1\n\nAngles\n",
       "39:1: \"Dihedrals\": this section is not available; available are Atoms"},
      {"Angles\n", "Bodies\n\n1 3 10\n1 0 0\n1 1 1 0 0 0\n0 0 0 2\n\nAngles\n", "39:1: Bodies: 1 bodies, but the header announces 0 bodies"},
      {"Angles\n", "Bonds\n\n1 1 1 2\n\nAngles\n", "39:1: Bonds: stands twice; the first is on line 34"},
  };
  for (const Wrong& w : wrong) {
    const auto all = sentences(replaced(w.what, w.by));
    INFO(w.what << " -> " << w.by);
    for (const auto& sentence : all) UNSCOPED_INFO(sentence);
    CHECK(all.size() == w.mistakes);
    REQUIRE(!all.empty());
    CHECK(all[0].find(w.sentence) != std::string::npos);
  }
}

TEST_CASE("image flags of a tilted box and overflowing ones are refused", "[lammps_data]") {
  std::string text = replaced("0 10 zlo zhi\n", "0 10 zlo zhi\n1 0 0 xy xz yz\n");
  CHECK(sentences(text).empty());
  text.replace(text.find("1 1 0 0 1 1 800 1\n"), 18, "1 1 0 0 1 1 800 1 0 1 0\n");
  REQUIRE(sentences(text).size() == 1);
  CHECK(sentences(text)[0].find("25:1: Atoms: image flag: a tilted box") == 0);
  std::string far = replaced("0 10 zlo", "-1e308 1e308 zlo");
  far.replace(far.find("1 1 0 0 1 1 800 1\n"), 18, "1 1 0 0 1 1 800 1 0 0 1\n");
  REQUIRE(sentences(far).size() == 1);
  CHECK(sentences(far)[0].find("24:1: Atoms: image flag: the unwrapped position is not finite") == 0);
}

TEST_CASE("all mistakes of a LAMMPS data file come at once, in the order of the lines", "[lammps_data]") {
  std::string text = replaced("1 100 1\n", "1 hard 1\n");
  text.replace(text.find("2 1 0 0 2"), 9, "2 1 0 x y");
  text.replace(text.find("1 1 1 2 4\n"), 10, "1 1 1 2 2\n");      // the atoms are not all known: left alone
  const auto all = sentences(text);
  REQUIRE(all.size() == 3);
  CHECK(all[0].find("16:3: Bond Coeffs: style \"hard\"") == 0);
  CHECK(all[1].find("25:7: Atoms: y") == 0);
  CHECK(all[2].find("25:9: Atoms: z") == 0);

  std::string many = "title\n100 atoms\n1 atom types\n\nAtoms # atomic\n\n";
  for (int i = 1; i <= 100; ++i) many += std::to_string(i) + " 1 0 0 z\n";
  CHECK(sentences(many).size() == 21);
  CHECK(sentences(many).back().find("20 mistakes; there may be more") != std::string::npos);
}

TEST_CASE("what is no data file at all", "[lammps_data]") {
  ScratchDirectory scratch;
  const auto sentence = [](const std::string& file) -> std::string {
    try {
      read_lammps_data(file);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  CHECK(sentence(scratch / "none").find("no such file") != std::string::npos);
  CHECK(sentence(scratch / "").find("is not a file of text") != std::string::npos);
  CHECK(sentence("/dev/zero").find("is not a file of text") != std::string::npos);
  CHECK(sentence(scratch.file("binary", std::string("PK\x03\x04\0\0", 6))).find("is a binary file") !=
        std::string::npos);
  CHECK(sentence(scratch.file("empty", "")).find("header: does not say how many atoms there are") != std::string::npos);
  CHECK(sentence(scratch.file("title", "3 atoms")).find("does not say how many atoms") != std::string::npos);
  CHECK(sentence(scratch.file("zero", "title\n0 atoms\n1 atom types\n\nAtoms # atomic\n")).find("there are none") !=
        std::string::npos);
}
