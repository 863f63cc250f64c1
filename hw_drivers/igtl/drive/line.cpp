#include "hw_drivers/igtl/drive/line.h"

namespace enc::igtl {

Line::Line(const IgtlSettings& settings)
    : streams_(settings.streams()),
      socket_(streams_ ? net::connect_tcp(settings.address, static_cast<std::uint16_t>(settings.port),
                                          from_seconds(settings.timeout))
                       : net::connect_udp(settings.address, static_cast<std::uint16_t>(settings.port))) {}

std::span<const std::byte> Line::next() noexcept {
  if (!streams_) return std::span(datagram_).first(socket_.receive(datagram_));
  constexpr int kMost = 32;  // pieces of a picture that are passed over at once: 2 MiB
  for (int i = 0; i < kMost; ++i) {
    const std::span<const std::byte> message = stream_.next();
    if (!message.empty() || stream_.lost()) return message;
    const std::size_t came = socket_.receive(stream_.room());
    if (came == 0) return {};
    stream_.came(came);
  }
  return stream_.next();
}

void Line::say(const Written& message) noexcept {
  const std::size_t sent = socket_.send(message.bytes());
  stuck_ = stuck_ || (sent > 0 && sent < message.bytes().size());
}

}  // namespace enc::igtl
