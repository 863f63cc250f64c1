// The drivers' messages, kept until the run is over: a few lines, from any thread.
#pragma once

#include <mutex>
#include <string>
#include <vector>

#include "core/devices/driver.h"
#include "models/schema/printable.h"

namespace enc::trial {

class DeviceLog final : public Log {
 public:
  void say(const std::string& line) override {
    const std::lock_guard lock(mutex_);  // text from a device may hold any byte
    if (lines_.size() < kMost) lines_.push_back(models::printable(line));
  }
  [[nodiscard]] std::vector<std::string> lines() const {
    const std::lock_guard lock(mutex_);
    return lines_;
  }

 private:
  static constexpr std::size_t kMost = 100;  // limits a driver that repeats one message for ever
  mutable std::mutex mutex_;
  std::vector<std::string> lines_;
};

}  // namespace enc::trial
