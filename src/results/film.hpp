#pragma once
// The films of a run: its stored states, one behind the other, for other programs.
#include "results/reel.hpp"
#include "results/results_directory.hpp"
#include "results/shot.hpp"

#include <map>

namespace elamin {

/// By the words of film_words: "lammpstrj": NAME.lammpstrj (see dump_frame; of a model with particles and bodies these in
/// NAME.bodies.lammpstrj) and NAME.data, the first state as a topology; "xyz": NAME.xyz, see xyz_frame; "pvd": NAME.pvd, a list of
/// frames/STEP.vtu (see write_vtu) by step or time. All of them are whole after each call.
class Film {
 public:
  /// name: "path" or "trajectory". The directory must outlive this. Throws OutputError if something cannot be written, as the others do.
  Film(ResultsDirectory& directory, std::string name, const std::vector<std::string>& words, std::string title);
  void add(const Shot& shot);
  /// The files frames/STEP.vtu stay.
  void drop(const std::set<std::int64_t>& steps);
  /// The same, and no more frames will come: those of the .lammpstrj get one and the same box, around all of them.
  void finish(const std::set<std::int64_t>& dropped);
  /// Reading, `dropping` as Reel has it.
  void carry(Archive& archive, bool dropping = false);
  explicit operator bool() const { return !words_.empty(); }

 private:
  void add_dump(const std::string& end, const Shot& shot, bool of_bodies);
  Reel& reel(const std::string& end);

  ResultsDirectory& directory_;
  std::string name_, title_;
  std::set<std::string> words_;
  std::map<std::string, Reel> reels_;  // by the end of the name
  std::map<std::string, Box> boxes_;   // … of the .lammpstrj, around all frames so far
};

}  // namespace elamin
