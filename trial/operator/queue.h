// A lock-free queue of fixed size between one writing and one reading thread.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <type_traits>

namespace enc::trial {

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
