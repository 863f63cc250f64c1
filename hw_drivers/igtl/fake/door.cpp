#include "hw_drivers/igtl/fake/door.h"

namespace enc::igtl {
namespace {

constexpr std::size_t kMostUnsent = 1U << 20U;  // a client that reads nothing is let go

}  // namespace

Door::Door(Transport transport, const std::string& address, std::uint16_t port, std::uint64_t seed)
    : transport_(transport),
      socket_(transport == Transport::tcp ? net::listen_tcp(address, port) : net::bind_udp(address, port)),
      line_(transport == Transport::tcp ? net::BadLine::Wire::stream : net::BadLine::Wire::datagrams, seed) {}

// What is not taken would wake us for ever.
void Door::wait_on(std::vector<int>& descriptors) const {
  const bool stands = line_.suffers(Trouble::Kind::stall);
  if (stands || (transport_ == Transport::udp && line_.dead())) return;
  descriptors.push_back(socket_.descriptor());
  if (client_.is_open()) descriptors.push_back(client_.descriptor());
}

bool Door::open(Time now) {
  if (transport_ == Transport::udp || line_.suffers(Trouble::Kind::stall)) return false;
  if (client_.is_open()) {  // that it has gone is known when something is read
    stream_.came(client_.receive(stream_.room()));
    if (client_.closed()) client_ = {};
  }
  net::Socket who = socket_.accept();
  if (!who.is_open() || line_.dead() || client_.is_open()) return false;  // and hung up
  client_ = std::move(who);
  stream_.begin();
  unsent_.clear();
  line_.begin(now);
  return true;
}

std::span<const std::byte> Door::next() {
  if (line_.dead()) return {};
  if (transport_ == Transport::udp) return std::span(datagram_).first(socket_.receive(datagram_));
  std::span<const std::byte> message = stream_.next();
  if (message.empty() && !stream_.lost()) {
    stream_.came(client_.receive(stream_.room()));
    message = stream_.next();
  }
  if (stream_.lost()) client_ = {};
  return message;
}

void Door::put(Time now, std::span<const std::byte> message) {
  if (transport_ == Transport::udp || client_.is_open()) line_.put(now, message);
}

void Door::leave(Time now) {
  line_.leave(now, [this](std::span<const std::byte> bytes) {
    if (transport_ == Transport::udp)
      static_cast<void>(socket_.reply(bytes));
    else
      unsent_.insert(unsent_.end(), bytes.begin(), bytes.end());
  });
  if (transport_ == Transport::udp || unsent_.empty()) return;
  unsent_.erase(unsent_.begin(), unsent_.begin() + static_cast<std::ptrdiff_t>(client_.send(unsent_)));
  if (client_.closed() || unsent_.size() > kMostUnsent) {
    client_ = {};
    unsent_.clear();
  }
}

void Door::suffer(const Trouble& trouble) noexcept {
  line_.suffer(trouble);
  if (trouble.kind == Trouble::Kind::disconnect) client_ = {};
}

}  // namespace enc::igtl
