// Waits of a driver in lockstep with a fake.
#pragma once

#include <algorithm>

namespace enc::net {

// s. The world of the fake stands until it answers, so in lockstep no answer is late, whatever the load of
// the computer. This wait only ends a run whose fake hangs.
inline constexpr double kFakeHangs = 5.0;

// Longest wait for an answer, s.
[[nodiscard]] inline double longest_wait(double timeout, bool lockstep) noexcept {
  return lockstep ? std::max(timeout, kFakeHangs) : timeout;
}

}  // namespace enc::net
