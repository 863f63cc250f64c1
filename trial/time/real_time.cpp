#include "trial/time/real_time.h"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>

namespace enc::trial {

RealTime::RealTime(bool wanted) {
  if (!wanted) return;
  sched_param before{};
  first_ = pthread_getschedparam(pthread_self(), &policy_before_, &before) == 0;
  priority_before_ = before.sched_priority;
  sched_param now{};
  now.sched_priority = kPriority;
  first_ = first_ && pthread_setschedparam(pthread_self(), SCHED_FIFO, &now) == 0;
  locked_ = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  words_ = first_ ? fmt::format("SCHED_FIFO {}", kPriority)
                  : std::string("not first (allow it in /etc/security/limits.conf: rtprio 41)");
  words_ += locked_ ? ", memory locked" : ", memory not locked (memlock unlimited, likewise)";
}

RealTime::~RealTime() {
  if (locked_) munlockall();
  if (!first_) return;
  sched_param before{};
  before.sched_priority = priority_before_;
  pthread_setschedparam(pthread_self(), policy_before_, &before);
}

}  // namespace enc::trial
