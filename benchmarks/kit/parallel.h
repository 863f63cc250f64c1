// Runs a function on every index, on all cores. Each index writes to its own place, so the result does not
// depend on which thread was faster.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <thread>
#include <vector>

namespace enc::bench {

// Runs work(index) for 0 to count - 1, in no order. Rethrows the exception of the lowest index that failed.
// Any thread may call `progress` with the share done (BenchContext::progress may be called so).
inline void in_parallel(std::size_t count, const std::function<void(std::size_t)>& work,
                        const std::function<void(double)>& progress = {}) {
  std::atomic<std::size_t> next{0};
  std::atomic<std::size_t> done{0};
  std::vector<std::exception_ptr> failed(count);
  const auto run = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      try {
        work(i);
        if (progress) progress(static_cast<double>(++done) / static_cast<double>(count));
      } catch (...) {
        failed[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> others;
    const std::size_t cores = std::max<std::size_t>(1, std::thread::hardware_concurrency());
    for (std::size_t i = 1; i < std::min(cores, count); ++i) others.emplace_back(run);
    run();
  }
  for (const std::exception_ptr& error : failed)
    if (error) std::rethrow_exception(error);
}

}  // namespace enc::bench
