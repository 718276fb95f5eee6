#include "model/entities.hpp"

#include "catch.hpp"

using namespace elamin;

TEST_CASE("particles and bodies are called by their structure", "[model]") {
  Model m;
  m.start = State(Field::Zero(3, 7));
  m.start.bodies.resize(2);
  m.id = {1, 2, 3, 4, 5, 60, 70};
  m.bodies.resize(2);
  m.bodies[0].id = 80, m.bodies[1].id = 81;
  CHECK(called(m, 5) == "particle 60");
  CHECK(called(m, 7) == "body 80");
  m.structures = {{"sheet", "sheet", 0, 4}, {"ball", "grains", 4, 1}, {"lammps", "lammps", 5, 2, 0, -1, -1, 0, 1}, {"cube", "body", 7, 0, 0, -1, -1, 1, 1}};
  CHECK(called(m, 0) == "sheet 1");
  CHECK(called(m, 3) == "sheet 4");
  CHECK(called(m, 4) == "ball 1");
  CHECK(called(m, 6) == "particle 70");
  CHECK(called(m, 7) == "body 80");
  CHECK(called(m, 8) == "body cube");
}
