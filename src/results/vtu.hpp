#pragma once
// A state as VTK's unstructured grid, for ParaView.
#include "results/shot.hpp"

namespace elamin {

/// Writes the state as .vtu: XML, the numbers behind it in binary, packed by zlib, so that they are the same to the last bit. Cells by their `kind`:
///   0  particles, a vertex each        1  bonds, a line each: tension, strain       2  angles, a line of three points each: curvature, moment,
///   3  closed contacts, a vertex at    4  walls, polygons                              moment_vector
///      the point of contact each: gap, force (on the first)                        5  bodies, polygons
/// `first` and `second` are the ids of who bonds or touches; of a wall its number from 1, negative. What a kind does not have is 0. Points: id
/// (of particles and on bodies), radius (of particles), columns_of, and mode_1 … the null vectors as displacements. Of the whole: step,
/// load_factor or time, label. Throws OutputError if it cannot be written.
void write_vtu(const std::string& file, const Shot& shot);

}  // namespace elamin
