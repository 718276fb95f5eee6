#pragma once
// Reads the tables of a document into structs, as they describe themselves. Nothing is thrown: every mistake is collected.
#include "input/constants.hpp"
#include "input/document.hpp"
#include "input/keys.hpp"

#include <string>
#include <vector>

namespace elamin {

/// One table of the document. `key` is what --set calls it ("beam.column"), `kind` what the schema does ("beam"). Numbers are those of the
/// file or expressions of the constants, to which the table [constants] adds.
class Reader : public Keys {
 public:
  Reader(const Entries& entries, Place place, std::string key, std::string kind, const std::string& folder, Constants& constants,
         Mistakes& mistakes);

  void either(const char* by, const std::vector<Choice>& choices) override;
  void numbers(NamedNumbers& list) override;
  void skip_the_rest() override { skip_ = true; }
  void at_most_one(const Names& keys) override;
  void one_at_least(const Names& keys, const char* wanted) override;
  void with(const Names& keys, const Names& needed, const char* what) override;

  /// Refuses what nothing asked for; returns where the table stands.
  TablePlace finish();

 private:
  bool value(const Key& key, KeyValue value, bool there) override;
  bool choose(const Key& key, int& at) override;
  void below(const char* key, const Below& tables) override;
  void read_table(const Entries& entries, Place place, const std::string& key, const std::string& kind, const Below& tables, std::size_t i);

  /// The entry of a key that is asked for, or null.
  const Node* find(const char* key);
  bool has(const char* key) const { return elamin::find(entries_, key) != nullptr; }

  /// A number, or the value of an expression; none after a mistake. `is`: what it is, for messages; `wanted`: what it must be.
  std::optional<double> number(const Key&, const Node&, const std::string& wanted, std::string& is);

  bool read(const Key&, const Node&, bool&);
  bool read(const Key&, const Node&, int&);
  bool read(const Key&, const Node&, double&);
  bool read(const Key&, const Node&, std::string&);
  bool read(const Key&, const Node&, Vec3&);
  bool read(const Key&, const Node&, Rest&);
  bool read(const Key&, const Node&, std::vector<std::string>&);
  template <class T> bool read(const Key&, const Node&, std::array<T, 2>&);
  template <class T> bool read(const Key&, const Node&, std::vector<T>&);
  bool read_one_or_two(const Key&, const Node&, std::vector<double>&);
  bool read_center(const Key&, const Node&, Vec3&);
  bool read_file(const Key&, const Node&, std::string&);
  bool read_words(const Key&, const Node&, std::vector<std::string>&);
  int one_of(const Key&, const Node&);

  void missing(const char* key, const std::string& wanted);
  bool wrong(const Key& key, const Node& node, const std::string& wanted) { return wrong(key, node, wanted, shown(node)); }
  bool wrong(const Key& key, const Node& node, const std::string& wanted, const std::string& is);
  void mistake(Place at, const std::string& key, const std::string& what);
  std::string inside(const std::string& key) const { return key_.empty() ? key : key_ + "." + key; }

  const Entries& entries_;
  std::string key_, kind_;
  const std::string& folder_;
  Constants& constants_;
  Mistakes& mistakes_;
  TablePlace place_;
  std::vector<std::string> known_;            // keys asked for
  std::vector<std::string>* others_ = nullptr;   // while the keys of a choice that was not taken are gone through: their names
  bool skip_ = false;
};

/// What a key may be: "an integer from 1 to 9", "a list of three numbers [x, y, z]".
std::string wanted(const Key& key, KeyValue value);

/// Whether a word may be the name of something: letters, digits, '_' and '-', a letter first, at most 64.
bool is_name(const std::string& word);

}  // namespace elamin
