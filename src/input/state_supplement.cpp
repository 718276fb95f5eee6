#include "input/state_supplement.hpp"

#include "core/error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <utility>

namespace elamin {

namespace {

using Json = nlohmann::ordered_json;

template <class Numbers> std::string list(const Numbers& numbers) {
  std::string text;
  for (const double x : numbers) fmt::format_to(std::back_inserter(text), "{}{:.17g}", text.empty() ? "" : ", ", x);
  return "[" + text + "]";
}

std::string stage_text(const StoredStage& stage) {
  std::string scaling;
  for (const Scaling& s : stage.scaling)
    scaling += fmt::format("{}[{:.17g}, {:.17g}]", scaling.empty() ? "" : ", ", s.fixed, s.rate);
  return fmt::format("{{\"name\": {}, \"from\": {:.17g}, \"scaling\": [{}]}}", Json(stage.name).dump(), stage.from, scaling);
}

std::string path_text(const StoredPath& path) {
  const Resume& r = path.resume;
  std::string text = fmt::format("{{\"varied\": {}, \"rising\": {}, \"resume\": {{", Json(path.varied).dump(), path.rising);
  auto add = [&, first = true](const char* key, const std::string& value) mutable {
    text += fmt::format("{}\n\"{}\": {}", first ? "" : ",", key, value);
    first = false;
  };
  if (!r.label.empty()) add("label", Json(r.label).dump());
  if (r.before >= 0) add("before", std::to_string(r.before));
  if (r.after >= 0) add("after", std::to_string(r.after));
  if (r.modes.cols() > 0) {
    std::string modes;
    for (Eigen::Index k = 0; k < r.modes.cols(); ++k) modes += (k ? ",\n" : "") + list(Vector(r.modes.col(k)));
    add("modes", "[" + modes + "]");
  }
  if (r.tangent.size() > 0) add("tangent", list(r.tangent));
  if (r.direction.size() > 0) {
    add("direction", list(r.direction));
    for (const auto& [key, value] : {std::pair("load", r.load), {"length", r.length}, {"step", r.step}, {"shortest", r.shortest}})
      add(key, fmt::format("{:.17g}", value));
  }
  if (!r.closed.empty()) add("closed", Json(r.closed).dump());
  if (!r.closed_bodies.empty()) add("closed_bodies", Json(r.closed_bodies).dump());
  return text + "}}";
}

/// What LABEL.json says; every `wrong` tells a sentence and throws.
class TailReader {
 public:
  TailReader(std::string file, Json json) : file_(std::move(file)), json_(std::move(json)) {}

  StateSupplement read() const {
    if (!json_.is_object() || !json_.contains("lambda") || !json_.contains("tail") || !number(json_["lambda"]) || !json_["tail"].is_array())
      wrong("must hold {\"lambda\": number, \"tail\": [[x, y, z], …]}, as beside every stored state; without this file "
            "the state is taken from its data file alone");
    StateSupplement stored{json_["lambda"].get<double>(), Field(3, static_cast<Eigen::Index>(json_["tail"].size())), {}, {}};
    if (json_.contains("bodies")) stored.bodies = bodies(json_["bodies"]);
    for (std::size_t i = 0; i < json_["tail"].size(); ++i) {
      const Json& t = json_["tail"][i];
      if (!t.is_array() || t.size() != 3 || !number(t[0]) || !number(t[1]) || !number(t[2]))
        wrong(fmt::format("tail {} must be three finite numbers [x, y, z]", i + 1));
      stored.low.col(static_cast<Eigen::Index>(i)) = Vec3(t[0].get<double>(), t[1].get<double>(), t[2].get<double>());
    }
    if (json_.contains("stage")) stored.stage = stage(json_["stage"]);
    const auto sites = stored.low.cols() + 2 * static_cast<Eigen::Index>(stored.bodies.size());
    if (json_.contains("path")) stored.path = path(json_["path"], static_cast<int>(sites));
    return stored;
  }

 private:
  [[noreturn]] void wrong(const std::string& what) const { throw InputError({Mistake{file_, 0, 0, {}, what}}); }

