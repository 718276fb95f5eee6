#pragma once
// Bonds and straight angles, edge by edge: the forces of chains and lattices at the speed of the memory.
#include "dynamics/columns.hpp"
#include "model/model.hpp"

namespace elamin {

// In which order the edges of a structure are kept, so that four neighbours lie side by side wherever the structure repeats.

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

/// With u = x_to − x_from of an edge, a = u/|u| and the energy U of its bond and of the angles at its ends,
///   e = ∂U/∂u = 2K (|u| − r₀) a − B (b⊥)/|u| − B' (b'⊥)/|u|,   b⊥ = b − (a·b) a,
/// b and b' the directions of the edges that the angles join it to. The force on a particle is the sum of e over the edges
/// that leave it, less that over those that come in. Each edge's direction is found once, four edges at a time.
class EdgeForces {
 public:
  EdgeForces(const EdgeOrder& order, int particles);

  /// New positions: the edges are found one after another as on() wants them.
  void begin() { found_ = pulled_ = 0; }
  /// The force on the particles 4·block … 4·block + 3. Asked for block after block, ascending; the particles of
  /// blocks that were asked for may have moved on meanwhile.
  [[gnu::always_inline]] Triple<Lanes> on(int block, const Columns& x) {
    const Pull& p = pulls_[block];
    if (pulled_ < p.pulled) go_on(x, p.pulled);
    const int* term = &terms_[p.first];
    Triple<Lanes> f{0.0, 0.0, 0.0};
    for (int k = 0; k < p.out; ++k) f = f + e_.load(*term++);
    for (int k = 0; k < p.in; ++k) f = f - e_.load(*term++);
    for (int k = 0; k < p.single; ++k) f = f + single(*term++);
    return f;
  }

 private:
  struct Block {
    int from, to, next, before;                // of its first edge, where those of the others follow; −1: see the lists
    int numbers;                               // in numbers_
    int found;                                 // how many blocks of edges must be found before its e
    bool turns_next, turns_before;             // any B there
  };
  struct Numbers { Lanes K, r0, next, before; };   // of four edges
  struct Pull { int first, pulled; short out, in, single; };   // pulled: how many blocks must have their e

  void build_blocks(const EdgeOrder& order);
  void build_pulls(const EdgeOrder& order, int particles);
  void go_on(const Columns& x, int pulled);
  void find(const Columns& x, int block);
  void pull(int block);
  Triple<Lanes> single(int term) const;
  Triple<Lanes> direction(int base, const std::vector<int>& list, int edge) const;

  int edges_ = 0, found_ = 0, pulled_ = 0;
  std::vector<Block> blocks_;
  std::vector<Numbers> numbers_;
  std::vector<int> from_, to_, next_, before_; // of every edge
  std::vector<Pull> pulls_;                    // of every four particles, in terms_
  std::vector<int> terms_;                     // edge out, edge in; single: 8·edge + 2·lane + (in)
  Columns a_, e_;
  Column inverse_, pull_;         // 1/|u|, 2K (|u| − r₀)
};

}  // namespace elamin
