// The tracking service through LeapC: a connection, and the thread that waits for its messages.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "core/base/hand_sample.h"
#include "core/base/latest.h"
#include "core/base/time.h"
#include "hw_drivers/leap/drive/settings.h"
#include "hw_drivers/leap/wire/leapc.h"

namespace enc::leap {

// A tracking event and its arrival.
struct Frame {
  std::int64_t number = 0;
  std::int64_t stamp = 0, read = 0;  // us of the library's clock: exposure, and the moment of `came`
  Duration came{};                   // steady clock
  bool seen = false;                 // the hand of the side that is asked for is in it
  leapc::Hand hand;
};

class Service {
 public:
  // Throws Error (kind device) if there is no connection.
  Service(const leapc::Functions& leap, const LeapSettings& settings);
  Service(const Service&) = delete;
  Service& operator=(const Service&) = delete;
  ~Service() = default;

  // Ends thread and connection. Returns false if the thread hangs in the library: this object must then live
  // on.
  [[nodiscard]] bool shut() noexcept;
  // The newest frame since the last call. Neither waits nor allocates.
  [[nodiscard]] bool take(Frame& newest) noexcept { return frames_.read(newest); }
  [[nodiscard]] bool has_device() const noexcept { return has_device_; }
  [[nodiscard]] bool connected() const noexcept { return connected_; }
  [[nodiscard]] std::string serial() const;                           // empty: none yet
  [[nodiscard]] std::string trouble() const;                          // the last one, in words; empty: none
  [[nodiscard]] std::int64_t lost() const noexcept { return lost_; }  // times that the device was

 private:
  void run() noexcept;
  void take(const leapc::Message& message);
  void meet(const leapc::DeviceReference& device);
  void deliver(const leapc::TrackingEvent& event);
  void say(std::string trouble);

  leapc::Functions leap_;
  std::int32_t side_;
  std::uint32_t mode_;
  leapc::Connection connection_ = nullptr;
  LatestValue<Frame> frames_;
  std::atomic<bool> connected_ = false, has_device_ = false, end_ = false, ended_ = false;
  std::atomic<std::int64_t> lost_ = 0;
  mutable std::mutex words_;
  std::string serial_, trouble_;
  std::thread thread_;
};

}  // namespace enc::leap
