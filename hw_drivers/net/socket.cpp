#include "hw_drivers/net/socket.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <memory>
#include <utility>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/base/units.h"
#include "hw_drivers/net/clocks.h"

namespace enc::net {
namespace {

using Addresses = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

Error refused(const std::string& host, std::uint16_t port, const std::string& what) {
  return Error(fmt::format("{}: {}", place(host, port), what), {}, ErrorKind::device);
}

Addresses resolve(const std::string& host, std::uint16_t port, int type, int flags) {
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = type;
  wanted.ai_flags = flags | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int code = getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found);
  if (code != 0)
    throw refused(host, port,
                  fmt::format("'{}' is no address and no name that is known ({}); see the address in the rig "
                              "file",
                              host, gai_strerror(code)));
  return {found, freeaddrinfo};
}

void switch_on(int descriptor, int level, int option) {
  const int on = 1;
  setsockopt(descriptor, level, option, &on, sizeof on);
}
// Small messages such as set-points are sent at once, not collected.
void send_at_once(int descriptor) { switch_on(descriptor, IPPROTO_TCP, TCP_NODELAY); }

void forget_after(int descriptor, Duration time) {
  const auto ms = static_cast<unsigned>(std::max<std::int64_t>(1, time.count() / kNsPerMs));
  setsockopt(descriptor, IPPROTO_TCP, TCP_USER_TIMEOUT, &ms, sizeof ms);
}

int open_for(const addrinfo& address) {
  const int descriptor = socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0)
    throw Error(fmt::format("no socket could be opened: {}", std::strerror(errno)), {}, ErrorKind::device);
  if (address.ai_socktype == SOCK_STREAM) send_at_once(descriptor);
  switch_on(descriptor, SOL_SOCKET, SO_TIMESTAMPNS);
  return descriptor;
}

// Time since the kernel received the message, by the kernel's stamp clock. It is wrong if that clock was set
// meanwhile; see take().
Duration waited(const msghdr& message) {
  constexpr std::int64_t kSecond = 1'000'000'000, kMost = 60 * kSecond;
  for (cmsghdr* word = CMSG_FIRSTHDR(&message); word != nullptr;
       word = CMSG_NXTHDR(const_cast<msghdr*>(&message), word)) {
    if (word->cmsg_level != SOL_SOCKET || word->cmsg_type != SCM_TIMESTAMPNS) continue;
    timespec came{}, now{};
    std::memcpy(&came, CMSG_DATA(word), sizeof came);
    clock_gettime(CLOCK_REALTIME, &now);
    const std::int64_t ns = (now.tv_sec - came.tv_sec) * kSecond + now.tv_nsec - came.tv_nsec;
    return ns > 0 && ns < kMost ? Duration(ns) : Duration{};
  }
  return {};
}

bool waits(int error) { return error == EAGAIN || error == EINTR; }

// Returns 0 if data came, ETIMEDOUT, or the error.
int wait_for(int descriptor, short events, Duration most) {
  const Duration until = steady_now() + most;
  for (;;) {
    const Duration left = std::max(Duration{}, until - steady_now());
    pollfd one{descriptor, events, 0};
    const timespec time{left.count() / 1'000'000'000, left.count() % 1'000'000'000};
    const int ready = ppoll(&one, 1, &time, nullptr);
    if (ready > 0) return 0;
    if (ready == 0) return ETIMEDOUT;
    if (errno != EINTR) return errno;
  }
}

std::string advice_of(int error, Duration timeout) {
  switch (error) {
    case ECONNREFUSED:
      return "nobody listens there; see that the device is on, and the port in the rig file";
    case ETIMEDOUT:
      return fmt::format("no answer within {} ms; see power, cable and address", timeout.count() / kNsPerMs);
    case ENETUNREACH:
    case EHOSTUNREACH:
      return "no way leads there; see cable, network and address";
    default:
      return std::strerror(error);
  }
}

int connected(int descriptor, const addrinfo& address, Duration timeout) {
  if (connect(descriptor, address.ai_addr, address.ai_addrlen) == 0) return 0;
  if (errno != EINPROGRESS) return errno;
  if (const int error = wait_for(descriptor, POLLOUT, timeout); error != 0) return error;
  int error = 0;
  socklen_t size = sizeof error;
  return getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &error, &size) == 0 ? error : errno;
}

}  // namespace

class Opener {
 public:
  // Connects to the first address of the name that accepts. If all fail, reports the last reason.
  static Socket connect_to(const std::string& host, std::uint16_t port, int type, Duration timeout) {
    const Addresses all = resolve(host, port, type, 0);
    int error = 0;
    for (const addrinfo* one = all.get(); one != nullptr; one = one->ai_next) {
      Socket socket(open_for(*one), type == SOCK_DGRAM);
      error = connected(socket.descriptor_, *one, timeout);
      if (error == 0) return socket;
    }
    throw refused(host, port, advice_of(error, timeout));
  }

  static Socket bind_to(const std::string& host, std::uint16_t port, int type) {
    const Addresses all = resolve(host, port, type, AI_PASSIVE);
    Socket socket(open_for(*all), type == SOCK_DGRAM);
    if (type == SOCK_STREAM) switch_on(socket.descriptor_, SOL_SOCKET, SO_REUSEADDR);
    if (bind(socket.descriptor_, all->ai_addr, all->ai_addrlen) != 0 ||
        (type == SOCK_STREAM && listen(socket.descriptor_, 8) != 0))
      throw refused(host, port,
                    errno == EADDRINUSE
                        ? "the port is taken; end what has it, or give another"
                        : fmt::format("{}; an address of this machine is needed", std::strerror(errno)));
    return socket;
  }
};

