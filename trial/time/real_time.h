// Real-time priority of the loop: a fixed priority (SCHED_FIFO) for this thread and the threads that it
// starts, and locked memory. It goes as far as the system allows; otherwise the run goes on without it.
#pragma once

#include <cstdint>
#include <string>

namespace enc::trial {

// The rights by which the system grants a process a fixed priority, sched(7).
struct RealTimeRights {
  bool root = false;       // the effective user
  bool sys_nice = false;   // CAP_SYS_NICE is effective, and not only within a user namespace
  bool container = false;  // container files exist: no login reads limits.conf there
  std::uint64_t most = 0;  // RLIMIT_RTPRIO
};
[[nodiscard]] RealTimeRights real_time_rights();
// The reason for a refused priority, and the remedy. error: of pthread_setschedparam().
[[nodiscard]] std::string real_time_refusal(int error, const RealTimeRights& rights);

class RealTime {
 public:
  static constexpr int kPriority = 40;  // range 1 to 99: below the kernel's own threads at 50

  explicit RealTime(bool wanted);
  ~RealTime();  // restores the earlier state
  RealTime(const RealTime&) = delete;
  RealTime& operator=(const RealTime&) = delete;

  // "SCHED_FIFO 40, memory locked"; or the reason for a refusal and the remedy. Empty: not requested.
  [[nodiscard]] const std::string& words() const { return words_; }
  [[nodiscard]] bool granted() const { return first_; }                  // priority granted
  [[nodiscard]] const std::string& refusal() const { return refusal_; }  // empty: granted

 private:
  std::string words_, refusal_;
  bool first_ = false, locked_ = false;
  int policy_before_ = 0, priority_before_ = 0;
};

}  // namespace enc::trial
