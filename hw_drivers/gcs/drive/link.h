// The bytes to and from a controller, and the clock that times them: a socket, or in tests the fake itself.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "core/base/time.h"

namespace enc::gcs {

class Link {
 public:
  virtual ~Link() = default;
  // Returns the number of bytes taken; send the rest again.
  virtual std::size_t send(std::string_view bytes) noexcept = 0;
  // Returns the number of bytes received; 0: no bytes yet.
  virtual std::size_t receive(std::span<char> into) noexcept = 0;
  [[nodiscard]] virtual bool closed() const noexcept = 0;
  // Returns when data have come, or after this time at the latest.
  virtual void wait(Duration most) noexcept = 0;
  // Time of a steady clock with any start; callable from any thread.
  [[nodiscard]] virtual Duration now() const noexcept = 0;
};

}  // namespace enc::gcs
