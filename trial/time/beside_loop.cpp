#include "trial/time/beside_loop.h"

#include <csignal>
#include <utility>

#include <pthread.h>
#include <sched.h>

namespace enc::trial {

std::jthread beside_loop(std::function<void(const std::stop_token&)> work) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  std::jthread thread([work = std::move(work)](const std::stop_token& stop) {
    constexpr sched_param kNone{};
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &kNone);
    work(stop);
  });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace enc::trial
