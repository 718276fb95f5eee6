#include "model/grains.hpp"

#include "catch.hpp"
#include "core/error.hpp"

using namespace elamin;

TEST_CASE("Grains are free: a molecule each, a type a set, no bonds", "[model]") {
  Model m;
  m.start = State(Field::Zero(3, 1));
  m.id = {7}, m.type = {2}, m.molecule = {3}, m.diameter = {1}, m.density = {1};
  Field three(3, 3);
  three << 1, 2, 3, 4, 5, 6, 7, 8, 9;
  add_grains(m, {{"a", three, {0.1, 0.2, 0.3}, 5}, {"none", Field(3, 0), {}, 1}, {"b", three.leftCols(1), {0.5}, 0}});
  CHECK(m.id == std::vector<int>{7, 8, 9, 10, 11});
  CHECK(m.type == std::vector<int>{2, 3, 3, 3, 5});
  CHECK(m.molecule == std::vector<int>{3, 4, 5, 6, 7});
  CHECK(m.diameter == std::vector<double>{1, 0.1, 0.2, 0.3, 0.5});
  CHECK(m.density == std::vector<double>{1, 5, 5, 5, 0});
  CHECK(m.start.position.middleCols(1, 3) == three);
  CHECK(m.start.low.isZero(0));
  CHECK((m.bonds.empty() && m.bond_types.empty() && m.angles.empty()));
  REQUIRE(m.structures.size() == 3);
  CHECK((m.structures[2].name == "b" && m.structures[2].kind == "grains" && m.structures[2].first == 4 &&
         m.structures[2].count == 1));
}

TEST_CASE("Where ids end is said", "[model]") {
  Model m;
  m.start = State(Field::Zero(3, 1));
  m.id = {2147483645}, m.type = {1}, m.molecule = {0}, m.diameter = {1}, m.density = {1};
  add_grains(m, {{"a", Field::Ones(3, 1), {1}, 1}});
  CHECK(m.id.back() == 2147483646);
  CHECK_THROWS_AS(add_grains(m, {{"b", Field::Ones(3, 1), {1}, 1}}), InputError);
  CHECK(m.particles() == 2);
}
