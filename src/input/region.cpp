#include "input/region.hpp"

#include "core/find.hpp"
#include "input/keys.hpp"
#include "input/stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace elamin {

namespace {

constexpr Word<Shape> shape_words[]{
    {"plane", Shape::plane}, {"block", Shape::block}, {"cylinder", Shape::cylinder}, {"sphere", Shape::sphere}, {"cone", Shape::cone}};
constexpr Word<int> axis_words[]{{"x", 0}, {"y", 1}, {"z", 2}};

/// The faces of a region that are open, by name.
template <std::size_t n> void describe_open(Keys& keys, Region& r, const std::array<const char*, n>& faces) {
  std::vector<std::string> open;
  for (std::size_t i = 0; i < n; ++i)
    if (r.open[i]) open.push_back(faces[i]);
  keys.words("open", open, faces, "faces that are not there");
  for (std::size_t i = 0; i < n; ++i) r.open[i] = contains(open, faces[i]);
}

/// An end along the axis, infinite where it is not given.
void describe_end(Keys& keys, const char* key, double& end, const char* means) {
  std::optional<double> given;
  if (std::isfinite(end)) given = end;
  keys.may(key, given, means);
  if (given) end = *given;
}

void describe_axis(Keys& keys, Region& r) {
  keys.must_word("axis", r.axis, axis_words, "of the cylinder or the cone");
  keys.center("center", r.center, r.axis, "a point of the axis, or the middle of a sphere");
}

}  // namespace

void describe_region(Keys& keys, Region& r) {
  if (!keys.must_word("shape", r.shape, shape_words, "of the region")) return keys.skip_the_rest();   // other keys belong to other shapes
  keys.either("shape", {{{"plane"}, "a plane", r.shape == Shape::plane, [&] {
                           keys.must("point", r.center, "a point of a plane");
                           keys.must("normal", r.normal, "of a plane, into the region");
                         }},
                        {{"block"}, "a block", r.shape == Shape::block, [&] {
                           keys.must("lo", r.lo, "the lower corner of a block");
                           keys.must("hi", r.hi, "its upper corner");
                           describe_open(keys, r, block_face_names);
                         }},
                        {{"sphere"}, "a sphere", r.shape == Shape::sphere, [&] {
                           keys.must("center", r.center, "a point of the axis, or the middle of a sphere");
                           keys.must("radius", r.radius, "[length]", range::positive);
                         }},
                        {{"cylinder"}, "a cylinder", r.shape == Shape::cylinder, [&] {
                           describe_axis(keys, r);
                           keys.must("radius", r.radius, "[length]", range::positive);
                           describe_end(keys, "lo", r.axial_lo, "where it begins along the axis; by default nowhere");
                           describe_end(keys, "hi", r.axial_hi, "where it ends; by default nowhere");
                           describe_open(keys, r, round_face_names);
                         }},
                        {{"cone"}, "a cone", r.shape == Shape::cone, [&] {
                           describe_axis(keys, r);
                           keys.must("radius_lo", r.radius_lo, "of a cone at lo [length]", range::not_negative);
                           keys.must("radius_hi", r.radius_hi, "at hi", range::not_negative);
                           keys.must("lo", r.axial_lo, "where it begins along the axis");
                           keys.must("hi", r.axial_hi, "where it ends");
                           describe_open(keys, r, round_face_names);
                         }}});
}

void check_region(TablePlace& place, const Region& region, bool flat, Mistakes& mistakes) {
  const auto order = [&](double lo, double hi, bool may_meet, const std::string& along) {
    if (lo > hi)
      mistakes.add(place, "hi", fmt::format("lies below lo{}: {} < {}", along, hi, lo));
    else if (lo == hi && !may_meet)
      mistakes.add(place, "hi", fmt::format("is the same as lo{}: {}; there must be room between them", along, hi));
  };
  switch (region.shape) {
    case Shape::plane: return check_direction(place, "normal", region.normal, mistakes);
    case Shape::block:
      for (int c = 0; c < 3; ++c) order(region.lo[c], region.hi[c], flat, fmt::format(" along {}", "xyz"[c]));
      return;
    case Shape::sphere: return;
    case Shape::cylinder: return order(region.axial_lo, region.axial_hi, flat, "");
    case Shape::cone:
      order(region.axial_lo, region.axial_hi, false, "");
      if (region.radius_lo == 0 && region.radius_hi == 0)
        mistakes.add(place, "radius_hi", "is zero, and radius_lo too; a cone has a radius at one end at least");
      return;
  }
}

Region with_unit_normal(Region region) {
  if (region.shape == Shape::plane) region.normal = (region.normal / region.normal.cwiseAbs().maxCoeff()).normalized();
  return region;
}

}  // namespace elamin
