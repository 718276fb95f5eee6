// Export to LAMMPS: the data file read back, the script's commands, which pairs its types let feel each other, and what is refused.
#include "catch.hpp"
#include "energy/contact_rules.hpp"
#include "energy/energy.hpp"
#include "input/build.hpp"
#include "input/read.hpp"
#include "lammps/data.hpp"
#include "lammps/export.hpp"
#include "lammps/state.hpp"
#include "scratch_directory.hpp"
#include "study/program.hpp"
#include "study/trace.hpp"

#include <filesystem>
#include <map>
#include <regex>
#include <set>

using namespace elamin;

namespace {

const std::string root = ELAMIN_ROOT "/";
const std::vector<std::string> exported{
    "tests/lammps/export/cohesion_cut", "tests/lammps/export/walls",       "tests/lammps/export/motion", "problems/column_self_contact", "problems/two_beams",
    "problems/loop_squeezed",           "problems/static/equation_06",     "problems/arch_flipped",      "problems/sheet_indented",      "problems/studies/mushroom",
    "problems/studies/settling_column", "problems/static/hanging_chain"};

bool has(const std::string& text, const std::string& line) { return ("\n" + text).find("\n" + line) != std::string::npos; }

Model as_read(const std::string& file) {
  LammpsData data = read_lammps_data(file);
  Model m;
  m.start = State(data.position);
  m.id = data.id, m.type = data.type, m.molecule = data.molecule, m.diameter = data.diameter, m.density = data.density;
  m.bond_types = data.bond_types, m.angle_types = data.angle_types, m.bonds = data.bonds, m.angles = data.angles;
  return m;
}

}  // namespace

TEST_CASE("an exported data file holds the same model: energies of bonds and angles, masses, places", "[export]") {
  for (const std::string& name : exported) {
    INFO(name);
    ScratchDirectory scratch;
    const Answer answer = elamin_says("export " + root + name + ".toml -o " + scratch / "in.lmp");
    INFO(answer.text);
    REQUIRE(answer.status == 0);
    const Problem problem = read_problem(root + name + ".toml");
    const Model own = build_model(problem), back = as_read(scratch / "in.data");
    Energy before(own), after(back);
    const State start = starting_state(problem, before);
    State state(start.position);                             // without tails, which no data file has
    REQUIRE(back.start.position == state.position);
    CHECK((back.id == own.id && back.diameter == own.diameter && back.molecule == own.molecule));
    CHECK(back.bonds.size() == own.bonds.size());
    const EnergyTerms a = before.terms(state), b = after.terms(back.start);
    CHECK(a.bond == b.bond);
    CHECK(std::abs(a.angle - b.angle) <= 1e-15 * a.angle);   // rest angles go by way of degrees
    if (straight_at_rest(own)) CHECK(a.angle == b.angle);
  }
}

TEST_CASE("types of an export let exactly those pairs feel each other that the contacts mean", "[export]") {
  for (const std::string& name : exported) {
    INFO(name);
    const Model model = build_model(read_problem(root + name + ".toml"));
    const ExportTypes types = export_types({&model});
    CHECK(types.refused.empty());
    REQUIRE(types.type.size() == static_cast<std::size_t>(model.particles()));
    CHECK(*std::max_element(types.type.begin(), types.type.end()) == types.count);
    const ContactRules rules(model);
    if (!rules.any()) continue;
    // Bonds between two particles, as special_bonds counts them.
    std::map<std::array<int, 2>, int> near;
    std::vector<std::set<int>> next(types.type.size());
    for (const Bond& b : model.bonds) next[b.particles[0]].insert(b.particles[1]), next[b.particles[1]].insert(b.particles[0]);
    for (int i = 0; i < model.particles(); ++i) {
      std::set<int> front{i}, seen{i};
      for (int bonds = 1; bonds <= types.stages[0].special; ++bonds) {
        std::set<int> after;
        for (const int p : front)
          for (const int j : next[p])
            if (seen.insert(j).second) after.insert(j), near[{i, j}] = bonds;
        front = after;
      }
    }
    int wrong = 0;
    for (int i = 0; i < model.particles(); ++i)
      for (int j = i + 1; j < model.particles(); ++j) {
        const auto& rule = types.rule(0, types.type[i], types.type[j]);
        const int hertz = rules.hertz(i, j), lj = near.count({i, j}) ? -1 : rule.lj;
        const bool none = hertz >= 0 && model.contacts[hertz].effective_modulus == 0;
        wrong += rule.hertz != (none ? -1 : hertz) || lj != rules.lj(i, j);
        wrong += types.rule(0, types.type[j], types.type[i]).hertz != rule.hertz;
      }
    CHECK(wrong == 0);
  }
  // Particles with no reason to differ keep the types of the model.
  const Model plain = build_model(read_problem(root + "problems/column_cylindrical.toml"));
  CHECK(export_types({&plain}).type == plain.type);
  // Too many particles that need a type of their own.
  const Model folded = build_model(read_problem(root + "problems/column_self_contact.toml"));
  CHECK(export_types({&folded}, 20).refused.size() == 1);
}

