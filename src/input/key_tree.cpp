#include "input/key_tree.hpp"

#include "core/find.hpp"
#include "input/problem.hpp"
#include "input/reader.hpp"
#include "input/resolved.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace elamin {

namespace {

using Type = KeyTree::Type;

Type type_of(const Key& key, KeyValue value) {
  if (std::holds_alternative<bool*>(value)) return Type::boolean;
  if (std::holds_alternative<int*>(value)) return Type::integer;
  if (std::holds_alternative<double*>(value)) return Type::number;
  if (std::holds_alternative<std::string*>(value)) return Type::string;
  if (std::holds_alternative<Rest*>(value) || key.kind == Key::Kind::one_or_more || key.kind == Key::Kind::one_or_two) return Type::other;
  return Type::list;
}

/// The Keys that note what there is.
class TreeMaker : public Keys {
 public:
  explicit TreeMaker(KeyTree& tree) : tree_(tree) {}

  void about(const char* text) override { tree_.means = text; }
  void either(const char* by, const std::vector<Choice>& choices) override {
    for (const Choice& c : choices) {
      // Of many words the first one stands for all.
      const Names words(c.words.begin(), c.words.begin() + (c.words.size() > 3 ? 1 : static_cast<std::ptrdiff_t>(c.words.size())));
      const auto outer = std::exchange(only_, fmt::format("{} = \"{}\"{}", by, fmt::join(words, "\" or \""), c.words.size() > 3 ? ", …" : ""));
      const std::size_t at = tree_.cases.size();
      tree_.cases.push_back({by, {c.words.begin(), c.words.end()}, {}, {}});
      const auto outer_case = std::exchange(case_, static_cast<int>(at));
      c.keys();
      only_ = outer, case_ = outer_case;
    }
  }
  void numbers(NamedNumbers&) override { tree_.names_numbers = true; }
  void at_most_one(const Names& keys) override { rule(KeyTree::Rule::Kind::at_most_one, keys, {}); }
  void one_at_least(const Names& keys, const char*) override { rule(KeyTree::Rule::Kind::one_at_least, keys, {}); }
  void with(const Names& keys, const Names& needed, const char*) override { rule(KeyTree::Rule::Kind::with, keys, needed); }

 private:
  void rule(KeyTree::Rule::Kind kind, const Names& keys, const Names& needed) {
    tree_.rules.push_back({kind, {keys.begin(), keys.end()}, {needed.begin(), needed.end()}});
  }
  /// A key of more than one choice stands once.
  KeyTree& add(const char* name, bool needed) {
    if (case_ >= 0) {
      tree_.cases[case_].own.push_back(name);
      if (needed) tree_.cases[case_].needed.push_back(name);
    }
    const auto found = std::find_if(tree_.keys.begin(), tree_.keys.end(), [&](const KeyTree& k) { return k.name == name; });
    KeyTree& key = found != tree_.keys.end() ? *found : tree_.keys.emplace_back();
    key.name = name;
    if (!only_.empty()) key.only.push_back(only_);
    return key;
  }
  void note(const Key& from, Type type, const std::string& may_be, const std::string& standard) {
    KeyTree& key = add(from.name, from.needed);
    const bool again = !key.means.empty();       // in another choice
    append(key.means, from.means, "; ");
    append(key.may_be, may_be, ", or ");
    key.type = !again || key.type == type ? type : Type::other;
    key.range = again ? Range{std::min(key.range.lo, from.range.lo), std::max(key.range.hi, from.range.hi), key.range.above && from.range.above}
                      : from.range;
    key.needed = from.needed, key.standard = from.needed ? "" : standard;
    for (const std::string& word : from.words)
      if (!contains(key.words, word)) key.words.push_back(word);
  }
  static void append(std::string& to, const std::string& text, const char* between) {
    if (to.find(text) == std::string::npos) to += (to.empty() ? "" : between) + text;
  }
  bool value(const Key& key, KeyValue value, bool there) override {
    note(key, type_of(key, value), wanted(key, value), there ? to_toml(key, value) : "");
    return false;
  }
  bool choose(const Key& key, int& at) override {
    note(key, Type::word, "", at >= 0 ? fmt::format("\"{}\"", key.words[at]) : "");
    return true;
  }
  void below(const char* name, const Below& tables) override {
    KeyTree& key = add(name, false);
    key.level = tables.many ? KeyTree::Level::tables : KeyTree::Level::table;
    if (tables.count == 0) tables.add();
    KeyTree& held = key;
    TreeMaker maker(held);
    tables.each(0, maker);
  }

