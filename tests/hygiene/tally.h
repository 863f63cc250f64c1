// Counts what a tick of the loop must not do: calls of the heap, locks, system calls and page faults of one
// thread.
//
// The program defines its own malloc(), pthread_mutex_lock() and so on. Every library calls those, also
// libstdc++ and libmujoco. They count and pass on to the C library's. A kernel filter (seccomp) turns each
// system call into a signal that is counted; the kernel itself counts page faults (getrusage).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace enc::test {

// Sanitizers have a heap of their own; the filter supports x86-64 only.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__x86_64__) || \
    !defined(__linux__)
inline constexpr bool kCanTally = false;
#else
#define ENCOUNTER_CAN_TALLY
inline constexpr bool kCanTally = true;
#endif

enum class Offence : std::uint8_t { heap, lock, system_call, minor_fault, major_fault };
inline constexpr std::size_t kOffences = 5;

// One call and its caller. Page faults are only counted.
struct Offender {
  Offence kind = Offence::heap;
  std::array<char, 24> name{};  // "malloc"; for a system call its number
  std::int64_t tick = 0;
  std::array<void*, 24> callers{};
  std::size_t depth = 0;  // entries of the stack
};

struct Tally {
  std::int64_t ticks = 0;
  std::int64_t dirty = 0;  // ticks with at least one call
  std::array<std::int64_t, kOffences> count{};
  std::array<std::int64_t, 512> calls{};  // count of each system call, by its number
  std::array<Offender, 6> first{};
  std::size_t offenders = 0;  // number of offenders
  bool filtered = false;      // the filter counts system calls

  [[nodiscard]] std::int64_t operator[](Offence kind) const { return count[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] std::int64_t all() const;
  [[nodiscard]] std::int64_t faults() const {
    return (*this)[Offence::minor_fault] + (*this)[Offence::major_fault];
  }
};

// Each system call of this thread passes the filter until the process ends, except those that sleep or read
// the clock. Returns false if the kernel, or the process's container, has no filters.
[[nodiscard]] bool filter_system_calls();

void begin_tally();  // for the calling thread; resets all counts
void end_tick();     // call it after each tick
[[nodiscard]] Tally end_tally();

// Maps all memory and code of the process. A child shares a page with its parent until it writes to it. The
// system loads a page of the program's file only when it is read.
void touch_all_pages();

}  // namespace enc::test
