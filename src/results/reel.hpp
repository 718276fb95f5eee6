#pragma once
// A file of frames, one behind the other, of which some may go again.
#include "core/archive.hpp"
#include "core/text_file.hpp"

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace elamin {

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
  /// The same, and what is left is changed.
  void drop(const std::set<std::int64_t>& steps, const std::function<std::string(const std::string&)>& changed);

 private:
  struct Frame {
    std::int64_t step;
    std::size_t bytes;
    void carry(Archive& archive) { archive(step, bytes); }
  };

  std::string file_, header_, footer_;
  std::vector<Frame> frames_;
  std::size_t end_ = 0;                    // of the frames, from the beginning of the file
  bool dropped_ = false;               // the next call of drop() has been carried out already
  GrowingFile out_;
};

}  // namespace elamin
