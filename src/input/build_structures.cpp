#include "input/build_structures.hpp"

#include "model/beam.hpp"
#include "model/grains.hpp"
#include "model/loop.hpp"
#include "model/sheet.hpp"
#include "input/build_beam.hpp"
#include "input/grains_file.hpp"
#include "input/schema_words.hpp"

#include <fmt/format.h>

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace elamin {
namespace {

/// Room that a particle takes in the model and the checks [bytes].
constexpr double room = 500;

double memory() { return static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE)); }

/// K = √3/4 E t and B = E t³/(8√3) of the triangular lattice. Source: Guerra 2021, equations (21), (27).
double sheet_bond_stiffness(double E, double t) { return std::sqrt(3.0) / 4 * E * t; }
double sheet_angle_stiffness(double E, double t) { return E * t * t * t / (8 * std::sqrt(3.0)); }

class StructureBuilder {
 public:
  StructureBuilder(const std::string& plane, Mistakes& mistakes) : plane_(plane), mistakes_(mistakes) {}

  std::optional<Beam> built(const BeamTable& table) {
    const Clamped clamped = clamped_ends(table);
    const std::optional<Centerline> line = centerline_of(table, plane_, mistakes_);
    if (!line) return std::nullopt;
    Beam b{table.name, line->centers, table.diameter, table.density.value_or(0), table.youngs_modulus.value_or(0),
           {}, {}};
    b.bond.rest_length = table.rest_length.value_or(line->spacing);
    row_stiffness(table, b.bond, b.angle);
    b.angle.rest = rest_angle(table.rest, pi);
    b.as_built = table.rest.as_built, b.clamped = clamped;
    if (!stiff(table.place, b.bond.stiffness, b.angle.stiffness)) return std::nullopt;
    return b;
  }

  std::optional<Ring> built(const LoopTable& table) {
    Ring r;
    r.name = table.name, r.particles = table.particles;
    r.center = table.center, r.normal = table.normal, r.radius = table.radius;
    r.diameter = table.diameter, r.density = table.density.value_or(0);
    r.youngs_modulus = table.youngs_modulus.value_or(0);
    const double spacing = chord(r.radius, r.particles);
    if (lost(table.place, "spacing", spacing, largest(r.center) + r.radius)) return std::nullopt;
    r.bond.rest_length = table.rest_length.value_or(spacing);
    row_stiffness(table, r.bond, r.angle);
    r.angle.rest = rest_angle(table.rest, ring_angle(r.particles));
    if (!stiff(table.place, r.bond.stiffness, r.angle.stiffness)) return std::nullopt;
    return r;
  }

  std::optional<Sheet> built(const SheetTable& table) {
    const double thickness = table.thickness.value_or(table.spacing), E = table.youngs_modulus.value_or(0);
    Sheet s;
    s.name = table.name, s.shape = shape_of(table.shape);
    s.center = table.center, s.normal = table.normal;
    s.size = table.size.value_or(s.size), s.radius = table.radius.value_or(0), s.height = table.height.value_or(0);
    s.lattice_angle = table.lattice_angle * pi / 180;
    s.spacing = table.spacing, s.rest_length = table.rest_length.value_or(0);
    s.diameter = table.diameter.value_or(table.spacing), s.density = table.density.value_or(0), s.youngs_modulus = E;
    s.bond_stiffness = table.bond_stiffness.value_or(sheet_bond_stiffness(E, thickness));
    s.angle_stiffness = table.angle_stiffness.value_or(sheet_angle_stiffness(E, thickness));
    s.as_built = table.rest.as_built, s.rest = rest_angle(table.rest, pi);
    const double reach = std::max({s.size[0], s.size[1], s.radius, s.height});
    if (lost(table.place, "spacing", s.spacing, largest(s.center) + reach)) return std::nullopt;
    if (!stiff(table.place, s.bond_stiffness, s.angle_stiffness)) return std::nullopt;
    const int particles = sheet_particles(s);
    if (particles > most_particles)
      mistakes_.add(table.place,
                    fmt::format("has more particles than can be handled, {}; make it smaller or its spacing "
                                "larger",
                                most_particles));
    else if (particles == 0)
      mistakes_.add(
          table.place, "radius",
          fmt::format("is too small for the spacing: once around is {:.3g} spacings, and a cylinder closes with "
                      "three",
                      2 * pi * s.radius / s.spacing));
    else if (particles == 1)
      mistakes_.add(table.place, "spacing", "is too large: the sheet has one particle; it needs two at least");
    else
      return s;
    return std::nullopt;
  }

  std::optional<Grains> built(const GrainsTable& table) {
    GrainRows rows;
    if (table.positions) {
      rows.position = *table.positions;
    } else {
      try {
        rows = read_grains(table.file);
      } catch (const InputError& e) {
        mistakes_.add(e.mistakes());
        return std::nullopt;
      }
    }
    if (rows.diameter.empty() != table.diameter.has_value()) {
      mistakes_.add(table.place, "diameter",
                    table.diameter ? "stands in the fourth column of the file; leave it out"
                                   : "is missing; give it here, or as a fourth column of the file");
      return std::nullopt;
    }
    if (rows.diameter.empty()) rows.diameter.assign(rows.position.size(), *table.diameter);
    Grains g{table.name, Field(3, rows.position.size()), std::move(rows.diameter), table.density.value_or(0)};
    double farthest = 0;
    for (std::size_t i = 0; i < rows.position.size(); ++i) {
      g.position.col(static_cast<Eigen::Index>(i)) = rows.position[i];
      farthest = std::max(farthest, largest(rows.position[i]));
    }
    const double smallest = *std::min_element(g.diameter.begin(), g.diameter.end());
    if (lost(table.place, "diameter", smallest, farthest)) return std::nullopt;
    return g;
  }

