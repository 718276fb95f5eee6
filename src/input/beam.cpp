#include "input/beam.hpp"

#include "input/csv.hpp"
#include "input/keys.hpp"
#include "model/centerline.hpp"
#include "model/geometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace elamin {

namespace {

constexpr Word<Profile> profile_words[]{{"circle", Profile::circle}, {"sine", Profile::sine}};
constexpr Word<ClampedEnds> clamped_words[]{{"from", ClampedEnds::from}, {"to", ClampedEnds::to}, {"both", ClampedEnds::both}};

void check_corners(TablePlace& place, const char* key, const std::vector<Vec3>& points, Mistakes& mistakes) {
  if (points.size() < 2)
    mistakes.add(place, key, "must be a list of two points at least, [[x, y, z], [x, y, z]]");
  for (std::size_t i = 1; i < points.size(); ++i)
    if (points[i] == points[i - 1]) {
      mistakes.add(place, key, fmt::format("has points {} and {} in the same place", i, i + 1));
      break;
    }
}

/// The points of a beam's file; none, and said why, if they make no curve.
std::optional<std::vector<Vec3>> curve_of(const BeamTable& table, Mistakes& mistakes) {
  const std::optional<NumberTable> read = mistakes.unless_wrong([&] { return read_numbers(table.file, {"x", "y", "z"}); });
  if (!read) return std::nullopt;
  const NumberTable& rows = *read;
  const int x = rows.column("x"), y = rows.column("y"), z = rows.column("z");
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < rows.rows.size(); ++i) {
    const std::vector<double>& row = rows.rows[i];
    points.push_back({row[x], row[y], row[z]});
    if (i > 0 && points[i] == points[i - 1]) {
      mistakes.add({Mistake{table.file, rows.lines[i], 1, {}, "is the same point as the one before"}});
      return std::nullopt;
    }
  }
  if (points.size() >= 2) return points;
  mistakes.add({Mistake{table.file, rows.lines[0], 1, {}, "is one point alone; a curve has two at least"}});
  return std::nullopt;
}

void check_arch(BeamTable& b, bool in_plane, Mistakes& mistakes) {
  const auto written = [&](const char* key) { return b.place.written(key); };
  const bool is_arch = written("rise") || written("angle");
  if (is_arch && !(written("from") && written("to")))
    mistakes.add(b.place, written("rise") ? "rise" : "angle", "is of an arch, which stands on from and to; give both");
  if (!is_arch) return;
  if (b.rise && *b.rise == 0) mistakes.add(b.place, "rise", "must not be 0; leave it out for a straight beam");
  if (!written("toward") && !in_plane && written("from") && written("to"))
    mistakes.add(b.place, "toward", "is missing; the arch rises to this side of from and to. In a plane it may be left out");
  if (b.from && b.to && b.toward && *b.from != *b.to && !rises({*b.from, *b.to, *b.toward}))
    mistakes.add(b.place, "toward", "leads to no side of the line between from and to");
  if (b.particles == 2) mistakes.add(b.place, "particles", "must be at least 3 for an arch");
  if (b.profile != Profile::sine) return;
  if (!written("rise")) mistakes.add(b.place, "profile", "of a sine needs rise");
  if (b.clamped)
    mistakes.add(b.place, "clamped", "is not for a sine; hold its ends with a [[support]] and leave this out");
}

}  // namespace

void describe(Keys& keys, BeamTable& t) {
  keys.about("A row of particles with bonds between neighbours and angles between triplets. Its place is from and to, or center, axis and "
             "spacing, or through, or a curve: points or file.");
  keys.name("name", t.name, "its name, which is a group too");
  keys.may("from_stage", t.from_stage, "the stage it is there from; by default from the start");
  keys.word("section", t.section, section_words, "the section that the stiffnesses follow from");
  keys.must("particles", t.particles, "how many", Range{2, most_particles});
  keys.may("from", t.from, "centre of the first particle");
  keys.may("to", t.to, "centre of the last one");
  keys.may("rise", t.rise, "height of an arch between from and to [length]");
  keys.may("angle", t.angle, "opening of the arc of an arch [degrees]", Range{0, 359, true});
  keys.may("toward", t.toward, "the side that an arch rises to; by default in the plane, to the left");
  keys.word("profile", t.profile, profile_words, "shape of an arch; by default a circle");
  keys.may("through", t.through, "the corners that the row goes through; some particle must be on each, and neighbours are equally far from each other everywhere");
  keys.may("points", t.points, "points of a curve, two at least; the particles are evenly by length along it, on its points or not, and bonds "
                               "over its bends are shorter");
  keys.may_file("file", t.file, "the same from a table of commas: x,y,z");
  keys.word("clamped", t.clamped, clamped_words, "ends with one particle beyond, to be held");
  keys.may("center", t.center, "middle of the row");
  keys.may("axis", t.axis, "its direction");
  keys.may("spacing", t.spacing, "distance of neighbours [length]; by default the diameter", range::positive);
  keys.must("diameter", t.diameter, "of the particles, for contact and mass [length]", range::positive);
  describe_row_stiffness(keys, t);
  describe_own_values(keys, t.values, true);
  keys.at_most_one({"through", "points", "file"});
  keys.at_most_one({"rise", "angle"});
  keys.with({"toward", "profile"}, {"rise", "angle"}, "which make it an arch");
}

