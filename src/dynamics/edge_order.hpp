#pragma once
// In which order the edges of a structure are kept, so that four neighbours lie side by side wherever the structure repeats.
#include "model/model.hpp"

namespace elamin {

/// An edge from particle `from` to `to`: a bond, the side of an angle, or both. Straight angles join it to the edge that
/// goes on at its end and to the one that it goes on from.
struct Edge {
  int from = 0, to = 0;
  double stiffness = 0, rest_length = 0;        // of its bond; 0: none
  int next = -1, before = -1;                   // the edges that it is joined to, −1: none
  double turn_next = 0, turn_before = 0;        // the stiffnesses B there
  bool filler = false;                          // stands between rows: no stiffness at all
};

/// The edges of all bonds and straight angles at a load factor, in rows: where the particles of one edge follow those of
/// another by one each, it does too. A row begins at a multiple of 4 and a filler ends it; between and before them only
/// fillers. Every edge is joined by one angle at each end at most.
struct EdgeOrder {
  std::vector<Edge> edges;                      // as many as a multiple of 4
  std::vector<int> bonds, angles;               // what has no place on them: indices of Model::bonds and Model::angles
};
EdgeOrder order_edges(const Model& model, double load_factor);

}  // namespace elamin
