#include "results/sweep_table.hpp"

#include "core/error.hpp"

namespace elamin {

SweepTable::~SweepTable() {
  try {
    for (const auto& [run, row] : waiting_) csv_.add(row);
  } catch (const OutputError&) {
    // a destructor has nobody to tell; the rows before were written
  }
}

void SweepTable::add(int run, Row row) {
  const std::lock_guard<std::mutex> lock(mutex_);
  waiting_[run] = std::move(row);
  for (auto it = waiting_.find(next_); it != waiting_.end(); it = waiting_.find(++next_)) {
    csv_.add(it->second);
    waiting_.erase(it);
  }
}

}  // namespace elamin
