// Priority of a device's thread beside the loop, from which it inherits its own.
#pragma once

#include <algorithm>

#include <pthread.h>
#include <sched.h>

namespace enc::net {

// Raises the fixed priority of the calling thread by so many steps; a negative number lowers it, to 1 at
// least. Without a fixed priority it changes nothing.
inline void shift_priority(int steps) noexcept {
  int policy = SCHED_OTHER;
  sched_param priority{};
  if (pthread_getschedparam(pthread_self(), &policy, &priority) != 0 || policy != SCHED_FIFO) return;
  priority.sched_priority = std::max(priority.sched_priority + steps, 1);
  static_cast<void>(pthread_setschedparam(pthread_self(), policy, &priority));
}

}  // namespace enc::net
