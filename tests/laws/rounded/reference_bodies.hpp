#pragma once
// The cases of data/polyhedra: bodies from LAMMPS's data file, settings and answers from expected.json.
#include "laws/rounded/kernel.hpp"
#include "laws/rounded/carried.hpp"
#include "laws/rounded/pose.hpp"
#include "reference.hpp"

#include <filesystem>
#include <map>
#include <set>
#include <sstream>

namespace elamin {

/// A body of a data file. The box frame is the frame of the body at the start: its rotation is 1.
struct ReferenceBody {
  int type = 1;
  double mass = 1;
  Vec3 x = Vec3::Zero(), v = Vec3::Zero(), L = Vec3::Zero();
  Mat3 inertia = Mat3::Zero();
  CoreMesh core;
  double radius = 0;
};

struct ReferenceCase {
  std::string name;
  nlohmann::json expected;
  std::vector<ReferenceBody> bodies;
  std::vector<RoundedShape> shapes;            // of the bodies

  const nlohmann::json& settings() const { return expected["settings"]; }
  double setting(const char* key) const { return settings()[key].get<double>(); }
  RoundedBody body(std::size_t k) const {
    return {&shapes[k], {{bodies[k].x, Vec3::Zero()}, Eigen::Quaterniond::Identity()}};
  }

  /// The kernel of the types of two bodies.
  RoundedKernel kernel(std::size_t i, std::size_t j) const {
    for (const auto& row : settings()["pair_coeff"]) {
      const std::set<int> types{row[0].get<int>(), row[1].get<int>()};
      if (types == std::set<int>{bodies[i].type, bodies[j].type})
        return {row[2], row[3], setting("cutoff"), RoundedKernel::Form::coded};
    }
    throw std::runtime_error("no coefficients");
  }
};

inline std::vector<ReferenceBody> read_bodies(const std::string& file) {
  std::ifstream in(file);
  std::map<std::string, std::istringstream> section;
  std::string line, name = "header", text;
  const std::set<std::string> names{"Atoms", "Velocities", "Bodies"};
  std::map<std::string, std::string> all;
  while (std::getline(in, line)) {
    if (names.contains(line)) name = line;
    else all[name] += line + "\n";
  }
  std::map<int, ReferenceBody> bodies;
  const auto read = [](std::istream& s, Vec3& x) { s >> x[0] >> x[1] >> x[2]; };
  int id = 0, flag = 0;
  for (std::istringstream s(all["Atoms"]); s >> id;) {
    ReferenceBody& b = bodies[id];
    s >> b.type >> flag >> b.mass;
    read(s, b.x);
  }
  for (std::istringstream s(all["Velocities"]); s >> id;) read(s, bodies[id].v), read(s, bodies[id].L);
  for (std::istringstream s(all["Bodies"]); s >> id;) {
    ReferenceBody& b = bodies[id];
    int integers = 0, numbers = 0, vertices = 0, edges = 0, faces = 0;
    s >> integers >> numbers >> vertices >> edges >> faces;
    Mat3& I = b.inertia;
    s >> I(0, 0) >> I(1, 1) >> I(2, 2) >> I(0, 1) >> I(0, 2) >> I(1, 2);
    I = Mat3(I.selfadjointView<Eigen::Upper>());
    b.core.vertices.resize(vertices);
    for (Vec3& x : b.core.vertices) read(s, x);
    if (vertices > 2) {
      b.core.edges.resize(edges), b.core.faces.resize(faces);
      for (auto& e : b.core.edges) s >> e[0] >> e[1];
      for (auto& f : b.core.faces)
        for (int k = 0, corner = 0; k < 4; ++k)
          if (s >> corner; corner >= 0) f.push_back(corner);
    }
    s >> b.radius;
    b.radius /= 2;
  }
  std::vector<ReferenceBody> out;
  for (auto& [key, b] : bodies) out.push_back(b);
  return out;
}

inline ReferenceCase read_case(const std::string& name, const std::string& folder) {
  ReferenceCase c;
  c.name = name, c.expected = reference(folder + "/expected.json");
  c.bodies = read_bodies(std::string(ELAMIN_ROOT) + "/data/" + folder + "/data.bodies");
  for (const ReferenceBody& b : c.bodies) c.shapes.push_back(rounded_shape(b.core, b.radius));
  return c;
}

inline ReferenceCase reference_case(const std::string& name) { return read_case(name, "polyhedra/" + name); }

/// All of them, without those that move (names that begin with dyn).
inline std::vector<ReferenceCase> static_cases() {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(std::string(ELAMIN_ROOT) + "/data/polyhedra"))
    if (entry.is_directory() && !entry.path().filename().string().starts_with("dyn"))
      names.insert(entry.path().filename());
  std::vector<ReferenceCase> cases;
  for (const std::string& name : names) cases.push_back(reference_case(name));
  return cases;
}

inline Vec3 vector_of(const nlohmann::json& j) { return {j[0].get<double>(), j[1].get<double>(), j[2].get<double>()}; }

/// Energy, forces and torques of all bodies.
struct Wrenches {
  double energy = 0;
  std::vector<Vec3> forces, torques;

  explicit Wrenches(std::size_t n) : forces(n, Vec3::Zero()), torques(n, Vec3::Zero()) {}

  /// −gradient of a pair.
  void add(std::size_t i, std::size_t j, const PairLocal& u) {
    energy += u.value;
    forces[i] -= u.gradient.segment<3>(0), torques[i] -= u.gradient.segment<3>(3);
    forces[j] -= u.gradient.segment<3>(6), torques[j] -= u.gradient.segment<3>(9);
  }

  /// The largest difference from an answer's energy, forces and torques, each relative to max(1, its size).
  double off(const nlohmann::json& answer, bool with_torques = true) const {
    const double e = answer["energy"].get<double>();
    double worst = std::abs(energy - e) / std::max(1.0, std::abs(e));
    for (std::size_t k = 0; k < forces.size(); ++k) {
      const Vec3 f = vector_of(answer["forces"][k]), t = vector_of(answer["torques"][k]);
      worst = std::max(worst, (forces[k] - f).norm() / std::max(1.0, f.norm()));
      if (with_torques) worst = std::max(worst, (torques[k] - t).norm() / std::max(1.0, t.norm()));
    }
    return worst;
  }
};

/// The sum over all pairs of a law (kernel set for the pair).
template <class L>
Wrenches wrenches(const ReferenceCase& c, L law, RoundedKernel::Form form) {
  Wrenches w(c.bodies.size());
  for (std::size_t i = 0; i < c.bodies.size(); ++i)
    for (std::size_t j = i + 1; j < c.bodies.size(); ++j) {
      law.kernel = c.kernel(i, j), law.kernel.form = form;
      w.add(i, j, law.derivatives(c.body(i), c.body(j)));
    }
  return w;
}

}  // namespace elamin