void check(BeamTable& b, bool in_plane, Mistakes& mistakes) {
  const auto written = [&](const char* key) { return b.place.written(key); };
  const bool ends = written("from") || written("to"), middle = written("center") || written("axis");
  const auto need_both = [&](const char* first, const char* second) {
    for (const auto& [key, other] : {std::pair(first, second), {second, first}})
      if (!written(key)) mistakes.add(b.place, key, fmt::format("is missing beside {}; it must be a list of three numbers [x, y, z]", other));
  };
  const char* const line = written("through") ? "through" : written("points") ? "points" : written("file") ? "file" : nullptr;
  if (line && (ends || middle)) {
    mistakes.add(b.place, line, "gives the place; leave out from, to, center and axis");
  } else if (ends && middle) {
    mistakes.add(b.place, "has from or to as well as center or axis; give from and to, or center, axis and spacing");
  } else if (line) {
    if (written("spacing")) mistakes.add(b.place, "spacing", fmt::format("follows from {} and particles; leave it out", line));
    if (b.through) check_corners(b.place, "through", *b.through, mistakes);
    if (b.points) check_corners(b.place, "points", *b.points, mistakes);
  } else if (ends) {
    need_both("from", "to");
    if (written("spacing")) mistakes.add(b.place, "spacing", "follows from from, to and particles; leave it out");
    if (b.from && b.to && *b.from == *b.to)
      mistakes.add(b.place, "to", "is the same point as from; a beam has a length");
  } else if (middle) {
    need_both("center", "axis");
    if (b.axis) check_direction(b.place, "axis", *b.axis, mistakes);
  } else {
    mistakes.add(b.place, "its place is missing; give from and to, or center, axis and spacing, or through, points or file");
  }
  check_arch(b, in_plane, mistakes);
  if (b.clamped) {
    const int least = 2 + (*b.clamped == ClampedEnds::both ? 2 : 1);
    if (middle)
      mistakes.add(b.place, "clamped", "needs ends; give from and to, or through, points or file");
    else if (b.particles > 0 && b.particles < least)
      mistakes.add(b.place, "particles", fmt::format("must be at least {} with {} clamped", least, least == 3 ? "an end" : "both ends"));
  }
  check_row_stiffness(b.place, mistakes);
}

