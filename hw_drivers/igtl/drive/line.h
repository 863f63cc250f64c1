// The connection to a server of tool data: datagrams, or a stream. It transfers single messages and never
// waits.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "hw_drivers/igtl/drive/settings.h"
#include "hw_drivers/igtl/wire/message.h"
#include "hw_drivers/igtl/wire/stream.h"
#include "hw_drivers/net/socket.h"

namespace enc::igtl {

class Line {
 public:
  // Throws Error (kind device) if no server listens there.
  explicit Line(const IgtlSettings& settings);

  void say(const Written& message) noexcept;
  // The next message; empty: no message yet. Valid until the next call.
  [[nodiscard]] std::span<const std::byte> next() noexcept;
  [[nodiscard]] Duration came() const noexcept {
    return socket_.came();
  }  // arrival of that message, by net::steady_now()
  void wait(Duration most) noexcept { socket_.wait(most); }
  // Stream only: true if the server has closed the connection or sends something other than OpenIGTLink.
  [[nodiscard]] bool closed() const noexcept { return streams_ && (socket_.closed() || stuck_); }
  [[nodiscard]] bool lost() const noexcept { return stream_.lost(); }
  [[nodiscard]] std::int64_t skipped() const noexcept { return stream_.skipped(); }

 private:
  bool streams_, stuck_ = false;  // stuck_: it took only half of a message
  net::Socket socket_;
  Stream stream_;
  std::array<std::byte, kMostBytes> datagram_{};
};

}  // namespace enc::igtl
