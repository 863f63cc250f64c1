// The kernel calls of the driver: open, ioctl, mmap, poll and the clock. A video device answers them, or a
// fake that stands in for one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/base/time.h"

namespace enc::v4l2 {

class System {
 public:
  virtual ~System() = default;
  // A descriptor, or the negative error number.
  [[nodiscard]] virtual int open(const std::string& path) noexcept = 0;
  virtual void close(int descriptor) noexcept = 0;
  // One ioctl with the struct that belongs to the request. 0, or the negative error number.
  [[nodiscard]] virtual int control(int descriptor, unsigned long request, void* data) noexcept = 0;
  // Shared memory of a buffer; null: refused.
  [[nodiscard]] virtual void* map(int descriptor, std::size_t size, std::int64_t offset) noexcept = 0;
  virtual void unmap(void* memory, std::size_t size) noexcept = 0;
  // Returns when a device has a frame or is gone, and after this time at the latest.
  virtual void wait(std::span<const int> descriptors, Duration most) noexcept = 0;
  [[nodiscard]] virtual Duration now() noexcept = 0;  // CLOCK_MONOTONIC, as the frames' stamps
};

// The calls of this machine's kernel.
[[nodiscard]] std::unique_ptr<System> kernel();

// The group that may use this file, such as "video".
[[nodiscard]] std::string group_of(const std::string& path);

}  // namespace enc::v4l2
