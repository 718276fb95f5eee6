#include "energy/groups.hpp"

#include "energy/wall_group.hpp"
#include "laws/cohesion.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/harmonic_bond.hpp"

#include <numeric>

namespace elamin {

namespace {

// A law of its own for every pair.
template <class L, class Make>
std::unique_ptr<ElementGroup> pair_group(const std::vector<IndexPair>& pairs, const Make& law_of) {
  std::vector<L> laws;
  std::vector<int> kind(pairs.size());
  std::vector<std::array<int, 2>> stencils;
  std::iota(kind.begin(), kind.end(), 0);
  for (const auto& [i, j] : pairs) laws.push_back(law_of(i, j)), stencils.push_back({i, j});
  return std::make_unique<LawGroup<L>>(std::move(laws), std::move(kind), std::move(stencils));
}

}  // namespace

std::unique_ptr<ElementGroup> bond_group(const Model& model) {
  std::vector<HarmonicBond> laws;
  for (const BondType& t : model.bond_types) laws.push_back({t.stiffness, t.rest_length});
  std::vector<int> kind;
  std::vector<std::array<int, 2>> stencils;
  for (const Bond& b : model.bonds) kind.push_back(b.type), stencils.push_back(b.particles);
  return std::make_unique<LawGroup<HarmonicBond>>(std::move(laws), std::move(kind), std::move(stencils));
}

std::unique_ptr<ElementGroup> angle_group(const Model& model) {
  std::vector<CosineAngle> laws;
  for (const AngleType& t : model.angle_types) laws.push_back(CosineAngle{t.stiffness, t.rest});
  std::vector<int> kind;
  std::vector<std::array<int, 3>> stencils;
  for (const Angle& a : model.angles) kind.push_back(a.type), stencils.push_back(a.particles);
  return std::make_unique<LawGroup<CosineAngle>>(std::move(laws), std::move(kind), std::move(stencils));
}

HertzContact hertz_contact(const Model& model, int table, int i, int j) {
  const double ri = model.diameter[i] / 2, rj = model.diameter[j] / 2;
  return {hertz_stiffness(model.contacts[table].effective_modulus, ri, rj), ri + rj};
}

std::unique_ptr<ElementGroup> contact_group(const Model& model, const Neighbours& neighbours) {
  return pair_group<HertzContact>(neighbours.hertz(), [&](int i, int j) {
    return hertz_contact(model, neighbours.rules().hertz(i, j), i, j);
  });
}

std::unique_ptr<ElementGroup> cohesion_group(const Model& model, const Neighbours& neighbours) {
  return pair_group<Cohesion>(neighbours.lj(), [&](int i, int j) {
    const PairContact& t = model.contacts[neighbours.rules().lj(i, j)];
    return Cohesion{t.epsilon, t.sigma, t.cutoff};
  });
}

std::unique_ptr<ElementGroup> wall_group(const Model& model) { return std::make_unique<WallGroup>(model); }

}  // namespace elamin
