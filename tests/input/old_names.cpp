#include "catch.hpp"
#include "input/read.hpp"

using namespace elamin;

TEST_CASE("old names of keys and words are read, with a note that tells the new one", "[problem]") {
  const std::string body = "[[body]]\nname = \"dice\"\nshape = \"cube\"\nedge = 1\nrounding_diameter = 0.25\nmass = 1\n";
  const std::string old_names = body + "[[support]]\ngroup = \"dice\"\nturns = \"xyz\"\n"
                                       "[[observe]]\nname = \"w\"\ngroup = \"dice\"\nquantity = \"spin.z\"\n[study]\ntype = \"energy\"\n";
  const Problem problem = read_problem_text(old_names, "p.toml", {});
  REQUIRE(problem.supports.size() == 1);
  CHECK(problem.supports[0].rotations == "xyz");
  REQUIRE(problem.observe.size() == 1);
  CHECK(problem.observe[0].quantity == Quantity::angular_velocity);
  CHECK(problem.notes == std::vector<std::string>{"p.toml:9: \"turns\" is now called \"rotations\"",
                                                  "p.toml:13: \"spin.z\" is now called \"angular_velocity.z\""});

  const std::string both = body + "[[support]]\ngroup = \"dice\"\nturns = \"xyz\"\nrotations = \"xy\"\n[study]\ntype = \"energy\"\n";
  CHECK_THROWS_WITH(read_problem_text(both, "p.toml", {}), Catch::Matchers::Contains("p.toml:9:1: support.1.turns: unknown key"));
}
