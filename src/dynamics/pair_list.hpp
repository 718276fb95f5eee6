#pragma once
// The pairs that may come into contact before anything has moved by half a skin, found anew while everything moves.
#include "dynamics/columns.hpp"
#include "energy/contact_rules.hpp"

#include <array>

namespace elamin {

/// Lists of pairs (i < j), of Hertz's tables and of Lennard-Jones's: all that feel each other, and all that would
/// if every particle moved by half the skin. Made in about n steps by a grid where the sizes are alike; the order of
/// the pairs follows the grid.
class PairList {
 public:
  PairList(const Model& model, const ContactRules& rules, double skin);

  struct Pair { int first, second, table; };
  /// The lists for these positions.
  void find(const Columns& x);
  const std::vector<Pair>& hertz() const { return pairs_[0]; }
  const std::vector<Pair>& lj() const { return pairs_[1]; }

 private:
  void find_on_grid(const Columns& x);
  void search(int at, int begin, int end);
  void find_at_all_sizes(const Columns& x);
  void offer(int i, int j, double squared);

  const Model& model_;
  const ContactRules& rules_;
  double skin_, cell_ = 0;
  bool alike_ = true;                            // the largest cutoff is not much above the smallest
  std::vector<int> members_;                     // particles with a cutoff
  std::vector<int> cell_of_, start_, sorted_;    // cell of each particle; where a cell begins in `sorted`; particles cell by cell
  Columns at_;                                   // as sorted: where they are, and their cutoff
  std::vector<double> far_;
  std::array<std::vector<Pair>, 2> pairs_;
};

}  // namespace elamin
