#include "input/reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>

namespace elamin {

bool is_name(const std::string& word) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  if (word.empty() || word.size() > 64 || !letter(word[0])) return false;
  return std::all_of(word.begin(), word.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-'; });
}

Reader::Reader(const Entries& entries, Place place, std::string key, std::string kind, const std::string& folder,
               Mistakes& mistakes)
    : entries_(entries), key_(std::move(key)), kind_(std::move(kind)), folder_(folder), mistakes_(mistakes) {
  static_cast<Place&>(place_) = place;
  place_.key = key_;
}

const Node* Reader::find(const char* key) {
  if (std::find(known_.begin(), known_.end(), key) == known_.end()) known_.push_back(key);
  const Node* node = elamin::find(entries_, key);
  if (node) place_.keys[key] = node->place;
  return node;
}

TablePlace Reader::finish() {
  if (skip_) return place_;
  for (const Entry& e : entries_) {
    if (std::find(known_.begin(), known_.end(), e.key) != known_.end()) continue;
    const bool is_table = std::holds_alternative<Entries>(e.node.value) ||
                          (is_tables(e.node) && !std::get<List>(e.node.value).empty());
    const Place at = is_table ? e.node.place : e.place;
    const std::string key = inside(is_name(e.key) ? e.key : in_quotes(e.key));
    mistake(at, key, (is_table ? "unknown table; allowed: " : "unknown key; allowed: ") + listed(known_) +
                         did_you_mean(e.key, known_));
  }
  return place_;
}

void Reader::mistake(Place at, const std::string& key, const std::string& what) {
  place_.broken = true;
  mistakes_.add(at, key, what);
}
void Reader::missing(const char* key, const std::string& wanted) {
  mistake(place_, inside(key), "is missing; it must be " + wanted);
}
void Reader::wrong(const char* key, const Node& node, const std::string& wanted) {
  mistake(node.place, inside(key), "must be " + wanted + ", is " + shown(node));
}

std::string Reader::wanted(int, Range limits) {
  const auto end = [](double x) { return static_cast<long long>(x); };
  if (limits.hi == range::id.hi) return fmt::format("an integer of at least {}", end(limits.lo));
  if (limits.lo == limits.hi) return std::to_string(end(limits.lo));
  return fmt::format("an integer from {} to {}", end(limits.lo), end(limits.hi));
}
std::string Reader::wanted(double, Range limits) {
  if (limits.lo == range::any.lo) return "a finite number";
  if (limits.hi == range::any.hi) return limits.above ? "a positive number" : "a number that is not negative";
  return fmt::format("a number {} {} and at most {}", limits.above ? "above" : "of at least", limits.lo, limits.hi);
}

bool Reader::read(const char* key, const Node& node, bool& value, Range limits) {
  const bool* flag = std::get_if<bool>(&node.value);
  if (!flag) return wrong(key, node, wanted(value, limits)), false;
  value = *flag;
  return true;
}

bool Reader::read(const char* key, const Node& node, int& value, Range limits) {
  const auto* integer = std::get_if<std::int64_t>(&node.value);
  if (!integer || static_cast<double>(*integer) < limits.lo || static_cast<double>(*integer) > limits.hi)
    return wrong(key, node, wanted(value, limits)), false;
  value = static_cast<int>(*integer);
  return true;
}

bool Reader::read(const char* key, const Node& node, double& value, Range limits) {
  const auto* integer = std::get_if<std::int64_t>(&node.value);
  const auto* real = std::get_if<double>(&node.value);
  const double x = integer ? static_cast<double>(*integer) : real ? *real : std::nan("");
  const bool inside_range = (limits.above ? x > limits.lo : x >= limits.lo) && x <= limits.hi;   // false for nan
  if (!inside_range) return wrong(key, node, wanted(value, limits)), false;
  value = x;
  return true;
}

bool Reader::read(const char* key, const Node& node, std::string& value, Range limits) {
  const auto* text = std::get_if<std::string>(&node.value);
  if (!text) return wrong(key, node, wanted(value, limits)), false;
  if (text->find('\0') != std::string::npos)
    return mistake(node.place, inside(key), "must not hold the character 0"), false;
  value = *text;
  return true;
}

bool Reader::read(const char* key, const Node& node, Vec3& value, Range limits) {
  const auto* list = std::get_if<List>(&node.value);
  if (!list || list->size() != 3) return wrong(key, node, wanted(value, limits)), false;
  Vec3 v = Vec3::Zero();
  bool good = true;
  for (int c = 0; c < 3; ++c) good = read(key, (*list)[c], v[c], limits) && good;
  if (good) value = v;
  return good;
}

bool Reader::read(const char* key, const Node& node, std::vector<int>& value, Range limits) {
  const auto* list = std::get_if<List>(&node.value);
  if (!list || list->empty()) return wrong(key, node, "a list of integers, at least one"), false;
  bool good = true;
  for (const Node& n : *list) good = read(key, n, value.emplace_back(), limits) && good;
  return good;
}

bool Reader::read(const char* key, const Node& node, std::vector<double>& value, Range limits) {
  const auto* list = std::get_if<List>(&node.value);
  if (!list || list->empty()) return wrong(key, node, "a list of numbers, at least one"), false;
  bool good = true;
  for (const Node& n : *list) good = read(key, n, value.emplace_back(), limits) && good;
  return good;
}

bool Reader::read(const char* key, const Node& node, std::vector<Vec3>& value, Range limits) {
  const auto* list = std::get_if<List>(&node.value);
  if (!list || list->empty()) return wrong(key, node, "a list of points [[x, y, z], …], at least one"), false;
  bool good = true;
  for (const Node& n : *list) good = read(key, n, value.emplace_back(), limits) && good;
  return good;
}

bool Reader::read(const char* key, const Node& node, std::vector<std::vector<int>>& value, Range limits) {
  const auto* list = std::get_if<List>(&node.value);
  if (!list || list->empty()) return wrong(key, node, "a list of lists of integers, at least one"), false;
  bool good = true;
  for (const Node& n : *list) good = read(key, n, value.emplace_back(), limits) && good;
  return good;
}

bool Reader::read(const char* key, const Node& node, std::array<double, 2>& value, Range limits) {
  const auto* list = std::get_if<List>(&node.value);
  if (!list || list->size() != 2) return wrong(key, node, wanted(value, limits)), false;
  const bool first = read(key, (*list)[0], value[0], limits), second = read(key, (*list)[1], value[1], limits);
  return first && second;
}

bool Reader::read(const char* key, const Node& node, std::array<std::string, 2>& value, Range limits) {
  const auto* list = std::get_if<List>(&node.value);
  if (!list || list->size() != 2) return wrong(key, node, wanted(value, limits)), false;
  const bool first = read(key, (*list)[0], value[0], limits), second = read(key, (*list)[1], value[1], limits);
  return first && second;
}

bool Reader::read(const char* key, const Node& node, Rest& value, Range limits) {
  const auto* text = std::get_if<std::string>(&node.value);
  const bool number = std::holds_alternative<double>(node.value) || std::holds_alternative<std::int64_t>(node.value);
  if (number) {
    value.as_built = false;
    return read(key, node, value.degrees, limits);
  }
  if (!text || (*text != "straight" && *text != "as_built"))
    return wrong(key, node, "\"straight\", \"as_built\" or an angle in degrees"), false;
  value = {*text == "as_built", 180};
  return true;
}

void Reader::one_or_more(const char* key, std::vector<std::string>& values) {
  const Node* node = find(key);
  if (!node) return;
  values.clear();
  const auto* list = std::get_if<List>(&node->value);
  const auto is_text = [](const Node& n) { return std::holds_alternative<std::string>(n.value); };
  if (list ? !std::all_of(list->begin(), list->end(), is_text) : !is_text(*node))
    return wrong(key, *node, "a string or a list of strings");
  if (!list) read(key, *node, values.emplace_back(), range::any);
  else
    for (const Node& n : *list) read(key, n, values.emplace_back(), range::any);
}

void Reader::one_or_two(const char* key, std::vector<double>& values, Range limits) {
  const Node* node = find(key);
  if (!node) return;
  const auto* list = std::get_if<List>(&node->value);
  values.clear();
  if (!list)
    read(key, *node, values.emplace_back(), limits);
  else if (list->size() == 2)
    read(key, *node, values, limits);
  else
    wrong(key, *node, wanted(0.0, limits) + ", or a list of two, for unlike materials");
}

void Reader::center(const char* key, Vec3& value, int axis) {
  const Node* node = find(key);
  if (!node) return missing(key, "a list of two coordinates, without the one along the axis, or of three");
  const auto* list = std::get_if<List>(&node->value);
  if (!list || (list->size() != 2 && list->size() != 3))
    return wrong(key, *node, "a list of two coordinates, without the one along the axis, or of three");
  value = Vec3::Zero();
  for (int c = 0, i = 0; c < 3; ++c)
    if (c != axis || list->size() == 3) read(key, (*list)[i++], value[c], range::any);
  value[axis] = 0;
}

void Reader::foreign(const char* key, const std::string& what) {
  if (const Node* node = elamin::find(entries_, key)) {
    find(key);
    mistake(node->place, inside(key), "does not belong to " + what);
  }
}

void Reader::name(const char* key, std::string& value) {
  must(key, value);
  const Node* node = find(key);
  if (node && std::holds_alternative<std::string>(node->value) && !is_name(value))
    wrong(key, *node, "a name of letters, digits, '_' and '-', a letter first, at most 64 of them");
}

void Reader::file(const char* key, std::string& value) {
  must(key, value);
  const Node* node = find(key);
  if (!node || !std::holds_alternative<std::string>(node->value)) return;
  if (value.empty()) return wrong(key, *node, "the name of a file");
  std::error_code error;
  const auto path = std::filesystem::absolute(std::filesystem::path(folder_) / value, error).lexically_normal();
  if (!std::filesystem::exists(path, error))
    mistake(node->place, inside(key),
            "there is no file " + in_quotes(value) + "; it is sought from the folder of this file");
  value = path.string();
}

void Reader::raw(const char* key, std::vector<std::string>& values) {
  const Node* node = find(key);
  if (!node) return;
  const auto* list = std::get_if<List>(&node->value);
  if (!list || list->empty()) return wrong(key, *node, "a list of values, at least one");
  for (const Node& n : *list) values.push_back(to_toml(n));
}

int Reader::one_of(const char* key, const Node& node, const std::vector<std::string>& known) {
  const auto* text = std::get_if<std::string>(&node.value);
  const auto found = text ? std::find(known.begin(), known.end(), *text) : known.end();
  if (found != known.end()) return static_cast<int>(found - known.begin());
  mistake(node.place, inside(key),
          "must be " + quoted_choice(known) + ", is " + shown(node) + (text ? did_you_mean(*text, known) : ""));
  return -1;
}

void Reader::some_of(const char* key, const Node& node, const std::vector<std::string>& known,
                     std::vector<std::string>& list) {
  const auto* nodes = std::get_if<List>(&node.value);
  if (!nodes) return wrong(key, node, "a list of the words " + quoted_choice(known));
  list.clear();
  for (const Node& n : *nodes) {
    const int i = one_of(key, n, known);
    if (i < 0) continue;
    if (std::find(list.begin(), list.end(), known[i]) != list.end())
      mistake(n.place, inside(key), in_quotes(known[i]) + " is there twice; once is enough");
    else
      list.push_back(known[i]);
  }
}

std::string Reader::label(const Entries& entries, std::size_t index) {
  const Node* node = elamin::find(entries, "name");
  const auto* name = node ? std::get_if<std::string>(&node->value) : nullptr;
  return name && is_name(*name) ? *name : std::to_string(index + 1);
}

}  // namespace elamin
