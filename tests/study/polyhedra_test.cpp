// The static cases of rounded polyhedra through the program, from a problem file and LAMMPS's data file to the tables.
#include "catch.hpp"
#include "laws/rounded/lammps_case.hpp"
#include "scratch_directory.hpp"
#include "study/program.hpp"

#include <fmt/format.h>

using namespace elamin;

namespace {

/// A case as a problem file. extra: more keys of every contact.
std::string problem_of(const ReferenceCase& c, const std::string& formulation, const std::string& extra, bool walls) {
  std::string text = fmt::format("[lammps]\ndata = \"{}/data/polyhedra/{}/data.bodies\"\n\n[study]\ntype = \"energy\"\n", ELAMIN_ROOT, c.name);
  for (const auto& row : c.settings()["pair_coeff"])
    text += fmt::format("\n[[contact]]\nbetween = [\"type{}\", \"type{}\"]\nlaw = \"rounded\"\nk_n = {:.17g}\nk_na = {:.17g}\ncutoff = {:.17g}\n"
                        "c_n = {:.17g}\nc_t = {:.17g}\nformulation = \"{}\"\n{}",
                        row[0].get<int>(), row[1].get<int>(), row[2].get<double>(), row[3].get<double>(), c.setting("cutoff"), c.setting("c_n"),
                        c.setting("c_t"), formulation, extra);
  if (!walls || !c.settings().contains("walls")) return text;
  int number = 0;
  for (const auto& words : c.settings()["walls"]) {
    const LammpsWall wall = lammps_wall(words.get<std::string>());
    const bool below = std::isfinite(wall.lo);
    Vec3 point = Vec3::Zero(), normal = Vec3::Zero();
    point[wall.axis] = below ? wall.lo : wall.hi, normal[wall.axis] = below ? 1 : -1;
    text += fmt::format("\n[[wall]]\nname = \"wall{}\"\ngroup = \"all\"\nshape = \"plane\"\npoint = [{:.17g}, {:.17g}, {:.17g}]\n"
                        "normal = [{}, {}, {}]\nk_n = {:.17g}\nc_n = {:.17g}\nc_t = {:.17g}\n{}",
                        ++number, point[0], point[1], point[2], normal[0], normal[1], normal[2], wall.stiffness, wall.normal_damping,
                        wall.tangential_damping, formulation == "lammps" ? "formulation = \"lammps\"\n" : "");
  }
  return text;
}

struct Said {
  Wrenches wrenches;
  nlohmann::json json;
};

/// What `elamin energy --json --forces` says of a problem file.
Said said_of(const ReferenceCase& c, const std::string& problem) {
  const ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", problem);
  const Answer answer = elamin_says("energy '" + file + "' --json --forces '" + scratch / "f.csv" + "'");
  INFO(answer.text);
  REQUIRE(answer.status == 0);
  Said said{Wrenches(c.bodies.size()), nlohmann::json::parse(answer.text)};
  said.wrenches.energy = said.json["energy"]["total"].get<double>();
  const auto rows = csv_rows(scratch / "f.bodies.csv");
  REQUIRE(rows.size() == c.bodies.size() + 1);
  CHECK(rows[0] == std::vector<std::string>{"id", "fx", "fy", "fz", "tx", "ty", "tz"});
  CHECK(csv_rows(scratch / "f.csv").size() == 1);
  for (std::size_t k = 0; k < c.bodies.size(); ++k)
    for (int i = 0; i < 3; ++i) {
      said.wrenches.forces[k][i] = std::stod(rows[k + 1][1 + i]);
      said.wrenches.torques[k][i] = std::stod(rows[k + 1][4 + i]);
    }
  return said;
}

}  // namespace

TEST_CASE("the program gives LAMMPS's energies, forces and torques of all static cases", "[study][rounded][lammps]") {
  for (const ReferenceCase& c : static_cases()) {
    INFO(c.name);
    const std::string extra = fmt::format("mu = {:.17g}\ndelta_ua = {:.17g}\n", c.setting("mu"), c.setting("delta_ua"));
    const Said said = said_of(c, problem_of(c, "lammps", extra, true));
    CHECK(said.wrenches.off(c.expected["lammps"]) <= 1e-12);
    CHECK(said.json["bodies"].get<std::size_t>() == c.bodies.size());
    CHECK(said.json["particles"] == 0);
    CHECK(said.json["dofs"].get<std::size_t>() == 6 * c.bodies.size());
    CHECK(said.json["energy"]["body"].get<double>() == said.wrenches.energy);
    double most = 0;
    for (const Vec3& f : said.wrenches.forces) most = std::max(most, f.norm());
    CHECK(said.json["max_force"].get<double>() == Approx(most).epsilon(1e-14));
  }
}

TEST_CASE("the program gives the energies, forces and torques of the true potentials", "[study][rounded]") {
  for (const ReferenceCase& c : static_cases()) {
    INFO(c.name);
    const nlohmann::json& p = c.expected["potential"];
    const bool unique = p["closest"]["contact_unique"].get<bool>();
    CHECK(said_of(c, problem_of(c, "multi", "", false)).wrenches.off(p["multi"]) <= 2e-12);
    CHECK(said_of(c, problem_of(c, "closest", "", false)).wrenches.off(p["closest"], unique) <= 2e-12);
    CHECK(said_of(c, problem_of(c, "closest", "kernel = \"printed\"\n", false)).wrenches.off(p["closest_printed_law"], unique) <= 2e-12);
  }
  const ReferenceCase c = reference_case("walls");
  const Said said = said_of(c, problem_of(c, "multi", "", true));
  CHECK(said.wrenches.off(c.expected["potential"]["walls"]) <= 1e-12);
  CHECK(said.json["energy"]["wall"].get<double>() == said.wrenches.energy);
}

TEST_CASE("the files name every mistake of bodies with its line", "[study][rounded][lammps_data]") {
  const ScratchDirectory scratch;
  std::string data = text_of(std::string(ELAMIN_ROOT) + "/data/polyhedra/walls/data.bodies");
  const auto change = [&](const std::string& what, const std::string& by) {
    const std::size_t at = data.find(what);
    REQUIRE(at != std::string::npos);
    data.replace(at, what.size(), by);
  };
  change("3 2 1 0   4 5 6 7", "3 2 0 1   4 5 6 7"), change("1 0 0\n0.064", "1 0 0\n-0.064");
  const std::string file = scratch.file("x.data", data);
  const Answer answer = elamin_says("check '" + scratch.file("p.toml", "[lammps]\ndata = \"x.data\"\n\n[study]\ntype = \"energy\"\n") + "'");
  CHECK(answer.status == 1);
  INFO(answer.text);
  CHECK(answer.text.find("x.data:23:1: Bodies: body 2: the inertia") != std::string::npos);
  CHECK(answer.text.find("x.data:28:1: Bodies: body 3: face 0 has no area") != std::string::npos);
}
