// Priority of a thread beside the one that made it, whose priority it inherits.
#pragma once

#include <algorithm>

#include <pthread.h>
#include <sched.h>

namespace enc::trial {

// Lowers the priority of the calling thread by so many steps. Without a fixed priority there is none to
// lower.
inline void come_after(int steps) noexcept {
  int policy = SCHED_OTHER;
  sched_param priority{};
  if (pthread_getschedparam(pthread_self(), &policy, &priority) != 0 || policy != SCHED_FIFO) return;
  priority.sched_priority = std::max(priority.sched_priority - steps, 1);
  static_cast<void>(pthread_setschedparam(pthread_self(), policy, &priority));
}

}  // namespace enc::trial
