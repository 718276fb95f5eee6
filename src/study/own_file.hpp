#pragma once
#include <string>

namespace elamin {

/// Throws InputError where `file` is there and `elamin COMMAND` has not written it, as one of its first two lines says; not with `force`.
void must_be_own(const std::string& file, const std::string& command, bool force);

}  // namespace elamin
