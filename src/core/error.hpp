#pragma once
// What ends a run with a sentence. Wrong input is reported all at once: a list of sentences, each with the place it is about.
#include <stdexcept>
#include <string>
#include <vector>

namespace elamin {

/// Where something stands in a file, line and column from 1; line 0: it came from the command line.
struct Place { int line = 0, column = 0; };

/// One mistake: `file:line:column: key: what is wrong; what is allowed`. Line 0: no place in a file.
struct Mistake {
  std::string file;
  int line = 0, column = 0;
  std::string key, what;
  std::string sentence() const;
};

/// Wrong input; what() is one sentence a line, in the order of the file.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<Mistake> mistakes);
  explicit InputError(const std::string& what) : InputError(std::vector<Mistake>{Mistake{{}, 0, 0, {}, what}}) {}
  const std::vector<Mistake>& mistakes() const { return mistakes_; }

 private:
  std::vector<Mistake> mistakes_;
};

/// What was computed cannot be kept, as on a disk that is full; what() is `file: cannot be written: the system's reason`.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace elamin
