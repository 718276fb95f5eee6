// Bodies in LAMMPS data files and molecule files: what is read, and the place and sentence of every mistake.
#include "catch.hpp"
#include "core/error.hpp"
#include "laws/rounded/reference_bodies.hpp"
#include "lammps/data.hpp"
#include "lammps/bodies.hpp"
#include "input/model_of.hpp"

#include <fmt/format.h>

using namespace elamin;

namespace {

/// A tetrahedron, a rod and a sphere.
const std::string body_file =
    "title\n"                                       // 1
    "\n"
    "3 atoms\n"                                     // 3
    "3 bodies\n"
    "2 atom types\n"                                // 5
    "-9 9 xlo xhi\n"
    "-9 9 ylo yhi\n"
    "-9 9 zlo zhi\n"
    "\n"
    "Atoms\n"                                       // 10
    "\n"
    "7 1 1 2.5 1 2 3\n"                             // 12
    "2 2 1 1 4 5 6\n"
    "9 1 1 1 -4 0 0.5\n"                            // 14
    "\n"
    "Velocities\n"                                  // 16
    "\n"
    "2 1 2 3 4 5 6\n"                               // 18
    "7 0 0 1 0 0 0.5\n"
    "9 0 0 0 0 0 0\n"                               // 20
    "\n"
    "Bodies\n"                                      // 22
    "\n"
    "7 3 47\n"                                      // 24
    "4 6 4\n"
    "2 3 4 0.1 0.2 0.3\n"                           // 26
    "0 0 0  1 0 0  0 1 0\n"
    "0 0 1\n"                                       // 28
    "0 1 0 2 0 3 1 2 1 3 2 3\n"
    "0 2 1 -1  0 1 3 -1  0 3 2 -1  1 2 3 -1\n"      // 30
    "0.5\n"
    "2 3 13\n"                                      // 32
    "2 1 0\n"
    "0 1 1 0 0 0  -1 0 0 1 0 0  0.25\n"             // 34
    "9 3 10\n"
    "1 0 0\n"                                       // 36
    "1 1 1 0 0 0\n"
    "0 0 0\n"                                       // 38
    "2\n";

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

LammpsData data_of(const std::string& text) {
  const ScratchDirectory scratch;
  return read_lammps_data(scratch.file("x.data", text));
}

std::string said(const std::string& text) { return sentences_of([&] { data_of(text); }); }

const std::string rod_numbers = "2 3 13\n2 1 0\n0 1 1 0 0 0  -1 0 0 1 0 0  0.25\n";

}  // namespace

TEST_CASE("bodies of a LAMMPS data file, sorted by id, along the axes of the file", "[lammps_data][bodies]") {
  for (const std::string& text : {body_file, replaced(body_file, "Atoms\n", "Atoms # body\n")}) {
    const LammpsData data = data_of(text);
    CHECK(data.id.empty());
    CHECK(data.position.cols() == 0);
    REQUIRE(data.bodies.size() == 3);
    CHECK(data.bodies[0].id == 2);
    CHECK(data.bodies[1].id == 7);
    CHECK(data.bodies[2].id == 9);
    CHECK(data.bodies[0].type == 2);
    CHECK(data.bodies[1].mass == 2.5);
    Mat3 inertia;
    inertia << 2, 0.1, 0.2, 0.1, 3, 0.3, 0.2, 0.3, 4;
    CHECK(data.bodies[1].inertia == inertia);
    CHECK(data.body_position.col(1) == Vec3(1, 2, 3));
    CHECK(data.body_velocity.col(0) == Vec3(1, 2, 3));
    CHECK(data.angular_momentum.col(0) == Vec3(4, 5, 6));
    CHECK(data.angular_momentum.col(1) == Vec3(0, 0, 0.5));
    REQUIRE(data.shapes.size() == 3);
    const RoundedShape& tetrahedron = data.shapes[data.bodies[1].shape];
    CHECK(tetrahedron.vertices.size() == 4);
    CHECK(tetrahedron.edges.size() == 6);
    CHECK(tetrahedron.faces.size() == 4);
    CHECK(tetrahedron.radius == 0.25);
    CHECK(data.shapes[data.bodies[0].shape].vertices[0] == Vec3(-1, 0, 0));
    CHECK(data.shapes[data.bodies[2].shape].radius == 1);
  }
}

