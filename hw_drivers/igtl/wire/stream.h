// Messages out of a stream of bytes, in whatever pieces it comes. What is longer than any message of a
// tracker, such as a picture, is passed over; nothing grows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "hw_drivers/igtl/wire/message.h"

namespace enc::igtl {

class Stream {
 public:
  static constexpr std::size_t kMost = 1U << 13U;  // of a message: some hundred tools

  void begin() noexcept { *this = Stream(std::move(bytes_)); }  // another stream: nothing has come
  // Where what comes next may go, never empty while it is not lost(); then how much of it came.
  [[nodiscard]] std::span<std::byte> room() noexcept;
  void came(std::size_t count) noexcept { end_ += count; }
  // The next message, header and body; empty: it has not come whole. Stays until room() is called.
  [[nodiscard]] std::span<const std::byte> next() noexcept;
  // What came is no header: where the next message begins is not known.
  [[nodiscard]] bool lost() const noexcept { return lost_; }
  [[nodiscard]] std::int64_t skipped() const noexcept { return skipped_; }  // messages that were too long

  Stream() : bytes_(kRoom) {}

 private:
  static constexpr std::size_t kRoom = 1U << 16U;
  explicit Stream(std::vector<std::byte> bytes) noexcept : bytes_(std::move(bytes)) {}

  std::vector<std::byte> bytes_;
  std::size_t begin_ = 0, end_ = 0;  // of what was not given out yet
  std::uint64_t passing_ = 0;        // bytes of what is too long that still come
  std::int64_t skipped_ = 0;
  bool lost_ = false;
};

}  // namespace enc::igtl
