#include "input/key_tree.hpp"

#include "input/problem.hpp"
#include "input/reader.hpp"
#include "input/resolved.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
      if (std::find(key.words.begin(), key.words.end(), word) == key.words.end()) key.words.push_back(word);
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

}  // namespace elamin
