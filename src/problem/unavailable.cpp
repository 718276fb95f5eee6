#include "problem/unavailable.hpp"

#include <string_view>

namespace elamin {
namespace {

constexpr const char* not_yet = "not available in this version";
constexpr const char* needs_arc_length = "needs the arc-length method, which is not available in this version; use ";

struct Refusal {
  std::string_view key, word;   // word "": the key itself; a trailing '*' stands for any ending
  std::string what;
};

const Refusal refusals[]{
    {"body", "", "not available in this version; available structures: beam, loop, sheet, grains, lammps"},
    {"contact.law", "rounded", std::string("\"rounded\" is ") + not_yet + "; use \"hertz\" or \"lj\""},
    {"dynamics", "", std::string(not_yet) + "; available studies: energy, equilibrium, path, modes"},
    {"support.velocity", "", std::string(not_yet) + "; it belongs to dynamics"},
    {"path.parameter", "", std::string(not_yet) + "; the parameter is the load factor"},
    {"path.branches", "*", std::string("switching branches ") + needs_arc_length + "0"},
    {"path.when_unstable", "follow", std::string("\"follow\" ") + needs_arc_length + "\"jump\" or \"stop\""},
    {"path.method", "arc_length", std::string("\"arc_length\" is ") + not_yet + "; use \"load_steps\""},
    {"study.type", "dynamics",
     std::string("\"dynamics\" is ") + not_yet + "; use \"energy\", \"equilibrium\", \"path\" or \"modes\""},
    {"solver.method", "ipopt", std::string("\"ipopt\" is ") + not_yet + "; use \"newton\""},
    {"solver.method", "nlopt:*", std::string("NLopt is ") + not_yet + "; use \"newton\""},
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
