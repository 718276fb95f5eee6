// Data files as LAMMPS itself writes them: order of hybrid columns, rounded coefficients, sections without a use here, type labels,
// and what is taken for a data file.
#include "catch.hpp"
#include "core/error.hpp"
#include "input/build.hpp"
#include "input/lammps.hpp"
#include "input/read.hpp"
#include "lammps/data.hpp"
#include "lammps/small_data_file.hpp"
#include "laws/section.hpp"
#include "scratch_directory.hpp"

using namespace elamin;

namespace {

std::string exchanged(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

std::string refusal(const std::string& file, const LammpsReading& how = {}) {
  try {
    read_lammps_data(file, how);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

Model model_of_problem(ScratchDirectory& scratch, const std::string& toml) {
  return build_model(read_problem(scratch.file("p.toml", "study.type = \"energy\"\n" + toml)));
}

}  // namespace

TEST_CASE("hybrid alone is the order of columns that all rows fit", "[lammps_data]") {
  ScratchDirectory scratch;
  const auto rows = [&](const std::string& first, const std::string& second) {
    std::string text = exchanged(small_data_file, "# hybrid sphere angle", "# hybrid");
    text = exchanged(text, "1 1 0 0 1 1 800 1", "1 1 0 0 1 " + first);
    text = exchanged(text, "2 1 0 0 2 1 800 1", "2 1 0 0 2 " + second);
    return scratch.file("x.data", exchanged(text, "4 1 0 0 3 1 800 1", "4 1 0 0 3 " + second));
  };
  const LammpsData last = read_lammps_data(rows("1 800 1", "1.5 800 1"));
  CHECK(last.diameter == std::vector<double>{1, 1.5, 1.5});
  CHECK(last.molecule == std::vector<int>{1, 1, 1});
  const LammpsData first = read_lammps_data(rows("2 1 800", "2 1 800.5"));
  CHECK(first.diameter == std::vector<double>{1, 1, 1});
  CHECK(first.density == std::vector<double>{800, 800.5, 800.5});
  CHECK(first.molecule == std::vector<int>{2, 2, 2});
  const std::string both = rows("1 800 1", "1 800 1");
  CHECK(refusal(both).find("fits two orders of columns") != std::string::npos);
  CHECK(read_lammps_data(both, "hybrid angle sphere").diameter == std::vector<double>{800, 800, 800});
  CHECK(refusal(rows("1.5 800 1.5", "1 800 1")).find("Atoms: molecule: \"1.5\" is not an integer") != std::string::npos);
}

TEST_CASE("sections that have no use here are passed over where that is asked for", "[lammps_data]") {
  ScratchDirectory scratch;
  const std::string more = "1 angle types\n1 dihedrals\n1 dihedral types\n1 impropers\n1 improper types\n";
  const std::string sections = "\nDihedral Coeffs # harmonic\n\n1 1 1 1\n\nDihedrals\n\n1 1 1 2 4 1\n\nImpropers\n\n1 1 1 2 4 1\n\nPair "
                               "Coeffs # lj/cut\n\n1 1 1\n";
  const std::string file = scratch.file("x.data", exchanged(small_data_file, "1 angle types\n", more) + sections);
  const std::string what = refusal(file);
  CHECK(what.find("\"Dihedral Coeffs\", \"Dihedrals\", \"Impropers\": these sections are not available") != std::string::npos);
  CHECK(what.find("ignore = [\"Dihedrals\", \"Impropers\"] in [lammps]") != std::string::npos);
  CHECK(std::count(what.begin(), what.end(), '\n') == 0);
  CHECK(refusal(file, {"", {"Dihedrals"}, {}, {}}).find("\"Impropers\": this section is not available") != std::string::npos);
  const LammpsData data = read_lammps_data(file, {"", {"Dihedrals", "Impropers"}, {}, {}});
  CHECK(data.angles.size() == 1);
  REQUIRE(data.notes.size() == 1);
  CHECK(data.notes[0].find("\"Pair Coeffs\" is passed over; contacts are given by [[contact]]") != std::string::npos);

  const LammpsData bonds = read_lammps_data(scratch.file("b.data", small_data_file), {"", {"Angles"}, {}, {}});
  CHECK((bonds.angles.empty() && bonds.angle_types.empty() && bonds.bonds.size() == 2));
  const std::string charged = exchanged(small_data_file, "# hybrid sphere angle", "# full");
  std::string rows = exchanged(charged, "1 1 0 0 1 1 800 1\n2 1 0 0 2 1 800 1\n4 1 0 0 3 1 800 1\n",
                               "1 1 1 0.5 0 0 1\n2 1 1 0 0 0 2\n4 1 1 0 0 0 3\n");
  const LammpsData full = read_lammps_data(scratch.file("c.data", rows));
  REQUIRE(full.notes.size() == 1);
  CHECK(full.notes[0].find("charges are dropped") != std::string::npos);
}

TEST_CASE("coefficients of the problem file stand for those that a data file has not, or has rounded", "[lammps_data]") {
  ScratchDirectory scratch;
  const LammpsReading own{"", {}, {{250.5, 0.75}}, {{5}}};
  const std::string without = exchanged(exchanged(small_data_file, "Bond Coeffs # harmonic\n\n1 100 1\n", ""),
                                        "Angle Coeffs # cosine\n\n1 5\n", "");
  for (const std::string& text : {small_data_file, without, exchanged(small_data_file, "# harmonic", "# fene")}) {
    const LammpsData data = read_lammps_data(scratch.file("x.data", text), own);
    REQUIRE(data.bond_types.size() == 1);
    CHECK((data.bond_types[0].stiffness == 250.5 && data.bond_types[0].rest_length == 0.75));
    CHECK((data.angle_types[0].stiffness == 5 && data.angle_types[0].rest == pi));
  }
  CHECK(read_lammps_data(scratch.file("x.data", without), {"", {}, {{1, 1}}, {{5, 120}}}).angle_types[0].rest == 120 * pi / 180);

  const std::string title = "LAMMPS data file via write_data, version 29 Sep 2021, timestep = 0\n";
  const auto doubt = [&](const std::string& coefficients, const LammpsReading& how = {}) {
    return read_lammps_data(scratch.file("x.data", exchanged(exchanged(small_data_file, "title\n", title), "1 100 1\n", coefficients)),
                            how).doubt;
  };
  CHECK(doubt("1 100.123 0.00123457\n").find("its coefficients have six digits") != std::string::npos);
  CHECK(doubt("1 100.1234 0.00123457\n").empty());
  CHECK(doubt("1 100.123 0.00123457\n", own).empty());
  CHECK(read_lammps_data(scratch.file("x.data", small_data_file)).doubt.empty());
}

TEST_CASE("labels of types are read, and those of atom types name groups", "[lammps_data]") {
  ScratchDirectory scratch;
  std::string text = exchanged(small_data_file, "1 atom types\n1 bond types\n1 angle types\n",
                               "2 atom types\n1 bond types\n1 angle types\n");
  text = exchanged(text, "Bond Coeffs # harmonic\n\n1 100 1\n", "Atom Type Labels\n\n1 steel\n2 rubber\n\nBond Type Labels\n\n1 "
                                                                "s-r\n\nAngle Type Labels\n\n1 s-r-s\n\n"
                                                               "Bond Coeffs # harmonic\n\ns-r 100 1\n");
  text = exchanged(text, "2 1 0 0 2 1 800 1", "2 rubber 0 0 2 1 800 1");
  text = exchanged(text, "2 1 2 4\n", "2 s-r 2 4\n");
  text = exchanged(text, "1 1 1 2 4\n", "1 s-r-s 1 2 4\n");
  const std::string file = scratch.file("x.data", text);
  const LammpsData data = read_lammps_data(file);
  CHECK(data.type == std::vector<int>{1, 2, 1});
  CHECK(data.bond_types[data.bonds[1].type].stiffness == 100);
  CHECK(atom_type_labels(file) == std::vector<std::pair<std::string, int>>{{"steel", 1}, {"rubber", 2}});
  const std::string toml = "lammps.data = \"x.data\"\n";
  const Model model = model_of_problem(scratch, toml + "[[support]]\ngroup = \"steel\"\n[[gravity]]\ngroup = \"rubber\"\nacceleration = "
                                                       "[0, 0, 1]\n");
  CHECK(model.supports[0].particles == std::vector<int>{0, 2});
  CHECK(model.gravity[0].particles == std::vector<int>{1});
  CHECK_THROWS_AS(model_of_problem(scratch, toml + "[[support]]\ngroup = \"copper\"\n"), InputError);
  CHECK_THROWS_AS(model_of_problem(scratch, toml + "[[group]]\nname = \"steel\"\nof = \"type2\"\n"), InputError);
}

TEST_CASE("dumps, restarts and packed files are told from data files", "[lammps_data]") {
  ScratchDirectory scratch;
  CHECK(refusal(scratch.file("a.dump", "ITEM: TIMESTEP\n0\n")).find("is a LAMMPS dump file") != std::string::npos);
  CHECK(refusal(scratch.file("a.restart", std::string("LammpS RestartT\0\1\2", 18))).find("lmp -restart2data") != std::string::npos);
  CHECK(refusal(scratch.file("a.gz", std::string("\x1f\x8b\x08\0", 4))).find("is compressed; unpack it with gunzip") != std::string::npos);
  const std::string other = refusal(scratch.file("weights", "title\n1.5 a 1 0\n2.5 a 1 0\n3.5 a 1 0\n"));
  CHECK(other.find("header: \"1.5 a 1 0\" is not known") != std::string::npos);
  CHECK(std::count(other.begin(), other.end(), '\n') == 0);
}

TEST_CASE("remarks about a data file are those of the problem that names it", "[lammps_data]") {
  ScratchDirectory scratch;
  scratch.file("x.data", exchanged(small_data_file, "title\n", "LAMMPS data file via write_data, version 29 Sep 2021, timestep = "
                                                               "0\n") + "\nPair Coeffs\n\n1 1 1\n");
  const Problem problem = read_problem(scratch.file("p.toml", "study.type = \"energy\"\nlammps.data = \"x.data\"\n"));
  CHECK(lammps_remarks(problem).notes.size() == 1);
  CHECK(lammps_remarks(problem).warnings.size() == 1);
}
