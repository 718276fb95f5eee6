#pragma once
// The films of a run: its stored states, one behind the other, for other programs.
#include "core/archive.hpp"
#include "core/text_file.hpp"
#include "results/results_directory.hpp"
#include "results/shot.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace elamin {

// A file of frames, one behind the other, of which some may go again.

/// The file is whole after each call: the header, the frames in their order, the footer.
class Reel {
 public:
  /// Creates the file. Throws OutputError if it cannot be written, as the others do.
  explicit Reel(std::string file, const std::string& header = "", std::string footer = "");
  /// The same of a file that is there, with the frames that the archive tells of: what came later is cut off. `dropping`: the run was stopped while it
  /// dropped frames, as its size tells or not; the same call of drop() comes next.
  Reel(std::string file, const std::string& header, std::string footer, Archive& archive, bool dropping);
  void carry(Archive& archive) { archive(frames_, end_); }
  void add(std::int64_t step, const std::string& text);
  void drop(const std::set<std::int64_t>& steps);
  /// The same, and what is left is changed; nothing: the file stays as it was, and the answer is no.
  bool drop(const std::set<std::int64_t>& steps, const std::function<std::optional<std::string>(const std::string&)>& changed);

 private:
  struct Frame {
    std::int64_t step;
    std::size_t bytes;
  };

  std::string file_, header_, footer_;
  std::vector<Frame> frames_;
  std::size_t end_ = 0;                    // of the frames, from the beginning of the file
  bool dropped_ = false;               // the next call of drop() has been carried out already
  GrowingFile out_;
};

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
  /// The same, and no more frames will come: those of the .lammpstrj get one and the same box, around all of them. No: it
  /// was interrupted, where some files may be at their end, as `dropping` takes them up.
  bool finish(const std::set<std::int64_t>& dropped);
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
