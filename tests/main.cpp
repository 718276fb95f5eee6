// Memory is kept as the program keeps it; main itself is Catch2's.
#include "core/memory.hpp"

namespace {
[[maybe_unused]] const bool kept = (elamin::keep_freed_memory(), true);
}
