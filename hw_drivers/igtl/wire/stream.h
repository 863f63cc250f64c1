// Extracts messages from a stream of bytes, in any pieces. It skips messages longer than any message of a
// tracker, such as a picture; no buffer grows.
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
  static constexpr std::size_t kMost = 1U << 13U;  // largest message: some hundred tools

  void begin() noexcept { *this = Stream(std::move(bytes_)); }  // starts another stream, with no data yet
  // Space for the next bytes, never empty unless lost(); then the number of bytes that came.
  [[nodiscard]] std::span<std::byte> room() noexcept;
  void came(std::size_t count) noexcept { end_ += count; }
  // The next message, header and body; empty: not complete yet. Valid until room() is called.
  [[nodiscard]] std::span<const std::byte> next() noexcept;
  // True if the bytes are not a header: the start of the next message is then unknown.
  [[nodiscard]] bool lost() const noexcept { return lost_; }
  [[nodiscard]] std::int64_t skipped() const noexcept { return skipped_; }  // messages that were too long

  Stream() : bytes_(kRoom) {}

 private:
  static constexpr std::size_t kRoom = 1U << 16U;
  explicit Stream(std::vector<std::byte> bytes) noexcept : bytes_(std::move(bytes)) {}

  std::vector<std::byte> bytes_;
  std::size_t begin_ = 0, end_ = 0;  // range of the bytes not yet returned
  std::uint64_t passing_ = 0;        // remaining bytes of a message that is too long
  std::int64_t skipped_ = 0;
  bool lost_ = false;
};

}  // namespace enc::igtl
