#include "input/loop.hpp"

#include "input/keys.hpp"

namespace elamin {

void describe(Keys& keys, LoopTable& t) {
  keys.about("A closed ring of particles.");
  keys.name("name", t.name, "its name, which is a group too");
  keys.may("from_stage", t.from_stage, "the stage it is there from; by default from the start");
  keys.word("section", t.section, section_words, "the section that the stiffnesses follow from");
  keys.must("particles", t.particles, "how many", Range{3, most_particles});
  keys.may("center", t.center, "its middle");
  keys.may("normal", t.normal, "across its plane");
  keys.must("radius", t.radius, "of the circle through the centres [length]", range::positive);
  keys.must("diameter", t.diameter, "of the particles, for contact and mass [length]", range::positive);
  describe_row_stiffness(keys, t);
  describe_own_values(keys, t.values, true);
}

void check(LoopTable& t, Mistakes& mistakes) {
  check_direction(t.place, "normal", t.normal, mistakes);
  check_row_stiffness(t.place, mistakes);
}

std::optional<Ring> built(const LoopTable& table, Mistakes& mistakes) {
  Ring r;
  r.name = table.name, r.particles = table.particles;
  r.center = table.center, r.normal = table.normal, r.radius = table.radius;
  r.diameter = table.diameter, r.density = table.density.value_or(0);
  r.youngs_modulus = table.youngs_modulus.value_or(0);
  const double spacing = chord(r.radius, r.particles);
  if (lost(table.place, "spacing", spacing, r.center.cwiseAbs().maxCoeff() + r.radius, mistakes)) return std::nullopt;
  r.bond.rest_length = table.rest_length.value_or(spacing);
  row_stiffness(table, table.diameter, r.bond, r.angle);
  r.angle.rest = rest_angle(table.rest, ring_angle(r.particles));
  if (!stiff(table.place, r.bond.stiffness, r.angle.stiffness, mistakes)) return std::nullopt;
  return r;
}

}  // namespace elamin
