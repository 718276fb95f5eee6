#pragma once
// Which keys there are: the schema as a tree of names.
#include "input/schema.hpp"

#include <string>
#include <utility>
#include <vector>

namespace elamin {

struct KeyTree {
  enum class Kind { value, table, tables } kind = Kind::value;
  std::vector<std::pair<std::string, KeyTree>> keys;   // of a table, in the order of the schema
  const KeyTree* find(const std::string& key) const {
    for (const auto& [name, tree] : keys)
      if (name == key) return &tree;
    return nullptr;
  }
  std::vector<std::string> names() const {
    std::vector<std::string> all;
    for (const auto& entry : keys) all.push_back(entry.first);
    return all;
  }
};

/// The io of `describe` that notes the names alone.
class Keys {
 public:
  static constexpr bool reading = false;
  explicit Keys(KeyTree& tree) : tree_(tree) {}
  template <class T> void may(const char* key, T&, Range = {}) { add(key); }
  template <class T> void must(const char* key, T&, Range = {}) { add(key); }
  template <class T> void one_or_more(const char* key, T&) { add(key); }
  template <class T> void must_one_or_more(const char* key, T&) { add(key); }
  void one_or_two(const char* key, std::vector<double>&, Range) { add(key); }
  void center(const char* key, Vec3&, int) { add(key); }
  void foreign(const char* key, const std::string&) { add(key); }
  void name(const char* key, std::string&) { add(key); }
  void may_name(const char* key, std::string&) { add(key); }
  void file(const char* key, std::string&) { add(key); }
  void may_file(const char* key, std::string&) { add(key); }
  void raw(const char* key, std::vector<std::string>&) { add(key); }
  template <class T, class Words> bool word(const char* key, T&, const Words&) { return add(key), true; }
  template <class T, class Words> bool must_word(const char* key, T&, const Words&) { return add(key), true; }
  template <class Words> void words(const char* key, std::vector<std::string>&, const Words&) { add(key); }
  template <class T> void table(const char* key, T& value) { descend(key, KeyTree::Kind::table, value); }
  template <class T> void table(const char* key, std::optional<T>&) {
    T value;
    descend(key, KeyTree::Kind::table, value);
  }
  template <class T> void tables(const char* key, std::vector<T>&) {
    T value;
    descend(key, KeyTree::Kind::tables, value);
  }
  void skip_the_rest() {}

 private:
  KeyTree& add(const char* key) { return tree_.keys.emplace_back(key, KeyTree{}).second; }
  template <class T> void descend(const char* key, KeyTree::Kind kind, T& value) {
    KeyTree& below = add(key);
    below.kind = kind;
    Keys keys(below);
    describe(keys, value);
  }
  KeyTree& tree_;
};

}  // namespace elamin
