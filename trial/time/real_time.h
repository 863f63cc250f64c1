// The loop before other work of this computer: a fixed priority (SCHED_FIFO) for this thread and those that
// it begins, and memory that is never paged out. As far as the system allows; else the run goes on without.
#pragma once

#include <string>

namespace enc::trial {

class RealTime {
 public:
  static constexpr int kPriority = 40;  // of 1 to 99: below the kernel's own threads at 50

  explicit RealTime(bool wanted);
  ~RealTime();  // as it was before
  RealTime(const RealTime&) = delete;
  RealTime& operator=(const RealTime&) = delete;

  // "SCHED_FIFO 40, memory locked"; or why not, and what to do. Empty: not wanted.
  [[nodiscard]] const std::string& words() const { return words_; }
  [[nodiscard]] bool granted() const { return first_; }  // the priority

 private:
  std::string words_;
  bool first_ = false, locked_ = false;
  int policy_before_ = 0, priority_before_ = 0;
};

}  // namespace enc::trial
