// Rounded bodies as surfaces: closed, outward, on the body.
#include "results/surfaces.hpp"

#include "catch.hpp"
#include "laws/rounded/core_distance.hpp"
#include "scratch_directory.hpp"

#include <fstream>
#include <map>
#include <sstream>

using namespace elamin;

namespace {

// Points that coincide to rounding are one.
std::vector<int> merged(const Surface& s, double size) {
  std::vector<int> of;
  for (std::size_t k = 0; k < s.points.size(); ++k) {
    int same = static_cast<int>(k);
    for (std::size_t j = 0; j < k && same == static_cast<int>(k); ++j)
      if ((s.points[j] - s.points[k]).norm() <= 1e-9 * size) same = static_cast<int>(j);
    of.push_back(same);
  }
  return of;
}

}  // namespace

TEST_CASE("The surface of a body is closed, outward and on the body", "[results][bodies]") {
  const double size = GENERATE(1e-3, 1.0, 1e3);
  const CoreMesh core = GENERATE(point_core(), rod_core(1), tetrahedron_core(1), cube_core(1), box_core(Vec3(1, 2, 0.5)));
  CoreMesh scaled = core;
  for (Vec3& v : scaled.vertices) v *= size;
  const RoundedShape shape = rounded_shape(scaled, 0.3 * size);
  const Surface s = surface_of(shape, 6);
  const std::vector<int> point = merged(s, size);
  std::map<std::pair<int, int>, int> sides;
  double volume = 0;
  for (const std::vector<int>& p : s.polygons)
    for (std::size_t k = 0; k < p.size(); ++k) {
      const int a = point[p[k]], b = point[p[(k + 1) % p.size()]];
      if (a != b) ++sides[{a, b}];
      if (k > 0 && k + 1 < p.size()) volume += s.points[p[0]].dot(s.points[p[k]].cross(s.points[p[k + 1]])) / 6;
    }
  for (const auto& [side, count] : sides) {
    CHECK(count == 1);
    CHECK(sides.count({side.second, side.first}) == 1);
  }
  const double exact = mass_properties(shape).volume;
  CHECK(volume < exact);
  CHECK(volume > 0.97 * exact);
  for (const Vec3& x : s.points) {
    std::vector<double> heights(shape.faces.size());
    face_heights(shape, x, heights.data());
    CHECK(std::abs(core_distance(shape, x, heights.data()).value - shape.radius) <= 1e-12 * size);
  }
}

TEST_CASE("A picture of bodies is polydata of VTK", "[results][bodies]") {
  Model m;
  m.shapes = {rounded_shape(cube_core(1), 0.1), rounded_shape(rod_core(2), 0.2)};
  m.bodies = {{1, 7, 2, 1, Mat3::Identity()}, {0, 9, 3, 1, Mat3::Identity()}};
  m.start.bodies = {{{Vec3(1, 2, 3), Vec3::Zero()}, quaternion(Vec3(0, 0, 0.4))}, {{Vec3(-5, 0, 0), Vec3::Zero()}, quaternion(Vec3::Zero())}};
  const ScratchDirectory folder;
  const std::string file = folder / "bodies.vtk";
  write_picture(file, m, m.start, "two\nlines");
  std::ifstream in(file);
  std::string line, word;
  std::getline(in, line);
  CHECK(line == "# vtk DataFile Version 3.0");
  std::getline(in, line);
  CHECK(line == "two lines");
  std::getline(in, line);
  CHECK(line == "ASCII");
  std::getline(in, line);
  CHECK(line == "DATASET POLYDATA");
  std::size_t points, cells, numbers;
  REQUIRE((in >> word >> points >> word && word == "double"));
  const Surface rod = surface_of(m.shapes[1]), cube = surface_of(m.shapes[0]);
  REQUIRE(points == rod.points.size() + cube.points.size());
  std::vector<Vec3> x(points);
  for (Vec3& p : x) in >> p[0] >> p[1] >> p[2];
  CHECK((x[0] - (Vec3(1, 2, 3) + quaternion(Vec3(0, 0, 0.4)) * rod.points[0])).norm() <= 1e-8);
  REQUIRE((in >> word >> cells >> numbers && word == "POLYGONS"));
  CHECK(cells == rod.polygons.size() + cube.polygons.size());
  std::size_t read = 0;
  for (std::size_t c = 0; c < cells; ++c) {
    std::size_t n, k;
    in >> n;
    for (std::size_t j = 0; j < n; ++j) REQUIRE((in >> k && k < points));
    read += n + 1;
  }
  CHECK(read == numbers);
  std::size_t again;
  REQUIRE((in >> word >> again && word == "CELL_DATA"));
  CHECK(again == cells);
  REQUIRE((in >> word >> word >> word && word == "int"));
  in >> word >> word >> word;
  std::vector<int> ids(cells);
  for (int& i : ids) REQUIRE(in >> i);
  CHECK((ids.front() == 7 && ids.back() == 9));
}
