#pragma once
// Ctrl-C in Python: signals are looked at while a solver works.
#include "core/interrupt.hpp"

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <mutex>
#include <optional>

namespace elamin::python {

namespace py = pybind11;

/// Whether a signal's handler has raised something in Python. Only the main thread runs handlers.
class Signals {
 public:
  /// Looks at most every 50 ms; takes Python's lock. True from the first time on that a handler has raised.
  bool arrived() {
    if (arrived_) return true;
    const auto now = std::chrono::steady_clock::now().time_since_epoch().count();
    auto last = looked_.load();
    constexpr auto pause = std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::milliseconds(50)).count();
    if (now - last < pause || !looked_.compare_exchange_strong(last, now)) return false;
    const py::gil_scoped_acquire acquire;
    return look();
  }
  /// The same at once, where the lock is held.
  bool look() {
    if (!arrived_ && PyErr_CheckSignals() != 0) raised_.emplace(), arrived_ = true;
    return arrived_;
  }
  /// What the handler raised, if it did. The lock is held.
  void raise() {
    if (raised_) throw py::error_already_set(std::move(*raised_));
  }
  const std::function<bool()>& question() const { return question_; }

 private:
  std::atomic<bool> arrived_{false};
  std::atomic<std::chrono::steady_clock::rep> looked_{std::chrono::steady_clock::now().time_since_epoch().count()};
  std::optional<py::error_already_set> raised_;
  std::function<bool()> question_ = [this] { return arrived(); };
};

/// While it lives, work on this thread asks this.
class Stopping {
 public:
  explicit Stopping(const std::function<bool()>& question) : before_(stop_asked) { stop_asked = &question; }
  ~Stopping() { stop_asked = before_; }
  Stopping(const Stopping&) = delete;
  Stopping& operator=(const Stopping&) = delete;

 private:
  const std::function<bool()>* before_;
};

}  // namespace elamin::python
