#pragma once
// A straight row of particles, an arch, or a row through corners.
#include "input/stiffness.hpp"
#include "model/beam.hpp"


namespace elamin {

enum class Profile { circle, sine };           // of an arch
enum class ClampedEnds { from, to, both };

struct BeamTable : RowStiffnessKeys {
  TablePlace place;
  std::string name, from_stage, values;
  int particles = 0;
  std::optional<Vec3> from, to;                 // either these …
  std::optional<Vec3> center, axis;             // … or these, with spacing …
  std::optional<double> spacing;
  std::optional<std::vector<Vec3>> through;     // … or the corners …
  std::optional<std::vector<Vec3>> points;      // … or a curve …
  std::string file;                             // … from a table
  std::optional<double> rise, angle;            // of an arch between from and to
  std::optional<Vec3> toward;
  std::optional<Profile> profile;
  std::optional<ClampedEnds> clamped;
  double diameter = 0;
  bool operator==(const BeamTable&) const = default;
};

void describe(Keys& keys, BeamTable& t);
void check(BeamTable& t, bool in_plane, Mistakes& mistakes);
/// The beam; none, and said why, if it cannot be built. plane: "", "xy", "xz" or "yz".
std::optional<Beam> built(const BeamTable& t, const std::string& plane, Mistakes& mistakes);

}  // namespace elamin
