#pragma once
// What the problem file of a later version may hold and this one refuses, all in one place.
#include <string>

namespace elamin {

/// The sentence that refuses a key ("sheet", "path.parameter") or a word of it ("contact.law", "rounded"); "" if
/// this is not a matter of the version.
std::string unavailable(const std::string& key, const std::string& word = "");

}  // namespace elamin
