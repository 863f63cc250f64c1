#include "trial/time/real_time.h"

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace enc::trial {
namespace {

// Reads a line of /proc/self/status, as "CapEff:\t000001ffffffffff".
bool has_capability(unsigned number) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (!line.starts_with("CapEff:")) continue;
    std::uint64_t bits = 0;
    std::istringstream(line.substr(line.find(':') + 1)) >> std::hex >> bits;
    return ((bits >> number) & 1U) != 0;
  }
  return false;
}

// The first user namespace maps every number to itself. A capability in another namespace has no effect
// outside of it.
bool in_first_user_namespace() {
  std::ifstream map("/proc/self/uid_map");
  std::uint64_t inside = 1, outside = 1, count = 0;
  constexpr std::uint64_t kAll = 4294967295;
  return !(map >> inside >> outside >> count) || (inside == 0 && outside == 0 && count == kAll);
}

}  // namespace

RealTimeRights real_time_rights() {
  constexpr unsigned kSysNice = 23;  // CAP_SYS_NICE, capability.h
  rlimit limit{};
  getrlimit(RLIMIT_RTPRIO, &limit);
  std::error_code none;
  return {.root = geteuid() == 0,
          .sys_nice = has_capability(kSysNice) && in_first_user_namespace(),
          .container = std::filesystem::exists("/.dockerenv", none) ||
                       std::filesystem::exists("/run/.containerenv", none),
          .most = limit.rlim_cur};
}

std::string real_time_refusal(int error, const RealTimeRights& rights) {
  if (error != EPERM) return fmt::format("the system refuses SCHED_FIFO: {}", std::strerror(error));
  // Despite the right, the kernel refuses a process whose control group has no real-time budget.
  if (rights.sys_nice || rights.most >= RealTime::kPriority)
    return "the container or control group has no real-time budget: docker run --cpu-rt-runtime=950000 "
           "--ulimit rtprio=41 --cap-add=SYS_NICE, or sysctl -w kernel.sched_rt_runtime_us=-1 on the host";
  if (rights.root || rights.container)
    return "the container lacks the right: docker run --cap-add=SYS_NICE --ulimit rtprio=41";
  return "allow it in /etc/security/limits.conf: rtprio 41";
}

RealTime::RealTime(bool wanted) {
  if (!wanted) return;
  sched_param before{};
  const bool known = pthread_getschedparam(pthread_self(), &policy_before_, &before) == 0;
  priority_before_ = before.sched_priority;
  sched_param now{};
  now.sched_priority = kPriority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &now);
  first_ = known && error == 0;
  locked_ = mlockall(MCL_CURRENT | MCL_FUTURE) == 0;
  const RealTimeRights rights = first_ && locked_ ? RealTimeRights{} : real_time_rights();
  if (!first_) refusal_ = real_time_refusal(error, rights);
  words_ = first_ ? fmt::format("SCHED_FIFO {}", kPriority) : fmt::format("not first ({})", refusal_);
  words_ += locked_            ? ", memory locked"
            : rights.container ? ", memory not locked (docker run --ulimit memlock=-1)"
                               : ", memory not locked (memlock unlimited, likewise)";
}

RealTime::~RealTime() {
  if (locked_) munlockall();
  if (!first_) return;
  sched_param before{};
  before.sched_priority = priority_before_;
  pthread_setschedparam(pthread_self(), policy_before_, &before);
}

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

RecordThread::RecordThread(RecordWriter& writer)
    : thread_(beside_loop([&writer](const std::stop_token& stop) {
        while (!stop.stop_requested()) {
          writer.drain();
          std::this_thread::sleep_for(kLook);
        }
      })) {}

}  // namespace enc::trial
