#include "problem/unavailable.hpp"

#include <string_view>

namespace elamin {
namespace {

constexpr const char* not_yet = "not available in this version";

struct Refusal {
  std::string_view key, word;   // word "": the key itself; a trailing '*' stands for any ending
  std::string what;
};

const Refusal refusals[]{
    {"body", "", "not available in this version; available structures: beam, loop, sheet, grains, lammps"},
    {"contact.law", "rounded", std::string("\"rounded\" is ") + not_yet + "; use \"hertz\" or \"lj\""},
};

bool matches(std::string_view pattern, std::string_view word) {
  if (pattern.empty() || pattern.back() != '*') return pattern == word;
  pattern.remove_suffix(1);
  return word.substr(0, pattern.size()) == pattern;
}

}  // namespace

std::string unavailable(const std::string& key, const std::string& word) {
  for (const Refusal& r : refusals)
    if (r.key == key && matches(r.word, word)) return r.what;
  return "";
}

}  // namespace elamin
