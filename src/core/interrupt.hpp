#pragma once
// Ctrl-C asks; long loops look here between iterations, finish what they hold and say so.
#include <atomic>
#include <functional>
#include <utility>

namespace elamin {

inline std::atomic<bool> interrupt_requested{false};
/// A program's own question, whether work on this thread is to end; null: it has none. What it points to must outlive the work.
inline thread_local const std::function<bool()>* stop_asked = nullptr;

inline bool interrupted() { return interrupt_requested.load(std::memory_order_relaxed) || (stop_asked && (*stop_asked)()); }

/// While it lives, work on this thread asks this.
class StopAsked {
 public:
  explicit StopAsked(const std::function<bool()>& question) : before_(std::exchange(stop_asked, &question)) {}
  ~StopAsked() { stop_asked = before_; }
  StopAsked(const StopAsked&) = delete;
  StopAsked& operator=(const StopAsked&) = delete;

 private:
  const std::function<bool()>* before_;
};

/// Whether a long factorisation has been abandoned because of an interruption since the study began: what has been computed from then on is not reported.
inline std::atomic<bool> gave_up{false};

}  // namespace elamin
