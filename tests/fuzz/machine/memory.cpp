#include "tests/fuzz/machine/memory.h"

#include <atomic>
#include <cstdlib>
#include <new>

#include <malloc.h>

namespace enc::fuzz {
namespace {

std::atomic<std::size_t> live{0}, peak{0};

}  // namespace

std::size_t live_bytes() { return live.load(std::memory_order_relaxed); }
std::size_t peak_bytes() { return peak.load(std::memory_order_relaxed); }
void forget_peak() { peak.store(live_bytes(), std::memory_order_relaxed); }

void* count_new(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t size = malloc_usable_size(memory);
  const std::size_t now = live.fetch_add(size, std::memory_order_relaxed) + size;
  if (now > peak_bytes()) peak.store(now, std::memory_order_relaxed);
  return memory;
}
void count_delete(void* memory) {
  if (memory == nullptr) return;
  live.fetch_sub(malloc_usable_size(memory), std::memory_order_relaxed);
  std::free(memory);
}

}  // namespace enc::fuzz

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(__clang__)
// The array forms and those that do not throw call these.
void* operator new(std::size_t size) { return enc::fuzz::count_new(std::malloc(size == 0 ? 1 : size)); }
void* operator new(std::size_t size, std::align_val_t align) {
  const auto to = static_cast<std::size_t>(align);
  return enc::fuzz::count_new(std::aligned_alloc(to, (size / to + 1) * to));
}
void operator delete(void* memory) noexcept { enc::fuzz::count_delete(memory); }
void operator delete(void* memory, std::size_t) noexcept { enc::fuzz::count_delete(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { enc::fuzz::count_delete(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  enc::fuzz::count_delete(memory);
}
#endif