TEST_CASE("all reference cases are read as LAMMPS means them", "[lammps_data][bodies]") {
  for (const ReferenceCase& c : static_cases()) {
    INFO(c.name);
    const LammpsData data = read_lammps_data(std::string(ELAMIN_ROOT) + "/data/polyhedra/" + c.name + "/data.bodies");
    REQUIRE(data.bodies.size() == c.bodies.size());
    for (std::size_t b = 0; b < c.bodies.size(); ++b) {
      CHECK(data.bodies[b].inertia == c.bodies[b].inertia);
      CHECK(data.bodies[b].mass == c.bodies[b].mass);
      CHECK(Vec3(data.body_position.col(static_cast<Eigen::Index>(b))) == c.bodies[b].x);
      CHECK(data.shapes[data.bodies[b].shape].vertices == c.bodies[b].core.vertices);
    }
  }
}

TEST_CASE("equal bodies share a shape, image flags move them, hybrids have the columns of body last", "[lammps_data][bodies]") {
  std::string text = replaced(body_file, "9 3 10\n1 0 0\n1 1 1 0 0 0\n0 0 0\n2\n", "9" + rod_numbers.substr(1));
  CHECK(data_of(text).shapes.size() == 2);
  text = body_file;
  for (const char* row : {"7 1 1 2.5 1 2 3", "2 2 1 1 4 5 6", "9 1 1 1 -4 0 0.5"}) text = replaced(text, row, row + std::string(" 0 1 -1"));
  CHECK(data_of(text).body_position.col(1) == Vec3(1, 20, -15));
  text = replaced(body_file, "Atoms\n", "Atoms # hybrid body\n");
  text = replaced(text, "7 1 1 2.5 1 2 3", "7 1 1 2 3 1 2.5"), text = replaced(text, "2 2 1 1 4 5 6", "2 2 4 5 6 1 1");
  text = replaced(text, "9 1 1 1 -4 0 0.5", "9 1 -4 0 0.5 1 1");
  CHECK(data_of(text).bodies[1].mass == 2.5);
  CHECK(data_of(text).body_position == data_of(body_file).body_position);
}

TEST_CASE("rods and spheres may announce or list edges and faces", "[lammps_data][bodies]") {
  for (const char* other : {"2 3 13\n2 1 1\n0 1 1 0 0 0 -1 0 0 1 0 0 0.25\n", "2 3 15\n2 1 0\n0 1 1 0 0 0 -1 0 0 1 0 0 0 1 0.25\n",
                            "2 3 19\n2 1 1\n0 1 1 0 0 0 -1 0 0 1 0 0 0 1 0 1 -1 -1 0.25\n", "2 3 15\n2 1 1\n0 1 1 0 0 0 -1 0 0 1 0 0 1 0 0.25\n",
                            "2\t3 13\n2\n0 0 0\n1 1 0 0 0 -1 0 0 1 0\n0\n0.25\n"}) {
    INFO(other);
    const LammpsData data = data_of(replaced(body_file, rod_numbers, other));
    const RoundedShape& rod = data.shapes[data.bodies[0].shape];
    CHECK(rod.vertices == std::vector<Vec3>{{-1, 0, 0}, {1, 0, 0}});
    CHECK(rod.radius == 0.125);
  }
  CHECK(data_of(replaced(body_file, "9 3 10\n1 0 0\n", "9 3 10\n1 1 1\n")).bodies.size() == 3);
}

TEST_CASE("coplanar triangles are faces", "[lammps_data][bodies]") {
  std::string text = body_file.substr(0, body_file.find("7 3 47")) + rod_numbers +
                     "9 3 10\n1 0 0\n1 1 1 0 0 0\n0 0 0\n2\n7 3 115\n8 18 12\n1 1 1 0 0 0\n";
  for (const Vec3& v : box_core({1, 2, 3}).vertices) text += fmt::format("{} {} {}\n", v[0], v[1], v[2]);
  std::string edges, faces;
  for (const auto& f : box_core({1, 1, 1}).faces) {
    faces += fmt::format("{} {} {} -1 {} {} {} -1\n", f[0], f[1], f[2], f[0], f[2], f[3]);
    edges += fmt::format("{} {} ", f[0], f[2]);
    for (int k = 0; k < 4; ++k)
      if (f[k] < f[(k + 1) % 4]) edges += fmt::format("{} {} ", f[k], f[(k + 1) % 4]);
  }
  const LammpsData data = data_of(text + edges + "\n" + faces + "0.1\n");
  const RoundedShape& box = data.shapes[data.bodies[1].shape];
  CHECK(box.faces.size() == 12);
  CHECK(std::count_if(box.edges.begin(), box.edges.end(), [](const auto& e) { return e.flat; }) == 6);
}

