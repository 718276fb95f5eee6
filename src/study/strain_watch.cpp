#include "study/strain_watch.hpp"

#include "energy/groups.hpp"
#include "energy/law_group.hpp"
#include "laws/cosine_angle.hpp"
#include "laws/harmonic_bond.hpp"
#include "model/entities.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

namespace elamin {

namespace {

constexpr double small_strain = 0.1, small_rotation = pi / 3;

}  // namespace

bool StrainWatch::Largest::grows(double v, double limit, const std::string& here) {
  if (v > limit && since.empty()) since = here;
  if (!(v > value)) return false;
  value = v, where = here;
  return true;
}

void StrainWatch::look(const Model& model, const State& state, const std::string& where) {
  const std::vector<HarmonicBond> bonds = bond_laws(model, state.load_factor);
  const std::vector<CosineAngle> angles = angle_laws(model, state.load_factor);
  std::optional<std::size_t> bond, angle;                  // the largest
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    if (!(bonds[b].K > 0 && bonds[b].r0 > 0)) continue;
    const double strain = bonds[b].strain(points<2>(state, model.bonds[b].particles));
    if (strain_.grows(std::abs(strain), small_strain, where)) bond = b;
  }
  for (std::size_t a = 0; a < angles.size(); ++a) {
    const double angle_here = angles[a].bending(points<3>(state, angle_sites(model, model.angles[a]))).angle;
    const double off = std::abs(std::remainder(angle_here - (pi - model.angle_types[model.angles[a].type].rest), 2 * pi));
    if (angles[a].B > 0 && bend_.grows(off, small_rotation, where)) angle = a;
  }
  if (bond) strain_.whose = called(model, model.bonds[*bond].particles[0]) + " and " + called(model, model.bonds[*bond].particles[1]);
  if (angle) bend_.whose = called(model, model.angles[*angle].particles[1]);
}

std::vector<std::string> StrainWatch::warnings() const {
  std::vector<std::string> all;
  const auto since = [](const Largest& l, const char* limit) {
    return l.since == l.where ? fmt::format("above {}", limit) : fmt::format("above {} from {} on", limit, l.since);
  };
  if (!strain_.since.empty())
    all.push_back(fmt::format("the bond of {} is strained by {:.3g} at {}, {}; the model means small strains", strain_.whose, strain_.value,
                              strain_.where, since(strain_, "0.1")));
  if (!bend_.since.empty())
    all.push_back(fmt::format("the angle at {} is bent by {:.0f}° from rest at {}, {}; more particles make the angles of a bend smaller",
                              bend_.whose, bend_.value * 180 / pi, bend_.where, since(bend_, "60°")));
  return all;
}

}  // namespace elamin
