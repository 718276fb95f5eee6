#pragma once
// Particles and bodies in one row, entities: particle after particle, then body after body, indices from 0.
#include "model/model.hpp"

namespace elamin {

inline int entities(const Model& model) { return model.particles() + static_cast<int>(model.bodies.size()); }
inline bool is_body(const Model& model, int entity) { return entity >= model.particles(); }
/// Whether anything of the model may come into contact.
inline bool may_touch(const Model& model) { return !(model.contacts.empty() && model.walls.empty() && model.rounded.empty()); }
/// LAMMPS's own, or counted from 1.
int id_of(const Model& model, int entity);
/// Its structure and its number there, from 1: "ball 1", "sheet 1757"; "body cube"; "particle 7", "body 9" with their ids of
/// what a data file has and what is in no structure.
std::string called(const Model& model, int entity);
/// Of each the number of its structure.
std::vector<int> structure_of(const Model& model);
/// A particle's diameter, twice a body's bounding radius [length].
double size_of(const Model& model, int entity);
/// The largest and the smallest size that is not 0; 0: there is none. [length]
double largest_size(const Model& model);
double smallest_size(const Model& model);

/// Sides of the box of the places of everything; 0 where there is nothing. [length]
Vec3 sides_of(const State& state);
/// Of the surfaces: the box of the spheres around everything, empty where there is nothing.
Eigen::AlignedBox3d box_of(const Model& model, const State& state);

}  // namespace elamin
