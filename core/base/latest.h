// Hands the newest value from one thread to one other thread without a lock. Neither thread waits, and a
// value that is replaced before it is read is lost. Three places: the writer holds one, the reader holds one,
// and the third changes hands.
#pragma once

#include <array>
#include <atomic>
#include <type_traits>

namespace enc {

template <class V>
class LatestValue {
  static_assert(std::is_trivially_copyable_v<V>);

 public:
  // Call only from the writing thread.
  void write(const V& value) noexcept {
    places_[written_] = value;
    written_ = between_.exchange(written_ | kNews, std::memory_order_acq_rel) & kPlace;
  }
  // Call only from the reading thread. Returns false and leaves `newest` alone if the writer wrote nothing
  // since the last read.
  bool read(V& newest) noexcept {
    if ((between_.load(std::memory_order_relaxed) & kNews) == 0) return false;
    read_ = between_.exchange(read_, std::memory_order_acq_rel) & kPlace;
    newest = places_[read_];
    return true;
  }

 private:
  static constexpr unsigned kNews = 4, kPlace = 3;
  std::array<V, 3> places_{};
  unsigned written_ = 0;  // the writer's place
  // free place, with kNews set until it is read
  std::atomic<unsigned> between_ = 1;
  unsigned read_ = 2;  // the reader's place
};

}  // namespace enc