TEST_CASE("an exported script says walls, contact, supports and loads in LAMMPS's words", "[export]") {
  ScratchDirectory scratch;
  REQUIRE(elamin_says("export " + root + "tests/lammps/export/walls.toml -o " + scratch / "in.lmp").status == 0);
  const std::string walls = text_of(scratch / "in.lmp");
  CHECK(has(walls, "read_data in.data\n"));
  CHECK(has(walls, "region wall_below plane 0 0 0.0009 0 0 1 side out units box\n"));
  CHECK(has(walls, "region wall_box block 0.09 0.11 0.09 0.11 0.09 0.11 side in units box move v_wall_box_x NULL v_wall_box_z open 1\n"));
  CHECK(has(walls, "variable wall_box_x equal ramp(0,-0.0001)\n"));
  CHECK(has(walls, "region wall_curved_tube cylinder z 0.7 0.7 v_wall_curved_tube_radius INF INF side in units box\n"));
  // E_eff = E/2 with nu = 0; of the plane wall with E = 1e6 and ν = 0.3 that is 2 · 1e6/(2 · 0.91).
  CHECK(has(walls, "fix wall_floor on_planes wall/gran/region granular hertz/material 1098901.098901099 0 0 tangential linear_nohistory 0 "
                   "0 damping velocity region wall_floor"));
  CHECK(has(walls, "fix wall_bowl in_bowl wall/gran/region granular hertz/material 2000000 0 0 tangential"));

  // Pairs that are left out have a law without force: `none` would not keep LAMMPS's hybrid styles from it.
  REQUIRE(elamin_says("export " + scratch.file("beam.toml", "[[beam]]\nname = \"s\"\nparticles = 3\nfrom = [0, 0, 0]\nto = [2, 0, 0]\n"
      "diameter = 1.2\nthickness = 1.0\nyoungs_modulus = 100\ndensity = 1\n[[contact]]\nbetween = [\"s\", \"s\"]\n"
      "youngs_modulus = 1000\npoissons_ratio = 0.3\n[[support]]\ngroup = \"s\"\n[study]\ntype = \"energy\"\n") +
      " -o " + scratch / "in.lmp").status == 0);
  const std::string beam = text_of(scratch / "in.lmp");
  CHECK(has(beam, "pair_style granular\npair_coeff * * hertz/material "));
  CHECK(has(beam, "pair_coeff 1 2 hertz 0 0 tangential linear_nohistory 0 0\npair_coeff 2 3 hertz 0 0 tangential linear_nohistory 0 0\n"));

  REQUIRE(elamin_says("export " + root + "tests/lammps/export/cohesion_smooth.toml -o " + scratch / "in.lmp").status == 0);
  const std::string cohesion = text_of(scratch / "in.lmp");
  CHECK(has(cohesion, "special_bonds lj 0 0 0 coul 1 1 1"));
  CHECK(has(cohesion, "pair_style hybrid/overlay granular lj/smooth "));
  CHECK(has(cohesion, "pair_modify pair lj/smooth shift yes\n"));
  CHECK(cohesion.find(" lj/smooth 1e-06 0.0009 0.0012 0.0025\n") != std::string::npos);
  CHECK(has(cohesion, "fix load_other_chain other_chain addforce 0 0 -0.00125"));      // 1e-2 shared by 8, constant
  CHECK(has(cohesion, "fix load_chain chain addforce 0 v_load_chain_y 0"));
  CHECK(has(cohesion, "variable load_chain_y equal ramp(0,0.001)\n"));

  REQUIRE(elamin_says("export " + root + "tests/lammps/export/cohesion_cut.toml -o " + scratch / "in.lmp").status == 0);
  const std::string cut = text_of(scratch / "in.lmp");                                  // away from an axis: of every particle its own
  CHECK(has(cut, "fix load_chain_2 chain addforce 0 v_load_chain_2_y v_load_chain_2_z "));
  CHECK(has(cut, "variable load_chain_2_y_each atomfile in.load_chain_2_y\n"));
  CHECK(has(cut, "variable load_chain_2_y atom v_load_chain_2_y_each*ramp(0,1)\n"));
  CHECK(lines_of(text_of(scratch / "in.load_chain_2_y")).size() == 2 + 12);

  REQUIRE(elamin_says("export " + root + "tests/lammps/export/motion.toml -o " + scratch / "in.lmp").status == 0);
  const std::string motion = text_of(scratch / "in.lmp");
  CHECK(has(motion, "fix support_left left move linear 0 0 0.01 "));
  CHECK(has(motion, "fix drag_2 beam viscous 1e-05 "));
  CHECK(has(motion, "timestep 1e-06\n"));
  CHECK(has(motion, "run 1000\n"));
  CHECK(motion.find("hertz/material 1098901.098901099 0.5 0 tangential linear_nohistory 0.5 0.3 damping tsuji\n") != std::string::npos);
  CHECK(motion.find("hertz/material 2000000 100 0 tangential linear_nohistory 1 0 damping viscoelastic region "
                    "wall_floor") != std::string::npos);
}