  KeyTree& tree_;
  std::string only_;
  int case_ = -1;
};

void append_table(std::string& text, const KeyTree& t, const std::string& path) {
  const bool many = t.level == KeyTree::Level::tables;
  const std::string name = path.empty() ? "The file" : fmt::format("`{}{}{}`", many ? "[[" : "[", path, many ? "]]" : "]");
  text += fmt::format("\n## {}\n\n{}\n", name, t.means);
  if (!t.names_numbers) text += "\n| key | is | default | what it means |\n|---|---|---|---|\n";
  for (const KeyTree& k : t.keys) {
    if (k.level != KeyTree::Level::value) continue;
    const std::string is = k.type == Type::word ? fmt::format("`\"{}\"`", fmt::join(k.words, "\"`, `\"")) : k.may_be;
    const std::string standard = k.needed ? k.only.empty() ? "needed" : "needed then" : k.standard.empty() ? "" : "`" + k.standard + "`";
    const std::string only = k.only.empty() ? "" : fmt::format(" (of `{}`)", fmt::join(k.only, "`, `"));
    text += fmt::format("| `{}` | {} | {} | {}{} |\n", k.name, is, standard, k.means, only);
  }
  const auto list = [](const std::vector<std::string>& names) { return fmt::format("`{}`", fmt::join(names, "`, `")); };
  if (!t.rules.empty()) text += "\n";
  for (const KeyTree::Rule& r : t.rules) switch (r.kind) {
    case KeyTree::Rule::Kind::at_most_one: text += fmt::format("- One at most of {}.\n", list(r.keys)); break;
    case KeyTree::Rule::Kind::one_at_least: text += fmt::format("- One at least of {}.\n", list(r.keys)); break;
    case KeyTree::Rule::Kind::with: text += fmt::format("- {} only with {}{}.\n", list(r.keys), r.needed.size() > 1 ? "one of " : "", list(r.needed));
  }
  for (const KeyTree& k : t.keys)
    if (k.level != KeyTree::Level::value) append_table(text, k, path.empty() ? k.name : path + "." + k.name);
}

}  // namespace

const KeyTree* KeyTree::find(const std::string& key) const {
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const KeyTree& k) { return k.name == key; });
  return found == keys.end() ? nullptr : &*found;
}

std::vector<std::string> KeyTree::names() const {
  std::vector<std::string> all;
  for (const KeyTree& k : keys) all.push_back(k.name);
  return all;
}

const KeyTree& key_tree() {
  static const KeyTree tree = [] {
    KeyTree root;
    root.level = KeyTree::Level::table;
    TreeMaker maker(root);
    ProblemFile file;
    describe(maker, file);
    return root;
  }();
  return tree;
}

std::string key_reference() {
  std::string text = "# The keys of a problem file\n\nWritten by `elamin schema --markdown`. Lengths, forces and times are in any consistent "
                     "units. Where a number stands, an expression of `[constants]` may: `\"t/2\"`.\n";
  append_table(text, key_tree(), "");
  return text;
}

namespace {

using Json = nlohmann::ordered_json;
using Type = KeyTree::Type;

Json any_required(const std::vector<std::string>& keys) {
  Json any = Json::array();
  for (const std::string& key : keys) any.push_back({{"required", {key}}});
  return {{"anyOf", any}};
}

Json schema_of(const KeyTree& t);

Json of_value(const KeyTree& k) {
  Json j{{"description", k.means}};
  switch (k.type) {
    case Type::boolean: j["type"] = "boolean"; break;
    case Type::string: j["type"] = "string"; break;
    case Type::list: j["type"] = "array"; break;
    case Type::integer:
    case Type::number:
      j["type"] = {k.type == Type::integer ? "integer" : "number", "string"};   // or an expression
      if (k.range.lo != range::any.lo) j[k.range.above ? "exclusiveMinimum" : "minimum"] = k.range.lo;
      if (k.range.hi != range::any.hi) j["maximum"] = k.range.hi;
      break;
    case Type::word: j["enum"] = k.words; break;
    case Type::other: break;
  }
  return j;
}

/// A table's keys, and what goes together as conditions on which of them are there.
Json of_table(const KeyTree& t) {
  Json j{{"type", "object"}, {"description", t.means}, {"additionalProperties", false}, {"properties", Json::object()}};
  if (t.names_numbers) j["additionalProperties"] = {{"type", {"number", "string"}}};
  std::vector<std::string> needed;
  for (const KeyTree& k : t.keys) {
    j["properties"][k.name] = schema_of(k);
    if (k.needed && k.only.empty()) needed.push_back(k.name);
  }
  if (!needed.empty()) j["required"] = needed;
  Json all = Json::array();
  for (const KeyTree::Rule& r : t.rules) {
    if (r.kind == KeyTree::Rule::Kind::one_at_least) all.push_back(any_required(r.keys));
    for (std::size_t i = 0; r.kind == KeyTree::Rule::Kind::at_most_one && i < r.keys.size(); ++i)
      for (std::size_t k = 0; k < i; ++k) all.push_back({{"not", {{"required", {r.keys[k], r.keys[i]}}}}});
    if (r.kind == KeyTree::Rule::Kind::with)
      for (const std::string& key : r.keys) all.push_back({{"if", {{"required", {key}}}}, {"then", any_required(r.needed)}});
  }
  for (const KeyTree::Case& c : t.cases) {
    const KeyTree* by = t.find(c.by);
    Json condition{{"properties", {{c.by, {{"enum", c.words}}}}}};
    const bool standard = by && std::any_of(c.words.begin(), c.words.end(), [&](const std::string& w) { return by->standard == '"' + w + '"'; });
    if (!standard) condition["required"] = {c.by};
    if (!c.needed.empty()) all.push_back({{"if", condition}, {"then", {{"required", c.needed}}}});
  }
  if (!all.empty()) j["allOf"] = all;
  return j;
}

Json schema_of(const KeyTree& t) {
  if (t.level == KeyTree::Level::value) return of_value(t);
  if (t.level == KeyTree::Level::table) return of_table(t);
  return {{"type", "array"}, {"items", of_table(t)}};
}

}  // namespace

std::string json_schema() {
  Json j{{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "A problem file of elamin"}};
  j.update(of_table(key_tree()));
  return j.dump(1) + "\n";
}

}  // namespace elamin
