#include "problem/unavailable.hpp"

#include <string_view>

namespace elamin {
namespace {

struct Refusal {
  std::string_view key, word;   // word "": the key itself
  const char* what;
};

constexpr Refusal refusals[]{
    {"body", "", "not available in this version; available structures: beam, loop, sheet, grains, lammps"},
    {"contact.law", "rounded", "\"rounded\" is not available in this version; use \"hertz\" or \"lj\""},
};

}  // namespace

std::string unavailable(const std::string& key, const std::string& word) {
  for (const Refusal& r : refusals)
    if (r.key == key && r.word == word) return r.what;
  return "";
}

}  // namespace elamin
