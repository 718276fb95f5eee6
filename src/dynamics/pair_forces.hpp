#pragma once
// Contact and cohesion of particles on plain doubles, four pairs at a time.
#include "dynamics/columns.hpp"
#include "dynamics/contact_damping.hpp"
#include "energy/contact_rules.hpp"

#include <array>

namespace elamin {

// The pairs that may come into contact before anything has moved by half a skin, found anew while everything moves.

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

/// What single pushes between particles, and between particles and walls, add up to, particle by particle.
struct Pushes {
  Rows force;                                   // elastic
  Rows damping;                                 // of contact damping and friction; empty: there is none
  Rows torque;                                  // of friction; empty: there is none
  bool damped() const { return !damping.row.empty(); }
  bool rubs() const { return !torque.row.empty(); }
};

/// Where the particles are and how they move, as pushes want it.
struct Movement {
  Rows position, velocity, angular_velocity;                // the latter two empty where nothing damps, nothing rubs
};

class PairForces {
 public:
  PairForces(const Model& model, const ContactRules& rules, double skin);

  bool damped() const { return damped_; }
  bool rubs() const { return rubs_; }
  /// Looks for the pairs that are near.
  void find(const Columns& x);
  void add(const Movement& movement, Pushes& pushes);

 private:
  /// The pairs of one table, a column for each number.
  struct Hertz {
    std::vector<int> first, second;
    std::vector<double> cutoff, stiffness;
    std::vector<double> coefficient;            // see DampedContact; only where there is damping
  };
  struct Cohesive {
    std::vector<int> first, second;
    std::vector<double> cutoff, epsilon, sigma;
    std::vector<double> inner, force, a, b;     // see Cohesion::Shell; of smooth ones alone
    void clear();
  };
  void put(const PairList::Pair& pair);
  template <bool damped, bool rubs>
  void add(const Hertz& pairs, const ContactDamping& damping, const Movement& movement, Pushes& pushes);
  template <bool smooth>
  void add(const Cohesive& pairs, const Movement& movement, Pushes& pushes);
  /// The indices of those pairs that are nearer than `cutoff`, in closed_, and how many; some more behind them may be read.
  int find_closed(const std::vector<int>& first, const std::vector<int>& second, const std::vector<double>& cutoff, const Rows& x);

  const Model& model_;
  PairList list_;
  bool damped_ = false, rubs_ = false;
  std::vector<Hertz> hertz_;                    // of every table
  Cohesive cohesive_, smooth_;
  std::vector<double> radius_;                  // of every particle
  std::vector<int> closed_;
};

}  // namespace elamin
