#pragma once
// How long a test takes, whatever runs beside it.
#include <ctime>

/// How many times as long all may take with the sanitizers.
#ifdef __SANITIZE_ADDRESS__
inline constexpr int slower = 10;
#else
inline constexpr int slower = 1;
#endif

/// Seconds of the processor since `begin`, of std::clock; with the sanitizers a tenth of them.
inline double processor_seconds(std::clock_t begin) { return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC / slower; }
