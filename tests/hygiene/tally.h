// What a tick of the loop must not do, counted while it runs: calls of the heap, locks, system calls, page
// faults. Of one thread.
//
// The program has its own malloc(), pthread_mutex_lock() and so on: every library calls those of the program,
// libstdc++ and libmujoco, too. They count and go on to the C library's. System calls are counted by a filter
// of the kernel (seccomp), which makes a signal of each; page faults by the kernel itself (getrusage).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace enc::test {

// Sanitizers have a heap of their own; the filter is written for x86-64.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__x86_64__) || \
    !defined(__linux__)
inline constexpr bool kCanTally = false;
#else
#define ENCOUNTER_CAN_TALLY
inline constexpr bool kCanTally = true;
#endif

enum class Offence : std::uint8_t { heap, lock, system_call, minor_fault, major_fault };
inline constexpr std::size_t kOffences = 5;

// One call, and who made it. Of page faults only the number is known.
struct Offender {
  Offence kind = Offence::heap;
  std::array<char, 24> name{};  // "malloc"; of a system call its number
  std::int64_t tick = 0;
  std::array<void*, 24> callers{};
  std::size_t depth = 0;  // of them
};

struct Tally {
  std::int64_t ticks = 0;
  std::int64_t dirty = 0;  // ticks in which something was called
  std::array<std::int64_t, kOffences> count{};
  std::array<std::int64_t, 512> calls{};  // of each system call, by its number
  std::array<Offender, 6> first{};
  std::size_t offenders = 0;  // of them
  bool filtered = false;      // system calls are counted

  [[nodiscard]] std::int64_t operator[](Offence kind) const { return count[static_cast<std::size_t>(kind)]; }
  [[nodiscard]] std::int64_t all() const;
  [[nodiscard]] std::int64_t faults() const {
    return (*this)[Offence::minor_fault] + (*this)[Offence::major_fault];
  }
};

// From here to the end of the process each system call of this thread goes through the filter, but those that
// sleep or read the clock. False where the kernel, or what holds the process, has no filters.
[[nodiscard]] bool filter_system_calls();

void begin_tally();  // of the calling thread; what it was until then is forgotten
void end_tick();     // after each
[[nodiscard]] Tally end_tally();

// All memory and all code that the process has by now are in their places: a page of a child is its parent's
// until it is written to, and one of a program's file is not there until it is read.
void touch_all_pages();

}  // namespace enc::test
