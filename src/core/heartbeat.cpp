#include "core/heartbeat.hpp"

#include <fmt/format.h>

#include <utility>

namespace elamin {

namespace {

std::vector<std::string> told(const detail::Work& work) {
  std::vector<std::string> all;
  if (const int k = work.iteration; k >= 0) all = {fmt::format("iteration {}", k), fmt::format("residual {:.0e}", work.residual.load())};
  if (const char* doing = work.doing; *doing) all.push_back(doing);
  return all;
}

}  // namespace

Heartbeat::Heartbeat(double seconds, OnBeat on_beat)
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

void Heartbeat::beat(double seconds, const OnBeat& on_beat) {
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
