#pragma once
// States as LAMMPS's custom dump, one frame after the other.
#include "lammps/state.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace elamin {

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
