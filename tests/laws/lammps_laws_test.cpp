// The laws alone, summed by plain loops over every pair and every wall, against what LAMMPS says.
#include "catch.hpp"
#include "laws/cohesion.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/harmonic_bond.hpp"
#include "laws/hertz_contact.hpp"
#include "laws/wall_sites.hpp"
#include "lammps/data.hpp"
#include "matrices.hpp"
#include "reference.hpp"

#include <map>
#include <set>

using namespace elamin;
using nlohmann::json;

namespace {

Vec3 vector(const json& v) { return {v[0].get<double>(), v[1].get<double>(), v[2].get<double>()}; }

Region region_of(const json& j) {
  static const std::map<std::string, Shape> shapes{{"plane", Shape::plane},
                                                   {"block", Shape::block},
                                                   {"cylinder", Shape::cylinder},
                                                   {"sphere", Shape::sphere},
                                                   {"cone", Shape::cone}};
  Region r;
  r.shape = shapes.at(j["shape"]);
  if (r.shape == Shape::plane) r.center = vector(j["point"]), r.normal = vector(j["normal"]).normalized();
  if (r.shape == Shape::sphere) r.center = vector(j["center"]), r.radius = j["radius"];
  if (r.shape == Shape::block) r.lo = vector(j["lo"]), r.hi = vector(j["hi"]);
  if (r.shape == Shape::cylinder || r.shape == Shape::cone) {
    r.axis = j["axis"].get<std::string>()[0] - 'x';
    const int first = r.axis == 0 ? 1 : 0, second = r.axis == 2 ? 1 : 2;
    r.center[first] = j["center"][0], r.center[second] = j["center"][1];
    r.axial_lo = j["lo"], r.axial_hi = j["hi"];
    r.radius = j.value("radius", 0.0), r.radius_lo = j.value("radius_lo", 0.0), r.radius_hi = j.value("radius_hi", 0.0);
  }
  for (const int face : j.value("open", std::vector<int>{})) r.open[face - 1] = true;
  return r;
}

// The table entry that holds for a pair of types: the last one.
json pair_entry(const json& table, int i, int j) {
  json found;
  const auto fits = [](const json& type, int t) { return type.is_string() || type.get<int>() == t; };
  for (const json& e : table)
    if ((fits(e["i"], i) && fits(e["j"], j)) || (fits(e["i"], j) && fits(e["j"], i))) found = e;
  return found;
}

struct Case {
  json c, expected;
  LammpsData data;
  std::set<std::pair<int, int>> bonded;

  explicit Case(const std::string& name)
      : c(reference("lammps/" + name + "/case.json")), expected(reference("lammps/" + name + "/expected.json")),
        data(read_lammps_data(std::string(ELAMIN_ROOT) + "/data/lammps/" + name + "/case.data")) {
    for (const Bond& b : data.bonds) bonded.insert(std::minmax(b.particles[0], b.particles[1]));
  }

  int particles() const { return static_cast<int>(data.id.size()); }
  bool is_bonded(int i, int j) const { return bonded.count(std::minmax(i, j)) > 0; }
  double radius(int i) const { return data.diameter[i] / 2; }

  template <std::size_t n>
  Points<static_cast<int>(n)> at(const std::array<int, n>& sites) const {
    Points<static_cast<int>(n)> x;
    for (std::size_t k = 0; k < n; ++k) x.position.col(k) = data.position.col(sites[k]);
    return x;
  }
};

struct Sums {
  ExactSum bond, angle, granular, lj, wall;
  Field force, wall_force, wall_normal_force;  // −∇U of all but the walls; of the walls; the walls' along their normals
  int pair_contacts = 0, wall_contacts = 0;
};

template <class L, std::size_t n>
double add(const L& law, const Case& k, const std::array<int, n>& sites, Field& force) {
  const auto u = law.derivatives(k.at(sites));
  for (std::size_t i = 0; i < n; ++i) force.col(sites[i]) -= u.gradient.template segment<3>(3 * i);
  return u.value;
}

void add_pairs(const Case& k, bool bonded_pairs_touch, Sums& sums) {
  for (int i = 0; i < k.particles(); ++i)
    for (int j = i + 1; j < k.particles(); ++j) {
      const int a = k.data.type[i], b = k.data.type[j];
      if (k.c.contains("granular") && (bonded_pairs_touch || !k.is_bonded(i, j))) {
        const double E = pair_entry(k.c["granular"]["pairs"], a, b)["E_eff"];
        const HertzContact contact{hertz_stiffness(E, k.radius(i), k.radius(j)), k.radius(i) + k.radius(j)};
        const double u = add(contact, k, std::array{i, j}, sums.force);
        sums.granular.add(u);
        sums.pair_contacts += u > 0;
      }
      if (k.c.contains("lj") && !k.is_bonded(i, j)) {
        const json e = pair_entry(k.c["lj"]["pairs"], a, b);
        sums.lj.add(add(Cohesion{e["epsilon"], e["sigma"], e["cutoff"]}, k, std::array{i, j}, sums.force));
      }
    }
}

void add_walls(const Case& k, Sums& sums) {
  for (const json& w : k.c.value("walls", json::array())) {
    const WallContact wall{region_of(w["region"]), w["region"]["side"] == "in", w["E_eff"], true};
    std::set<int> atoms;
    if (w["atoms"].is_array()) atoms = w["atoms"].get<std::set<int>>();
    for (int i = 0; i < k.particles(); ++i) {
      if (!atoms.empty() && !atoms.count(k.data.id[i])) continue;
      const ExactVector x{k.data.position.col(i), Vec3::Zero()};
      const Local<1> u = wall.derivatives(x, k.radius(i));
      sums.wall.add(u.value);
      sums.wall_force.col(i) -= u.gradient;
      sums.wall_normal_force.col(i) += touch_force(wall, x, k.radius(i));
      std::array<WallTouch, WallContact::most_faces> touch;
      const int count = wall.touches(x, k.radius(i), 0, touch);
      sums.wall_contacts += count;
      for (int f = 0; f < count; ++f) {        // each is one of the listed contacts
        int found = 0;
        for (const json& known : k.expected["wall_contacts"]) {
          if (known["wall"] != w["id"] || known["atom"] != k.data.id[i]) continue;
          if ((vector(known["normal"]) - touch[f].normal).norm() > 1e-9) continue;
          ++found;
          CHECK(-touch[f].gap == Approx(known["delta"].get<double>()).epsilon(1e-12).margin(1e-15 * k.data.diameter[i]));
          CHECK(touch[f].effective_radius == Approx(known["R_eff"].get<double>()).epsilon(1e-14));
        }
        CHECK(found == 1);
      }
    }
  }
}

Sums sums_of(const Case& k, bool bonded_pairs_touch) {
  Sums sums;
  sums.force = sums.wall_force = sums.wall_normal_force = Field::Zero(3, k.particles());
  for (const Bond& b : k.data.bonds) {
    const BondType& t = k.data.bond_types[b.type];
    sums.bond.add(add(HarmonicBond{t.stiffness, t.rest_length}, k, b.particles, sums.force));
  }
  for (const Angle& a : k.data.angles) {
    const AngleType& t = k.data.angle_types[a.type];
    sums.angle.add(add(CosineAngle(t.stiffness, t.rest), k, a.particles, sums.force));
  }
  add_pairs(k, bonded_pairs_touch, sums);
  add_walls(k, sums);
  for (const json& l : k.c.value("loads", json::array()))                 // here: gravity on all
    for (int i = 0; i < k.particles(); ++i)
      sums.force.col(i) += k.data.density[i] * pi / 6 * std::pow(k.data.diameter[i], 3) * vector(l["acceleration"]);
  return sums;
}

Field forces_of(const json& rows) {
  Field f(3, rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) f.col(i) = Vec3(rows[i][1], rows[i][2], rows[i][3]);
  return f;
}

}  // namespace

