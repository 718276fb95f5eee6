#pragma once

namespace elamin {

/// What this program can have without taking it from others, or beyond its limit (ulimit -v) [bytes]; infinity where the system does not tell.
double free_memory();

}  // namespace elamin
