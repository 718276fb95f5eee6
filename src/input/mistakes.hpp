#pragma once
// Collects what is wrong with a problem file, so that everything is told in one go.
#include "core/error.hpp"
#include "input/table.hpp"

#include <string>
#include <vector>

namespace elamin {

class Mistakes {
 public:
  explicit Mistakes(std::string file) : file_(std::move(file)) {}

  const std::string& file() const { return file_; }
  bool any() const { return !list_.empty(); }
  const std::vector<Mistake>& list() const { return list_; }

  /// A mistake at a place of the file; line 0: of the command line.
  void add(Place at, const std::string& key, const std::string& what) {
    keep({at.line > 0 ? file_ : "--set", at.line, at.column, key, what});
  }
  /// A mistake of a key of a table: at its value if it is written, else at the table.
  void add(const TablePlace& table, const std::string& key, const std::string& what) {
    const auto found = table.keys.find(key);
    add(found == table.keys.end() ? Place{table} : found->second, table.key + "." + key, what);
  }
  /// A mistake of a table as a whole.
  void add(const TablePlace& table, const std::string& what) { add(Place{table}, table.key, what); }
  /// The same, and marks the table as broken.
  void add(TablePlace& table, const std::string& key, const std::string& what) {
    table.broken = true;
    add(static_cast<const TablePlace&>(table), key, what);
  }
  void add(TablePlace& table, const std::string& what) {
    table.broken = true;
    add(static_cast<const TablePlace&>(table), what);
  }
  /// A mistake of the file as a whole.
  void add(const std::string& what) { keep({file_, 0, 0, {}, what}); }
  void add(const std::vector<Mistake>& others) {
    for (const Mistake& m : others) keep(m);
  }

  /// Throws InputError, which has the order of the file, if there is any.
  void raise() const {
    if (!any()) return;
    std::vector<Mistake> all = list_;
    if (left_out_ > 0)
      all.push_back({file_, 0, 0, {}, "has " + std::to_string(left_out_) + " more mistakes than are told here"});
    throw InputError(std::move(all));
  }

 private:
  static constexpr std::size_t most = 200;   // further ones are counted, not kept
  void keep(Mistake m) {
    if (list_.size() >= most)
      ++left_out_;
    else
      list_.push_back(std::move(m));
  }
  std::string file_;
  std::vector<Mistake> list_;
  std::size_t left_out_ = 0;
};

}  // namespace elamin
