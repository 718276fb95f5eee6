#include "lammps/script/particles.hpp"

#include "lammps/state.hpp"
#include "laws/section.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>

namespace elamin::script {
namespace {

/// Glue that is in some run between atoms that are.
template <int N> bool used(const Glue<N>& g, int runs) { return g.gone > g.born && g.born < std::max(1, runs) && g.gone > 0; }

}  // namespace

Particles::Particles(const World& world) : world_(world), id_(world.atoms.size()) {
  std::set<int> taken, types, of_bodies;
  int next = 1;
  const int runs = std::max(1, world.run_number());
  for (const Atom& a : world.atoms) next = std::max(next, a.id + 1);
  for (std::size_t i = 0; i < world.atoms.size(); ++i) {
    const Atom& a = world.atoms[i];
    if (a.born >= runs || a.gone <= a.born) continue;
    atoms_.push_back(static_cast<int>(i));
    id_[i] = taken.insert(a.id).second ? a.id : next++;
    bodies_ += a.is_body;
    types.insert(a.type);
    if (a.is_body) of_bodies.insert(a.type);
  }
  types_.assign(types.begin(), types.end()), body_types_.assign(of_bodies.begin(), of_bodies.end());
}

std::string Particles::data(const std::string& title, const std::map<int, double>& stiffer, bool velocities) const {
  fmt::memory_buffer text;
  const auto put = [&](fmt::string_view format, const auto&... values) {
    fmt::vformat_to(std::back_inserter(text), format, fmt::make_format_args(values...));
  };
  std::vector<int> order;
  std::copy_if(atoms_.begin(), atoms_.end(), std::back_inserter(order), [&](int i) { return !world_.atoms[i].is_body; });
  std::sort(order.begin(), order.end(), [&](int i, int j) { return id(i) < id(j); });
  Field x(3, static_cast<Eigen::Index>(order.size()));
  std::vector<double> diameter;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Atom& a = world_.atoms[order[k]];
    x.col(static_cast<Eigen::Index>(k)) = a.start;
    diameter.push_back(a.diameter);
  }
  const int runs = world_.run_number();
  std::map<int, int> bond_types, angle_types;   // the script's numbers → those of the file
  std::size_t bonds = 0, angles = 0;
  for (const auto& b : world_.bonds)
    if (used(b, runs)) bond_types[b.type], ++bonds;
  for (const auto& a : world_.angles)
    if (used(a, runs)) angle_types[a.type], ++angles;
  for (auto* types : {&bond_types, &angle_types}) {
    int n = 0;
    for (auto& [type, number] : *types) number = ++n;
  }
  const auto coefficient = [&](const auto& of_run, int type, const auto& now) {
    for (const Run& run : world_.runs)
      if (const auto found = (run.*of_run).find(type); found != (run.*of_run).end()) return found->second;
    return (world_.*now)(type);
  };
  bool straight = true;
  for (const auto& [type, number] : angle_types)
    straight = straight && coefficient(&Run::angles, type, &World::of_angles).rest == pi;

  put("{}\n\n{} atoms\n{} bonds\n{} angles\n{} atom types\n{} bond types\n{} angle types\n\n", title, order.size(), bonds, angles,
      types_.back(), bond_types.size(), angle_types.size());
  const Box box = box_around(x, diameter);
  for (int c = 0; c < 3; ++c) put("{:.17g} {:.17g} {}lo {}hi\n", box.lo[c], box.hi[c], "xyz"[c], "xyz"[c]);
  const bool masses =
      !world_.sphere && std::all_of(types_.begin(), types_.end(), [&](int t) { return world_.mass[t - 1] > 0; });
  if (masses) {
    put("\nMasses\n\n");
    for (int t = 1; t <= types_.back(); ++t)
      put("{} {:.17g}\n", t, world_.mass[t - 1] > 0 ? world_.mass[t - 1] : 1.0);
  }
  if (!bond_types.empty()) put("\nBond Coeffs # harmonic\n\n");
  for (const auto& [type, number] : bond_types) {
    const Coefficient c = coefficient(&Run::bonds, type, &World::of_bonds);
    put("{} {:.17g} {:.17g}\n", number, c.stiffness, c.rest);
  }
  if (!angle_types.empty()) put("\nAngle Coeffs # {}\n\n", straight ? "cosine" : "cosine/shift");
  for (const auto& [type, number] : angle_types) {
    const Coefficient c = coefficient(&Run::angles, type, &World::of_angles);
    const auto factor = stiffer.find(type);
    const double B = c.stiffness * (factor == stiffer.end() ? 1 : factor->second);
    if (straight) put("{} {:.17g}\n", number, B);
    else put("{} {:.17g} {:.17g}\n", number, 2 * B, degrees(c.rest));
  }
  const char* style = world_.sphere ? "hybrid sphere angle" : world_.molecular ? "angle" : "atomic";
  put("\nAtoms # {}\n\n", style);
  for (const int i : order) {
    const Atom& a = world_.atoms[i];
    const Vec3& p = a.start;
    if (world_.sphere)
      put("{} {} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {}\n", id(i), a.type, p[0], p[1], p[2], a.diameter, a.density, a.molecule);
    else if (world_.molecular) put("{} {} {} {:.17g} {:.17g} {:.17g}\n", id(i), a.molecule, a.type, p[0], p[1], p[2]);
    else put("{} {} {:.17g} {:.17g} {:.17g}\n", id(i), a.type, p[0], p[1], p[2]);
  }
  const auto moves = [](const Atom& a) { return !a.start_v.isZero(0) || !a.omega.isZero(0); };
  const bool move =
      velocities && std::any_of(order.begin(), order.end(), [&](int i) { return moves(world_.atoms[i]); });
  if (move) {
    put("\nVelocities # {}\n\n", style);
    for (const int i : order) {
      const Vec3 &v = world_.atoms[i].start_v, &w = world_.atoms[i].omega;
      put("{} {:.17g} {:.17g} {:.17g}", id(i), v[0], v[1], v[2]);
      if (world_.sphere) put(" {:.17g} {:.17g} {:.17g}", w[0], w[1], w[2]);
      put("\n");
    }
  }
  if (bonds > 0) put("\nBonds\n\n");
  std::size_t n = 0;
  for (const auto& b : world_.bonds)
    if (used(b, runs)) put("{} {} {} {}\n", ++n, bond_types[b.type], id(b.atoms[0]), id(b.atoms[1]));
  if (angles > 0) put("\nAngles\n\n");
  n = 0;
  for (const auto& a : world_.angles)
    if (used(a, runs)) put("{} {} {} {} {}\n", ++n, angle_types[a.type], id(a.atoms[0]), id(a.atoms[1]), id(a.atoms[2]));
  return {text.data(), text.size()};
}

}  // namespace elamin::script
