// A socket of the network, TCP or UDP: opened before the run with clear words where it fails, then never
// waiting. A device's folder holds what is said over it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

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
  // The other end has gone, or the network reports it unreachable. A socket of UDP is never closed.
  [[nodiscard]] bool closed() const noexcept { return closed_ || !is_open(); }
  [[nodiscard]] std::uint16_t port() const noexcept;                     // of this end; 0: none
  [[nodiscard]] int descriptor() const noexcept { return descriptor_; }  // to wait on; -1: none

  // How many bytes were taken; the rest is to be sent again. Of UDP: all or nothing.
  std::size_t send(std::span<const std::byte> bytes) noexcept;
  // How many came; 0: none yet, or closed(). Of UDP one datagram; what is longer than `into` is cut there.
  std::size_t receive(std::span<std::byte> into) noexcept;
  // When the last of what receive() gave came to this machine, by steady_now(): as its kernel stamped it, or
  // else when it was read.
  [[nodiscard]] Duration came() const noexcept { return came_; }
  // Of UDP, to and from whoever asks: reply() sends to who had sent what was received before answer_sender().
  void answer_sender() noexcept;
  std::size_t reply(std::span<const std::byte> bytes) noexcept;
  // Says that nothing more comes, waits until the other side has read all, at most so long, and closes: what
  // is closed with something unread takes with it what was sent last.
  void finish(Duration most) noexcept;
  // Returns when something came, and after this long at the latest; true: something came.
  bool wait(Duration most) noexcept;
  // Of a listening one: who has connected meanwhile; not open: nobody.
  Socket accept() noexcept;

 private:
  friend class Opener;
  explicit Socket(int descriptor, bool datagrams) : descriptor_(descriptor), datagrams_(datagrams) {}
  void close() noexcept;
  std::size_t receive_datagram(std::span<std::byte> into) noexcept;
  std::ptrdiff_t take(std::span<std::byte> into, void* sender, std::uint32_t& sender_size) noexcept;

  int descriptor_ = -1;
  bool datagrams_ = false, closed_ = false;
  Duration came_{}, empty_{};  // empty_: when nothing was there, after which what comes next has come
  // Who is answered, and who sent the last datagram: each a sockaddr, kept as bytes so that this header needs
  // none of the system's.
  alignas(8) std::byte peer_[128]{}, sender_[128]{};
  std::uint32_t peer_size_ = 0, sender_size_ = 0;
};

// A name or an address of IPv4 or IPv6, without brackets. All throw Error (kind device) with `host:port`,
// what went wrong and what to do.
// `undelivered`: after so long a connection is lost on which something cannot be delivered. It never is then:
// not seconds later, when a cable is back or who sent it is dead.
[[nodiscard]] Socket connect_tcp(const std::string& host, std::uint16_t port, Duration timeout,
                                 Duration undelivered = Duration(2'000'000'000));
[[nodiscard]] Socket connect_udp(const std::string& host, std::uint16_t port);
// Of a fake: at an address of this machine. Port 0: one that is free, which port() tells.
[[nodiscard]] Socket listen_tcp(const std::string& address, std::uint16_t port);
[[nodiscard]] Socket bind_udp(const std::string& address, std::uint16_t port);
// "192.168.0.20:50000", "[::1]:50000"
[[nodiscard]] std::string place(const std::string& host, std::uint16_t port);

}  // namespace enc::net
