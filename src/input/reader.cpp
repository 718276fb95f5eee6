#include "input/reader.hpp"

#include "core/find.hpp"
#include "core/suggest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

namespace elamin {
namespace {

std::string wanted_integer(Range limits) {
  const auto end = [](double x) { return static_cast<long long>(x); };
  if (limits.hi == range::any.hi) return "an integer";
  if (limits.hi == range::id.hi) return fmt::format("an integer of at least {}", end(limits.lo));
  if (limits.lo == limits.hi) return std::to_string(end(limits.lo));
  return fmt::format("an integer from {} to {}", end(limits.lo), end(limits.hi));
}

std::string wanted_number(Range limits) {
  if (limits.lo == range::any.lo) return "a finite number";
  if (limits.hi == range::any.hi) return limits.above ? "a positive number" : "a number that is not negative";
  return fmt::format("a number {} {} and at most {}", limits.above ? "above" : "of at least", limits.lo, limits.hi);
}

struct Wanted {
  const Key& key;
  std::string operator()(bool*) const { return "true or false"; }
  std::string operator()(int*) const { return wanted_integer(key.range); }
  std::string operator()(double*) const { return wanted_number(key.range); }
  std::string operator()(std::string*) const { return key.words.empty() ? "a string" : quoted_choice(key.words); }
  std::string operator()(Vec3*) const {
    return key.kind == Key::Kind::center ? "a list of two coordinates, without the one along the axis, or of three" : "a list of three numbers [x, y, z]";
  }
  std::string operator()(Rest*) const { return "\"straight\", \"as_built\" or an angle in degrees"; }
  std::string operator()(std::array<double, 2>*) const { return "a list of two positive numbers"; }
  std::string operator()(std::array<std::string, 2>*) const { return "a list of the names of two groups"; }
  std::string operator()(std::vector<int>*) const { return "a list of integers, at least one"; }
  std::string operator()(std::vector<double>*) const {
    return key.kind == Key::Kind::one_or_two ? wanted_number(key.range) + ", or a list of two, for unlike materials" : "a list of numbers, at least one";
  }
  std::string operator()(std::vector<Vec3>*) const { return "a list of points [[x, y, z], …], at least one"; }
  std::string operator()(std::vector<std::vector<int>>*) const { return "a list of lists of integers, at least one"; }
  std::string operator()(std::vector<std::vector<double>>*) const { return "a list of lists of numbers, at least one"; }
  std::string operator()(std::vector<std::string>*) const {
    return key.kind == Key::Kind::words    ? "a list of the words " + quoted_choice(key.words)
           : key.kind == Key::Kind::values ? "a list of values, at least one"
                                           : "a string or a list of strings";
  }
};

/// Of an element of [[…]]: its name, or its number.
std::string label(const Entries& entries, std::size_t index) {
  const Node* node = find(entries, "name");
  const auto* name = node ? std::get_if<std::string>(&node->value) : nullptr;
  return name && is_name(*name) ? *name : std::to_string(index + 1);
}


}  // namespace

std::string wanted(const Key& key, KeyValue value) { return std::visit(Wanted{key}, value); }

bool is_name(const std::string& word) {
  const auto letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  if (word.empty() || word.size() > 64 || !letter(word[0])) return false;
  return std::all_of(word.begin(), word.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9') || c == '-'; });
}

Reader::Reader(const Entries& entries, Place place, std::string key, std::string kind, const std::string& folder, Constants& constants,
               Mistakes& mistakes)
    : entries_(entries), key_(std::move(key)), kind_(std::move(kind)), folder_(folder), constants_(constants), mistakes_(mistakes) {
  static_cast<Place&>(place_) = place;
  place_.key = key_;
}

const Node* Reader::find(const char* key) {
  if (others_) return others_->push_back(key), nullptr;
  if (!contains(known_, key)) known_.push_back(key);
  const Node* node = elamin::find(entries_, key);
  if (node) place_.keys[key] = node->place;
  return node;
}

TablePlace Reader::finish() {
  if (skip_) return place_;
  for (const Entry& e : entries_) {
    if (contains(known_, e.key)) continue;
    const bool is_table = std::holds_alternative<Entries>(e.node.value) || (is_tables(e.node) && !std::get<List>(e.node.value).empty());
    const Place at = is_table ? e.node.place : e.place;
    const std::string key = inside(is_name(e.key) ? e.key : in_quotes(e.key));
    mistake(at, key, (is_table ? "unknown table; allowed: " : "unknown key; allowed: ") + listed(known_) + did_you_mean(e.key, known_));
  }
  return place_;
}

void Reader::mistake(Place at, const std::string& key, const std::string& what) {
  place_.broken = true;
  mistakes_.add(at, key, what);
}
void Reader::missing(const char* key, const std::string& what) { mistake(place_, inside(key), "is missing; it must be " + what); }
bool Reader::wrong(const Key& key, const Node& node, const std::string& what, const std::string& is) {
  mistake(node.place, inside(key.name), "must be " + what + ", is " + is);
  return false;
}

void Reader::either(const char*, const std::vector<Choice>& choices) {
  if (others_) {
    for (const Choice& c : choices) c.keys();
    return;
  }
  std::vector<std::string> others;
  const std::size_t before = known_.size();
  const char* what = "";
  for (const Choice& c : choices)
    if (c.chosen) what = c.what, c.keys();
  const std::string own = enumerated({known_.begin() + static_cast<std::ptrdiff_t>(before), known_.end()}, "and");
  others_ = &others;
  for (const Choice& c : choices)
    if (!c.chosen) c.keys();
  others_ = nullptr;
  for (const std::string& key : others) {
    const Node* node = elamin::find(entries_, key);
    if (!node || contains(known_, key)) continue;
    find(key.c_str());
    mistake(node->place, inside(key), fmt::format("does not belong to {}{}", what, own.empty() || std::strchr(what, ',') ? "" : ", which has " + own));
  }
}

void Reader::at_most_one(const Names& keys) {
  const char* first = nullptr;
  for (const char* key : keys) {
    if (others_ || !has(key)) continue;
    if (first) mistake(elamin::find(entries_, key)->place, inside(key), std::string(first) + " is there too; give one of them");
    else first = key;
  }
}

void Reader::one_at_least(const Names& keys, const char* what) {
  if (others_ || std::any_of(keys.begin(), keys.end(), [&](const char* key) { return has(key); })) return;
  mistake(place_, key_, enumerated({keys.begin(), keys.end()}, "or") + " is missing; " + what);
}

void Reader::with(const Names& keys, const Names& needed, const char* what) {
  if (others_ || std::any_of(needed.begin(), needed.end(), [&](const char* key) { return has(key); })) return;
  std::string names;
  for (const char* key : needed) names += (names.empty() ? "" : " or ") + std::string(key);
  for (const char* key : keys)
    if (has(key)) mistake(elamin::find(entries_, key)->place, inside(key), fmt::format("is of no use without {}, {}", names, what));
}

void Reader::below(const char* key, const Below& tables) {
  const Node* node = find(key);
  if (!node) return;
  const std::string kind = kind_.empty() ? key : kind_ + "." + key;
  if (!tables.many) {
    const auto* entries = std::get_if<Entries>(&node->value);
    if (!entries) return void(wrong({key, ""}, *node, "a table [" + kind + "]"));
    tables.add();
    return read_table(*entries, node->place, inside(key), kind, tables, 0);
  }
  if (!is_tables(*node)) return void(wrong({key, ""}, *node, "tables with double brackets, [[" + kind + "]]"));
  const List& list = std::get<List>(node->value);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const auto& entries = std::get<Entries>(list[i].value);
    tables.add();
    read_table(entries, list[i].place, inside(key) + "." + label(entries, i), kind, tables, i);
  }
}

void Reader::read_table(const Entries& entries, Place place, const std::string& key, const std::string& kind, const Below& tables, std::size_t i) {
  Reader reader(entries, place, key, kind, folder_, constants_, mistakes_);
  TablePlace& where = tables.each(i, reader);
  where = reader.finish();
  if (where.broken) place_.broken = true;
}

bool Reader::value(const Key& key, KeyValue value, bool) {
  const Node* node = find(key.name);
  if (others_) return false;
  if (!node) {
    if (key.needed) missing(key.name, wanted(key, value));
    return false;
  }
  return std::visit([&](auto* v) {
    using T = std::remove_pointer_t<decltype(v)>;
    if constexpr (std::is_same_v<T, std::vector<double>>)
      if (key.kind == Kind::one_or_two) return read_one_or_two(key, *node, *v);
    if constexpr (std::is_same_v<T, Vec3>)
      if (key.kind == Kind::center) return read_center(key, *node, *v);
    if constexpr (std::is_same_v<T, std::string>)
      if (key.kind == Kind::file) return read_file(key, *node, *v);
    return read(key, *node, *v);
  }, value);
}

bool Reader::choose(const Key& key, int& at) {
  const Node* node = find(key.name);
  if (others_) return true;
  if (node) {
    const int i = one_of(key, *node);
    if (i >= 0) at = i;
    return i >= 0;
  }
  if (key.needed) missing(key.name, quoted_choice(key.words));
  return !key.needed;
}

int Reader::one_of(const Key& key, const Node& node) {
  const auto* text = std::get_if<std::string>(&node.value);
  const auto found = text ? std::find(key.words.begin(), key.words.end(), *text) : key.words.end();
  if (found != key.words.end()) return static_cast<int>(found - key.words.begin());
  mistake(node.place, inside(key.name), "must be " + quoted_choice(key.words) + ", is " + shown(node) + (text ? did_you_mean(*text, key.words) : ""));
  return -1;
}

bool Reader::read(const Key& key, const Node& node, bool& value) {
  const bool* flag = std::get_if<bool>(&node.value);
  if (!flag) return wrong(key, node, wanted(key, &value));
  value = *flag;
  return true;
}

std::optional<double> Reader::number(const Key& key, const Node& node, const std::string& what, std::string& is) {
  is = shown(node);
  if (const auto* integer = std::get_if<std::int64_t>(&node.value)) return static_cast<double>(*integer);
  if (const auto* real = std::get_if<double>(&node.value)) return *real;
  const auto* text = std::get_if<std::string>(&node.value);
  if (!text) return wrong(key, node, what), std::nullopt;
  const Constants::Result result = constants_.value(*text);
  if (result.value) is = fmt::format("{}, of {}", *result.value, in_quotes(*text));
  else if (result.why.empty()) place_.broken = true;
  else wrong(key, node, what, constants_.empty() && is_name(*text) ? is : is + ", " + result.why);   // a word is not meant as an expression
  return result.value;
}

void Reader::numbers(NamedNumbers& list) {
  for (const Entry& e : entries_)
    if (is_constant_name(e.key)) constants_.announce(e.key);
  for (const Entry& e : entries_) {
    known_.push_back(e.key);
    place_.keys[e.key] = e.node.place;
    if (!is_constant_name(e.key)) {
      mistake(e.place, inside(in_quotes(e.key)), "is no name for a constant: letters, digits and '_', a letter first, and not that of a function");
      continue;
    }
    double x = 0;
    const bool good = read({e.key.c_str(), ""}, e.node, x);
    constants_.set(e.key, good ? std::optional(x) : std::nullopt);
    if (good) list.emplace_back(e.key, x);
  }
}

bool Reader::read(const Key& key, const Node& node, int& value) {
  const auto inside_range = [&](double x) {
    return x >= std::max<double>(key.range.lo, std::numeric_limits<int>::min()) && x <= std::min<double>(key.range.hi, std::numeric_limits<int>::max());
  };
  std::optional<double> x;
  std::string is;
  if (const auto* integer = std::get_if<std::int64_t>(&node.value)) {
    x = static_cast<double>(*integer);
  } else if (std::holds_alternative<std::string>(node.value)) {
    if (!(x = number(key, node, wanted(key, &value), is))) return false;
    x = nearly_integer(*x);
  }
  if (!x || !inside_range(*x)) return wrong(key, node, wanted(key, &value), is.empty() ? shown(node) : is);
  value = static_cast<int>(*x);
  return true;
}

bool Reader::read(const Key& key, const Node& node, double& value) {
  std::optional<double> x;
  std::string is;
  if (const auto* integer = std::get_if<std::int64_t>(&node.value)) x = static_cast<double>(*integer);
  else if (const auto* real = std::get_if<double>(&node.value)) x = *real;
  else if (!(x = number(key, node, wanted_number(key.range), is))) return false;
  const bool inside_range = (key.range.above ? *x > key.range.lo : *x >= key.range.lo) && *x <= key.range.hi;   // false for nan
  if (!inside_range) return wrong(key, node, wanted_number(key.range), is.empty() ? shown(node) : is);
  value = *x;
  return true;
}

bool Reader::read(const Key& key, const Node& node, std::string& value) {
  const auto* text = std::get_if<std::string>(&node.value);
  if (!text) return wrong(key, node, "a string");
  if (text->find('\0') != std::string::npos) return mistake(node.place, inside(key.name), "must not hold the character 0"), false;
  value = *text;
  if (key.kind == Kind::name && !is_name(value)) wrong(key, node, "a name of letters, digits, '_' and '-', a letter first, at most 64 of them");
  return true;
}

bool Reader::read(const Key& key, const Node& node, Vec3& value) {
  const auto* list = std::get_if<List>(&node.value);
  if (!list || list->size() != 3) return wrong(key, node, wanted({key.name, ""}, &value));
  Vec3 v = Vec3::Zero();
  bool good = true;
  for (int c = 0; c < 3; ++c) good = read(key, (*list)[c], v[c]) && good;
  if (good) value = v;
  return good;
}

template <class T> bool Reader::read(const Key& key, const Node& node, std::vector<T>& value) {
  const auto* list = std::get_if<List>(&node.value);
  if (!list || list->empty()) return wrong(key, node, wanted({key.name, ""}, &value));
  bool good = true;
  for (const Node& n : *list) good = read(key, n, value.emplace_back()) && good;
  return good;
}

template <class T> bool Reader::read(const Key& key, const Node& node, std::array<T, 2>& value) {
  const auto* list = std::get_if<List>(&node.value);
  if (!list || list->size() != 2) return wrong(key, node, wanted(key, &value));
  const bool first = read(key, (*list)[0], value[0]), second = read(key, (*list)[1], value[1]);
  return first && second;
}

bool Reader::read(const Key& key, const Node& node, Rest& value) {
  const auto* text = std::get_if<std::string>(&node.value);
  if (text && (*text == "straight" || *text == "as_built")) {
    value = {*text == "as_built", 180};
    return true;
  }
  std::string is;
  if (!number(key, node, wanted(key, &value), is)) return false;
  value.as_built = false;
  return read(key, node, value.degrees);
}

bool Reader::read(const Key& key, const Node& node, std::vector<std::string>& values) {
  const auto* list = std::get_if<List>(&node.value);
  values.clear();
  if (key.kind == Kind::words) return read_words(key, node, values);
  if (key.kind == Kind::values) {
    if (!list || list->empty()) return wrong(key, node, wanted(key, &values));
    for (const Node& n : *list) values.push_back(to_toml(n));
    return true;
  }
  const auto is_text = [](const Node& n) { return std::holds_alternative<std::string>(n.value); };
  if (list ? !std::all_of(list->begin(), list->end(), is_text) : !is_text(node)) return wrong(key, node, wanted(key, &values));
  if (!list) read(key, node, values.emplace_back());
  else
    for (const Node& n : *list) read(key, n, values.emplace_back());
  return true;
}

bool Reader::read_words(const Key& key, const Node& node, std::vector<std::string>& list) {
  const auto* nodes = std::get_if<List>(&node.value);
  if (!nodes) return wrong(key, node, wanted(key, &list));
  for (const Node& n : *nodes) {
    const int i = one_of(key, n);
    if (i < 0) continue;
    if (contains(list, key.words[i])) mistake(n.place, inside(key.name), in_quotes(key.words[i]) + " is there twice; once is enough");
    else list.push_back(key.words[i]);
  }
  return true;
}

bool Reader::read_one_or_two(const Key& key, const Node& node, std::vector<double>& values) {
  const auto* list = std::get_if<List>(&node.value);
  values.clear();
  if (!list) return read(key, node, values.emplace_back());
  if (list->size() == 2) return read<double>(key, node, values);
  return wrong(key, node, wanted(key, &values));
}

bool Reader::read_center(const Key& key, const Node& node, Vec3& value) {
  const auto* list = std::get_if<List>(&node.value);
  if (!list || (list->size() != 2 && list->size() != 3)) return wrong(key, node, wanted(key, &value));
  value = Vec3::Zero();
  for (int c = 0, i = 0; c < 3; ++c)
    if (c != key.axis || list->size() == 3) read(key, (*list)[i++], value[c]);
  value[key.axis] = 0;
  return true;
}

bool Reader::read_file(const Key& key, const Node& node, std::string& value) {
  if (!read(key, node, value)) return false;
  if (value.empty()) return wrong(key, node, "the name of a file");
  std::error_code error;
  const auto path = std::filesystem::absolute(std::filesystem::path(folder_) / value, error).lexically_normal();
  if (!std::filesystem::exists(path, error))
    mistake(node.place, inside(key.name), "there is no file " + in_quotes(value) + "; it is sought from the folder of this file");
  else if (std::string_view(key.name) != "run" && !std::filesystem::is_regular_file(path, error))      // a run is a directory
    mistake(node.place, inside(key.name), in_quotes(value) + " is a folder or a device; it must be a file");
  value = path.string();
  return true;
}

}  // namespace elamin
