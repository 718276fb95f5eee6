#pragma once
// A file of frames, one behind the other, of which some may go again.
#include <cstdint>
#include <fstream>
#include <functional>
#include <set>
#include <string>
#include <vector>

namespace elamin {

/// The file is whole after each call: the header, the frames in their order, the footer.
class Reel {
 public:
  /// Creates the file. Throws InputError if it cannot be written, as the others do.
  explicit Reel(std::string file, const std::string& header = "", std::string footer = "");
  void add(std::int64_t step, const std::string& text);
  void drop(const std::set<std::int64_t>& steps);
  /// The same, and what is left is changed.
  void drop(const std::set<std::int64_t>& steps, const std::function<std::string(const std::string&)>& changed);

 private:
  struct Frame {
    std::int64_t step;
    std::size_t bytes;
  };
  void check() const;

  std::string file_, header_, footer_;
  std::vector<Frame> frames_;
  std::size_t end_;                    // of the frames, from the beginning of the file
  std::ofstream out_;
};

}  // namespace elamin
