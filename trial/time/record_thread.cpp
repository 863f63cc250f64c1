#include "trial/time/record_thread.h"

#include <csignal>
#include <stop_token>

#include <pthread.h>
#include <sched.h>

namespace enc::trial {

// A signal is for the loop, whose sleep it ends.
RecordThread::RecordThread(RecordWriter& writer) {
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_BLOCK, &all, &before);
  thread_ = std::jthread([&writer](const std::stop_token& stop) {
    constexpr sched_param kNone{};
    pthread_setschedparam(pthread_self(), SCHED_OTHER, &kNone);  // behind the loop, wherever it began
    while (!stop.stop_requested()) {
      writer.drain();
      std::this_thread::sleep_for(kLook);
    }
  });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

}  // namespace enc::trial
