#include "energy/groups.hpp"

#include "energy/body_groups.hpp"
#include "energy/carried_group.hpp"
#include "energy/changes.hpp"
#include "energy/hard_group.hpp"
#include "energy/wall_group.hpp"
#include "laws/cohesion.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/edge_pressure.hpp"
#include "laws/harmonic_bond.hpp"
#include "laws/hertz_contact.hpp"
#include "laws/triangle_pressure.hpp"

#include <algorithm>
#include <numeric>

namespace elamin {

namespace {

std::vector<bool> glued_particles(const Model& model) {
  std::vector<bool> glued(model.particles(), false);
  for (const Glued& g : model.glued) glued[g.particle] = true;
  return glued;
}

// The elements in two groups; `laws`: as a list, or as their schedule.
template <class L, class Laws>
Parts law_groups(const Model& model, const Kinematics& kinematics, const Laws& laws, const std::vector<int>& kind,
                 const std::vector<std::array<int, L::sites>>& stencils) {
  const std::vector<bool> glued = glued_particles(model);
  std::array<std::vector<int>, 2> kinds;
  std::array<std::vector<std::array<int, L::sites>>, 2> elements;
  for (std::size_t e = 0; e < stencils.size(); ++e) {
    const bool carried = std::any_of(stencils[e].begin(), stencils[e].end(), [&](int p) { return glued[p]; });
    kinds[carried].push_back(kind[e]), elements[carried].push_back(stencils[e]);
  }
  return {std::make_unique<LawGroup<L>>(laws, std::move(kinds[0]), std::move(elements[0])),
          std::make_unique<CarriedGroup>(model, kinematics, std::make_unique<LawGroup<L>>(laws, std::move(kinds[1]), std::move(elements[1])))};
}

// A law of its own for every pair.
template <class L, class Make>
Parts pair_groups(const Model& model, const Kinematics& kinematics, const std::vector<IndexPair>& pairs, const Make& law_of) {
  std::vector<L> laws;
  std::vector<int> kind(pairs.size());
  std::vector<std::array<int, 2>> stencils;
  std::iota(kind.begin(), kind.end(), 0);
  for (const auto& [i, j] : pairs) laws.push_back(law_of(i, j)), stencils.push_back({i, j});
  return law_groups<L>(model, kinematics, laws, kind, stencils);
}

// One law a kind; where nothing changes it, it stays as it is for every load factor.
Schedule<HarmonicBond> bond_schedule(const Model& model, const Kinds& kinds, double load_factor) {
  Schedule<HarmonicBond> now;
  for (std::size_t k = 0; k < kinds.type.size(); ++k) {
    const BondType& t = model.bond_types[kinds.type[k]];
    const auto factor = [&](double Change::*part) { return change_factor(model, kinds.changes[k], part, load_factor); };
    const auto rate = [&](double Change::*part) { return change_rate(model, kinds.changes[k], part); };
    const Exact r0 = Exact{t.rest_length} * factor(&Change::rest_length);
    now.laws.push_back({t.stiffness * factor(&Change::bond_stiffness).value(), r0.hi, r0.lo});
    now.rates.push_back({t.stiffness * rate(&Change::bond_stiffness), t.rest_length * rate(&Change::rest_length)});
  }
  return now;
}

Schedule<CosineAngle> angle_schedule(const Model& model, const Kinds& kinds, double load_factor) {
  Schedule<CosineAngle> now;
  for (std::size_t k = 0; k < kinds.type.size(); ++k) {
    const AngleType& t = model.angle_types[kinds.type[k]];
    CosineAngle law(t.stiffness, t.rest, model.plane_normal.value_or(-1)), rate = law;
    law.B *= change_factor(model, kinds.changes[k], &Change::angle_stiffness, load_factor).value();
    rate.B *= change_rate(model, kinds.changes[k], &Change::angle_stiffness);
    now.laws.push_back(law), now.rates.push_back(rate);
  }
  return now;
}

// The group of a schedule that is asked only where something changes.
template <class L, class ScheduleOf>
Parts glue_groups(const Model& model, const Kinematics& kinematics, const Kinds& kinds, const std::vector<std::array<int, L::sites>>& stencils,
                  const ScheduleOf& schedule_of) {
  if (!kinds.changed()) return law_groups<L>(model, kinematics, schedule_of(model, kinds, 0.0).laws, kinds.of, stencils);
  const auto schedule = [&model, kinds, schedule_of](const State& state) { return schedule_of(model, kinds, state.load_factor); };
  return law_groups<L>(model, kinematics, typename LawGroup<L>::ScheduleAt(schedule), kinds.of, stencils);
}

template <class L>
std::vector<L> laws_of(const Schedule<L>& schedule, const Kinds& kinds) {
  std::vector<L> laws;
  laws.reserve(kinds.of.size());
  for (const int kind : kinds.of) laws.push_back(schedule.laws[kind]);
  return laws;
}

}  // namespace

// In a plane an angle has a sign (see CosineAngle): the sites in the order in which they turn about the axis across the
// plane as built, or as they are where they are in line.
std::array<int, 3> angle_sites(const Model& model, const Angle& angle) {
  const std::array<int, 3>& sites = angle.particles;
  if (!model.plane_normal) return sites;
  const auto edge = [&](int i, int j) { return model.start.at(sites[j]) - model.start.at(sites[i]); };
  const bool against = cross(edge(0, 1), edge(1, 2))[*model.plane_normal].value() < 0;
  return against ? std::array{sites[2], sites[1], sites[0]} : sites;
}

Parts bond_group(const Model& model, const Kinematics& kinematics) {
  std::vector<std::array<int, 2>> stencils;
  for (const Bond& b : model.bonds) stencils.push_back(b.particles);
  return glue_groups<HarmonicBond>(model, kinematics, bond_kinds(model), stencils, bond_schedule);
}

Parts angle_group(const Model& model, const Kinematics& kinematics) {
  std::vector<std::array<int, 3>> stencils;
  for (const Angle& a : model.angles) stencils.push_back(angle_sites(model, a));
  return glue_groups<CosineAngle>(model, kinematics, angle_kinds(model), stencils, angle_schedule);
}

std::vector<HarmonicBond> bond_laws(const Model& model, double load_factor) {
  const Kinds kinds = bond_kinds(model);
  return laws_of(bond_schedule(model, kinds, load_factor), kinds);
}

std::vector<CosineAngle> angle_laws(const Model& model, double load_factor) {
  const Kinds kinds = angle_kinds(model);
  return laws_of(angle_schedule(model, kinds, load_factor), kinds);
}

std::unique_ptr<ElementGroup> pressure_group(const Model& model) {
  std::vector<int> kind;
  std::vector<std::array<int, 2>> stencils;
  for (std::size_t k = 0; k < model.pressures.size(); ++k) {
    const std::vector<int>& row = model.pressures[k].particles;
    if (!model.pressures[k].triangles.empty()) continue;
    for (std::size_t i = 0; i < row.size(); ++i)
      kind.push_back(static_cast<int>(k)), stencils.push_back({row[i], row[i + 1 < row.size() ? i + 1 : 0]});
  }
  if (kind.empty()) return std::make_unique<LawGroup<EdgePressure>>(std::vector<EdgePressure>{}, kind, stencils);
  const auto schedule = [&model](const State& state) {
    Schedule<EdgePressure> now;
    for (const Pressure& p : model.pressures) {
      // The middle of two particles that lie opposite: inside of a loop that is not far from round.
      const ExactVector a = state.at(p.particles.front()), b = state.at(p.particles[p.particles.size() / 2]);
      const ExactVector middle{(a.hi + b.hi) / 2, Vec3::Zero()};
      now.laws.push_back({p.scaling.at(state.load_factor) * p.pressure, p.normal, middle});
      now.rates.push_back({p.scaling.rate * p.pressure, p.normal, middle});
    }
    return now;
  };
  return std::make_unique<LawGroup<EdgePressure>>(schedule, std::move(kind), std::move(stencils));
}

std::unique_ptr<ElementGroup> sheet_pressure_group(const Model& model) {
  std::vector<int> kind;
  std::vector<std::array<int, 3>> stencils;
  for (std::size_t k = 0; k < model.pressures.size(); ++k)
    for (const auto& triangle : model.pressures[k].triangles) kind.push_back(static_cast<int>(k)), stencils.push_back(triangle);
  if (kind.empty()) return std::make_unique<LawGroup<TrianglePressure>>(std::vector<TrianglePressure>{}, kind, stencils);
  const auto schedule = [&model](const State& state) {
    Schedule<TrianglePressure> now;
    for (const Pressure& p : model.pressures) {
      now.laws.push_back({p.scaling.at(state.load_factor) * p.pressure, p.tip});
      now.rates.push_back({p.scaling.rate * p.pressure, p.tip});
    }
    return now;
  };
  return std::make_unique<LawGroup<TrianglePressure>>(schedule, std::move(kind), std::move(stencils));
}

HertzContact hertz_contact(const Model& model, int table, int i, int j) {
  const double ri = model.diameter[i] / 2, rj = model.diameter[j] / 2;
  return {hertz_stiffness(model.contacts[table].effective_modulus, ri, rj), ri + rj};
}

Parts contact_group(const Model& model, const Kinematics& kinematics, const Neighbours& neighbours) {
  return pair_groups<HertzContact>(model, kinematics, neighbours.hertz(), [&](int i, int j) {
    return hertz_contact(model, neighbours.rules().hertz(i, j), i, j);
  });
}

Parts cohesion_group(const Model& model, const Kinematics& kinematics, const Neighbours& neighbours) {
  return pair_groups<Cohesion>(model, kinematics, neighbours.lj(), [&](int i, int j) {
    const PairContact& t = model.contacts[neighbours.rules().lj(i, j)];
    return Cohesion{t.epsilon, t.sigma, t.cutoff, t.cutoff_style, t.inner_cutoff};
  });
}

Parts wall_group(const Model& model, const Kinematics& kinematics) {
  const std::vector<bool> glued = glued_particles(model);
  const auto part = [&](bool carried) {
    return std::make_unique<WallGroup>(model, [glued, carried](int p) { return glued[p] == carried; });
  };
  return {part(false), std::make_unique<CarriedGroup>(model, kinematics, part(true))};
}

Parts body_particle_groups(const Model& model, const Kinematics& kinematics, const BodyNeighbours& neighbours) {
  return {body_particle_group(model, kinematics, neighbours, false),
          std::make_unique<CarriedGroup>(model, kinematics, body_particle_group(model, kinematics, neighbours, true))};
}

std::unique_ptr<ElementGroup> hard_pair_group(const Model& model, const Neighbours& neighbours) {
  return std::make_unique<HardPairGroup>(model, neighbours.hard());
}

std::unique_ptr<ElementGroup> hard_wall_group(const Model& model) { return std::make_unique<HardWallGroup>(model); }

}  // namespace elamin