Socket::Socket(Socket&& other) noexcept { *this = std::move(other); }

Socket& Socket::operator=(Socket&& other) noexcept {
  if (this == &other) return *this;
  close();
  descriptor_ = std::exchange(other.descriptor_, -1);
  datagrams_ = other.datagrams_;
  came_ = other.came_;
  empty_ = other.empty_;
  closed_ = other.closed_;
  peer_size_ = other.peer_size_;
  sender_size_ = other.sender_size_;
  std::copy(std::begin(other.peer_), std::end(other.peer_), std::begin(peer_));
  std::copy(std::begin(other.sender_), std::end(other.sender_), std::begin(sender_));
  return *this;
}

Socket::~Socket() { close(); }

void Socket::close() noexcept {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

std::uint16_t Socket::port() const noexcept {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  if (getsockname(descriptor_, reinterpret_cast<sockaddr*>(&address), &size) != 0) return 0;
  if (address.ss_family == AF_INET6) return ntohs(reinterpret_cast<const sockaddr_in6*>(&address)->sin6_port);
  return ntohs(reinterpret_cast<const sockaddr_in*>(&address)->sin_port);
}

std::size_t Socket::send(std::span<const std::byte> bytes) noexcept {
  if (closed() || bytes.empty()) return 0;
  const ssize_t sent = ::send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent >= 0) return static_cast<std::size_t>(sent);
  closed_ = !datagrams_ && !waits(errno);
  return 0;
}

// Works as recvfrom(), and notes the arrival time.
std::ptrdiff_t Socket::take(std::span<std::byte> into, void* sender, std::uint32_t& sender_size) noexcept {
  iovec place{into.data(), into.size()};
  alignas(cmsghdr) std::array<char, 128> words{};
  msghdr message{};
  message.msg_name = sender;
  message.msg_namelen = sender_size;
  message.msg_iov = &place;
  message.msg_iovlen = 1;
  message.msg_control = words.data();
  message.msg_controllen = words.size();
  const ssize_t came = recvmsg(descriptor_, &message, 0);
  if (came <= 0) {
    if (came < 0 && waits(errno)) empty_ = steady_now();
    return came;
  }
  sender_size = message.msg_namelen;
  const Duration here = waited(message);
  came_ = std::max(steady_now() - here, empty_);
  return came;
}

std::size_t Socket::receive(std::span<std::byte> into) noexcept {
  if (closed() || into.empty()) return 0;
  if (datagrams_) return receive_datagram(into);
  std::uint32_t none = 0;
  const std::ptrdiff_t came = take(into, nullptr, none);
  if (came > 0) return static_cast<std::size_t>(came);
  closed_ = came == 0 || !waits(errno);
  return 0;
}

// Skips empty datagrams and errors of earlier ones: further data may follow them.
std::size_t Socket::receive_datagram(std::span<std::byte> into) noexcept {
  static_assert(sizeof sender_ >= sizeof(sockaddr_storage));
  constexpr int kMostEmpty = 64;
  for (int i = 0; i < kMostEmpty; ++i) {
    std::uint32_t size = sizeof sender_;
    const std::ptrdiff_t came = take(into, sender_, size);
    if (came > 0) {
      sender_size_ = size;
      return static_cast<std::size_t>(came);
    }
    if (came < 0 && waits(errno)) return 0;
  }
  return 0;
}

void Socket::answer_sender() noexcept {
  std::copy(std::begin(sender_), std::end(sender_), std::begin(peer_));
  peer_size_ = sender_size_;
}

void Socket::finish(Duration most) noexcept {
  if (!is_open() || datagrams_) return;
  shutdown(descriptor_, SHUT_WR);
  std::array<std::byte, 1024> rest{};
  for (const Duration until = steady_now() + most; !closed() && steady_now() < until;)
    if (receive(rest) == 0) wait(until - steady_now());
  close();
}

std::size_t Socket::reply(std::span<const std::byte> bytes) noexcept {
  if (closed() || peer_size_ == 0) return 0;
  const ssize_t sent = sendto(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL,
                              reinterpret_cast<const sockaddr*>(peer_), peer_size_);
  return sent < 0 ? 0 : static_cast<std::size_t>(sent);
}

bool Socket::wait(Duration most) noexcept { return is_open() && wait_for(descriptor_, POLLIN, most) == 0; }

Socket Socket::accept() noexcept {
  const int descriptor =
      is_open() ? accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK) : -1;
  if (descriptor >= 0) send_at_once(descriptor);
  return Socket(descriptor, false);
}

Socket connect_tcp(const std::string& host, std::uint16_t port, Duration timeout, Duration undelivered) {
  Socket socket = Opener::connect_to(host, port, SOCK_STREAM, timeout);
  forget_after(socket.descriptor(), undelivered);
  return socket;
}

Socket connect_udp(const std::string& host, std::uint16_t port) {
  return Opener::connect_to(host, port, SOCK_DGRAM, Duration{});
}

Socket listen_tcp(const std::string& address, std::uint16_t port) {
  return Opener::bind_to(address, port, SOCK_STREAM);
}

Socket bind_udp(const std::string& address, std::uint16_t port) {
  return Opener::bind_to(address, port, SOCK_DGRAM);
}

std::string printable(std::string_view text) {
  constexpr std::size_t kMost = 100;
  std::string shown(text.substr(0, kMost));
  for (char& c : shown)
    if (c < ' ' || c > '~') c = '?';
  return shown;
}

std::string place(const std::string& host, std::uint16_t port) {
  return host.find(':') == std::string::npos ? fmt::format("{}:{}", host, port)
                                             : fmt::format("[{}]:{}", host, port);
}

}  // namespace enc::net
