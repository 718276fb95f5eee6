#pragma once
// Ctrl-C asks; long loops look here between iterations, finish what they hold and say so.
#include <atomic>
#include <functional>

namespace elamin {

inline std::atomic<bool> interrupt_requested{false};
/// A program's own question, whether work on this thread is to end; null: it has none. What it points to must outlive the work.
inline thread_local const std::function<bool()>* stop_asked = nullptr;

inline bool interrupted() { return interrupt_requested.load(std::memory_order_relaxed) || (stop_asked && (*stop_asked)()); }

/// Whether a long factorisation has been abandoned because of an interruption since the study began: what has been computed from then on is not reported.
inline std::atomic<bool> gave_up{false};

}  // namespace elamin
