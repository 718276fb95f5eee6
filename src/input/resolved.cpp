#include "input/resolved.hpp"

#include "input/document.hpp"
#include "input/schema.hpp"

namespace elamin {
namespace {

/// The io of `describe` that writes.
class Writer {
 public:
  static constexpr bool reading = false;
  Writer(std::string& text, std::string path) : text_(text), path_(std::move(path)) {}

  template <class T> void must(const char* key, const T& value, Range = {}) { line(key, toml(value)); }
  template <class T> void may(const char* key, const T& value, Range = {}) { line(key, toml(value)); }
  template <class T> void may(const char* key, const std::optional<T>& value, Range = {}) {
    if (value) line(key, toml(*value));
  }
  template <class T> void must(const char* key, const std::optional<T>& value, Range = {}) { may(key, value); }
  void one_or_more(const char* key, const std::vector<std::string>& list) { line(key, toml(list)); }
  void must_one_or_more(const char* key, const std::vector<std::string>& list) { one_or_more(key, list); }
  void one_or_more(const char* key, const std::optional<std::vector<std::string>>& list) { may(key, list); }
  void one_or_two(const char* key, const std::vector<double>& values, Range) {
    if (!values.empty()) line(key, values.size() == 1 ? toml(values[0]) : toml(values));
  }
  void center(const char* key, const Vec3& value, int axis) {
    line(key, toml(std::array{value[axis == 0 ? 1 : 0], value[axis == 2 ? 1 : 2]}));
  }
  void foreign(const char*, const std::string&) {}
  void name(const char* key, const std::string& value) { line(key, toml(value)); }
  void may_name(const char* key, const std::string& value) {
    if (!value.empty()) name(key, value);
  }
  void file(const char* key, const std::string& value) { line(key, toml(value)); }
  void may_file(const char* key, const std::string& value) {
    if (!value.empty()) line(key, toml(value));
  }
  void raw(const char*, const std::vector<std::string>&) {}   // sweeps are not written
  template <class T, class W, std::size_t n> bool word(const char* key, const T& value, const Word<W> (&words)[n]) {
    for (const auto& w : words)
      if (value == w.value) line(key, toml(std::string(w.text)));
    return true;
  }
  template <class T, class W, std::size_t n>
  bool must_word(const char* key, const T& value, const Word<W> (&words)[n]) {
    return word(key, value, words);
  }
  template <class Words>
  void words(const char* key, const std::vector<std::string>& list, const Words&) {
    line(key, toml(list));
  }

  template <class T> void table(const char* key, T& value) { descend("[" + inside(key) + "]", key, value); }
  template <class T> void table(const char* key, std::optional<T>& value) {
    if (value) table(key, *value);
  }
  template <class T> void tables(const char* key, std::vector<T>& list) {
    for (T& value : list) descend("[[" + inside(key) + "]]", key, value);
  }
  void skip_the_rest() {}

 private:
  void line(const char* key, const std::string& value) { text_ += std::string(key) + " = " + value + "\n"; }
  template <class T> void descend(const std::string& header, const char* key, T& value) {
    text_ += "\n" + header + "\n";
    Writer writer(text_, inside(key));
    describe(writer, value);
  }
  std::string inside(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

  static std::string toml(bool value) { return value ? "true" : "false"; }
  static std::string toml(int value) { return std::to_string(value); }
  static std::string toml(double value) { return to_toml(value); }
  static std::string toml(const std::string& value) { return to_toml(value); }
  static std::string toml(const Vec3& v) { return "[" + toml(v.x()) + ", " + toml(v.y()) + ", " + toml(v.z()) + "]"; }
  static std::string toml(const Rest& r) {
    return r.as_built         ? toml(std::string("as_built"))
           : r.degrees == 180 ? toml(std::string("straight"))
                              : toml(r.degrees);
  }
  template <class T> static std::string toml(const std::array<T, 2>& pair) {
    return "[" + toml(pair[0]) + ", " + toml(pair[1]) + "]";
  }
  template <class T> static std::string toml(const std::vector<T>& list) {
    std::string text;
    for (const T& value : list) text += (text.empty() ? "" : ", ") + toml(value);
    return "[" + text + "]";
  }

  std::string& text_;
  std::string path_;
};

}  // namespace

std::string resolved_toml(const Problem& problem) {
  ProblemFile file{problem, {}};
  std::string text;
  Writer writer(text, "");
  describe(writer, file);
  return text;
}

}  // namespace elamin