 private:
  static double largest(const Vec3& x) { return x.cwiseAbs().maxCoeff(); }

  static Sheet::Shape shape_of(SheetShape shape) {
    return shape == SheetShape::rectangle ? Sheet::Shape::rectangle
           : shape == SheetShape::circle  ? Sheet::Shape::circle
                                          : Sheet::Shape::cylinder;
  }

  bool lost(const TablePlace& place, const char* what, double length, double farthest) {
    return elamin::lost(place, what, length, farthest, mistakes_);
  }

  /// K = EA/(2q₀) and B = EI/q₀, of the section where nothing else is given.
  template <class Table> static void row_stiffness(const Table& table, BondType& bond, AngleType& angle) {
    const double E = table.youngs_modulus.value_or(0), t = table.thickness.value_or(table.diameter);
    const double q = bond.rest_length;
    bond.stiffness = table.bond_stiffness    ? *table.bond_stiffness
                     : table.axial_stiffness ? *table.axial_stiffness / (2 * q)
                                             : bond_stiffness(table.section, E, t, q);
    angle.stiffness = table.angle_stiffness     ? *table.angle_stiffness
                      : table.bending_stiffness ? *table.bending_stiffness / q
                                                : angle_stiffness(table.section, E, t, q);
  }

  bool stiff(const TablePlace& place, double bond, double angle) {
    for (const auto& [name, value] : {std::pair("bond", bond), {"angle", angle}})
      if (!std::isnormal(value)) {
        mistakes_.add(place, fmt::format("its {} stiffness, {}, is beyond what numbers can hold", name, value));
        return false;
      }
    return true;
  }

  const std::string& plane_;
  Mistakes& mistakes_;
};

/// Everything that can be built of a list of tables; the names of the others go to left_out.
template <class Built, class Table>
std::vector<Built> all_built(StructureBuilder& builder, const std::vector<Table>& tables, std::vector<std::string>& left_out) {
  std::vector<Built> all;
  for (const Table& table : tables) {
    std::optional<Built> one;
    if (!table.place.broken) one = builder.built(table);
    if (one)
      all.push_back(std::move(*one));
    else
      left_out.push_back(table.name);
  }
  return all;
}

}  // namespace

bool add_structures(const Problem& problem, Model& model, std::vector<std::string>& left_out, Mistakes& mistakes) {
  StructureBuilder builder(problem.plane, mistakes);
  const auto sheets = all_built<Sheet>(builder, problem.sheets, left_out);
  const auto grains = all_built<Grains>(builder, problem.grains, left_out);
  double rows = 0, total = model.particles();
  for (const BeamTable& b : problem.beams) rows += b.particles;
  for (const LoopTable& l : problem.loops) rows += l.particles;
  for (const Sheet& s : sheets) total += sheet_particles(s);
  for (const Grains& g : grains) total += static_cast<double>(g.position.cols());
  total += rows;
  if (total > most_particles) {
    if (rows <= most_particles)   // else said when the file was read
      mistakes.add(fmt::format("the structures have {:.0f} particles together; at most {} can be handled", total,
                               most_particles));
    return false;
  }
  if (total * room > memory()) {
    mistakes.add(fmt::format("{:.0f} particles need more memory than this machine has", total));
    return false;
  }
  for (const auto* numbers : {&model.id, &model.type, &model.molecule}) {
    const int most = numbers->empty() ? 0 : *std::max_element(numbers->begin(), numbers->end());
    if (most > std::numeric_limits<int>::max() - total && total > model.particles()) {
      mistakes.add(
          problem.lammps->place, "data",
          fmt::format("its numbers of particles, types or molecules reach {}; there is no room above for those "
                      "of the other structures",
                      most));
      return false;
    }
  }
  const auto beams = all_built<Beam>(builder, problem.beams, left_out);
  const auto loops = all_built<Ring>(builder, problem.loops, left_out);
  if (!beams.empty()) add_beams(model, beams);
  if (!loops.empty()) add_loops(model, loops);
  if (!sheets.empty()) add_sheets(model, sheets);
  if (!grains.empty()) add_grains(model, grains);
  return true;
}

const Structure& structure_with(const Model& model, int particle) {
  return *std::find_if(model.structures.begin(), model.structures.end(),
                       [&](const Structure& s) { return particle < s.first + s.count; });
}

const TablePlace& place_of(const Problem& problem, const Structure& s) {
  const auto find = [&](const char* kind, const auto& tables) -> const TablePlace* {
    for (const auto& table : tables)
      if (s.kind == kind && table.name == s.name) return &table.place;
    return nullptr;
  };
  for (const TablePlace* place : {find("beam", problem.beams), find("loop", problem.loops),
                                  find("sheet", problem.sheets), find("grains", problem.grains),
                                  find("body", problem.bodies)})
    if (place) return *place;
  return problem.lammps->place;
}

double rest_angle(const Rest& rest, double as_built) {
  if (rest.as_built) return as_built;
  return rest.degrees == 180 ? pi : rest.degrees * pi / 180;
}

}  // namespace elamin
