#pragma once
// Reads the tables of a document into structs, by the schema. Nothing is thrown: every mistake is collected.
#include "input/document.hpp"
#include "input/mistakes.hpp"
#include "input/schema.hpp"
#include "core/suggest.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace elamin {

/// One table of the document. `key` is what --set calls it ("beam.column"), `kind` what the schema does ("beam").
class Reader {
 public:
  static constexpr bool reading = true;
  Reader(const Entries& entries, Place place, std::string key, std::string kind, const std::string& folder,
         Mistakes& mistakes);

  bool has(const char* key) const { return elamin::find(entries_, key) != nullptr; }

  template <class T> void may(const char* key, T& value, Range limits = {}) {
    if (const Node* node = find(key)) read(key, *node, value, limits);
  }
  template <class T> void may(const char* key, std::optional<T>& value, Range limits = {}) {
    if (const Node* node = find(key))
      if (T read_value{}; read(key, *node, read_value, limits)) value = std::move(read_value);
  }
  template <class T> void must(const char* key, T& value, Range limits = {}) {
    if (const Node* node = find(key))
      read(key, *node, value, limits);
    else
      missing(key, wanted(value, limits));
  }
  template <class T> void must(const char* key, std::optional<T>& value, Range limits = {}) {
    if (find(key))
      may(key, value, limits);
    else
      missing(key, wanted(T{}, limits));
  }
  void one_or_more(const char* key, std::vector<std::string>& list);
  void one_or_more(const char* key, std::optional<std::vector<std::string>>& list) {
    if (find(key)) one_or_more(key, list.emplace());
  }
  void must_one_or_more(const char* key, std::vector<std::string>& list) {
    if (find(key)) one_or_more(key, list);
    else missing(key, "a string or a list of strings");
  }
  void one_or_two(const char* key, std::vector<double>& values, Range limits);
  void center(const char* key, Vec3& value, int axis);
  void foreign(const char* key, const std::string& what);
  void name(const char* key, std::string& value);
  void may_name(const char* key, std::string& value) {
    if (find(key)) name(key, value);
  }
  void file(const char* key, std::string& value);
  void may_file(const char* key, std::string& value) {
    if (find(key)) file(key, value);
  }
  void raw(const char* key, std::vector<std::string>& values);

  template <class T, class W, std::size_t n> bool word(const char* key, T& value, const Word<W> (&words)[n]) {
    const Node* node = find(key);
    if (!node) return true;
    const int i = one_of(key, *node, texts(words));
    if (i >= 0) value = words[i].value;
    return i >= 0;
  }
  template <class T, class W, std::size_t n> bool must_word(const char* key, T& value, const Word<W> (&words)[n]) {
    if (find(key)) return word(key, value, words);
    missing(key, quoted_choice(texts(words)));
    return false;
  }
  template <std::size_t n>
  void words(const char* key, std::vector<std::string>& list, const Word<const char*> (&known)[n]) {
    if (const Node* node = find(key)) some_of(key, *node, texts(known), list);
  }

  template <class T> void table(const char* key, T& value) {
    const Node* node = find(key);
    if (!node) return;
    if (const auto* entries = std::get_if<Entries>(&node->value))
      read_table(*entries, node->place, inside(key), key, value);
    else
      wrong(key, *node, "a table [" + kind_of(key) + "]");
  }
  template <class T> void table(const char* key, std::optional<T>& value) {
    if (find(key)) table(key, value.emplace());
  }
  template <class T> void tables(const char* key, std::vector<T>& list) {
    const Node* node = find(key);
    if (!node) return;
    if (!is_tables(*node)) return wrong(key, *node, "tables with double brackets, [[" + kind_of(key) + "]]");
    for (const Node& element : std::get<List>(node->value)) {
      const auto& entries = std::get<Entries>(element.value);
      const std::string name = label(entries, list.size());
      read_table(entries, element.place, inside(key) + "." + name, key, list.emplace_back());
    }
  }

  void skip_the_rest() { skip_ = true; }
  /// Refuses what nothing asked for; returns where the table stands.
  TablePlace finish();

 private:
  template <class T> void read_table(const Entries& entries, Place place, std::string key, const char* kind, T& value) {
    Reader reader(entries, place, std::move(key), kind_of(kind), folder_, mistakes_);
    describe(reader, value);
    value.place = reader.finish();
    if (value.place.broken) place_.broken = true;
  }

  const Node* find(const char* key);
  bool read(const char* key, const Node&, bool&, Range);
  bool read(const char* key, const Node&, int&, Range);
  bool read(const char* key, const Node&, double&, Range);
  bool read(const char* key, const Node&, std::string&, Range);
  bool read(const char* key, const Node&, Vec3&, Range);
  bool read(const char* key, const Node&, std::vector<int>&, Range);
  bool read(const char* key, const Node&, std::vector<double>&, Range);
  bool read(const char* key, const Node&, std::vector<Vec3>&, Range);
  bool read(const char* key, const Node&, std::vector<std::vector<int>>&, Range);
  bool read(const char* key, const Node&, std::array<double, 2>&, Range);
  bool read(const char* key, const Node&, std::array<std::string, 2>&, Range);
  bool read(const char* key, const Node&, Rest&, Range);
  static std::string wanted(bool, Range) { return "true or false"; }
  static std::string wanted(int, Range);
  static std::string wanted(double, Range);
  static std::string wanted(const std::string&, Range) { return "a string"; }
  static std::string wanted(const Vec3&, Range) { return "a list of three numbers [x, y, z]"; }
  static std::string wanted(const std::vector<Vec3>&, Range) { return "a list of points [[x, y, z], …], at least one"; }
  static std::string wanted(const std::array<double, 2>&, Range) { return "a list of two positive numbers"; }
  static std::string wanted(const std::array<std::string, 2>&, Range) { return "a list of the names of two groups"; }

  template <class W, std::size_t n> static std::vector<std::string> texts(const Word<W> (&words)[n]) {
    std::vector<std::string> all;
    for (const auto& w : words) all.push_back(w.text);
    return all;
  }
  int one_of(const char* key, const Node&, const std::vector<std::string>& known);
  void some_of(const char* key, const Node&, const std::vector<std::string>& known, std::vector<std::string>& list);

  void missing(const char* key, const std::string& wanted);
  void wrong(const char* key, const Node&, const std::string& wanted);
  void mistake(Place at, const std::string& key, const std::string& what);
  /// Of an element of [[…]]: its name, or its number.
  static std::string label(const Entries& entries, std::size_t index);
  std::string inside(const std::string& key) const { return key_.empty() ? key : key_ + "." + key; }
  std::string kind_of(const std::string& key) const { return kind_.empty() ? key : kind_ + "." + key; }

  const Entries& entries_;
  std::string key_, kind_;
  const std::string& folder_;
  Mistakes& mistakes_;
  TablePlace place_;
  std::vector<std::string> known_;   // keys asked for
  bool skip_ = false;
};

/// Whether a word may be the name of something: letters, digits, '_' and '-', a letter first, at most 64.
bool is_name(const std::string& word);

}  // namespace elamin
