#include "model/beam.hpp"

#include "model/append.hpp"
#include "model/distinct.hpp"
#include "model/geometry.hpp"

namespace elamin {

void add_beams(Model& model, const std::vector<Beam>& beams) {
  int more = 0;
  for (const Beam& beam : beams) more += static_cast<int>(beam.centers.size());
  Appender append(model, more);
  for (const Beam& beam : beams) {
    const int n = static_cast<int>(beam.centers.size());
    const int first = append.together(n, beam.diameter, beam.density), end = first + n;
    for (int i = 0; i < n; ++i) model.start.set(first + i, beam.centers[i]);
    const int bond_type = add_type(model, beam.bond);
    for (int i = first; i + 1 < end; ++i) model.bonds.push_back({bond_type, {i, i + 1}});
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
