// Bytes for a client of a fake, until the client's socket takes them.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "hw_drivers/net/socket.h"

namespace enc::net {

class SendQueue {
 public:
  void clear() noexcept { bytes_.clear(); }
  void add(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
  void send(Socket& to) {
    if (bytes_.empty()) return;
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(to.send(bytes_)));
  }
  [[nodiscard]] bool empty() const noexcept { return bytes_.empty(); }
  // The client does not read: disconnect it.
  [[nodiscard]] bool overfull() const noexcept { return bytes_.size() > (1U << 20U); }

 private:
  std::vector<std::byte> bytes_;
};

}  // namespace enc::net