TEST_CASE("stages of an exported script undo what they do not go on with, and define everything once", "[export]") {
  for (const char* name : {"problems/arch_flipped", "problems/arch_buckled", "problems/column_self_contact"}) {
    INFO(name);
    ScratchDirectory scratch;
    REQUIRE(elamin_says("export " + root + name + ".toml -o " + scratch / "in.lmp").status == 0);
    std::set<std::string> fixes, groups{"all"}, regions, variables;
    const std::regex used(" v_([A-Za-z0-9_]+)");
    int runs = 0;
    for (std::string line : lines_of(text_of(scratch / "in.lmp"))) {
      line = line.substr(0, line.find('#'));
      std::istringstream in(line);
      std::string command, id, group;
      in >> command >> id >> group;
      INFO(line);
      if (command == "group") CHECK(groups.insert(id).second);
      if (command == "region") CHECK(regions.insert(id).second);
      if (command == "fix") CHECK((fixes.insert(id).second && groups.count(group)));
      if (command == "unfix") CHECK(fixes.erase(id) == 1);
      if (command == "variable") variables.insert(id);
      if (command == "run") CHECK((++runs && fixes.count("plane") && fixes.count("motion") && fixes.count("damping")));
      for (std::sregex_iterator at(line.begin(), line.end(), used), end; at != end; ++at) CHECK(variables.count((*at)[1]) == 1);
    }
    CHECK(runs == static_cast<int>(read_problem(root + name + ".toml").stages.size()));
  }
}

TEST_CASE("what LAMMPS cannot have is refused at once, or left out and said so", "[export]") {
  ScratchDirectory scratch;
  const std::string file = scratch.file("p.toml", R"(plane = "xy"
[[loop]]
name = "ring"
particles = 20
center = [0, 0, 0]
radius = 0.01
normal = [0, 0, 1]
section = "cylinder"
youngs_modulus = 1e6
diameter = 1e-3
[[support]]
group = "ring"
directions = "z"
[[group]]
name = "two"
of = "ring"
first = 2
[[support]]
group = "two"
[[pressure]]
loop = "ring"
pressure = 1.0
[[change]]
group = "ring"
rest_length = 0.1
[solver]
method = "ipopt"
[[wall]]
name = "lid"
group = "ring"
shape = "plane"
point = [0, 0.02, 0]
normal = [0, -1, 0]
hard = true
[path]
steps = 2
)");
  const std::string script = scratch / "out.lmp";
  const Answer refused = elamin_says("export " + file + " -o " + script);
  INFO(refused.text);
  CHECK(refused.status == 1);
  for (const char* what : {"LAMMPS cannot have pressure on 'ring'", "LAMMPS cannot have change of 'ring'",
                           "LAMMPS cannot have wall 'lid': it is hard", "--skip leaves this out"})
    CHECK(refused.text.find(what) != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(script));
  CHECK_FALSE(std::filesystem::exists(scratch / "out.data"));
  const Answer skipped = elamin_says("export " + file + " --skip -o " + script);
  INFO(skipped.text);
  CHECK(skipped.status == 0);
  const std::string text = text_of(script);
  for (const char* what : {"# Left out: pressure on 'ring'", "# Left out: change of 'ring'", "# Left out: wall 'lid'"})
    CHECK(text.find(what) != std::string::npos);
  CHECK(text.find("wall/gran") == std::string::npos);

  CHECK(elamin_says("export " + file + " --skip -o " + file).text.find("is a file that the problem is read from") != std::string::npos);
  const std::string title = scratch.file("t.toml", "title = \"two\\nquit\"\n[[grains]]\nname = \"a\"\npositions = [[0, 0, 0]]\ndiameter = 1\n"
                                                   "[study]\ntype = \"energy\"\n");
  REQUIRE(elamin_says("export " + title + " -o " + script).status == 0);
  CHECK(text_of(script).starts_with("# two quit\n"));
  for (const std::string end : {".lmp", ".data"}) {             // somebody's own
    const std::string mine = scratch.file("mine" + end, "mine\n"), how = "export " + title + " -o " + (scratch / "mine.lmp");
    CHECK(elamin_says(how).text.find("mine" + end + ": is there already and was not written by elamin export") != std::string::npos);
    CHECK(text_of(mine) == "mine\n");
    CHECK(elamin_says(how + " --force").status == 0);
    std::filesystem::remove(scratch / "mine.lmp");
  }
  CHECK(elamin_says("export " + root + "problems/cubes_jammed.toml -o " + script).text.find("LAMMPS cannot have rigid bodies "
                                                                                            "(5)") != std::string::npos);
}