TEST_CASE("one mistake in a body gives its place and its sentence", "[lammps_data][bodies]") {
  struct Wrong { const char *what, *by, *sentence; };
  const Wrong wrong[]{
      {"7 1 1 2.5", "7 1 0 2.5", "12:5: Atoms: bodyflag: 0 makes it a point without size, which is not available"},
      {"7 1 1 2.5", "7 1 2 2.5", "12:5: Atoms: bodyflag: \"2\" is out of range; 0 to 1 is allowed"},
      {"7 1 1 2.5", "7 1 1 0", "12:7: Atoms: mass: is 0; it must be positive"},
      {"7 1 1 2.5", "7 1 1 nan", "12:7: Atoms: mass: \"nan\" is not finite"},
      {"7 1 1 2.5", "2 1 1 2.5", "13:1: Atoms: id: 2 stands twice; the first is on line 12"},
      {"Atoms\n", "Atoms # hybrid sphere body\n", "10:1: Atoms: \"hybrid sphere body\" is not available: one column would be a density"},
      {"2 1 2 3 4 5 6\n", "2 1 2 3\n", "18:1: Velocities: id: 2 is a body; expected are 7 columns"},
      {"3 bodies\n", "4 bodies\n", "22:1: Bodies: 3 bodies, but the header announces 4 bodies"},
      {"7 3 47\n", "7 3 46\n", "24:1: Bodies: body 7: 46 numbers are announced, but 4 vertices, 6 edges and 4 faces take 47"},
      {"7 3 47\n", "7 3 48\n", "32:3: Bodies: more than the 48 numbers that line 24 announces; a body begins on a line of its own"},
      {"7 3 47\n", "7 2 47\n", "24:3: Bodies: integers of a body rounded/polyhedron: \"2\" is out of range; 3 is allowed"},
      {"7 3 47\n", "7 1 47\n", "24:3: Bodies: a body with one integer is of style nparticle or rounded/polygon, which are not available"},
      {"7 3 47\n", "7 3 4700\n", "24:1: Bodies: the body ends after 3 integers and"},
      {"7 3 47\n", "7 47\n", "24:1: Bodies: 2 columns, expected 3: id, how many integers (3)"},
      {"7 3 47\n", "8 3 47\n", "24:1: Bodies: id: there is no atom 8\n"},
      {"7 3 47\n", "2 3 47\n", "32:1: Bodies: id: 2 stands twice; the first is on line 24"},
      {"4 6 4\n", "4 5 4\n", "24:1: Bodies: body 7: 47 numbers are announced, but 4 vertices, 5 edges and 4 faces take 45"},
      {"4 6 4\n", "4 6 4.5\n", "25:5: Bodies: faces: \"4.5\" is not an integer"},
      {"2 1 0\n", "2 2 2\n", nullptr},
      {"2 1 0\n", "3 1 0\n", "32:1: Bodies: body 2: 13 numbers are announced, but 3 vertices, 1 edges and 0 faces take 18"},
      {"2 3 4 0.1", "2 3 7 0.1", "24:1: Bodies: body 7: the inertia has the principal moments"},
      {"2 3 4 0.1", "-2 3 4 0.1", "24:1: Bodies: body 7: the inertia has the principal moment -2."},
      {"2 3 4 0.1", "inf 3 4 0.1", "26:1: Bodies: number: \"inf\" is not finite"},
      {"0 0 1\n", "nan nan nan\n", "28:1: Bodies: number: \"nan\" is not finite"},
      {"0 0 1\n", "0 0 0\n", "24:1: Bodies: body 7: vertices 0 and 3 are at the same place"},
      {"0 1 0 2", "0 4 0 2", "24:1: Bodies: body 7: edge 0 names vertex 4; allowed: 0 to 3"},
      {"0 1 0 2", "0 0.5 0 2", "24:1: Bodies: body 7: edge 0 names vertex 0.5; allowed: 0 to 3"},
      {"0 1 0 2", "0 1 0 1", "24:1: Bodies: body 7: the edge 0 to 1 is given 2 times"},
      {"0 2 1 -1", "0 2 7 -1", "24:1: Bodies: body 7: face 0 names vertex 7; allowed: 0 to 3"},
      {"0 2 1 -1", "0 1 2 -1", nullptr},                          // either sense, as LAMMPS
      {"0 2 1 -1", "0 -1 1 -1", "24:1: Bodies: body 7: face 0 names vertex -1; allowed: 0 to 3"},
      {"0 2 1 -1", "0 2 1 3", "24:1: Bodies: body 7: face 0 is not planar"},
      {"1 2 3 -1\n0.5\n", "1 2 3 -1\n-0.5\n", "24:1: Bodies: body 7: the rounding diameter is -0.5; it must be positive"},
      {"1 2 3 -1\n0.5\n", "1 2 3 -1\nnan\n", "31:1: Bodies: number: \"nan\" is not finite"},
      {"0 0 0\n2\n", "0 0 0\n2 2\n", "39:3: Bodies: more than the 10 numbers that line 35 announces"},
      {"0 0 0\n2\n", "0 0 0\n", "35:1: Bodies: the body ends after 3 integers and 9 numbers; announced are 3 and 10"},
      {"3 atoms\n", "3 atoms\n1 ellipsoids\n", "4:1: ellipsoids: ellipsoids are not available"},
  };
  CHECK(said(body_file).empty());
  for (const Wrong& w : wrong) {
    INFO(w.what << " -> " << w.by);
    const std::string all = said(replaced(body_file, w.what, w.by));
    INFO(all);
    if (w.sentence) CHECK((all + "\n").find(w.sentence) != std::string::npos);
    else CHECK(all.empty());
  }
  CHECK(said(body_file.substr(0, body_file.find("Bodies"))).find("Bodies: the file ends without this section") != std::string::npos);
  CHECK(said(replaced(body_file, rod_numbers, "") + "\n").find("13:1: Atoms: id: body 2 is missing in the section Bodies") == std::string::npos);
  CHECK(said(replaced(replaced(body_file, rod_numbers, ""), "3 bodies", "2 bodies")).find("13:1: Atoms: id: body 2 is missing") != std::string::npos);
}