namespace {

/// The ends of the beam beyond which one particle more stands.
Clamped clamped_ends(const BeamTable& table) {
  const bool both = table.clamped == ClampedEnds::both;
  return {both || table.clamped == ClampedEnds::from, both || table.clamped == ClampedEnds::to};
}

double largest(const Vec3& x) { return x.cwiseAbs().maxCoeff(); }

/// The corners of a beam, or its two ends.
std::vector<ExactVector> corners_of(const BeamTable& table) {
  std::vector<ExactVector> corners;
  if (table.through)
    for (const Vec3& x : *table.through) corners.push_back(exact(x));
  else if (table.from)
    corners = {exact(*table.from), exact(*table.to)};
  else
    for (const ExactVector& x : ends_of_row(*table.center, *table.axis, table.spacing.value_or(table.diameter), table.particles - 1))
      corners.push_back(x);
  return corners;
}

std::optional<Centerline> arch_of(const BeamTable& table, const std::string& plane, double size, Mistakes& mistakes) {
  Arch a{*table.from, *table.to, table.toward.value_or(Vec3::Zero())};
  if (!table.toward) {                               // a quarter turn of from → to in the plane
    const int u = plane[0] - 'x', v = plane[1] - 'x';
    a.toward[u] = -(a.to - a.from)[v], a.toward[v] = (a.to - a.from)[u];
  }
  const double chord = (a.to - a.from).norm();
  if (!rises(a) || chord <= 1e-12 * size) {
    mistakes.add(table.place, "to", "is no place to which an arch leads from here; from and to must lie apart in the plane");
    return std::nullopt;
  }
  if (table.profile == Profile::sine) {
    std::optional<Centerline> line = half_sine(a, *table.rise, table.particles);
    if (!line)
      mistakes.add(table.place, "rise", "is too high for so few particles on a sine; take more of them, or a circle");
    return line;
  }
  if (table.angle) return arc(a, exact(*table.angle) / exact(360), table.particles, clamped_ends(table));
  if (*table.rise < 0) a.toward = -a.toward;
  return arc(a, turns_of_rise(chord, std::abs(*table.rise)), table.particles, clamped_ends(table));
}

/// What can be done where no number of particles has one on every corner: the lengths as they are, and multiples of a round spacing near
/// them.
std::string common_measure(const BeamTable& table) {
  const std::vector<Vec3>& corners = *table.through;
  std::vector<double> are, could;
  for (std::size_t i = 1; i < corners.size(); ++i) are.push_back((corners[i] - corners[i - 1]).norm());
  const double length = std::accumulate(are.begin(), are.end(), 0.0), shortest = *std::min_element(are.begin(), are.end());
  const double pieces = std::max(1.0, std::round(shortest * (table.particles - 1) / length));
  const double spacing = std::stod(fmt::format("{:.4g}", shortest / pieces));
  for (const double l : are) could.push_back(std::round(l / spacing) * spacing);
  return fmt::format("the lengths between corners must have a common measure; they are {:.6g}, while {:.10g} would do; or give every "
                     "piece a [[beam]] of its own and join them with [[connect]]", fmt::join(are, ", "), fmt::join(could, ", "));
}

void not_on_corners(const BeamTable& table, Mistakes& mistakes) {
  const auto [below, above] = fitting(*table.through, table.particles, clamped_ends(table));
  std::string nearest;
  for (const int n : {below, above})
    if (n > 0) nearest += fmt::format("{}{}", nearest.empty() ? "" : " and ", n);
  mistakes.add(table.place, "particles",
               fmt::format("{} evenly along through put none on a corner; {}", table.particles,
                           nearest.empty() ? "no number near it does: " + common_measure(table) : "the nearest that do: " + nearest));
}

/// Where the particles of a beam are; none, and said why, if they cannot be there.
std::optional<Centerline> centerline_of(const BeamTable& table, const std::string& plane, Mistakes& mistakes) {
  std::optional<std::vector<Vec3>> curve = table.points;
  if (!table.file.empty() && !(curve = curve_of(table, mistakes))) return std::nullopt;
  std::vector<ExactVector> corners;
  if (!curve) corners = corners_of(table);
  else
    for (const Vec3& x : *curve) corners.push_back(exact(x));
  double length = 0, farthest = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    farthest = std::max(farthest, largest(corners[i].hi));
    if (i > 0) length += distance(corners[i - 1], corners[i]).value();
  }
  if (table.rise) length += std::abs(*table.rise), farthest += std::abs(*table.rise);
  if (!std::isfinite(length)) {
    mistakes.add(table.place, "its length is beyond what numbers can hold");
    return std::nullopt;
  }
  if (lost(table.place, "spacing", length / (table.particles - 1), farthest, mistakes)) return std::nullopt;
  if (table.rise || table.angle) return arch_of(table, plane, length, mistakes);
  if (curve) return along_curve(*curve, table.particles, clamped_ends(table));
  if (!table.through) return row(corners.front(), corners.back(), table.particles, clamped_ends(table));
  std::optional<Centerline> line = polyline(*table.through, table.particles, clamped_ends(table));
  if (!line) not_on_corners(table, mistakes);
  return line;
}

}  // namespace

std::optional<Beam> built(const BeamTable& table, const std::string& plane, Mistakes& mistakes) {
  const Clamped clamped = clamped_ends(table);
  const std::optional<Centerline> line = centerline_of(table, plane, mistakes);
  if (!line) return std::nullopt;
  Beam b{table.name, line->centers, table.diameter, table.density.value_or(0), table.youngs_modulus.value_or(0),
         {}, {}};
  b.bond.rest_length = table.rest_length.value_or(line->spacing);
  row_stiffness(table, table.diameter, b.bond, b.angle);
  b.angle.rest = rest_angle(table.rest, pi);
  b.as_built = table.rest.as_built, b.clamped = clamped;
  if (!stiff(table.place, b.bond.stiffness, b.angle.stiffness, mistakes)) return std::nullopt;
  if ((table.points || !table.file.empty()) && !table.rest_length) {
    for (std::size_t i = 1; i < b.centers.size(); ++i) {   // over a bend they are shorter
      BondType own{0, distance(b.centers[i - 1], b.centers[i]).value()};
      AngleType ignored{};
      if (!(own.rest_length > 1e-12 * line->spacing)) {
        mistakes.add(table.place, table.points ? "points" : "file",
                     fmt::format("turns back between particles {} and {}, which are in the same place; take another number of particles", i, i + 1));
        return std::nullopt;
      }
      row_stiffness(table, table.diameter, own, ignored);
      b.bonds.push_back(own);
    }
  }
  return b;
}

}  // namespace elamin
