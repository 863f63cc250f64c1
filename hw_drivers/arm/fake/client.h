// The connection of a fake vendor's library to the fake arm (server.h).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <mutex>

#include "core/base/time.h"
#include "hw_drivers/arm/fake/message.h"
#include "hw_drivers/net/socket.h"

namespace enc::arm {

class Client {
 public:
  // Returns false if no fake arm answers there within this time.
  [[nodiscard]] bool open(const Place& place, Duration within) noexcept;
  void close() noexcept;
  [[nodiscard]] bool is_open() const noexcept { return session_ != 0; }

  // Waits for a newer state, at most this long, and takes the newest; returns false if none came.
  bool wait(Duration most) noexcept;
  [[nodiscard]] const State& state() const noexcept { return state_; }
  [[nodiscard]] bool lockstep() const noexcept { return (state_.flags & kLockstep) != 0; }
  // Sets the watchdog of the fake's firmware, s.
  void set_watchdog(double time) noexcept { watchdog_ = time; }
  // Sends a force in R, N, that answers state().
  void send(const std::array<double, 3>& force, bool enabled) noexcept;
  void end_force() noexcept;  // answers no state; any thread may call it
  // Lockstep: sends a force and waits for the state after it; false: no answer within this time.
  bool exchange(const std::array<double, 3>& force, bool enabled, Duration within) noexcept;

 private:
  void send(Message message, const std::array<double, 3>& force, bool enabled, std::uint64_t state) noexcept;
  bool take() noexcept;  // takes what has come; true: a newer state

  net::Socket socket_;
  State state_;
  std::uint64_t session_ = 0;
  std::atomic<double> watchdog_ = 0.0;  // s
  std::uint64_t number_ = 0;            // of the last force
  std::mutex sending_;                  // the device's thread and a watch may send
};

}  // namespace enc::arm
