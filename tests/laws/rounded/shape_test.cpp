#include "laws/rounded/shape.hpp"

#include "catch.hpp"
#include "laws/rounded/bodies.hpp"

using namespace elamin;

namespace {

using Sentences = std::vector<std::string>;

/// Moments of a rounded solid by counting cells of a grid.
MassProperties counted(const RoundedShape& shape, int cells) {
  const double h = 2 * shape.bounding_radius() / cells;
  std::vector<double> heights(shape.faces.size());
  double volume = 0;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (int i = 0; i < cells; ++i)
    for (int j = 0; j < cells; ++j)
      for (int k = 0; k < cells; ++k) {
        const Vec3 x = h * Vec3(i + 0.5, j + 0.5, k + 0.5) - Vec3::Constant(shape.bounding_radius());
        face_heights(shape, x, heights.data());
        if (core_distance(shape, x, heights.data()).value > shape.radius) continue;
        volume += h * h * h, first += h * h * h * x, second += h * h * h * x * x.transpose();
      }
  const Vec3 middle = first / volume;
  second -= volume * middle * middle.transpose();
  return {volume, middle, second.trace() * Mat3::Identity() - second};
}

CoreMesh changed(CoreMesh core, int vertex, const Vec3& by) {
  core.vertices[vertex] += by;
  return core;
}

}  // namespace

TEST_CASE("cores without mistakes", "[laws][rounded]") {
  for (const double size : {1e-3, 1.0, 1e3}) {
    for (const CoreMesh& core :
         {point_core(), rod_core(size), tetrahedron_core(size), cube_core(size), box_core(size * Vec3(1, 2, 3))})
      CHECK(mistakes(core, 0.1 * size) == Sentences{});
    CHECK(tetrahedron_core(size).vertices.size() == 4);
    CHECK(rounded_shape(tetrahedron_core(size), size).shortest_edge == Approx(size).epsilon(1e-14));
  }
  CHECK(mistakes(pyramid_core(), 0.1) == Sentences{});
  for (const NamedShape& s : test_shapes()) {
    const int v = static_cast<int>(s.shape.vertices.size()), e = static_cast<int>(s.shape.edges.size()),
        f = static_cast<int>(s.shape.faces.size());
    if (f > 0) CHECK(v - e + f == 2);
  }
}