  static bool number(const Json& j) { return j.is_number() && std::isfinite(j.get<double>()); }
  static bool integer(const Json& j, int least, int most) {
    return j.is_number_integer() && j.get<std::int64_t>() >= least && j.get<std::int64_t>() <= most;
  }
  template <class Holds> static bool all(const Json& j, const Holds& holds) {
    return j.is_array() && std::all_of(j.begin(), j.end(), holds);
  }

  StoredStage stage(const Json& j) const {
    const auto pair = [](const Json& p) { return p.is_array() && p.size() == 2 && number(p[0]) && number(p[1]); };
    if (!j.is_object() || !j.contains("name") || !j["name"].is_string() || !j.contains("from") || !number(j["from"]) ||
        !j.contains("scaling") || !all(j["scaling"], pair))
      wrong("stage must be {\"name\": text, \"from\": number, \"scaling\": [[fixed, rate], …]}");
    StoredStage stored{j["name"].get<std::string>(), j["from"].get<double>(), {}};
    for (const Json& s : j["scaling"]) stored.scaling.emplace_back(s[0].get<double>(), s[1].get<double>());
    return stored;
  }

  std::vector<Pose> bodies(const Json& j) const {
    const auto row = [](const Json& r) { return all(r, number) && r.size() == 7; };
    if (!all(j, row)) wrong("bodies must be [[x, y, z, qw, qx, qy, qz], …], finite numbers");
    std::vector<Pose> poses;
    for (const Json& r : j) {
      std::array<double, 7> v;
      for (std::size_t k = 0; k < 7; ++k) v[k] = r[k].get<double>();
      poses.push_back({{Vec3::Zero(), {v[0], v[1], v[2]}}, {v[3], v[4], v[5], v[6]}});
      if (std::abs(poses.back().rotation.norm() - 1) > 1e-12)
        wrong(fmt::format("the rotation of body {} must be a unit quaternion [qw, qx, qy, qz]", poses.size()));
    }
    return poses;
  }

  StoredPath path(const Json& j, int sites) const {
    if (!j.is_object() || !j.contains("varied") || !all(j["varied"], [](const Json& w) { return w.is_string(); }) ||
        !j.contains("rising") || !j["rising"].is_boolean() || !j.contains("resume") || !j["resume"].is_object())
      wrong("path must be {\"varied\": [text, …], \"rising\": true or false, \"resume\": {…}}");
    return {j["varied"].get<std::vector<std::string>>(), j["rising"].get<bool>(), resume(j["resume"], sites)};
  }

