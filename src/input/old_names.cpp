#include "input/old_names.hpp"

#include <fmt/format.h>

namespace elamin {

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
