#include "input/settings.hpp"

#include "core/error.hpp"
#include "input/key_tree.hpp"
#include "core/suggest.hpp"
#include "core/text.hpp"

#include <fmt/format.h>

namespace elamin {
namespace {

/// A number from 1, or 0.
std::size_t index_of(const std::string& part) {
  std::size_t number = 0;
  return reads_as(part, number) ? number : 0;
}

std::string name_of(const Node& element) {
  const Node* name = find(std::get<Entries>(element.value), "name");
  const auto* text = name ? std::get_if<std::string>(&name->value) : nullptr;
  return text ? *text : "";
}

/// Walks a dotted key through document and schema; tables and keys that are missing are made.
class Walk {
 public:
  Walk(const std::string& key, Entries& root) : parts_(parts_of(key, ".")), entries_(&root) {}

  /// The place for the value; null if the key addresses nothing, and then why() says so.
  Node* end() {
    while (true) {
      const std::string part = parts_[at_];
      if (tree_->names_numbers) return constant(part);
      const KeyTree* child = tree_->find(part);
      if (!child) return unknown(part);
      canonical_ += fmt::format("{}{}", at_ ? "." : "", part);
      ++at_;
      if (child->level == KeyTree::Level::value) return value(*child, part);
      if (at_ == parts_.size() && child->names_numbers) return refuse("is a table; name one of its numbers");
      if (at_ == parts_.size()) return refuse("is a table; name one of its keys: " + listed(child->names()));
      tree_ = child;
      if (!(child->level == KeyTree::Level::table ? table(part) : element(part))) return nullptr;
      if (at_ == parts_.size()) return refuse("is a table; name one of its keys: " + listed(child->names()));
    }
  }
  const std::string& why() const { return why_; }
  const std::string& canonical() const { return canonical_; }
  /// Whether what is there is a number, so that an expression may be.
  bool is_number() const { return is_number_; }
  bool is_integer() const { return is_integer_; }

 private:
  Node* refuse(const std::string& why) {
    why_ = why;
    return nullptr;
  }
  Node* unknown(const std::string& part) {
    return refuse(fmt::format("{} is no key; allowed: {}{}", in_quotes(part), listed(tree_->names()), did_you_mean(part, tree_->names())));
  }
  /// One of [constants], which must be there: nothing would use another.
  Node* constant(const std::string& part) {
    std::vector<std::string> names;
    for (const Entry& e : *entries_) names.push_back(e.key);
    Node* node = find(*entries_, part);
    if (!node || at_ + 1 < parts_.size())
      return refuse(fmt::format("{} is no constant of this file; {}", in_quotes(part), there_are(names, part)));
    canonical_ += "." + part;
    is_number_ = true;
    return node;
  }
  Node* value(const KeyTree& key, const std::string& part) {
    is_number_ = key.type == KeyTree::Type::number || key.type == KeyTree::Type::integer || key.type == KeyTree::Type::list;
    is_integer_ = key.type == KeyTree::Type::integer;
    Node* node = find(*entries_, part);
    if (at_ == parts_.size()) {
      return node ? node : &entries_->emplace_back(Entry{part, {}, {}}).node;
    }
    auto* list = node ? std::get_if<List>(&node->value) : nullptr;
    const std::size_t number = index_of(parts_[at_]);
    if (!list || at_ + 1 < parts_.size() || number < 1 || number > list->size())
      return refuse(list ? fmt::format("has components 1 to {}", list->size())
                         : fmt::format("{} is a value, not a table", in_quotes(part)));
    canonical_ += fmt::format(".{}", number);
    return &(*list)[number - 1];
  }
  bool table(const std::string& part) {
    Node* node = find(*entries_, part);
    if (!node) {
      node = &entries_->emplace_back(Entry{part, {}, {}}).node;
      node->value = Entries{};
    }
    entries_ = std::get_if<Entries>(&node->value);
    return entries_ || refuse(in_quotes(part) + " is not a table in this file");
  }
  bool element(const std::string& part) {
    Node* node = find(*entries_, part);
    if (!node || !is_tables(*node)) return refuse("there is no [[" + part + "]] in this file");
    List& list = std::get<List>(node->value);
    const std::string& which = parts_[at_++];
    const std::size_t number = index_of(which);
    std::vector<std::string> names;
    for (std::size_t i = 0; i < list.size(); ++i) {
      names.push_back(name_of(list[i]).empty() ? std::to_string(i + 1) : name_of(list[i]));
      if (number == i + 1 || (number == 0 && names.back() == which)) {
        entries_ = &std::get<Entries>(list[i].value);
        canonical_ += fmt::format(".{}", i + 1);
        return true;
      }
    }
    refuse(fmt::format("no [[{}]] is {}; there are: {}{}", part, in_quotes(which), listed(names), did_you_mean(which, names)));
    return false;
  }

  std::vector<std::string> parts_;
  std::size_t at_ = 0;
  Entries* entries_;
  const KeyTree* tree_ = &key_tree();
  std::string why_, canonical_;
  bool is_number_ = false, is_integer_ = false;
};

}  // namespace

Setting parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw InputError({Mistake{"--set", 0, 0, in_quotes(text), "must be KEY=VALUE, such as path.steps=50"}});
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void apply(const Setting& setting, Document& document, Mistakes& mistakes) {
  if (!is_text(setting.key)) return mistakes.add(setting.place, "", "its key is not a text in UTF-8");
  if (!is_text(setting.value)) return mistakes.add(setting.place, setting.key, "is not a text in UTF-8");
  Walk walk(setting.key, document.root);
  if (Node* node = walk.end())
    *node = parse_value(setting.value, setting.place);
  else
    mistakes.add(setting.place, in_quotes(setting.key), walk.why());
}

std::string computed(const Setting& setting, const Document& document, const Constants& constants) {
  const Node node = parse_value(setting.value, setting.place);
  const auto* text = std::get_if<std::string>(&node.value);
  if (!text) return setting.value;
  Entries root = document.root;
  Walk walk(setting.key, root);
  if (!walk.end() || !walk.is_number()) return setting.value;
  const std::optional<double> x = constants.value(*text).value;
  if (!x) return setting.value;
  const std::optional<double> integer = walk.is_integer() ? nearly_integer(*x) : std::nullopt;
  return integer ? fmt::format("{:.0f}", *integer) : to_toml(*x);
}

std::string wrong_number(const std::string& key, const Document& document) {
  Entries root = document.root;
  Walk walk(key, root);
  const Node* node = walk.end();
  if (!node) return walk.why();
  if (walk.is_integer()) return in_quotes(key) + " is a whole number; a curve needs a key that may have any value";
  return !walk.is_number() || std::holds_alternative<List>(node->value) ? in_quotes(key) + " is no number" : "";
}

bool has_table(const std::string& key) {
  const KeyTree* tree = key_tree().find(key);
  return tree && tree->level != KeyTree::Level::value;
}

std::string canonical_key(const std::string& key, const Document& document) {
  Entries root = document.root;
  Walk walk(key, root);
  return walk.end() ? walk.canonical() : "";
}

}  // namespace elamin
