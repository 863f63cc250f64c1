// The server's side of the line to who asks for tool data, one client at a time: of datagrams a later one
// takes the place of the earlier, of a stream it is sent away.
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
  // Port 0: any that is free. Throws Error (kind device) where nobody may listen there.
  Door(Transport transport, const std::string& address, std::uint16_t port, std::uint64_t seed);

  [[nodiscard]] std::uint16_t port() const { return socket_.port(); }
  void wait_on(std::vector<int>& descriptors) const;
  // Lets in who has come. True: somebody new is there.
  bool open(Time now);
  // The next message that somebody sent; empty: none. Stays until it is called again.
  [[nodiscard]] std::span<const std::byte> next();
  void answer_sender() noexcept { socket_.answer_sender(); }  // of datagrams
  // On its way, and out of the door when it is due.
  void put(Time now, std::span<const std::byte> message);
  void leave(Time now);

  // What is wrong with the line.
  [[nodiscard]] bool knows(Trouble::Kind kind) const noexcept { return line_.knows(kind); }
  void suffer(const Trouble& trouble) noexcept;
  void heal(Trouble::Kind kind) noexcept { line_.heal(kind); }
  void begin(Time now) { line_.begin(now); }

 private:
  Transport transport_;
  net::Socket socket_, client_;  // client_: of a stream
  net::BadLine line_;
  Stream stream_;
  std::array<std::byte, kMostBytes> datagram_{};
  std::vector<std::byte> unsent_;
};

}  // namespace enc::igtl
