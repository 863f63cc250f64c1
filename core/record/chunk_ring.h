// The memory of a record on its way to a file: one thread fills chunks, another takes those that are whole.
// Neither waits for the other, and nothing is allocated.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace enc {

class ChunkRing {
 public:
  struct Chunk {  // head, leaves, checksum
    std::vector<std::uint64_t> words;
    std::size_t used = 1;
  };
  ChunkRing(std::size_t chunks, std::size_t words) : chunks_(chunks), place_(chunks) {
    for (Chunk& one : chunks_) one.words.resize(words);
  }

  // Of the thread that fills.
  [[nodiscard]] Chunk& filling() noexcept { return chunk(whole_.load(std::memory_order_relaxed)); }
  // That one is whole, and another is filled from here on. One that was taken before one that never was, so
  // that as long as the other thread keeps up no memory is filled that the processor has forgotten. False:
  // none is left.
  [[nodiscard]] bool next() noexcept {
    const std::size_t number = whole_.load(std::memory_order_relaxed) + 1;
    std::size_t& place = place_[number % place_.size()];  // whose number before was taken long ago
    whole_.store(number, std::memory_order_release);
    if (again_ < taken_.load(std::memory_order_acquire))
      place = place_[again_++ % place_.size()];
    else if (untouched_ < chunks_.size())
      place = untouched_++;
    else
      return false;
    chunk(number).used = 1;
    return true;
  }

  // Of the thread that takes: take(chunk) of each that is whole, in order.
  template <class Take>
  void drain(Take take) noexcept {
    for (std::size_t i = taken_.load(std::memory_order_relaxed); i < whole_.load(std::memory_order_acquire);
         ++i) {
      take(chunk(i));
      taken_.store(i + 1, std::memory_order_release);
    }
  }
  [[nodiscard]] std::size_t size() const noexcept { return chunks_.size(); }

 private:
  [[nodiscard]] Chunk& chunk(std::size_t number) noexcept { return chunks_[place_[number % place_.size()]]; }

  // Chunks have numbers in the order in which they are filled; place_ has the chunk of each, modulo their
  // count. Between the next number that is filled again and the newest there is one for each chunk that was
  // touched.
  std::vector<Chunk> chunks_;
  std::vector<std::size_t> place_;
  std::size_t again_ = 0, untouched_ = 1;
  std::atomic<std::size_t> whole_ = 0, taken_ = 0;  // chunks; the one that is filled is number whole_
};

}  // namespace enc
