#include "input/resolved.hpp"

#include "input/document.hpp"
#include "input/keys.hpp"

#include <fmt/format.h>

namespace elamin {
namespace {

std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(int value) { return std::to_string(value); }
std::string text_of(double value) { return to_toml(value); }
std::string text_of(const std::string& value) { return to_toml(value); }
std::string text_of(const Vec3& v) { return "[" + text_of(v.x()) + ", " + text_of(v.y()) + ", " + text_of(v.z()) + "]"; }
std::string text_of(const Rest& r) {
  return r.as_built ? text_of(std::string("as_built")) : r.degrees == 180 ? text_of(std::string("straight")) : text_of(r.degrees);
}
template <class T> std::string text_of(const std::array<T, 2>& pair) { return "[" + text_of(pair[0]) + ", " + text_of(pair[1]) + "]"; }
template <class T> std::string text_of(const std::vector<T>& list) {
  std::string text;
  for (const T& value : list) text += (text.empty() ? "" : ", ") + text_of(value);
  return "[" + text + "]";
}

/// The Keys that write.
class Writer : public Keys {
 public:
  Writer(std::string& text, std::string path) : text_(text), path_(std::move(path)) {}

  void either(const char*, const std::vector<Choice>& choices) override {
    for (const Choice& c : choices)
      if (c.chosen) c.keys();
  }
  void numbers(NamedNumbers& list) override {
    for (const auto& [name, value] : list) line(name.c_str(), text_of(value));
  }

 private:
  bool value(const Key& key, KeyValue value, bool there) override {
    if (there) line(key.name, to_toml(key, value));
    return false;
  }
  bool choose(const Key& key, int& at) override {
    if (at >= 0) line(key.name, to_toml(key.words[at]));
    return true;
  }
  void below(const char* key, const Below& tables) override {
    const std::string path = path_.empty() ? key : path_ + "." + key;
    for (std::size_t i = 0; i < tables.count; ++i) {
      text_ += fmt::format(fmt::runtime(tables.many ? "\n[[{}]]\n" : "\n[{}]\n"), path);
      Writer writer(text_, path);
      tables.each(i, writer);
    }
  }
  void line(const char* key, const std::string& value) { text_ += std::string(key) + " = " + value + "\n"; }

  std::string& text_;
  std::string path_;
};

}  // namespace

std::string to_toml(const Key& key, KeyValue value) {
  if (const auto* x = std::get_if<Vec3*>(&value); x && key.kind == Key::Kind::center)
    return text_of(std::array{(**x)[key.axis == 0 ? 1 : 0], (**x)[key.axis == 2 ? 1 : 2]});
  if (const auto* list = std::get_if<std::vector<double>*>(&value); list && key.kind == Key::Kind::one_or_two && (*list)->size() == 1)
    return text_of((**list)[0]);
  return std::visit([](const auto* v) { return text_of(*v); }, value);
}

std::string resolved_toml(const Problem& problem) {
  ProblemFile file{problem, {}};
  std::string text;
  Writer writer(text, "");
  describe(writer, file);
  return text;
}

}  // namespace elamin
