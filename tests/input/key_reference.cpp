// What the program says of its keys: every key has a sentence, the tracked reference is what it prints, and the schema holds.
#include "catch.hpp"

#include "input/key_tree.hpp"

#include <nlohmann/json.hpp>

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

}  // namespace

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
