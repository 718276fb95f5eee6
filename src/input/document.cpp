#include "input/document.hpp"

#include "core/error.hpp"
#include "core/suggest.hpp"
#include "core/text.hpp"
#include "input/lammps.hpp"
#include "input/reader.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <sstream>

namespace elamin {

namespace {

Place place_of(const toml::source_region& region) {
  return {static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Node convert(const toml::node& from) {
  Node to;
  to.place = place_of(from.source());
  if (const auto* table = from.as_table()) {
    Entries entries;
    for (const auto& [key, node] : *table)
      entries.push_back({std::string(key.str()), place_of(key.source()), convert(node)});
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
      return std::pair(a.place.line, a.place.column) < std::pair(b.place.line, b.place.column);
    });
    to.value = std::move(entries);
  } else if (const auto* array = from.as_array()) {
    List list;
    for (const toml::node& node : *array) list.push_back(convert(node));
    to.value = std::move(list);
  } else if (const auto* text = from.as_string()) {
    to.value = text->get();
  } else if (const auto* integer = from.as_integer()) {
    to.value = integer->get();
  } else if (const auto* real = from.as_floating_point()) {
    to.value = real->get();
  } else if (const auto* flag = from.as_boolean()) {
    to.value = flag->get();
  } else {
    std::ostringstream written;
    written << toml::node_view<const toml::node>(from);
    to.value = Date{written.str()};
  }
  return to;
}

/// What the parser must not see, found by going through the text outside strings and comments: a dotted key of more
/// parts than any key has (it takes a level of the stack for each), and characters beyond ASCII (undefined in toml++
/// 3.3, and no TOML there). Returns the offset and what is wrong; npos: nothing.
std::pair<std::size_t, const char*> unparsable(const std::string& text) {
  constexpr int most = 16;
  int parts = 1;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (c == '#') {
      i = std::min(text.find('\n', i), text.size());
      parts = 1;
    } else if (c == '"' || c == '\'') {
      const std::string quote(text.compare(i, 3, std::string(3, c)) == 0 ? 3 : 1, c);
      for (i += quote.size(); i < text.size() && text.compare(i, quote.size(), quote) != 0; ++i) {
        if (c == '"' && text[i] == '\\') ++i;
        if (i < text.size() && text[i] == '\n' && quote.size() == 1) break;  // an error of the text; the parser says so
      }
      i += quote.size() - 1;
      for (int more = 0; more < 2 && quote.size() == 3 && i + 1 < text.size() && text[i + 1] == c; ++more) ++i;
    } else if (c == '.') {
      if (++parts > most) return {i, "a dotted key has more than 16 parts; no key has so many"};
    } else if (static_cast<unsigned char>(c) >= 0x80) {
      return {i, "not TOML: outside of quotes there are only ASCII characters"};
    } else if (std::string_view(",=[]{}\n").find(c) != std::string_view::npos) {
      parts = 1;
    }
  }
  return {std::string::npos, nullptr};
}

Entries parse(const std::string& text, const std::string& file) {
  const auto refuse = [&](Place at, std::string what) {
    for (char& c : what)
      if (static_cast<unsigned char>(c) < 0x20) c = ' ';
    throw InputError({Mistake{file, at.line, at.column, {}, what}});
  };
  if (const auto [offset, what] = unparsable(text); what) refuse(place_in(text, offset), what);
  try {
    return std::get<Entries>(convert(toml::parse(std::string_view(text))).value);
  } catch (const toml::parse_error& e) {
    refuse(place_of(e.source()), "not TOML: " + std::string(e.description()));
  }
  return {};
}

}  // namespace

void set_place(Node& node, Place place) {
  node.place = place;
  if (auto* list = std::get_if<List>(&node.value))
    for (Node& n : *list) set_place(n, place);
  if (auto* entries = std::get_if<Entries>(&node.value))
    for (Entry& e : *entries) e.place = place, set_place(e.node, place);
}

Document parse_document(const std::string& text, const std::string& file) {
  Document document{file, sha256(text), parse(std::string(without_mark(text)), file), {}};
  take_lammps_input(document);
  return document;
}

Entries parse_entries(const std::string& text, const std::string& file) { return parse(text, file); }

Document read_document(const std::string& file) { return parse_document(read_text(file), file); }

Node parse_value(const std::string& text, Place place) {
  Node node;
  node.value = text;
  try {
    Entries entries = parse("value = " + text, "");
    if (entries.size() == 1 && entries[0].key == "value") node = std::move(entries[0].node);
  } catch (const InputError&) {
    // not a TOML value: a bare word
  }
  set_place(node, place);
  return node;
}

Node* find(Entries& entries, const std::string& key) {
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.key == key; });
  return found == entries.end() ? nullptr : &found->node;
}
const Node* find(const Entries& entries, const std::string& key) { return find(const_cast<Entries&>(entries), key); }

