// Hands the newest of large values from one thread to one other thread, without a lock and without a copy.
// Three places: the writer fills one, the reader holds one, and the third changes hands (core/base/latest.h
// copies).
#pragma once

#include <array>
#include <atomic>

namespace enc::v4l2 {

template <class V>
class Exchange {
 public:
  [[nodiscard]] V& back() { return places_[written_]; }            // the writer's
  [[nodiscard]] const V& front() const { return places_[read_]; }  // the reader's
  // Hands over back(). True: a value that was not read is lost.
  bool write() noexcept {
    const unsigned before = between_.exchange(written_ | kNews, std::memory_order_acq_rel);
    written_ = before & kPlace;
    return (before & kNews) != 0;
  }
  // False, and front() stays: the writer handed over nothing since the last call.
  bool read() noexcept {
    if ((between_.load(std::memory_order_relaxed) & kNews) == 0) return false;
    read_ = between_.exchange(read_, std::memory_order_acq_rel) & kPlace;
    return true;
  }

 private:
  static constexpr unsigned kNews = 4, kPlace = 3;
  std::array<V, 3> places_{};
  unsigned written_ = 0;
  std::atomic<unsigned> between_ = 1;
  unsigned read_ = 2;
};

}  // namespace enc::v4l2
