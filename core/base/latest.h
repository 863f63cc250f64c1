// The newest value of one thread for one other, without a lock: nobody waits, and what came too fast to be
// read is passed over. The two threads never have the same of three places: one is written, one is read, and
// the third changes hands.
#pragma once

#include <array>
#include <atomic>
#include <type_traits>

namespace enc {

template <class V>
class Latest {
  static_assert(std::is_trivially_copyable_v<V>);

 public:
  // Of the one thread that writes.
  void write(const V& value) noexcept {
    places_[written_] = value;
    written_ = between_.exchange(written_ | kNews, std::memory_order_acq_rel) & kPlace;
  }
  // Of the one thread that reads: false where nothing was written since; then it leaves `newest` alone.
  bool read(V& newest) noexcept {
    if ((between_.load(std::memory_order_relaxed) & kNews) == 0) return false;
    read_ = between_.exchange(read_, std::memory_order_acq_rel) & kPlace;
    newest = places_[read_];
    return true;
  }

 private:
  static constexpr unsigned kNews = 4, kPlace = 3;
  std::array<V, 3> places_{};
  unsigned written_ = 0;               // of the writer
  std::atomic<unsigned> between_ = 1;  // the place that nobody has, with kNews until it is read
  unsigned read_ = 2;                  // of the reader
};

}  // namespace enc