TEST_CASE("faces of bodies are taken in either sense", "[lammps_data][bodies]") {
  const LammpsData as_meant = data_of(body_file), turned = data_of(replaced(body_file, "0 2 1 -1", "0 1 2 -1"));
  REQUIRE(turned.shapes.size() == as_meant.shapes.size());
  for (std::size_t k = 0; k < turned.shapes.size(); ++k) CHECK(turned.shapes[k].faces.size() == as_meant.shapes[k].faces.size());
  for (std::size_t f = 0; f < as_meant.shapes[0].faces.size(); ++f)
    CHECK((turned.shapes[0].faces[f].normal - as_meant.shapes[0].faces[f].normal).norm() < 1e-15);
}

TEST_CASE("mistakes of all bodies are told at once", "[lammps_data][bodies]") {
  std::string text = replaced(body_file, "0 2 1 -1", "0 2 2 -1");
  text = replaced(text, "0 0 0\n2\n", "0 0 0\n0\n"), text = replaced(text, "0 1 1 0 0 0  -1", "0 1 3 0 0 0  -1");
  text = replaced(text, "9 1 1 1", "9 1 1 -1");
  const std::string all = said(text);
  for (const char* one : {"face 0 names vertex 2 twice", "the rounding diameter is 0", "body 2: the inertia", "14:7: Atoms: mass"}) {
    INFO(one);
    CHECK(all.find(one) != std::string::npos);
  }
}