TEST_CASE("each mistake of a core has its sentence", "[laws][rounded]") {
  CoreMesh box = box_core({1, 2, 3});
  CHECK(mistakes(box, 0) == Sentences{"the rounding radius is 0; allowed: > 0"});
  CHECK(mistakes(box, std::nan("")) == Sentences{"the rounding radius is nan; allowed: > 0"});
  CHECK(mistakes(changed(box, 3, Vec3(std::nan(""), 0, 0)), 1) == Sentences{"vertex 3 is not finite"});
  CHECK(mistakes({}, 1) == Sentences{"there is no vertex; allowed: 1 (sphere), 2 (rod), 4 or more (polyhedron)"});
  CHECK(mistakes({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}}, 1) ==
        Sentences{"three vertices span no volume; allowed: 1 (sphere), 2 (rod), 4 or more (polyhedron)"});
  CHECK(mistakes({{{0, 0, 0}}, {}, {{0, 0, 0}}}, 1).back() == "a sphere or rod has no faces");
  CHECK(mistakes({{{0, 0, 0}, {0, 0, 0}}, {}, {}}, 1) == Sentences{"vertices 0 and 1 are at the same place"});

  CoreMesh c = box;
  c.faces[0] = {0, 4, 6, 9};
  CHECK(mistakes(c, 1) == Sentences{"face 0 names vertex 9; allowed: 0 to 7"});
  c.faces[0] = {0, 4};
  CHECK(mistakes(c, 1) == Sentences{"face 0 has 2 vertices; allowed: 3 or more"});
  c.faces[0] = {0, 4, 6, 4};
  CHECK(mistakes(c, 1) == Sentences{"face 0 names vertex 4 twice"});
  c = box, c.edges = {{0, 8}, {1, 1}};
  CHECK(mistakes(c, 1) == Sentences{"edge 0 names vertex 8; allowed: 0 to 7", "edge 1 runs from vertex 1 to itself"});
  c = box, c.faces.pop_back();
  CHECK(mistakes(c, 1).size() == 4);
  CHECK(mistakes(c, 1)[0] == "the mesh is open: one face only at the side 4 to 6");
  c = box, std::reverse(c.faces[0].begin(), c.faces[0].end());
  const Sentences turned = mistakes(c, 1);
  CHECK(turned[0] == "2 faces run along 0 to 2 in the same direction; allowed: 1");
  CHECK(turned.back() == "face 0 looks inward; allowed: vertices counter-clockwise seen from outside");
  c = box;
  for (auto& face : c.faces) std::reverse(face.begin(), face.end());
  CHECK(mistakes(c, 1).size() == 6);
  CHECK(mistakes(c, 1)[5] == "face 5 looks inward; allowed: vertices counter-clockwise seen from outside");
  CHECK(mistakes(changed(box, 0, {-5e-5, 0, 0}), 1).at(0) == "face 0 is not planar");
  CHECK(mistakes(changed(box, 0, {-1e-6, 0, 0}), 1).empty());     // the last of six written digits
  CHECK(mistakes(changed(box, 0, {-1e-12, 0, 0}), 1) == Sentences{});

  // A pyramid whose tip is below its base: the base looks inward, and so on; a dent in an octahedron: not convex.
  CHECK(!mistakes(changed(pyramid_core(), 4, {0, 0, -2}), 1).empty());
  CoreMesh dented{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, 0.5}}, {},
                  {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
  CHECK(mistakes(dented, 1).back() == "the core is not convex: vertices stand on both sides of face 7");
  CHECK(mistakes(changed(dented, 5, {0, 0, -1.5}), 1) == Sentences{});
  CHECK(mistakes({{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {}, {{0, 1, 2, 3}, {3, 2, 1, 0}}}, 1) ==
      Sentences{"the core has no volume"});

  c = box, c.vertices.push_back({0, 0, 0});
  CHECK(mistakes(c, 1) == Sentences{"vertex 8 belongs to no face"});
  c = box, c.vertices.push_back((c.vertices[4] + c.vertices[5]) / 2);  // in the middle of a side
  c.faces = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 8, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 8, 5, 7, 6}};
  CHECK(mistakes(c, 1) == Sentences{"vertex 8 is no corner of the core: leave it out"});

  c = tetrahedron_core(1), c.edges = {{0, 1}, {1, 0}, {0, 2}, {0, 3}, {1, 2}};
  CHECK(mistakes(c, 1) ==
      Sentences{"the edge 0 to 1 is given 2 times", "the side 1 to 3 of a face is missing among the edges",
                                    "the side 2 to 3 of a face is missing among the edges"});
}

TEST_CASE("edges between coplanar faces are no features", "[laws][rounded]") {
  CoreMesh box = box_core({1, 2, 3}), cut = box;
  cut.faces.clear();
  for (const auto& f : box.faces) cut.faces.push_back({f[0], f[1], f[2]}), cut.faces.push_back({f[0], f[2], f[3]});
  CHECK(mistakes(cut, 0.1) == Sentences{});
  const RoundedShape whole = rounded_shape(box, 0.1), pieces = rounded_shape(cut, 0.1);
  int flat = 0;
  for (const auto& e : pieces.edges) flat += e.flat;
  CHECK(flat == 6);
  CHECK(pieces.shortest_edge == whole.shortest_edge);
  CHECK((mass_properties(pieces).inertia - mass_properties(whole).inertia).norm() <=
      1e-13 * mass_properties(whole).inertia.norm());
  std::mt19937 random(5);
  for (int k = 0; k < 300; ++k) {
    const Vec3 y = 1.5 * random_vector(random);
    std::array<double, 12> h;
    face_heights(whole, y, h.data());
    const CoreDistance a = core_distance(whole, y, h.data());
    face_heights(pieces, y, h.data());
    const CoreDistance b = core_distance(pieces, y, h.data());
    CHECK(std::abs(a.value - b.value) <= 1e-14);
    CHECK((a.normal - b.normal).norm() <= 1e-12);
    CHECK(a.feature.kind == b.feature.kind);
  }
}

