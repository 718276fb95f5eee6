// Bodies in written states: read back as they were, alone and beside particles, and gone on from to the last bit.
#include "catch.hpp"
#include "laws/rounded/bodies.hpp"
#include "lammps/data.hpp"
#include "input/model_of.hpp"
#include "input/state_supplement.hpp"
#include "lammps/state.hpp"
#include "results/sample.hpp"
#include "core/text_file.hpp"
#include "results/columns.hpp"

#include <fmt/format.h>

#include <filesystem>

using namespace elamin;

namespace {

/// One body of each kind, turned, with masses and velocities; ids above those of the particles.
void add_bodies(Model& m, bool moving) {
  std::mt19937 random(3);
  for (const NamedShape& s : test_shapes()) {
    const int k = static_cast<int>(m.bodies.size());
    const MassProperties solid = mass_properties(s.shape);
    m.shapes.push_back(s.shape);
    m.bodies.push_back({k, 20 + 3 * k, 1 + k % 3, 2 + k / 3.0, (2 + k / 3.0) / solid.volume * solid.inertia});
    m.start.bodies.push_back({{3 * random_vector(random), 1e-18 * random_vector(random)}, random_rotation(random)});
  }
  if (!moving) return;
  m.body_velocity = m.angular_momentum = Field(3, static_cast<Eigen::Index>(m.bodies.size()));
  for (Eigen::Index b = 0; b < m.body_velocity.cols(); ++b)
    m.body_velocity.col(b) = random_vector(random), m.angular_momentum.col(b) = random_vector(random);
}

double off(const RoundedShape& a, const Eigen::Quaterniond& q, const RoundedShape& b) {
  double most = std::abs(a.radius - b.radius);
  for (std::size_t k = 0; k < a.vertices.size(); ++k) most = std::max(most, (q * a.vertices[k] - b.vertices[k]).norm());
  return most;
}

}  // namespace

TEST_CASE("bodies alone are written in atom style body, turned into the axes of space", "[lammps_state][bodies]") {
  const ScratchDirectory scratch;
  Model m;
  const bool moving = GENERATE(false, true);
  add_bodies(m, moving);
  write_state(scratch / "a.data", m, m.start, "bodies");
  CHECK_FALSE(std::filesystem::exists(scratch / "a.bodies.data"));
  const LammpsData data = read_lammps_data(scratch / "a.data");
  REQUIRE(data.bodies.size() == m.bodies.size());
  for (std::size_t b = 0; b < m.bodies.size(); ++b) {
    INFO(test_shapes()[b].name);
    const auto column = static_cast<Eigen::Index>(b);
    CHECK(data.bodies[b].id == m.bodies[b].id);
    CHECK(data.bodies[b].type == m.bodies[b].type);
    CHECK(data.bodies[b].mass == m.bodies[b].mass);
    CHECK(Vec3(data.body_position.col(column)) == m.start.bodies[b].position.hi);
    const Mat3 R = m.start.bodies[b].rotation.toRotationMatrix();
    CHECK((data.bodies[b].inertia - R * m.bodies[b].inertia * R.transpose()).norm() <= 1e-15 * m.bodies[b].inertia.norm() * 4);
    const RoundedShape& there = data.shapes[data.bodies[b].shape];
    REQUIRE(there.vertices.size() == m.shapes[b].vertices.size());
    CHECK(there.edges.size() == m.shapes[b].edges.size());
    CHECK(there.faces.size() == m.shapes[b].faces.size());
    CHECK(off(m.shapes[b], m.start.bodies[b].rotation, there) <= 1e-15);
  }
  CHECK(data.body_velocity.cols() == (moving ? 5 : 0));
  if (moving) CHECK(data.body_velocity == m.body_velocity);
  if (moving) CHECK(data.angular_momentum == m.angular_momentum);
}