TEST_CASE("a file of bodies that ends anywhere or holds any other word is read or refused", "[lammps_data][bodies][fuzz]") {
  int read = 0, refused = 0;
  const auto attempt = [&](const std::string& text) {
    try {
      const LammpsData data = data_of(text);
      for (const Body& b : data.bodies) REQUIRE((b.shape >= 0 && b.shape < static_cast<int>(data.shapes.size()) && b.mass > 0));
      REQUIRE(data.body_position.allFinite());
      ++read;
    } catch (const InputError& e) {
      REQUIRE_FALSE(e.mistakes().empty());
      ++refused;
    }
  };
  for (std::size_t n = 0; n <= body_file.size(); ++n) attempt(body_file.substr(0, n));
  for (std::size_t begin = body_file.find_first_not_of(" \n"); begin != std::string::npos;) {
    const std::size_t end = std::min(body_file.find_first_of(" \n", begin), body_file.size());
    for (const char* word : {"", "0", "-1", "nan", "2147483647", "1e300", "Bodies", "x", "\n", "#", "1.5", "Atoms"})
      attempt(body_file.substr(0, begin) + word + body_file.substr(end));
    begin = body_file.find_first_not_of(" \n", end);
  }
  CHECK(read > 50);
  CHECK(refused > 1000);
}

TEST_CASE("a molecule file of one body", "[lammps_data][bodies]") {
  const std::string text =
      "a rod\n\n1 atoms\n3 13 body\n2.5 mass\n0 0 0 com\n\nCoords\n\n1 0 0 0\n\nTypes\n\n1 1\n\nBody Integers\n\n2 1 0\n\nBody Doubles\n\n"
      "0 1 1 0 0 0\n-1 0 0 1 0 0\n0.25\n";
  const ScratchDirectory scratch;
  const auto read = [&](const std::string& t) { return read_molecule(scratch.file("m", t)); };
  const LammpsMolecule rod = read(text);
  CHECK(rod.mass == 2.5);
  CHECK(rod.form.core.vertices == std::vector<Vec3>{{-1, 0, 0}, {1, 0, 0}});
  CHECK(rod.form.diameter == 0.25);
  CHECK(rod.form.inertia == Mat3(Vec3(0, 1, 1).asDiagonal()));
  CHECK(read(replaced(text, "2.5 mass\n", "")).mass == 0);
  CHECK(read(replaced(text, "2.5 mass\n", "") + "\nMasses\n\n1 4\n").mass == 4);
  struct Wrong { const char *what, *by, *sentence; };
  const Wrong wrong[]{
      {"1 atoms", "2 atoms", "3:1: atoms: \"2\" is out of range; 1 is allowed"},
      {"1 atoms\n", "", "header: does not say how many atoms there are"},
      {"3 13 body\n", "", "header: does not say how many integers and numbers the body has"},
      {"3 13 body", "2 13 body", "4:1: body: integers of a body rounded/polyhedron: \"2\" is out of range"},
      {"3 13 body", "3 14 body", "Body Doubles: 13 numbers, but the header announces 14"},
      {"2.5 mass", "-2.5 mass", "5:1: mass: is -2.5; it must be positive"},
      {"2.5 mass", "2.5 mass\n1 bonds", "6:1: header: \"1 bonds\" is not available"},
      {"2.5 mass", "2.5 mass\n0 1 2 0 0 0 inertia", "6:1: inertia: differs from that of Body Doubles"},
      {"Body Integers\n\n2 1 0\n", "", "Body Integers: the file ends without this section"},
      {"2 1 0\n", "2 1\n", "Body Integers: 2 integers, expected 3"},
      {"0 1 1 0 0 0", "0 1 3 0 0 0", "Body Doubles: the inertia has the principal moments 0, 1 and 3"},
      {"0.25\n", "x\n", "\"x\": this section is not available"},
      {"Types\n\n1 1", "Types\n\n1", "Types: 1 columns, expected 2"},
      {"Types", "Shake Flags", "\"Shake Flags\": this section is not available"},
  };
  for (const Wrong& w : wrong) {
    INFO(w.what << " -> " << w.by);
    const std::string all = sentences_of([&] { read(replaced(text, w.what, w.by)); });
    INFO(all);
    CHECK(all.find(w.sentence) != std::string::npos);
  }
  CHECK(sentences_of([&] { read_molecule(scratch / "none"); }) != "");
}
