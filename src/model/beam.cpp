#include "model/beam.hpp"

#include "model/append.hpp"
#include "model/distinct.hpp"
#include "model/geometry.hpp"

#include <algorithm>

namespace elamin {
namespace {

/// The first of its types.
int add_bonds(Model& model, const Beam& beam, int first) {
  const int n = static_cast<int>(beam.centers.size()), first_type = static_cast<int>(model.bond_types.size());
  std::vector<double> lengths;
  for (const BondType& b : beam.bonds) lengths.push_back(b.rest_length);
  const Distinct types = distinct(lengths, first_type, 0, 16 * epsilon);
  for (std::size_t k = 0; k < types.value.size(); ++k) {
    const auto one = std::find(types.type.begin(), types.type.end(), first_type + static_cast<int>(k));
    add_type(model, beam.bonds[one - types.type.begin()]);
  }
  if (lengths.empty()) add_type(model, beam.bond);
  for (int i = 0; i + 1 < n; ++i) model.bonds.push_back({lengths.empty() ? first_type : types.type[i], {first + i, first + i + 1}});
  return first_type;
}

}  // namespace

void add_beams(Model& model, const std::vector<Beam>& beams) {
  int more = 0;
  for (const Beam& beam : beams) more += static_cast<int>(beam.centers.size());
  Appender append(model, more);
  for (const Beam& beam : beams) {
    const int n = static_cast<int>(beam.centers.size());
    const int first = append.together(n, beam.diameter, beam.density);
    for (int i = 0; i < n; ++i) model.start.set(first + i, beam.centers[i]);
    const int bond_type = add_bonds(model, beam, first);
    if (beam.angle.stiffness == 0) {
      model.structures.push_back({beam.name, "beam", first, n, beam.youngs_modulus, bond_type, -1});
      continue;
    }
    const int angle_type = static_cast<int>(model.angle_types.size());
    std::vector<double> rests;
    if (beam.as_built)
      for (int i = 1; i + 1 < n; ++i)
        rests.push_back(angle_at(beam.centers[i], beam.centers[i - 1], beam.centers[i + 1]));
    const Distinct types = distinct(rests, angle_type, 16 * epsilon, 0);
    for (const double rest : types.value) add_type(model, AngleType{beam.angle.stiffness, rest});
    if (types.value.empty()) add_type(model, beam.angle);
    for (int i = 0; i + 2 < n; ++i)
      model.angles.push_back({rests.empty() ? angle_type : types.type[i], {first + i, first + i + 1, first + i + 2}});
    const auto double_up = [&](Angle& angle) {
      const AngleType& type = model.angle_types[angle.type];
      angle.type = add_type(model, AngleType{2 * type.stiffness, type.rest});
    };
    if (beam.clamped.from) double_up(*(model.angles.end() - (n - 2)));
    if (beam.clamped.to) double_up(model.angles.back());
    model.structures.push_back({beam.name, "beam", first, n, beam.youngs_modulus, bond_type, angle_type});
  }
}

}  // namespace elamin
