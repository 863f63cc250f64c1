// The server socket for clients that ask for tool data, one client at a time. For datagrams, a later client
// replaces the earlier one; for a stream, it is refused.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "hw_drivers/igtl/wire/message.h"
#include "hw_drivers/igtl/wire/stream.h"
#include "hw_drivers/net/bad_line.h"
#include "hw_drivers/net/socket.h"

namespace enc::igtl {

enum class Transport : bool { udp, tcp };

class Door {
 public:
  // Port 0: any free port. Throws Error (kind device) if it cannot listen there.
  Door(Transport transport, const std::string& address, std::uint16_t port, std::uint64_t seed);

  [[nodiscard]] std::uint16_t port() const { return socket_.port(); }
  void wait_on(std::vector<int>& descriptors) const;
  // Accepts a new client. True: a new client is there.
  bool open(Time now);
  // The next received message; empty: no message. Valid until the next call.
  [[nodiscard]] std::span<const std::byte> next();
  void answer_sender() noexcept { socket_.answer_sender(); }  // datagrams only
  // put() queues a message, and leave() sends it when it is due.
  void put(Time now, std::span<const std::byte> message);
  void leave(Time now);

  // Faults of the connection.
  [[nodiscard]] bool knows(Trouble::Kind kind) const noexcept { return line_.knows(kind); }
  void suffer(const Trouble& trouble) noexcept;
  void heal(Trouble::Kind kind) noexcept { line_.heal(kind); }
  void begin(Time now) { line_.begin(now); }

 private:
  Transport transport_;
  net::Socket socket_, client_;  // client_: stream only
  net::BadLine line_;
  Stream stream_;
  std::array<std::byte, kMostBytes> datagram_{};
  std::vector<std::byte> unsent_;
};

}  // namespace enc::igtl
