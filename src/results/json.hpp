#pragma once
// Numbers and cells of tables as JSON.
#include "results/table.hpp"

#include <nlohmann/json.hpp>

#include <cmath>

namespace elamin {

using Json = nlohmann::ordered_json;

/// The number; null where it is not finite.
inline Json json_of(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

inline Json json_of(const std::optional<double>& value) { return value ? json_of(*value) : Json(nullptr); }

/// The text of a file; what is no UTF-8 is replaced.
inline std::string file_text(const Json& all) { return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"; }

/// What the cell holds; null where it is empty, or a number that is not finite.
inline Json json_of(const Cell& cell) {
  if (const bool* b = std::get_if<bool>(&cell)) return *b;
  if (const int* i = std::get_if<int>(&cell)) return *i;
  if (const double* d = std::get_if<double>(&cell)) return json_of(*d);
  if (const std::string* s = std::get_if<std::string>(&cell)) return *s;
  return nullptr;
}

/// An object of these entries, in their order.
inline Json object(const std::vector<std::pair<std::string, double>>& entries) {
  Json all = Json::object();
  for (const auto& [name, v] : entries) all[name] = json_of(v);
  return all;
}

}  // namespace elamin