TEST_CASE("mass of spheres, rods, boxes and tetrahedra", "[laws][rounded]") {
  const double rho = 0.3, L = 1.7;
  const MassProperties ball = mass_properties(rounded_shape(point_core(), rho));
  CHECK(ball.volume == Approx(4 * pi / 3 * std::pow(rho, 3)).epsilon(1e-14));
  CHECK((ball.inertia - 0.4 * rho * rho * ball.volume * Mat3::Identity()).norm() <= 1e-14 * ball.inertia.norm());

  const MassProperties rod = mass_properties(rounded_shape(rod_core(L), rho));
  const double cylinder = pi * rho * rho * L;
  CHECK(rod.volume == Approx(cylinder + ball.volume).epsilon(1e-14));
  CHECK(rod.inertia(0, 0) == Approx(cylinder * rho * rho / 2 + 0.4 * ball.volume * rho * rho).epsilon(1e-14));
  const double across = cylinder * (rho * rho / 4 + L * L / 12)
      + ball.volume * (0.4 * rho * rho + L * L / 4 + 3 * L * rho / 8);
  CHECK(rod.inertia(1, 1) == Approx(across).epsilon(1e-14));

  // ∫ x² of a rounded box by slices: |x| < a full, then with the radius √(ρ² − z²).
  const Vec3 half(0.5, 0.4, 0.7);
  const MassProperties box = mass_properties(rounded_shape(box_core(2 * half), rho));
  Vec3 square;
  for (int k = 0; k < 3; ++k) {
    const double a = half[k], b = half[(k + 1) % 3], c = half[(k + 2) % 3], p = rho, p2 = p * p, p3 = p2 * p,
        p4 = p3 * p, p5 = p4 * p;
    const double full = 4 * b * c + 4 * (b + c) * p + pi * p2;
    const double flat = ((std::pow(a + p, 3)) - a * a * a) / 3,
        root = a * a * pi * p2 / 4 + 2 * a * p3 / 3 + pi * p4 / 16;
    const double round = a * a * (2 * p3 / 3) + 2 * a * (p4 / 4) + 2 * p5 / 15;
    square[k] = full * 2 * a * a * a / 3 + 2 * (4 * b * c * flat + 4 * (b + c) * root + pi * round);
  }
  for (int k = 0; k < 3; ++k) CHECK(box.inertia(k, k) == Approx(square.sum() - square[k]).epsilon(1e-14));
  CHECK((box.inertia - Mat3(box.inertia.diagonal().asDiagonal())).norm() <= 16 * epsilon * box.inertia.norm());
  CHECK(box.center.norm() <= 1e-15);

  const double e = 1.2;
  const MassProperties tetrahedron = mass_properties(rounded_shape(tetrahedron_core(e), rho));
  CHECK(tetrahedron.volume == Approx(std::pow(e, 3) / (6 * std::sqrt(2.0)) + std::sqrt(3.0) * e * e * rho +
                                     3 * e * rho * rho * (pi - std::acos(1.0 / 3)) + ball.volume).epsilon(1e-14));
  CHECK(tetrahedron.center.norm() <= 1e-15);
  CHECK((tetrahedron.inertia - tetrahedron.inertia(0, 0) * Mat3::Identity()).norm() <= 1e-14);
}

TEST_CASE("mass of a body without symmetry, against a grid, its center", "[laws][rounded]") {
  CoreMesh core = pyramid_core();
  for (Vec3& x : core.vertices) x = quaternion({0.3, -0.9, 0.5}) * x;        // no face along the grid
  const RoundedShape shape = rounded_shape(core, 0.25);
  const MassProperties m = mass_properties(shape), grid = counted(shape, 80);
  CHECK(m.volume == Approx(grid.volume).epsilon(3e-4));
  CHECK((m.center - grid.center).norm() <= 3e-4);
  CHECK((m.inertia - grid.inertia).norm() <= 5e-4 * m.inertia.norm());
  CHECK((m.inertia - m.inertia(0, 0) * Mat3::Identity()).norm() > 0.1 * m.inertia.norm());

  const RoundedShape centred = rounded_shape(moved_origin(core, m.center), 0.25);
  CHECK(mass_properties(centred).center.norm() <= 1e-15);
  CHECK((mass_properties(centred).inertia - m.inertia).norm() <= 1e-14);
}
