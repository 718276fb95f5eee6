// What the program says of its keys: every key has a sentence, the tracked reference is what it prints, and the schema holds.
#include "catch.hpp"

#include "input/document.hpp"
#include "input/key_tree.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace elamin;

namespace {

int said(const KeyTree& tree, const std::string& path) {
  INFO(path);
  CHECK_FALSE(tree.means.empty());
  int count = 1;
  for (const KeyTree& below : tree.keys) count += said(below, path + "." + below.name);
  return count;
}

/// Whether a node may stand where the schema says: what is wrong with types, words, ranges and keys, or "".
std::string against(const Node& node, const nlohmann::json& schema) {
  // A number may be written as an expression, a string.
  const auto types = schema.contains("type") && schema["type"].is_array() ? schema["type"].get<std::vector<std::string>>()
                                                                           : std::vector<std::string>{schema.value("type", "")};
  const std::string& type = types.front();
  if (const auto* entries = std::get_if<Entries>(&node.value)) {
    if (type != "object") return "is a table";
    for (const Entry& e : *entries) {
      if (!schema["properties"].contains(e.key) && schema["additionalProperties"].is_object()) {
        if (const std::string wrong = against(e.node, schema["additionalProperties"]); !wrong.empty()) return e.key + ": " + wrong;
        continue;
      }
      if (!schema["properties"].contains(e.key)) return e.key + " is unknown";
      if (const std::string wrong = against(e.node, schema["properties"][e.key]); !wrong.empty()) return e.key + ": " + wrong;
    }
    for (const auto& key : schema.value("required", nlohmann::json::array()))
      if (!find(*entries, key.get<std::string>())) return key.get<std::string>() + " is missing";
    return "";
  }
  if (const auto* list = std::get_if<List>(&node.value)) {
    if (!type.empty() && type != "array") return "is a list";
    for (const Node& n : *list)
      if (const std::string wrong = schema.contains("items") ? against(n, schema["items"]) : ""; !wrong.empty()) return wrong;
    return "";
  }
  if (const auto* text = std::get_if<std::string>(&node.value)) {
    if (schema.contains("enum")) return std::count(schema["enum"].begin(), schema["enum"].end(), *text) == 1 ? "" : "is no such word";
    return type.empty() || types.back() == "string" ? "" : "is a string";
  }
  if (std::holds_alternative<bool>(node.value)) return type.empty() || type == "boolean" ? "" : "is true or false";
  const auto* integer = std::get_if<std::int64_t>(&node.value);
  const double x = integer ? static_cast<double>(*integer) : std::get<double>(node.value);
  if (!type.empty() && type != "number" && !(integer && type == "integer")) return "is a number";
  const bool above = !schema.contains("exclusiveMinimum") || x > schema["exclusiveMinimum"].get<double>();
  const bool inside = above && x >= schema.value("minimum", x) && x <= schema.value("maximum", x);
  return inside ? "" : "is out of range";
}

}  // namespace

TEST_CASE("Files that are right are so by the JSON schema") {
  const auto schema = nlohmann::json::parse(json_schema());
  int files = 0;
  for (const char* folder : {"/tests/input/good", "/problems"})
    for (const auto& entry : std::filesystem::directory_iterator(std::string(ELAMIN_ROOT) + folder)) {
      if (entry.path().extension() != ".toml") continue;
      INFO(entry.path());
      CHECK(against({{}, read_document(entry.path().string()).root}, schema) == "");
      ++files;
    }
  CHECK(files > 50);
}

TEST_CASE("Every table and every key says what it means") { CHECK(said(key_tree(), "") > 250); }

TEST_CASE("docs/keys.md is what `elamin schema --markdown` prints") {
  std::ifstream in(ELAMIN_ROOT "/docs/keys.md");
  const std::string tracked{std::istreambuf_iterator<char>(in), {}};
  CHECK(tracked == key_reference());
}

TEST_CASE("The JSON schema has ranges, words, and what is needed when") {
  const auto schema = nlohmann::json::parse(json_schema());
  CHECK(schema["additionalProperties"] == false);
  const auto& beam = schema["properties"]["beam"]["items"];
  CHECK(beam["properties"]["particles"]["minimum"] == 2);
  CHECK(beam["properties"]["diameter"]["exclusiveMinimum"] == 0);
  CHECK(beam["properties"]["section"]["enum"] == std::vector<std::string>{"cylinder", "square"});
  CHECK(beam["required"] == std::vector<std::string>{"name", "particles", "diameter"});
  const auto& sheet = schema["properties"]["sheet"]["items"];
  CHECK(sheet["required"] == std::vector<std::string>{"name", "spacing"});
  // A rectangle is what a sheet is that does not say its shape; a circle must say so.
  const nlohmann::json size{{"required", {"size"}}}, radius{{"required", {"radius"}}};
  bool rectangle = false, circle = false;
  for (const auto& rule : sheet["allOf"]) {
    if (!rule.contains("then")) continue;
    rectangle = rectangle || (rule["then"] == size && !rule["if"].contains("required"));
    circle = circle || (rule["then"] == radius && rule["if"]["properties"]["shape"]["enum"][0] == "circle" && rule["if"].contains("required"));
  }
  CHECK(rectangle);
  CHECK(circle);
}
