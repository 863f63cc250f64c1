// The data of an armed run for its operator: the present status, and events as they happen. On the loop's
// side it only compares and copies; it neither allocates nor waits.
#pragma once

#include <array>
#include <cstdint>

#include "core/base/latest.h"
#include "trial/time/real_time.h"
#include "trial/trial_options.h"

namespace enc::trial {

struct RunStatus {
  Time t{};
  Mode mode = Mode::away;
  std::uint32_t why = 0;
  bool halted = false;      // stopped by hand
  double gap = kUnset;      // m
  double force = kUnset;    // N, pressing force along the surface's normal
  std::int64_t missed = 0;  // missed cycles since the start
  static constexpr std::size_t kPeriods = 1000;
  std::array<std::uint32_t, kPeriods> periods_ns{};  // last ticks, in any order
  std::size_t periods = 0;                           // number of valid entries
};

struct RunEvent {
  enum class Kind : std::uint8_t {
    hold,
    hold_over,
    contact,
    contact_over,
    link_lost,
    halted,
    suspended,
    resumed,
    ends
  };
  Kind kind = Kind::hold;
  Time t{};
  std::uint32_t why = 0;       // reasons of a hold
  Mode mode = Mode::away;      // mode after a hold
  std::int32_t contact = 0;    // number of the contact
  std::int32_t object = -1;    // object of the contact
  const char* role = nullptr;  // role of a lost link
  int signal = 0;              // signal that ended the run; 0: a key
};

class RunWatch {
 public:
  void see(const Glance& glance) noexcept;
  // Records an action of the operator.
  void note(RunEvent::Kind kind, int signal = 0) noexcept;

  [[nodiscard]] const RunStatus& status() const noexcept { return status_; }  // after the last tick
  [[nodiscard]] bool halted() const noexcept { return status_.halted; }       // by hand, before the last tick

  // The reader's side, for one other thread.
  bool newest(RunStatus& status) noexcept { return statuses_.read(status); }
  bool next(RunEvent& event) noexcept { return events_.pop(event); }
  [[nodiscard]] std::size_t take_dropped() noexcept { return events_.take_dropped(); }

 private:
  void push(RunEvent event) noexcept;
  void compare(const Glance& glance) noexcept;

  static constexpr int kStatusEach = 50;  // ticks between two statuses
  RunStatus status_;
  LatestValue<RunStatus> statuses_;
  Queue<RunEvent, 128> events_;
  std::int64_t ticks_ = 0;
  std::uint32_t why_ = 0;
  std::int32_t contacts_ = 0;
  bool in_contact_ = false;
  std::array<bool, kRoles> lost_{};
};

}  // namespace enc::trial
