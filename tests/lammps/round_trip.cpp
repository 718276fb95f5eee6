// Problems through LAMMPS's script and back: the same energies, forces, loads, driven ends and walls.
#include "catch.hpp"
#include "lammps/script_reading.hpp"
#include "lammps/stage_walk.hpp"
#include "study/program.hpp"

#include <cmath>
#include <filesystem>
#include <map>

using namespace elamin;

namespace {

/// What export says of the files that it refuses; the last two name states that are not there.
const std::vector<std::pair<std::string, std::vector<std::string>>> refusals{
    {"rigid bodies (",
     {"problems/box_tips", "problems/boxes_stacked", "problems/cube_dropped", "problems/cubes_cohesive", "problems/cubes_jammed",
      "problems/rod_leaning", "tests/input/good/bodies", "tests/input/good/falling"}},
    {"it is hard; LAMMPS has elastic ones",
     {"problems/column_hard_walls", "problems/ring_hard_plates"}},
    {"its effective radius is the particle's; LAMMPS's has the wall's curvature in it",
     {"problems/confined_d_cone", "problems/studies/confined_d_cone_coarse", "tests/input/good/structures"}},
    {"coefficients that vary with the load factor",
     {"problems/disc_clamped", "problems/disc_hinged", "problems/plate_growing", "tests/input/good/everything"}},
    {"LAMMPS has no force that stays normal to a row or a sheet",
     {"problems/plate_pressure", "problems/ring_pressure", "problems/ring_pressure_links", "problems/tube_pressure",
      "tests/input/good/stages"}},
    {"contact of 1350 particles that leaves out pairs that are glued closely",
     {"problems/studies/cylindrical_sheet", "problems/studies/cylindrical_sheet_free"}},
    {"what is added or taken away as it begins",
     {"problems/studies/middle_glued", "problems/studies/on_top_cohesive", "problems/studies/on_top_glued", "tests/input/good/staged",
      "tests/input/good/staged_body"}},
    {"is not the directory of a run", {"tests/input/good/landscape"}},
    {"imperfection",
     {"tests/input/good/shapes", "tests/input/good/shapes_state"}}};

std::vector<std::string> problem_files() {
  std::vector<std::string> files;
  for (const char* folder : {"problems", "problems/static", "problems/studies", "tests/lammps/export", "tests/input/good"})
    for (const auto& entry : std::filesystem::directory_iterator(std::string(ELAMIN_ROOT "/") + folder))
      if (entry.path().extension() == ".toml") files.push_back(std::filesystem::relative(entry.path(), ELAMIN_ROOT).string());
  std::sort(files.begin(), files.end());
  return files;
}

/// Drag on each particle.
std::vector<double> drag(const Model& m) {
  std::vector<double> all(static_cast<std::size_t>(m.particles()));
  for (const Viscosity& v : m.viscosity)
    for (const int p : v.particles) all[static_cast<std::size_t>(p)] += v.coefficient;
  return all;
}

}  // namespace

TEST_CASE("what is exported and imported has the same energies and forces at each stage's begin, middle and end", "[script][export]") {
  std::map<std::string, std::string> expected;
  for (const auto& [what, files] : refusals)
    for (const std::string& name : files) expected[name + ".toml"] = what;
  for (const std::string& name : problem_files()) {
    INFO(name);
    const ScratchDirectory scratch;
    const std::string file = std::string(ELAMIN_ROOT "/") + name, script = scratch / "in.lmp";
    if (const Answer answer = elamin_says("export '" + file + "' -o '" + script + "'"); answer.status != 0) {
      INFO(answer.text);
      CHECK(answer.text.find(expected.contains(name) ? expected[name] : "no word of " + name) != std::string::npos);
      expected.erase(name);
      continue;
    }
    const Problem problem = read_problem(file);
    const script::Reading reading = script::read_script(script, {});
    REQUIRE(reading.passes.size() == 1);
    const script::TranslationOptions options{problem.in_time(), false, false};
    const script::Translated made = options.dynamics ? script::in_time(reading, reading.passes[0], options, {"p.data"}, {}).at(0)
                                                     : script::translated(reading, reading.passes[0], options, "p.data");
    INFO(made.toml);
    scratch.file("p.data", made.data);
    const Problem back = read_problem(scratch.file("p.toml", made.toml));
    StageWalk ours(problem), theirs(back);
    REQUIRE(ours.count() == theirs.count());
    for (int k = 0; k < ours.count(); ++k) {
      INFO("stage " << k);
      ours.enter(), theirs.enter();
      const Model &m = ours.model(), &n = theirs.model();
      REQUIRE(m.id == n.id);
      CHECK(m.diameter == n.diameter);
      if (problem.in_time()) {
        CHECK(drag(m) == drag(n));
        CHECK((m.velocity.cols() == 0 ? n.velocity.isZero(0) : m.velocity == n.velocity));
      }
      for (const double part : {0.0, 0.5, 1.0}) {
        INFO("part " << part);
        const StageWalk::There a = ours.at(part), b = theirs.at(part);
        // ε of places, as driven ends go by way of velocities, and of rest angles, by way of degrees; K and B make forces of it.
        const double eps = 2.3e-16, far = a.position.cwiseAbs().maxCoeff();
        double K = 0, B = 0, count = static_cast<double>(m.bonds.size() + m.angles.size());
        for (const BondType& t : m.bond_types) K = std::max(K, t.stiffness);
        for (const BondType& t : m.bond_types) for (const AngleType& u : m.angle_types) B = std::max(B, u.stiffness / t.rest_length);
        CHECK((a.position - b.position).cwiseAbs().maxCoeff() <= 4 * eps * far);
        const double largest = a.forces.size() ? a.forces.colwise().norm().maxCoeff() : 0, rounding = 4 * eps * (2 * K * far + 2 * B);
        CHECK((a.forces - b.forces).colwise().norm().maxCoeff() <= 1e-12 * largest + rounding);
        CHECK(std::abs(a.terms.total() - b.terms.total()) <= 1e-12 * std::abs(a.terms.total()) + count * (largest + rounding) * 4 * eps * far);
      }
    }
  }
  std::string exported;
  for (const auto& [name, what] : expected) exported += name + " ";
  CHECK(exported.empty());                       // what stands in the table, and is exported
}
