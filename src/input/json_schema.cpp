#include "input/key_tree.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace elamin {
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
