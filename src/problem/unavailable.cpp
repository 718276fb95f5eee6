#include "problem/unavailable.hpp"

#include <string_view>

namespace elamin {
namespace {

constexpr const char* structures = "not available in this version; available structures: beam, lammps";
constexpr const char* not_yet = "not available in this version";
constexpr const char* needs_arc_length = "needs the arc-length method, which is not available in this version; use ";

struct Refusal {
  std::string_view key, word;   // word "": the key itself; a trailing '*' stands for any ending
  std::string what;
};

const Refusal refusals[]{
    {"loop", "", structures},
    {"sheet", "", structures},
    {"grains", "", structures},
    {"body", "", structures},
    {"contact", "", not_yet},
    {"wall", "", not_yet},
    {"connect", "", not_yet},
    {"dynamics", "", std::string(not_yet) + "; available studies: energy, equilibrium, path"},
    {"support.velocity", "", std::string(not_yet) + "; it belongs to dynamics"},
    {"path.parameter", "", std::string(not_yet) + "; the parameter is the load factor"},
    {"path.branches", "*", std::string("switching branches ") + needs_arc_length + "0"},
    {"path.when_unstable", "follow", std::string("\"follow\" ") + needs_arc_length + "\"jump\" or \"stop\""},
    {"path.method", "arc_length", std::string("\"arc_length\" is ") + not_yet + "; use \"load_steps\""},
    {"study.type", "modes", std::string("\"modes\" is ") + not_yet + "; use \"energy\", \"equilibrium\" or \"path\""},
    {"study.type", "dynamics",
     std::string("\"dynamics\" is ") + not_yet + "; use \"energy\", \"equilibrium\" or \"path\""},
    {"solver.method", "ipopt", std::string("\"ipopt\" is ") + not_yet + "; use \"newton\""},
    {"solver.method", "nlopt:*", std::string("NLopt is ") + not_yet + "; use \"newton\""},
    {"observe.quantity", "gap*",
     std::string("a gap is ") + not_yet + "; use a position, displacement, reaction or velocity"},
    {"observe.quantity", "contacts",
     std::string("contacts are ") + not_yet + "; use a position, displacement, reaction or velocity"},
    {"group.inside.shape", "plane", std::string("\"plane\" is ") + not_yet + "; use \"block\""},
    {"group.inside.shape", "cylinder", std::string("\"cylinder\" is ") + not_yet + "; use \"block\""},
    {"group.inside.shape", "sphere", std::string("\"sphere\" is ") + not_yet + "; use \"block\""},
    {"group.inside.shape", "cone", std::string("\"cone\" is ") + not_yet + "; use \"block\""},
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
