// A network socket, TCP or UDP: opening it reports clear errors before the run, and afterwards it never
// blocks. The device's folder defines the messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/base/time.h"

namespace enc::net {

class Socket {
 public:
  Socket() = default;
  Socket(Socket&& other) noexcept;
  Socket& operator=(Socket&& other) noexcept;
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket();

  [[nodiscard]] bool is_open() const noexcept { return descriptor_ >= 0; }
  // The other end is gone, or the network reports it as unreachable. A UDP socket is never closed.
  [[nodiscard]] bool closed() const noexcept { return closed_ || !is_open(); }
  [[nodiscard]] std::uint16_t port() const noexcept;                     // port of this end; 0: no port
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }  // to wait on; -1: not open

  // Returns the number of bytes taken; send the rest again. UDP: all or nothing.
  std::size_t send(std::span<const std::byte> bytes) noexcept;
  // Returns the number of bytes received; 0: no bytes yet, or closed(). UDP: one datagram, cut at the size of
  // `into`.
  std::size_t receive(std::span<std::byte> into) noexcept;
  // Arrival at this machine of the last data of receive(), by steady_now(): the kernel's stamp, or else the
  // time of reading.
  [[nodiscard]] Duration came() const noexcept { return came_; }
  // UDP with any client: reply() sends to the sender of the data received before answer_sender().
  void answer_sender() noexcept;
  std::size_t reply(std::span<const std::byte> bytes) noexcept;
  // Announces the end of data, waits until the other side has read everything, at most this long, and closes.
  // Closing with unread data would discard the data sent last.
  void finish(Duration most) noexcept;
  // Returns when data have come, and after this time at the latest; true: data have come.
  bool wait(Duration most) noexcept;
  // Listening socket: the next new connection; not open: no connection.
  Socket accept() noexcept;

 private:
  friend class Opener;
  explicit Socket(int descriptor, bool datagrams) : descriptor_(descriptor), datagrams_(datagrams) {}
  void close() noexcept;
  std::size_t receive_datagram(std::span<std::byte> into) noexcept;
  std::ptrdiff_t take(std::span<std::byte> into, void* sender, std::uint32_t& sender_size) noexcept;

  int descriptor_ = -1;
  bool datagrams_ = false, closed_ = false;
  Duration came_{}, empty_{};  // empty_: time of the last empty read; later data arrived after it
  // The peer for replies, and the sender of the last datagram: each a sockaddr, kept as bytes so that this
  // header needs no system header.
  alignas(8) std::byte peer_[128]{}, sender_[128]{};
  std::uint32_t peer_size_ = 0, sender_size_ = 0;
};

// `host`: a name or an address of IPv4 or IPv6, without brackets. All throw Error (kind device) with
// `host:port`, the problem and the remedy. `undelivered`: a connection is lost if it cannot deliver data for
// this long. The data are then never delivered, not even seconds later, when a cable is back or their sender
// is gone.
[[nodiscard]] Socket connect_tcp(const std::string& host, std::uint16_t port, Duration timeout,
                                 Duration undelivered = Duration(2'000'000'000));
[[nodiscard]] Socket connect_udp(const std::string& host, std::uint16_t port);
// Fakes only: opens a port at an address of this machine. Port 0: a free one, reported by port().
[[nodiscard]] Socket listen_tcp(const std::string& address, std::uint16_t port);
[[nodiscard]] Socket bind_udp(const std::string& address, std::uint16_t port);
// Received text for a message of one line: at most 100 characters, each printable or '?'.
[[nodiscard]] std::string printable(std::string_view text);
// Looks like "192.168.0.20:50000" or "[::1]:50000".
[[nodiscard]] std::string place(const std::string& host, std::uint16_t port);

}  // namespace enc::net
