#pragma once
// Values of a problem file as a translation writes them.
#include "laws/region.hpp"

#include <string>
#include <vector>

namespace elamin::script {

std::string vec(const Vec3& v);
std::string quoted(const std::string& s);
/// For between quotes; bytes below 32 become blanks.
std::string escaped(const std::string& s);
/// A list over several lines where it is long.
std::string list_of(const std::vector<std::string>& items);
std::string ordinal(int k);
/// The keys of a [[wall]] of this shape, a line each.
std::string region_text(const Region& r, bool inside);

}  // namespace elamin::script
