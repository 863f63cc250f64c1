// The bytes to and from a controller, and the clock they are timed by: a socket, or in tests the fake itself.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "core/base/time.h"

namespace enc::gcs {

class Link {
 public:
  virtual ~Link() = default;
  // How many of the bytes were taken; the rest is to be sent again.
  virtual std::size_t send(std::string_view bytes) noexcept = 0;
  // How many came; 0: none yet.
  virtual std::size_t receive(std::span<char> into) noexcept = 0;
  [[nodiscard]] virtual bool closed() const noexcept = 0;
  // Returns when something came, and after this long at the latest.
  virtual void wait(Duration most) noexcept = 0;
  // Of a steady clock, from any start; from any thread.
  [[nodiscard]] virtual Duration now() const noexcept = 0;
};

}  // namespace enc::gcs
