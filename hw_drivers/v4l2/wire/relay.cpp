#include "hw_drivers/v4l2/wire/relay.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include "hw_drivers/net/clocks.h"

namespace enc::v4l2 {

// ---- packets

namespace {

template <class Packet>
constexpr std::size_t kHeader = sizeof(Packet) - kMostData;

// One descriptor as ancillary data.
union OneDescriptor {
  cmsghdr header;
  std::array<char, CMSG_SPACE(sizeof(int))> bytes;
};

template <class Packet>
bool send_packet(int socket, const Packet& packet, int descriptor) noexcept {
  iovec part{const_cast<Packet*>(&packet), kHeader<Packet> + std::min<std::size_t>(packet.size, kMostData)};
  OneDescriptor more{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  if (descriptor >= 0) {
    message.msg_control = &more;
    message.msg_controllen = sizeof(more);
    cmsghdr* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = SOL_SOCKET;
    header->cmsg_type = SCM_RIGHTS;
    header->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(header), &descriptor, sizeof(int));
  }
  return ::sendmsg(socket, &message, MSG_NOSIGNAL) == static_cast<ssize_t>(part.iov_len);
}

template <class Packet>
bool receive_packet(int socket, Packet& packet, int& descriptor) noexcept {
  descriptor = -1;
  iovec part{&packet, sizeof(packet)};
  OneDescriptor more{};
  msghdr message{};
  message.msg_iov = &part;
  message.msg_iovlen = 1;
  message.msg_control = &more;
  message.msg_controllen = sizeof(more);
  const ssize_t got = ::recvmsg(socket, &message, MSG_CMSG_CLOEXEC);
  if (got < 0) return false;
  const cmsghdr* header = CMSG_FIRSTHDR(&message);
  if (header != nullptr && header->cmsg_level == SOL_SOCKET && header->cmsg_type == SCM_RIGHTS &&
      header->cmsg_len == CMSG_LEN(sizeof(int)))
    std::memcpy(&descriptor, CMSG_DATA(header), sizeof(int));
  const auto size = static_cast<std::size_t>(got);
  return size >= kHeader<Packet> && packet.size <= kMostData && size == kHeader<Packet> + packet.size;
}

// Length 0: the name does not fit.
socklen_t address_of(std::string_view name, sockaddr_un& address) noexcept {
  address = {};
  address.sun_family = AF_UNIX;
  if (name.size() < 2 || name.size() >= sizeof(address.sun_path)) return 0;
  std::copy(name.begin(), name.end(), address.sun_path);
  address.sun_path[0] = '\0';  // abstract
  return static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
}

}  // namespace

bool send(int socket, const Call& call) noexcept { return send_packet(socket, call, -1); }
bool send(int socket, const Answer& answer, int descriptor) noexcept {
  return send_packet(socket, answer, descriptor);
}
bool receive(int socket, Call& call) noexcept {
  int descriptor = -1;
  const bool good = receive_packet(socket, call, descriptor);
  if (descriptor >= 0) ::close(descriptor);
  return good;
}
bool receive(int socket, Answer& answer, int& descriptor) noexcept {
  const bool good = receive_packet(socket, answer, descriptor);
  if (!good && descriptor >= 0) ::close(std::exchange(descriptor, -1));
  return good;
}

int connect_to(std::string_view name, std::chrono::seconds patience) noexcept {
  sockaddr_un address{};
  const socklen_t length = address_of(name, address);
  if (length == 0) return -EINVAL;
  const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
  if (socket < 0) return -errno;
  const timeval most{patience.count(), 0};
  static_cast<void>(::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &most, sizeof(most)));
  static_cast<void>(::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &most, sizeof(most)));
  if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), length) == 0) return socket;
  const int error = errno;
  ::close(socket);
  return -error;
}

int listen_at(std::string_view name) noexcept {
  sockaddr_un address{};
  const socklen_t length = address_of(name, address);
  if (length == 0) return -EINVAL;
  const int socket = ::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (socket < 0) return -errno;
  if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), length) == 0 && ::listen(socket, 4) == 0)
    return socket;
  const int error = errno;
  ::close(socket);
  return -error;
}

// ---- the driver's end

namespace {

class RelayMessage final : public System {
 public:
  explicit RelayMessage(std::chrono::seconds patience) : patience_(patience) {}
  ~RelayMessage() override {
    while (!lines_.empty()) close(lines_.back().socket);
  }
  int open(const std::string& path) noexcept override {
    const int socket = connect_to(path, patience_);
    if (socket < 0) return socket;
    Answer hello;
    int event = -1;
    if (receive(socket, hello, event) && hello.result == 0 && event >= 0) {
      lines_.push_back({socket, event});
      return socket;
    }
    if (event >= 0) ::close(event);
    ::close(socket);
    return -ENODEV;
  }
  void close(int descriptor) noexcept override {
    const auto line = find(descriptor);
    if (line == lines_.end()) return;
    ::close(line->socket);
    ::close(line->event);
    lines_.erase(line);
  }
  int control(int descriptor, unsigned long request, void* data) noexcept override {
    Call call;
    call.request = static_cast<std::uint32_t>(request);
    call.size = _IOC_SIZE(request);
    if (call.size > kMostData) return -ENOTTY;
    std::memcpy(call.data.data(), data, call.size);
    Answer answer;
    int none = -1;
    if (!ask(descriptor, call, answer, none)) return -ENODEV;
    if (none >= 0) ::close(none);
    if (answer.size == call.size) std::memcpy(data, answer.data.data(), call.size);
    return answer.result;
  }
  void* map(int descriptor, std::size_t size, std::int64_t offset) noexcept override {
    Call call;
    call.kind = Call::Kind::map;
    Answer answer;
    int memory = -1;
    if (!ask(descriptor, call, answer, memory) || memory < 0) return nullptr;
    void* at = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, memory, offset);
    ::close(memory);
    return at == MAP_FAILED ? nullptr : at;
  }
  void unmap(void* memory, std::size_t size) noexcept override { ::munmap(memory, size); }
  void wait(std::span<const int> descriptors, Duration most) noexcept override {
    std::array<pollfd, 4> all{};
    std::size_t count = 0;
    for (const int descriptor : descriptors) {
      const auto line = find(descriptor);
      if (line == lines_.end() || count + 2 > all.size()) continue;
      all[count++] = {line->event, POLLIN, 0};
      all[count++] = {line->socket, POLLIN, 0};  // readable between two calls: the fake hung up
    }
    const timespec time{static_cast<time_t>(most.count() / 1'000'000'000),
                        static_cast<long>(most.count() % 1'000'000'000)};
    static_cast<void>(::ppoll(all.data(), count, &time, nullptr));
  }
  Duration now() noexcept override { return net::steady_now(); }

 private:
  struct Line {
    int socket, event;
  };
  std::vector<Line>::iterator find(int descriptor) {
    return std::find_if(lines_.begin(), lines_.end(),
                        [descriptor](const Line& line) { return line.socket == descriptor; });
  }
  static bool ask(int descriptor, const Call& call, Answer& answer, int& came) noexcept {
    return send(descriptor, call) && receive(descriptor, answer, came);
  }

  std::chrono::seconds patience_;
  std::vector<Line> lines_;
};

}  // namespace

std::unique_ptr<System> relayed(std::chrono::seconds patience) {
  return std::make_unique<RelayMessage>(patience);
}

}  // namespace enc::v4l2
