#pragma once
// Which points of a path keep their shape beside those that have a label: [path] frames and every.
#include "core/archive.hpp"
#include "input/path_table.hpp"
#include "path/point.hpp"

#include <vector>

namespace elamin {

/// Of `every` n each n-th point. Of `frames` n the points that are nearest to n places, evenly along the path: how far a point is along it is
/// told by its load factor, or in arc length by √(|Δx|²/(N L²) + Δλ²/Λ²) summed up, of N sites and L the size of the structure; each stage's
/// Λ is |to − from|, and a snap and the way to another branch count nothing. How long the path gets is known at its end only: until then
/// at most `spare` · n points are kept, of every piece of it (they double in length) the first.
class FrameChoice {
 public:
  /// stages: how many the path has.
  FrameChoice(const PathTable& path, double size, int stages);

  /// The points that come belong to this stage; goes_on: some before belong to it, too.
  void enter(const PathTable& stage, bool goes_on = false) { stage_ = stage, branch_ = goes_on ? branch_ : -1; }

  /// Whether the shape of the next point is kept, for now.
  bool take(const PathPoint& point);

  /// The steps of those that are not kept any longer, since the last call. A point that has a label is never among them.
  std::vector<int> dropped();
  /// The same at the end of the path: what is left are the frames.
  std::vector<int> dropped_at_end();

  /// But for the stage, which is entered again.
  void carry(Archive& archive);

 private:
  static constexpr int spare = 4;
  struct Candidate {
    int step;
    double at;
    bool labelled;
  };
  double way_to(const PathPoint& point) const;
  double piece(double at) const;
  template <class Keep> void keep(const Keep& wanted);

  int frames_, every_;
  double size_, piece_;                // [1], the length of a piece
  PathTable stage_;
  State last_;                         // of the point before, on this branch
  int branch_ = -1;
  double at_ = 0;                      // how far that is
  int spares_ = 0;                     // candidates without label
  std::vector<Candidate> candidates_;
  std::vector<int> dropped_;
};

}  // namespace elamin