bool is_tables(const Node& node) {
  const auto* list = std::get_if<List>(&node.value);
  return list && std::all_of(list->begin(), list->end(), [](const Node& n) { return std::holds_alternative<Entries>(n.value); });
}

std::string shown(const Node& node) {
  if (const auto* flag = std::get_if<bool>(&node.value)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&node.value)) return std::to_string(*integer);
  if (const auto* real = std::get_if<double>(&node.value)) {
    const std::string digits = fmt::format("{}", *real);
    return digits.find_first_of(".en") == std::string::npos ? digits + ".0" : digits;   // 10.0 is no integer
  }
  if (const auto* text = std::get_if<std::string>(&node.value)) return "the string " + in_quotes(*text);
  if (const auto* date = std::get_if<Date>(&node.value)) return "the date or time " + date->text;
  if (std::holds_alternative<Entries>(node.value)) return "a table";
  return "a list of " + std::to_string(std::get<List>(node.value).size());
}

std::string to_toml(double value) {
  std::string text = fmt::format("{}", value);      // as few digits as read back to the same double
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string to_toml(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\')
      text += '\\', text += c;
    else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
      text += fmt::format("\\u{:04X}", static_cast<unsigned char>(c));
    else
      text += c;
  }
  return text + '"';
}

std::string to_toml(const Document& document) {
  const auto key = [](const Entry& e) { return is_name(e.key) ? e.key : to_toml(e.key); };
  const auto lines = [&](const Entries& entries) {
    std::string text;
    for (const Entry& e : entries) text += key(e) + " = " + to_toml(e.node) + "\n";
    return text;
  };
  Entries top;
  std::string tables;
  for (const Entry& e : document.root) {
    if (const auto* entries = std::get_if<Entries>(&e.node.value))
      tables += "\n[" + key(e) + "]\n" + lines(*entries);
    else if (is_tables(e.node) && !std::get<List>(e.node.value).empty())
      for (const Node& n : std::get<List>(e.node.value)) tables += "\n[[" + key(e) + "]]\n" + lines(std::get<Entries>(n.value));
    else
      top.push_back(e);
  }
  return lines(top) + tables;
}

std::string to_toml(const Node& node) {
  std::string text;
  if (const auto* list = std::get_if<List>(&node.value)) {
    for (const Node& n : *list) text += (text.empty() ? "" : ", ") + to_toml(n);
    return "[" + text + "]";
  }
  if (const auto* entries = std::get_if<Entries>(&node.value)) {
    for (const Entry& e : *entries) text += (text.empty() ? "" : ", ") + to_toml(e.key) + " = " + to_toml(e.node);
    return "{" + text + "}";
  }
  if (const auto* real = std::get_if<double>(&node.value)) return to_toml(*real);
  if (const auto* string = std::get_if<std::string>(&node.value)) return to_toml(*string);
  return shown(node);
}

namespace {

struct OldKey { const char *table, *old_name, *name; };
constexpr OldKey old_keys[]{{"support", "turns", "rotations"}, {"velocity", "spin", "angular_velocity"}};

/// Words begin so: "spin.x".
struct OldWord { const char *table, *key, *old_start, *start; };
constexpr OldWord old_words[]{{"observe", "quantity", "spin.", "angular_velocity."}};

/// The tables of that name, [table] or [[table]].
std::vector<Entries*> tables(Entries& root, const char* name) {
  std::vector<Entries*> found;
  Node* node = find(root, name);
  if (!node) return found;
  if (auto* one = std::get_if<Entries>(&node->value)) found.push_back(one);
  if (auto* list = std::get_if<List>(&node->value))
    for (Node& element : *list)
      if (auto* one = std::get_if<Entries>(&element.value)) found.push_back(one);
  return found;
}

}  // namespace

std::vector<std::string> take_old_names(Document& document) {
  std::vector<std::string> notes;
  const auto note = [&](const Place& place, const std::string& old_name, const std::string& name) {
    notes.push_back(fmt::format("{}:{}: \"{}\" is now called \"{}\"", document.file, place.line, old_name, name));
  };
  for (const OldKey& k : old_keys)
    for (Entries* table : tables(document.root, k.table))
      for (Entry& entry : *table)
        if (entry.key == k.old_name && !find(*table, k.name)) {
          note(entry.place, k.old_name, k.name);
          entry.key = k.name;
        }
  for (const OldWord& w : old_words)
    for (Entries* table : tables(document.root, w.table))
      if (Node* node = find(*table, w.key))
        if (auto* word = std::get_if<std::string>(&node->value); word && word->rfind(w.old_start, 0) == 0) {
          const std::string name = w.start + word->substr(std::string(w.old_start).size());
          note(node->place, *word, name);
          *word = name;
        }
  return notes;
}

}  // namespace elamin