TEST_CASE("bodies beside particles have a file of their own", "[lammps_state][bodies]") {
  const ScratchDirectory scratch;
  Model m = sample_model();
  add_bodies(m, false);
  m.bodies[0].mass = 0;
  write_state(scratch / "a.data", m, m.start, "both");
  CHECK(read_lammps_data(scratch / "a.data").position == m.start.position);
  CHECK(read_lammps_data(scratch / "a.data").bodies.empty());
  const LammpsData bodies = read_lammps_data(scratch / "a.bodies.data");
  CHECK(bodies.bodies.size() == 5);
  CHECK(bodies.bodies[0].mass == 1);
  CHECK(text_of(scratch / "a.bodies.data").find("a mass that is not given is written as 1") != std::string::npos);
  const std::string files = fmt::format("[lammps]\ndata = \"{}\"\nbodies = \"{}\"\n", scratch / "a.data", scratch / "a.bodies.data");
  const Model both = model_of(files + energy_study);
  CHECK(both.particles() == m.particles());
  CHECK(both.bodies.size() == 5);
  CHECK(both.structures.at(0).bodies == 5);
  CHECK(said_of(fmt::format("[lammps]\ndata = \"{0}\"\nbodies = \"{0}\"\n", scratch / "a.bodies.data") + energy_study)
            .find("lammps.bodies: and `data` both hold bodies") != std::string::npos);
  CHECK(said_of(fmt::format("[lammps]\nbodies = \"{}\"\n", scratch / "a.data") + energy_study)
            .find("particles; these belong into the file of `data`") != std::string::npos);
  m.bodies[2].id = m.id[0];
  std::swap(m.bodies[0], m.bodies[2]), std::swap(m.start.bodies[0], m.start.bodies[2]);
  write_state(scratch / "a.data", m, m.start, "both");
  CHECK(said_of(files + energy_study).find("is that of a body and of a particle") != std::string::npos);
}

TEST_CASE("faces of more than four corners are cut for LAMMPS", "[lammps_state][bodies]") {
  const ScratchDirectory scratch;
  const int n = GENERATE(5, 6, 7, 8);
  CoreMesh drum{{}, {}, {{}, {}}};
  for (int k = 0; k < 2 * n; ++k)
    drum.vertices.push_back({std::cos(k % n * 2 * pi / n), std::sin(k % n * 2 * pi / n), k < n ? -0.3 : 0.3});
  for (int k = 0; k < n; ++k) {
    drum.faces[0].insert(drum.faces[0].begin(), k), drum.faces[1].push_back(n + k);
    drum.faces.push_back({k, (k + 1) % n, n + (k + 1) % n, n + k});
  }
  Model m;
  m.shapes.push_back(rounded_shape(drum, 0.2));
  m.bodies.push_back({0, 1, 1, 1, Mat3::Identity()});
  m.start.bodies.push_back({});
  write_state(scratch / "a.data", m, m.start, "a drum");
  const LammpsData data = read_lammps_data(scratch / "a.data");
  CHECK(data.shapes.at(0).faces.size() == static_cast<std::size_t>(n + 2 * ((n - 1) / 2)));
  CHECK(mass_properties(data.shapes[0]).volume == Approx(mass_properties(m.shapes[0]).volume).epsilon(1e-14));
  std::istringstream lines(text_of(scratch / "a.data"));
  for (std::string line; std::getline(lines, line);) CHECK(line.size() < 255);    // LAMMPS reads no longer one
}

