// The loop in real time: its priority, the threads beside it, and the queue between two threads.
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>
#include <type_traits>

#include "core/record/record.h"

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

// A fixed priority (SCHED_FIFO) for this thread and the threads that it starts, and locked memory. It goes as
// far as the system allows; otherwise the run goes on without it.
class RealTime {
 public:
  static constexpr int kPriority = 40;  // range 1 to 99: below the kernel's own threads at 50

  explicit RealTime(bool wanted);
  ~RealTime();  // restores the earlier state
  RealTime(const RealTime&) = delete;
  RealTime& operator=(const RealTime&) = delete;

  // Returns "SCHED_FIFO 40, memory locked", or the reason for a refusal and the remedy. Empty: not requested.
  [[nodiscard]] const std::string& words() const { return words_; }
  [[nodiscard]] bool granted() const { return first_; }                  // priority granted
  [[nodiscard]] const std::string& refusal() const { return refusal_; }  // empty: granted

 private:
  std::string words_, refusal_;
  bool first_ = false, locked_ = false;
  int policy_before_ = 0, priority_before_ = 0;
};

// Starts a thread beside a real-time loop, which takes no signal, because a signal would end the loop's
// sleep. It has a lower priority than the loop, whatever the caller's priority.
[[nodiscard]] std::jthread beside_loop(std::function<void(const std::stop_token&)> work);

// Writes a record to its file beside a wall-clock run, so that no tick waits for a disk.
class RecordThread {
 public:
  // Shorter than the time of a chunk up to 6 kHz.
  static constexpr std::chrono::milliseconds kLook{10};
  // `writer` must outlive this object, and is closed afterwards.
  explicit RecordThread(RecordWriter& writer);
  RecordThread(const RecordThread&) = delete;
  RecordThread& operator=(const RecordThread&) = delete;

 private:
  std::jthread thread_;
};

// A lock-free queue of fixed size between one writing and one reading thread.
template <class V, std::size_t kRoom>
class Queue {
  static_assert(std::is_trivially_copyable_v<V>);

 public:
  // Returns false if the queue is full; the value is then dropped and counted.
  bool push(const V& value) noexcept {
    const std::size_t at = pushed_.load(std::memory_order_relaxed);
    if (at - popped_.load(std::memory_order_acquire) == kRoom) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    places_[at % kRoom] = value;
    pushed_.store(at + 1, std::memory_order_release);
    return true;
  }
  bool pop(V& value) noexcept {
    const std::size_t at = popped_.load(std::memory_order_relaxed);
    if (at == pushed_.load(std::memory_order_acquire)) return false;
    value = places_[at % kRoom];
    popped_.store(at + 1, std::memory_order_release);
    return true;
  }
  [[nodiscard]] std::size_t take_dropped() noexcept { return dropped_.exchange(0); }

 private:
  std::array<V, kRoom> places_{};
  std::atomic<std::size_t> pushed_ = 0, popped_ = 0, dropped_ = 0;
};

}  // namespace enc::trial
