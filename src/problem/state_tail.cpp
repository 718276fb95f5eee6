#include "problem/state_tail.hpp"

#include "core/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace elamin {

std::string tail_file(const std::string& data_file) {
  return std::filesystem::path(data_file).replace_extension(".json").string();
}

std::string tail_text(const State& state, const StoredStage* stage) {
  std::string text = fmt::format("{{\"lambda\": {:.17g},\n", state.load_factor);
  if (stage) {
    std::string scaling;
    for (const Scaling& s : stage->scaling)
      scaling += fmt::format("{}[{:.17g}, {:.17g}]", scaling.empty() ? "" : ", ", s.fixed, s.rate);
    text += fmt::format("\"stage\": {{\"name\": {}, \"from\": {:.17g}, \"scaling\": [{}]}},\n", nlohmann::json(stage->name).dump(),
                        stage->from, scaling);
  }
  text += "\"tail\": [";
  for (Eigen::Index i = 0; i < state.particles(); ++i) {
    const Vec3 t = state.tail.col(i).array() + 0.0;                  // no negative zeros
    fmt::format_to(std::back_inserter(text), "{}\n[{:.17g}, {:.17g}, {:.17g}]", i ? "," : "", t[0], t[1], t[2]);
  }
  return text + "]}\n";
}

std::optional<StateTail> read_tail(const std::string& data_file) {
  const std::string file = tail_file(data_file);
  std::ifstream in(file, std::ios::binary);
  if (!in || file == data_file) return std::nullopt;
  const auto wrong = [&](const std::string& what) { return InputError({Mistake{file, 0, 0, {}, what}}); };
  const auto json = nlohmann::json::parse(in, nullptr, false);
  const auto number = [](const nlohmann::json& j) { return j.is_number() && std::isfinite(j.get<double>()); };
  if (!json.is_object() || !json.contains("lambda") || !json.contains("tail") || !number(json["lambda"]) ||
      !json["tail"].is_array())
    throw wrong("must hold {\"lambda\": number, \"tail\": [[x, y, z], …]}, as beside every stored state; without this file "
                "the state is taken from its data file alone");
  StateTail stored{json["lambda"].get<double>(), Field(3, static_cast<Eigen::Index>(json["tail"].size())), {}};
  for (std::size_t i = 0; i < json["tail"].size(); ++i) {
    const auto& t = json["tail"][i];
    if (!t.is_array() || t.size() != 3 || !number(t[0]) || !number(t[1]) || !number(t[2]))
      throw wrong(fmt::format("tail {} must be three finite numbers [x, y, z]", i + 1));
    stored.tail.col(static_cast<Eigen::Index>(i)) = Vec3(t[0].get<double>(), t[1].get<double>(), t[2].get<double>());
  }
  if (json.contains("stage")) {
    const auto& s = json["stage"];
    const auto pair = [&](const nlohmann::json& j) { return j.is_array() && j.size() == 2 && number(j[0]) && number(j[1]); };
    if (!s.is_object() || !s.contains("name") || !s["name"].is_string() || !s.contains("from") || !number(s["from"]) ||
        !s.contains("scaling") || !s["scaling"].is_array() || !std::all_of(s["scaling"].begin(), s["scaling"].end(), pair))
      throw wrong("stage must be {\"name\": text, \"from\": number, \"scaling\": [[fixed, rate], …]}");
    stored.stage = StoredStage{s["name"].get<std::string>(), s["from"].get<double>(), {}};
    for (const auto& j : s["scaling"]) stored.stage->scaling.emplace_back(j[0].get<double>(), j[1].get<double>());
  }
  return stored;
}

}  // namespace elamin