TEST_CASE("a path goes on from a state of bodies to the last bit", "[lammps_state][bodies]") {
  const ScratchDirectory scratch;
  Model start;
  add_bodies(start, false);
  write_state(scratch / "start.data", start, start.start, "start");
  const std::string problem = fmt::format("[lammps]\ndata = \"{}\"\n[study]\ntype = \"energy\"\n[path]\nstart = \"{}\"\n", scratch / "start.data",
                                          scratch / "x.data");
  const Model m = model_of(fmt::format("[lammps]\ndata = \"{}\"\n", scratch / "start.data") + energy_study);
  State state = m.start;
  std::mt19937 random(5);
  for (Pose& p : state.bodies) p = {{p.position.hi + random_vector(random), 1e-18 * random_vector(random)}, random_rotation(random)};
  write_state(scratch / "x.data", m, state, "later");

  Model again = model_of(problem);                             // from the data file alone
  REQUIRE(again.restart);
  for (std::size_t b = 1; b < 5; ++b) {                        // of a sphere nothing tells
    CHECK(again.restart->bodies[b].position.hi == state.bodies[b].position.hi);
    CHECK(off(m.shapes[m.bodies[b].shape], again.restart->bodies[b].rotation, read_lammps_data(scratch / "x.data").shapes[b]) <= 1e-14);
  }

  write_text(scratch / "x.json", supplement_text({0.25, state.low, {}, {}, stored_poses(state)}));
  again = model_of(problem);
  CHECK(again.restart->load_factor == 0.25);
  for (std::size_t b = 0; b < 5; ++b) {
    CHECK(again.restart->bodies[b].position.hi == state.bodies[b].position.hi);
    CHECK(again.restart->bodies[b].position.lo == state.bodies[b].position.lo);
    CHECK(again.restart->bodies[b].rotation.coeffs() == state.bodies[b].rotation.coeffs());
  }

  std::swap(state.bodies[1].rotation, state.bodies[2].rotation);
  write_text(scratch / "x.json", supplement_text({0.25, state.low, {}, {}, stored_poses(state)}));
  CHECK(said_of(problem).find("are not of one state") != std::string::npos);
  write_text(scratch / "x.json", "{\"lambda\": 0, \"tail\": [], \"bodies\": [[0, 0, 0, 1, 0, 0]]}");
  CHECK(said_of(problem).find("bodies must be [[x, y, z, qw, qx, qy, qz], …], finite numbers") != std::string::npos);
  write_text(scratch / "x.json", "{\"lambda\": 0, \"tail\": [], \"bodies\": [[0, 0, 0, 2, 0, 0, 0]]}");
  CHECK(said_of(problem).find("the rotation of body 1 must be a unit quaternion") != std::string::npos);
  std::filesystem::remove(scratch / "x.json");
  Model other = m;
  other.shapes[other.bodies[3].shape].radius *= 1.01;
  write_state(scratch / "x.data", other, m.start, "another");
  CHECK(said_of(problem).find("holds body 29 in another shape; it must be a state of this problem") != std::string::npos);
  other.bodies[3].id = 30;
  write_state(scratch / "x.data", other, m.start, "another");
  CHECK(said_of(problem).find("holds bodies with other ids") != std::string::npos);
}

TEST_CASE("a frame has a row a body in a file of its own", "[trajectory][bodies]") {
  const ScratchDirectory scratch;
  Model m;
  add_bodies(m, true);
  Motion motion;
  motion.state = m.start, motion.body_velocity = m.body_velocity, motion.angular_momentum = m.angular_momentum;
  motion.body_force = 2 * m.body_velocity, motion.torque = 3 * m.angular_momentum;
  write_frame(scratch / "100.csv", m, motion);
  CHECK(text_of(scratch / "100.csv") == "id,x,y,z,vx,vy,vz,fx,fy,fz\n");
  std::istringstream lines(text_of(scratch / "100.bodies.csv"));
  std::string line;
  std::getline(lines, line);
  CHECK(line == "id,x,y,z,qw,qx,qy,qz,vx,vy,vz,Lx,Ly,Lz,fx,fy,fz,tx,ty,tz");
  for (std::size_t b = 0; b < 5; ++b) {
    std::getline(lines, line);
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    std::vector<double> v;
    for (double x; words >> x;) v.push_back(x);
    REQUIRE(v.size() == 20);
    const Pose& p = m.start.bodies[b];
    CHECK(v[0] == m.bodies[b].id);
    CHECK(v[2] == p.position.hi.y());
    CHECK(v[4] >= 0);
    CHECK(Eigen::Quaterniond(v[4], v[5], v[6], v[7]).toRotationMatrix() == p.rotation.toRotationMatrix());
    CHECK(v[10] == m.body_velocity(2, static_cast<Eigen::Index>(b)));
    CHECK(v[11] == m.angular_momentum(0, static_cast<Eigen::Index>(b)));
    CHECK(v[16] == motion.body_force(2, static_cast<Eigen::Index>(b)));
    CHECK(v[17] == motion.torque(0, static_cast<Eigen::Index>(b)));
  }
}
