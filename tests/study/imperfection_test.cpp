// [imperfection] from modes, states and random numbers, as prepared and as run.
#include "catch.hpp"

#include "input/read.hpp"
#include "scratch_directory.hpp"
#include "study/imperfection.hpp"
#include "study/program.hpp"

#include "energy/energy.hpp"

#include <nlohmann/json.hpp>

#include <fstream>

using namespace elamin;

namespace {

const std::string hinged = R"(
plane = "xz"
[[beam]]
name = "column"
particles = 21
from = [0, 0, 0]
to = [0, 0, 1]
diameter = 0.05
youngs_modulus = 1e6
[[group]]
name = "ends"
of = "column"
ids = [1, 21]
[[support]]
group = "ends"
)";

Model imperfect(const ScratchDirectory& scratch, const std::string& more, const std::string& column = hinged) {
  return model_of(read_problem(scratch.file("imperfect.toml", column + more)));
}

}  // namespace

TEST_CASE("Modes of the structure as built are half waves of the amplitudes that are asked for", "[study]") {
  const ScratchDirectory scratch;
  const Model perfect = imperfect(scratch, ""), m = imperfect(scratch, "[imperfection]\nmodes = [1, 2]\namplitudes = [2e-3, -1e-3]\n");
  const auto shape = [&](int i) { return (m.start.position.col(i) - perfect.start.position.col(i)).eval(); };
  const double first = (shape(10)).x(), half = (shape(5).x() + shape(15).x()) / 2, other = (shape(5).x() - shape(15).x()) / 2;
  CHECK(first == Approx(2e-3).epsilon(1e-9));
  CHECK(half == Approx(2e-3 * std::sin(pi / 4)).epsilon(1e-6));
  CHECK(std::abs(other) == Approx(1e-3).epsilon(1e-6));
  CHECK(shape(0).norm() == 0);
  CHECK(m.imperfection > 2e-3);
  CHECK(Energy(m).forces(m.start).norm() < 1e-9);        // at rest so; a bond bears 1e6·t²
}

TEST_CASE("Random imperfections are the same for a seed, within their bounds, in the plane and in the group", "[study]") {
  const ScratchDirectory scratch;
  const auto by = [&](const std::string& more) -> Field {
    return imperfect(scratch, "[imperfection]\nrandom = 1e-3\n" + more).start.position - imperfect(scratch, "").start.position;
  };
  const Field a = by("seed = 3\n"), b = by("seed = 4\n");
  CHECK(a == by("seed = 3\n"));
  CHECK((a - b).norm() > 1e-3);
  CHECK(a.cwiseAbs().maxCoeff() <= 1e-3);
  CHECK(a.cwiseAbs().maxCoeff() > 0.8e-3);
  CHECK(a.row(1).isZero(0));
  const Field normal = by("distribution = \"normal\"\n");
  CHECK(normal.cwiseAbs().maxCoeff() > 1.5e-3);
  CHECK(normal.norm() / std::sqrt(42.0) == Approx(1e-3).epsilon(0.4));
  const Field ends = by("group = \"ends\"\n");
  CHECK(ends.col(0).norm() > 0);
  CHECK(ends.middleCols(1, 19).isZero(0));
}

TEST_CASE("An imperfection from a stored run: its modes, null vectors of an event, a state, and it is recorded", "[study]") {
  const ScratchDirectory scratch;
  scratch.file("modes.toml", hinged + "[study]\ntype = \"modes\"\n");
  REQUIRE(elamin_says((scratch / "modes.toml") + " -o " + (scratch / "modes") + " --quiet").status == 0);
  const Model stored = imperfect(scratch, "[imperfection]\nmodes = [2]\namplitudes = [1e-3]\nrun = \"modes\"\n");
  const Model own = imperfect(scratch, "[imperfection]\nmodes = [2]\namplitudes = [1e-3]\n");
  CHECK((stored.start.position - own.start.position).norm() < 1e-9);

  std::string sliding = hinged;
  sliding += "displacement = [0, 0, 0]\n[[group]]\nname = \"top\"\nof = \"column\"\nlast = 1\n";
  scratch.file("path.toml", sliding + "[[change]]\ngroup = \"column\"\nrest_length = 0.01\n[path]\nsteps = 10\n");
  REQUIRE(elamin_says((scratch / "path.toml") + " -o " + (scratch / "path") + " --quiet").status == 0);
  const Model null = imperfect(scratch, "[imperfection]\nmodes = [1]\namplitudes = [1e-3]\nrun = \"path\"\nat = \"branch:1\"\n");
  CHECK((null.start.position.col(10) - Vec3(1e-3, 0, 0.5)).norm() < 1e-9);
  const Model state = imperfect(scratch, "[imperfection]\nstate = \"path/states/final.data\"\nscale = 0.01\n");
  CHECK(state.imperfection > 1e-5);
  CHECK(state.imperfection < 1e-2);

  scratch.file("run.toml", hinged + "[study]\ntype = \"equilibrium\"\n[imperfection]\nmodes = [1]\namplitudes = [1e-3]\n");
  REQUIRE(elamin_says((scratch / "run.toml") + " -o " + (scratch / "run") + " --quiet").status == 0);
  std::ifstream in(scratch / "run/summary.json");
  const auto summary = nlohmann::json::parse(in);
  CHECK(summary["imperfection"]["max_displacement"].get<double>() == Approx(1e-3).epsilon(1e-9));
  std::ifstream resolved(scratch / "run/resolved.toml");
  const std::string text{std::istreambuf_iterator<char>(resolved), {}};
  CHECK(text.find("[imperfection]\nmodes = [1]\namplitudes = [0.001]\n") != std::string::npos);

  const std::pair<const char*, const char*> kinds[]{
      {"modes = [1]\namplitudes = [1e-3]\n", "imperfection: modes 1; particles are moved by 0.001 at most, and at rest so\n"},
      {"random = 1e-3\n", "imperfection: random, seed 0; particles are moved by 0.00"},
      {"state = \"path/states/final.data\"\nscale = 0.5\n", "final.data has beside the perfect shape; particles are moved by 0."}};
  for (const auto& [keys, sentence] : kinds) {
    const std::string said = elamin_says("check " + scratch.file("check.toml", hinged + "[study]\ntype = \"equilibrium\"\n[imperfection]\n" + keys)).text;
    INFO(said);
    CHECK(said.find(sentence) != std::string::npos);
  }
}

TEST_CASE("Imperfections that cannot be made are told", "[study]") {
  const ScratchDirectory scratch;
  const auto said = [&](const std::string& more, const std::string& column = hinged) -> std::string {
    try {
      imperfect(scratch, "[imperfection]\n" + more, column);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  };
  CHECK_THAT(said("modes = [90]\namplitudes = [1]\n"), Catch::Contains("there is no mode 90: the structure has 38"));
  CHECK_THAT(said("modes = [1]\namplitudes = [1]\nrun = \".\"\n"), Catch::Contains("there is no mode 1"));
  CHECK_THAT(said("state = \"imperfect.toml\"\n"), Catch::Contains("is no state of this structure"));
  const std::string in_space = hinged.substr(hinged.find("[["));
  CHECK_THAT(said("random = 1e-3\n", in_space), Catch::Contains("a rest angle in space has no direction"));
  CHECK(said("random = 1e-3\nstress_free = false\n", in_space) == "");
}
