#include "model/rigid_motion.hpp"

#include "catch.hpp"
#include "chain.hpp"
#include "model/geometry.hpp"
#include "model/grains.hpp"

using namespace elamin;

namespace {

Field column(std::initializer_list<Vec3> points) {
  Field x(3, static_cast<Eigen::Index>(points.size()));
  Eigen::Index k = 0;
  for (const Vec3& p : points) x.col(k++) = p;
  return x;
}

std::vector<std::string> names(const std::vector<RigidMotion>& motions) {
  std::vector<std::string> n;
  for (const RigidMotion& m : motions) n.push_back(m.name);
  return n;
}

}  // namespace

TEST_CASE("Free grains are named one by one", "[model]") {
  Model m = chain(5, 1, 1, 1);
  hold(m, 0, 1);
  add_grains(m, {{"grains", column({{3, 0, 0}, {4, 0, 0}}), {1, 1}, 1}, {"one", column({{9, 9, 9}}), {1}, 1}});
  hold(m, 6, 6, {true, false, true});
  const std::vector<RigidMotion> motions = free_rigid_motions(m, m.start);
  CHECK(names(motions) == std::vector<std::string>{"translation of grains 1 along x",
                                                   "translation of grains 1 along y",
                                                   "translation of grains 1 along z",
                                                   "translation of grains 2 along y", "translation of 'one' along x",
                                                   "translation of 'one' along y", "translation of 'one' along z"});
  for (const RigidMotion& r : motions) CHECK((r.translation && r.sites == std::vector<int>{r.particle}));
  CHECK(motions[3].particle == 6);
  const Field v = motions[3].velocity_field(m.particles());
  CHECK((v.cols() == 8 && v.col(6) == Vec3(0, 1, 0) && v.cwiseAbs().sum() == 1));
}

TEST_CASE("Motions move their part rigidly and nothing that is held", "[model]") {
  Model m = chain(6, 1, 1, 1e-3, Vec3(1, 0, 0));
  m.start.position.col(5) += Vec3(0, 4e-4, 0);   // not in one line, so that it can turn about all axes
  hold(m, 0, 0);
  add_grains(m, {{"grain", column({{3, 0, 0}}), {1}, 1}});
  hold(m, 6, 6);
  const std::vector<RigidMotion> motions = free_rigid_motions(m, m.start);
  REQUIRE(motions.size() == 3);
  for (const RigidMotion& r : motions) {
    CHECK_FALSE(r.translation);
    CHECK(r.name.find("rotation of 'chain' about ") == 0);
    const Field v = r.velocity_field(7);
    CHECK(v.col(0).norm() < 1e-12);
    CHECK(v.col(6).isZero(0));
    CHECK(v.leftCols(6).cwiseAbs().maxCoeff() > 1e-6);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < i; ++j)
        CHECK(std::abs((v.col(i) - v.col(j)).dot((m.start.position.col(i) - m.start.position.col(j)).normalized())) <
              1e-12);
  }
}

TEST_CASE("Contacts in force tie parts together", "[model]") {
  Model m = chain(3, 1, 1, 1);   // along z
  add_grains(m, {{"grains", column({{0, 0, 3}, {0, 1, 3}, {7, 7, 7}}), {1, 1, 1}, 1}});
  const std::vector<std::array<int, 2>> touching{{2, 3}, {3, 4}};
  CHECK(connected_parts(m) == std::vector<int>{0, 0, 0, 1, 2, 3});
  CHECK(connected_parts(m, touching) == std::vector<int>{0, 0, 0, 0, 0, 1});
  hold(m, 5, 5);
  CHECK(free_rigid_motions(m, m.start).size() == 5 + 2 * 3);   // a row does not turn about its own line
  const std::vector<RigidMotion> motions = free_rigid_motions(m, m.start, touching);
  REQUIRE(motions.size() == 6);
  int translations = 0;
  for (const RigidMotion& r : motions) {
    CHECK(r.name.find("of 'chain' and what it touches a") != std::string::npos);
    CHECK(r.sites == std::vector<int>{0, 1, 2, 3, 4});
    translations += r.translation;
  }
  CHECK(translations == 3);
}

TEST_CASE("Pieces of one structure are told apart", "[model]") {
  Model m = chain(6, 1, 1, 1);
  m.structures[0].name = m.structures[0].kind = "lammps";
  m.bonds.erase(m.bonds.begin() + 2), m.bonds.pop_back();   // 1–3, 4–5, 6
  m.angles.clear();
  hold(m, 0, 1);
  const std::vector<std::string> all = names(free_rigid_motions(m, m.start));
  REQUIRE(all.size() == 5 + 3);
  CHECK(all[4].find("of the part of 'lammps' that has particle 4 along ") != std::string::npos);
  CHECK(all[5] == "translation of particle 6 along x");
}

TEST_CASE("Very many free grains take little", "[model]") {
  constexpr int n = 200'000;
  Model m;
  add_grains(m, {{"grains", Field::Random(3, n), std::vector<double>(n, 1e-3), 1}});
  const std::vector<RigidMotion> motions = free_rigid_motions(m, m.start);
  REQUIRE(motions.size() == 3u * n);
  CHECK(motions.back().name == "translation of grains 200000 along z");
  CHECK(motions.back().part_velocity.cols() == 1);
}
