#pragma once
// Which keys a problem file may hold: what its tables say of themselves, as a tree.
#include "input/keys.hpp"

#include <string>
#include <vector>

namespace elamin {

struct KeyTree {
  enum class Level { value, table, tables } level = Level::value;
  std::string name, means;                       // a table's own sentence too
  bool needed = false;
  std::string may_be, standard;                  // in words; the default as TOML, "" if there is none
  std::vector<std::string> words;                // that may stand there, if it is one of some words
  enum class Type { boolean, integer, number, string, list, word, other } type = Type::other;
  Range range;
  std::vector<std::string> only;                 // "shape = \"circle\"": where it belongs to a choice, in any of these
  std::vector<KeyTree> keys;                     // of a table, in its order
  bool names_numbers = false;                    // instead of keys it has numbers with names of the file's own
  /// Choices of a word among the keys: with these words those of its keys that are needed, and those that must not be there.
  struct Case { std::string by; std::vector<std::string> words, needed, own; };
  std::vector<Case> cases;
  /// What goes together.
  struct Rule { enum class Kind { at_most_one, one_at_least, with } kind; std::vector<std::string> keys, needed; };
  std::vector<Rule> rules;

  const KeyTree* find(const std::string& key) const;
  std::vector<std::string> names() const;
};

/// The whole of it.
const KeyTree& key_tree();

/// As a JSON schema (draft 2020-12), for editors.
std::string json_schema();

/// As the pages of a reference, in Markdown: docs/keys.md.
std::string key_reference();

}  // namespace elamin