TEST_CASE("contacts, cohesion and walls are LAMMPS's", "[laws][reference]") {
  for (const std::string name :
       {"gran_bonded_included", "gran_mixed_types", "gran_packing_lj", "gran_packing_si", "gran_pairs", "gran_wound_chain",
        "overlay_chains", "overlay_cohesive_sheet", "wall_beam_corner", "wall_block_in", "wall_block_out", "wall_cone_in",
        "wall_cone_out", "wall_cylinder_in", "wall_cylinder_open", "wall_cylinder_out", "wall_planes", "wall_spheres"}) {
    INFO(name);
    const Case k(name);
    const json granular = k.c["granular"];
    const Sums sums = sums_of(k, granular["bonded_pairs"] != "excluded");
    const json lammps = k.expected["energy_lammps"], computed = k.expected["energy_computed"];
    const auto agree = [](const ExactSum& sum, const json& energies, const char* term) {
      if (energies.contains(term)) CHECK(sum.value() == Approx(energies[term].get<double>()).epsilon(1e-12).margin(0));
    };
    agree(sums.bond, lammps, "bond"), agree(sums.angle, lammps, "angle"), agree(sums.lj, lammps, "lj");
    agree(sums.granular, computed, "granular"), agree(sums.wall, computed, "wall");
    CHECK(sums.pair_contacts == static_cast<int>(k.expected["pair_contacts"].size()));
    CHECK(sums.wall_contacts == static_cast<int>(k.expected.value("wall_contacts", json::array()).size()));

    const Field known = forces_of(k.expected["forces"]);
    CHECK(largest(sums.force + sums.wall_normal_force - known) <= 1e-12 * largest(known));
    const double off = largest(sums.force + sums.wall_force - known) / largest(known);
    if (name.find("cone") == std::string::npos) {
      CHECK(off <= 1e-12);
    } else {                                   // LAMMPS leaves the derivative of R_eff out
      CHECK(off > 1e-4);
      CHECK(off < 8e-4);
    }
  }
}

TEST_CASE("without contact of bonded pairs the forces are those of the later LAMMPS", "[laws][reference]") {
  const Case k("gran_bonded_included");
  const Field known = forces_of(k.expected["later_release"]["forces"]);
  CHECK(largest(sums_of(k, false).force - known) <= 1e-12 * largest(known));
}

TEST_CASE("smooth cohesion agrees with LAMMPS's lj/smooth", "[laws][reference]") {
  const json c = reference("lammps/lj_smooth.json");
  const Cohesion cohesion{c["epsilon"], c["sigma"], c["cutoff"], CutoffStyle::smooth, c["inner_cutoff"]};
  const double rounding = 4 * epsilon * std::abs(cohesion.shell().force) * (cohesion.cutoff - cohesion.inner);      // LAMMPS's: differences of a polynomial
  for (const json& pair : c["pairs"]) {                          // printed to 15 digits
    Eigen::Matrix<double, 3, 2> x = Eigen::Matrix<double, 3, 2>::Zero();
    x(0, 1) = pair["distance"];
    Local<2> u = cohesion.derivatives(Points<2>(x));
    CHECK(std::abs(u.value - pair["energy"].get<double>()) <= 1e-14 * std::abs(u.value) + rounding);
    CHECK(std::abs(-u.force_part(1)[0] - pair["force"].get<double>()) <= 1e-14 * std::abs(u.force_part(1)[0]));
  }
}
