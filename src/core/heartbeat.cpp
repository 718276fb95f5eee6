#include "core/heartbeat.hpp"

#include <fmt/format.h>

#include <chrono>
#include <utility>

namespace elamin {

namespace {

std::string told(const detail::Work& work) {
  const char* doing = work.doing;
  const int iteration = work.iteration;
  if (iteration < 0) return doing;
  return fmt::format("iteration {}, residual {:.0e}{}{}", iteration, work.residual.load(), *doing ? ", " : "", doing);
}

}  // namespace

Heartbeat::Heartbeat(double seconds, std::function<void(const std::string&)> on_beat)
    : before_(std::exchange(detail::work, &work_)), thread_([this, seconds, f = std::move(on_beat)] { beat(seconds, f); }) {}

Heartbeat::~Heartbeat() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  ended_.notify_one();
  thread_.join();
  detail::work = before_;
}

void Heartbeat::beat(double seconds, const std::function<void(const std::string&)>& on_beat) {
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return over_; })) {
    lock.unlock();
    try {
      on_beat(told(work_));
    } catch (const std::exception&) {            // it comes again where the work itself meets it
    }
    lock.lock();
  }
}

}  // namespace elamin
