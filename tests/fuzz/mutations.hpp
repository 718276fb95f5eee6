#pragma once
// How a text is damaged at random: the same number, the same damage.
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace elamin {

class Mutations {
 public:
  explicit Mutations(long number) : random_(static_cast<std::uint64_t>(number) * 0x9E3779B97F4A7C15u + 19) {}
  std::size_t pick(std::size_t n) { return static_cast<std::size_t>(random_() % n); }

  /// One to four changes: of a letter, a number, the value of a key, a line, the end; or lines of another text.
  void change(std::string& text, const std::vector<std::string>& others) {
    for (std::size_t changes = 1 + pick(4); changes > 0; --changes) {
      if (text.empty()) text = "\n";
      const std::size_t at = pick(text.size());
      switch (pick(8)) {
        case 0: text[at] = static_cast<char>(random_()); break;
        case 1: case 2: number(text, at); break;
        case 3: case 4: value(text, at); break;
        case 5: {
          const auto [begin, end] = line(text, at);
          if (pick(2)) text.erase(begin, end - begin);
          else text.insert(begin, text.substr(begin, end - begin));
          break;
        }
        case 6:
          if (pick(8) == 0) text.resize(at);
          break;
        default: {
          const std::string& other = others[pick(others.size())];
          std::size_t begin = line(other, pick(other.size())).first, end = begin;
          for (std::size_t lines = 1 + pick(5); lines > 0 && end < other.size(); --lines) end = line(other, end).second;
          text.insert(line(text, at).first, other.substr(begin, end - begin));
        }
      }
    }
  }
  std::string odd() { return odd_words[pick(odd_words.size())]; }

  /// KEY=VALUE: a key of a problem, and anything.
  std::string setting(const std::string& problem) { return key_in(problem) + "=" + odd(); }

 private:
  static std::pair<std::size_t, std::size_t> line(const std::string& text, std::size_t at) {
    const std::size_t before = at == 0 ? std::string::npos : text.rfind('\n', at - 1), end = text.find('\n', at);
    return {before == std::string::npos ? 0 : before + 1, end == std::string::npos ? text.size() : end + 1};
  }
  void number(std::string& text, std::size_t at) {
    const auto in_number = [&](std::size_t k) { return std::isdigit(static_cast<unsigned char>(text[k])) || text[k] == '.' || text[k] == '-' || text[k] == 'e'; };
    while (at < text.size() && !std::isdigit(static_cast<unsigned char>(text[at]))) ++at;
    std::size_t end = at;
    while (end < text.size() && in_number(end)) ++end;
    while (at > 0 && in_number(at - 1)) --at;
    if (at >= text.size()) return;
    const std::string now = text.substr(at, end - at);
    static const std::vector<std::string> factors{"0.1", "10", "-1", "1e-6", "1e6", "2"};
    text.replace(at, end - at, pick(2) ? odd() : std::to_string(std::atof(now.c_str()) * std::atof(factors[pick(factors.size())].c_str())));
  }
  void value(std::string& text, std::size_t at) {
    const auto [begin, end] = line(text, at);
    const std::size_t equals = text.find('=', begin);
    if (equals < end) text.replace(equals + 1, end - equals - 1, " " + odd() + "\n");
  }
  std::string key_in(const std::string& text) {
    const std::size_t at = text.find("\n[", pick(text.size()));
    if (at == std::string::npos) return "path.steps";
    const std::size_t begin = text.find_first_not_of("[\n", at), end = text.find(']', begin), line = text.find('\n', end), equals = text.find('=', line);
    if (equals == std::string::npos) return "solver.tolerance";
    std::string key = text.substr(begin, end - begin) + "." + text.substr(line + 1, equals - line - 1);
    std::erase_if(key, [](unsigned char c) { return std::isspace(c); });
    return key;
  }

  inline static const std::vector<std::string> odd_words{
      "0", "-1", "1", "-0.0", "nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "1e-30", "9223372036854775807", "2147483648", "1000000000", "\"\"", "\"all\"", "\"xyz\"", "[]", "[0, 0, 0]",
      "[1e300, 0, 0]", "[[]]", "{}", "true", "1979-05-27", "\"..\"", "\"/dev/zero\"", "\"/etc/passwd\"", "\"{}\"", "[nan, 0, 0]", "'''", "\\", "=", "\"\\u0000\"", "\"lj\"", "\"hertz\"",
      "\"rounded\"", "\"path\"", "\"dynamics\"", "\"arc_length\"", "0.5", "1e3", "3", "100"};

  std::mt19937_64 random_;
};

}  // namespace elamin
