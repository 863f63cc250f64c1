// Lists that grow during the loop reserve their memory beforehand, so that a tick never allocates.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/base/frames.h"

namespace enc::trial {

// Capacity of a list of contacts or presses: more than twenty minutes of them. A longer list doubles each
// time that it is full, as usual.
inline constexpr std::size_t kRoom = 256;

// Returns an empty list whose memory has been written once: untouched memory would cause a page fault.
template <class T>
[[nodiscard]] std::vector<T> with_room(std::size_t n = kRoom) {
  std::vector<T> list(n);
  list.clear();
  return list;
}

// Positions of the prop in the last ticks.
class Way {
 public:
  static constexpr std::size_t kMost = 1 << 14;  // ticks: 16 s at 1 kHz; older ones are forgotten

  // Call once, before a tick adds to it.
  void make_room() {
    if (ring_.empty()) ring_.resize(kMost);
  }
  void clear() noexcept { size_ = 0; }
  void add(const Point<'W'>& at) {
    make_room();
    ring_[next_] = at;
    next_ = (next_ + 1) % kMost;
    size_ = std::min(size_ + 1, kMost);
  }
  // Number of consecutive last ticks within `within` (m) of a place; 0 if the last tick is not.
  [[nodiscard]] std::size_t there(const Point<'W'>& place, double within) const {
    std::size_t n = 0;
    while (n < size_ && (ring_[(next_ + kMost - 1 - n) % kMost] - place).norm() <= within) ++n;
    return n;
  }

 private:
  std::vector<Point<'W'>> ring_;
  std::size_t next_ = 0, size_ = 0;
};

}  // namespace enc::trial