  Resume resume(const Json& j, int sites) const {
    Resume r;
    if (j.contains("label")) {
      if (!j["label"].is_string()) wrong("path.resume.label must be a text");
      r.label = j["label"].get<std::string>();
    }
    for (const auto& [key, index] : {std::pair("before", &r.before), {"after", &r.after}})
      if (j.contains(key)) {
        if (!integer(j[key], 0, 3 * sites)) wrong(fmt::format("path.resume.{} must be a number of eigenvalues", key));
        *index = j[key].get<int>();
      }
    std::size_t dofs = 0;
    const auto vector = [&](const Json& values, const char* key) {
      if (!all(values, number) || values.empty()) wrong(fmt::format("path.resume.{} must be finite numbers", key));
      if (dofs == 0) dofs = values.size();
      if (values.size() != dofs)
        wrong(fmt::format("path.resume.{} has {} numbers, and what stands before it {}; all are over the same free coordinates",
                          key, values.size(), dofs));
      Vector v(static_cast<Eigen::Index>(dofs));
      for (std::size_t i = 0; i < dofs; ++i) v[static_cast<Eigen::Index>(i)] = values[i].get<double>();
      return v;
    };
    if (j.contains("modes")) {
      const Json& modes = j["modes"];
      if (!modes.is_array() || modes.empty()) wrong("path.resume.modes must be arrays of finite numbers, one for each mode");
      for (std::size_t k = 0; k < modes.size(); ++k) {
        const Vector mode = vector(modes[k], "modes");
        if (k == 0) r.modes.resize(mode.size(), static_cast<Eigen::Index>(modes.size()));
        r.modes.col(static_cast<Eigen::Index>(k)) = mode;
      }
    }
    if (j.contains("tangent")) r.tangent = vector(j["tangent"], "tangent");
    if (j.contains("direction")) {
      r.direction = vector(j["direction"], "direction");
      for (const auto& [key, value] : {std::pair("load", &r.load), {"length", &r.length}, {"step", &r.step}, {"shortest", &r.shortest}}) {
        if (!j.contains(key) || !number(j[key])) wrong(fmt::format("path.resume.{} must be a finite number, as there is a direction", key));
        *value = j[key].get<double>();
        if (value != &r.load && *value <= 0) wrong(fmt::format("path.resume.{} must be positive", key));
      }
    }
    if (j.contains("closed")) {
      constexpr int most = std::numeric_limits<int>::max();
      const auto contact = [&](const Json& c) {
        return c.is_array() && c.size() == 3 && integer(c[0], 0, sites - 1) && integer(c[1], -1, sites - 1) && integer(c[2], -1, most);
      };
      if (!all(j["closed"], contact))
        wrong("path.resume.closed must be contacts [particle, other or -1, wall or -1], particles counted from 0");
      r.closed = j["closed"].get<std::vector<std::array<int, 3>>>();
    }
    if (j.contains("closed_bodies")) {
      constexpr int most = std::numeric_limits<int>::max();
      const auto contact = [&](const Json& c) {
        return c.is_array() && c.size() == 5 && integer(c[0], 0, sites - 1) && integer(c[1], -1, sites - 1) && integer(c[2], -1, most) &&
               integer(c[3], 0, most) && integer(c[4], 0, 1);
      };
      if (!all(j["closed_bodies"], contact))
        wrong("path.resume.closed_bodies must be contacts [body or particle, other or -1, wall or -1, feature, 1 if within reach]");
      r.closed_bodies = j["closed_bodies"].get<std::vector<std::array<int, 5>>>();
    }
    return r;
  }

  std::string file_;
  Json json_;
};

}  // namespace

std::string supplement_file(const std::string& data_file) {
  return std::filesystem::path(data_file).replace_extension(".json").string();
}

std::vector<Pose> stored_poses(const State& state) {
  std::vector<Pose> poses = state.bodies;
  for (Pose& p : poses) p.position.hi = Vec3::Zero();
  return poses;
}

std::string supplement_text(const StateSupplement& stored) {
  std::string text = fmt::format("{{\"lambda\": {:.17g},\n", stored.load_factor);
  if (stored.stage) text += "\"stage\": " + stage_text(*stored.stage) + ",\n";
  if (stored.path) text += "\"path\": " + path_text(*stored.path) + ",\n";
  text += "\"tail\": [";
  for (Eigen::Index i = 0; i < stored.low.cols(); ++i) {
    const Vec3 t = stored.low.col(i).array() + 0.0;                 // no negative zeros
    fmt::format_to(std::back_inserter(text), "{}\n[{:.17g}, {:.17g}, {:.17g}]", i ? "," : "", t[0], t[1], t[2]);
  }
  text += "]";
  if (!stored.bodies.empty()) text += ",\n\"bodies\": [";
  for (std::size_t b = 0; b < stored.bodies.size(); ++b) {
    const Vec3 t = stored.bodies[b].position.lo.array() + 0.0;
    const Eigen::Quaterniond& q = stored.bodies[b].rotation;
    text += (b ? ",\n" : "\n") + list(std::array{t[0], t[1], t[2], q.w(), q.x(), q.y(), q.z()});
  }
  return text + (stored.bodies.empty() ? "}\n" : "]}\n");
}

std::optional<StateSupplement> read_supplement(const std::string& data_file) {
  const std::string file = supplement_file(data_file);
  std::ifstream in(file, std::ios::binary);
  if (!in || file == data_file) return std::nullopt;
  return TailReader(file, Json::parse(in, nullptr, false)).read();
}

}  // namespace elamin
