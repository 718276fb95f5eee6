#pragma once
// Ctrl-C asks; long loops look here between iterations, finish what they hold and say so.
#include <atomic>

namespace elamin {

inline std::atomic<bool> interrupt_requested{false};
inline bool interrupted() { return interrupt_requested.load(std::memory_order_relaxed); }

}  // namespace elamin
