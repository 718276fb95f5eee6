// Tables of grains, right and wrong.
#include "catch.hpp"

#include "input/grains.hpp"
#include "input/model_of.hpp"

#include <sys/stat.h>

using namespace elamin;

TEST_CASE("A table of grains") {
  const ScratchDirectory scratch;
  const auto rows = [&](const std::string& text) { return read_grains(scratch.file("g.csv", text)); };
  const auto said = [&](const std::string& text) { return sentences_of([&] { rows(text); }); };
  CHECK(rows("1,2,3").position == std::vector<Vec3>{{1, 2, 3}});
  CHECK(rows("1,2,3\n\n 4 ,\t5,6e-3\r\n").position[1] == Vec3(4, 5, 6e-3));
  CHECK(rows("x,y,z\n1,2,3\n").diameter.empty());
  CHECK(rows("# all\nx,y,z,diameter # of all\n1,2,3,0.10000000000000001\n").diameter == std::vector<double>{0.1});
  CHECK(said("") == "1:1: holds no grain; a line x,y,z or x,y,z,diameter is one");
  CHECK(said("x,y,z\n") == "1:1: holds no grain; a line x,y,z or x,y,z,diameter is one");
  CHECK(said("1,2\n") == "1:1: 2 columns, expected x,y,z or x,y,z,diameter");
  CHECK(said("1,2,3\n1,2,3,4\n") == "2:1: 4 columns, but the lines before have 3");
  CHECK(said("1,2,3\n4, five,\n") == "2:4: y: \"five\" is not a number\n2:9: z: \"\" is not a number");
  CHECK(said("1,2,nan\ninf,0,0x1\n") ==
        "1:5: z: \"nan\" is not finite\n2:1: x: \"inf\" is not finite\n2:7: z: \"0x1\" is not a number");
  CHECK(said("1,2,1e999\n") == "1:5: z: \"1e999\" is too large or too small for a floating-point number");
  CHECK(said("1,2,3,0\n1,2,3,-1\n") ==
        "1:7: diameter: must be a positive number, is 0\n2:7: diameter: must be a positive number, is -1");
  CHECK(said("1 2 3\n") == "1:1: 1 columns, expected x,y,z or x,y,z,diameter");
  CHECK(rows("# a\x7f comment\n1,2,3\n").position.size() == 1);      // no letter, but no sign of a binary file
  CHECK(said(std::string("1,2,3\0", 6)) == " is a binary file; a table x,y,z or x,y,z,diameter is text");
  std::string wrong;
  for (int i = 0; i < 1000; ++i) wrong += "a,b,c\n";
  CHECK(said(wrong).size() < 2000);

  scratch.file("g.csv", "0,0,0\n3,0,0\n");
  const auto problem = [&](const std::string& more) {
    const std::string file = scratch.file("p.toml", "[[grains]]\nname = \"a\"\nfile = \"g.csv\"\n" + more);
    return sentences_of([&] {
      const int particles = build_model(read_problem(file)).particles();
      CHECK(particles == 2);
    });
  };
  CHECK(problem("diameter = 1") == "");
  CHECK(problem("") == "1:1: grains.a.diameter: is missing; give it here, or as a fourth column of the file");
  scratch.file("g.csv", "0,0,0,1\n3,0,0,2\n");
  CHECK(problem("") == "");
  CHECK(problem("diameter = 1") == "4:12: grains.a.diameter: stands in the fourth column of the file; leave it out");
  const std::string pipe = scratch / "pipe";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);                     // to read it would wait for ever
  for (const std::string& file : {std::string("/tmp"), std::string("/dev/zero"), pipe})
    CHECK(said_of("[[grains]]\nname = \"a\"\nfile = \"" + file + "\"\n[[support]]\ngroup = \"b\"\n") ==
          "3:8: grains.a.file: \"" + file + "\" is a folder or a device; it must be a file\n"
          "5:9: support.1.group: \"b\" names no group; there are: all, a");
  scratch.file("g.csv", "0,0,0,1\n0,0,0,2\n");
  CHECK(problem("") ==
        "1:1: grains.a: a 2 is in the same place as a 1, [0, 0, 0]; particles must lie apart");
}
