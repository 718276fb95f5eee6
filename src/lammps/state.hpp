#pragma once
// States as LAMMPS data files.
#include "model/model.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace elamin {

/// LABEL.bodies.data of LABEL.data: the bodies of a model that has particles too.
std::string bodies_file(const std::string& data_file);

/// Writes the state as a LAMMPS data file, atom style "hybrid sphere angle": positions with 17 digits (their tails are
/// left out), bonds and angles with coefficients (angles as cosine; where one is not straight at rest all of them as
/// cosine/shift, 2B and the rest angle in degrees), velocities if the model has them, a box around everything.
/// Types that no bond or angle has are left out, the others counted anew; the title says so.
/// read_lammps_data reads the same positions back to the last bit; LAMMPS and OVITO open it. LAMMPS wants densities
/// above zero: a density or mass that is not given is written as 1, and the title says so.
///
/// Bodies are written in atom style body (rounded/polyhedron): vertices and inertia in the axes of space, faces of more than
/// four corners cut into such of four and three, velocities with angular momentum. Of a model with particles they go to a
/// second file, bodies_file(file). Throws OutputError if a file cannot be written.
void write_state(const std::string& file, const Model& model, const State& state, const std::string& title);

/// The particles of the state with their bonds and angles in atom style "full" (charge 0; of each type the mass of its first particle,
/// or 1 where that is not known), which more programs read: MDAnalysis and ASE among them. Throws OutputError if it cannot be written.
void write_topology(const std::string& file, const Model& model, const State& state, const std::string& title);

/// An angle in degrees, exactly 180 for π, and so that degrees · (π/180) gives the same angle back where one of the doubles does.
double degrees(double angle);

/// Whether all angles are straight at rest: then they are written as LAMMPS's cosine.
bool straight_at_rest(const Model& model);

struct Box { Vec3 lo, hi; };
/// All of these with room: a tenth of the largest extent, at least the largest diameter, and not lost in rounding.
Box box_around(const Field& x, const std::vector<double>& diameter);

// States as LAMMPS's custom dump, one frame after the other.

/// Something that is known of every particle, and behind them of every body, besides where it is: a number or a vector.
struct EntityColumn {
  std::string name;                        // "force"
  std::vector<std::string> components;     // "fx", "fy", "fz"
  Eigen::MatrixXd values;                  // components × entities (see model/entities.hpp), finite
};
using EntityColumns = std::vector<EntityColumn>;

/// The box around particles, or around bodies instead.
Box dump_box(const Model& model, const State& state, bool of_bodies);

/// One frame: TIMESTEP, number of atoms, a box, and of each particle, or of each body instead, id type mol x y z radius (of
/// a body the bounding one, and quati quatj quatk quatw), then the components of the columns. Numbers read back to the same doubles.
std::string dump_frame(std::int64_t step, const Model& model, const State& state, const EntityColumns& columns, bool of_bodies,
                       const Box& box);

/// The same frame in another box.
std::string in_box(const std::string& frame, const Box& box);

}  // namespace elamin
