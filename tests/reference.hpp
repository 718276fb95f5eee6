#pragma once
// Reference numbers of data/, as JSON.
#include <nlohmann/json.hpp>

#include <fstream>
#include <string>

inline nlohmann::json reference(const std::string& name) {
  std::ifstream in(std::string(ELAMIN_ROOT) + "/data/" + name);
  return nlohmann::json::parse(in);
}
